//! Position errors of feet: a table for people of several kinds, Eq. 4 beside the tracker.

use crate::sense_support::{Scene, Score, Sensors, quantile, stand, tap, walk};
use underfoot::sense::Method;

const SEEDS: std::ops::Range<u64> = 0..20;

fn scores(make: fn(u64, Sensors) -> Scene, sensors: Sensors) -> (Score, Score) {
    let (mut eq4, mut tracker) = (Score::default(), Score::default());
    for seed in SEEDS {
        let scene = make(seed, sensors);
        eq4.add(&scene, Method::Eq4);
        tracker.add(&scene, Method::Tracker);
    }
    (eq4, tracker)
}

fn table(make: fn(u64, Sensors) -> Scene) -> (String, Score) {
    let (eq4, tracker) = scores(make, Sensors::CALIBRATED);
    (format!("{}\n{}\n{}", Score::HEAD, eq4.line("Eq. 4"), tracker.line("tracker")), tracker)
}

#[test]
fn walkers_of_all_speeds() {
    let (table, tracker) = table(walk);
    println!("{table}");
    insta::assert_snapshot!("walkers", table);
    assert!(quantile(&tracker.two, 0.5) < 1.5 && quantile(&tracker.two, 0.95) < 5.0);
    assert!(tracker.id_changes * 1000 <= tracker.steps);
    let inside = tracker.inside_ellipse as f32 / tracker.matched as f32;
    assert!((0.93..=0.998).contains(&inside), "{inside} of the true points lie in the 95 % ellipse");
}

#[test]
fn standers_15_to_60_cm_apart() {
    let (table, tracker) = table(stand);
    println!("{table}");
    insta::assert_snapshot!("standers", table);
    assert!(quantile(&tracker.two, 0.5) < 1.5);
}

#[test]
fn light_taps_beside_a_heavy_stance_foot() {
    let (table, tracker) = table(tap);
    println!("{table}");
    insta::assert_snapshot!("taps", table);
    assert!(quantile(&tracker.lighter, 0.5) < 1.0 && quantile(&tracker.lighter, 0.95) < 2.5);
}
