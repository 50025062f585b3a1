//! One area as the gateway knows it: who serves it, how its clock goes, whether it lives.

use std::time::Duration;

use underfoot::units::Instant;

use super::claim::{Claims, Holder};
use super::clock::NodeClock;
use super::presses::Presses;
use crate::message::{LayoutStanding, NodeMessage, Standing};

/// Greatest age of an area's newest frame, by the gateway's own clock: the uncertainty of the node's clock adds to the
/// age. All holds of the area are cancelled then.
pub const LOST_AFTER: Duration = Duration::from_millis(100);

/// How far in the future a frame may be: the uncertainty of clocks that are known to a round trip. What is further is
/// of a clock that was set, of which the next echo tells.
const AHEAD: Duration = Duration::from_millis(20);

/// One area.
#[derive(Clone, Debug, Default)]
pub(super) struct AreaState {
    pub(super) claims: Claims,
    pub(super) holder: Option<u64>,
    pub(super) standing: Standing,
    pub(super) clock: NodeClock,
    pub(super) presses: Presses,
    /// When its newest frame was, on the gateway's clock.
    pub(super) newest: Option<Instant>,
    /// Uncertainty of that time.
    unsure: Duration,
    /// Up to when what it told has been put in order; never goes back while it lives.
    pub(super) told: Instant,
    /// Whether its boards are silent, as its node says.
    pub(super) silent: bool,
    /// How its node stands with layouts, and the page that it has told of.
    pub(super) layout: LayoutStanding,
    pub(super) page: Option<String>,
    /// Whether its node has been told what apps have set.
    pub(super) is_brought_up: bool,
    /// When it came to live: events before that are of no interest any more.
    since: Instant,
    /// The numbers of the last message and of the next event.
    sequence: u64,
    next_event: Option<u64>,
}

/// What a message is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Worth {
    /// Nothing: it is an old one, from a node that is not believed, or of a time that is not known yet.
    Nothing,
    /// It is too old to act on, or of a moment that has not come yet.
    Stale,
    /// It shows that the node's clock was set: nobody knows of when the last messages were.
    ClockSet,
    /// It tells what is now; `lost` events are missing before it.
    Fresh { lost: u64 },
}

impl AreaState {
    /// Takes note of who says what when.
    pub(super) fn note(&mut self, message: &NodeMessage, now: Instant) -> Worth {
        self.claims.note(message.node, &message.name, now);
        if self.claims.holder(now) != Holder::One(message.node) {
            return Worth::Nothing;
        }
        if self.holder.replace(message.node) != Some(message.node) {
            // Another clock, other numbers.
            self.clock = NodeClock::default();
            (self.sequence, self.next_event, self.newest) = (0, None, None);
        }
        if message.sequence <= self.sequence {
            return Worth::Nothing;
        }
        self.sequence = message.sequence;
        self.silent = message.silent;
        let was_set = message.echo.is_some_and(|echo| self.clock.note(&echo, message.sent, now));
        let expected =
            self.next_event.replace(message.first_event.saturating_add(message.events.len() as u64));
        let lost = message.first_event.saturating_sub(expected.unwrap_or(message.first_event));
        if was_set {
            return Worth::ClockSet;
        }
        let Some(frame) = message.frame.and_then(|frame| self.clock.here(frame)) else {
            return Worth::Nothing;
        };
        let unsure = self.clock.uncertainty(now).unwrap_or_default();
        // What a node says of silent boards is no news of the floor, however new.
        if message.silent || now.since(frame) + unsure > LOST_AFTER || frame > now + AHEAD {
            return Worth::Stale;
        }
        (self.newest, self.unsure) = (Some(frame), unsure);
        Worth::Fresh { lost }
    }

    /// The moment here of `micros` on the node's clock.
    pub(super) fn here(&self, micros: u64) -> Instant {
        self.clock.here(micros).unwrap_or(Instant::START)
    }

    /// The moment in the order of all areas: as [`AreaState::here`], but never before one that was given earlier.
    pub(super) fn in_order(&mut self, at: Instant) -> Instant {
        self.told = self.told.max(at);
        self.told
    }

    /// Whether an event of that time is of interest.
    pub(super) fn is_of_interest(&self, at: Instant) -> bool {
        at >= self.since
    }

    /// Begins to believe what is told from `at` on.
    pub(super) fn begin(&mut self, at: Instant) {
        self.standing = Standing::Live;
        self.is_brought_up = false;
        (self.since, self.told) = (at, at);
    }

    /// Greatest possible age of its newest frame at `now`; `None` without a frame.
    pub(super) fn age(&self, now: Instant) -> Option<Duration> {
        self.newest.map(|newest| now.since(newest) + self.unsure)
    }

    /// Whether it has to be given up at `now`, and as what.
    pub(super) fn fallen(&mut self, now: Instant) -> Option<Standing> {
        let is_disputed = self.claims.holder(now) == Holder::Disputed;
        let is_old = self.age(now).is_none_or(|age| age > LOST_AFTER);
        let next = match self.standing {
            Standing::Disputed if is_disputed => return None,
            _ if is_disputed => Standing::Disputed,
            Standing::Live if is_old => Standing::Lost,
            Standing::Disputed => Standing::Lost,
            _ => return None,
        };
        Some(next)
    }

    /// Gives it up.
    pub(super) fn fall(&mut self, standing: Standing) {
        self.standing = standing;
        self.newest = None;
    }
}
