//! The visit of a link in a page, without a browser: played, scrubbed and taken over.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::sync::Arc;
use std::time::Duration;

use underfoot::floor::{Floor, Geometry};
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::outgoing::json::event_line;
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot::sink::{EventSink, Report};
use underfoot::units::Newtons;
use underfoot_sim::{FloorQuality, Pace, PlayedFeet, RecordedFeet, Scenario, SimulatedSource};
use underfoot_web::floor::PageFloor;
use underfoot_web::plan::shipped;
use underfoot_web::played::Played;
use underfoot_web::visit::VisitReel;
use underfoot_window::link::{SharedLayout, SharedVisit};
use underfoot_window::preview::{
    Playback, PlaybackOrder, PlaybackState, PreviewFoot, PreviewInput, VisitOrder,
};

/// Time from one frame of a page to the next.
const FRAME: Duration = Duration::from_micros(16_667);

fn map() -> Layout {
    let text = shipped("map").text;
    parse_layout(&text, "map", &Kinds::builtin(), &Geometry::default()).unwrap().layout
}

/// The layout `map` with the built-in session.
fn session() -> SharedLayout {
    let session = Scenario::parse("session", Scenario::SESSION).unwrap();
    let feet = RecordedFeet::of(&mut session.resolve(&map(), &Geometry::default()).unwrap());
    let visit = SharedVisit::new(&feet, FloorQuality::Slight, 3).unwrap();
    SharedLayout { visit: Some(visit), ..shipped("map") }
}

/// The events of the same visit on a floor of the program's.
fn simulated(shared: &SharedLayout) -> Vec<String> {
    #[derive(Clone, Default)]
    struct Lines(Arc<std::sync::Mutex<Vec<String>>>);
    impl EventSink for Lines {
        fn report(&mut self, report: &Report<'_>) {
            if let Report::Event(event) = report {
                self.0.lock().unwrap().push(event_line(event));
            }
        }
    }
    let visit = shared.visit.as_ref().unwrap();
    let (sim, floor) = visit.build().unwrap().in_use(&Floor::default()).unwrap();
    let driver = PlayedFeet::new(Arc::new(visit.feet().unwrap()));
    let source = SimulatedSource::new(sim, Box::new(driver), Pace::FreeRunning);
    let lines = Lines::default();
    let mut server =
        Server::new(&floor, map(), Method::default(), source).with_events(Box::new(lines.clone()));
    while server.turn().unwrap() == Ended::No {}
    drop(server);
    Arc::into_inner(lines.0).unwrap().into_inner().unwrap()
}

/// A page with a visit; the test calls its frames.
struct Page {
    visit: Played,
    input: PreviewInput,
    now: Duration,
}

impl Page {
    fn new(shared: &SharedLayout) -> Self {
        let reel = VisitReel::new(shared, |_| {}, Box::new(|_, _| {})).unwrap();
        let (visit, input) = Played::new(Box::new(reel), "a visit").unwrap();
        Self { visit, input, now: Duration::ZERO }
    }

    fn playback(&mut self) -> &mut dyn Playback {
        &mut **self.input.playback.as_mut().unwrap()
    }

    fn frame(&mut self) {
        self.now += FRAME;
        // On this machine, no frame ends early.
        self.visit.run_until(self.now, &|| Duration::ZERO);
    }

    /// Runs frames until the condition holds.
    fn until(&mut self, what: impl Fn(&PlaybackState) -> bool) -> PlaybackState {
        for _ in 0..10_000 {
            self.frame();
            let state = self.playback().state();
            if what(&state) {
                return state;
            }
        }
        panic!("it never comes: {:?}", self.playback().state())
    }

    /// The lines of controls' events since the last call.
    fn events(&self) -> Vec<String> {
        self.visit.floor().event_lines().filter(|line| !line.contains("\"event\":\"ignored\"")).collect()
    }
}

#[test]
fn a_visit_gives_the_same_events_at_any_speed_and_once_more_as_the_program_does() {
    let shared = session();
    let expected = simulated(&shared);
    assert!(expected.iter().any(|line| line.contains("\"pressed\"") && line.contains("\"home\"")));
    let mut page = Page::new(&shared);
    let mut seen = Vec::new();
    while page.playback().state().at_s < 6.0 {
        page.frame();
        seen.extend(page.events());
    }
    assert!((page.now.as_secs_f64() - 6.0).abs() < 0.1, "as fast as it was: {:?}", page.now);
    assert!(page.visit.is_heard());
    page.playback().lead(PlaybackOrder::Speed(f64::INFINITY));
    let end = page.until(|state| state.is_paused);
    seen.extend(page.events());
    assert_eq!(seen, expected);
    assert!(
        (end.at_s - end.length_s).abs() < 0.002 && end.can_take_over && !page.visit.is_heard(),
        "{end:?}"
    );
    assert!(end.marks.iter().any(|mark| mark.what == "home pressed"), "{end:?}");

    // Back to an earlier moment: simulated anew, and the same.
    page.playback().lead(PlaybackOrder::GoTo(7.0));
    let back = page.until(|state| state.goes_to_s.is_none() && state.at_s < 8.0);
    assert!((back.at_s - 7.0).abs() < 0.002 && back.is_paused, "{back:?}");
    assert_eq!(back.marks.len(), end.marks.len(), "no mark twice");
    let again = page.events();
    assert!(!again.is_empty() && again[..] == expected[..again.len()], "{again:?}");
    assert!((page.input.snapshots.read().at.secs() - 7.0).abs() < 0.02);
    page.playback().lead(PlaybackOrder::Repeat(Some((7.0, 7.5))));
    page.playback().lead(PlaybackOrder::Speed(1.0));
    page.playback().lead(PlaybackOrder::Pause(false));
    page.until(|state| state.at_s > 7.4);
    page.until(|state| state.at_s < 7.1);
}

#[test]
fn a_machine_that_is_slow_is_late_and_still_answers() {
    let mut page = Page::new(&session());
    page.playback().lead(PlaybackOrder::GoTo(f64::INFINITY));
    page.playback().lead(PlaybackOrder::GoTo(10.0));
    let time = std::cell::Cell::new(Duration::ZERO);
    // Each look at the clock takes a tenth of a second.
    let clock = || {
        time.set(time.get() + Duration::from_millis(100));
        time.get()
    };
    page.now += FRAME;
    page.visit.run_until(page.now, &clock);
    let state = page.playback().state();
    assert_eq!((state.goes_to_s, state.at_s), (Some(10.0), 0.0));
}

/// A foot of the window, with its ball at `at`.
fn foot(at: Vec2, force: f32) -> PreviewFoot {
    PreviewFoot {
        position: at,
        heading_rad: 0.0,
        length_m: 0.28,
        force: Newtons(force),
        roll: 0.75,
        left: false,
    }
}

#[test]
fn the_feet_of_the_window_go_on_where_the_visit_is() {
    let mut page = Page::new(&session());
    page.until(|state| state.at_s > 3.0);
    let mut shoes = Vec::new();
    page.input.shoes.as_mut().unwrap()(&mut shoes);
    assert_eq!(shoes.len(), 2, "the visitor's feet are shown");
    assert!(page.input.feet.is_none(), "the mouse moves none yet");
    let at_s = page.playback().state().at_s;
    let mut live = page.playback().take_over().unwrap();
    assert!(page.playback().take_over().is_none(), "once");
    page.events();
    let home = live.layout.widgets.iter().find(|widget| widget.id.as_str() == "home").unwrap().area.centre();
    let mut stand = |page: &mut Page, force: f32, frames: u32| {
        for _ in 0..frames {
            let feet = live.feet.as_mut().unwrap();
            let acts_at = feet.centre_of_pressure(&foot(Vec2::ZERO, 0.0));
            feet.lead(FRAME.as_secs_f32(), &[vec![foot(home - acts_at, force)]]);
            page.frame();
        }
    };
    stand(&mut page, 0.0, 30);
    stand(&mut page, 150.0, 30);
    stand(&mut page, 0.0, 30);
    let events = page.events();
    assert!(
        events.iter().any(|line| line.contains("\"pressed\"") && line.contains("\"home\"")),
        "{events:?}"
    );
    let passed = live.snapshots.read().at.secs() - at_s;
    assert!((passed - 90.0 * FRAME.as_secs_f64()).abs() < 0.1, "{passed}");
    live.shoes.as_mut().unwrap()(&mut shoes);
    assert_eq!(shoes.len(), 1, "the visitor has gone");
    assert!(page.visit.is_heard());
}

#[test]
fn feet_that_the_window_records_are_a_visit_with_the_same_presses() {
    let (mut floor, mut input) = PageFloor::new(&shipped("map"), |_| {}).unwrap();
    let home = map().widgets.iter().find(|widget| widget.id.as_str() == "home").unwrap().area.centre();
    let mut now = Duration::ZERO;
    let mut stand = |floor: &mut PageFloor, input: &mut PreviewInput, force: f32, frames: u32| {
        for _ in 0..frames {
            let feet = input.feet.as_mut().unwrap();
            let acts_at = feet.centre_of_pressure(&foot(Vec2::ZERO, 0.0));
            feet.lead(FRAME.as_secs_f32(), &[vec![foot(home - acts_at, force)]]);
            now += FRAME;
            floor.run_until(now);
        }
    };
    stand(&mut floor, &mut input, 0.0, 60);
    let desk = input.visit.as_mut().unwrap();
    desk.lead(VisitOrder::Begin(Box::default()));
    assert!(desk.state().is_for_links && desk.shared().is_none());
    for _ in 0..3 {
        stand(&mut floor, &mut input, 150.0, 30);
        stand(&mut floor, &mut input, 0.0, 30);
    }
    let desk = input.visit.as_mut().unwrap();
    let size = desk.state().recording.unwrap();
    assert!((size.length_s - 4.5).abs() < 0.2 && size.bytes > 50, "{size:?}");
    desk.lead(VisitOrder::End);
    let visit = desk.shared().unwrap().unwrap();
    assert!(visit.letters() < 1000, "{}", visit.letters());
    let done = |lines: Vec<String>| {
        let names = ["pressed", "released", "clicked"].map(|name| format!("\"event\":\"{name}\""));
        let is_named = |line: &String| names.iter().find(|name| line.contains(*name)).cloned();
        lines.iter().filter_map(is_named).collect::<Vec<_>>()
    };
    let lived = done(floor.event_lines().collect());
    assert!(lived.len() >= 6, "{lived:?}");
    assert_eq!(done(simulated(&SharedLayout { visit: Some(visit), ..shipped("map") })), lived);
}

#[test]
fn a_recording_ends_when_another_layout_comes() {
    let (mut floor, mut input) = PageFloor::new(&shipped("map"), |_| {}).unwrap();
    input.visit.as_mut().unwrap().lead(VisitOrder::Begin(Box::default()));
    floor.run_until(Duration::from_millis(100));
    input.channels.commands.send(underfoot_window::preview::PreviewCommand::Open(0)).unwrap();
    floor.run_until(Duration::from_millis(200));
    let desk = input.visit.as_mut().unwrap();
    assert!(desk.state().recording.is_none());
    assert!(desk.shared().unwrap().unwrap_err().contains("another layout"));
}
