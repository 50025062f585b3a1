//! What tells a step from a press: how bodies walk and stand.
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
//! Lines 1 and 2 look at what came before, so that nobody waits for an answer: a foot that taps
//! beside a foot that stands is never delayed. Lines 3 to 6 take back what the first two could
//! not know, such as the first foot that somebody puts on the floor.
//!
//! # Source
//! Adults walk at 0.8 to 1.8 m/s with 80 to 130 steps a minute of 0.5 to 0.9 m; the stance lasts
//! 0.5 to 1.0 s, and each foot alone carries the whole body for 40 % of the cycle (Perry 1992;
//! Winter 1991). The centre of pressure runs 0.13 to 0.27 m from heel to toe during it, that
//! is at 0.15 to 0.4 m/s; under a standing foot it wanders by less than 2 cm/s (Prieto 1996).
//! Where a bound is ours, it says so.

use std::time::Duration;

use glam::Vec2;

use crate::units::Instant;

/// Slower than this a centre of pressure does not roll from heel to toe, in metres per second
/// (our choice: half of what the slowest walkers' does, several times what sway does).
const ROLL_M_S: f32 = 0.12;

/// How far a foot lands from the one that rolls over: more than the width of a stance and no
/// more than the longest step, in metres.
const STEP_M: std::ops::RangeInclusive<f32> = 0.15..=1.1;

/// A roll goes where the step goes: cosine between the two (our choice).
const ALONG: f32 = 0.3;

/// Longest time from one footfall to the other foot's next in a walk that goes on
/// (a slow shuffle, 45 steps a minute).
const STEP_TIME: Duration = Duration::from_millis(1300);

/// Longest swing of a foot from one place to the next.
const SWING_TIME: Duration = Duration::from_millis(900);

/// From which share of the body on a foot carries it (our choice: more than anybody can press with
/// while standing on the other foot without going over to it).
pub(super) const CARRIES: f32 = 0.65;

/// What a foot that is alone on the floor carries when it carries a body whose weight is not
/// known, in newtons: far above any press (three times the heaviest shipped threshold).
const CARRIES_ALONE_N: f32 = 350.0;

/// How long it must, so that one bad estimate is not a step.
const CARRIES_FOR: Duration = Duration::from_millis(30);

/// A foot that stands beside the other one carries half of the body, give and take some sway;
/// and more than this many newtons, which hold a heavy pedal.
const STANDS: f32 = 0.38;
const STANDS_N: f32 = 200.0;

/// How long a press of that force may last (our choice: twice a slow click).
const STANDS_FOR: Duration = Duration::from_millis(800);

/// A foot at rest on a control that is meant to be tapped: share of the body, newtons, and for how long.
pub(super) const RESTS: f32 = 0.25;
pub(super) const RESTS_N: f32 = 110.0;
const RESTS_FOR: Duration = Duration::from_secs(1);

/// How far a foot must roll over for it to be more than a wobble, in metres, and within which time of its landing.
const ROLLED_M: f32 = 0.07;
const ROLLED_WITHIN: Duration = Duration::from_millis(1200);

/// What rolls over under a body carries at least this share of it, and so many newtons.
const ROLLS: f32 = 0.35;
const ROLLS_N: f32 = 200.0;

/// A heel that strikes bears so many newtons within so short a time.
///
/// # Source
/// Walking loads a foot by 7 to 20 body weights a second when it lands (Winter 1991; 10 N a
/// millisecond in the recorded walk that was tried); people who press build up 60 to 150 N in
/// 60 to 120 ms.
const IMPACT_N: f32 = 250.0;
const IMPACT_WITHIN: Duration = Duration::from_millis(45);

/// What was known of somebody when a foot of theirs landed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    /// Where it landed.
    pub(super) at: Vec2,
    /// The heaviest foot of the same person that was down.
    pub(super) support: Option<Support>,
    /// How long ago another foot of theirs left the floor that had pressed nothing.
    pub(super) left: Option<Duration>,
}

/// A foot that carries somebody while another one lands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Support {
    pub(super) at: Vec2,
    /// How long it has been down.
    pub(super) age: Duration,
    /// Whether it stepped there, rather than coming back from a control.
    pub(super) stepped: bool,
    /// Velocity of its centre of pressure over the last quarter of a second before the landing.
    pub(super) rolling: Vec2,
}

impl Landing {
    /// Whether the foot goes on with a walk (lines 1 and 2).
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

    /// Whether somebody stood there on the other foot, who has not just come.
    pub(super) fn has_standing_support(&self) -> bool {
        self.support.as_ref().is_some_and(|support| !support.stepped || support.age > STEP_TIME)
    }
}

/// What one foot carries at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loading {
    pub(super) force: f32,
    /// Share of the person's weight, or of all that the person's feet carry now; `None` if nothing
    /// is known of either.
    pub(super) share: Option<f32>,
    /// How long the foot has been down.
    pub(super) age: Duration,
    /// How far its centre of pressure is from where it landed, in metres.
    pub(super) travelled: f32,
    /// Whether somebody stood on the other foot when it landed.
    pub(super) has_support: bool,
}

/// Watches one foot for signs that it carries a body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepWatch {
    carries: Since,
    stands: Since,
    rests: Since,
}

impl StepWatch {
    /// Takes in what the foot carries now; whether it is a step (lines 3, 5 and 6).
    pub(super) fn is_step(&mut self, loading: &Loading, now: Instant) -> bool {
        let Loading { force, share, age, travelled, has_support } = *loading;
        let above = |least: f32, newtons: f32| force >= newtons && share.is_none_or(|share| share >= least);
        let carries = share.map_or(force >= CARRIES_ALONE_N, |share| share >= CARRIES);
        // Of a foot alone on the floor nobody knows whether it is at rest or held there.
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

    /// Whether the foot has been at rest for longer than anybody taps.
    pub(super) fn rests(&self, now: Instant) -> bool {
        self.rests.lasts(now) >= Some(RESTS_FOR)
    }
}

/// Since when something has been so without a break.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Since(Option<Instant>);

impl Since {
    /// Notes whether it is so now. For how long it has been so; `None` if it is not.
    pub(super) fn note(&mut self, is: bool, now: Instant) -> Option<Duration> {
        self.0 = is.then(|| self.0.unwrap_or(now));
        self.lasts(now)
    }

    /// For how long it has been so; `None` if it is not.
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
        // Who stands takes the foot from beside the other one to the control: no walk.
        assert!(!landing(Some(STANDING), Some(400)).walks());
        // Nor does a foot that went back to where it had stood make the other one's tap a step.
        let back = Some(Support { age: Duration::from_millis(600), ..STANDING });
        assert!(!landing(back, Some(400)).walks());
    }

    /// When a foot that carries this becomes a step, in milliseconds.
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
