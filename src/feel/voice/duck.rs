//! Attenuation of voices while a more important effect plays.

use crate::feel::loudspeakers::NEAREST;
use crate::feel::{MAX_SPOTS, Manner};

/// Time constants of ducking and of the recovery, in seconds (our choice: before a click's peak is over, and slow
/// enough not to be felt as one).
const DOWN_S: f32 = 0.004;
const UP_S: f32 = 0.06;

/// Maximum time for which one click ducks others, even if it rings longer.
const LONGEST_S: f32 = 0.5;

/// Attenuation of all lasting voices on each channel while a more important effect plays.
#[derive(Clone, Debug)]
pub(super) struct Ducks {
    channels: Vec<Duck>,
    /// Whether any channel is ducked.
    active: bool,
}

#[derive(Clone, Copy, Debug)]
struct Duck {
    depth: f32,
    gain: f32,
    left_s: f32,
    priority: u8,
    owner: Option<usize>,
}

const UP: Duck = Duck { depth: 1.0, gain: 1.0, left_s: 0.0, priority: 0, owner: None };

impl Ducks {
    pub(super) fn new(channels: usize) -> Self {
        Self { channels: vec![UP; channels], active: false }
    }

    pub(super) fn clear(&mut self) {
        self.channels.fill(UP);
        self.active = false;
    }

    /// Ducks other voices on `channel` for some seconds; `owner` is the voice that requests it, if any.
    pub(super) fn press(&mut self, channel: usize, manner: &Manner, seconds: f32, owner: Option<usize>) {
        let Some(duck) = self.channels.get_mut(channel).filter(|_| manner.duck_db > 0.0) else { return };
        let depth = (-0.115_129_25 * manner.duck_db.min(60.0)).exp();
        // The highest priority counts; of several such, the deepest.
        if duck.left_s <= 0.0 || (manner.priority, -depth) >= (duck.priority, -duck.depth) {
            duck.depth = depth;
            duck.priority = manner.priority;
            duck.owner = owner;
        }
        duck.left_s = duck.left_s.max(seconds.min(LONGEST_S));
        self.active = true;
    }

    /// Advances by some seconds: `gain += (target - gain) * dt / (T + dt)`, with T the time constant of the
    /// direction.
    pub(super) fn step(&mut self, seconds: f32) {
        if !self.active {
            return;
        }
        self.active = false;
        let (down, up) = (seconds / (DOWN_S + seconds), seconds / (UP_S + seconds));
        for duck in &mut self.channels {
            if duck.left_s <= 0.0 && duck.gain > 0.999 {
                *duck = UP;
                continue;
            }
            self.active = true;
            duck.left_s -= seconds;
            let (target, pull) = if duck.left_s > 0.0 { (duck.depth, down) } else { (1.0, up) };
            duck.gain += (target - duck.gain) * pull;
        }
    }

    /// The gain of voice number `voice` on `channel`.
    #[inline]
    pub(super) fn gain(&self, channel: usize, voice: usize, priority: u8) -> f32 {
        if !self.active {
            return 1.0;
        }
        match self.channels.get(channel) {
            Some(duck) if duck.owner != Some(voice) && priority <= duck.priority => duck.gain,
            _ => 1.0,
        }
    }
}

/// Maximum number of channels of a voice: those under it, and as many that it has just left.
pub(super) const MAX_REACHES: usize = 2 * (MAX_SPOTS + NEAREST);
