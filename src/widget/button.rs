//! A push button, with the gestures of its kind.
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

use super::moment::{BehaviourInput, BehaviourMachine, FootOnControl};
use super::press::PressOutcome;
use super::stage::Stage;
use super::{Direction, Emitted, EventKind, Guard, Thresholds};
use crate::units::{Instant, Newtons};
use underfoot_format::number::plain;
use underfoot_format::{Faults, Flat, Name, Named, Opt, num, record};

record! {
    /// A push button: `Pressed`, then `Released` and `Clicked`, or `Cancelled`.
    pub struct ButtonSpec = "Button", Copy => ButtonSpec::rules;
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// The moment of its click.
    pub acts_on: ActsOn = "acts_on", Name => ActsOn::Release;
    /// Its further gestures.
    pub gestures: Gestures = "", Flat;
}

impl ButtonSpec {
    /// Reports settings that contradict each other.
    fn rules(&mut self, faults: &mut Faults) {
        let Gestures { double_tap, long_press, swipe_m, hard } = self.gestures;
        if let Some(HardStage { press, release }) = hard {
            let light = self.thresholds.press;
            if release >= press || release <= light {
                let shown = |force: Newtons| plain(force.0.into());
                let (light, release, hard) = (shown(light), shown(release), shown(press));
                faults.error(
                    &["hard_release_n", "hard_n", "press_n"],
                    "the second stage must end between `press_n` and its own beginning",
                    format!("press_n is {light} N, hard_release_n {release} N, hard_n {hard} N"),
                );
            }
        }
        let waits: [(&'static [&'static str], bool); 3] = [
            (&["double_tap_ms", "acts_on"], double_tap.is_some()),
            (&["long_press_ms", "acts_on"], long_press.is_some()),
            (&["swipe_m", "acts_on"], swipe_m.is_some()),
        ];
        for (fields, _) in waits.into_iter().filter(|(_, given)| *given && self.acts_on == ActsOn::Press) {
            let message = format!("a button that acts on press cannot wait for `{}`", fields[0]);
            faults.error(fields, message, "what it is shows later");
            faults.help("write acts_on: Release, or leave the gesture out");
        }
        if double_tap.is_some() && matches!(self.thresholds.guard, Guard::Confirm(_)) {
            let message = "a guard that confirms takes two presses already";
            faults.error(&["double_tap_ms", "guard"], message, "a double tap can't be told from them");
        }
    }

    /// A button that clicks on release, without gestures.
    #[must_use]
    pub const fn new(thresholds: Thresholds) -> Self {
        let gestures = Gestures { double_tap: None, long_press: None, swipe_m: None, hard: None };
        Self { thresholds, acts_on: ActsOn::Release, gestures }
    }
}

/// The moment at which a button clicks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ActsOn {
    /// At the press: for minimum latency, where an accidental press does no harm.
    Press,
    /// At the release of a foot on it: sliding off cancels the press.
    #[default]
    Release,
}

impl Named for ActsOn {
    const ALL: &'static [(&'static str, Self)] = &[("Press", Self::Press), ("Release", Self::Release)];
}

record! {
    /// The gestures of a button besides a tap; none by default.
    pub struct Gestures = "Gestures", Copy, Default;
    /// Maximum time from a tap to the second press of a double tap.
    pub double_tap: Option<Duration> = "double_tap_ms", Opt(num(100.0..=1000.0).milli()) => None;
    /// Minimum duration of a long press.
    pub long_press: Option<Duration> = "long_press_ms", Opt(num(200.0..=5000.0).milli()) => None;
    /// Minimum distance of a swipe, in metres.
    pub swipe_m: Option<f32> = "swipe_m", Opt(num(0.02..=1.0)) => None;
    /// The second stage: force above which a press is hard.
    pub hard: Option<HardStage> = "hard_n", HARD => None;
}

impl Gestures {
    /// Whether a press that lasts means something else than a tap.
    pub(crate) const fn lasts(&self) -> bool {
        self.long_press.is_some()
    }
}

const HARD: Stage = Stage {
    press: num(10.0..=2000.0),
    release: num(1.0..=2000.0),
    names: ["hard_n", "hard_release_n"],
    about: "Force below which it is hard no longer; less than `hard_n`, more than `press_n`.",
    follows: 0.75,
    lonely: "a second stage needs both",
};

/// The second stage of a press. It is scaled with the first where that is a share of the person's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardStage {
    /// Force above which the press is hard; more than the press threshold.
    pub press: Newtons,
    /// Force below which it is no longer hard; less than `press`.
    pub release: Newtons,
}

impl From<[f32; 2]> for HardStage {
    fn from([press, release]: [f32; 2]) -> Self {
        Self { press: Newtons(press), release: Newtons(release) }
    }
}

impl From<HardStage> for [f32; 2] {
    fn from(stage: HardStage) -> Self {
        [stage.press.0, stage.release.0]
    }
}

/// Distance beyond its edge at which a button that captures its foot still counts the foot as on it, in metres (the
/// same allowance for sway as on other controls).
const MARGIN_M: f32 = 0.03;

/// The state of a push button.
#[derive(Clone, Debug)]
pub(super) struct Button {
    spec: ButtonSpec,
    down: Option<Down>,
    /// Time at which a first tap becomes a click, if no second press comes.
    tapped: Option<Instant>,
}

/// A press under way.
#[derive(Clone, Copy, Debug)]
struct Down {
    since: Instant,
    /// First and last place of the foot, in metres from the button's middle.
    path: Option<(Vec2, Vec2)>,
    /// Whether a first tap came just before.
    second: bool,
    hard: bool,
    /// Whether it was long or hard already: its release is not a click.
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

    fn held(&mut self, moment: &BehaviourInput, foot: FootOnControl, emitted: &mut Emitted) {
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

    fn released(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
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

    fn cancelled(&mut self, moment: &BehaviourInput, down: Down, emitted: &mut Emitted) {
        emitted.push(EventKind::Cancelled);
        // The first tap was valid; a second one decides its meaning a little later.
        if down.second && !down.spent && !moment.broken {
            self.tapped = Some(moment.now + self.spec.gestures.double_tap.unwrap_or_default());
        }
    }
}

/// Turns the press into something other than a tap or the second of two.
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

    /// Distance of the foot's motion, in metres.
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

impl BehaviourMachine for Button {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        if moment.broken {
            self.tapped = None;
        } else if self.tapped.is_some_and(|until| moment.now > until) {
            self.tapped = None;
            emitted.push(EventKind::Clicked);
        }
        match moment.outcome {
            Some(PressOutcome::Pressed) => self.pressed(moment.now, emitted),
            Some(PressOutcome::Released) => self.released(moment, emitted),
            Some(PressOutcome::Cancelled) => {
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
