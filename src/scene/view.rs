//! What a scene is drawn from.

use glam::Vec2;

use super::Theme;
use crate::engine::{Snapshot, WidgetState};
use crate::floor::{Geometry, TileId};
use crate::layout::{Layout, Widget};
use crate::units::Newtons;
use crate::widget::Value;

/// A simulated shoe, for drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shoe {
    /// Middle of the sole, in floor metres.
    pub position: Vec2,
    /// Where the toes point: 0 is north, counter-clockwise in radians.
    pub heading_rad: f32,
    /// Length of the sole, in metres.
    pub length_m: f32,
    /// Normal force; 0 for a shoe in the air.
    pub force: Newtons,
    /// Where the foot presses: 0 on the heel to 1 on the toes.
    pub roll: f32,
    /// Whether it is a left shoe.
    pub left: bool,
}

#[cfg(feature = "sim")]
impl From<&crate::sim::Foot> for Shoe {
    /// A shoe of the foot's own length.
    fn from(foot: &crate::sim::Foot) -> Self {
        Self {
            position: foot.position,
            heading_rad: foot.heading,
            length_m: foot.length_m,
            force: foot.force,
            roll: foot.roll,
            left: foot.left,
        }
    }
}

/// One layer of a [`Show`], to be read or switched.
pub type Layer = fn(&mut Show) -> &mut bool;

/// Which parts of the floor's state are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Show {
    /// The sensors with their forces. Sensors that are broken or silent are shown even without.
    pub sensors: bool,
    /// The plates' colour under load, and the force on each of them.
    pub loads: bool,
    /// Where the load of each tile acts.
    pub centroids: bool,
    /// Contacts: circles whose area follows the force.
    pub contacts: bool,
    /// Around each contact the ellipse that holds its true place 95 times in 100.
    pub uncertainty: bool,
    /// The way each contact came: see [`View::trails`].
    pub trails: bool,
    /// Rings around the contacts that operate controls.
    pub cursors: bool,
    /// On each control how far the force on it has come to its threshold.
    pub engagement: bool,
    /// Why presses were ignored, for some seconds on the controls that did not answer.
    pub ignored: bool,
    /// What the actuators do.
    pub actuators: bool,
    /// How far each sensor can be believed, as a quarter of its plate.
    pub health: bool,
    /// Tile numbers along the floor's west and south sides.
    pub ruler: bool,
    /// A strip above the floor with the layout's title and the time.
    pub header: bool,
    /// A strip below the floor that explains the marks.
    pub legend: bool,
}

impl Show {
    /// Everything that is seen in a window at first.
    pub const WINDOW: Self = Self {
        sensors: true,
        loads: true,
        contacts: true,
        cursors: true,
        ignored: true,
        ruler: true,
        ..Self::PROJECTOR
    };

    /// Everything that is seen in a picture of a floor at work.
    pub const PICTURE: Self = Self { ignored: false, header: true, legend: true, ..Self::WINDOW };

    /// A layout alone.
    pub const LAYOUT: Self = Self { ruler: true, header: true, ..Self::PROJECTOR };

    /// What a projector throws onto the floor: controls, no marks on them, nothing around.
    pub const PROJECTOR: Self = Self {
        sensors: false,
        loads: false,
        centroids: false,
        contacts: false,
        uncertainty: false,
        trails: false,
        cursors: false,
        engagement: true,
        ignored: false,
        actuators: true,
        health: false,
        ruler: false,
        header: false,
        legend: false,
    };

    /// What can be laid over the floor, by name, for a menu.
    pub const LAYERS: [(&'static str, Layer); 11] = [
        ("Sensor forces", |show| &mut show.sensors),
        ("Tile forces", |show| &mut show.loads),
        ("Tile centroids", |show| &mut show.centroids),
        ("Contacts", |show| &mut show.contacts),
        ("Uncertainty", |show| &mut show.uncertainty),
        ("Trails", |show| &mut show.trails),
        ("Cursors", |show| &mut show.cursors),
        ("Engagement", |show| &mut show.engagement),
        ("Ignored presses", |show| &mut show.ignored),
        ("Actuators", |show| &mut show.actuators),
        ("Sensor health", |show| &mut show.health),
    ];
}

/// Where a contact has been of late.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trail {
    /// Its places, in floor metres, oldest first.
    pub points: Vec<Vec2>,
    /// Whether it operates controls.
    pub leads: bool,
}

/// All that one drawing shows.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The floor.
    pub geometry: &'a Geometry,
    /// The controls.
    pub layout: &'a Layout,
    /// Their state. A control it does not know, or knows as another kind of control, is drawn at rest;
    /// tiles it does not know are drawn bare.
    pub snapshot: &'a Snapshot,
    /// The colours.
    pub theme: &'a Theme,
    /// Which parts are drawn.
    pub show: Show,
    /// Simulated shoes.
    pub shoes: &'a [Shoe],
    /// What each tile's actuator does, in tile-index order: 0 (still) to 1 (full scale); may be shorter.
    pub levels: &'a [f32],
    /// Where contacts have been, for the layer of that name.
    pub trails: &'a [Trail],
    /// A tile to be outlined.
    pub chosen: Option<TileId>,
}

impl<'a> View<'a> {
    /// The floor as a window shows it, without shoes or actuators.
    #[must_use]
    pub const fn new(
        geometry: &'a Geometry,
        layout: &'a Layout,
        snapshot: &'a Snapshot,
        theme: &'a Theme,
    ) -> Self {
        Self {
            geometry,
            layout,
            snapshot,
            theme,
            show: Show::WINDOW,
            shoes: &[],
            levels: &[],
            trails: &[],
            chosen: None,
        }
    }

    /// The state of the control at `index`, at rest where the snapshot does not fit the layout.
    pub(super) fn widget_state(&self, index: usize) -> WidgetState {
        let Some(widget) = self.layout.widgets.get(index) else { return WidgetState::default() };
        let hidden = !widget.is_on(self.snapshot.page);
        let rest = WidgetState { value: widget.behaviour.initial(), hidden, ..WidgetState::default() };
        match self.snapshot.widgets.get(index) {
            Some(state) if same_kind(state.value, rest.value) => *state,
            _ => rest,
        }
    }

    /// The control at `index` with the label and the range that apps have set; `None` where they have set neither.
    pub(super) fn as_apps_set(&self, index: usize, widget: &Widget) -> Option<Widget> {
        let label = self.snapshot.labels.iter().find(|(of, _)| *of == index).map(|(_, label)| label);
        let range = self.snapshot.ranges.iter().find(|(of, _)| *of == index);
        let behaviour = range.and_then(|(_, scale)| widget.behaviour.with_range(scale.min, scale.max));
        if label.is_none() && behaviour.is_none() {
            return None;
        }
        let label = label.map_or_else(|| widget.label.clone(), |label| label.as_ref().to_owned());
        let behaviour = behaviour.unwrap_or_else(|| widget.behaviour.clone());
        Some(Widget { label, behaviour, ..widget.clone() })
    }
}

fn same_kind(one: Option<Value>, other: Option<Value>) -> bool {
    matches!(
        (one, other),
        (None, None)
            | (Some(Value::Switch(_)), Some(Value::Switch(_)))
            | (Some(Value::Number(_)), Some(Value::Number(_)))
            | (Some(Value::Choice(_)), Some(Value::Choice(_)))
            | (Some(Value::Pair(_)), Some(Value::Pair(_)))
    )
}
