//! The engine driven with point loads on an ideal floor.

use std::sync::Arc;
use std::time::Duration;

use arrayvec::ArrayVec;
use glam::Vec2;

use super::*;
use crate::feel::{Click, Cue, Feel, Friction, Mode};
use crate::floor::{Geometry, Rect};
use crate::layout::{Colour, CursorRule, Layout, Look, Region, Shape, Widget};
use crate::sense::{ForceFrame, Method, Quality};
use crate::units::{Instant, Newtons};
use crate::widget::{
    Behaviour, ButtonSpec, EventKind, Scale, SetError, SliderSpec, SwitchSpec, Thresholds, Value, WidgetId,
};

const AT: Thresholds = Thresholds::new(Newtons(60.0), Newtons(40.0));

fn widget(id: &str, min: Vec2, size: Vec2, behaviour: Behaviour) -> Widget {
    let click = |hz| Click {
        modes: ArrayVec::from_iter([Mode { frequency_hz: hz, decay_s: 0.02, amplitude: 1.0 }]),
        level: Newtons(10.0),
        ..Click::default()
    };
    let friction = Friction {
        level: Newtons(5.0),
        low_hz: 80.0,
        high_hz: 300.0,
        full_speed_m_s: 0.5,
        full_force: Newtons(100.0),
    };
    Widget {
        id: WidgetId::new(id),
        kind: behaviour.name().into(),
        region: 0,
        page: None,
        goto: None,
        area: Rect::from_min_size(min, size),
        label: String::new(),
        behaviour,
        feel: Feel {
            press: Some(Arc::new(click(180.0).into())),
            release: Some(Arc::new(click(240.0).into())),
            drag: Some(Arc::new(friction.into())),
            ..Feel::default()
        },
        send: Vec::new(),
        look: Look {
            shape: Shape::Box,
            face: Colour::default(),
            lit: Colour::default(),
            ink: Colour::default(),
            icon: None,
        },
    }
}

/// A button `home`, a slider `zoom` and a switch `light` on the paper's floor, well apart.
fn page() -> Layout {
    let size = Vec2::splat(0.2);
    let home = Behaviour::Button(ButtonSpec::new(AT));
    let light = Behaviour::Switch(SwitchSpec { thresholds: AT, initial: false });
    let zoom = SliderSpec::new(AT, Scale::UNIT);
    Layout {
        title: "Test page".into(),
        regions: vec![Region {
            id: "page".into(),
            area: Rect::from_min_size(Vec2::new(0.0, 0.6), Vec2::new(1.824, 1.224)),
            cursor: CursorRule::Largest,
            send: Vec::new(),
        }],
        stances: Vec::new(),
        pages: Vec::new(),
        targets: Vec::new(),
        grounds: Vec::new(),
        widgets: vec![
            widget("home", Vec2::new(0.35, 0.95), size, home),
            widget("light", Vec2::new(1.25, 0.95), size, light),
            widget("zoom", Vec2::new(0.4, 1.4), Vec2::new(1.0, 0.2), Behaviour::Slider(zoom)),
        ],
    }
}

const HOME: Vec2 = Vec2::new(0.45, 1.05);
const LIGHT: Vec2 = Vec2::new(1.35, 1.05);

/// An engine with the point loads of feet as its input, one frame a millisecond.
struct Floor {
    engine: Engine,
    geometry: Geometry,
    now: Instant,
    events: Vec<(String, EventKind)>,
    cues: Vec<Cue>,
    slip_speeds: Vec<f32>,
}

impl Floor {
    fn with_page() -> Self {
        let geometry = Geometry::default();
        let mut floor = Self {
            engine: Engine::new(geometry, page(), Method::Eq4),
            geometry,
            now: Instant::START,
            events: Vec::new(),
            cues: Vec::new(),
            slip_speeds: Vec::new(),
        };
        floor.stand(&[], 30);
        floor
    }

    fn frame(&mut self, feet: &[(Vec2, f32)]) -> ForceFrame {
        let mut frame = ForceFrame::empty(&self.geometry);
        self.now = self.now + Duration::from_millis(1);
        frame.at = self.now;
        frame.received = self.now;
        for &(at, force) in feet {
            frame.add_load(&self.geometry, at, Newtons(force));
        }
        frame
    }

    fn give(&mut self, frame: &ForceFrame) {
        let step = self.engine.step(frame);
        self.events.extend(step.events.iter().map(|event| (event.id.to_string(), event.kind)));
        self.cues.extend_from_slice(step.cues);
        self.slip_speeds.extend(step.sustained.iter().map(|sustained_cue| sustained_cue.speed_m_s));
    }

    fn stand(&mut self, feet: &[(Vec2, f32)], millis: u64) {
        for _ in 0..millis {
            let frame = self.frame(feet);
            self.give(&frame);
        }
    }

    /// Slides a foot in a straight line at `speed` metres per second.
    fn slide(&mut self, from: Vec2, to: Vec2, force: f32, speed: f32) {
        let millis = (from.distance(to) / speed * 1000.0) as u16;
        for step in 0..millis {
            let at = from.lerp(to, f32::from(step) / f32::from(millis));
            self.stand(&[(at, force)], 1);
        }
    }

    fn unsensed(&mut self, millis: u64) {
        for _ in 0..millis {
            let mut frame = self.frame(&[]);
            frame.quality.fill([Quality::Stale; 4]);
            self.give(&frame);
        }
    }

    fn events_of(&mut self, id: &str) -> Vec<EventKind> {
        let kinds = self.events.iter().filter(|(of, _)| of == id).map(|(_, kind)| *kind).collect();
        self.events.clear();
        kinds
    }
}

#[test]
fn a_press_clicks_the_button_and_the_tile_under_it() {
    use EventKind::{Clicked, Pressed, Released};
    let mut floor = Floor::with_page();
    floor.stand(&[(HOME, 100.0)], 100);
    floor.stand(&[], 50);
    assert_eq!(floor.events_of("home"), [Pressed, Released, Clicked]);
    let tile = floor.geometry.index(floor.geometry.tile_under(HOME).unwrap()).unwrap();
    let frequencies: Vec<_> = floor.cues.iter().map(|cue| cue.click.modes[0].frequency_hz).collect();
    assert_eq!(frequencies, [180.0, 240.0]);
    for cue in &floor.cues {
        assert_eq!(usize::from(cue.spots[0].tile), tile);
        assert_eq!(cue.spots[0].weight, 1.0);
    }
}

#[test]
fn a_heavier_foot_outside_the_region_does_not_take_the_cursor() {
    let mut floor = Floor::with_page();
    let stance = (Vec2::new(0.9, 0.15), 650.0);
    floor.stand(&[stance], 100);
    floor.stand(&[stance, (HOME, 100.0)], 100);
    floor.stand(&[stance], 50);
    assert_eq!(floor.events_of("home").last(), Some(&EventKind::Clicked));
}

#[test]
fn a_foot_that_slides_off_a_button_cancels_it() {
    let mut floor = Floor::with_page();
    floor.stand(&[(HOME, 100.0)], 100);
    floor.slide(HOME, HOME + Vec2::new(0.3, 0.0), 100.0, 0.3);
    floor.stand(&[], 50);
    assert_eq!(floor.events_of("home"), [EventKind::Pressed, EventKind::Cancelled]);
}

#[test]
fn a_loaded_foot_that_slides_onto_a_button_does_not_press_it_until_lifted() {
    let mut floor = Floor::with_page();
    floor.stand(&[(HOME - Vec2::new(0.3, 0.0), 100.0)], 400);
    floor.slide(HOME - Vec2::new(0.3, 0.0), HOME, 100.0, 0.3);
    floor.stand(&[(HOME, 100.0)], 500);
    assert_eq!(floor.events_of("home"), []);
    floor.stand(&[(HOME, 20.0)], 30);
    floor.stand(&[(HOME, 100.0)], 100);
    assert_eq!(floor.events_of("home"), [EventKind::Pressed]);
}

#[test]
fn a_slider_keeps_its_foot_and_slides_while_it_moves() {
    let mut floor = Floor::with_page();
    let (west, east) = (Vec2::new(0.6, 1.5), Vec2::new(1.2, 1.5));
    floor.stand(&[(west, 80.0)], 60);
    floor.slide(west, east, 80.0, 0.3);
    // Far to the north of the slider, which captures the foot and keeps it.
    floor.slide(east, east + Vec2::new(0.0, 0.25), 80.0, 0.3);
    let fastest = floor.slip_speeds.iter().copied().fold(0.0, f32::max);
    assert!((0.2..0.4).contains(&fastest), "moved at 0.3 m/s, slid at {fastest}");
    floor.stand(&[], 50);
    let events = floor.events_of("zoom");
    assert_eq!(events.first(), Some(&EventKind::Pressed));
    assert_eq!(events.last(), Some(&EventKind::Released));
    let Some(Value::Number(value)) = floor.engine.value("zoom") else { panic!("a slider holds a number") };
    assert!((value - 0.8).abs() < 0.01, "{value}");
}

#[test]
fn a_foot_that_lands_alone_on_a_slider_in_a_walk_does_not_move_it() {
    for newtons_per_ms in [2.0, 5.0, 10.0] {
        let mut floor = Floor::with_page();
        let at = Vec2::new(0.9, 1.5);
        for ms in 0..600 {
            floor.stand(&[(at, (newtons_per_ms * ms as f32).min(700.0))], 1);
        }
        floor.stand(&[], 50);
        assert_eq!(floor.events_of("zoom"), [], "{newtons_per_ms} N a millisecond");
        // A foot of a sitting person presses it once its force has settled.
        floor.stand(&[(at, 80.0)], 150);
        assert_eq!(floor.events_of("zoom").first(), Some(&EventKind::Pressed));
    }
}

#[test]
fn losing_the_floor_cancels_and_a_loaded_control_must_be_lifted_afterwards() {
    let mut floor = Floor::with_page();
    floor.stand(&[(LIGHT, 100.0)], 100);
    floor.unsensed(50);
    floor.stand(&[(LIGHT, 100.0)], 500);
    assert_eq!(floor.events_of("light"), [EventKind::Pressed, EventKind::Cancelled]);
    floor.stand(&[], 50);
    floor.stand(&[(LIGHT, 100.0)], 100);
    floor.stand(&[], 50);
    assert_eq!(floor.events_of("light").last(), Some(&EventKind::Changed(Value::Switch(true))));
}

#[test]
fn a_captured_foot_lost_with_its_tile_cancels_and_commits_nothing() {
    let mut floor = Floor::with_page();
    let (west, east) = (Vec2::new(0.6, 1.5), Vec2::new(1.2, 1.5));
    floor.stand(&[(west, 80.0)], 60);
    floor.slide(west, east, 80.0, 0.3);
    // On to tiles south of the slider; their board then fails.
    let beyond = Vec2::new(1.2, 1.1);
    floor.slide(east, beyond, 80.0, 0.3);
    let row = floor.geometry.tile_under(beyond).unwrap().row;
    for _ in 0..30 {
        let mut frame = floor.frame(&[]);
        for (tile, quality) in floor.geometry.tiles().zip(&mut frame.quality) {
            if tile.row == row {
                *quality = [Quality::Stale; 4];
            }
        }
        floor.give(&frame);
    }
    let events = floor.events_of("zoom");
    assert_eq!(events.last(), Some(&EventKind::Cancelled));
    assert_eq!(floor.engine.value("zoom"), Some(Value::Number(0.0)), "back where it was");
}

#[test]
fn one_dead_sensor_leaves_its_tile_at_work() {
    let mut floor = Floor::with_page();
    let tile = floor.geometry.index(floor.geometry.tile_under(HOME).unwrap()).unwrap();
    for (force, millis) in [(0.0, 20), (100.0, 100), (0.0, 50)] {
        for _ in 0..millis {
            let mut frame = floor.frame(&[(HOME, force)]);
            frame.quality[tile][2] = Quality::Faulty;
            frame.forces[tile][2] = 0.0;
            floor.give(&frame);
        }
    }
    assert_eq!(floor.events_of("home").last(), Some(&EventKind::Clicked));
}

#[test]
fn a_new_layout_waits_for_the_foot_and_keeps_values() {
    let mut floor = Floor::with_page();
    assert_eq!(floor.engine.set_value("zoom", Value::Number(0.25)), Ok(()));
    floor.stand(&[(HOME, 100.0)], 100);
    let mut moved = page();
    moved.widgets[0].area = Rect::from_min_size(Vec2::new(1.4, 1.3), Vec2::splat(0.2));
    floor.engine.set_layout(moved.clone());
    floor.stand(&[(HOME, 100.0)], 100);
    assert_eq!(floor.engine.layout(), &page());
    floor.stand(&[], 50);
    assert_eq!(floor.events_of("home").last(), Some(&EventKind::Clicked));
    assert_eq!(floor.engine.layout(), &moved);
    assert_eq!(floor.engine.value("zoom"), Some(Value::Number(0.25)));
}

#[test]
fn a_control_that_vanishes_under_a_foot_is_cancelled() {
    let mut floor = Floor::with_page();
    floor.stand(&[(HOME, 100.0)], 100);
    let mut without = page();
    without.widgets.remove(0);
    floor.engine.set_layout(without.clone());
    floor.stand(&[(HOME, 100.0)], 2);
    assert_eq!(floor.events_of("home"), [EventKind::Pressed, EventKind::Cancelled]);
    assert_eq!(floor.engine.layout(), &without);
}

#[test]
fn a_disabled_control_is_deaf_and_needs_a_lift_afterwards() {
    let mut floor = Floor::with_page();
    floor.stand(&[(HOME, 100.0)], 100);
    assert_eq!(floor.engine.set_enabled("home", false), Ok(()));
    floor.stand(&[(HOME, 100.0)], 100);
    assert_eq!(floor.engine.set_enabled("home", true), Ok(()));
    floor.stand(&[(HOME, 100.0)], 100);
    assert_eq!(floor.events_of("home"), [EventKind::Pressed, EventKind::Cancelled]);
    assert_eq!(floor.engine.set_enabled("nowhere", true), Err(SetError::Unknown));
}

#[test]
fn the_snapshot_shows_what_a_person_would_see() {
    let mut floor = Floor::with_page();
    floor.stand(&[(HOME, 90.0)], 100);
    let mut snapshot = Snapshot::default();
    floor.engine.snapshot(&mut snapshot);
    assert_eq!(snapshot.tiles.len(), 36);
    assert_eq!(snapshot.contacts.len(), 1);
    let cursor = snapshot.cursors[0].unwrap();
    assert!(cursor.position.distance(HOME) < 1e-3);
    assert!(snapshot.widgets[0].pressed && !snapshot.widgets[1].pressed);
    assert!((snapshot.widgets[0].press_share - 1.5).abs() < 0.01);
}
