//! Sensing is deterministic, and survives nonsense.

use crate::sense_support::{Scene, Sensors, stand, walk};
use proptest::prelude::*;
use underfoot::floor::Geometry;
use underfoot::sense::{Contact, ForceFrame, Method, Quality, Sensing};
use underfoot::units::Instant;

fn run(scene: &Scene, method: Method) -> Vec<Vec<Contact>> {
    let mut sensing = Sensing::new(scene.geometry, method);
    scene.frames.iter().map(|frame| sensing.update(frame).to_vec()).collect()
}

#[test]
fn the_same_frames_give_the_same_contacts_to_the_bit() {
    let scene = walk(3, Sensors::CALIBRATED);
    for method in [Method::Eq4, Method::Tracker] {
        assert!(run(&scene, method) == run(&scene, method), "{method:?}");
    }
}

#[test]
fn a_person_seen_with_a_dead_sensor_is_degraded_and_still_found() {
    let mut scene = stand(3, Sensors::PERFECT);
    let loaded = (0..scene.geometry.tile_count())
        .max_by(|&a, &b| {
            let force = |tile: usize| scene.frames[3000].forces[tile].iter().sum::<f32>();
            force(a).total_cmp(&force(b))
        })
        .unwrap();
    for frame in &mut scene.frames {
        frame.quality[loaded][2] = Quality::Faulty;
        frame.forces[loaded][2] = 0.0;
    }
    let seen = run(&scene, Method::Tracker);
    assert_eq!(seen[3000].len(), 2);
    assert!(seen[3000].iter().any(|contact| contact.quality == Quality::Degraded));
    for foot in &scene.truth[3000] {
        let nearest = seen[3000].iter().map(|contact| contact.centroid.distance(foot.centre));
        // A rigid plate's fourth corner can be estimated only if the plate rests evenly on all four.
        assert!(nearest.fold(f32::INFINITY, f32::min) < 0.05, "{:?}", seen[3000]);
    }
}

fn any_force() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => -5.0..400.0_f32,
        3 => Just(0.0),
        1 => prop_oneof![Just(f32::NAN), Just(f32::INFINITY), Just(1e38), Just(-1e38), Just(1e-40)],
    ]
}

fn any_quality() -> impl Strategy<Value = Quality> {
    prop_oneof![
        12 => Just(Quality::Live),
        1 => Just(Quality::Degraded),
        1 => Just(Quality::Stale),
        1 => Just(Quality::Faulty),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_frame_breaks_it(
        frames in proptest::collection::vec(
            (
                proptest::collection::vec(proptest::array::uniform4(any_force()), 16),
                proptest::collection::vec(proptest::array::uniform4(any_quality()), 16),
                0..50_000_u64,
                1..8_u8,
            ),
            1..30,
        ),
    ) {
        let geometry = Geometry::of_paper_tiles(4, 4).unwrap();
        for method in [Method::Eq4, Method::Tracker] {
            let mut sensing = Sensing::new(geometry, method);
            let mut frame = ForceFrame::empty(&geometry);
            let mut micros = 0;
            for (forces, quality, gap, repeats) in &frames {
                frame.forces.clone_from(forces);
                frame.quality.clone_from(quality);
                for _ in 0..*repeats {
                    // Gaps from zero to 50 ms occur.
                    micros += gap;
                    frame.at = Instant::from_micros(micros);
                    let contacts = sensing.update(&frame);
                    prop_assert!(contacts.is_sorted_by(|a, b| a.id < b.id));
                    for contact in contacts {
                        prop_assert!(contact.centroid.is_finite(), "{contact:?}");
                        prop_assert!(contact.force.is_finite() && contact.force.0 >= 0.0, "{contact:?}");
                        prop_assert!(contact.velocity.is_finite(), "{contact:?}");
                        prop_assert!(contact.covariance.xx.is_finite(), "{contact:?}");
                        prop_assert!(!contact.tiles.is_empty(), "{contact:?}");
                        prop_assert!(contact.quality <= Quality::Degraded, "{contact:?}");
                    }
                }
            }
        }
    }
}
