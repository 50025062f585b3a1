//! Recorded feet against those that were there, in bytes and back, damaged, and taken over.

use std::sync::LazyLock;

use proptest::prelude::*;

use super::*;
use crate::track::turn_between;
use crate::{Performance, Person, Scenario, Script, feet_by_hand, visit};
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};

fn shipped(name: &str) -> Layout {
    let text = builtin_layout(name).unwrap();
    parse_layout(text, name, &Kinds::builtin(), &Geometry::default()).unwrap().layout
}

fn session() -> Script {
    let session = Scenario::parse("session", Scenario::SESSION).unwrap();
    session.resolve(&shipped("map"), &Geometry::default()).unwrap()
}

/// The foot of `feet` that is nearest to `foot`, of the same side.
fn nearest(feet: &[Foot], foot: &Foot) -> Foot {
    let away = |other: &&Foot| other.position.distance(foot.position);
    let same = feet.iter().filter(|other| other.left == foot.left);
    *same.min_by(|one, two| away(one).total_cmp(&away(two))).unwrap()
}

fn assert_alike(recorded: &RecordedFeet, driver: &mut dyn FootDriver, millis: u64) {
    let (mut there, mut played) = (Vec::new(), Vec::new());
    for ms in 0..millis {
        let at = Instant::from_millis(ms);
        driver.feet(at, &mut there);
        recorded.feet_at(at, &mut played);
        assert_eq!(there.len(), played.len(), "at {ms} ms");
        for foot in &there {
            let other = nearest(&played, foot);
            let (place, force) = (foot.position.distance(other.position), foot.force.0 - other.force.0);
            let turn = turn_between(foot.heading, other.heading);
            assert!(force.abs() < 0.8 + 0.006 * foot.force.0, "at {ms} ms: {foot:?} {other:?}");
            if foot.force.0 > 0.0 {
                assert!(place < 0.0006 && turn.abs() < 0.006, "at {ms} ms: {foot:?} {other:?}");
                assert!((foot.roll - other.roll).abs() < 0.006, "at {ms} ms: {foot:?} {other:?}");
            } else {
                assert!(place < 0.02, "at {ms} ms: {foot:?} {other:?}");
            }
        }
    }
}

#[test]
fn a_person_who_walks_presses_and_drags_is_kept_to_a_fraction_of_a_millimetre_in_some_bytes() {
    let script = session();
    let recorded = RecordedFeet::of(&mut script.clone());
    assert_alike(&recorded, &mut script.clone(), script.duration().as_millis() as u64);
    assert_eq!(recorded.duration().as_millis(), script.duration().as_millis() + u128::from(END_MS));
    let code = recorded.encode();
    let per_s = code.len() as f64 / script.duration().as_secs_f64();
    assert!(per_s < 400.0, "{per_s} bytes a second");
    assert_eq!(RecordedFeet::decode(&code), Ok(recorded));
}

#[test]
fn visits_to_all_shipped_layouts_come_back_from_their_bytes() {
    for name in builtin_layouts() {
        let mut script = visit(&shipped(name), &Geometry::default()).script;
        let recorded = RecordedFeet::of(&mut script);
        let code = recorded.encode();
        assert_eq!(RecordedFeet::decode(&code).as_ref(), Ok(&recorded), "{name}");
    }
}

#[test]
fn the_foot_of_a_mouse_is_kept_where_it_lands_slides_and_jumps() {
    let place = |x: f32, force: f32, turn: f32| Foot {
        position: Vec2::new(x, 0.8),
        heading: 3.0 + turn,
        length_m: 0.27,
        force: Newtons(force),
        roll: 0.75,
        left: false,
    };
    // Hovers, presses, slides with a turn past the half turn, lifts, and comes down far away.
    let played = |feet: &mut dyn FnMut(Instant, &[Foot])| {
        let (mut handle, mut driver) = feet_by_hand();
        let mut now = Vec::new();
        for ms in 0..3000_u64 {
            if ms % 16 == 0 {
                let path = match ms {
                    0..200 => vec![place(0.4 + 0.001 * ms as f32, 0.0, 0.0)],
                    200..500 => vec![place(0.6, 150.0, 0.0)],
                    500..1500 => {
                        vec![place(0.6 + 0.0004 * (ms - 500) as f32, 150.0, 0.0005 * (ms - 500) as f32)]
                    }
                    1500..2000 => vec![place(1.2, 0.0, 0.5)],
                    _ => vec![place(0.2, 80.0, 0.5)],
                };
                handle.lead(0.016, vec![path]);
            }
            driver.feet(Instant::from_millis(ms), &mut now);
            feet(Instant::from_millis(ms), &now);
        }
    };
    let mut recorder = FeetRecorder::default();
    let mut all = Vec::new();
    played(&mut |at, feet| {
        assert!(recorder.note(at, feet));
        all.push(feet.to_vec());
    });
    let recorded = recorder.finish();
    assert_alike(&recorded, &mut Again(all), 3000);
    assert_eq!(RecordedFeet::decode(&recorded.encode()), Ok(recorded));
}

/// Feet of each millisecond, from a list.
struct Again(Vec<Vec<Foot>>);

impl FootDriver for Again {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        let now = self.0.get(at.micros() as usize / 1000);
        feet.extend(now.into_iter().flatten());
        now.is_some()
    }
}

fn standing(force: f32) -> Foot {
    Foot {
        position: Vec2::new(0.5, 0.5),
        heading: 0.0,
        length_m: 0.27,
        force: Newtons(force),
        roll: 0.5,
        left: true,
    }
}

#[test]
fn a_recorder_that_is_full_says_so_and_keeps_what_it_has() {
    let mut recorder = FeetRecorder::default();
    let at = Instant::from_millis(u64::from(MOST_MS));
    assert!(recorder.note(Instant::START, &[standing(600.0)]));
    assert!(!recorder.note(at, &[standing(600.0)]) && recorder.is_full());
    let crowd = vec![standing(600.0); MOST_FEET + 1];
    let mut recorder = FeetRecorder::default();
    assert!(recorder.note(Instant::START, &crowd[1..]));
    assert!(!recorder.note(Instant::from_millis(1), &crowd));
    let kept = recorder.finish();
    assert_eq!(RecordedFeet::decode(&kept.encode()), Ok(kept));
}

#[test]
fn a_tape_begins_with_an_empty_floor_on_which_those_who_stand_there_come_down() {
    let (tape, mut driver) = taped(Box::new(Again(vec![vec![standing(600.0)]; 5000])));
    let mut feet = Vec::new();
    let mut run = |from: u64, to: u64| {
        for ms in from..to {
            driver.feet(Instant::from_millis(ms), &mut feet);
        }
    };
    run(0, 1000);
    assert_eq!((tape.size(), tape.end()), (None, None));
    tape.begin();
    run(1000, 3000);
    let recorded = tape.end().unwrap();
    let at = |ms| {
        let mut feet = Vec::new();
        recorded.feet_at(Instant::from_millis(ms), &mut feet);
        feet.first().map_or(0.0, |foot| foot.force.0)
    };
    assert_eq!((at(1000), at(1399)), (0.0, 0.0));
    assert!((250.0..350.0).contains(&at(1450)), "{}", at(1450));
    assert!((at(1600) - 600.0).abs() < 4.0 && (at(3499) - 600.0).abs() < 4.0);
    assert_eq!(at(3501), 0.0);
}

#[test]
fn another_driver_takes_over_once_and_the_recorded_feet_lift_where_they_stand() {
    let mut person = Performance::new(Person::default(), 1);
    person.appear(Vec2::new(0.9, 0.9), 0.0).unwrap();
    person.wait(Duration::from_secs(5));
    let mut script = Script::new(vec![person], Geometry::default().bounds());
    let recorded = Arc::new(RecordedFeet::of(&mut script));
    let live = Again(vec![vec![standing(150.0)]; 9000]);
    let (take_over, mut driver) = go_on_from(recorded, Box::new(live));
    let mut count = |ms: u64| {
        let mut feet = Vec::new();
        assert!(driver.feet(Instant::from_millis(ms), &mut feet), "it goes on");
        (feet.len(), feet.iter().map(|foot| foot.force.0).sum::<f32>())
    };
    let (feet, force) = count(2000);
    assert_eq!(feet, 2);
    take_over.at(Instant::from_millis(2001));
    take_over.at(Instant::from_millis(9000));
    assert_eq!(count(2001).0, 3);
    assert!((count(2041).1 - 150.0 - 0.5 * force).abs() < 20.0);
    assert_eq!(count(2100), (1, 150.0));
}

/// The feet of the built-in session.
static SESSION: LazyLock<Vec<u8>> = LazyLock::new(|| RecordedFeet::of(&mut session()).encode());

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Any bytes give feet within the limits, or an error.
    #[test]
    fn damaged_feet_are_refused_or_played(at in 0..4000_usize, with in proptest::collection::vec(any::<u8>(), 0..6), cut in 0..9_usize) {
        let good = &*SESSION;
        let (begin, end) = (at.min(good.len()), (at + cut).min(good.len()));
        let bad = [&good[..begin], &with, &good[end..]].concat();
        if let Ok(feet) = RecordedFeet::decode(&bad) {
            assert_playable(&feet);
        }
    }

    #[test]
    fn any_bytes_are_refused_or_played(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let bytes = [&[1][..], &bytes].concat();
        if let Ok(feet) = RecordedFeet::decode(&bytes) {
            assert_playable(&feet);
        }
    }
}

fn assert_playable(recorded: &RecordedFeet) {
    assert!(recorded.duration() <= Duration::from_millis(MOST_MS.into()));
    let mut feet = Vec::new();
    for ms in (0..u64::from(MOST_MS)).step_by(977) {
        recorded.feet_at(Instant::from_millis(ms), &mut feet);
        assert!(feet.len() <= MOST_FEET);
        assert!(feet.iter().all(|foot| foot.position.is_finite() && (0.0..=1e4).contains(&foot.force.0)));
    }
}

#[test]
fn feet_of_a_newer_form_and_too_many_feet_say_so() {
    assert_eq!(RecordedFeet::decode(&[2, 0, 0]), Err(BadFeet::Newer(2)));
    assert_eq!(RecordedFeet::decode(&[]), Err(BadFeet::Damaged));
    // One line whose number of points would take gigabytes.
    let huge = [1, 100, 1, 0, 0x9c, 4, 0xff, 0xff, 0xff, 0xff, 7];
    assert_eq!(RecordedFeet::decode(&huge), Err(BadFeet::TooMany));
    let lines =
        vec![
            FootLine { left: true, length_mm: 270, points: vec![FootPoint { ms: 5, values: [0; VALUES] }] };
            MOST_FEET + 1
        ];
    let crowd = RecordedFeet { length_ms: 9, lines };
    assert_eq!(RecordedFeet::decode(&crowd.encode()), Err(BadFeet::TooMany));
}
