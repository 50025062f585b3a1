//! A page of controls, and snapshots of a floor in use, for tests.

use std::sync::Arc;
use std::time::Duration;

use underfoot::glam::Vec2;
use underfoot::smallvec::smallvec;

use underfoot::engine::{Snapshot, TileState, WidgetState};
use underfoot::feel::Feel;
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Colour, CursorRule, Layout, Look, Region, Shape, Stance, Widget};
use underfoot::sense::{Contact, ContactId, Covariance, Cursor, Quality, TileLoad};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{
    Axis, Behaviour, ButtonSpec, DialSpec, HoldSpec, LeanSpec, PadSpec, PedalSpec, Repeat, Scale,
    SelectorSpec, SliderSpec, SliderTrack, StepperSpec, SwitchSpec, Thresholds, WidgetId,
};
use underfoot::wire::LinkState;

pub(crate) const THRESHOLDS: Thresholds = Thresholds::new(Newtons(60.0), Newtons(40.0));

pub(crate) fn slider(track: SliderTrack, min: f32, max: f32, step: f32, initial: f32) -> Behaviour {
    let scale = Scale { step, ..Scale::new(min, max) };
    Behaviour::Slider(SliderSpec { track, initial, ..SliderSpec::new(THRESHOLDS, scale) })
}

pub(crate) fn button() -> Behaviour {
    Behaviour::Button(ButtonSpec::new(THRESHOLDS))
}

pub(crate) fn switch(initial: bool) -> Behaviour {
    Behaviour::Switch(SwitchSpec { thresholds: THRESHOLDS, initial })
}

/// All behaviours except buttons, switches and straight sliders.
pub(crate) fn others() -> Vec<Behaviour> {
    let thresholds = THRESHOLDS;
    let scale = Scale { step: 0.5, ..Scale::new(-10.0, 10.0) };
    let options = ["Pan", "Zoom by hand", "Turn"].map(Arc::from).into();
    let slider = SliderSpec::new(thresholds, Scale::UNIT);
    let repeat =
        Repeat { after: None, every: Duration::from_millis(250), fastest: Duration::from_millis(60) };
    let arc = SliderTrack::Arc { from_degrees: 180.0, to_degrees: 0.0 };
    vec![
        Behaviour::Hold(HoldSpec { thresholds }),
        Behaviour::Selector(SelectorSpec { thresholds, axis: Axis::East, options, initial: 1 }),
        Behaviour::Slider(SliderSpec { track: arc, ..slider }),
        Behaviour::Slider(SliderSpec { track: SliderTrack::Line { degrees: 30.0 }, ..slider }),
        Behaviour::Slider(SliderSpec { track: SliderTrack::Line { degrees: 120.0 }, ..slider }),
        Behaviour::Pedal(PedalSpec {
            thresholds,
            scale: Scale::new(0.0, 10.0),
            deadband: None,
            full: Newtons(250.0),
            curve: 1.0,
        }),
        Behaviour::Pad(PadSpec {
            initial: Vec2::ZERO,
            ..PadSpec::new(thresholds, Scale::new(-1.0, 1.0), scale)
        }),
        Behaviour::Dial(DialSpec { thresholds, scale, turn_degrees: 270.0, initial: -10.0 }),
        Behaviour::Stepper(StepperSpec { thresholds, axis: Axis::East, scale, initial: 0.0, repeat }),
        Behaviour::Stepper(StepperSpec { thresholds, axis: Axis::North, scale, initial: 0.0, repeat }),
        Behaviour::Lean(LeanSpec {
            thresholds,
            settle: Duration::from_millis(250),
            deadband_m: 0.008,
            full_m: 0.03,
        }),
    ]
}

/// A control of `size` tiles with its south-west corner at `at`, in tiles of the paper's floor.
pub(crate) fn widget(
    id: &str,
    label: &str,
    at: [f32; 2],
    size: [f32; 2],
    behaviour: Behaviour,
    look: Look,
) -> Widget {
    let pitch = Geometry::default().pitch_m();
    Widget {
        id: WidgetId::new(id),
        kind: "sample".into(),
        region: 0,
        page: None,
        goto: None,
        area: Rect::from_min_size(Vec2::from(at) * pitch, Vec2::from(size) * pitch),
        label: label.into(),
        behaviour,
        feel: Feel::default(),
        look,
        send: Vec::new(),
    }
}

pub(crate) fn look(shape: Shape, face: u32, lit: u32, ink: u32) -> Look {
    let colour = |hex: u32| Colour::rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8);
    Look { shape, face: colour(face), lit: colour(lit), ink: colour(ink), icon: None }
}

pub(crate) fn blue(shape: Shape) -> Look {
    look(shape, 0xdb_e7_f6, 0x2f_6b_d8, 0x1d_2b_44)
}

pub(crate) fn green() -> Look {
    look(Shape::Box, 0xe3_ec_df, 0x4d_9a_5b, 0x22_33_24)
}

pub(crate) fn sand() -> Look {
    look(Shape::Box, 0xee_e6_d6, 0xe0_8a_2e, 0x3a_2e_1c)
}

/// A map layout, similar to the program's initial one.
pub(crate) fn map() -> Layout {
    let pitch = Geometry::default().pitch_m();
    let tiles = |x: f32, y: f32, w: f32, h: f32| {
        Rect::from_min_size(Vec2::new(x, y) * pitch, Vec2::new(w, h) * pitch)
    };
    let round = blue(Shape::Round);
    Layout {
        title: "Map navigation".into(),
        regions: vec![Region {
            id: "map".into(),
            area: tiles(0.0, 2.0, 6.0, 4.0),
            cursor: CursorRule::Largest,
            send: Vec::new(),
        }],
        stances: vec![Stance { area: tiles(1.75, 0.35, 2.5, 1.4), label: "stand here".into() }],
        pages: vec![],
        targets: Vec::new(),
        grounds: vec![],
        widgets: vec![
            widget("zoom-in", "Zoom in", [0.25, 4.55], [1.0, 1.0], button(), blue(Shape::Box)),
            widget("zoom-out", "Zoom out", [0.25, 3.35], [1.0, 1.0], button(), blue(Shape::Box)),
            widget("north", "North", [2.55, 4.75], [0.9, 0.9], button(), round),
            widget("west", "West", [1.6, 3.8], [0.9, 0.9], button(), round),
            widget("home", "Home", [2.6, 3.85], [0.8, 0.8], button(), sand()),
            widget("east", "East", [3.5, 3.8], [0.9, 0.9], button(), round),
            widget("south", "South", [2.55, 2.85], [0.9, 0.9], button(), round),
            widget("satellite", "Satellite", [4.6, 4.9], [1.2, 0.7], switch(false), green()),
            widget("labels", "Names of places", [4.6, 3.9], [1.2, 0.8], switch(true), green()),
            widget(
                "time",
                "Time of day",
                [0.25, 2.1],
                [3.2, 0.6],
                slider(SliderTrack::EAST, 0.0, 24.0, 0.0, 12.0),
                sand(),
            ),
            widget(
                "tilt",
                "Tilt",
                [4.95, 2.1],
                [0.6, 1.65],
                slider(SliderTrack::NORTH, 0.0, 90.0, 5.0, 30.0),
                sand(),
            ),
        ],
    }
}

/// A snapshot of `layout` on the paper's empty floor.
pub(crate) fn at_rest(layout: &Layout) -> Snapshot {
    let live = TileState { quality: [Quality::Live; 4], ..TileState::default() };
    Snapshot {
        at: Instant::from_millis(3214),
        tiles: vec![live; Geometry::default().tile_count()],
        cursors: vec![None; layout.regions.len()],
        widgets: layout
            .widgets
            .iter()
            .map(|widget| WidgetState { value: widget.behaviour.initial(), ..WidgetState::default() })
            .collect(),
        link: LinkState::Live,
        ..Snapshot::default()
    }
}

/// Adds a foot of `force` newtons at `at` with the velocity `velocity`, spread over the sensors of the tile under it.
pub(crate) fn step_on(snapshot: &mut Snapshot, id: u32, at: Vec2, force: f32, velocity: Vec2) {
    let geometry = Geometry::default();
    let tile = geometry.tile_under(at).unwrap();
    let index = geometry.index(tile).unwrap();
    let reach = geometry.sensor_places(tile).rectangle().unwrap();
    let from_middle = ((at - geometry.centre(tile)) / reach).clamp(Vec2::NEG_ONE, Vec2::ONE);
    let (x, y) = (from_middle.x, from_middle.y);
    let shares = [(1.0 - x) * (1.0 - y), (1.0 + x) * (1.0 - y), (1.0 - x) * (1.0 + y), (1.0 + x) * (1.0 + y)];
    let state = &mut snapshot.tiles[index];
    for (sensor, share) in state.forces.iter_mut().zip(shares) {
        *sensor += 0.25 * share * force;
    }
    state.force += Newtons(force);
    state.centroid = Some(at);
    let load = TileLoad { tile, index, force: Newtons(force), centroid: at };
    snapshot.contacts.push(Contact {
        id: ContactId(id),
        centroid: at,
        force: Newtons(force),
        velocity,
        tiles: smallvec![load],
        covariance: Covariance::isotropic(0.003),
        ambiguous: false,
        split: false,
        quality: Quality::Live,
        difference: None,
    });
}

/// A person who stands on one foot and presses "Zoom in" with the other.
pub(crate) fn pressing(layout: &Layout) -> Snapshot {
    let mut snapshot = at_rest(layout);
    let toe = layout.widgets[0].area.centre() + Vec2::new(0.03, -0.02);
    step_on(&mut snapshot, 6, Vec2::new(0.82, 0.36), 520.0, Vec2::ZERO);
    step_on(&mut snapshot, 7, toe, 152.0, Vec2::new(0.1, 0.25));
    snapshot.cursors[0] = Some(Cursor { contact: ContactId(7), position: toe, force: Newtons(152.0) });
    snapshot.widgets[0].pressed = true;
    snapshot.widgets[0].press_share = 2.5;
    snapshot
}
