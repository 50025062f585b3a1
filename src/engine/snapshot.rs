use glam::Vec2;

use crate::feel::FeelCounters;
use crate::sense::{Contact, Cursor, Quality, SensorHealth};
use crate::units::{Instant, Newtons};
use crate::widget::Value;
use crate::wire::LinkCounters;

/// The state of the floor at one instant, for windows and pictures.
///
/// Only ever the latest matters: a reader that misses one has lost nothing but
/// a picture. Events travel on their own channel.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// The frame's time on the floor's sample clock.
    pub at: Instant,
    /// One entry per tile, in tile-index order.
    pub tiles: Vec<TileState>,
    /// The feet on the floor.
    pub contacts: Vec<Contact>,
    /// The cursor of each of the layout's regions.
    pub cursors: Vec<Option<Cursor>>,
    /// One entry per control, in the layout's order.
    pub widgets: Vec<WidgetState>,
    /// Whether sensor packets arrive.
    pub link: LinkState,
    /// What came in and what was refused.
    pub counters: LinkCounters,
    /// How the sensors are doing.
    pub health: SensorHealth,
    /// What could not be felt as it should.
    pub feel: FeelCounters,
    /// Events that other programs could not be told.
    pub unsent_events: u64,
    /// Which layout the controls belong to: the first is 0, the n-th given to [`super::Engine::set_layout`] is n.
    pub layout_revision: u64,
}

/// What one tile senses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileState {
    /// Newtons in [`crate::floor::Corner::ALL`] order.
    pub forces: [f32; 4],
    /// How far each can be trusted.
    pub quality: [Quality; 4],
    /// Sum of the forces.
    pub force: Newtons,
    /// Where the tile's load acts; `None` if it is too light to tell.
    pub centroid: Option<Vec2>,
}

/// What one control looks like to a person.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WidgetState {
    /// Whether a foot engages it.
    pub pressed: bool,
    /// What it holds; `None` for a button.
    pub value: Option<Value>,
    /// Force of the foot on it, as a share of its press threshold; 0 with no foot on it.
    pub press_share: f32,
    /// Whether a foot on it must be lifted before it works (after a lost floor, or when an app enabled it under a foot).
    pub needs_lift: bool,
    /// Whether an app has switched it off.
    pub disabled: bool,
}

/// Whether sensor packets arrive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinkState {
    /// No packet has come yet.
    #[default]
    Waiting,
    /// Packets arrive from every board.
    Live,
    /// Packets arrive, but not from every board.
    Partial,
    /// Nothing has come for 100 ms or more; every control is released.
    Lost,
}
