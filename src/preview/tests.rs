//! The window without a display: what a person sees by name, and what the mouse does to the floor.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};

use eframe::egui::{self, Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::Vec2;

use super::ProjectionOptions;
use super::app::App;
use super::{
    FootSink, LayoutCause, LayoutNews, PreviewCommand, PreviewFoot, PreviewInput, PreviewOptions, ScopeFeed,
    Warnings,
};
use crate::engine::Snapshot;
use crate::floor::{Corner, Floor, SensorId, TileId};
use crate::ground::{Crack, GroundCounters, GroundState};
use crate::layout::Layout;
use crate::scene::sample::{at_rest, map, pressing};
use crate::schema::{Kinds, builtin_layout, parse_layout};
use crate::sense::ContactId;
use crate::units::{Instant, Newtons};
use crate::widget::{EventKind, Value, WidgetEvent, WidgetId};
use crate::wire::LinkState;

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

/// A window and everything on its other side.
struct Room {
    window: Harness<'static, App>,
    snapshots: triple_buffer::Input<Snapshot>,
    events: Sender<WidgetEvent>,
    layouts: Sender<LayoutNews>,
    notices: Sender<String>,
    commands: Receiver<PreviewCommand>,
    feet: Arc<Mutex<Vec<PreviewFoot>>>,
}

struct Feet(Arc<Mutex<Vec<PreviewFoot>>>);

impl FootSink for Feet {
    fn lead(&mut self, _over_s: f32, paths: &[Vec<PreviewFoot>]) {
        *self.0.lock().unwrap() = paths.iter().filter_map(|path| path.last().copied()).collect();
    }
}

/// Where the force of a foot acts, as the window was told.
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
    fn simulated() -> Self {
        Self::of(true, 1280.0, 800.0)
    }

    fn of(simulated: bool, width: f32, height: f32) -> Self {
        let layout = Arc::new(map());
        let (snapshots, output) = triple_buffer::triple_buffer(&at_rest(&layout));
        let (events, event_list) = channel();
        let (layouts, news) = channel();
        let (notices, notes) = channel();
        let (sender, commands) = channel();
        let feet = Arc::<Mutex<Vec<PreviewFoot>>>::default();
        let sink: Box<dyn FootSink> = Box::new(Feet(Arc::clone(&feet)));
        let input = PreviewInput {
            floor: Arc::new(Floor::default()),
            layout,
            warnings: Warnings::default(),
            source: "simulated floor".into(),
            snapshots: output,
            events: event_list,
            layouts: news,
            notices: notes,
            scopes: Some(Box::new(Silence)),
            feet: simulated.then_some(sink),
            shoes: None,
            choices: vec!["Map navigation".into(), "Surgery".into()],
            effects: crate::schema::Effects::builtin().iter().cloned().collect(),
            design: Some(super::DesignInput {
                name: "map".into(),
                text: builtin_layout("map").unwrap().into(),
                path: None,
                kinds_of: Box::new(|_| Ok(Arc::new(Kinds::builtin()))),
                // Where no folder can be.
                state: "/dev/null/underfoot".into(),
            }),
            commands: sender,
        };
        // Nobody's own corners.
        let corners = Some(std::env::temp_dir().join("underfoot no such folder/projection.txt"));
        let projection = ProjectionOptions { corners, ..ProjectionOptions::default() };
        let app = App::new(input, &PreviewOptions { projection, ..PreviewOptions::default() });
        let window = Harness::builder()
            .with_size(vec2(width, height))
            .with_step_dt(1.0 / 60.0)
            .build_ui_state(|ui, app: &mut App| app.show(ui), app);
        Self { window, snapshots, events, layouts, notices, commands, feet }
    }

    fn run(&mut self, frames: usize) {
        self.window.run_steps(frames);
    }

    fn write(&mut self, snapshot: Snapshot) {
        self.snapshots.write(snapshot);
        self.run(2);
    }

    /// Where on the screen the control called `name` is.
    fn place(&self, name: &str) -> Pos2 {
        self.window.get_by_label(name).rect().center()
    }

    fn hover(&mut self, at: Pos2) {
        self.window.event(Event::PointerMoved(at));
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

    /// The foot that works, and the one that stands.
    fn feet(&self) -> (Option<PreviewFoot>, Option<PreviewFoot>) {
        let feet = self.feet.lock().unwrap();
        let foot = |left| feet.iter().copied().find(|foot| foot.left == left);
        (foot(false), foot(true))
    }

    fn says(&self, text: &str) -> bool {
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
fn a_press_on_the_floor_puts_force_where_the_mouse_is() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.hover(home);
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO, "in the air above it");
    room.press(home);
    let foot = room.feet().0.unwrap();
    assert!((foot.force.0 - 150.0).abs() < 1.0, "{foot:?}");
    // A pixel is about 3 mm of floor in this window.
    let off = acts_at(&foot).distance(middle_of("Home"));
    assert!(off < 0.004, "{off} m beside the control");
    let west = room.place("West");
    room.hover(west);
    let off = acts_at(&room.feet().0.unwrap()).distance(middle_of("West"));
    assert!(off < 0.004, "dragging slides: {off}");
    room.release(west);
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO);
}

#[test]
fn the_wheel_presses_harder_and_softer() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.press(home);
    room.wheel(3.0);
    let harder = room.feet().0.unwrap().force.0;
    assert!((harder - 150.0 * 1.12_f32.powi(3)).abs() < 2.0, "{harder}");
    room.wheel(-6.0);
    assert!(room.feet().0.unwrap().force.0 < 120.0);
}

#[test]
fn q_e_and_the_right_button_turn_the_foot_about_its_pressure() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.press(home);
    room.hold_key(Key::Q, 12);
    let left = room.feet().0.unwrap();
    assert!((0.2..0.6).contains(&left.heading_rad), "Q turns to the left: {}", left.heading_rad);
    assert!(acts_at(&left).distance(middle_of("Home")) < 0.004);
    room.hold_key(Key::E, 24);
    assert!(room.feet().0.unwrap().heading_rad < -0.1, "E turns to the right");
    room.release(home);
    let before = room.feet().0.unwrap().heading_rad;
    room.button(home, PointerButton::Secondary, true);
    room.hover(home + vec2(-50.0, 0.0));
    room.button(home + vec2(-50.0, 0.0), PointerButton::Secondary, false);
    let turned = room.feet().0.unwrap().heading_rad - before;
    assert!((turned - 0.6).abs() < 0.05, "50 points to the left: {turned}");
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO, "the right button does not press");
}

#[test]
fn the_standing_foot_stays_where_space_left_it() {
    let mut room = Room::simulated();
    let stance = room.place("South");
    room.hover(stance);
    room.window.key_press(Key::Space);
    room.run(20);
    let standing = room.feet().1.unwrap();
    assert!(standing.position.distance(middle_of("South")) < 0.004);
    assert!((standing.force.0 - 600.0).abs() < 2.0);
    let home = room.place("Home");
    room.press(home);
    assert_eq!(room.feet().1.unwrap().position, standing.position);
    assert!(room.feet().0.unwrap().force.0 > 100.0, "both feet are down");
    room.release(home);
    // Dragged by its handle it moves, and the working foot does not press.
    let handle = room.place("Standing foot");
    room.hover(handle);
    room.button(handle, PointerButton::Primary, true);
    room.hover(handle + vec2(80.0, 0.0));
    let moved = room.feet();
    assert!(moved.1.unwrap().position.x > standing.position.x + 0.1);
    assert_eq!(moved.0.unwrap().force, Newtons::ZERO, "the hand holds the standing foot");
    room.button(handle + vec2(80.0, 0.0), PointerButton::Primary, false);
    // Space on it lifts it.
    room.window.key_press(Key::Space);
    room.run(2);
    assert!(room.feet().1.is_none());
}

#[test]
fn a_button_stands_the_foot_in_the_layouts_own_place() {
    let mut room = Room::simulated();
    room.window.get_by_label("Stance foot").click();
    room.run(3);
    assert_eq!(room.feet().1.unwrap().position, map().stances[0].area.centre());
    room.window.get_by_label("Stance foot").click();
    room.run(3);
    assert!(room.feet().1.is_none());
}

#[test]
fn shift_chooses_a_tile_and_presses_nothing() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.hover(home);
    let modifiers = Modifiers::SHIFT;
    for pressed in [true, false] {
        room.window.event(Event::ModifiersChanged(modifiers));
        room.window.event(Event::PointerButton {
            pos: home,
            button: PointerButton::Primary,
            pressed,
            modifiers,
        });
        room.run(5);
        assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO);
    }
    let tile = Floor::default().geometry.tile_under(middle_of("Home")).unwrap();
    assert!(room.says(&format!("Tile {}, {}", tile.column, tile.row)) && room.says("Follow the foot"));
}

// R5
#[test]
fn a_window_that_loses_the_keyboard_lifts_the_foot() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    room.press(home);
    room.window.event(Event::WindowFocused(false));
    room.run(20);
    assert_eq!(room.feet().0.unwrap().force, Newtons::ZERO, "its button may come up elsewhere, unseen");
}

#[test]
fn a_real_floor_has_no_mouse_feet_and_a_click_chooses_a_tile() {
    let mut room = Room::of(false, 1280.0, 800.0);
    assert!(!room.says("Stance foot"));
    let zoom = room.place("Zoom in");
    room.press(zoom);
    assert!(room.feet.lock().unwrap().is_empty());
    let tile = Floor::default().geometry.tile_under(middle_of("Zoom in")).unwrap();
    assert!(room.says(&format!("Tile {}, {}", tile.column, tile.row)));
    room.window.key_press(Key::ArrowRight);
    room.run(2);
    assert!(room.says(&format!("Tile {}, {}", tile.column + 1, tile.row)));
    room.window.get_by_label("Follow the foot").click();
    room.run(2);
    assert!(room.says("follows the foot"));
}

#[test]
fn the_panel_follows_the_foot_and_lists_its_sensors() {
    let mut room = Room::simulated();
    let mut snapshot = pressing(&map());
    let index = Floor::default().geometry.index(TileId::new(0, 4)).unwrap();
    snapshot.tiles[index].quality[2] = crate::sense::Quality::Faulty;
    room.write(snapshot);
    assert!(room.says("Tile 0, 4"));
    assert!(room.says(", faulty"));
    assert!(room.says("Contact 7 cursor: 152 newtons"));
    assert!(room.says("Contact 6 : 520 newtons"));
    let pressed = room.window.get_by_label("Zoom in");
    assert_eq!(pressed.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
}

#[test]
fn the_panel_says_in_one_line_how_the_sensors_are_and_names_those_in_trouble() {
    let mut room = Room::simulated();
    let mut snapshot = pressing(&map());
    snapshot.health.counts = [144, 0, 0, 0];
    room.write(snapshot.clone());
    assert!(room.says("Sensors: all 144 live"));
    snapshot.health.counts = [143, 0, 0, 1];
    let sensor = SensorId { tile: TileId::new(2, 1), corner: Corner::SouthWest };
    snapshot.health.troubles.push((sensor, crate::sense::Trouble::Stuck));
    room.write(snapshot);
    room.window.get_by_label("Sensors: 1 faulty, 143 live").click();
    room.run(20);
    assert!(room.says("tile (2, 1) sw: stuck"));
}

#[test]
fn events_are_listed_newest_first() {
    let mut room = Room::simulated();
    room.events.send(event(100, "home")).unwrap();
    let changed = EventKind::Changed(Value::Number(7.25));
    room.events.send(WidgetEvent { kind: changed, ..event(200, "time") }).unwrap();
    room.run(2);
    let (older, newer) = (room.place("home pressed"), room.place("time changed 7.250"));
    assert!(newer.y < older.y);
    assert!(room.says("2 so far"));
}

#[test]
fn the_list_of_events_is_searched_and_copied() {
    let mut room = Room::simulated();
    for (at, id) in [(100, "home"), (200, "time")] {
        room.events.send(event(at, id)).unwrap();
    }
    room.run(2);
    room.window.get_by_label("Search events").focus();
    room.run(1);
    room.window.event(Event::Text("hom".into()));
    room.run(2);
    assert!(room.says("home pressed") && !room.says("time pressed"));
    // Keys that are typed press nothing and mute nothing.
    assert!(room.commands.try_recv().is_err());
    room.window.get_by_label("Copy events").click();
    room.window.step();
    let copied = room.window.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    assert!(copied.is_some_and(|text| text.contains("\"home\"") && !text.contains("\"time\"")));
}

#[test]
fn a_lost_floor_is_said_across_the_view() {
    let mut room = Room::simulated();
    let mut snapshot = at_rest(&map());
    snapshot.counters.packets = 6000;
    room.write(snapshot.clone());
    assert!(!room.says("No sensor packets"));
    snapshot.link = LinkState::Lost;
    room.snapshots.write(snapshot);
    room.run(24);
    assert!(room.says("No sensor packets for 0.4 s. Every control is released."));
}

#[test]
fn a_bad_layout_is_told_while_the_last_good_one_works() {
    let mut room = Room::simulated();
    let diagnostics: String =
        (1..=30).map(|line| format!("error: layouts/map.ron:{line}:5: unknown field `pres_n`\n")).collect();
    room.layouts.send(LayoutNews::Refused { name: "map.ron".into(), diagnostics }).unwrap();
    room.run(3);
    assert!(room.says("map.ron has problems"));
    assert!(room.says("layouts/map.ron:30:5: unknown field"));
    let home = room.place("Home");
    room.press(home);
    assert!(acts_at(&room.feet().0.unwrap()).distance(middle_of("Home")) < 0.005);
    room.release(home);
    // Mended: another page of controls, and no more problems.
    let mut layout = Layout { title: "Mended".into(), ..map() };
    layout.widgets.truncate(1);
    let name = "map.ron".into();
    room.layouts.send(loaded(Arc::new(layout), name)).unwrap();
    room.run(3);
    assert!(!room.says("has problems"));
    assert!(room.says("saved changes loaded"));
    assert!(!room.says("Home") && room.says("Zoom in"));
}

#[test]
fn notices_stay_until_they_are_put_away() {
    let mut room = Room::simulated();
    room.notices.send("No sound card was found.".into()).unwrap();
    room.run(3);
    assert!(room.says("No sound card was found."));
    room.window.get_by_label("Hide: No sound card was found.").click();
    room.run(3);
    assert!(!room.says("No sound card was found."));
}

#[test]
fn the_floor_is_muted_by_button_and_key_and_says_so() {
    let mut room = Room::simulated();
    room.window.get_by_label("Mute").click();
    room.run(2);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Mute(true)));
    assert!(!room.says("muted"), "it is once the floor says so");
    let mut snapshot = at_rest(&map());
    snapshot.muted.all = true;
    room.write(snapshot.clone());
    assert!(room.says("muted"));
    let button = room.window.get_by_label("Mute");
    assert_eq!(button.accesskit_node().toggled(), Some(egui::accesskit::Toggled::True));
    room.window.key_press(Key::M);
    room.run(2);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Mute(false)));
    // One tile: the selected one.
    snapshot.muted.all = false;
    room.write(snapshot.clone());
    let tile = Floor::default().geometry.tile_under(middle_of("Home")).unwrap();
    room.window.get_by_label("Mute tile").click();
    room.run(2);
    let Ok(PreviewCommand::MuteTile { tile: selected, on: true }) = room.commands.try_recv() else {
        panic!("not muted")
    };
    snapshot.muted.tiles = vec![selected, tile];
    room.write(snapshot);
    assert!(room.says("2 muted"));
    room.window.get_by_label("Mute tile").click();
    room.run(2);
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::MuteTile { tile: selected, on: false }));
}

#[test]
fn the_panel_counts_what_gave_way_underfoot() {
    let mut room = Room::simulated();
    let text = builtin_layout("pond").unwrap();
    let pond = parse_layout(text, "pond", &Kinds::builtin(), &Floor::default().geometry).unwrap().layout;
    let mut snapshot = at_rest(&pond);
    let layout = Arc::new(pond);
    room.layouts.send(loaded(layout, "pond".into())).unwrap();
    let counters = GroundCounters { events: 5, unfelt: 0, evicted: 2 };
    let cracks = vec![Crack::default(); 3];
    snapshot.grounds = vec![GroundState { cracks, counters, ..GroundState::default() }];
    room.write(snapshot);
    assert!(!room.says("evicted"), "one line until it is opened");
    room.window.get_by_label("Ice: 3 pieces").click();
    room.run(20);
    assert!(room.says("evicted by new pieces: 2") && room.says("seeds: 0"));
}

#[test]
fn an_apps_part_can_be_played_from_the_panel() {
    let mut room = Room::simulated();
    room.window.get_by_label("Controls, as an app sets them").click();
    room.run(20);
    room.window.get_by_label("home works").click();
    room.run(3);
    let id = WidgetId::new("home");
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Enable { id, enabled: false }));
    room.window.get_by_label("satellite value").scroll_to_me();
    room.run(3);
    room.window.get_by_label("satellite value").click();
    room.run(3);
    let id = WidgetId::new("satellite");
    assert_eq!(room.commands.try_recv(), Ok(PreviewCommand::Set { id, value: Value::Switch(true) }));
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
    assert_eq!(super::reason(winit), "neither WAYLAND_DISPLAY nor DISPLAY is set");
    assert_eq!(super::reason("no matching configs"), "no matching configs");
}

#[test]
fn an_effect_is_tuned_played_and_saved() {
    let mut room = Room::of(true, 1280.0, 900.0);
    assert!(!room.says("Revert"));
    room.window.get_by_label("Effects").click();
    room.run(3);
    room.window.get_by_label("Play").click();
    room.run(3);
    let Ok(PreviewCommand::Feel { effect, tile, .. }) = room.commands.try_recv() else {
        panic!("nothing is played")
    };
    assert_eq!(effect.kind.name(), "Click");
    assert!(tile < 36);
    // A slider to its far end: seen at once, and played once the hand rests.
    let level = room.window.get_by_label("level_n").rect();
    let end = Pos2::new(level.right() - 70.0, level.center().y);
    room.press(end);
    room.release(end);
    room.run(20);
    let Ok(PreviewCommand::Feel { effect: louder, .. }) = room.commands.try_recv() else {
        panic!("not played by itself")
    };
    assert_ne!(louder, effect);
    assert!(!room.window.get_by_label("Revert").accesskit_node().is_disabled());
    room.window.get_by_label("Name to save as").focus();
    room.run(2);
    room.window.get_by_label("Name to save as").type_text("_2");
    room.run(2);
    room.window.get_by_label("Save as RON").click();
    room.run(3);
    let Ok(PreviewCommand::SaveEffect { name, text }) = room.commands.try_recv() else { panic!("not saved") };
    let (saved, _) = crate::schema::parse_effect(&text, "saved.ron", &Default::default()).unwrap();
    assert_eq!((name.as_str(), &saved.effect), ("crisp_click_2", &louder));
    assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new());
    room.window.get_by_label("Effects").click();
    room.run(3);
    assert!(!room.says("Revert"));
}

#[test]
fn a_control_with_the_focus_is_pressed_and_slid_by_keys() {
    let mut room = Room::simulated();
    room.window.get_by_label("Home").focus();
    room.run(2);
    room.window.key_down(Key::Enter);
    room.run(3);
    let foot = room.feet().0.unwrap();
    assert!((foot.force.0 - 150.0).abs() < 1.0 && acts_at(&foot).distance(middle_of("Home")) < 0.001);
    room.window.key_up(Key::Enter);
    room.run(3);
    assert!(room.feet().0.is_none_or(|foot| foot.force == Newtons::ZERO));
    room.window.get_by_label("Time of day").focus();
    room.run(2);
    room.window.key_down(Key::Space);
    room.run(2);
    room.window.key_down(Key::ArrowRight);
    room.run(20);
    let foot = room.feet().0.unwrap();
    let way = acts_at(&foot) - middle_of("Time of day");
    assert!(foot.force.0 > 100.0 && way.x > 0.05 && way.y.abs() < 0.001, "{way}");
    assert!(room.feet().1.is_none(), "Space is the control's while it has the focus");
}

#[test]
fn warnings_are_counted_and_listed_and_an_opened_layout_is_not_called_saved() {
    let mut room = Room::simulated();
    assert!(!room.says("warning"));
    let warnings = Warnings { count: 2, text: "warning[U101]: \"home\" is 4.0 cm wide".into() };
    let (layout, name) = (Arc::new(map()), "map".to_owned());
    room.layouts
        .send(LayoutNews::Loaded { layout, revision: 0, name, cause: LayoutCause::Opened, warnings })
        .unwrap();
    room.run(3);
    assert!(room.says("map: opened") && !room.says("saved"));
    assert!(!room.says("U101"));
    room.window.get_by_label("2 warnings").click();
    room.run(3);
    assert!(room.says("U101"));
}

#[test]
fn sensors_of_a_lost_floor_are_not_called_live() {
    let mut room = Room::simulated();
    let mut snapshot = at_rest(&map());
    snapshot.health.counts = [144, 0, 0, 0];
    snapshot.link = LinkState::Lost;
    room.write(snapshot);
    assert!(room.says("Sensors: none heard") && !room.says("144 live"));
}

#[test]
fn ctrl_with_the_wheel_zooms_and_leaves_the_force() {
    let mut room = Room::simulated();
    let home = room.place("Home");
    let before = room.window.get_by_label("Home").rect();
    room.hover(home);
    room.window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, 4.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::CTRL | Modifiers::COMMAND,
    });
    room.run(30);
    let after = room.window.get_by_label("Home").rect();
    assert!(after.width() > 1.05 * before.width(), "{before} {after}");
    assert!((after.center() - home).length() < 2.0, "what is under the mouse stays there");
    room.press(home);
    assert!((room.feet().0.unwrap().force.0 - 150.0).abs() < 1.0);
}

#[test]
fn the_projection_shows_controls_only_and_is_closed_by_the_key_that_opened_it() {
    let mut room = Room::simulated();
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(room.says("Projected floor") && room.says("Projected Home"));
    assert!(!room.says("Corner 1"), "feet and stray clicks move nothing");
    room.window.key_press(Key::F11);
    room.run(3);
    assert!(!room.says("Projected floor"));
}
