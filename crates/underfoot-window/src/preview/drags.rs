//! The path from mouse to control without a display: pointer, foot, floor, sensing, slider.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use glam::Vec2;

use super::feed::{FootSink, PreviewFoot};
use super::feet::{HandInput, MouseFeet, Move};
use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::floor::Geometry;
use underfoot::layout::{Layout, Widget};
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::sink::{EventSink, Report};
use underfoot::source::{FaultInjector, LinkFaults};
use underfoot::units::Instant;
use underfoot::widget::{Behaviour, EventKind, Value, WidgetEvent};
use underfoot::wire::LinkState;
use underfoot_sim::{
    Foot, FootHandle, Host, Pace, SimConfig, SimFloor, SimulatedSource, calibrated, feet_by_hand,
};

struct Mouse(FootHandle);

impl FootSink for Mouse {
    fn lead(&mut self, over_s: f32, paths: &[Vec<PreviewFoot>]) {
        let foot = |shoe: &PreviewFoot| Foot {
            position: shoe.position,
            heading: shoe.heading_rad,
            length_m: shoe.length_m - 0.01,
            force: shoe.force,
            roll: shoe.roll,
            left: shoe.left,
        };
        self.0.lead(over_s, paths.iter().map(|path| path.iter().map(foot).collect()).collect());
    }
}

/// Records its reports.
#[derive(Clone, Default)]
struct Told(Arc<Mutex<(Vec<WidgetEvent>, Vec<LinkState>)>>);

impl EventSink for Told {
    fn report(&mut self, report: &Report<'_>) {
        let mut told = self.0.lock().unwrap();
        match report {
            Report::Event(event) => told.0.push(WidgetEvent::clone(event)),
            Report::Link(_, state) => told.1.push(*state),
            _ => {}
        }
    }
}

/// A host whose time the test sets.
#[derive(Clone, Default)]
struct ByHand(Arc<Mutex<Duration>>);

impl ByHand {
    fn pass(&self, length: Duration) {
        *self.0.lock().unwrap() += length;
    }
}

impl Host for ByHand {
    fn elapsed(&self) -> Duration {
        *self.0.lock().unwrap()
    }

    fn sleep(&self, length: Duration) {
        self.pass(length);
    }
}

/// A running simulated floor, the mouse on it, and a window with a fixed number of frames per second.
struct Table {
    server: Server,
    host: ByHand,
    feet: MouseFeet,
    sink: Mouse,
    told: Told,
    snapshot: Snapshot,
    frame_s: f32,
    /// The end of the frame on the floor's clock, in seconds.
    frame_end_s: f64,
    most_contacts: usize,
    pointer: Vec2,
    down: bool,
}

impl Table {
    fn of(layout: &Layout, frames_per_s: f32, faults: LinkFaults) -> Self {
        let floor = Floor::default();
        let sim = SimFloor::new(&floor, SimConfig::default(), 1);
        let floor = calibrated(&floor, &sim, 1).unwrap();
        let (handle, driver) = feet_by_hand();
        let host = ByHand::default();
        let source = SimulatedSource::on(sim, Box::new(driver), Pace::RealTime, Arc::new(host.clone()));
        let source = FaultInjector::new(source, faults, 1);
        let told = Told::default();
        let mut table = Self {
            server: Server::new(&floor, layout.clone(), Method::default(), source)
                .with_events(Box::new(told.clone())),
            host,
            feet: MouseFeet::new(),
            sink: Mouse(handle),
            told,
            snapshot: Snapshot::default(),
            frame_s: 1.0 / frames_per_s,
            frame_end_s: 0.0,
            most_contacts: 0,
            pointer: Vec2::ZERO,
            down: false,
        };
        // By now the tare has been measured and the sensors have settled.
        table.rest(1.0);
        table
    }

    /// One frame of the window: the actions of the mouse are applied at its end.
    fn frame(&mut self, moves: Vec<Move>) {
        self.frame_end_s += f64::from(self.frame_s);
        while self.server.engine().now().secs() < self.frame_end_s {
            self.server.turn().unwrap();
            self.server.snapshot(&mut self.snapshot);
            self.most_contacts = self.most_contacts.max(self.snapshot.contacts.len());
        }
        let hand = HandInput {
            moves,
            pointer: Some(self.pointer),
            down: self.down,
            elapsed_s: self.frame_s,
            ..HandInput::default()
        };
        self.feet.step(&hand, &mut self.sink);
    }

    fn rest(&mut self, length_s: f32) {
        for _ in 0..(length_s / self.frame_s).ceil() as usize {
            self.frame(vec![]);
        }
    }

    fn press(&mut self, at: Vec2) {
        (self.pointer, self.down) = (at, true);
        self.frame(vec![Move::To(at), Move::Press(at)]);
    }

    fn release(&mut self) {
        self.down = false;
        self.frame(vec![Move::Release(self.pointer)]);
    }

    /// Moves the mouse to `to` at `speed` metres per second; it reports 125 times a second.
    fn drag(&mut self, to: Vec2, speed: f32) {
        let from = self.pointer;
        let length_s = from.distance(to) / speed;
        let mut passed = 0.0;
        while passed < length_s {
            let until = (passed + self.frame_s).min(length_s);
            let mut moves = Vec::new();
            while passed < until {
                passed = (passed + 0.008).min(until);
                self.pointer = from.lerp(to, passed / length_s);
                moves.push(Move::To(self.pointer));
            }
            self.frame(moves);
        }
    }

    fn events(&self) -> Vec<WidgetEvent> {
        std::mem::take(&mut self.told.0.lock().unwrap().0)
    }

    fn links(&self) -> Vec<LinkState> {
        self.told.0.lock().unwrap().1.clone()
    }

    fn now(&self) -> Instant {
        self.server.engine().now()
    }
}

fn layout(name: &str) -> Layout {
    let text = builtin_layout(name).unwrap();
    parse_layout(text, name, &Kinds::builtin(), &Geometry::default()).unwrap().layout
}

/// A place on the control's track, in floor metres.
fn place(widget: &Widget, share: f32) -> Vec2 {
    let Behaviour::Slider(slider) = &widget.behaviour else { panic!("{} is not a slider", widget.id) };
    let size = widget.area.size();
    widget.area.min + slider.track.place_at(share, size) * size
}

fn number(value: Option<Value>) -> f32 {
    match value {
        Some(Value::Number(number)) => number,
        other => panic!("{other:?}"),
    }
}

/// Drags each slider of the built-in layouts there and back at each speed, at `frames_per_s`.
fn drag_all(frames_per_s: f32) {
    let mut dragged = 0;
    for name in builtin_layouts() {
        let layout = layout(name);
        for (index, widget) in layout.widgets.iter().enumerate() {
            let Behaviour::Slider(slider) = &widget.behaviour else { continue };
            if widget.page.is_some_and(|page| page != 0) {
                continue;
            }
            let mut table = Table::of(&layout, frames_per_s, LinkFaults::default());
            for (count, speed) in [0.2, 0.35, 0.5, 0.75, 1.0].into_iter().enumerate() {
                let (from, to) = if count % 2 == 0 { (0.15, 0.85) } else { (0.85, 0.15) };
                let before = number(table.snapshot.widgets[index].value);
                table.press(place(widget, from));
                table.drag(place(widget, to), speed);
                table.rest(0.3);
                let after = number(table.snapshot.widgets[index].value);
                table.release();
                table.rest(0.4);
                let what = format!("{name}: {} at {frames_per_s} frames a second, {speed} m/s", widget.id);
                let kinds: Vec<EventKind> = table.events().into_iter().map(|event| event.kind).collect();
                assert_eq!(
                    kinds.iter().filter(|kind| matches!(kind, EventKind::Pressed)).count(),
                    1,
                    "{what}: {kinds:?}"
                );
                assert!(!kinds.contains(&EventKind::Cancelled), "{what}: {kinds:?}");
                assert_eq!(kinds.last(), Some(&EventKind::Released), "{what}: {kinds:?}");
                match slider.mapping {
                    underfoot::widget::Mapping::Absolute => {
                        let wanted = slider.scale.at(to);
                        let off = (after - wanted).abs() / slider.scale.range();
                        // A tenth of a slider is about 3 cm, the position error of a foot across seams.
                        assert!(off < 0.1, "{what}: {after} for {wanted}");
                    }
                    _ => assert_ne!(before, after, "{what}"),
                }
                dragged += 1;
            }
            assert_eq!(table.most_contacts, 1, "{name}: {}: a second foot", widget.id);
            assert!(!table.links().contains(&LinkState::Lost));
        }
    }
    assert!(dragged >= 15, "{dragged}");
}

#[test]
fn sliders_follow_the_mouse_at_ten_frames_a_second() {
    drag_all(10.0);
}

#[test]
fn sliders_follow_the_mouse_at_thirty_frames_a_second() {
    drag_all(30.0);
}

#[test]
fn sliders_follow_the_mouse_at_sixty_frames_a_second() {
    drag_all(60.0);
}

#[test]
fn a_machine_that_stands_still_for_seconds_loses_no_link_and_cancels_no_press() {
    let map = layout("map");
    let zoom = map.widgets.iter().position(|widget| widget.id == "zoom").unwrap();
    let mut table = Table::of(&map, 60.0, LinkFaults::default());
    table.press(place(&map.widgets[zoom], 0.2));
    table.rest(0.3);
    for pause_s in [0.05, 0.1, 0.3, 1.0, 5.0] {
        let before = table.now();
        table.host.pass(Duration::from_secs_f32(pause_s));
        table.frame(vec![]);
        assert!(table.now().since(before) < Duration::from_millis(70), "the floor waited");
        table.drag(place(&map.widgets[zoom], 0.2 + 0.1 * pause_s), 0.4);
        assert!(table.snapshot.widgets[zoom].pressed, "after {pause_s} s");
    }
    table.release();
    table.rest(0.4);
    let kinds: Vec<EventKind> = table.events().into_iter().map(|event| event.kind).collect();
    assert!(kinds.contains(&EventKind::Released) && !kinds.contains(&EventKind::Cancelled), "{kinds:?}");
    assert_eq!(table.links(), [LinkState::Live]);
}

#[test]
fn a_fault_that_cuts_the_link_still_cancels_the_press() {
    let map = layout("map");
    let zoom = map.widgets.iter().find(|widget| widget.id == "zoom").unwrap();
    let boards: Vec<String> = (0..6).map(|board| format!("board={board}:2s..2.3s")).collect();
    let cut =
        boards.iter().fold(LinkFaults::default(), |faults, written| faults.and(written.parse().unwrap()));
    let mut table = Table::of(&map, 60.0, cut);
    table.press(place(zoom, 0.2));
    table.rest(2.0);
    let kinds: Vec<EventKind> = table.events().into_iter().map(|event| event.kind).collect();
    assert!(kinds.contains(&EventKind::Cancelled), "{kinds:?}");
    assert!(table.links().contains(&LinkState::Lost));
}
