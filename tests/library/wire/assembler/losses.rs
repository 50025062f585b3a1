//! Packets that come late, never, or all at once; boards that fall silent.

use std::time::Duration;

use underfoot::floor::{TileBlock, TileId};
use underfoot::wire::LinkState;

use super::*;

// N1
#[test]
fn single_losses_hold_the_last_values_and_mark_nothing() {
    let mut assembler = assembler();
    let frames = feed(&mut assembler, steady(0, 1000).filter(|p| p.board != 1 || p.sequence % 20 != 7));
    assert_eq!(frames.len(), 1000);
    for (ms, frame) in (0..).zip(&frames) {
        let held = if ms % 20 == 7 { ms - 1 } else { ms };
        assert_eq!(
            *frame,
            Shown { at_us: ms * 1000, samples: [ms as f32, held as f32, ms as f32], quality: LIVE }
        );
    }
    assert_eq!(assembler.counters().lost, 50);
}

// N1
#[test]
fn a_fifth_of_the_packets_lost_degrades_that_board() {
    let mut assembler = assembler();
    let frames = feed(&mut assembler, steady(0, 1500).filter(|p| p.board != 1 || p.sequence % 5 != 0));
    assert_eq!(frames.last().unwrap().quality, [Quality::Live, Quality::Degraded, Quality::Live]);
    let status = assembler.board(1).unwrap();
    assert!((status.loss - 0.2).abs() < 0.02, "{status:?}");
    assert_eq!(assembler.link_state(), LinkState::Live);
}

// N2
#[test]
fn bursts_below_100_ms_are_held_through() {
    for burst in [20, 50, 90] {
        let mut assembler = assembler();
        let all = steady(0, 1000).filter(|p| !(300..300 + burst).contains(&p.sequence));
        let mut frames = Vec::new();
        let mut last = 0;
        for packet in all {
            // The source finds no packet for a while and only time passes.
            for ms in (last..packet.received.micros() / 1000).skip(1) {
                frames.extend(poll(&mut assembler, ms));
            }
            last = packet.received.micros() / 1000;
            frames.extend(feed(&mut assembler, [packet]));
        }
        assert!(frames.iter().all(|frame| frame.quality == LIVE), "{burst} ms");
        assert_eq!(frames.len(), 1000 - burst as usize);
        assert_eq!(assembler.counters().lost, u64::from(burst) * 3);
    }
}

// N3
#[test]
fn silence_is_shown_at_100_ms() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 1000));
    for ms in (1000..1099).step_by(9) {
        assert_eq!(poll(&mut assembler, ms), [], "{ms}");
    }
    let frames = poll(&mut assembler, 1100);
    let stale = Shown { at_us: 1_100_000, samples: [999.0; 3], quality: [Quality::Stale; 3] };
    assert_eq!(frames, [stale]);
    assert_eq!(assembler.link_state(), LinkState::Lost);
    assert_eq!(assembler.board(2).unwrap().age, Some(Duration::from_millis(101)));
    assert_eq!(poll(&mut assembler, 1300), [], "said once");

    // A single outage ends with the next packets.
    let frames = feed(&mut assembler, steady(2000, 2010));
    assert_eq!(frames.len(), 10);
    assert_eq!(frames[0], Shown { at_us: 2_000_000, samples: [2000.0; 3], quality: LIVE });
    assert_eq!(assembler.link_state(), LinkState::Live);
}

#[test]
fn silence_is_shown_even_if_nobody_polled_during_it() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 1000));
    let frames = feed(&mut assembler, steady(1500, 1510));
    assert_eq!(frames[0].quality, [Quality::Stale; 3]);
    assert_eq!(frames[1].quality, LIVE);
}

#[test]
fn what_waits_for_a_board_is_passed_on_when_time_passes() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 10));
    assert_eq!(feed(&mut assembler, [packet(0, 10, 10), packet(1, 10, 10)]), []);
    assert_eq!(poll(&mut assembler, 12), []);
    let frames = poll(&mut assembler, 13);
    assert_eq!(frames, [Shown { at_us: 10_000, samples: [10.0, 10.0, 9.0], quality: LIVE }]);
}

// N4
#[test]
fn a_board_two_slots_ahead_ends_the_wait_and_stragglers_are_late() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 10));
    let ahead = (10..13).flat_map(|ms| [packet(0, ms, 12), packet(2, ms, 12)]);
    let frames = feed(&mut assembler, ahead);
    assert_eq!(frames.iter().map(|frame| frame.samples).collect::<Vec<_>>(), [[10.0, 9.0, 10.0]]);
    // Slot 10 is done, 11 and 12 still wait.
    let frames = feed(&mut assembler, (10..13).map(|ms| packet(1, ms, 13)));
    assert_eq!(frames.iter().map(|frame| frame.samples).collect::<Vec<_>>(), [[11.0; 3], [12.0; 3]]);
    assert_eq!((assembler.counters().late, assembler.counters().lost), (1, 0));
}

// N7
#[test]
fn a_burst_after_200_ms_of_silence_is_swallowed() {
    for polled in [true, false] {
        let mut assembler = assembler();
        feed(&mut assembler, steady(0, 1000));
        let mut frames = Vec::new();
        if polled {
            (1000..1200).for_each(|ms| frames.extend(poll(&mut assembler, ms)));
        }
        let burst = steady(1000, 1200).map(|p| SensorPacket { received: Instant::from_millis(1200), ..p });
        frames.extend(feed(&mut assembler, burst));
        frames.extend(feed(&mut assembler, steady(1200, 1300)));

        assert_eq!(frames[0].quality, [Quality::Stale; 3]);
        // Packets older than 20 ms are dropped, and time never runs backwards.
        assert!(frames[1..].iter().all(|frame| frame.at_us >= 1_180_000), "{:?}", frames[1]);
        assert!(frames.is_sorted_by(|a, b| a.at_us < b.at_us));
        assert_eq!(frames.last(), Some(&Shown { at_us: 1_299_000, samples: [1299.0; 3], quality: LIVE }));
        assert!(assembler.counters().late > 500);
    }
}

#[test]
fn a_link_that_stays_200_ms_late_is_followed() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 1000));
    let late =
        steady(1000, 3000).map(|p| SensorPacket { received: p.received + Duration::from_millis(200), ..p });
    let frames = feed(&mut assembler, late);
    assert!(frames.is_sorted_by(|a, b| a.at_us < b.at_us));
    let last = frames.last().unwrap();
    assert_eq!((last.quality, last.samples), (LIVE, [2999.0; 3]));
    assert!((3_198_000..=3_200_000).contains(&last.at_us), "{last:?}");
}

#[test]
fn a_link_that_returns_50_ms_later_than_before_is_believed_soon() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 1000));
    poll(&mut assembler, 1150);
    let late =
        steady(1200, 1400).map(|p| SensorPacket { received: p.received + Duration::from_millis(50), ..p });
    let frames = feed(&mut assembler, late);
    let first = frames.iter().position(|frame| frame.quality == LIVE).unwrap();
    assert!(first <= 130, "{first}");
    assert_eq!(frames.last().unwrap().samples, [1399.0; 3]);
}

// N10
#[test]
fn one_unplugged_board_leaves_the_others_alone() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 1000));
    let frames = feed(&mut assembler, steady(1000, 3000).filter(|p| p.board != 1));
    assert_eq!(frames.len(), 2000);
    for frame in &frames {
        // The others wait two slots for it, so 1097 is the frame made 100 ms after 999.
        let stale = frame.at_us >= 1_097_000;
        let expected = if stale { Quality::Stale } else { Quality::Live };
        assert_eq!(frame.quality, [Quality::Live, expected, Quality::Live], "{frame:?}");
        assert_eq!(frame.samples[0], frame.samples[2]);
        assert_eq!(frame.samples[1], 999.0);
    }
    assert_eq!(assembler.link_state(), LinkState::Partial);
    // Connected again.
    let frames = feed(&mut assembler, steady(3000, 3010));
    assert_eq!(frames.len(), 10);
    assert_eq!(frames[9], Shown { at_us: 3_009_000, samples: [3009.0; 3], quality: LIVE });
}

#[test]
fn a_board_missing_from_the_start_is_stale_and_holds_nobody_up() {
    let mut assembler = assembler();
    let frames = feed(&mut assembler, steady(0, 500).filter(|p| p.board != 2));
    assert!(frames.len() >= 498);
    assert!(frames.iter().all(|frame| frame.quality == [Quality::Live, Quality::Live, Quality::Stale]));
    assert_eq!(assembler.board(2).unwrap().age, None);
}

// N12
#[test]
fn a_flapping_link_stays_stale_until_it_is_clean_for_a_second() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 5000));
    // Up 90 ms, down 110 ms, for two seconds.
    let flapping =
        steady(5000, 10_000).filter(|p| p.board != 1 || p.sequence >= 7000 || p.sequence % 200 >= 110);
    let frames = feed(&mut assembler, flapping);
    let live_ms: Vec<_> = frames
        .iter()
        .filter(|frame| frame.quality[1] == Quality::Live)
        .map(|frame| frame.at_us / 1000)
        .collect();
    // Live until the first outage is detected and once more after it; then, up since 6910, not before 7910.
    assert!(live_ms.contains(&5111));
    assert!(live_ms.iter().all(|ms| !(5300..7910).contains(ms)));
    assert!(live_ms.contains(&7910));
}

#[test]
fn a_part_of_a_floor_waits_for_what_its_neighbour_forwards_late() {
    // The computer that forwards board 1's packets is busy for five milliseconds.
    let busy = |p: SensorPacket| {
        let ms = p.received.micros() / 1000;
        let is_held_up = p.board == 1 && (500..505).contains(&ms);
        if is_held_up { packet(1, p.sequence, 505) } else { p }
    };
    let mut packets: Vec<_> = steady(0, 1000).map(busy).collect();
    packets.sort_by_key(|packet| packet.received);
    let whole = Geometry::of_paper_tiles(4, BOARDS).unwrap();
    let part = whole.part(&TileBlock { first: TileId::new(2, 0), columns: 2, rows: BOARDS }).unwrap();
    for (geometry, late) in [(part, 0), (floor().geometry, 3)] {
        let mut assembler = Assembler::new(&Floor::of(geometry));
        let frames = feed(&mut assembler, packets.iter().cloned());
        assert_eq!(frames.len(), 1000, "one frame each millisecond");
        assert_eq!(assembler.counters().late, late);
        let is_whole = |(ms, frame): (u16, &Shown)| frame.samples == [f32::from(ms); 3];
        let missed = (0..).zip(&frames).filter(|&frame| !is_whole(frame)).count();
        assert_eq!(missed as u64, late, "frames without that board's own sample");
    }
}
