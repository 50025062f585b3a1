//! Single feet that are reported as two: the contact that is no foot is marked, and no guarded control acts on it.

use std::time::Duration;

use glam::Vec2;
use underfoot::floor::Geometry;
use underfoot::sense::{Contact, Method, TileLoad};
use underfoot::units::Instant;
use underfoot_lab::experiment::{DrawnVisit, Rig};
use underfoot_sim::{FloorQuality, Load};

/// Force of a foot that stands alone, and the most that another may carry meanwhile, in newtons.
const ALONE_N: f32 = 400.0;
const GONE_N: f32 = 5.0;

/// Force from which a second contact would press most controls.
const HEAVY_N: f32 = 100.0;

/// Time for which the other foot must be gone: one that lifts is reported for some milliseconds more.
const GONE_FOR_MS: u64 = 50;

/// The contacts beside that of the foot while a person of this number stands on one foot, as `(marked, unmarked)`
/// milliseconds.
fn second_contacts(quality: FloorQuality, person: u64) -> (u64, u64) {
    let geometry = Geometry::default();
    let mut rig = Rig::of_quality(geometry, quality, person).unwrap();
    let visit = if quality.is_real() {
        DrawnVisit::rolling_as_people_do(person, &geometry)
    } else {
        DrawnVisit::of(person, &geometry)
    };
    let visit = visit.unwrap();
    let mut sensing = rig.sensing(Method::Tracker);
    let (mut loads, mut alone_ms): (Vec<Load>, u64) = (Vec::new(), 0);
    let (mut marked, mut unmarked) = (0, 0);
    for milli in 1..=visit.script().duration().as_millis() as u64 {
        loads.clear();
        visit.script().loads_at(Instant::START + Duration::from_millis(milli), &mut loads);
        let carried = |load: &Load| rig.carried(load);
        let force = |tiles: &[TileLoad]| tiles.iter().map(|tile| tile.force.0).sum::<f32>();
        let tiles: Vec<_> = loads.iter().map(carried).collect();
        let mut forces: Vec<f32> = tiles.iter().map(|tiles| force(tiles)).collect();
        let heaviest = tiles.iter().max_by(|a, b| force(a).total_cmp(&force(b)));
        let moment: Vec2 = heaviest.iter().copied().flatten().map(|tile| tile.centroid * tile.force.0).sum();
        let foot = moment / forces.iter().copied().fold(1.0, f32::max);
        forces.sort_by(|a, b| b.total_cmp(a));
        let is_alone = forces.first().is_some_and(|first| *first > ALONE_N)
            && forces.get(1).is_none_or(|second| *second < GONE_N);
        alone_ms = if is_alone { alone_ms + 1 } else { 0 };
        rig.step(loads.iter().copied(), |frame| {
            let contacts = sensing.update(frame);
            let mut heavy: Vec<&Contact> =
                contacts.iter().filter(|contact| contact.force.0 > HEAVY_N).collect();
            let off = |contact: &Contact| contact.centroid.distance(foot);
            heavy.sort_by(|a, b| off(a).total_cmp(&off(b)));
            if alone_ms > GONE_FOR_MS && heavy.len() > 1 {
                let is_marked = heavy.iter().skip(1).all(|contact| contact.split && contact.ambiguous);
                *if is_marked { &mut marked } else { &mut unmarked } += 1;
            }
        });
    }
    (marked, unmarked)
}

#[test]
fn most_contacts_beside_a_single_foot_are_marked() {
    // On floors with worn sensors this person turns on one foot that is reported as two for seconds: the sensors cannot
    // tell a long foot from two round ones.
    for quality in [FloorQuality::Slight, FloorQuality::Moderate] {
        let (marked, unmarked) = second_contacts(quality, 5);
        assert!(marked > 500, "{quality}: a single foot is never reported as two: this test proves nothing");
        assert!(
            5 * unmarked < 2 * (marked + unmarked),
            "{quality}: {marked} ms marked, {unmarked} ms unmarked"
        );
    }
}
