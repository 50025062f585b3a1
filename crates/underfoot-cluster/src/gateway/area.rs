//! The state of one area in the gateway: the node that serves it, its clock, and its standing.

use std::time::Duration;

use underfoot::units::Instant;

use super::claim::{Claims, Holder};
use super::clock::NodeClock;
use super::presses::AreaPresses;
use crate::message::{AreaStanding, LayoutStanding, NodeMessage};

/// Greatest age of an area's newest frame, by the gateway's own clock: the uncertainty of the node's clock adds to
/// the age. Beyond it, the gateway cancels all holds of the area.
pub const LOST_AFTER: Duration = Duration::from_millis(100);

/// Greatest time by which a frame may lie in the future: the uncertainty of a clock with an offset known to within a
/// round trip. A frame further ahead comes from a clock that was set, which the next echo reveals.
const AHEAD: Duration = Duration::from_millis(20);

/// One area.
#[derive(Clone, Debug, Default)]
pub(super) struct JoinedArea {
    pub(super) claims: Claims,
    pub(super) holder: Option<u64>,
    pub(super) standing: AreaStanding,
    pub(super) clock: NodeClock,
    pub(super) presses: AreaPresses,
    /// Time of its newest frame, on the gateway's clock.
    pub(super) newest: Option<Instant>,
    /// Uncertainty of that time.
    unsure: Duration,
    /// Time up to which its reports have been ordered; it never decreases while the area is live.
    pub(super) told: Instant,
    /// Whether its node reports that its boards are silent.
    pub(super) silent: bool,
    /// The state of its node's layouts, and the page that it has reported.
    pub(super) layout: LayoutStanding,
    pub(super) page: Option<String>,
    /// Whether the settings of apps have been sent to its node.
    pub(super) is_brought_up: bool,
    /// Time at which it became live: earlier events are ignored.
    since: Instant,
    /// The numbers of the last message and of the next event.
    sequence: u64,
    next_event: Option<u64>,
}

/// The use of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MessageUse {
    /// It is dropped: an old one, one from a node that does not hold the area, or one of an unknown time.
    Nothing,
    /// It is too old to act on, or lies in the future.
    Stale,
    /// It shows that the node's clock was set: the times of the last messages are unknown.
    ClockSet,
    /// It is current; `lost` events are missing before it.
    Fresh { lost: u64 },
}

impl JoinedArea {
    /// Notes a message and its sender, received at `now`.
    pub(super) fn note(&mut self, message: &NodeMessage, now: Instant) -> MessageUse {
        self.claims.note(message.node, &message.name, now);
        if self.claims.holder(now) != Holder::One(message.node) {
            return MessageUse::Nothing;
        }
        if self.holder.replace(message.node) != Some(message.node) {
            // The clock and the numbers of another node.
            self.clock = NodeClock::default();
            (self.sequence, self.next_event, self.newest) = (0, None, None);
        }
        if message.sequence <= self.sequence {
            return MessageUse::Nothing;
        }
        self.sequence = message.sequence;
        self.silent = message.silent;
        let was_set = message.echo.is_some_and(|echo| self.clock.note(&echo, message.sent, now));
        let expected =
            self.next_event.replace(message.first_event.saturating_add(message.events.len() as u64));
        let lost = message.first_event.saturating_sub(expected.unwrap_or(message.first_event));
        if was_set {
            return MessageUse::ClockSet;
        }
        let Some(frame) = message.frame.and_then(|frame| self.clock.here(frame)) else {
            return MessageUse::Nothing;
        };
        let unsure = self.clock.uncertainty(now).unwrap_or_default();
        // A message about silent boards brings no new frame, however recent it is.
        if message.silent || now.since(frame) + unsure > LOST_AFTER || frame > now + AHEAD {
            return MessageUse::Stale;
        }
        (self.newest, self.unsure) = (Some(frame), unsure);
        MessageUse::Fresh { lost }
    }

    /// The gateway's time at which the node's clock showed `micros`.
    pub(super) fn here(&self, micros: u64) -> Instant {
        self.clock.here(micros).unwrap_or(Instant::START)
    }

    /// Makes `at` monotonic for the order of all areas: returns the greatest of `at` and all earlier results.
    pub(super) fn in_order(&mut self, at: Instant) -> Instant {
        self.told = self.told.max(at);
        self.told
    }

    /// Whether the gateway reports an event of that time.
    pub(super) fn is_of_interest(&self, at: Instant) -> bool {
        at >= self.since
    }

    /// Makes the area live from `at` on.
    pub(super) fn begin(&mut self, at: Instant) {
        self.standing = AreaStanding::Live;
        self.is_brought_up = false;
        (self.since, self.told) = (at, at);
    }

    /// Greatest possible age of its newest frame at `now`; `None` without a frame.
    pub(super) fn age(&self, now: Instant) -> Option<Duration> {
        self.newest.map(|newest| now.since(newest) + self.unsure)
    }

    /// The standing to which it falls at `now`, if it falls.
    pub(super) fn fallen(&mut self, now: Instant) -> Option<AreaStanding> {
        let is_disputed = self.claims.holder(now) == Holder::Disputed;
        let is_old = self.age(now).is_none_or(|age| age > LOST_AFTER);
        let next = match self.standing {
            AreaStanding::Disputed if is_disputed => return None,
            _ if is_disputed => AreaStanding::Disputed,
            AreaStanding::Live if is_old => AreaStanding::Lost,
            AreaStanding::Disputed => AreaStanding::Lost,
            _ => return None,
        };
        Some(next)
    }

    /// Sets the standing to which it falls.
    pub(super) fn fall(&mut self, standing: AreaStanding) {
        self.standing = standing;
        self.newest = None;
    }
}
