//! A session from the view of an app: its events, state, requests and refusals.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use underfoot::engine::ValueRange;
use underfoot::floor::Floor;
use underfoot::runtime::{EndReason, Event, Kind, Refusal, Session, SessionBuilder, StartError};
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::{HostClock, Instant};
use underfoot::widget::{EventKind, OffReason, SetError, Value, WidgetId};
use underfoot::wire::{LinkCounters, SensorPacket};
use underfoot_sim::{
    self as sim, FloorQuality, Pace, Scenario, SimConfig, SimFloor, SimulatedSource, calibrated,
};

use crate::support::layout;

/// Sends no packet until it is stopped.
struct Silence(Arc<AtomicBool>);

impl SensorSource for Silence {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        std::thread::sleep(Duration::from_millis(1));
        Ok(None)
    }

    fn now(&self) -> Instant {
        Instant::START
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
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
    Session::source(Silence(Arc::default()), no_clock()).layout(layout(name))
}

/// The built-in session, as fast as possible.
fn visit() -> SessionBuilder {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 1);
    let floor = calibrated(&wired, &sim, 1).unwrap();
    let script = Scenario::parse("session", Scenario::SESSION).unwrap();
    let script = script.resolve(&layout("map"), &floor.geometry).unwrap();
    let source = SimulatedSource::new(sim, Box::new(script), Pace::FreeRunning);
    Session::source(source, no_clock()).floor(floor).layout(layout("map"))
}

fn all(session: &Session) -> Vec<Event> {
    std::iter::from_fn(|| session.next_event_timeout(Duration::from_secs(60))).collect()
}

fn refused(id: &str, why: SetError) -> Result<(), Refusal> {
    Err(Refusal::Control { id: WidgetId::new(id), why })
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
    let zoom = session.control("zoom").unwrap();
    zoom.set(0.75).unwrap();
    zoom.set_range(1..=120).unwrap();
    zoom.set(40).unwrap();
    zoom.set_label("Slice").unwrap();
    assert_eq!(zoom.set(true), refused("zoom", SetError::WrongType));
    assert_eq!(zoom.set(f32::NAN), refused("zoom", SetError::NotFinite));
    assert_eq!(zoom.set_range(5..=5), refused("zoom", SetError::NoRange));
    assert_eq!(zoom.set_range(0.0..=f64::NAN), refused("zoom", SetError::NoRange));
    zoom.set_locked(true).unwrap();
    assert_eq!(zoom.set(50), refused("zoom", SetError::Locked));
    assert_eq!(zoom.set_range(0..=9), refused("zoom", SetError::Locked));
    assert_eq!(session.control("home").unwrap().set_range(0..=9), refused("home", SetError::WrongType));
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
    assert_eq!(session.control("drive").unwrap().set(true), refused("drive", SetError::Momentary));
    assert!(!session.held("drive").unwrap().is_fresh());
}

#[test]
fn another_layout_keeps_what_apps_have_set_and_is_shown_with_its_own_names() {
    let session = silent("map").start().unwrap();
    session.control("zoom").unwrap().set_range(1..=120).unwrap();
    let mut next = layout("map");
    next.widgets.reverse();
    let revision = session.set_layout(next);
    // The answer comes after the layout.
    session.control("zoom").unwrap().set(90).unwrap();
    let snapshot = session.snapshot();
    assert_eq!(snapshot.floor.layout_revision, revision);
    assert_eq!(snapshot.layout.widgets[0].id, "zoom");
    assert_eq!(snapshot.value("zoom"), Some(Value::Number(90.0)));
}

#[test]
fn the_last_handle_ends_the_floor_before_it_is_gone() {
    let gone = Arc::new(AtomicBool::new(false));
    let source = Silence(Arc::clone(&gone));
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

#[test]
fn a_misspelt_name_is_refused_with_the_nearest_one_wherever_it_is_asked_for() {
    let session = silent("map").start().unwrap();
    let expected = r#"there is no control "zom"; did you mean "zoom"?"#;
    assert_eq!(session.control("zom").map(drop).unwrap_err().to_string(), expected);
    assert_eq!(session.held("zom").map(drop).unwrap_err().to_string(), expected);
    let get = underfoot::wire::ControlMessage::Get { id: WidgetId::new("zom") };
    assert_eq!(session.ask(get).unwrap_err().to_string(), expected);
}

#[test]
fn an_unknown_page_is_refused_with_the_names_of_the_pages() {
    let pages = crate::support::page(
        r#"Layout(version: 1, pages: [(id: "first"), (id: "second")],
            regions: [(id: "all", at: (0, 0), size: (6, 6))],
            widgets: [(id: "home", kind: "button", at: (1, 1), size: (0.8, 0.8))])"#,
    );
    let session = Session::source(Silence(Arc::default()), no_clock()).layout(pages).start().unwrap();
    let expected = r#"there is no page "third": the layout has "first" and "second""#;
    assert_eq!(session.set_page("third").unwrap_err().to_string(), expected);
    session.set_page("second").unwrap();
}

#[test]
fn a_value_beyond_the_range_becomes_the_nearest_end_of_it() {
    let session = silent("all_controls").start().unwrap();
    for control in session.controls() {
        let Some(ValueRange::Number(scale)) = control.state().unwrap().range else { continue };
        for (given, taken) in [(1e6, scale.max), (-1e6, scale.min), (scale.max, scale.max)] {
            match control.set(given) {
                Ok(()) => {
                    assert_eq!(
                        control.state().unwrap().value,
                        Some(Value::Number(taken)),
                        "{}",
                        control.id()
                    );
                }
                Err(refusal) => assert_eq!(Err(refusal), self::refused(control.id(), SetError::Momentary)),
            }
        }
    }
}

#[test]
fn controls_are_listed_in_the_order_of_the_layout_with_their_states() {
    let session = silent("map").start().unwrap();
    let page = layout("map");
    let expected: Vec<&str> = page.widgets.iter().map(|widget| widget.id.as_str()).collect();
    let controls = session.controls();
    assert_eq!(controls.iter().map(underfoot::runtime::ControlHandle::id).collect::<Vec<_>>(), expected);
    let states: Vec<String> = session.snapshot().controls().map(|state| state.id.to_string()).collect();
    assert_eq!(states, expected);
    assert!(controls.iter().all(|control| control.state().unwrap().id == control.id()));
}

#[test]
fn a_loop_over_a_session_hears_every_event_and_ends_with_it() {
    let session = visit().start().unwrap();
    let events: Vec<Event> = (&session).into_iter().collect();
    assert_eq!(controls(&events).len(), 8);
    assert_eq!(events.last().map(|event| &event.kind), Some(&Kind::Ended(EndReason::SourceEnded)));
    assert_eq!(session.events().next(), None, "after the end nothing is waited for");
}

#[test]
fn a_session_knows_the_port_that_the_system_chose() {
    let session = Session::listen("127.0.0.1:0").layout(layout("map")).start().unwrap();
    let address = session.local_addr().unwrap();
    assert!(address.ip().is_loopback() && address.port() > 0, "{address}");
    assert_eq!(silent("map").start().unwrap().local_addr(), None);
    let within = Session::listen("[::ffff:127.0.0.1]:0").layout(layout("map")).start().unwrap();
    assert!(within.local_addr().unwrap().is_ipv4(), "an IPv4 address within IPv6 is the IPv4 address");
}

/// The reason of a control that acts while it is held, after a second of this floor.
fn off_after_a_second(floor: Floor, sim: SimFloor) -> Option<underfoot::engine::Off> {
    let stand = "Scenario(title: \"nobody\", steps: [Wait(ms: 1000)])";
    let page = layout("all_controls");
    let script = Scenario::parse("nobody", stand).unwrap().resolve(&page, &floor.geometry).unwrap();
    let source = SimulatedSource::new(sim, Box::new(script), Pace::FreeRunning);
    let session = Session::source(source, no_clock()).floor(floor).layout(page).start().unwrap();
    let told = session.events().filter(|event| (event.id(), event.kind) == ("drive", Kind::State)).count();
    let off = session.control("drive").unwrap().state().unwrap().off;
    assert_eq!(told > 0, off.is_some(), "an app hears of it without asking");
    off
}

#[test]
fn an_app_hears_why_a_control_is_off_on_a_floor_without_calibration() {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 1);
    let off = off_after_a_second(wired.clone(), sim.clone()).unwrap();
    assert_eq!(off.reason, OffReason::NotCalibrated);
    assert!(off.text.contains("no floor file is given"), "{}", off.text);
    let mut named = wired.clone();
    named.file = underfoot::floor::FloorFile::new("hall.ron");
    let off = off_after_a_second(named, sim.clone()).unwrap();
    assert!(off.text.contains("hall.ron"), "{}", off.text);
    assert_eq!(off_after_a_second(calibrated(&wired, &sim, 1).unwrap(), sim), None);
}

#[test]
fn a_floor_simulated_in_the_same_process_is_calibrated() {
    let page = layout("all_controls");
    let text = "Scenario(title: \"nobody\", steps: [Wait(ms: 1500)])";
    let scenario = Scenario::parse("nobody", text).unwrap();
    let session = sim::session(page, &scenario, FloorQuality::default()).unwrap().start().unwrap();
    let ended = session.events().last().unwrap();
    assert_eq!(ended.kind, Kind::Ended(EndReason::SourceEnded));
    assert_eq!(session.snapshot().floor.health.uncalibrated, 0);
    let off = session.control("drive").unwrap().state().unwrap().off.map(|off| off.reason);
    // The floor falls silent only with its end.
    assert!(matches!(off, None | Some(OffReason::LinkLost)), "{off:?}");
}

#[test]
fn a_floor_is_simulated_from_files() {
    let session =
        sim::session_from_files("layouts/map.ron", None, FloorQuality::default()).unwrap().start().unwrap();
    let first = session.events().find(|event| matches!(event.kind, Kind::Control(_))).unwrap();
    assert_eq!((first.id(), first.kind), ("home", Kind::Control(EventKind::Pressed)));
    // A layout is no scenario.
    for (layout, scenario, wrong) in [
        ("no such.ron", None, "no such.ron"),
        ("layouts/map.ron", Some("no such.ron"), "no such.ron"),
        ("layouts/map.ron", Some("layouts/map.ron"), "layouts/map.ron"),
    ] {
        let session = sim::session_from_files(layout, scenario.map(Path::new), FloorQuality::default());
        let problem = session.map(drop).unwrap_err();
        assert!(problem.to_string().contains(wrong), "{problem}");
    }
}
