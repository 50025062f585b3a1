//! Amplifiers and coils.

use glam::Vec2;

use crate::units::Newtons;
use underfoot_format::{num, record};

record! {
    /// The amplifiers behind a floor's actuators and the coils they drive, all alike.
    pub struct Drive = "Drive", Copy;
    /// Voltage at an amplifier's output for a full-scale sample, in volts; positive.
    pub full_scale_v: f32 = "full_scale_v", num(0.01..=1000.0).explicit() => Drive::default().full_scale_v;
    /// Resistance of an actuator's coil, in ohms; positive.
    pub load_ohm: f32 = "load_ohm", num(0.1..=1000.0).explicit() => Drive::default().load_ohm;
    /// Continuous power rating of a coil, in watts; positive.
    pub long_term_w: f32 = "long_term_w", num(0.01..=10_000.0).explicit() => Drive::default().long_term_w;
}

impl Drive {
    /// Returns the power of a constant full-scale sample, in watts; a full-scale sine has half of it.
    #[must_use]
    pub fn full_scale_w(&self) -> f32 {
        self.full_scale_v * self.full_scale_v / self.load_ohm
    }
}

impl Default for Drive {
    /// The paper's actuators, 80 W into 4 ohms, with amplifiers that can deliver about twice as much to a sine (36 V;
    /// our choice).
    fn default() -> Self {
        Self { full_scale_v: 36.0, load_ohm: 4.0, long_term_w: 80.0 }
    }
}

/// Measured frequency response of an actuator: force at the plate by frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Hertz and decibels, by frequency.
    points: Vec<(f32, f32)>,
}

impl Response {
    /// Maximum number of points of one response.
    pub const MOST_POINTS: usize = 1024;

    /// A response from `points`: hertz, and decibels relative to the actuator's full scale.
    ///
    /// `None` unless there are 2 to 1024 points with positive, rising frequencies, and all numbers are finite.
    #[must_use]
    pub fn of(points: Vec<(f32, f32)>) -> Option<Self> {
        let good = (2..=Self::MOST_POINTS).contains(&points.len())
            && points.iter().all(|(hz, db)| *hz > 0.0 && hz.is_finite() && db.is_finite())
            && points.is_sorted_by(|a, b| a.0 < b.0);
        good.then_some(Self { points })
    }

    /// A response from `points` of hertz and newtons for a full-scale sine, for an actuator with nominal force
    /// `full_scale`: `20 log10(newtons / full_scale)` decibels.
    ///
    /// `None` as for [`Response::of`], or if any force is not positive.
    #[must_use]
    pub(crate) fn of_newtons(points: &[(f32, f32)], full_scale: Newtons) -> Option<Self> {
        if points.iter().any(|(_, newtons)| newtons.is_nan() || *newtons <= 0.0) {
            return None;
        }
        Self::of(points.iter().map(|(hz, newtons)| (*hz, 20.0 * (newtons / full_scale.0).log10())).collect())
    }

    /// Returns the measured points: hertz and decibels, by frequency.
    #[must_use]
    pub fn points(&self) -> &[(f32, f32)] {
        &self.points
    }

    /// Returns the gain at `hz`, in decibels: linear between the points over the logarithm of the frequency, constant
    /// outside of them.
    #[must_use]
    pub fn gain_db(&self, hz: f64) -> f64 {
        let above = self.points.partition_point(|(known, _)| f64::from(*known) < hz);
        let at = |index: usize| self.points.get(index).map(|(hz, db)| (f64::from(*hz), f64::from(*db)));
        match (above.checked_sub(1).and_then(at), at(above)) {
            (Some((low, a)), Some((high, b))) => a + (b - a) * (hz / low).ln() / (high / low).ln(),
            (Some((_, db)), None) | (None, Some((_, db))) => db,
            (None, None) => 0.0,
        }
    }
}

/// A loudspeaker beside the floor, which plays the cues of layouts with sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loudspeaker {
    /// Its place, in floor metres; may be outside of the floor.
    pub at: Vec2,
    /// Output channel of the audio device, from 0.
    pub channel: u16,
    /// Its gain, in decibels: at 0, a cue of 40 N with sound 1 is a full-scale sample.
    pub gain_db: f32,
}

impl Loudspeaker {
    /// Maximum number of loudspeakers of one floor.
    pub(crate) const MOST: usize = 8;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_response_is_read_between_its_points_and_held_beyond() {
        let response = Response::of(vec![(50.0, -6.0), (200.0, 2.0)]).unwrap();
        let read = [20.0, 50.0, 100.0, 200.0, 900.0].map(|hz| response.gain_db(hz));
        assert_eq!(read.map(|db| (db * 1e6).round() / 1e6), [-6.0, -6.0, -2.0, 2.0, 2.0]);
        let in_newtons = Response::of_newtons(&[(50.0, 20.0), (200.0, 80.0)], Newtons(40.0)).unwrap();
        assert!((in_newtons.gain_db(50.0) + 6.02).abs() < 0.01);
    }

    #[test]
    fn what_is_no_response_is_refused() {
        for points in
            [vec![], vec![(50.0, 0.0)], vec![(50.0, 0.0), (50.0, 1.0)], vec![(0.0, 0.0), (9.0, 0.0)]]
        {
            assert_eq!(Response::of(points), None);
        }
        assert_eq!(Response::of(vec![(50.0, f32::NAN), (60.0, 0.0)]), None);
        assert_eq!(Response::of_newtons(&[(50.0, 0.0), (60.0, 1.0)], Newtons(40.0)), None);
    }

    #[test]
    fn the_papers_coil_takes_half_of_what_its_amplifier_could_give() {
        assert_eq!(Drive::default().full_scale_w() / 2.0, 162.0);
    }
}
