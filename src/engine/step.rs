//! Distinguishes a step from a press, by the way people walk and stand.
//!
//! ```text
//! 1  lands a step ahead of a foot that is rolling over       -> a step from the start
//! 2  lands just after another foot has left that pressed nothing, while
//!    the foot that stands has itself just stepped there       -> a step from the start
//! 3  carries most of the body                                -> a step from then on
//! 4  carries about half of the body for longer than a press  -> a step from then on
//! 5  rolls over under a good part of the body                -> a step from then on
//! 6  lands as a body does, and nobody is known to stand there
//!    who could have stamped                                  -> a step from then on
//! 7  anything else                                           -> a press, from its first millisecond
//! ```
//!
//! Lines 1 and 2 use the past only, so that they add no latency: a foot that taps beside a standing foot is never
//! delayed. Lines 3 to 6 correct the result where the past is unknown, such as for the first foot that a person puts
//! on the floor.
//! # Source
//! Adults walk at 0.8 to 1.8 m/s with 80 to 130 steps a minute of 0.5 to 0.9 m; the stance lasts
//! 0.5 to 1.0 s, and each foot alone carries the whole body for 40 % of the cycle (Perry 1992;
//! Winter 1991). The centre of pressure runs 0.13 to 0.27 m from heel to toe during it, that
//! is at 0.15 to 0.4 m/s; under a standing foot it wanders by less than 2 cm/s (Prieto 1996).
//! A bound of our own is marked as such.

use std::time::Duration;

use glam::Vec2;

use crate::units::Instant;

/// Minimum speed of a centre of pressure that rolls from heel to toe, in metres per second (our choice: half the
/// speed of the slowest walkers, several times the speed of sway).
const ROLL_M_S: f32 = 0.12;

/// Distance between a landing foot and the one that rolls over, in metres: more than the width of a stance, at most
/// the longest step.
const STEP_M: std::ops::RangeInclusive<f32> = 0.15..=1.1;

/// Minimum cosine of the angle between the roll and the step (our choice).
const ALONG: f32 = 0.3;

/// Longest time from one footfall to the other foot's next in a walk that goes on
/// (a slow shuffle, 45 steps a minute).
const STEP_TIME: Duration = Duration::from_millis(1300);

/// Longest swing of a foot from one place to the next.
const SWING_TIME: Duration = Duration::from_millis(900);

/// Share of the body above which a foot carries it (our choice: more than a person can press with while standing on
/// the other foot, without going over to it).
pub(super) const CARRIES: f32 = 0.65;

/// Force above which a foot alone on the floor carries a body of unknown weight, in newtons: far above any press
/// (three times the heaviest shipped threshold).
const CARRIES_ALONE_N: f32 = 350.0;

/// Time for which it must carry that, so that a single bad estimate does not make a step.
const CARRIES_FOR: Duration = Duration::from_millis(30);

/// Minimum load on a foot that stands beside the other one: about half of the body, less some sway; and a force in
/// newtons above that on a heavy pedal.
const STANDS: f32 = 0.38;
const STANDS_N: f32 = 200.0;

/// Maximum duration of a press with that force (our choice: twice a slow click).
const STANDS_FOR: Duration = Duration::from_millis(800);

/// A foot at rest on a control that is meant for taps: minimum share of the body, minimum force in newtons, and
/// minimum time.
pub(super) const RESTS: f32 = 0.25;
pub(super) const RESTS_N: f32 = 110.0;
const RESTS_FOR: Duration = Duration::from_secs(1);

/// Minimum distance of a roll, above that of a wobble, in metres, and maximum time since the landing.
const ROLLED_M: f32 = 0.07;
const ROLLED_WITHIN: Duration = Duration::from_millis(1200);

/// Minimum load on a foot that rolls over under a body: share of the body and newtons.
const ROLLS: f32 = 0.35;
const ROLLS_N: f32 = 200.0;

/// A heel strike: at least this force, in newtons, within this time of the landing.
///
/// # Source
/// Walking loads a foot by 7 to 20 body weights a second when it lands (Winter 1991; 10 N a
/// millisecond in the recorded walk that was tried); people who press build up 60 to 150 N in
/// 60 to 120 ms.
const IMPACT_N: f32 = 250.0;
const IMPACT_WITHIN: Duration = Duration::from_millis(45);

/// The state of a person when one of their feet lands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    /// Place of the landing.
    pub(super) at: Vec2,
    /// The heaviest foot of the same person that was down.
    pub(super) support: Option<Support>,
    /// Time since the last lift of another foot of the person, one that had pressed no control.
    pub(super) left: Option<Duration>,
}

/// A foot that carries the person while another one lands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Support {
    pub(super) at: Vec2,
    /// Time that it has been down.
    pub(super) age: Duration,
    /// Whether it stepped there, rather than returning from a control.
    pub(super) stepped: bool,
    /// Velocity of its centre of pressure over the last quarter of a second before the landing.
    pub(super) rolling: Vec2,
}

impl Landing {
    /// Whether the foot continues a walk (lines 1 and 2).
    pub(super) fn walks(&self) -> bool {
        let Some(support) = &self.support else { return false };
        let way = self.at - support.at;
        let speed = support.rolling.length();
        let rolls_over = speed >= ROLL_M_S
            && STEP_M.contains(&way.length())
            && support.rolling.dot(way) >= ALONG * speed * way.length();
        let steps_on =
            support.stepped && support.age <= STEP_TIME && self.left.is_some_and(|since| since <= SWING_TIME);
        rolls_over || steps_on
    }

    /// Whether the person stood on the other foot, and had not just stepped there.
    pub(super) fn has_standing_support(&self) -> bool {
        self.support.as_ref().is_some_and(|support| !support.stepped || support.age > STEP_TIME)
    }
}

/// The load on one foot at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loading {
    pub(super) force: f32,
    /// Share of the person's weight, or of the present load on the person's feet; `None` if neither is known.
    pub(super) share: Option<f32>,
    /// Time since the landing.
    pub(super) age: Duration,
    /// Distance of its centre of pressure from the place of the landing, in metres.
    pub(super) travelled: f32,
    /// Whether the person stood on the other foot when it landed.
    pub(super) has_support: bool,
}

/// Detects from its load that one foot carries a body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepWatch {
    carries: HeldSince,
    stands: HeldSince,
    rests: HeldSince,
}

impl StepWatch {
    /// Processes the present load; returns whether it is a step (lines 3, 5 and 6).
    pub(super) fn is_step(&mut self, loading: &Loading, now: Instant) -> bool {
        let Loading { force, share, age, travelled, has_support } = *loading;
        let above = |least: f32, newtons: f32| force >= newtons && share.is_none_or(|share| share >= least);
        let carries = share.map_or(force >= CARRIES_ALONE_N, |share| share >= CARRIES);
        // A foot alone on the floor may be at rest or held there: its share is unknown.
        self.rests.note(share.is_some() && above(RESTS, RESTS_N), now);
        let rolls = above(ROLLS, ROLLS_N) && travelled >= ROLLED_M && age <= ROLLED_WITHIN;
        self.stands.note(above(STANDS, STANDS_N), now);
        self.carries.note(carries, now) >= Some(CARRIES_FOR)
            || rolls
            || !has_support && force >= IMPACT_N && age <= IMPACT_WITHIN
    }

    /// Whether the foot has carried about half of the body for longer than a press lasts (line 4).
    pub(super) fn stands(&self, now: Instant) -> bool {
        self.stands.lasts(now) >= Some(STANDS_FOR)
    }

    /// Whether the foot has been at rest for longer than a tap lasts.
    pub(super) fn rests(&self, now: Instant) -> bool {
        self.rests.lasts(now) >= Some(RESTS_FOR)
    }
}

/// Start time of a condition that has held without a break.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldSince(Option<Instant>);

impl HeldSince {
    /// Notes whether the condition holds now. Returns for how long; `None` if it does not hold.
    pub(super) fn note(&mut self, is: bool, now: Instant) -> Option<Duration> {
        self.0 = is.then(|| self.0.unwrap_or(now));
        self.lasts(now)
    }

    /// Time for which the condition has held; `None` if it does not hold.
    pub(super) fn lasts(&self, now: Instant) -> Option<Duration> {
        self.0.map(|since| now.since(since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STANDING: Support =
        Support { at: Vec2::ZERO, age: Duration::from_secs(5), stepped: false, rolling: Vec2::ZERO };

    fn landing(support: Option<Support>, left_ms: Option<u64>) -> Landing {
        Landing { at: Vec2::new(0.0, 0.6), support, left: left_ms.map(Duration::from_millis) }
    }

    #[test]
    fn line_1_a_foot_lands_ahead_of_one_that_rolls_over() {
        let rolling = |x: f32, y: f32| Some(Support { rolling: Vec2::new(x, y), ..STANDING });
        assert!(landing(rolling(0.0, 0.25), None).walks());
        assert!(!landing(rolling(0.0, 0.05), None).walks(), "sway");
        assert!(!landing(rolling(0.25, 0.0), None).walks(), "another way");
    }

    #[test]
    fn line_2_two_steps_in_a_row_are_a_walk() {
        let arrived = Some(Support { age: Duration::from_millis(600), stepped: true, ..STANDING });
        assert!(landing(arrived, Some(400)).walks());
        assert!(!landing(arrived, None).walks(), "somebody puts the second foot down");
        assert!(!landing(arrived, Some(2000)).walks());
        // A standing person takes the foot from beside the other one to the control: not a walk.
        assert!(!landing(Some(STANDING), Some(400)).walks());
        // A foot that went back to its earlier place does not make a step of the other foot's tap either.
        let back = Some(Support { age: Duration::from_millis(600), ..STANDING });
        assert!(!landing(back, Some(400)).walks());
    }

    /// Time at which a foot with this load becomes a step, in milliseconds.
    fn step_after(force: f32, share: Option<f32>, travelled: impl Fn(u64) -> f32) -> Option<u64> {
        let mut watch = StepWatch::default();
        (0..5000).find(|&ms| {
            let loading = Loading {
                force,
                share,
                age: Duration::from_millis(ms),
                travelled: travelled(ms),
                has_support: true,
            };
            let now = Instant::from_millis(ms);
            watch.is_step(&loading, now) || watch.stands(now)
        })
    }

    #[test]
    fn line_3_most_of_a_body_is_a_step_after_30_ms() {
        assert_eq!(step_after(500.0, Some(0.7), |_| 0.0), Some(30));
        assert_eq!(step_after(400.0, None, |_| 0.0), Some(30), "alone");
        assert_eq!(step_after(250.0, None, |_| 0.0), Some(800), "alone, and not sure before it stays");
    }

    #[test]
    fn line_4_half_a_body_is_a_press_no_longer_than_a_press_lasts() {
        assert_eq!(step_after(340.0, Some(0.5), |_| 0.0), Some(800));
        assert_eq!(step_after(150.0, Some(0.34), |_| 0.0), None, "a light person holds a heavy pedal");
    }

    #[test]
    fn line_6_an_impact_is_a_step_unless_somebody_stands_there_who_may_stamp() {
        let lands = |has_support: bool, newtons_per_ms: f32| {
            let mut watch = StepWatch::default();
            (0..100).any(|ms| {
                let force = (newtons_per_ms * ms as f32).min(320.0);
                let age = Duration::from_millis(ms);
                let loading = Loading { force, share: Some(0.3), age, travelled: 0.0, has_support };
                watch.is_step(&loading, Instant::from_millis(ms))
            })
        };
        assert!(lands(false, 10.0), "a heel strikes");
        assert!(!lands(true, 10.0), "a stamp");
        assert!(!lands(false, 4.0), "a quick press");
    }

    #[test]
    fn line_5_a_foot_that_rolls_over_under_a_body_is_a_step() {
        let rolling = |ms: u64| 0.25 * ms as f32 * 1e-3;
        assert_eq!(step_after(300.0, Some(0.45), rolling), Some(280), "7 cm at 0.25 m/s");
        assert_eq!(step_after(100.0, Some(0.15), rolling), None, "a foot that drags a slider");
    }
}
