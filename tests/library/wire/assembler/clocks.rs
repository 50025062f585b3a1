//! Counters that wrap, restart or are damaged, and crystals that drift.

use underfoot::wire::LinkCounters;

use super::*;

// N6
#[test]
fn a_wrapping_counter_leaves_no_trace() {
    let mut assembler = assembler();
    let start = u32::MAX - 500;
    let packets = (0..1000)
        .flat_map(|ms| (0..BOARDS).map(move |board| packet(board, ms, ms.into())))
        // Only the counter wraps: a load that wraps would not be a body's.
        .map(|packet| SensorPacket { sequence: start.wrapping_add(packet.sequence), ..packet });
    let frames = feed(&mut assembler, packets);
    assert_eq!(frames.len(), 1000);
    assert!(frames.iter().all(|frame| frame.quality == LIVE));
    assert!((0..).zip(&frames).all(|(ms, frame)| frame.at_us == ms * 1000));
    assert_eq!(assembler.counters(), LinkCounters { packets: 3000, frames: 1000, ..LinkCounters::default() });
}

// N6
#[test]
fn a_rebooted_board_is_stale_once_and_back_in_step() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 5000));
    // Board 1 counts from zero again after 30 ms.
    let reboot = steady(5000, 5200).filter_map(|p| match (p.board, p.sequence) {
        (1, 5000..5030) => None,
        (1, ms) => Some(SensorPacket { sequence: ms - 5030, ..p }),
        _ => Some(p),
    });
    let frames = feed(&mut assembler, reboot);
    let stale: Vec<_> = frames.iter().filter(|frame| frame.quality[1] == Quality::Stale).collect();
    // Accepted at its third packet; by then two slots were waiting for it.
    assert_eq!(stale.iter().map(|frame| frame.at_us).collect::<Vec<_>>(), [5_031_000, 5_032_000]);
    assert_eq!(frames.last().unwrap().samples[1], 5199.0);
    assert_eq!(frames.len(), 200);
    let counters = assembler.counters();
    assert_eq!((counters.restarts, counters.out_of_order), (1, 2));
}

// P9
#[test]
fn a_damaged_sequence_number_derails_nothing() {
    let clean = feed(&mut assembler(), steady(0, 400));
    for bit in 0..32 {
        let mut assembler = assembler();
        // A damaged copy before each tenth packet of board 1.
        let noisy = steady(0, 400).flat_map(|p| {
            let damaged = SensorPacket { sequence: p.sequence ^ (1 << bit), ..p.clone() };
            let noise = (p.board == 1 && p.sequence % 10 == 9).then_some(damaged);
            noise.into_iter().chain([p])
        });
        let frames = feed(&mut assembler, noisy);
        assert_eq!(frames.len(), clean.len(), "bit {bit}");
        for (frame, clean) in frames.iter().zip(&clean) {
            assert_eq!((frame.at_us, frame.quality), (clean.at_us, clean.quality), "bit {bit}");
            // The next number in sequence is indistinguishable from the true one.
            assert!((frame.samples[1] - clean.samples[1]).abs() <= 1.0, "bit {bit}: {frame:?}");
        }
        assert_eq!(assembler.counters().restarts, 0, "bit {bit}");
    }
}

// N8
#[test]
fn crystals_200_ppm_apart_slip_now_and_then_and_lose_nothing_else() {
    let mut assembler = assembler();
    // Board 0 is 200 ppm fast, board 2 as slow, for 60 s: 12 ms apart on either side.
    let mut packets: Vec<_> = (0..BOARDS)
        .flat_map(|board| {
            let step_ns = [999_800, 1_000_000, 1_000_200][usize::from(board)];
            (0..60_000u64).map(move |n| at_us(board, n as u32, 1000 + n * step_ns / 1000))
        })
        .collect();
    packets.sort_by_key(|packet| packet.received);
    let frames = feed(&mut assembler, packets);
    let odd: Vec<_> = frames.iter().filter(|frame| frame.quality != LIVE).take(3).collect();
    assert!(odd.is_empty(), "{odd:?}");
    assert!(frames.is_sorted_by(|a, b| (999..=1001).contains(&(b.at_us - a.at_us))));
    assert!((59_990..=60_012).contains(&frames.len()), "{}", frames.len());
    let counters = assembler.counters();
    assert!((22..=26).contains(&counters.slips), "{counters:?}");
    assert_eq!((counters.lost, counters.restarts, counters.out_of_order), (0, 0, 0));
    assert!(counters.late <= 6, "{counters:?}");
    assert!((11..=13).contains(&assembler.board(2).unwrap().slips));
    assert!((-13..=-11).contains(&assembler.board(0).unwrap().slips));
}

// N8
#[test]
fn a_floor_whose_crystals_all_run_slow_is_followed_without_slips() {
    let mut assembler = assembler();
    let packets = (0..60_000u64)
        .flat_map(|n| (0..BOARDS).map(move |board| at_us(board, n as u32, n * 1_000_200 / 1000)));
    let frames = feed(&mut assembler, packets);
    assert_eq!(frames.len(), 60_000);
    assert_eq!(assembler.counters().slips, 0);
    let end = 59_999u64 * 1_000_200 / 1000;
    let off = end.abs_diff(frames.last().unwrap().at_us);
    assert!(off < 500, "{off} us behind");
    assert!(frames.is_sorted_by(|a, b| (999..=1001).contains(&(b.at_us - a.at_us))));
}

/// Packets of all boards, `hz` a second for eight seconds.
fn at_rate(hz: u64) -> impl Iterator<Item = SensorPacket> {
    (0..8 * hz).flat_map(move |n| (0..BOARDS).map(move |board| at_us(board, n as u32, n * 1_000_000 / hz)))
}

#[test]
fn time_is_that_of_the_clock_whatever_boards_send() {
    for hz in [20, 50, 100, 140, 160, 200, 500, 800, 1000, 1010, 1400, 1600, 2000, 4000] {
        let mut assembler = assembler();
        let mut frames = 0;
        for packet in at_rate(hz) {
            assembler.take(&packet);
            while let Some(frame) = assembler.ready() {
                frames += 1;
                let ahead = frame.at.micros().cast_signed() - packet.received.micros().cast_signed();
                // A rate is measured over half a second: until then time may lag, and leads by 100 ms at most.
                let is_measured = packet.received >= Instant::from_millis(1000);
                let (behind, most) = if is_measured { (25_000, 25_000) } else { (600_000, 110_000) };
                assert!(ahead < most && ahead > -behind - 1_000_000 / hz as i64, "{hz} Hz: {ahead} us");
            }
        }
        let expected = 7 * hz.min(1000);
        assert!((expected..=8 * 1000 + 100).contains(&frames), "{hz} Hz: {frames} frames");
        let last = assembler.board(0).unwrap();
        assert_eq!((last.quality, last.loss < 0.01), (Quality::Live, true), "{hz} Hz: {last:?}");
    }
}

#[test]
fn a_slow_board_holds_up_none_of_the_others() {
    let mut assembler = assembler();
    // Board 1 sends every third millisecond.
    let packets = steady(0, 4000).filter_map(|p| match p.board {
        1 if p.sequence % 3 == 0 => Some(SensorPacket { sequence: p.sequence / 3, ..p }),
        1 => None,
        _ => Some(p),
    });
    let frames = feed(&mut assembler, packets);
    assert!(frames.len() > 3990, "{}", frames.len());
    let late: Vec<_> = frames.iter().filter(|frame| frame.at_us > 1_000_000).collect();
    assert!(late.iter().all(|frame| frame.quality == LIVE && frame.samples[0] == frame.samples[2]));
    // Its sample is from that millisecond or one of the two before.
    let behind = |frame: &&Shown| frame.samples[0] - frame.samples[1];
    assert!(late.iter().all(|frame| (-1.0..=4.0).contains(&behind(frame))));
}
