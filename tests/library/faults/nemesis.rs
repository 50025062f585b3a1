//! Random combinations of faults under a person who plays the built-in session, and on an empty floor.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::sense::Method;
use underfoot::serve::{Ended, Server};
use underfoot::sink::{EventSink, Report};
use underfoot::source::{FaultInjector, LinkFaults};
use underfoot::units::Instant;
use underfoot::widget::{EventKind, WidgetEvent};
use underfoot::wire::LinkState;
use underfoot_sim::{
    self as sim, Foot, FootDriver, Pace, Scenario, Script, SimConfig, SimFloor, SimulatedSource,
};

use crate::support::layout;

/// All reports, in order.
#[derive(Clone, Debug)]
enum Told {
    Event(WidgetEvent),
    Held(Instant, Vec<String>),
    Link(Instant, LinkState),
}

#[derive(Clone, Default)]
struct Notes(Arc<Mutex<Vec<Told>>>);

impl EventSink for Notes {
    fn report(&mut self, report: &Report<'_>) {
        let told = match report {
            Report::Event(event) => Told::Event(WidgetEvent::clone(event)),
            Report::Link(at, state) => Told::Link(*at, *state),
            Report::Held(held) => Told::Held(held.at, held.held.iter().map(ToString::to_string).collect()),
            _ => return,
        };
        self.0.lock().unwrap().push(told);
    }
}

/// An empty floor for a while.
struct Nobody(Instant);

impl FootDriver for Nobody {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        at < self.0
    }
}

fn serve(
    floor: &Floor,
    sim: &SimFloor,
    page: &Layout,
    feet: Box<dyn FootDriver>,
    faults: LinkFaults,
) -> Vec<Told> {
    let notes = Notes::default();
    let source = SimulatedSource::new(sim.clone(), feet, Pace::FreeRunning);
    let source = FaultInjector::new(source, faults, 5);
    let mut server =
        Server::new(floor, page.clone(), Method::default(), source).with_events(Box::new(notes.clone()));
    while server.turn().unwrap() == Ended::No {}
    drop(server);
    std::mem::take(&mut *notes.0.lock().unwrap())
}

/// Whether an event ends a press.
fn ends(kind: EventKind) -> bool {
    matches!(kind, EventKind::Released | EventKind::Cancelled)
}

/// Every press happens under a foot that presses there, ends once, and is not held on a lost floor.
fn check(told: &[Told], script: &Script, page: &Layout, seed: u64) -> usize {
    let mut pressed: Vec<String> = Vec::new();
    let (mut presses, mut lost_since) = (0, None);
    for told in told {
        match told {
            Told::Event(event) => {
                let id = event.id.to_string();
                if event.kind == EventKind::Pressed {
                    presses += 1;
                    assert!(is_under_a_foot(event, script, page), "seed {seed}: {event:?} by itself");
                    assert!(!pressed.contains(&id), "seed {seed}: {id} twice");
                    assert_eq!(lost_since, None, "seed {seed}: {event:?} on a lost floor");
                    pressed.push(id);
                } else if ends(event.kind) {
                    assert!(pressed.contains(&id), "seed {seed}: {event:?} ends nothing");
                    pressed.retain(|held| *held != id);
                }
            }
            Told::Held(at, held) => {
                let lost = lost_since.is_some_and(|since| at.since(since) > Duration::from_millis(20));
                assert!(!lost || held.is_empty(), "seed {seed}: {held:?} held at {at:?} on a lost floor");
            }
            Told::Link(at, state) => {
                lost_since = (*state == LinkState::Lost).then_some(lost_since.unwrap_or(*at));
            }
        }
    }
    assert!(pressed.is_empty(), "seed {seed}: {pressed:?} never ended");
    presses
}

/// Whether a foot pressed on or beside the control within the last third of a second: packets may be delayed.
fn is_under_a_foot(event: &WidgetEvent, script: &Script, page: &Layout) -> bool {
    let Some(widget) = page.widgets.iter().find(|widget| widget.id == event.id) else { return false };
    let mut feet = Vec::new();
    (0..34_u64).any(|tenth| {
        feet.clear();
        script.feet_at(event.at.before(Duration::from_millis(10 * tenth)), &mut feet);
        feet.iter().any(|foot| {
            let at = foot.centre_of_pressure();
            foot.force.0 > 10.0 && widget.area.distance(at) < 0.1
        })
    })
}

fn a_floor() -> (Floor, SimFloor) {
    let wired = Floor::default();
    let sim = SimFloor::new(&wired, SimConfig::default(), 7);
    (sim::calibrated(&wired, &sim, 7).unwrap(), sim)
}

/// The events of each control, in order, without positions and forces.
fn story(told: &[Told]) -> Vec<(String, &'static str)> {
    let events = told.iter().filter_map(|told| match told {
        Told::Event(event) if !matches!(event.kind, EventKind::Changed(_) | EventKind::Ticked) => Some(event),
        _ => None,
    });
    events.map(|event| (event.id.to_string(), event.kind.name())).collect()
}

// N1, N2
#[test]
fn losses_and_short_bursts_change_nothing_of_what_a_person_does() {
    let (floor, sim) = a_floor();
    let page = layout("map");
    let script = Scenario::parse("session", Scenario::SESSION).unwrap();
    let script = script.resolve(&page, &floor.geometry).unwrap();
    let play = |faults: &str| {
        let faults = faults.parse().unwrap();
        story(&serve(&floor, &sim, &page, Box::new(script.clone()), faults))
    };
    let clean = play("loss=0%");
    assert!(clean.len() >= 6, "{clean:?}");
    for faults in ["loss=1%", "loss=5%", "bursts=1s:20ms", "bursts=1.1s:50ms", "bursts=1.3s:90ms"] {
        assert_eq!(play(faults), clean, "{faults}");
    }
}

/// Ten simulated minutes. Rows N1, N2, N4, N5, N7, N12.
#[test]
fn whatever_goes_wrong_at_once_presses_nothing_by_itself_and_every_press_ends() {
    let (floor, sim) = a_floor();
    let page = layout("map");
    let script = Scenario::parse("session", Scenario::SESSION).unwrap();
    let script = script.resolve(&page, &floor.geometry).unwrap();
    let mut presses = 0;
    let mut simulated = Duration::ZERO;
    for seed in 0.. {
        if simulated >= Duration::from_secs(600) {
            break;
        }
        simulated += script.duration();
        let faults = LinkFaults::nemesis(seed, script.duration(), floor.boards.len() as u16);
        let told = serve(&floor, &sim, &page, Box::new(script.clone()), faults);
        presses += check(&told, &script, &page, seed);
    }
    assert!(presses > 20, "{presses} presses: the person must get through now and then");
}

#[test]
fn whatever_goes_wrong_at_once_on_an_empty_floor_is_no_event() {
    let (floor, sim) = a_floor();
    let page = layout("map");
    let length = Duration::from_secs(30);
    for seed in 100..104 {
        let faults = LinkFaults::nemesis(seed, length, floor.boards.len() as u16);
        let told = serve(&floor, &sim, &page, Box::new(Nobody(Instant::START + length)), faults);
        let events: Vec<_> = told.iter().filter(|told| matches!(told, Told::Event(_))).collect();
        assert!(events.is_empty(), "seed {seed}: {events:?}");
    }
}
