//! The complete visible state of a floor at one instant.

use std::sync::Arc;
use std::time::Duration;

use glam::Vec2;

use super::ignored::{AnsweredPress, IgnoredPress};
use crate::feel::{DeviceStatus, FeelCounters, Muted};
use crate::floor::FloorFile;
use crate::ground::GroundState;
use crate::sense::{Contact, ContactId, Cursor, Quality, SensorHealth};
use crate::units::{Instant, Newtons};
use crate::widget::{Indicator, OffReason, Scale, Value, WidgetId};
use crate::wire::{LinkCause, LinkCounters, LinkState};

/// The state of the floor at one instant, for windows and pictures.
///
/// Only the latest matters: a reader that misses one loses only a picture. Events have their own channel.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// The frame's time on the floor's sample clock.
    pub at: Instant,
    /// One entry per tile, in tile-index order.
    pub tiles: Vec<TileState>,
    /// The feet on the floor.
    pub contacts: Vec<Contact>,
    /// The role of each contact for the controls, in the order of the contacts.
    pub feet: Vec<FootState>,
    /// The cursor of each of the layout's regions; after these, in no order, the further cursors of regions in which
    /// each contact is one (their own entry is the heaviest).
    pub cursors: Vec<Option<Cursor>>,
    /// Index of the layout's current page; 0 without pages.
    pub page: usize,
    /// Labels that apps have set in place of the layout's: the control's index and its label.
    pub labels: Vec<(usize, Arc<str>)>,
    /// Ranges that apps have set in place of the layout's: the control's index and its scale.
    pub ranges: Vec<(usize, Scale)>,
    /// One entry per control, in the layout's order.
    pub widgets: Vec<WidgetState>,
    /// The latest presses without a response, oldest first; 16 at most.
    pub ignored: Vec<IgnoredPress>,
    /// The latest presses that controls answered, oldest first; 16 at most.
    pub answered: Vec<AnsweredPress>,
    /// One entry per ground, in the layout's order.
    pub grounds: Vec<GroundState>,
    /// The controls that feet press now, in any order.
    pub held: Vec<WidgetId>,
    /// The file from which the floor was read; [`OffReason::explain`] names it.
    pub floor_file: FloorFile,
    /// Whether sensor packets arrive.
    pub link: LinkState,
    /// The cause why a sender is active but no frame is usable, or why no load was ever seen; `None` if all is well,
    /// or without a sender.
    pub link_cause: Option<LinkCause>,
    /// Number of boards of this floor.
    pub boards: u32,
    /// Number of boards with usable packets.
    pub boards_live: u32,
    /// Counts of received and of rejected packets.
    pub counters: LinkCounters,
    /// The state of the sensors.
    pub health: SensorHealth,
    /// The state of the device that drives the actuators; `None` without one.
    pub device: Option<DeviceStatus>,
    /// The feedback that is muted.
    pub muted: Muted,
    /// Counts of feedback that was not rendered as it should be.
    pub feel: FeelCounters,
    /// Number of events that could not be sent to other programs.
    pub unsent_events: u64,
    /// Revision of the layout to which the controls belong: the first is 0, the n-th given to
    /// [`super::Engine::set_layout`] is n.
    pub layout_revision: u64,
}

/// The readings of one tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileState {
    /// Newtons in [`crate::floor::Corner::ALL`] order.
    pub forces: [f32; 4],
    /// How reliable each force is.
    pub quality: [Quality; 4],
    /// Sum of the forces.
    pub force: Newtons,
    /// Place at which the tile's load acts; `None` if the load is too light.
    pub centroid: Option<Vec2>,
    /// Age of the forces: zero where the board samples once a frame, up to a period and the delay of its packets where
    /// it samples less often.
    pub age: Duration,
}

/// The visible state of one control.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WidgetState {
    /// Whether a foot engages it.
    pub pressed: bool,
    /// Its value; `None` for a button.
    pub value: Option<Value>,
    /// Force of the foot on it, as a share of its press threshold; 0 with no foot on it.
    pub press_share: f32,
    /// Whether a foot on it must be lifted before it works (after a lost floor, or when an app enabled it under a
    /// foot).
    pub needs_lift: bool,
    /// Whether an app has switched it off.
    pub disabled: bool,
    /// The reason why no foot can press it; `None` if a foot can.
    pub off: Option<OffReason>,
    /// Whether an app has locked it.
    pub locked: bool,
    /// Whether a first press has armed it.
    pub armed: bool,
    /// Whether it will soon stop by itself although a foot holds it.
    pub warned: bool,
    /// The state of its lamp.
    pub indicator: Indicator,
    /// The value that it would take if the foot let go now, if different.
    pub pending: Option<Value>,
    /// Whether it is on a page other than the current one.
    pub hidden: bool,
}

/// The role of one contact for the controls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootState {
    /// The contact.
    pub contact: ContactId,
    /// Its role.
    pub role: FootRole,
    /// Contacts with the same number belong to one person; numbers are not reused.
    pub person: u32,
    /// That person's weight; `None` until they have stood quietly for two seconds.
    pub weight: Option<Newtons>,
}

/// The role of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FootRole {
    /// A foot that may press controls.
    #[default]
    Free,
    /// A foot in a stance zone, which is not a cursor.
    Stance,
    /// A foot that walks or carries the body, and presses nothing until it has lifted.
    Step,
    /// An object left on the floor, ignored until it moves: it has kept still for a minute.
    Object,
}
