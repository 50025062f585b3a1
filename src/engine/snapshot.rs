//! Everything there is to see of a floor at one instant.

use std::sync::Arc;

use glam::Vec2;

use super::ignored::{AnsweredPress, IgnoredPress};
use crate::feel::{DeviceStatus, FeelCounters, Muted};
use crate::ground::GroundState;
use crate::sense::{Contact, ContactId, Cursor, HoldDoubt, Quality, SensorHealth};
use crate::units::{Instant, Newtons};
use crate::widget::{Indicator, Scale, Value, WidgetId};
use crate::wire::{LinkCounters, LinkState};

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
    /// What each contact is to the controls, in their order.
    pub feet: Vec<FootState>,
    /// The cursor of each of the layout's regions; after these, in no order, the further cursors of
    /// regions in which each contact is one (their own entry is the heaviest).
    pub cursors: Vec<Option<Cursor>>,
    /// Which of the layout's pages is shown; 0 without pages.
    pub page: usize,
    /// What apps have written on controls in place of what the layout says: the control's index and its label.
    pub labels: Vec<(usize, Arc<str>)>,
    /// Ranges that apps have set in place of what the layout says: the control's index and its scale.
    pub ranges: Vec<(usize, Scale)>,
    /// One entry per control, in the layout's order.
    pub widgets: Vec<WidgetState>,
    /// The latest presses that no control answered, oldest first; 16 at most.
    pub ignored: Vec<IgnoredPress>,
    /// The latest presses that controls answered, oldest first; 16 at most.
    pub answered: Vec<AnsweredPress>,
    /// One entry per ground, in the layout's order.
    pub grounds: Vec<GroundState>,
    /// The controls that a foot holds pressed, in no order.
    pub held: Vec<WidgetId>,
    /// Whether sensor packets arrive.
    pub link: LinkState,
    /// Boards that this floor has.
    pub boards: u32,
    /// Boards of which usable packets arrive.
    pub boards_live: u32,
    /// What came in and what was refused.
    pub counters: LinkCounters,
    /// How the sensors are doing.
    pub health: SensorHealth,
    /// How the device that moves the actuators is doing; `None` without one.
    pub device: Option<DeviceStatus>,
    /// What somebody has muted.
    pub muted: Muted,
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
    /// Whether a foot on it must be lifted before it works (after a lost floor, or when an app enabled it under a
    /// foot).
    pub needs_lift: bool,
    /// Whether an app has switched it off.
    pub disabled: bool,
    /// Whether it is off because it acts for as long as it is held, and this floor is not calibrated.
    pub uncalibrated: bool,
    /// Why it is off because it acts for as long as it is held, and the readings of its tiles may not hold it.
    pub hold_doubt: Option<HoldDoubt>,
    /// Whether an app has locked it.
    pub locked: bool,
    /// Whether a first press has armed it.
    pub armed: bool,
    /// Whether it will soon stop by itself although a foot holds it.
    pub warned: bool,
    /// What its lamp shows.
    pub indicator: Indicator,
    /// What its value would become if the foot let go now, where that is another one.
    pub pending: Option<Value>,
    /// Whether it is on another page than the one that is shown.
    pub hidden: bool,
}

impl WidgetState {
    /// Whether it reacts to no foot, for whatever reason.
    #[must_use]
    pub const fn is_off(&self) -> bool {
        self.disabled || self.uncalibrated || self.hold_doubt.is_some()
    }
}

/// What one contact is to the controls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootState {
    /// Which contact.
    pub contact: ContactId,
    /// What it is taken for.
    pub role: FootRole,
    /// Contacts with the same number are taken for feet of one person; never used again.
    pub person: u32,
    /// That person's weight; `None` until they have stood quietly for two seconds.
    pub weight: Option<Newtons>,
}

/// What a contact is taken for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FootRole {
    /// A foot that may press controls.
    #[default]
    Free,
    /// A foot in a stance zone, which is not a cursor.
    Stance,
    /// A foot that walks or carries the body, and presses nothing until it has lifted.
    Step,
    /// Something left on the floor, ignored until it moves: it has kept still for a minute.
    Object,
}
