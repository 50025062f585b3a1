//! Feet on the shipped pond.

use crate::support::{Walker, layout, page};
use underfoot::engine::Snapshot;
use underfoot::glam::Vec2;
use underfoot::ground::GroundState;
use underfoot::units::Newtons;
use underfoot_lab::experiment::{PondWalk, WalkManner};

/// One foot of 70 kg.
const WEIGHT: Newtons = Newtons(690.0);

fn ground(walker: &Walker) -> GroundState {
    let mut snapshot = Snapshot::default();
    walker.engine.snapshot(&mut snapshot);
    snapshot.grounds.swap_remove(0)
}

/// Three steps over the pond, each with its full force within 40 ms.
fn walk(walker: &mut Walker) {
    for place in [Vec2::new(0.4, 0.5), Vec2::new(0.9, 0.9), Vec2::new(1.3, 1.4)] {
        walker.step_at(place, WEIGHT);
        walker.wait(200);
        walker.lift();
        walker.wait(150);
    }
}

#[test]
fn the_same_walk_gives_the_same_pond_and_another_seed_another() {
    let pond = |seed: &str| {
        let mut walker = Walker::on(page(&format!("Layout(version: 1, grounds: [Ice(seed: {seed})])")));
        walk(&mut walker);
        (ground(&walker), walker.take_cues())
    };
    let (first, again, other) = (pond("7"), pond("7"), pond("8"));
    assert!(first.0.cracks.len() > 20, "{}", first.0.cracks.len());
    assert_eq!(first, again, "cracks and cues, to the bit");
    assert_ne!(first.0.cracks, other.0.cracks);
}

/// 25 steps of each manner, on floors of the paper's parts.
#[test]
fn careful_walking_cracks_at_most_a_third_of_what_stamping_does() {
    let walk = PondWalk::measure(3, 25).unwrap();
    println!("{walk}");
    let line = |manner| walk.line(manner).unwrap();
    let (stamping, walking) = (line(WalkManner::Stamping), line(WalkManner::Walking));
    for manner in [WalkManner::Careful, WalkManner::Lighter] {
        assert!(line(manner).share <= 1.0 / 3.0, "{manner:?}: {}", line(manner).share);
    }
    // A slower rise to the same load cracks less too, and walking is audible.
    assert!(line(WalkManner::Slower).share < 0.8, "{}", line(WalkManner::Slower).share);
    assert!(walking.events_per_step > 2.0 && walking.share < 0.5, "{walking:?}");
    assert!(stamping.events_per_step > 20.0, "{stamping:?}");
    let ratio = line(WalkManner::Careful).rate_per_s / walking.rate_per_s;
    assert!((ratio - 0.6).abs() < 0.01, "{ratio}");
}

#[test]
fn each_crack_is_felt_under_the_foot_at_its_own_time() {
    let mut walker = Walker::on(layout("pond"));
    // A stamp across the seam of two tiles: both are under the foot.
    walker.step_at(Vec2::new(0.608, 0.75), Newtons(1400.0));
    walker.wait(100);
    let cues = walker.take_cues();
    let state = ground(&walker);
    assert!(cues.len() as u64 == state.counters.events && cues.len() > 10, "{}", cues.len());
    let levels: Vec<f32> = cues.iter().map(|cue| cue.click.level.0).collect();
    assert!(levels.iter().all(|level| (0.0..=16.0).contains(level)));
    assert!(cues.windows(2).all(|pair| pair[0].at <= pair[1].at), "in order of time");
    let within: Vec<u64> = cues.iter().map(|cue| cue.at.micros() % 1000).collect();
    assert!(within.iter().collect::<std::collections::BTreeSet<_>>().len() > cues.len() / 2, "{within:?}");
    assert!(cues.iter().any(|cue| cue.spots.len() >= 2), "shared by Eq. 4's weights");
    for cue in &cues {
        let whole: f32 = cue.spots.iter().map(|spot| spot.weight).sum();
        assert!((whole - 1.0).abs() < 1e-4);
        assert!(cue.spots.iter().all(|spot| [1, 2].contains(&(spot.tile % 6))), "{:?}", cue.spots);
        let modes = &cue.click.modes;
        assert!(modes.len() == 6 && modes.iter().all(|mode| (70.0..=720.0).contains(&mode.frequency_hz)));
    }
    // The cracks lie at the foot.
    assert!(state.seeds.iter().all(|seed| seed.at.distance(Vec2::new(0.608, 0.75)) < 0.12));
}

#[test]
fn standing_shifting_and_leaving_crack_nothing() {
    let mut walker = Walker::on(layout("pond"));
    walker.step_at(Vec2::new(0.9, 0.9), Newtons(200.0));
    walker.wait(300);
    let before = ground(&walker).counters.events;
    walker.wait(2000);
    walker.leave_floor(100);
    walker.wait(500);
    assert_eq!(ground(&walker).counters.events, before);
}

/// A load that is present when the floor comes back is not a stamp.
#[test]
fn a_floor_that_was_lost_and_comes_back_under_a_foot_does_not_crack() {
    let mut walker = Walker::on(layout("pond"));
    walker.step_at(Vec2::new(0.9, 0.9), WEIGHT);
    walker.wait(500);
    let before = ground(&walker).counters.events;
    for gap in [5, 60, 150, 700] {
        walker.connected = false;
        walker.wait(gap);
        walker.connected = true;
        walker.wait(300);
        assert_eq!(ground(&walker).counters.events, before, "after {gap} ms without packets");
    }
}

/// Ice in a layout that arrives under a standing person starts under load.
#[test]
fn ice_laid_under_a_standing_foot_is_whole_and_edited_ice_keeps_its_cracks() {
    let text = |title: &str, seed: u32| {
        page(&format!("Layout(version: 1, title: \"{title}\", grounds: [Ice(seed: {seed})])"))
    };
    let mut walker = Walker::on(text("one", 1));
    walk(&mut walker);
    let before = ground(&walker);
    walker.engine.set_layout(text("two", 1));
    walker.wait(10);
    assert_eq!(ground(&walker).cracks, before.cracks, "the same ice under another title");
    walker.step_at(Vec2::new(0.9, 0.9), WEIGHT);
    walker.wait(300);
    walker.engine.set_layout(text("three", 2));
    walker.wait(300);
    assert_eq!(ground(&walker).counters.events, 0, "new ice was laid under the foot");
}
