//! Reordered, duplicated and invented streams.

use proptest::prelude::*;

use super::*;

/// 300 ms of three boards; after the first 30 ms each packet is displaced by up to `reach` places.
fn displaced(reach: usize) -> impl Strategy<Value = Vec<SensorPacket>> {
    let count = 300 * usize::from(BOARDS);
    prop::collection::vec(0..=reach, count).prop_map(|places| {
        let mut packets: Vec<_> = places.into_iter().zip(steady(0, 300)).enumerate().collect();
        packets.sort_by_key(|(index, (displacement, _))| index + if *index < 90 { 0 } else { *displacement });
        let mut now = Instant::START;
        let in_order = packets.into_iter().map(|(_, (_, packet))| {
            now = now.max(packet.received);
            SensorPacket { received: now, ..packet }
        });
        in_order.collect()
    })
}

/// The samples of the frames in order, and the packets that the assembler used for them.
fn used(packets: &[SensorPacket]) -> (Vec<[f32; 3]>, Vec<SensorPacket>) {
    let mut assembler = assembler();
    let mut frames = Vec::new();
    let mut used = Vec::new();
    for packet in packets {
        let before = assembler.counters().packets;
        assembler.take(packet);
        if assembler.counters().packets > before {
            used.push(packet.clone());
        }
        drain(&mut assembler, &mut frames);
    }
    frames.extend(poll(&mut assembler, 10_000).first());
    (frames.iter().map(|frame| frame.samples).collect(), used)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    // N4
    #[test]
    fn packets_out_of_order_give_the_frames_of_those_in_time_put_in_order(packets in displaced(10)) {
        let (frames, mut kept) = used(&packets);
        kept.sort_by_key(|packet| (packet.sequence, packet.board));
        let mut now = Instant::START;
        for packet in &mut kept {
            now = now.max(packet.received);
            packet.received = now;
        }
        let (in_order, all) = used(&kept);
        prop_assert_eq!(all.len(), kept.len());
        prop_assert_eq!(frames, in_order);
    }

    // N5
    #[test]
    fn packets_that_come_up_to_ten_times_count_once(copies in prop::collection::vec(1usize..=10, 600)) {
        let once: Vec<_> = steady(0, 200).collect();
        let again = copies.iter().zip(&once).flat_map(|(&copies, packet)| vec![packet.clone(); copies]);
        let expected = feed(&mut assembler(), once.clone());
        let mut assembler = assembler();
        prop_assert_eq!(feed(&mut assembler, again), expected);
        prop_assert_eq!(assembler.counters().duplicate, copies.iter().map(|&n| n as u64 - 1).sum::<u64>());
    }

    // P7
    #[test]
    fn whatever_comes_time_runs_forward_and_forces_stay_finite(
        packets in prop::collection::vec((0u16..4, any::<u32>(), 0u64..500_000, any::<f32>(), any::<bool>()), 1..400),
    ) {
        let mut assembler = assembler();
        let mut near = [0u32; 4];
        let mut last = None;
        for (board, number, received_us, force, in_line) in packets {
            let slot = usize::from(board);
            near[slot] = if in_line { near[slot].wrapping_add(1 + number % 3) } else { number };
            let readings = Readings::Newtons([force; 8].into_iter().collect());
            assembler.take(&SensorPacket { readings, ..at_us(board, near[slot], received_us) });
            assembler.poll(Instant::from_micros(received_us));
            while let Some(frame) = assembler.ready() {
                prop_assert!(last < Some(frame.at));
                prop_assert!(frame.forces.iter().flatten().all(|force| force.is_finite()));
                last = Some(frame.at);
            }
        }
    }
}
