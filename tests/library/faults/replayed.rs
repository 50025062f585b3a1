//! P9 packets of an earlier press are sent again, beside those of the floor.

use std::time::Duration;

use underfoot::units::Instant;
use underfoot::wire::SensorPacket;

use super::bench::{Bench, foot};
use underfoot::glam::Vec2;
use underfoot_sim::SimConfig;

/// The packets of boards during a press, repeated on an empty floor, at any pace.
#[test]
fn p9_an_old_press_that_is_sent_again_presses_nothing() {
    for every in [1, 2, 5] {
        let mut bench = Bench::new(SimConfig::default().sensing);
        let mut captured: Vec<SensorPacket> = Vec::new();
        let mut ms = 200_u32;
        let feed = |bench: &mut Bench, packets: &[SensorPacket]| {
            packets.iter().for_each(|packet| bench.assembler.take(packet));
            while let Some(frame) = bench.assembler.ready() {
                bench.events.extend(bench.engine.step(frame).events.iter().map(|event| event.kind));
            }
        };
        let pressing = [foot(Vec2::new(0.15, 0.15), 200.0)];
        for time in 0..4000_u32 {
            ms += 1;
            let received = Instant::START + Duration::from_millis(ms.into());
            let is_pressed = (500..900).contains(&time);
            let readings = bench.sim.step(if is_pressed { &pressing } else { &[] }).to_vec();
            let live: Vec<_> = (0..)
                .zip(readings)
                .map(|(board, readings)| SensorPacket { board, sequence: ms, received, readings })
                .collect();
            if is_pressed {
                captured.extend(live.iter().cloned());
            }
            feed(&mut bench, &live);
            // Later, all captured packets, in order, beside the live ones.
            if time == 1500 {
                assert!(!bench.events.is_empty(), "it was pressed");
                bench.events.clear();
            }
            if time > 1500 && time % every == 0 {
                let boards = bench.sim.readings().len();
                let at = ((time - 1500) / every) as usize * boards % captured.len();
                let old: Vec<_> = captured[at..(at + boards).min(captured.len())]
                    .iter()
                    .map(|packet| SensorPacket { received, ..packet.clone() })
                    .collect();
                feed(&mut bench, &old);
            }
        }
        assert_eq!(bench.events, [], "every {every} ms");
        let counters = bench.assembler.counters();
        assert!(counters.late + counters.duplicate + counters.out_of_order > 100, "{counters:?}");
    }
}
