//! The guard between a press and its action.
//!
//! ```text
//! Confirm (arm, then press within 3 s)
//!  1  a press and its release while at rest        -> Pressed, Released, Armed; it does nothing else
//!  2  that first press is cancelled                -> Pressed, Cancelled; not armed
//!  3  armed, a second press within the time        -> acts as if unguarded, then Disarmed
//!     and where a double tap may come of it        -> Disarmed once that is known
//!  4  armed, the second press is cancelled         -> Cancelled, Disarmed
//!  5  armed, no press within the time              -> Disarmed
//!  6  armed, sensing is lost, a foot steps or slides on, an app stops it
//!                                                  -> Disarmed
//!
//! HoldToRun (off as soon as the contact is uncertain)
//!  7  a press                                      -> acts for as long as it is held
//!  8  the foot lets go                             -> Released
//!  9  the force can't be believed for one frame, the foot slides off, sensing is lost
//!                                                  -> Cancelled; needs a lift
//! 10  `warn` before the longest time               -> Warned, once
//! 11  held for the longest time                    -> Cancelled; needs a lift
//! ```

use super::guard::{Confirm, Guard};
use super::press::{PressOutcome, PressState};
use super::{Emitted, EventKind, Input};
use crate::units::Instant;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    /// The press that will arm it is down.
    Arming,
    Armed {
        until: Instant,
    },
    /// The press that acts is down.
    Acting {
        since: Instant,
        warned: bool,
    },
}

/// The state of a guard: idle, arming, armed or acting.
#[derive(Clone, Debug)]
pub(super) struct Guarding {
    guard: Guard,
    state: State,
}

impl Guarding {
    pub(super) fn new(guard: Guard) -> Self {
        Self { guard, state: State::Idle }
    }

    pub(super) fn is_armed(&self) -> bool {
        matches!(self.state, State::Armed { .. })
            || (matches!(self.state, State::Acting { .. }) && matches!(self.guard, Guard::Confirm { .. }))
    }

    /// Whether the present press will only arm it.
    pub(super) fn is_arming(&self) -> bool {
        self.state == State::Arming
    }

    pub(super) fn has_warned(&self) -> bool {
        matches!(self.state, State::Acting { warned: true, .. })
    }

    /// Whether time alone changes nothing.
    pub(super) fn is_at_rest(&self) -> bool {
        self.state == State::Idle
    }

    /// Ends a press that is untrusted or has lasted too long; returns the outcome of the press.
    pub(super) fn end_untrusted(
        &mut self,
        now: Instant,
        input: Input,
        press: &mut PressState,
        outcome: Option<PressOutcome>,
        emitted: &mut Emitted,
    ) -> Option<PressOutcome> {
        let (Guard::HoldToRun(run), State::Acting { since, warned }) = (self.guard, self.state) else {
            return outcome;
        };
        let untrusted = matches!(input, Input::Foot { trusted: false, .. });
        if outcome == Some(PressOutcome::Cancelled) || (untrusted && outcome.is_none()) {
            press.cancel();
            return Some(PressOutcome::Cancelled);
        }
        let held = now.since(since);
        if outcome.is_none() && held >= run.max {
            return press.cancel();
        }
        if outcome.is_none() && !warned && held >= run.max.saturating_sub(run.warns()) {
            self.state = State::Acting { since, warned: true };
            emitted.push(EventKind::Warned);
        }
        outcome
    }

    /// Whether the press reaches the control; a press that only arms ends here.
    pub(super) fn passes(
        &mut self,
        now: Instant,
        outcome: Option<PressOutcome>,
        broken: bool,
        emitted: &mut Emitted,
    ) -> bool {
        let Guard::Confirm(Confirm { within }) = self.guard else {
            if outcome == Some(PressOutcome::Pressed) {
                self.state = State::Acting { since: now, warned: false };
            }
            return true;
        };
        match (self.state, outcome) {
            (State::Idle, Some(PressOutcome::Pressed)) => {
                self.state = State::Arming;
                emitted.push(EventKind::Pressed);
            }
            (State::Arming, Some(PressOutcome::Released)) => {
                self.state = State::Armed { until: now + within };
                emitted.extend([EventKind::Released, EventKind::Armed]);
            }
            (State::Arming, Some(PressOutcome::Cancelled)) => {
                self.state = State::Idle;
                emitted.push(EventKind::Cancelled);
            }
            (State::Armed { until }, Some(PressOutcome::Pressed)) if now < until => {
                self.state = State::Acting { since: now, warned: false };
                return true;
            }
            (State::Armed { until }, _) if broken || now >= until => {
                self.state = State::Idle;
                emitted.push(EventKind::Disarmed);
                // Too late for the second press: it counts as a first one.
                if outcome == Some(PressOutcome::Pressed) {
                    self.state = State::Arming;
                    emitted.push(EventKind::Pressed);
                }
            }
            (State::Acting { .. }, _) => return true,
            (State::Idle | State::Arming | State::Armed { .. }, _) => {}
        }
        false
    }

    /// Updates the state after the control: `is_down` is whether the press is still down, `waits` whether the control
    /// waits for a second tap, during which the guard must stay open.
    pub(super) fn after(&mut self, is_down: bool, waits: bool, emitted: &mut Emitted) {
        let confirms = matches!(self.guard, Guard::Confirm { .. });
        if matches!(self.state, State::Acting { .. }) && !is_down && !(confirms && waits) {
            self.state = State::Idle;
            if confirms {
                emitted.push(EventKind::Disarmed);
            }
        }
    }
}
