//! A recording that is dropped on a page, without a browser.
//!
//! `PROPTEST_CASES=10000` in the environment tries more damaged ones.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::sync::LazyLock;
use std::time::Duration;

use proptest::prelude::*;
use underfoot::floor::{Floor, Geometry};
use underfoot::recording::{Recorded, Recorder, WhenBehind};
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot_sim::{FloorBuild, FloorQuality, Pace, Scenario, SimulatedSource};
use underfoot_web::plan::{NoFloor, shipped};
use underfoot_web::played::Played;
use underfoot_web::recording::RecordingReel;
use underfoot_window::preview::{PlaybackOrder, PlaybackState, PreviewInput};

/// The built-in session on an ideal floor, recorded.
static SESSION: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let geometry = Geometry::default();
    let map = parse_layout(&shipped("map").text, "map", &Kinds::builtin(), &geometry).unwrap().layout;
    let session = Scenario::parse("session", Scenario::SESSION).unwrap();
    let script = session.resolve(&map, &geometry).unwrap();
    let (sim, floor) = FloorBuild::of(FloorQuality::Ideal, 1).in_use(&Floor::default()).unwrap();
    let source = SimulatedSource::new(sim, Box::new(script), Pace::FreeRunning);
    let file = tempfile::NamedTempFile::new().unwrap();
    let method = Method::default();
    let Recorded { recorder, input, floor, layout } =
        Recorder::around(Some(file.path()), source, floor, map, method, WhenBehind::Wait).unwrap();
    let events = recorder.as_ref().unwrap().events().unwrap().waiting();
    let mut server = Server::new(&floor, layout, method, input).with_events(Box::new(events));
    while server.turn().unwrap() == Ended::No {}
    drop((server, recorder));
    std::fs::read(file.path()).unwrap()
});

fn state(input: &mut PreviewInput) -> PlaybackState {
    input.playback.as_mut().unwrap().state()
}

/// Runs frames until the condition holds.
fn until(
    played: &mut Played,
    input: &mut PreviewInput,
    what: impl Fn(&PlaybackState) -> bool,
) -> PlaybackState {
    let mut now = Duration::ZERO;
    for _ in 0..5000 {
        now += Duration::from_micros(16_667);
        played.run_until(now, &|| Duration::ZERO);
        let state = state(input);
        if what(&state) {
            return state;
        }
    }
    panic!("it never comes: {:?}", state(input))
}

#[test]
fn a_recording_plays_to_its_end_and_again_from_any_moment() {
    let reel = RecordingReel::new("walk.mcap", SESSION.clone()).unwrap();
    let (mut played, mut input) = Played::new(Box::new(reel), "walk.mcap").unwrap();
    assert_eq!(input.source, "walk.mcap");
    let begun = state(&mut input);
    assert!((18.0..30.0).contains(&begun.length_s) && !begun.can_take_over, "{begun:?}");
    assert!(begun.marks.iter().any(|mark| mark.what == "home pressed"), "{begun:?}");
    input.playback.as_mut().unwrap().lead(PlaybackOrder::Speed(f64::INFINITY));
    until(&mut played, &mut input, |state| state.is_paused);
    let first: Vec<String> = played.floor().event_lines().collect();
    assert!(first.len() > 10);
    input.playback.as_mut().unwrap().lead(PlaybackOrder::GoTo(6.0));
    let back = until(&mut played, &mut input, |state| state.goes_to_s.is_none() && state.at_s < 7.0);
    assert!((back.at_s - 6.0).abs() < 0.01 && back.marks == begun.marks, "{back:?}");
    let again: Vec<String> = played.floor().event_lines().collect();
    assert!(!again.is_empty() && again[..] == first[..again.len()]);
    assert!((input.snapshots.read().at.secs() - 6.0).abs() < 0.1);
}

#[test]
fn bytes_that_are_no_recording_and_too_many_say_so() {
    let says = |bytes: Vec<u8>| RecordingReel::new("a.mcap", bytes).err().map(|error| error.to_string());
    assert!(says(b"not a recording".to_vec()).unwrap().contains("no recording of a floor"));
    assert!(matches!(RecordingReel::new("a.mcap", vec![0; (64 << 20) + 1]), Err(NoFloor::Large)));
}

fn cases() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(60))
}

proptest! {
    #![proptest_config(cases())]

    /// Recordings that are changed or cut anywhere play as far as they can be read, or are refused with a sentence.
    #[test]
    fn damaged_recordings_are_refused_or_played(at in any::<prop::sample::Index>(), with in proptest::collection::vec(any::<u8>(), 0..9), keeps in prop::option::of(any::<prop::sample::Index>())) {
        let mut bytes = SESSION.clone();
        let at = at.index(bytes.len());
        let end = (at + with.len()).min(bytes.len());
        bytes.splice(at..end, with);
        if let Some(keeps) = keeps {
            bytes.truncate(keeps.index(bytes.len() + 1));
        }
        match RecordingReel::new("a.mcap", bytes) {
            Ok(reel) => {
                let opened = Played::new(Box::new(reel), "a.mcap");
                if let Ok((mut played, mut input)) = opened {
                    input.playback.as_mut().unwrap().lead(PlaybackOrder::GoTo(f64::MAX));
                    input.playback.as_mut().unwrap().lead(PlaybackOrder::GoTo(3.0));
                    for frame in 0..20 {
                        played.run_until(Duration::from_millis(16 * frame), &|| Duration::ZERO);
                    }
                }
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
