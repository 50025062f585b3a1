//! S7 hum and noise, for ten minutes.

use std::f32::consts::TAU;

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::sense::Quality;
use underfoot::sim::Sensing;
use underfoot::widget::EventKind;

use crate::bench::{BUTTON, Bench};

#[test]
fn s7_hum_and_noise_make_no_event_in_ten_minutes() {
    for (mains_hz, seed) in [(50.0, 1), (60.0, 2)] {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut bench = Bench::new(Sensing::Newtons(Default::default()));
        // Hum that all sensors share, which is the worst case, and noise of their own: 5 N together.
        let mut noise = move |ms: u64, _: (usize, usize), force: &mut f32| {
            let phase = (TAU * mains_hz * (ms % 1000) as f32 / 1000.0).sin();
            *force += 4.0 * phase + rng.random_range(-1.0..=1.0f32);
        };
        bench.run_with(150_000, &mut noise);
        assert_eq!(bench.events, [], "nobody there, {mains_hz} Hz");
        bench.press(BUTTON, 100.0);
        bench.run_with(150_000, &mut noise);
        assert_eq!(bench.events, [EventKind::Pressed], "a foot that stays, {mains_hz} Hz");
        bench.lift(BUTTON);
        bench.run(100);
        assert_eq!(bench.events, [EventKind::Pressed, EventKind::Released, EventKind::Clicked]);
    }
}

#[test]
fn s7_a_noisy_sensor_is_named() {
    let mut bench = Bench::new(Sensing::Newtons(Default::default()));
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever boards send, forces stay finite, a broken sensor is not trusted within half a
    /// second again, and nothing is pressed by a sensor alone.
    #[test]
    fn whatever_comes_forces_stay_finite_and_quality_needs_evidence(
        sent in prop::collection::vec((0usize..4, prop::num::f32::ANY, 1u64..400), 1..20),
    ) {
        let mut bench = Bench::new(Sensing::Newtons(Default::default()));
        let mut faulty_until = 0;
        let mut clock = 0;
        for (channel, value, millis) in sent {
            for _ in 0..millis {
                bench.run_with(1, |_, (board, at), force| if board == 0 && at == channel { *force = value });
                clock += 1;
                let tile = &bench.snapshot().tiles[0];
                prop_assert!(tile.forces.iter().all(|force| force.is_finite()));
                let stuck_at = bench.assembler.troubles().any(|(_, trouble)| trouble == underfoot::sense::Trouble::Offset);
                if stuck_at {
                    faulty_until = clock + 500;
                } else if clock < faulty_until {
                    prop_assert!(tile.quality.iter().any(|&quality| quality > Quality::Live));
                }
            }
        }
        prop_assert_eq!(&bench.events, &[]);
    }
}
