//! Amplifiers and coils.

use glam::Vec2;

use crate::format::{num, record};
use crate::units::Newtons;

record! {
    /// The amplifiers behind a floor's actuators and the coils they drive, all alike.
    pub struct Drive = "Drive", Copy;
    /// Voltage at an amplifier's output for a full-scale sample, in volts; positive.
    pub full_scale_v: f32 = "full_scale_v", num(0.01..=1000.0).explicit() => Drive::default().full_scale_v;
    /// Resistance of an actuator's coil, in ohms; positive.
    pub load_ohm: f32 = "load_ohm", num(0.1..=1000.0).explicit() => Drive::default().load_ohm;
    /// Power that a coil takes for ever, in watts; positive.
    pub long_term_w: f32 = "long_term_w", num(0.01..=10_000.0).explicit() => Drive::default().long_term_w;
}

impl Drive {
    /// Power of a steady full-scale sample, in watts; a full-scale sine has half of it.
    #[must_use]
    pub fn full_scale_w(&self) -> f32 {
        self.full_scale_v * self.full_scale_v / self.load_ohm
    }
}

impl Default for Drive {
    /// The paper's actuators, 80 W into 4 ohms, behind amplifiers that could give twice as much (36 V; our choice).
    fn default() -> Self {
        Self { full_scale_v: 36.0, load_ohm: 4.0, long_term_w: 80.0 }
    }
}

/// How strongly an actuator moves its plate at each frequency, as it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Hertz and decibels, by frequency.
    points: Vec<(f32, f32)>,
}

impl Response {
    /// Most points that one response has.
    pub const MOST_POINTS: usize = 1024;

    /// A response from `points`: hertz, and decibels relative to the actuator's full scale.
    ///
    /// `None` unless there are 2 to 1024 points, the hertz are positive and rise, and everything is finite.
    #[must_use]
    pub fn of(points: Vec<(f32, f32)>) -> Option<Self> {
        let good = (2..=Self::MOST_POINTS).contains(&points.len())
            && points.iter().all(|(hz, db)| *hz > 0.0 && hz.is_finite() && db.is_finite())
            && points.is_sorted_by(|a, b| a.0 < b.0);
        good.then_some(Self { points })
    }

    /// A response from `points` of hertz and newtons for a full-scale sine, of an actuator that is meant to give
    /// `full_scale`.
    ///
    /// `None` as for [`Response::of`], or if any force is not positive.
    #[must_use]
    pub(crate) fn of_newtons(points: &[(f32, f32)], full_scale: Newtons) -> Option<Self> {
        if points.iter().any(|(_, newtons)| newtons.is_nan() || *newtons <= 0.0) {
            return None;
        }
        Self::of(points.iter().map(|(hz, newtons)| (*hz, 20.0 * (newtons / full_scale.0).log10())).collect())
    }

    /// The measured points: hertz and decibels, by frequency.
    #[must_use]
    pub fn points(&self) -> &[(f32, f32)] {
        &self.points
    }

    /// The gain at `hz`, in decibels: straight lines between the points over the logarithm of the
    /// frequency, and the outermost points beyond them.
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

/// A loudspeaker beside the floor, which plays the cues of layouts that want to be heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loudspeaker {
    /// Where it stands, in floor metres; also outside of the floor.
    pub at: Vec2,
    /// Output channel of the audio device, from 0.
    pub channel: u16,
    /// How loud it is, in decibels: at 0, a cue of 40 N that is heard in full is a full-scale sample.
    pub gain_db: f32,
}

impl Loudspeaker {
    /// Most loudspeakers of one floor.
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
