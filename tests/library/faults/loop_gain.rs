//! S8 the actuator's force on the sensors beside it.

use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::{Floor, Geometry};
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::widget::EventKind;
use underfoot_sim::SimulatedSensors;

use super::bench::{BUTTON, Bench};

const RATE: usize = 48_000;

/// Plays the session's cues into the sensors of each tile, with `share` of the actuator's force on every one.
fn session(share: f32) -> (Vec<EventKind>, usize, f32) {
    let floor = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    let mut bench = Bench::new(SimulatedSensors::Newtons(Default::default()));
    let (mut sender, renderer) = renderer(RendererConfig::of(&floor, RATE as u32));
    let mut sink = ManualSink::new(renderer, bench.now());
    let mut peak: f32 = 0.0;
    let mut sent = 0;
    let steps: [(u64, f32); 4] = [(500, 0.0), (400, 75.0), (600, 0.0), (1500, 0.0)];
    for (millis, force) in steps {
        let before = bench.feet.first().map_or(0.0, |foot| foot.force.0);
        for ms in 0..millis {
            let risen = (ms as f32 / 40.0).min(1.0);
            bench.feet = vec![super::bench::foot(BUTTON, before + (force - before) * risen)];
            // The actuators' samples in the last millisecond; each sensor reads the last one.
            sink.advance(bench.now()).unwrap();
            let coupled: Vec<f32> =
                (0..4).map(|tile| sink.channel(tile).last().copied().unwrap_or(0.0) * 40.0 * share).collect();
            peak = peak.max(coupled.iter().fold(0.0, |most, force| force.abs().max(most)));
            bench.run_with(1, |_, (board, at), force| *force += coupled[board * 2 + at / 4]);
            for cue in &bench.cues[sent..] {
                sender.send(cue);
            }
            sent = bench.cues.len();
        }
    }
    (bench.events, sent, peak)
}

#[test]
fn s8_a_click_that_couples_into_its_own_sensors_triggers_nothing() {
    let alone = session(0.0);
    let one_click = vec![EventKind::Pressed, EventKind::Released, EventKind::Clicked];
    assert_eq!(alone.0, one_click);
    let coupled = session(0.1);
    assert!(coupled.2 > 0.2, "or nothing is shown: {} N per sensor", coupled.2);
    println!("the click puts {} N on each sensor of its tile", coupled.2);
    assert_eq!((coupled.0, coupled.1), (alone.0, alone.1), "no event and no cue of its own");
}
