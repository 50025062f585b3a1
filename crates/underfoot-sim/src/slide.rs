//! Path of a foot that slides over the floor under load.

use glam::Vec2;

use underfoot::floor::Rect;
use underfoot::widget::{DialSpec, SliderTrack};

/// Radius of a drag around a dial, relative to half of the dial's shorter side: well off the hub, well inside the
/// rim.
const ROUND: f32 = 0.6;

/// Path of a foot that slides over the floor, in floor metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slide {
    /// A straight line.
    Line {
        /// Start.
        from: Vec2,
        /// End.
        to: Vec2,
    },
    /// An arc around a centre.
    Arc {
        /// Start.
        from: Vec2,
        /// Centre of the arc.
        centre: Vec2,
        /// Angle of the arc, in radians counter-clockwise; may be several turns.
        sweep: f32,
    },
}

impl Slide {
    /// Path along the track of a slider on `area`, from one share (0 to 1) of it to another.
    pub(super) fn along(track: SliderTrack, area: Rect, from: f32, to: f32) -> Self {
        let size = area.size();
        let at = |share: f32| area.min + track.place_at(share, size) * size;
        match (track, track.circle(size)) {
            (SliderTrack::Arc { from_degrees, to_degrees }, Some((centre, _))) => {
                let sweep = (to_degrees - from_degrees).to_radians() * (to - from);
                Self::Arc { from: at(from), centre: area.centre() + centre, sweep }
            }
            _ => Self::Line { from: at(from), to: at(to) },
        }
    }

    /// Path around a dial on `area`, starting at the needle's place for the share `from`; greater shares are
    /// clockwise.
    pub(super) fn round(spec: &DialSpec, area: Rect, from: f32, to: f32) -> Self {
        let turn = spec.turn_degrees.to_radians();
        let angle = std::f32::consts::FRAC_PI_2 + turn * (0.5 - from);
        let radius = ROUND * 0.5 * area.size().min_element();
        let centre = area.centre();
        Self::Arc { from: centre + Vec2::from_angle(angle) * radius, centre, sweep: turn * (from - to) }
    }

    /// Returns the position at a share (0 to 1) of the path.
    #[must_use]
    pub fn at(self, share: f32) -> Vec2 {
        match self {
            Self::Line { from, to } => from.lerp(to, share),
            Self::Arc { from, centre, sweep } => {
                centre + Vec2::from_angle(sweep * share).rotate(from - centre)
            }
        }
    }

    /// Returns the length in metres.
    #[must_use]
    pub fn length(self) -> f32 {
        match self {
            Self::Line { from, to } => from.distance(to),
            Self::Arc { from, centre, sweep } => from.distance(centre) * sweep.abs(),
        }
    }

    /// True if all numbers are finite.
    pub(super) fn is_finite(self) -> bool {
        match self {
            Self::Line { from, to } => from.is_finite() && to.is_finite(),
            Self::Arc { from, centre, sweep } => from.is_finite() && centre.is_finite() && sweep.is_finite(),
        }
    }

    /// The same path, shifted by `by` metres.
    pub(super) fn shifted(self, by: Vec2) -> Self {
        match self {
            Self::Line { from, to } => Self::Line { from: from + by, to: to + by },
            Self::Arc { from, centre, sweep } => Self::Arc { from: from + by, centre: centre + by, sweep },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{PI, TAU};

    use super::*;

    #[test]
    fn an_arc_keeps_its_distance_and_ends_where_its_sweep_says() {
        let arc = Slide::Arc { from: Vec2::new(2.0, 1.0), centre: Vec2::ONE, sweep: -PI };
        assert!((arc.length() - PI).abs() < 1e-6);
        assert!(arc.at(0.5).distance(Vec2::new(1.0, 0.0)) < 1e-6, "clockwise: by the south");
        assert!(arc.at(1.0).distance(Vec2::new(0.0, 1.0)) < 1e-6);
        for share in [0.0, 0.1, 0.7, 1.0] {
            assert!((arc.at(share).distance(Vec2::ONE) - 1.0).abs() < 1e-6);
            assert!(arc.shifted(Vec2::X).at(share).distance(arc.at(share) + Vec2::X) < 1e-6);
        }
        let twice = Slide::Arc { from: Vec2::X, centre: Vec2::ZERO, sweep: 2.0 * TAU };
        assert!(twice.at(1.0).distance(Vec2::X) < 1e-5 && (twice.length() - 2.0 * TAU).abs() < 1e-5);
    }
}
