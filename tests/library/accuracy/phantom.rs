//! Exploration: single feet that are reported as two.
use std::time::Duration;
use underfoot::floor::Geometry;
use underfoot::sense::Method;
use underfoot::units::Instant;
use underfoot_lab::experiment::{Rig, Visit};
use underfoot_sim::{FloorQuality, Load};

#[test]
#[ignore = "exploration"]
fn explore() {
    let people: u64 = std::env::var("PEOPLE").ok().and_then(|n| n.parse().ok()).unwrap_or(20);
    for quality in [FloorQuality::Ideal, FloorQuality::Paper, FloorQuality::Slight, FloorQuality::Moderate] {
        let (mut runs, mut unmarked, mut marked, mut split, mut single) = (0, 0, 0, 0, 0);
        let mut least = [0_u32; 6];
        for seed in 0..people {
            let geometry = Geometry::default();
            let mut rig = Rig::of_quality(geometry, quality, seed).unwrap();
            let visit = if quality.is_real() {
                Visit::rolling_as_people_do(seed, &geometry)
            } else {
                Visit::of(seed, &geometry)
            }
            .unwrap();
            let mut sensing = rig.sensing(Method::Tracker);
            let mut loads: Vec<Load> = Vec::new();
            let mut before = false;
            for milli in 1..=visit.script().duration().as_millis() as u64 {
                loads.clear();
                visit.script().loads_at(Instant::START + Duration::from_millis(milli), &mut loads);
                let mut forces: Vec<f32> =
                    loads.iter().map(|l| rig.carried(l).iter().map(|t| t.force.0).sum()).collect();
                forces.sort_by(|a, b| b.total_cmp(a));
                let one =
                    forces.first().is_some_and(|f| *f > 400.0) && forces.get(1).is_none_or(|f| *f < 5.0);
                let truth: Vec<_> = loads.iter().map(|l| (l.position, l.force)).collect();
                rig.step(loads.iter().copied(), |frame| {
                    let contacts = sensing.update(frame);
                    let heavy: Vec<_> = contacts.iter().filter(|c| c.force.0 > 60.0).collect();
                    if one {
                        single += 1;
                    }
                    let two = one && heavy.len() > 1;
                    if two {
                        split += 1;
                        let young = heavy.iter().max_by_key(|c| c.id).unwrap();
                        if young.ambiguous {
                            marked += 1
                        } else {
                            unmarked += 1
                        }
                        least[(heavy.iter().filter(|c| c.ambiguous).count()).min(5)] += 1;
                        if !before {
                            runs += 1;
                            eprintln!("{quality} {seed} {milli} true {truth:?}");
                            for c in &contacts[..] {
                                eprintln!(
                                    "     {:?} {:.0} N at {} amb {} split {} tiles {:?}",
                                    c.id,
                                    c.force.0,
                                    c.centroid,
                                    c.ambiguous,
                                    "?",
                                    c.tiles
                                        .iter()
                                        .map(|t| (t.tile.to_string(), t.force.0.round()))
                                        .collect::<Vec<_>>()
                                );
                            }
                        }
                    }
                    before = two;
                });
            }
        }
        println!(
            "{quality}: {single} single-foot ms, {split} ms split in {runs} runs; youngest marked {marked}, unmarked {unmarked}; ambiguous among {least:?}"
        );
    }
}
