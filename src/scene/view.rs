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
    /// A right shoe of the foot's own length: a simulated foot has no side.
    fn from(foot: &crate::sim::Foot) -> Self {
        Self {
            position: foot.position,
            heading_rad: foot.heading,
            length_m: foot.length_m,
            force: foot.force,
            roll: foot.roll,
            left: false,
        }
    }
}

/// Which parts of the floor's state are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Show {
    /// The sensors with their forces. Sensors that are broken or silent are shown even without.
    pub sensors: bool,
    /// Contacts and cursors.
    pub contacts: bool,
    /// Tile numbers along the floor's west and south sides.
    pub ruler: bool,
    /// A strip above the floor with the layout's title and the time.
    pub header: bool,
    /// A strip below the floor that explains the marks.
    pub legend: bool,
}

impl Show {
    /// Everything that is seen in a window.
    pub const WINDOW: Self =
        Self { sensors: true, contacts: true, ruler: true, header: false, legend: false };

    /// Everything that is seen in a picture of a floor at work.
    pub const PICTURE: Self = Self { sensors: true, contacts: true, ruler: true, header: true, legend: true };

    /// A layout alone.
    pub const LAYOUT: Self =
        Self { sensors: false, contacts: false, ruler: true, header: true, legend: false };

    /// What a projector throws onto the floor: controls, no marks on them, nothing around.
    pub const PROJECTOR: Self =
        Self { sensors: false, contacts: false, ruler: false, header: false, legend: false };
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
        Self { geometry, layout, snapshot, theme, show: Show::WINDOW, shoes: &[], levels: &[], chosen: None }
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
