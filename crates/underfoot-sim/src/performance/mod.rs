//! Performance of one person, composed of moves.

mod walking;

use std::time::Duration;

use glam::Vec2;

use super::person::{MoveError, PRESS_ROLL, Person, TwoFootStance};
use super::rolling::RollingHabit;
use super::slide::Slide;
use super::sway::Sway;
use super::track::{FootTrack, Pose, Profile, turn_between};
use super::way::bend;
use underfoot::units::Newtons;

/// A person's performance, composed of moves; each move begins when the one before ends.
#[derive(Clone, Debug)]
pub struct Performance {
    pub(super) person: Person,
    pub(super) tracks: [FootTrack; 2],
    pub(super) sway: Sway,
    /// The person's rolling pattern; `None` for the even roll of [`super::Print::Shoe`].
    pub(super) habit: Option<RollingHabit>,
    now_s: f64,
    standing: Option<TwoFootStance>,
}

/// Roll of a standing foot: a little more than half of the load is on the heel.
const STAND_ROLL: f32 = 0.4;

/// Time to shift the weight onto one foot, and back (s).
const SHIFT_S: f64 = 0.35;

/// Minimum length of a walk (m).
const SHORTEST_WAY_M: f32 = 0.02;

/// Maximum bend that a person walks round without stopping (rad).
const EASY_BEND: f32 = 0.8;

/// Maximum turn with one pair of steps on the spot (rad).
const TURN_STEP: f32 = 0.9;

impl Performance {
    /// A performance of a person outside the floor; `seed` determines the sway.
    #[must_use]
    pub fn new(person: Person, seed: u64) -> Self {
        Self {
            person,
            tracks: [FootTrack::default(), FootTrack::default()],
            sway: Sway::new(seed),
            habit: None,
            now_s: 0.0,
            standing: None,
        }
    }

    /// Makes the person's feet roll, press and stay down like those of recorded people ([`RollingHabit`]), and sets
    /// the toe-out angle accordingly. Call it before the person appears.
    ///
    /// The moves stay the same; [`super::Script::loads_at`] returns the prints.
    #[must_use]
    pub fn rolling_as_people_do(mut self, seed: u64) -> Self {
        let habit = RollingHabit::new(seed);
        self.person.toe_out = habit.turn_out();
        self.habit = Some(habit);
        self
    }

    /// Returns the duration of the performance so far.
    #[must_use]
    pub fn duration(&self) -> Duration {
        Duration::from_secs_f64(self.now_s.max(0.0))
    }

    /// Returns the place between the person's feet, in floor metres; `None` while the person is off the floor.
    #[must_use]
    pub fn place(&self) -> Option<Vec2> {
        self.standing.map(|standing| standing.middle)
    }

    /// Waits; a person on the floor stands and sways a little.
    pub fn wait(&mut self, time: Duration) {
        self.now_s += time.as_secs_f64();
    }

    /// Appears, standing at `middle` and facing `facing` (radians counter-clockwise from north).
    ///
    /// # Errors
    /// [`MoveError::AlreadyThere`], [`MoveError::NotFinite`].
    pub fn appear(&mut self, middle: Vec2, facing: f32) -> Result<(), MoveError> {
        must_be_finite(middle.is_finite() && facing.is_finite())?;
        if self.standing.is_some() {
            return Err(MoveError::AlreadyThere);
        }
        let standing = self.person.standing(middle, facing);
        for (track, pose) in self.tracks.iter_mut().zip(standing.feet) {
            track.put(self.now_s, pose);
            track.load.rest(self.now_s, 0.0);
            track.load.rest(self.now_s, 0.5);
            track.roll.rest(self.now_s, STAND_ROLL);
        }
        self.sway.strength.rest(self.now_s, 1.0);
        self.standing = Some(standing);
        Ok(())
    }

    /// Disappears at once, for a person outside the floor.
    ///
    /// # Errors
    /// [`MoveError::NotThere`].
    pub fn disappear(&mut self) -> Result<(), MoveError> {
        self.standing.take().ok_or(MoveError::NotThere)?;
        for track in &mut self.tracks {
            track.load.hold(self.now_s);
            track.load.rest(self.now_s, 0.0);
        }
        Ok(())
    }

    /// Walks in straight lines through `points` and stops at the last with the feet side by side.
    ///
    /// Turns on the spot at sharp bends. Ignores walks of less than 2 cm.
    ///
    /// # Errors
    /// [`MoveError::NotThere`], [`MoveError::NotFinite`].
    pub fn walk(&mut self, points: &[Vec2]) -> Result<(), MoveError> {
        must_be_finite(points.iter().all(|point| point.is_finite()))?;
        let mut stretch = vec![self.standing.ok_or(MoveError::NotThere)?.middle];
        for &point in points {
            match stretch[..] {
                [.., last] if last.distance(point) < SHORTEST_WAY_M => continue,
                [.., before, last] if bend(before, last, point) > EASY_BEND => {
                    self.walk_stretch(&stretch)?;
                    stretch = vec![last];
                }
                _ => {}
            }
            stretch.push(point);
        }
        self.walk_stretch(&stretch)
    }

    /// Turns on the spot to face `facing`, by small steps.
    ///
    /// # Errors
    /// [`MoveError::NotThere`], [`MoveError::NotFinite`].
    pub fn turn(&mut self, facing: f32) -> Result<(), MoveError> {
        must_be_finite(facing.is_finite())?;
        let standing = self.standing.ok_or(MoveError::NotThere)?;
        let turn = turn_between(standing.facing, facing);
        let steps = (turn.abs() / TURN_STEP).ceil();
        if turn.abs() < 0.02 {
            return Ok(());
        }
        // The foot on the inner side moves first, so that the feet never cross.
        let order = if turn > 0.0 { [0, 1] } else { [1, 0] };
        let parts = (1..=steps as usize)
            .map(|step| self.person.standing(standing.middle, standing.facing + turn * step as f32 / steps));
        let parts: Vec<TwoFootStance> = parts.collect();
        self.shuffle(&parts, order);
        Ok(())
    }

    /// Steps aside to `to` by small steps, with the same facing.
    ///
    /// # Errors
    /// [`MoveError::NotThere`], [`MoveError::NotFinite`].
    pub fn sidestep(&mut self, to: Vec2) -> Result<(), MoveError> {
        must_be_finite(to.is_finite())?;
        let standing = self.standing.ok_or(MoveError::NotThere)?;
        let way = to - standing.middle;
        let steps = (way.length() / ASIDE_STEP_M).ceil();
        if way.length() < SHORTEST_WAY_M {
            return Ok(());
        }
        // The foot with the shorter way moves first, so that the feet never cross.
        let leading = standing.nearer_foot(to);
        let parts: Vec<TwoFootStance> = (1..=steps as usize)
            .map(|step| self.person.standing(standing.middle + way * (step as f32 / steps), standing.facing))
            .collect();
        self.shuffle(&parts, [leading, 1 - leading]);
        Ok(())
    }

    /// Presses `target` with the ball of the nearer foot, stands on the other one meanwhile, and moves the foot back.
    ///
    /// The force rises within 60 to 120 ms, stays for `hold` and falls again. The standing foot stays in place and
    /// carries the rest of the weight.
    ///
    /// # Errors
    /// [`MoveError`] if the person is not on the floor, the target is out of reach or under the other foot, the force
    /// exceeds the body weight, or a number is not finite.
    pub fn press(&mut self, target: Vec2, force: Newtons, hold: Duration) -> Result<(), MoveError> {
        self.press_along(Slide::Line { from: target, to: target }, force, hold, 0.0)
    }

    /// Presses at the start of `way`, slides along it at `speed_m_s` with the same force, and lifts at its end.
    ///
    /// The shoe keeps its heading, also along a bend.
    ///
    /// # Errors
    /// The same as [`Performance::press`].
    pub fn drag(&mut self, way: Slide, speed_m_s: f32, force: Newtons) -> Result<(), MoveError> {
        self.press_along(way, force, Duration::from_millis(150), speed_m_s.max(0.01))
    }

    fn press_along(
        &mut self,
        way: Slide,
        force: Newtons,
        hold: Duration,
        speed_m_s: f32,
    ) -> Result<(), MoveError> {
        must_be_finite(way.is_finite() && force.is_finite() && speed_m_s.is_finite())?;
        let standing = self.standing.ok_or(MoveError::NotThere)?;
        let weight = self.person.weight();
        if force > weight {
            return Err(MoveError::TooHeavy { force_n: force.0, weight_n: weight.0 });
        }
        let nearer = standing.nearer_foot(way.at(0.5));
        let reached = self.reach(&standing, nearer, way);
        let (side, [start, end]) = match reached {
            Ok(poses) => (nearer, poses),
            // If the nearer foot can't do it, try the other one; if both fail, report the nearer foot's error.
            Err(trouble) => (1 - nearer, self.reach(&standing, 1 - nearer, way).map_err(|_| trouble)?),
        };
        let home = standing.feet[side];

        self.leave_standing();
        // A foot can't pull at the floor.
        let share = (force / weight).max(0.0);
        // Heavier presses take longer to rise.
        let rise_s = (0.06 + 0.0003 * f64::from(force.0)).min(0.12);
        let is_still = way.length() == 0.0;
        let slide_s = if is_still { 0.0 } else { f64::from(way.length() / speed_m_s) + RAMP_S };
        let out_s = swing_time(home, start);

        self.shift_weight(side, 0.5, 0.0);
        let lifted = self.now_s;
        let touch = lifted + out_s;
        let pressed = touch + rise_s;
        let slide = pressed + hold.as_secs_f64();
        let slid = slide + slide_s;
        let let_go = if is_still { slid } else { slid + hold.as_secs_f64() };
        let off = let_go + 0.08;
        let back = off + swing_time(end, home);

        let foot = &mut self.tracks[side];
        foot.go(lifted, touch, start, Profile::Swing);
        if !is_still {
            let way = way.shifted(start.position - way.at(0.0));
            foot.slide(slide, slid, way, Profile::Steady { ramp_s: RAMP_S as f32 });
        }
        foot.go(off, back, home, Profile::Swing);
        foot.roll.rest(lifted, STAND_ROLL);
        foot.roll.rest(0.5 * (lifted + touch), PRESS_ROLL);
        foot.roll.rest(off, PRESS_ROLL);
        foot.roll.rest(back, STAND_ROLL);
        for (track, rest, pressing) in [(side, 0.0, share), (1 - side, 1.0, 1.0 - share)] {
            let load = &mut self.tracks[track].load;
            load.rest(touch, rest);
            load.rest(pressed, pressing);
            load.rest(let_go, pressing);
            load.rest(off, rest);
            load.rest(back, rest);
        }
        self.now_s = back;
        self.shift_weight(side, 0.0, 0.5);
        self.resume_standing(standing);
        Ok(())
    }

    /// Poses of the shoe at both ends of a press with one foot; an error if the foot can't reach some part of the
    /// way.
    fn reach(&self, standing: &TwoFootStance, side: usize, way: Slide) -> Result<[Pose; 2], MoveError> {
        let (home, stance) = (standing.feet[side], standing.feet[1 - side]);
        let pose = |target| self.person.pose_pressing(target, home.heading);
        for part in 0..=WAY_PARTS {
            self.person.can_put(pose(way.at(part as f32 / WAY_PARTS as f32)), stance)?;
        }
        Ok([pose(way.at(0.0)), pose(way.at(1.0))])
    }

    /// Moves the feet one after the other, in this order, to each of the stances in `parts`.
    fn shuffle(&mut self, parts: &[TwoFootStance], order: [usize; 2]) {
        self.leave_standing();
        let mut carried = 0.5;
        for part in parts {
            for side in order {
                self.shift_weight(side, carried, 0.0);
                let lifted = self.now_s;
                self.now_s += REPLANT_S;
                self.tracks[side].go(lifted, self.now_s, part.feet[side], Profile::Swing);
                // The other foot moves next, and this one now carries the whole weight.
                carried = 1.0;
            }
        }
        self.shift_weight(order[1], 0.0, 0.5);
        if let Some(last) = parts.last() {
            self.resume_standing(*last);
        }
    }

    /// Shifts the share of the weight on foot `side` from `from` to `to`.
    fn shift_weight(&mut self, side: usize, from: f32, to: f32) {
        for (track, from, to) in [(side, from, to), (1 - side, 1.0 - from, 1.0 - to)] {
            let load = &mut self.tracks[track].load;
            load.rest(self.now_s, from);
            load.rest(self.now_s + SHIFT_S, to);
        }
        self.now_s += SHIFT_S;
    }

    /// Ends the sway now.
    fn leave_standing(&mut self) {
        self.sway.strength.rest(self.now_s, 1.0);
        self.sway.strength.rest(self.now_s + 0.2, 0.0);
    }

    /// Starts standing and swaying now.
    fn resume_standing(&mut self, standing: TwoFootStance) {
        self.sway.strength.rest(self.now_s - 0.1, 0.0);
        self.sway.strength.rest(self.now_s, 1.0);
        self.standing = Some(standing);
    }
}

/// Time that a foot is in the air for a small step (s).
const REPLANT_S: f64 = 0.3;

/// Maximum length of a small step aside (m).
const ASIDE_STEP_M: f32 = 0.3;

/// Number of points checked along a drag: five for each of a dial's ten turns.
const WAY_PARTS: u16 = 50;

/// Time in which a drag reaches its speed (s).
const RAMP_S: f64 = 0.1;

/// Duration of moving a foot from one place to another without load (s).
fn swing_time(from: Pose, to: Pose) -> f64 {
    f64::from((0.25 + 0.5 * from.position.distance(to.position)).min(0.7))
}

fn must_be_finite(finite: bool) -> Result<(), MoveError> {
    if finite { Ok(()) } else { Err(MoveError::NotFinite) }
}
