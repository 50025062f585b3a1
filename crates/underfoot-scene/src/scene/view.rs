//! Input of a scene's drawing.

use glam::Vec2;

use super::Theme;
use underfoot::engine::{Snapshot, WidgetState};
use underfoot::floor::{Geometry, Rect, TileId};
use underfoot::layout::{Layout, Widget};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::Value;

/// A simulated shoe, for drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shoe {
    /// Centre of the sole, in floor metres.
    pub position: Vec2,
    /// Direction of the toes: 0 is north, counter-clockwise in radians.
    pub heading_rad: f32,
    /// Length of the sole, in metres.
    pub length_m: f32,
    /// Normal force; 0 for a shoe in the air.
    pub force: Newtons,
    /// Position of the pressure: 0 on the heel to 1 on the toes.
    pub roll: f32,
    /// True for a left shoe.
    pub left: bool,
}

/// The shoe of a simulated foot, as long as the foot itself.
#[cfg(feature = "sim")]
impl From<&underfoot_sim::Foot> for Shoe {
    fn from(foot: &underfoot_sim::Foot) -> Self {
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

/// Accessor of one layer of a [`Show`], for reading or switching it.
pub type Layer = fn(&mut Show) -> &mut bool;

/// Visible parts of the floor's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Show {
    /// Sensors with their forces. Broken and silent sensors are visible even without this layer.
    pub sensors: bool,
    /// The plates' colour under load, and the force on each of them.
    pub loads: bool,
    /// Centroid of each tile's load.
    pub centroids: bool,
    /// Contacts: circles with an area proportional to the force.
    pub contacts: bool,
    /// The 95 % confidence ellipse around each contact.
    pub uncertainty: bool,
    /// Recent path of each contact: see [`View::trails`].
    pub trails: bool,
    /// Rings around the contacts that operate controls.
    pub cursors: bool,
    /// On each control, the force as a share of its press threshold.
    pub engagement: bool,
    /// Reasons of ignored presses, for some seconds on their controls.
    pub ignored: bool,
    /// Levels of the actuators.
    pub actuators: bool,
    /// Quality of each sensor, as a quarter of its plate.
    pub health: bool,
    /// Tile numbers along the floor's west and south sides.
    pub ruler: bool,
    /// A strip above the floor with the layout's title and the time.
    pub header: bool,
    /// A strip below the floor that explains the marks.
    pub legend: bool,
}

impl Show {
    /// The initial layers of a window.
    pub const WINDOW: Self = Self {
        sensors: true,
        loads: true,
        contacts: true,
        cursors: true,
        ignored: true,
        ruler: true,
        ..Self::PROJECTOR
    };

    /// The layers of a picture of a floor in use.
    pub const PICTURE: Self = Self { ignored: false, header: true, legend: true, ..Self::WINDOW };

    /// Only the layout.
    pub const LAYOUT: Self = Self { ruler: true, header: true, ..Self::PROJECTOR };

    /// The layers for a projector: controls without marks, and nothing around the floor.
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

    /// The optional layers by name, for a menu.
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

/// Recent path of a contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trail {
    /// Positions in floor metres, oldest first.
    pub points: Vec<Vec2>,
    /// True if the contact operates controls.
    pub leads: bool,
}

/// A press on free floor close to a control.
#[derive(Clone, Debug, PartialEq)]
pub struct PressBeside {
    /// Time of its end.
    pub at: Instant,
    /// The place of the press, in floor metres.
    pub place: Vec2,
    /// The area of the control, in floor metres; `None` if the layout no longer has it.
    pub control: Option<Rect>,
    /// The distance and the name of the control.
    pub text: String,
}

/// Input of one drawing.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// Geometry of the floor.
    pub geometry: &'a Geometry,
    /// Layout with the controls.
    pub layout: &'a Layout,
    /// State of the floor. Controls missing in the snapshot, or of another kind there, are drawn at rest; missing
    /// tiles are drawn without load.
    pub snapshot: &'a Snapshot,
    /// Colours.
    pub theme: &'a Theme,
    /// Visible parts.
    pub show: Show,
    /// Simulated shoes.
    pub shoes: &'a [Shoe],
    /// Level of each tile's actuator, in tile-index order: 0 (still) to 1 (full scale); may be shorter than the
    /// floor.
    pub levels: &'a [f32],
    /// Recent paths of the contacts, for the layer of trails.
    pub trails: &'a [Trail],
    /// Presses close to controls, for the layer of ignored presses.
    pub near_misses: &'a [PressBeside],
    /// A tile to outline.
    pub chosen: Option<TileId>,
}

impl<'a> View<'a> {
    /// Creates the view of a window, without shoes or actuators.
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
            near_misses: &[],
            chosen: None,
        }
    }

    /// The controls of the page on display.
    pub(super) fn controls(&self) -> impl Iterator<Item = &'a Widget> {
        let page = self.snapshot.page;
        self.layout.widgets.iter().filter(move |widget| widget.is_on(page))
    }

    /// State of the control at `index`; the state at rest if the snapshot does not fit the layout.
    pub(super) fn widget_state(&self, index: usize) -> WidgetState {
        let Some(widget) = self.layout.widgets.get(index) else { return WidgetState::default() };
        let hidden = !widget.is_on(self.snapshot.page);
        let rest = WidgetState { value: widget.behaviour.initial(), hidden, ..WidgetState::default() };
        match self.snapshot.widgets.get(index) {
            Some(state) if same_kind(state.value, rest.value) => *state,
            _ => rest,
        }
    }

    /// The control at `index` with the label and the range set by apps; `None` if neither is set.
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
