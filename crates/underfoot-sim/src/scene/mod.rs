//! Scenes that are hard to sense, with people and objects drawn from a seed.

mod body;
mod gear;
mod standing;
mod thing;
mod turning;
mod walking;
mod working;

use std::time::Duration;

use super::foot::Load;
use super::person::MoveError;
use super::script::Script;
use underfoot::floor::Geometry;
use underfoot::units::Instant;

pub use body::RandomPerson;
use thing::SceneObject;

/// Kind of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SceneKind {
    /// A person walks onto the floor, stops, walks on and leaves.
    Walking,
    /// A person stands and shifts weight, down to 10 to 20 % on one foot, in 0.2 or 1.2 s.
    Shifting,
    /// A person jumps three times.
    Jumping,
    /// A person steps aside and back.
    SideSteps,
    /// A person turns on one heel and moves the other foot after it.
    HeelPivot,
    /// A person kneels down on one knee or both, and gets up.
    Kneeling,
    /// A person walks with a stick.
    Stick,
    /// A person pushes a trolley or an occupied wheelchair over the floor.
    Wheels,
    /// Two people come, stand face to face and leave.
    FaceToFace,
    /// Two feet land within 20 ms of each other, 12 to 40 cm apart.
    LandingTogether,
    /// A foot rests on a control and slides it 10 to 60 cm, there and back.
    Slide,
    /// A foot rests on a control and presses it three times with 50 to 250 N more.
    Press,
    /// A foot rests on a control and rocks between heel and ball.
    Rock,
    /// A foot rests on a control and turns about its heel or ball by 20 to 60 degrees, there and back.
    Turn,
    /// A person turns on the spot by small steps.
    TurnAround,
}

impl SceneKind {
    /// All kinds, in the order of tables.
    pub const ALL: [Self; 15] = [
        Self::Walking,
        Self::Shifting,
        Self::Jumping,
        Self::SideSteps,
        Self::HeelPivot,
        Self::Kneeling,
        Self::Stick,
        Self::Wheels,
        Self::FaceToFace,
        Self::LandingTogether,
        Self::Slide,
        Self::Press,
        Self::Rock,
        Self::Turn,
        Self::TurnAround,
    ];

    /// Returns the name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Walking => "walking",
            Self::Shifting => "shifting weight",
            Self::Jumping => "jumping",
            Self::SideSteps => "side steps",
            Self::HeelPivot => "heel pivot",
            Self::Kneeling => "kneeling",
            Self::Stick => "walking stick",
            Self::Wheels => "wheels",
            Self::FaceToFace => "face to face",
            Self::LandingTogether => "landing together",
            Self::Slide => "foot slides",
            Self::Press => "foot presses",
            Self::Rock => "foot rocks",
            Self::Turn => "foot turns",
            Self::TurnAround => "turning around",
        }
    }
}

/// A scene: the loads on the floor, moment by moment.
///
/// People have 20 to 140 kg, are barefoot or wear shoes, heels or boots, and roll their feet like recorded people
/// ([`super::RollingHabit`]); see [`RandomPerson`].
#[derive(Clone, Debug)]
pub struct PlayedScene {
    script: Option<Script>,
    things: Vec<SceneObject>,
    duration: Duration,
}

impl PlayedScene {
    /// Creates the scene of this kind from `seed`, around the centre of a floor.
    ///
    /// Meant for floors of at least some 1.8 m; on smaller ones some feet stand beside the floor.
    ///
    /// # Errors
    /// [`MoveError`] if a move is impossible, which no seed should cause.
    pub fn of(kind: SceneKind, seed: u64, geometry: &Geometry) -> Result<Self, MoveError> {
        let mut body = RandomPerson::of(seed);
        let bounds = geometry.bounds();
        match kind {
            SceneKind::Walking => walking::walk(&mut body, bounds).map(Self::scripted),
            SceneKind::SideSteps => walking::sidesteps(&mut body, bounds).map(Self::scripted),
            SceneKind::FaceToFace => {
                walking::face_to_face(&mut body, &mut RandomPerson::of(seed ^ 0x000f_ace5), bounds)
                    .map(Self::scripted)
            }
            SceneKind::Shifting => Ok(Self::acted(standing::shifting(&mut body, bounds))),
            SceneKind::Jumping => Ok(Self::acted(standing::jumping(&mut body, bounds))),
            SceneKind::HeelPivot => Ok(Self::acted(standing::heel_pivot(&mut body, bounds))),
            SceneKind::LandingTogether => Ok(Self::acted(standing::landing(&mut body, bounds))),
            SceneKind::Kneeling => Ok(Self::acted(standing::kneeling(&mut body, bounds))),
            SceneKind::Stick => Ok(Self::acted(gear::stick(&mut body, bounds))),
            SceneKind::Wheels => Ok(Self::acted(gear::wheels(&mut body, bounds))),
            SceneKind::Slide => Ok(Self::acted(working::slide(&mut body, bounds))),
            SceneKind::Press => Ok(Self::acted(working::press(&mut body, bounds))),
            SceneKind::Rock => Ok(Self::acted(working::rock(&mut body, bounds))),
            SceneKind::Turn => Ok(Self::acted(working::turn(&mut body, bounds))),
            SceneKind::TurnAround => Ok(Self::acted(turning::turn_around(&mut body, bounds))),
        }
    }

    /// Returns the duration of the scene.
    #[must_use]
    pub const fn duration(&self) -> Duration {
        self.duration
    }

    /// Adds the loads on the floor at a moment, always in the same order.
    pub fn loads_at(&self, at: Instant, loads: &mut Vec<Load>) {
        if let Some(script) = &self.script {
            script.loads_at(at, loads);
        }
        loads.extend(self.things.iter().filter_map(|thing| thing.load(at.secs())));
    }

    fn scripted(script: Script) -> Self {
        Self { duration: script.duration(), script: Some(script), things: Vec::new() }
    }

    fn acted(things: Vec<SceneObject>) -> Self {
        let end_s = things.iter().map(SceneObject::end_s).fold(0.0, f64::max);
        Self { script: None, things, duration: Duration::from_secs_f64(end_s + 0.3) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loads of a scene every 10 ms.
    fn frames(kind: SceneKind, seed: u64) -> Vec<Vec<Load>> {
        let scene = PlayedScene::of(kind, seed, &Geometry::default()).unwrap();
        let moments = (0..scene.duration().as_millis() as u64).step_by(10);
        let frame = |ms| {
            let mut loads = Vec::new();
            scene.loads_at(Instant::from_millis(ms), &mut loads);
            loads.retain(|load| load.force.0 > 10.0);
            loads
        };
        moments.map(frame).collect()
    }

    #[test]
    fn every_scene_can_be_played_by_anybody_and_follows_from_its_seed() {
        for kind in SceneKind::ALL {
            for seed in 0..40 {
                let scene = frames(kind, seed);
                let seconds = scene.len() as f32 / 100.0;
                assert!((2.0..40.0).contains(&seconds), "{kind:?} {seed} takes {seconds} s");
                assert!(scene.last().unwrap().is_empty(), "{kind:?} {seed} ends with somebody on the floor");
                let bounds = Geometry::default().bounds();
                let on_floor = |load: &&Load| bounds.contains(load.centre_of_pressure());
                let down = scene.iter().filter(|frame| frame.iter().any(|load| on_floor(&load))).count();
                assert!(down > 50, "{kind:?} {seed}: {down} frames with somebody on the floor");
                for load in scene.iter().flatten() {
                    assert!(load.position.is_finite() && load.force.0 < 6000.0, "{kind:?} {seed}: {load:?}");
                }
            }
            assert_eq!(frames(kind, 3), frames(kind, 3));
            assert_ne!(frames(kind, 3), frames(kind, 4));
        }
    }

    #[test]
    fn scenes_hold_as_many_things_as_their_names_say() {
        let most = |kind| {
            (0..20).map(|seed| frames(kind, seed).iter().map(Vec::len).max().unwrap()).collect::<Vec<_>>()
        };
        for (kind, expected) in [
            (SceneKind::Walking, 2..=2),
            (SceneKind::Shifting, 2..=2),
            (SceneKind::HeelPivot, 2..=2),
            (SceneKind::Kneeling, 3..=4),
            (SceneKind::Stick, 3..=3),
            (SceneKind::Wheels, 6..=6),
            (SceneKind::FaceToFace, 4..=4),
            (SceneKind::LandingTogether, 2..=2),
            (SceneKind::Rock, 1..=2),
            (SceneKind::TurnAround, 2..=2),
        ] {
            let found = most(kind);
            assert!(found.iter().all(|count| expected.contains(count)), "{kind:?}: {found:?}");
        }
    }

    #[test]
    fn things_move_without_jumps_while_they_press() {
        for kind in SceneKind::ALL {
            for seed in 0..10 {
                let scene = PlayedScene::of(kind, seed, &Geometry::default()).unwrap();
                let mut before: Vec<Load> = Vec::new();
                for ms in 0..scene.duration().as_millis() as u64 {
                    let mut loads = Vec::new();
                    scene.loads_at(Instant::from_millis(ms), &mut loads);
                    for load in loads.iter().filter(|load| load.force.0 > 60.0) {
                        // Its own position a millisecond before.
                        let near = before
                            .iter()
                            .filter(|other| other.position.distance(load.position) < 0.01)
                            .map(|other| other.centre_of_pressure().distance(load.centre_of_pressure()))
                            .fold(f32::INFINITY, f32::min);
                        assert!(near < 0.01 || near.is_infinite(), "{kind:?} {seed} at {ms} ms: {near} m");
                    }
                    before = loads;
                }
            }
        }
    }
}
