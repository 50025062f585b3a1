//! Position errors of people's feet: a small table as a snapshot, compared with the goals.
//!
//! `underfoot experiment feet --people 100 --quality paper` makes the same table of more people.

use std::time::Duration;

use underfoot::floor::Geometry;
use underfoot::glam::Vec2;
use underfoot::sense::{Contact, Method};
use underfoot::units::Instant;
use underfoot_lab::experiment::{Followed, PeopleTable, Rig};
use underfoot_sim::{Foot, Performance, Person, Script};

#[test]
fn both_feet_of_people_who_walk_turn_and_stand() {
    let mut table = PeopleTable::default();
    (1..=8).for_each(|seed| table.add_person(seed).unwrap());
    println!("{table}");
    insta::assert_snapshot!(table);
    let [eq4, tracker] = [0, 1].map(|method| table.whole(method));
    let median = |followed: &Followed| followed.two_feet.quantile(0.5).unwrap();
    assert!(median(&tracker) < 0.015, "{} m", median(&tracker));
    // The goals: 5 cm for 95 of 100 feet, and hardly any foot that changes its number: splitting one foot in two once
    // made 300 swaps per 1000 steps, and the 195 steps of these 8 people see a few.
    let most = tracker.two_feet.quantile(0.95).unwrap();
    assert!(most < 0.05, "{most} m");
    assert!(tracker.swaps <= 4, "{} swaps", tracker.swaps);
    assert!(tracker.share_within_5cm() > 3.0 * eq4.share_within_5cm(), "both feet are told apart");
}

#[test]
fn people_whose_feet_once_changed_their_names() {
    // Each made 3 to 46 changes, one false foot causing the next, until the error was fixed.
    let mut swaps = 0;
    for (seed, why) in [
        (40_246, "118 kg on one tile: a sensor near its end reads a fifth too much"),
        (60_166, "108 kg, 16 cm apart: in 120 ms the weight goes over to a foot on the same tile"),
        (72_159, "of a foot that has left, the rim of the other one is taken for the rest"),
        (
            33_043,
            "103 kg: the second foot draws the first one's farthest place along, as if it were rolling there",
        ),
        (
            72_046,
            "the second foot draws the first one's centre along, as if it pressed where that comes down",
        ),
        (60_029, "the last weight of the partner beside it was taken for the roll of the foot it left"),
    ] {
        let mut table = PeopleTable::default();
        table.add_person(seed).unwrap();
        println!("{} swaps of person {seed}: {why}", table.whole(1).swaps);
        swaps += table.whole(1).swaps;
    }
    // Three to 46 each before; the rest are pairs on one saturated sensor that count as one foot.
    assert!(swaps <= 60, "{swaps} swaps");
}

#[test]
fn both_feet_of_people_who_arrive_and_stand_narrowly() {
    // 16 to 21 cm apart both feet are often on one tile: only the transfer of weight reveals the second one.
    let (mut found, mut all) = (0, 0);
    for seed in 1..=6_u8 {
        let mut rig = Rig::of_calibrated_parts(Geometry::default(), seed.into()).unwrap();
        let bounds = rig.geometry().bounds();
        let person = Person { stand_width_m: 0.15 + 0.01 * f32::from(seed), ..Person::default() };
        let mut somebody = Performance::new(person, seed.into());
        let goal = bounds.centre() + Vec2::new(0.07, 0.05) * f32::from(seed) - 0.2;
        somebody.appear(goal - Vec2::new(0.0, 1.8), 0.0).unwrap();
        somebody.walk(&[goal]).unwrap();
        somebody.wait(Duration::from_millis(500));
        let script = Script::new(vec![somebody], bounds);
        let mut sensing = rig.sensing_without_maps(Method::Tracker);
        let end = script.duration().as_millis() as u64;
        let mut feet: Vec<Foot> = Vec::new();
        for milli in 1..=end {
            feet.clear();
            script.feet_at(Instant::from_millis(milli), &mut feet);
            rig.step(feet.iter().map(Foot::as_load), |frame| {
                let contacts = sensing.update(frame);
                // A foot that has stood for some time: one contact for both feet is at least 8 cm from either.
                for foot in feet.iter().filter(|_| milli + 400 > end) {
                    all += 1;
                    found += usize::from(contacts.iter().any(|contact| near(contact, foot)));
                }
            });
        }
    }
    println!("{found} of {all} feet within 5 cm");
    assert!(all > 4000 && found * 10 > 6 * all, "{found} of {all} feet within 5 cm");
}

fn near(contact: &Contact, foot: &Foot) -> bool {
    contact.centroid.distance(foot.centre_of_pressure()) < 0.05
}
