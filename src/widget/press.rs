//! The press that every control shares: from a foot's force to down and up.
//!
//! ```text
//!  force    press  ---------------/\---------------------
//!           release -----/\-----/----\------------/\------
//!
//!  1  above press for `dwell`                      -> Pressed
//!  2  below release before `dwell` is over         -> nothing
//!  3  between the two while down                   -> stays down
//!  4  below release for LIFT_TIME while down       -> Released
//!  5  below release for less than that while down  -> nothing (one bad sample is not a lift)
//!  6  off the control while down                   -> Cancelled
//!  7  sensing lost while down                      -> Cancelled
//!  8  above press within `lockout` of a release    -> waits until the lockout is over
//!  9  already loaded at start, after a loss, or by a foot that slid on
//!                                                  -> nothing until below release for UNLOAD_TIME
//! 10  untrusted force while up                     -> nothing; while down it holds
//! 11  below release while down, but untrusted      -> Cancelled: an untrusted lift commits nothing
//! 12  the foot on it takes a step                  -> like 9, while down -> Cancelled
//! ```

use std::time::Duration;

use super::{Input, Thresholds};
use crate::units::{Instant, Newtons};

/// Time for which the force must stay below the release threshold for a lift (our choice).
///
/// It delays no press; it delays a release by less than a person can feel.
pub(super) const LIFT_TIME: Duration = Duration::from_millis(4);

/// Time without load before a control works after a start or a loss (our choice: longer than the tracker needs to
/// find a foot again when packets return).
const UNLOAD_TIME: Duration = Duration::from_millis(20);

/// The outcome of a press in one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PressOutcome {
    Pressed,
    Released,
    Cancelled,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// Ignores all presses until an unloaded span is over; unloaded since `clear`.
    NeedsLift { clear: Option<Instant> },
    /// At rest; presses count from `ready` on.
    Up { ready: Instant },
    /// Loaded enough since `since`, waiting for the dwell to pass.
    Arming { since: Instant },
    /// Engaged.
    Down,
    /// Engaged, but unloaded since `since`.
    Lifting { since: Instant },
}

const NEEDS_LIFT: State = State::NeedsLift { clear: None };

/// One control's press: needs a lift, up, arming, down or lifting.
#[derive(Clone, Debug)]
pub(super) struct PressState {
    /// The thresholds as written.
    written: Thresholds,
    /// The thresholds for the person of the last foot on it.
    at: Thresholds,
    state: State,
    force: Newtons,
}

impl PressState {
    /// A press that first needs a span without load.
    pub(super) fn new(at: Thresholds) -> Self {
        Self { written: at, at, state: NEEDS_LIFT, force: Newtons::ZERO }
    }

    /// The thresholds for the person of the last foot on it.
    pub(super) fn thresholds(&self) -> Thresholds {
        self.at
    }

    pub(super) fn is_engaged(&self) -> bool {
        matches!(self.state, State::Down | State::Lifting { .. })
    }

    pub(super) fn needs_lift(&self) -> bool {
        matches!(self.state, State::NeedsLift { .. })
    }

    /// Whether a step with [`Input::Clear`] would change nothing.
    pub(super) fn is_at_rest(&self) -> bool {
        matches!(self.state, State::Up { .. }) && self.force == Newtons::ZERO
    }

    /// Force of the foot on it as a share of the press threshold, at least 0.
    pub(super) fn share(&self) -> f32 {
        (self.force / self.at.press).max(0.0)
    }

    /// Whether the force is closer to the press than to the release threshold: the foot is not lifting.
    pub(super) fn is_firm(&self) -> bool {
        self.is_engaged() && self.force >= (self.at.press + self.at.release) * 0.5
    }

    /// Ends the press without committing; a foot still on it must lift first.
    pub(super) fn cancel(&mut self) -> Option<PressOutcome> {
        let engaged = self.is_engaged();
        self.state = NEEDS_LIFT;
        engaged.then_some(PressOutcome::Cancelled)
    }

    pub(super) fn step(&mut self, now: Instant, input: Input) -> Option<PressOutcome> {
        use State::{Arming, Down, Lifting, NeedsLift, Up};
        // An absent foot has no force.
        let (force, trusted) = match input {
            Input::Foot { force, trusted, weight, .. } => {
                // The thresholds stay during a press: a better estimate of the weight is not a release.
                if !self.is_engaged() {
                    self.at = self.written.for_weight(weight);
                }
                (force, trusted)
            }
            Input::Clear => (Newtons::ZERO, true),
            Input::SlidOn { force } | Input::Stepping { force } => {
                self.force = force;
                return self.cancel();
            }
            Input::SlidOff => {
                self.force = Newtons::ZERO;
                let engaged = self.is_engaged();
                self.state = Up { ready: now };
                return engaged.then_some(PressOutcome::Cancelled);
            }
            Input::Lost => {
                self.force = Newtons::ZERO;
                return self.cancel();
            }
        };
        self.force = force;
        let loaded = force >= self.at.release;
        let (state, outcome) = match self.state {
            NeedsLift { .. } if loaded || !trusted => (NEEDS_LIFT, None),
            NeedsLift { clear: Some(clear) } if now.since(clear) >= UNLOAD_TIME => (Up { ready: now }, None),
            NeedsLift { clear } => (NeedsLift { clear: clear.or(Some(now)) }, None),

            Up { ready } if trusted && force >= self.at.press && now >= ready => {
                if self.at.dwell.is_zero() {
                    (Down, Some(PressOutcome::Pressed))
                } else {
                    (Arming { since: now }, None)
                }
            }
            Up { ready } => (Up { ready }, None),

            Arming { .. } if !loaded || !trusted => (Up { ready: now }, None),
            Arming { since } if now.since(since) >= self.at.dwell => (Down, Some(PressOutcome::Pressed)),
            Arming { since } => (Arming { since }, None),

            Down if loaded => (Down, None),
            Down => (Lifting { since: now }, None),

            Lifting { .. } if loaded => (Down, None),
            Lifting { since } if now.since(since) >= LIFT_TIME && !trusted => {
                (NEEDS_LIFT, Some(PressOutcome::Cancelled))
            }
            Lifting { since } if now.since(since) >= LIFT_TIME => {
                (Up { ready: now + self.at.lockout }, Some(PressOutcome::Released))
            }
            Lifting { since } => (Lifting { since }, None),
        };
        self.state = state;
        outcome
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    const AT: Thresholds = Thresholds::new(Newtons(60.0), Newtons(40.0));

    /// Time without load, in milliseconds, after which the press works.
    const SETTLED: u64 = 25;

    /// One press fed millisecond by millisecond.
    struct Bench {
        press: PressState,
        now: Instant,
        outcomes: Vec<(u64, PressOutcome)>,
    }

    impl Bench {
        /// A press after a span without load.
        fn ready() -> Self {
            let mut bench = Self { press: PressState::new(AT), now: Instant::START, outcomes: Vec::new() };
            bench.give(Input::Clear, SETTLED);
            bench
        }

        fn give(&mut self, input: Input, millis: u64) {
            for _ in 0..millis {
                self.now = self.now + Duration::from_millis(1);
                if let Some(outcome) = self.press.step(self.now, input) {
                    self.outcomes.push((self.now.micros() / 1000 - SETTLED, outcome));
                }
            }
        }

        fn force(&mut self, newtons: f32, millis: u64) {
            self.give(foot(newtons), millis);
        }
    }

    fn foot(newtons: f32) -> Input {
        Input::Foot { force: Newtons(newtons), trusted: true, place: Vec2::splat(0.5), weight: None }
    }

    #[test]
    fn line_1_presses_once_the_dwell_has_passed() {
        let mut bench = Bench::ready();
        bench.force(80.0, 100);
        // Loaded from 1 ms on, 20 ms dwell.
        assert_eq!(bench.outcomes, [(21, PressOutcome::Pressed)]);
    }

    #[test]
    fn line_2_a_graze_is_no_press() {
        let mut bench = Bench::ready();
        bench.force(80.0, 15);
        bench.force(10.0, 30);
        assert_eq!(bench.outcomes, []);
    }

    #[test]
    fn lines_3_and_4_hysteresis_holds_until_below_release() {
        let mut bench = Bench::ready();
        bench.force(80.0, 30);
        bench.force(45.0, 200);
        assert!(bench.press.is_engaged());
        bench.force(35.0, 10);
        assert_eq!(bench.outcomes, [(21, PressOutcome::Pressed), (235, PressOutcome::Released)]);
    }

    #[test]
    fn line_5_one_bad_sample_is_no_lift() {
        let mut bench = Bench::ready();
        bench.force(80.0, 30);
        bench.force(0.0, 1);
        bench.force(80.0, 30);
        assert_eq!(bench.outcomes, [(21, PressOutcome::Pressed)]);
    }

    #[test]
    fn lines_6_and_7_sliding_off_and_losing_the_floor_cancel() {
        for end in [Input::SlidOff, Input::Lost] {
            let mut bench = Bench::ready();
            bench.force(80.0, 30);
            bench.give(end, 5);
            assert_eq!(
                bench.outcomes,
                [(21, PressOutcome::Pressed), (31, PressOutcome::Cancelled)],
                "{end:?}"
            );
        }
    }

    #[test]
    fn line_8_a_bounce_waits_for_the_lockout() {
        let mut bench = Bench::ready();
        bench.force(80.0, 30);
        bench.force(0.0, 6);
        bench.force(80.0, 60);
        // Released at 35 ms; locked out until 55 ms; then the dwell.
        assert_eq!(
            bench.outcomes,
            [(21, PressOutcome::Pressed), (35, PressOutcome::Released), (75, PressOutcome::Pressed)]
        );
    }

    #[test]
    fn line_9_a_loaded_control_must_first_be_seen_unloaded() {
        let mut bench = Bench::ready();
        bench.give(Input::Lost, 1);
        bench.force(80.0, 500);
        assert!(bench.press.needs_lift());
        bench.force(10.0, 25);
        bench.force(80.0, 30);
        assert_eq!(bench.outcomes.len(), 1);
        let mut slid = Bench::ready();
        slid.give(Input::SlidOn { force: Newtons(80.0) }, 1);
        slid.force(80.0, 500);
        assert_eq!(slid.outcomes, []);
    }

    #[test]
    fn lines_10_and_11_untrusted_force_starts_nothing_and_commits_nothing() {
        let untrusted =
            |force| Input::Foot { force: Newtons(force), trusted: false, place: Vec2::ZERO, weight: None };
        let mut bench = Bench::ready();
        bench.give(untrusted(200.0), 100);
        assert_eq!(bench.outcomes, []);
        bench.force(80.0, 30);
        bench.give(untrusted(80.0), 100);
        bench.force(80.0, 10);
        assert_eq!(bench.outcomes.len(), 1, "held while untrusted");
        bench.give(untrusted(0.0), 10);
        let kinds: Vec<_> = bench.outcomes.iter().map(|(_, outcome)| *outcome).collect();
        assert_eq!(kinds, [PressOutcome::Pressed, PressOutcome::Cancelled]);
    }

    #[test]
    fn line_12_a_step_starts_nothing_and_ends_what_was_started() {
        let stepping = Input::Stepping { force: Newtons(500.0) };
        let mut bench = Bench::ready();
        bench.give(stepping, 300);
        bench.force(80.0, 300);
        assert_eq!(bench.outcomes, [], "the same foot, no longer thought to step");
        let mut bench = Bench::ready();
        bench.force(80.0, 30);
        bench.give(stepping, 1);
        assert_eq!(bench.outcomes, [(21, PressOutcome::Pressed), (31, PressOutcome::Cancelled)]);
    }

    #[test]
    fn the_weight_moves_the_thresholds_but_not_under_a_foot_that_presses() {
        let share = Some(super::super::WeightShare { press: 0.1, release: 0.06 });
        let mut bench = Bench::ready();
        bench.press = PressState::new(Thresholds { share, ..AT });
        bench.give(Input::Clear, SETTLED);
        let of = |force, weight| Input::Foot {
            force: Newtons(force),
            trusted: true,
            place: Vec2::splat(0.5),
            weight: Some(Newtons(weight)),
        };
        bench.give(of(80.0, 900.0), 50);
        assert_eq!(bench.outcomes, [], "90 N for who weighs 900 N");
        bench.give(of(80.0, 600.0), 50);
        bench.give(of(80.0, 2000.0), 50);
        assert!(bench.press.is_engaged());
    }
}
