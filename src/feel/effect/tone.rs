//! A tone or a band of noise under an envelope.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use super::click::{HZ, LEVEL, SHARE};
use crate::units::Newtons;
use underfoot_format::{Faults, Num, Opt, Rec, list, num, record};

/// Maximum number of points of a curve; the same as in an AHAP parameter curve.
pub const MAX_POINTS: usize = 16;

/// Range of times in one effect, in milliseconds in files.
pub(super) const TIME: Num = num(0.0..=60_000.0).milli();

/// Range of the factors of a curve.
pub(super) const STRENGTH: Num = num(0.0..=4.0);

record! {
    /// A tone or a band of noise of limited length.
    ///
    /// Its level rises to full in `attack_s`, falls to `sustain` in `decay_s`, stays there until `length_s`, and
    /// reaches zero `release_s` later; the curve multiplies all of it and sets the pitch.
    pub struct Tone = "Continuous", Default, Serialize, Deserialize => Tone::rules;
    /// Force at the plate of its tone; a noise is as strong as a tone of this amplitude.
    pub level: Newtons = "level_n", LEVEL;
    /// Its pitch, or the centre of its noise, where the curve sets none, in hertz; 20 to 1000.
    pub hz: f32 = "hz", HZ;
    /// From a pure tone (0) to a band of noise (1).
    pub noise: f32 = "noise", SHARE => 0.0;
    /// Time until the release begins, in seconds.
    pub length_s: f32 = "length_ms", num(1.0..=60_000.0).hand(1.0..=5000.0).milli();
    /// Duration of the attack, in seconds.
    pub attack_s: f32 = "attack_ms", TIME.hand(0.0..=1000.0) => 0.005;
    /// Duration of the decay to `sustain`, in seconds.
    pub decay_s: f32 = "decay_ms", TIME.hand(0.0..=1000.0) => 0.0;
    /// Level after the decay, 0 to 1.
    pub sustain: f32 = "sustain", SHARE => 1.0;
    /// Duration of the release after `length_s`, in seconds.
    pub release_s: f32 = "release_ms", TIME.hand(0.0..=1000.0) => 0.02;
    /// Level and pitch over time, in order of time; the first point's values hold before it, the last point's after
    /// it.
    pub curve: ArrayVec<TonePoint, MAX_POINTS> = "curve", list("point", MAX_POINTS, Rec).still() => ArrayVec::new();
}

record! {
    /// Level and pitch of a tone at one moment.
    pub struct TonePoint = "Point", Copy, Default, Serialize, Deserialize;
    /// Time since the tone's start, in seconds.
    pub at_s: f32 = "at_ms", TIME;
    /// Share of the tone's level.
    pub level: f32 = "level", STRENGTH => 1.0;
    /// Pitch in hertz; the tone's if absent.
    pub hz: Option<f32> = "hz", Opt(HZ) => None;
}

/// Reports points of a curve that are not in order of time.
pub(super) fn check_order(times: impl Iterator<Item = f32> + Clone, faults: &mut Faults) {
    if !times.clone().zip(times.skip(1)).all(|(a, b)| a < b) {
        let expected = "each `at_ms` must be later than the one before";
        faults.error(&["curve"], "a curve's points go forwards in time", expected);
    }
}

impl Tone {
    fn rules(&mut self, faults: &mut Faults) {
        check_order(self.curve.iter().map(|point| point.at_s), faults);
    }

    /// Level factor and pitch `t` seconds after the start; the level is zero before the start and after the end.
    ///
    /// # Real-time
    /// A few comparisons and divisions.
    #[must_use]
    pub fn at(&self, t: f32) -> (f32, f32) {
        let release = if t <= self.length_s {
            1.0
        } else {
            (1.0 - (t - self.length_s) / self.release_s.max(1e-6)).max(0.0)
        };
        let (level, hz) = self.held_at(t);
        (level * release, hz)
    }

    /// As [`Tone::at`] for a held tone: without the release.
    #[must_use]
    pub(crate) fn held_at(&self, t: f32) -> (f32, f32) {
        let (curve, hz) = self.curve_at(t);
        let envelope = if t < 0.0 || t.is_nan() {
            0.0
        } else if t < self.attack_s {
            t / self.attack_s
        } else if t < self.attack_s + self.decay_s {
            1.0 - (1.0 - self.sustain) * (t - self.attack_s) / self.decay_s
        } else if self.decay_s > 0.0 {
            self.sustain
        } else {
            1.0
        };
        (envelope * curve, hz)
    }

    /// Time from the start to silence, in seconds.
    #[must_use]
    pub fn whole_s(&self) -> f32 {
        self.length_s + self.release_s
    }

    fn curve_at(&self, t: f32) -> (f32, f32) {
        let after = self.curve.iter().position(|point| point.at_s > t).unwrap_or(self.curve.len());
        let before = after.checked_sub(1).and_then(|before| self.curve.get(before));
        match (before, self.curve.get(after)) {
            (None, None) => (1.0, self.hz),
            (Some(point), None) | (None, Some(point)) => (point.level, self.hz_at(point)),
            (Some(a), Some(b)) => {
                let share = (t - a.at_s) / (b.at_s - a.at_s).max(1e-6);
                let (a_hz, b_hz) = (self.hz_at(a), self.hz_at(b));
                (a.level + (b.level - a.level) * share, a_hz + (b_hz - a_hz) * share)
            }
        }
    }

    /// Pitch at one of the points of its curve, in hertz.
    pub(crate) fn hz_at(&self, point: &TonePoint) -> f32 {
        point.hz.unwrap_or(self.hz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone() -> Tone {
        Tone {
            level: Newtons(4.0),
            hz: 100.0,
            length_s: 1.0,
            attack_s: 0.1,
            decay_s: 0.2,
            sustain: 0.5,
            release_s: 0.4,
            ..Tone::default()
        }
    }

    #[test]
    fn the_envelope_comes_falls_stays_and_goes() {
        let tone = tone();
        for (t, level) in [
            (-0.1, 0.0),
            (0.05, 0.5),
            (0.1, 1.0),
            (0.2, 0.75),
            (0.3, 0.5),
            (1.0, 0.5),
            (1.2, 0.25),
            (1.4, 0.0),
            (9.0, 0.0),
        ] {
            assert!((tone.at(t).0 - level).abs() < 1e-5, "{t} s: {:?}", tone.at(t));
        }
        assert_eq!(tone.held_at(9.0).0, 0.5);
        assert_eq!(tone.at(f32::NAN).0, 0.0);
    }

    #[test]
    fn the_curve_is_straight_between_its_points_and_even_beyond_them() {
        let point = |at_s, level, hz| TonePoint { at_s, level, hz: Some(hz) };
        let curve = [point(0.2, 0.0, 80.0), point(0.6, 1.0, 160.0)].into_iter().collect();
        let tone = Tone { attack_s: 0.0, decay_s: 0.0, curve, ..tone() };
        assert_eq!(tone.at(0.1), (0.0, 80.0));
        let (level, hz) = tone.at(0.3);
        assert!((level - 0.25).abs() < 1e-5 && (hz - 100.0).abs() < 1e-3);
        assert_eq!(tone.at(0.9), (1.0, 160.0));
    }
}
