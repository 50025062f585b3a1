//! A session as an app has it: what it hears, sees, asks for and is refused.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use underfoot::engine::ValueRange;
use underfoot::floor::Floor;
use underfoot::runtime::{EndReason, Event, Kind, Refusal, Session, SessionBuilder, StartError};
use underfoot::sim::{Scenario, SimConfig, SimFloor, calibrated};
use underfoot::source::{Pace, SensorSource, SimulatedSource, SourceError};
use underfoot::units::{HostClock, Instant};
use underfoot::widget::{EventKind, SetError, Value};
use underfoot::wire::SensorPacket;

use crate::support::layout;

/// Nothing comes for as long as it is asked.
struct Silence(Arc<AtomicBool>);

impl SensorSource for Silence {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        std::thread::sleep(Duration::from_millis(1));
        Ok(None)
    }

    fn now(&self) -> Instant {
        Instant::START
    }
}

impl Drop for Silence {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

fn no_clock() -> HostClock {
    Arc::new(|| Instant::START)
}

fn silent(name: &str) -> SessionBuilder {
    Session::source(Box::new(Silence(Arc::default())), no_clock()).layout(layout(name))
}

/// The built-in session as fast as it can be computed.
fn visit() -> SessionBuilder {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 1);
    let floor = calibrated(&wired, &sim, 1).unwrap();
    let script = Scenario::parse("session", Scenario::SESSION).unwrap();
    let script = script.resolve(&layout("map"), &floor.geometry).unwrap();
    let source = SimulatedSource::new(sim, Box::new(script), Pace::FreeRunning);
    Session::source(Box::new(source), no_clock()).floor(floor).layout(layout("map"))
}

fn all(session: &Session) -> Vec<Event> {
    std::iter::from_fn(|| session.next_event_timeout(Duration::from_secs(60))).collect()
}

fn controls(events: &[Event]) -> Vec<String> {
    let of = |event: &Event| match event.kind {
        Kind::Control(EventKind::Changed(Value::Number(_))) => None,
        Kind::Control(kind) => Some(format!("{} {}", event.id(), kind.name())),
        _ => None,
    };
    events.iter().filter_map(of).collect()
}

#[test]
fn a_visit_is_heard_to_its_end_and_the_handle_is_shared() {
    fn is_shared<T: Clone + Send + Sync>(_: &T) {}
    let calls = Arc::new(AtomicU32::new(0));
    let called = Arc::clone(&calls);
    let wake = move || {
        called.fetch_add(1, Ordering::Relaxed);
    };
    let session = visit().wake(wake).start().unwrap();
    is_shared(&session);
    let other = session.clone();
    let events = std::thread::spawn(move || all(&other)).join().unwrap();
    let expected = [
        "home pressed",
        "home released",
        "home clicked",
        "zoom pressed",
        "zoom released",
        "satellite pressed",
        "satellite released",
        "satellite changed",
    ];
    assert_eq!(controls(&events), expected);
    assert_eq!(events.last().map(|event| &event.kind), Some(&Kind::Ended(EndReason::SourceEnded)));
    let snapshot = session.snapshot();
    assert_eq!(snapshot.value("satellite"), Some(Value::Switch(true)));
    let Some(Value::Number(zoom)) = snapshot.value("zoom") else { panic!("{snapshot:?}") };
    assert!((0.7..0.8).contains(&zoom), "{zoom}");
    assert!(calls.load(Ordering::Relaxed) > 0);
    assert_eq!((session.has_ended(), session.dropped()), (true, 0));
    assert_eq!(session.control("zoom").unwrap().set(0.1), Err(Refusal::Ended));
}

#[test]
fn what_an_app_asks_is_done_and_told_or_refused_with_its_reason() {
    let session = silent("map").start().unwrap();
    // Before the first frame.
    let zoom = session.snapshot().control("zoom").unwrap();
    assert_eq!((zoom.value, zoom.label.as_str(), zoom.enabled), (Some(Value::Number(0.3)), "Zoom", true));
    let refused = |id: &str| session.control(id).map(drop);
    assert_eq!(refused("nowhere"), Err(SetError::Unknown.into()));
    let zoom = session.control("zoom").unwrap();
    zoom.set(0.75).unwrap();
    zoom.set_range(1..=120).unwrap();
    zoom.set(40).unwrap();
    zoom.set_label("Slice").unwrap();
    assert_eq!(zoom.set(true), Err(SetError::WrongType.into()));
    assert_eq!(zoom.set(f32::NAN), Err(SetError::NotFinite.into()));
    assert_eq!(zoom.set_range(5..=5), Err(SetError::NoRange.into()));
    assert_eq!(zoom.set_range(0.0..=f64::NAN), Err(SetError::NoRange.into()));
    zoom.set_locked(true).unwrap();
    assert_eq!(zoom.set(50), Err(SetError::Locked.into()));
    assert_eq!(zoom.set_range(0..=9), Err(SetError::Locked.into()));
    assert_eq!(session.control("home").unwrap().set_range(0..=9), Err(SetError::WrongType.into()));
    assert_eq!(session.set_page("nowhere"), Err(SetError::Unknown.into()));
    session.stop();
    let events = all(&session);
    let told = events.iter().filter(|event| (event.id(), event.kind) == ("zoom", Kind::State));
    assert_eq!(told.count(), 5);
    let state = zoom.state().unwrap();
    assert_eq!((state.value, state.label.as_str(), state.locked), (Some(Value::Number(40.0)), "Slice", true));
    let Some(ValueRange::Number(scale)) = state.range else { panic!("no range") };
    assert_eq!((scale.min, scale.max), (1.0, 120.0));
}

#[test]
fn only_a_foot_can_hold_what_acts_while_it_is_held() {
    let session = silent("all_controls").start().unwrap();
    assert_eq!(session.control("drive").unwrap().set(true), Err(SetError::Momentary.into()));
    assert!(!session.held("drive").is_fresh());
}

#[test]
fn another_layout_keeps_what_apps_have_set_and_is_shown_with_its_own_names() {
    let session = silent("map").start().unwrap();
    session.control("zoom").unwrap().set_range(1..=120).unwrap();
    let mut next = layout("map");
    next.widgets.reverse();
    let revision = session.set_layout(next);
    // The answer comes behind the layout.
    session.control("zoom").unwrap().set(90).unwrap();
    let snapshot = session.snapshot();
    assert_eq!(snapshot.floor.layout_revision, revision);
    assert_eq!(snapshot.layout.widgets[0].id, "zoom");
    assert_eq!(snapshot.value("zoom"), Some(Value::Number(90.0)));
}

#[test]
fn the_last_handle_ends_the_floor_before_it_is_gone() {
    let gone = Arc::new(AtomicBool::new(false));
    let source = Box::new(Silence(Arc::clone(&gone)));
    let session = Session::source(source, no_clock()).layout(layout("map")).start().unwrap();
    let other = session.clone();
    drop(session);
    assert!(!gone.load(Ordering::Relaxed));
    drop(other);
    assert!(gone.load(Ordering::Relaxed), "the sensing thread has ended");
}

#[test]
fn what_is_missing_is_said_and_nothing_runs() {
    let start = |builder: SessionBuilder| builder.start().map(drop).unwrap_err();
    assert!(matches!(start(Session::listen("127.0.0.1:0")), StartError::NoLayout));
    let other = Floor::of(underfoot::floor::Geometry::of_paper_tiles(3, 2).unwrap());
    assert!(matches!(start(silent("map").floor(other)), StartError::NoLayout));
    let nowhere = Session::listen("nowhere").layout(layout("map"));
    assert!(start(nowhere).to_string().contains("write it like 127.0.0.1:9000"));
    let taken = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    assert!(matches!(start(Session::listen(address).layout(layout("map"))), StartError::Source(_)));
}
