//! The window without a display: its parts are found by name, and the mouse acts on the floor.

mod bars;
mod faults;
mod feet;
mod first_steps;
mod floor_check;
mod gallery;
mod handheld;
mod modes;
mod panel;
mod plots;
mod presses;
mod projection;
mod server;
mod share;
mod stage;
mod status;
mod texts;
mod time_line;
mod walks;

use std::sync::mpsc::{Receiver, SyncSender};
use std::sync::{Arc, Mutex};

use eframe::egui::{self, Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::Vec2;

use super::ProjectionOptions;
use super::app::App;
use super::playback::Playback;
use super::time_line::TimeLine;
use super::{
    EventNews, FootSink, LayoutCause, LayoutNews, PreviewCommand, PreviewFoot, PreviewInput, PreviewOptions,
    ProgramChannels, ScopeFeed, Warnings, channels,
};
use crate::preview::Notice;
use crate::preview::sample::{at_rest, map, pressing};
use underfoot::engine::Snapshot;
use underfoot::feel::{DeviceState, DeviceStatus};
use underfoot::floor::{Corner, Floor, SensorId, TileId};
use underfoot::ground::{Crack, GroundCounters, GroundState};
use underfoot::layout::Layout;
use underfoot::schema::{Kinds, builtin_layout, parse_layout};
use underfoot::sense::ContactId;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, Value, WidgetEvent, WidgetId};
use underfoot::wire::LinkState;
use underfoot_scene::scene::Show;

pub(super) fn event(at_ms: u64, id: &str) -> WidgetEvent {
    WidgetEvent {
        at: Instant::from_millis(at_ms),
        id: WidgetId::new(id),
        kind: EventKind::Pressed,
        contact: Some(ContactId(1)),
        force: Newtons(80.0),
        position: Vec2::new(0.5, 0.5),
    }
}

/// A window and the program's ends of its channels.
pub(super) struct Room {
    pub(super) window: Harness<'static, App>,
    snapshots: triple_buffer::Input<Snapshot>,
    events: SyncSender<EventNews>,
    layouts: SyncSender<LayoutNews>,
    notices: SyncSender<Notice>,
    commands: Receiver<PreviewCommand>,
    feet: Arc<Mutex<Vec<PreviewFoot>>>,
    /// The folder for the projection's corners.
    folder: tempfile::TempDir,
}

struct Feet(Arc<Mutex<Vec<PreviewFoot>>>);

impl FootSink for Feet {
    fn lead(&mut self, _over_s: f32, paths: &[Vec<PreviewFoot>]) {
        *self.0.lock().unwrap() = paths.iter().filter_map(|path| path.last().copied()).collect();
    }
}

/// Point of action of a foot, with the centre of pressure of the window's sink.
fn acts_at(foot: &PreviewFoot) -> Vec2 {
    Feet(Arc::default()).centre_of_pressure(foot)
}

struct Silence;

impl ScopeFeed for Silence {
    fn scope(&mut self, _channel: usize) -> &[(f32, f32)] {
        &[(0.0, 0.0); 128]
    }
}

impl Room {
    pub(super) fn simulated() -> Self {
        Self::of(true, 1280.0, 800.0)
    }

    /// A recording that plays through `playback`.
    fn recorded(playback: Box<dyn Playback>) -> Self {
        let mut room = Self::of(false, 1280.0, 800.0);
        room.window.state_mut().time_line = Some(TimeLine::new(playback));
        room.window.state_mut().presses = super::presses::PressLog::recorded();
        room.run(2);
        room
    }

    fn of(simulated: bool, width: f32, height: f32) -> Self {
        let layout = Arc::new(map());
        let (snapshots, output) = triple_buffer::triple_buffer(&at_rest(&layout));
        let (channels, ProgramChannels { events, layouts, notices, commands }) = channels();
        let feet = Arc::<Mutex<Vec<PreviewFoot>>>::default();
        let sink: Box<dyn FootSink> = Box::new(Feet(Arc::clone(&feet)));
        let input = PreviewInput {
            scopes: Some(Box::new(Silence)),
            feet: simulated.then_some(sink),
            choices: vec!["Map navigation".into(), "Surgery".into()],
            effects: underfoot::schema::Effects::builtin().iter().cloned().collect(),
            design: Some(super::DesignInput {
                name: "map".into(),
                text: builtin_layout("map").unwrap().into(),
                path: None,
                kinds_of: Box::new(|_| Ok(Arc::new(Kinds::builtin()))),
                // No folder can exist here.
                state: "/dev/null/underfoot".into(),
            }),
            ..PreviewInput::new(Arc::new(Floor::default()), layout, "simulated floor", output, channels)
        };
        // A folder of this test alone, for the corners of the projection.
        let folder = tempfile::tempdir().unwrap();
        let corners = Some(folder.path().join("projection.txt"));
        let projection = ProjectionOptions { corners, ..ProjectionOptions::default() };
        let settings = Some(folder.path().join("window"));
        let options = PreviewOptions { projection, settings, ..PreviewOptions::default() };
        let app = App::new(input, &options);
        let window = Harness::builder()
            .with_size(vec2(width, height))
            .with_step_dt(1.0 / 60.0)
            .with_context_setup(|ctx| ctx.set_fonts(crate::preview::style::fonts()))
            .build_ui_state(|ui, app: &mut App| app.show(ui), app);
        Self { window, snapshots, events, layouts, notices, commands, feet, folder }
    }

    fn happen(&self, event: WidgetEvent) {
        self.events.send(EventNews::Event(event)).unwrap();
    }

    pub(super) fn run(&mut self, frames: usize) {
        self.window.run_steps(frames);
    }

    fn write(&mut self, snapshot: Snapshot) {
        self.snapshots.write(snapshot);
        self.run(2);
    }

    /// The position on the screen of the control called `name`.
    fn place(&self, name: &str) -> Pos2 {
        self.window.get_by_label(name).rect().center()
    }

    /// The position of the line with this text.
    fn place_of(&self, text: &str) -> Pos2 {
        self.window.get_by_label_contains(text).rect().min
    }

    fn hover(&mut self, at: Pos2) {
        self.window.event(Event::PointerMoved(at));
        self.run(1);
    }

    /// Passes all events within one frame, as a window with slow frames gets them.
    fn at_once(&mut self, events: impl IntoIterator<Item = Event>) {
        self.window.input_mut().events.extend(events);
        self.run(1);
    }

    fn button(&mut self, at: Pos2, button: PointerButton, pressed: bool) {
        self.window.event(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
        self.run(1);
    }

    fn press(&mut self, at: Pos2) {
        self.hover(at);
        self.button(at, PointerButton::Primary, true);
        self.run(15);
    }

    fn release(&mut self, at: Pos2) {
        self.button(at, PointerButton::Primary, false);
        self.run(20);
    }

    fn wheel(&mut self, notches: f32) {
        self.window.event(Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, notches),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        self.run(20);
    }

    fn hold_key(&mut self, key: Key, frames: usize) {
        self.window.key_down(key);
        self.run(frames);
        self.window.key_up(key);
        self.run(1);
    }

    /// The working foot and the standing foot.
    fn feet(&self) -> (Option<PreviewFoot>, Option<PreviewFoot>) {
        let feet = self.feet.lock().unwrap();
        let foot = |left| feet.iter().copied().find(|foot| foot.left == left);
        (foot(false), foot(true))
    }

    pub(super) fn says(&self, text: &str) -> bool {
        self.window.query_all_by_label_contains(text).next().is_some()
    }
}

fn loaded(layout: Arc<Layout>, name: String) -> LayoutNews {
    LayoutNews::Loaded { layout, revision: 0, name, cause: LayoutCause::Saved, warnings: Warnings::default() }
}

fn middle_of(name: &str) -> Vec2 {
    map().widgets.iter().find(|widget| widget.label == name).unwrap().area.centre()
}

#[test]
fn everything_that_can_be_worked_has_a_name_and_room_at_every_size() {
    for (width, height) in [(720.0, 480.0), (900.0, 600.0), (1600.0, 1000.0)] {
        let mut room = Room::of(true, width, height);
        room.notices.send("No sound card was found.".into()).unwrap();
        room.write(pressing(&map()));
        room.window.get_by_label("Stance foot").click();
        room.run(3);
        assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new());
        let floor = room.window.get_by_label("Floor").rect();
        assert!(
            floor.width() > 0.5 * width && floor.height() > 0.7 * height,
            "{floor:?} of {width} x {height}"
        );
        for widget in &map().widgets {
            assert!(floor.contains_rect(room.window.get_by_label(&widget.label).rect()), "{}", widget.label);
        }
    }
}

#[test]
fn why_there_is_no_window_is_said_without_source_lines() {
    let winit = "winit EventLoopError: os error at /somewhere/linux/mod.rs:765: neither WAYLAND_DISPLAY nor DISPLAY is set.";
    assert_eq!(super::desktop::reason(winit), "neither WAYLAND_DISPLAY nor DISPLAY is set");
    assert_eq!(super::desktop::reason("no matching configs"), "no matching configs");
}
