//! Motion of one foot over a whole performance: pose, load and roll.

use std::f32::consts::{PI, TAU};

use glam::Vec2;

use super::curve::Curve;
use super::rolling::Rolling;
use super::slide::Slide;

/// Position of a shoe, and direction of its toes (radians counter-clockwise from north).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pose {
    pub(super) position: Vec2,
    pub(super) heading: f32,
}

impl Pose {
    /// Interpolates a share (0 to 1) from `self` to `other`, turning the shorter way.
    fn towards(self, other: Self, share: f32) -> Self {
        Self {
            position: self.position.lerp(other.position, share),
            heading: self.heading + turn_between(self.heading, other.heading) * share,
        }
    }
}

/// The turn from one heading to another, from minus half a turn to half a turn.
pub(super) fn turn_between(from: f32, to: f32) -> f32 {
    (to - from + PI).rem_euclid(TAU) - PI
}

/// Unit vector in the direction of a heading.
pub(super) fn forward(heading: f32) -> Vec2 {
    Vec2::from_angle(heading).rotate(Vec2::Y)
}

/// Path of a move from its start to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Path {
    Straight,
    /// Around a centre by `sweep` radians counter-clockwise, with constant heading.
    Round {
        centre: Vec2,
        sweep: f32,
    },
}

/// Time profile of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Profile {
    /// Minimum jerk, as a limb swings: slow, fast, slow.
    Swing,
    /// Constant speed, with a ramp of `ramp_s` seconds at both ends.
    Steady { ramp_s: f32 },
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Move {
    start_s: f64,
    end_s: f64,
    from: Pose,
    to: Pose,
    path: Path,
    profile: Profile,
}

/// Track of one foot in a performance.
#[derive(Clone, Debug, Default)]
pub(super) struct FootTrack {
    /// Force on the floor, in body weights.
    pub(super) load: Curve,
    /// From the heel (0) to the toes (1).
    pub(super) roll: Curve,
    /// Blend of the pressure: as in the current step (1) or as in standing (0).
    pub(super) stepping: Curve,
    /// Steps by their start times; empty for a foot with the even roll.
    pub(super) steps: Vec<(f64, Rolling)>,
    moves: Vec<Move>,
}

impl FootTrack {
    /// Places the foot at once.
    pub(super) fn put(&mut self, at_s: f64, pose: Pose) {
        let (path, profile) = (Path::Straight, Profile::Swing);
        self.moves.push(Move { start_s: at_s, end_s: at_s, from: pose, to: pose, path, profile });
    }

    /// Moves the foot from its last pose; moves must be in order and must not overlap.
    pub(super) fn go(&mut self, start_s: f64, end_s: f64, to: Pose, profile: Profile) {
        let from = self.moves.last().map_or(to, |last| last.to);
        self.moves.push(Move { start_s, end_s, from, to, path: Path::Straight, profile });
    }

    /// Slides the foot from its last pose along `way`, which starts there, with constant heading.
    pub(super) fn slide(&mut self, start_s: f64, end_s: f64, way: Slide, profile: Profile) {
        let from = self.moves.last().map_or(Pose::default(), |last| last.to);
        let to = Pose { position: way.at(1.0), ..from };
        let path = match way {
            Slide::Line { .. } => Path::Straight,
            Slide::Arc { centre, sweep, .. } => Path::Round { centre, sweep },
        };
        self.moves.push(Move { start_s, end_s, from, to, path, profile });
    }

    /// Returns the current or the last step.
    pub(super) fn step(&self, at_s: f64) -> Option<&Rolling> {
        let begun = self.steps.partition_point(|(start_s, _)| *start_s <= at_s);
        begun.checked_sub(1).and_then(|last| self.steps.get(last)).map(|(_, step)| step)
    }

    /// Returns the pose; `None` before the foot is first placed.
    pub(super) fn pose(&self, at_s: f64) -> Option<Pose> {
        let begun = self.moves.partition_point(|step| step.start_s <= at_s);
        begun.checked_sub(1).and_then(|last| self.moves.get(last)).map(|step| step.at(at_s))
    }
}

impl Move {
    fn at(&self, at_s: f64) -> Pose {
        if at_s >= self.end_s {
            return self.to;
        }
        let span = (self.end_s - self.start_s) as f32;
        let past = (at_s - self.start_s) as f32;
        let share = match self.profile {
            Profile::Swing => {
                let t = past / span;
                t * t * t * (10.0 + t * (6.0 * t - 15.0))
            }
            Profile::Steady { ramp_s } => {
                let ramp = ramp_s.clamp(1e-3, 0.5 * span);
                let speed = 1.0 / (span - ramp);
                if past < ramp {
                    0.5 * speed * past * past / ramp
                } else if past > span - ramp {
                    1.0 - 0.5 * speed * (span - past) * (span - past) / ramp
                } else {
                    speed * (past - 0.5 * ramp)
                }
            }
        };
        match self.path {
            Path::Straight => self.from.towards(self.to, share),
            Path::Round { centre, sweep } => {
                let spoke = self.from.position - centre;
                Pose { position: centre + Vec2::from_angle(sweep * share).rotate(spoke), ..self.from }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_profiles_arrive_without_jumps() {
        for profile in [Profile::Swing, Profile::Steady { ramp_s: 0.1 }] {
            let mut track = FootTrack::default();
            track.put(1.0, Pose::default());
            track.go(2.0, 3.0, Pose { position: Vec2::X, heading: 1.0 }, profile);
            assert_eq!(track.pose(0.5), None);
            assert_eq!(track.pose(1.5), Some(Pose::default()));
            assert_eq!(track.pose(3.0).unwrap().position, Vec2::X);
            let places: Vec<f32> =
                (0..=1000).map(|ms| track.pose(2.0 + f64::from(ms) * 1e-3).unwrap().position.x).collect();
            let steepest = places.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f32::max);
            assert!(
                places.windows(2).all(|pair| pair[1] >= pair[0] - 1e-6) && steepest < 0.002,
                "{profile:?}: {steepest}"
            );
            assert!((places[500] - 0.5).abs() < 1e-3, "{profile:?}");
        }
    }

    #[test]
    fn feet_turn_the_shorter_way() {
        assert!((turn_between(3.0, -3.0) - (TAU - 6.0)).abs() < 1e-5);
        assert!((turn_between(0.0, -0.5) + 0.5).abs() < 1e-6);
        assert!(forward(0.0).distance(Vec2::Y) < 1e-6);
        assert!(forward(PI / 2.0).distance(Vec2::NEG_X) < 1e-6);
    }
}
