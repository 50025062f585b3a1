//! S7 hum and noise, for ten minutes.

use std::f32::consts::TAU;

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::sense::Quality;
use underfoot::widget::EventKind;
use underfoot_sim::{PartConfig, SimulatedSensors};

use super::bench::{BUTTON, Bench};

#[test]
fn s7_hum_and_noise_make_no_event_in_ten_minutes() {
    for (mains_hz, seed) in [(50.0, 1), (60.0, 2)] {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut bench = Bench::new(SimulatedSensors::Newtons(Default::default()));
        // Hum that all sensors share, which is the worst case, and independent noise: 5 N together.
        let mut noise = move |ms: u64, _: (usize, usize), force: &mut f32| {
            let phase = (TAU * mains_hz * (ms % 1000) as f32 / 1000.0).sin();
            *force += 4.0 * phase + rng.random_range(-1.0..=1.0f32);
        };
        bench.run_with(150_000, &mut noise);
        assert_eq!(bench.events, [], "nobody there, {mains_hz} Hz");
        bench.press(BUTTON, 100.0);
        bench.stay(BUTTON, 100.0, 150, &mut noise);
        assert_eq!(bench.events, [EventKind::Pressed], "a foot that stays, {mains_hz} Hz");
        bench.lift(BUTTON);
        bench.run(100);
        assert_eq!(bench.events, [EventKind::Pressed, EventKind::Released, EventKind::Clicked]);
    }
}

#[test]
fn s7_a_noisy_sensor_is_named() {
    let mut bench = Bench::new(SimulatedSensors::Newtons(Default::default()));
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    bench.run_with(10_000, |_, channel, force| {
        if channel == (0, 0) {
            *force += rng.random_range(-5.0..=5.0f32);
        }
    });
    let found: Vec<_> = bench.assembler.troubles().map(|(_, trouble)| trouble).collect();
    assert_eq!(found, [underfoot::sense::Trouble::Noisy]);
    assert_eq!(bench.events, []);
}

/// A quarter of a second of right readings does not count once nonsense has come: here an impossible force, a strange
/// load, and readings that are not numbers, 0.2 s in all.
#[test]
fn right_readings_before_nonsense_are_no_evidence() {
    let mut bench = Bench::new(SimulatedSensors::Newtons(PartConfig::default()));
    for (value, millis) in [(-87.0, 1), (0.0, 272), (3.7e25, 79), (-90.0, 34), (f32::NAN, 162), (0.0, 800)] {
        bench.run_with(millis, |_, channel, force| {
            if channel == (0, 0) {
                *force = value;
            }
        });
    }
    assert!(bench.snapshot().tiles[0].quality[0] >= Quality::Degraded, "0.8 s of evidence");
    bench.run_with(400, |_, channel, force| {
        if channel == (0, 0) {
            *force = 0.0;
        }
    });
    assert_eq!(bench.snapshot().tiles[0].quality[0], Quality::Live);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// For any readings of one sensor, forces stay finite, they cause no press, and the sensor's quality recovers
    /// only after a second without nonsense.
    #[test]
    fn whatever_comes_forces_stay_finite_and_quality_needs_evidence(
        sent in prop::collection::vec(
            (prop_oneof![prop::num::f32::ANY, -300.0f32..300.0, Just(0.0f32)], 1u64..900),
            1..20,
        ),
    ) {
        let mut bench = Bench::new(SimulatedSensors::Newtons(PartConfig::default()));
        bench.hasten();
        let (mut nonsense_ms, mut clock_ms, mut worst) = (0, 0, Quality::Live);
        for (value, millis) in sent {
            for _ in 0..millis {
                bench.run_with(1, |_, channel, force| if channel == (0, 0) { *force = value });
                clock_ms += 1;
                let tile = bench.snapshot().tiles[0];
                prop_assert!(tile.forces.iter().all(|force| force.is_finite()));
                if tile.forces[0].abs() > 10.0 {
                    nonsense_ms = clock_ms;
                }
                let improved = tile.quality[0] < worst && value.is_finite() && bench.assembler.troubles().next().is_none();
                // A reading that is not a number marks one frame only.
                let was_found = worst == Quality::Degraded;
                prop_assert!(!(improved && was_found) || clock_ms - nonsense_ms > 900);
                worst = tile.quality[0];
            }
        }
        prop_assert_eq!(&bench.events, &[]);
    }
}
