//! A push button, with the gestures its kind asks for.
//!
//! ```text
//!  1  press                                    -> Pressed; Clicked too if it acts on press
//!  2  release on itself                        -> Released, Clicked (unless it acts on press)
//!  3  slide off, a step, loss                  -> Cancelled
//!
//! with a long press (others never wait for one)
//!  4  held for less than `long_press`          -> as 2: the click waits for the release
//!  5  held for that long                       -> LongPressed; the release gives Released only
//!
//! with a double tap
//!  6  release, no second press within the time -> Released, and Clicked once the time has passed
//!  7  a second tap within the time             -> Released, DoubleTapped
//!  8  the second press becomes something else  -> Clicked for the first tap, then what it became
//!  9  sensing is lost while it waits           -> the first tap is forgotten
//!
//! with a swipe (the button keeps its foot)
//! 10  the foot went `swipe` metres, released   -> Released, Swiped
//! 11  it went less far and is on the button    -> as 2
//! 12  it went less far and is off the button   -> Cancelled
//!
//! with two stages
//! 13  above the hard threshold                 -> HardPressed
//! 14  below the hard release threshold         -> HardReleased; the release gives Released only
//! 15  released from the second stage at once   -> HardReleased, Released
//! 16  cancelled in the second stage            -> Cancelled
//! ```

use std::time::Duration;

use glam::Vec2;

use super::moment::{Foot, Machine, Moment};
use super::press::Outcome;
use super::{Direction, Emitted, EventKind, Thresholds};
use crate::units::{Instant, Newtons};

/// A push button: `Pressed`, then `Released` and `Clicked`, or `Cancelled`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ButtonSpec {
    /// When it engages.
    pub thresholds: Thresholds,
    /// When it clicks.
    pub acts_on: ActsOn,
    /// What else it understands.
    pub gestures: Gestures,
}

impl ButtonSpec {
    /// A button that clicks on release and knows no gestures.
    #[must_use]
    pub const fn new(thresholds: Thresholds) -> Self {
        let gestures = Gestures { double_tap: None, long_press: None, swipe_m: None, hard: None };
        Self { thresholds, acts_on: ActsOn::Release, gestures }
    }
}

/// When a button clicks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ActsOn {
    /// As soon as it is pressed: where every millisecond counts and a slip does no harm.
    Press,
    /// When the foot lets go on it: sliding off takes the press back.
    #[default]
    Release,
}

/// What a button understands besides a tap; nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gestures {
    /// How soon after a tap a second press must be down to make it a double tap.
    pub double_tap: Option<Duration>,
    /// How long a press must last to be a long one.
    pub long_press: Option<Duration>,
    /// How far a foot must go to swipe, in metres.
    pub swipe_m: Option<f32>,
    /// The second stage.
    pub hard: Option<HardStage>,
}

/// The second stage of a press. It grows with the first where that is a share of the person's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardStage {
    /// Force from which on the press is hard; more than the press threshold.
    pub press: Newtons,
    /// Force below which it is hard no longer; less than `press`.
    pub release: Newtons,
}

/// How far beyond its edge a button that keeps its foot still counts the foot as on it, in metres
/// (as much as others let a foot sway).
const MARGIN_M: f32 = 0.03;

/// A push button at work.
#[derive(Clone, Debug)]
pub(super) struct Button {
    spec: ButtonSpec,
    down: Option<Down>,
    /// When a first tap becomes a click, if no second press comes.
    tapped: Option<Instant>,
}

/// A press under way.
#[derive(Clone, Copy, Debug)]
struct Down {
    since: Instant,
    /// Where the foot was first and last, in metres from the button's middle.
    path: Option<(Vec2, Vec2)>,
    /// Whether a first tap came just before.
    second: bool,
    hard: bool,
    /// Whether it has been long or hard: its release is no click.
    spent: bool,
}

impl Button {
    pub(super) fn new(spec: ButtonSpec) -> Self {
        Self { spec, down: None, tapped: None }
    }

    fn pressed(&mut self, now: Instant, emitted: &mut Emitted) {
        let second = self.tapped.take().is_some();
        self.down = Some(Down { since: now, path: None, second, hard: false, spent: false });
        emitted.push(EventKind::Pressed);
        if self.spec.acts_on == ActsOn::Press {
            emitted.push(EventKind::Clicked);
        }
    }

    fn held(&mut self, moment: &Moment, foot: Foot, emitted: &mut Emitted) {
        let Some(down) = &mut self.down else { return };
        if let Some(at) = moment.offset() {
            down.path = Some((down.path.map_or(at, |(from, _)| from), at));
        }
        let Gestures { long_press, swipe_m, hard, .. } = self.spec.gestures;
        if let Some(hard) = hard {
            let grown = moment.at.press / self.spec.thresholds.press;
            if !down.hard && foot.force >= hard.press * grown {
                become_other(down, EventKind::HardPressed, emitted);
                down.hard = true;
            } else if down.hard && foot.force < hard.release * grown {
                down.hard = false;
                emitted.push(EventKind::HardReleased);
            }
        }
        let still = swipe_m.is_none_or(|far| down.went() < far);
        if let Some(long) = long_press
            && !down.spent
            && still
            && moment.firm
            && moment.now.since(down.since) >= long
        {
            become_other(down, EventKind::LongPressed, emitted);
        }
    }

    fn released(&mut self, moment: &Moment, emitted: &mut Emitted) {
        let Some(down) = self.down.take() else { return };
        let Gestures { swipe_m, double_tap, .. } = self.spec.gestures;
        if let Some(far) = swipe_m
            && down.went() < far
            && down.is_off(moment.size)
        {
            self.cancelled(moment, down, emitted);
            return;
        }
        if down.hard {
            emitted.push(EventKind::HardReleased);
        }
        emitted.push(EventKind::Released);
        if down.spent || self.spec.acts_on == ActsOn::Press {
            return;
        }
        match swipe_m.and_then(|far| down.swipe(far)) {
            Some(direction) => {
                if down.second {
                    emitted.push(EventKind::Clicked);
                }
                emitted.push(EventKind::Swiped(direction));
            }
            None if down.second => emitted.push(EventKind::DoubleTapped),
            None => match double_tap {
                Some(window) => self.tapped = Some(moment.now + window),
                None => emitted.push(EventKind::Clicked),
            },
        }
    }

    fn cancelled(&mut self, moment: &Moment, down: Down, emitted: &mut Emitted) {
        emitted.push(EventKind::Cancelled);
        // The first tap was a good one; what came of it is known a little later.
        if down.second && !down.spent && !moment.broken {
            self.tapped = Some(moment.now + self.spec.gestures.double_tap.unwrap_or_default());
        }
    }
}

/// The press is no tap, nor the second of two.
fn become_other(down: &mut Down, kind: EventKind, emitted: &mut Emitted) {
    if std::mem::take(&mut down.second) {
        emitted.push(EventKind::Clicked);
    }
    down.spent = true;
    emitted.push(kind);
}

impl Down {
    fn way(&self) -> Vec2 {
        self.path.map_or(Vec2::ZERO, |(from, to)| to - from)
    }

    /// How far the foot went, in metres.
    fn went(&self) -> f32 {
        self.way().length()
    }

    fn is_off(&self, size: Vec2) -> bool {
        self.path.is_some_and(|(_, at)| (at.abs() - 0.5 * size).max_element() > MARGIN_M)
    }

    fn swipe(&self, far: f32) -> Option<Direction> {
        let way = self.way();
        (way.length() >= far).then(|| match (way.x.abs() > way.y.abs(), way.x > 0.0, way.y > 0.0) {
            (true, true, _) => Direction::East,
            (true, false, _) => Direction::West,
            (false, _, true) => Direction::North,
            (false, _, false) => Direction::South,
        })
    }
}

impl Machine for Button {
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted) {
        if moment.broken {
            self.tapped = None;
        } else if self.tapped.is_some_and(|until| moment.now > until) {
            self.tapped = None;
            emitted.push(EventKind::Clicked);
        }
        match moment.outcome {
            Some(Outcome::Pressed) => self.pressed(moment.now, emitted),
            Some(Outcome::Released) => self.released(moment, emitted),
            Some(Outcome::Cancelled) => {
                if let Some(down) = self.down.take() {
                    self.cancelled(moment, down, emitted);
                }
            }
            None => {}
        }
        if let Some(foot) = moment.foot {
            self.held(moment, foot, emitted);
        }
    }

    fn captures(&self) -> bool {
        self.spec.gestures.swipe_m.is_some()
    }

    fn is_at_rest(&self) -> bool {
        self.tapped.is_none()
    }
}
