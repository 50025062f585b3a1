//! The shape of a foot: what is learnt of it while it stands alone, and how long that holds.

use super::foot::{Foot, HALF_EAST, HALF_LEAST, HALF_MOST, HALF_NORTH, HALF_REST};
use super::lines::{Axis, Habit, Lines};
use crate::sense::tile::LoadedTile;

/// Time constant of a foot's habits, in seconds.
const HABIT_S: f64 = 0.08;

/// How long a foot must be alone for its shape to be known, in seconds.
const KNOWN_S: f64 = 0.1;

/// How long only its heel may be down, which tells nothing of the rest, in seconds.
const TOUCHES_S: f64 = 0.1;

impl Foot {
    /// Learns the patch's half widths from how seams divide a foot whose centre of pressure is known.
    fn learn_halves(&mut self, lines: &Lines, pitch: f64, dt: f64) {
        let fade = (-dt / 0.3).exp();
        // The same error of the model is seen in many frames.
        let doubt = 0.015_f64.powi(2) * (1.0_f64).max(0.02 / dt.max(1e-4));
        for axis in Axis::BOTH {
            let half = axis.half();
            self.state[half] = HALF_REST + fade * (self.state[half] - HALF_REST);
            let mut variance = self.covariance[half][half];
            variance = variance * fade * fade + 0.03_f64.powi(2) * (1.0 - fade * fade);
            for line in lines.lines.iter().filter(|line| line.axis == axis) {
                let slice = line.slice(pitch, axis.along(self.centre()), self.state[half]);
                let seen = [line.force / lines.force - slice.share, line.moment / lines.force - slice.moment];
                // A share that strays lies half a pitch from the line's middle.
                let slopes = [slice.share_by[1], slice.moment_by[1]];
                for (missing, slope, lever) in [(seen[0], slopes[0], 1.0), (seen[1], slopes[1], 0.5 * pitch)]
                {
                    let gain = variance * slope / (slope * slope * variance + doubt * lever * lever);
                    self.state[half] = (self.state[half] + gain * missing).clamp(HALF_LEAST, HALF_MOST);
                    variance *= 1.0 - gain * slope;
                }
            }
            self.covariance[half][half] = variance;
        }
    }

    /// Notes how the foot, alone on its tiles, differs from its model patch.
    pub(super) fn learn_habits(&mut self, list: &[LoadedTile], pitch: f64, dt: f64) {
        let (centre, half) = (self.centre(), self.half());
        let mut lines = Lines::of(self.tiles.iter().map(|&position| &list[position as usize]), pitch);
        for axis in Axis::BOTH {
            let (c, h) = (axis.along(centre), axis.along(half));
            for number in ((c - h) / pitch).floor() as i32..=((c + h) / pitch).floor() as i32 {
                lines.line(axis, number);
            }
        }
        self.learn_halves(&lines, pitch, dt);
        let half = self.half();
        // Slowly, so that the first touch of a newcomer, not yet known as one, hardly enters.
        let weight =
            if self.alone_at.is_none() || self.age < HABIT_S { 1.0 } else { 1.0 - (-dt / HABIT_S).exp() };
        for habit in &mut self.habits {
            habit.seen = false;
        }
        for line in &lines.lines {
            let slice = line.slice(pitch, line.axis.along(centre), line.axis.along(half));
            let now = [
                line.force / lines.force - slice.share,
                line.moment / lines.force - slice.moment,
                line.cross / lines.force,
            ];
            let same = |habit: &Habit| habit.axis == line.axis && habit.number == line.number;
            let position = self.habits.iter().position(same).unwrap_or_else(|| {
                self.habits.push(Habit::none(line.axis, line.number));
                self.habits.len() - 1
            });
            self.habits[position].learn(now, weight);
        }
        self.habits.retain(|habit| habit.seen);
        if self.age > TOUCHES_S {
            self.alone_s += dt;
        }
        let before = self.alone_at.unwrap_or(centre);
        self.alone_at = Some(before + (centre - before) * weight);
    }

    /// Makes a foot that was alone until now be sure of its shape: its habits say how it
    /// differs from the model, whatever the half widths are.
    pub(super) fn keep_shape(&mut self) {
        if self.alone_at.is_some() {
            let unknown = (-self.alone_s / KNOWN_S).exp();
            let deviation = 0.0005 + 0.03 * unknown;
            for half in [HALF_EAST, HALF_NORTH] {
                self.state[half] += unknown * (HALF_REST - self.state[half]);
                let variance = &mut self.covariance[half][half];
                *variance = variance.min(deviation * deviation);
            }
        }
    }

    /// How much of its habits still hold: all of them where it was last alone, none a few centimetres on.
    pub(super) fn habit_strength(&self) -> f64 {
        self.alone_at.map_or(0.0, |place| {
            let moved = place.distance(self.centre()) / 0.05;
            (-moved * moved).exp() * (1.0 - (-self.alone_s / KNOWN_S).exp())
        })
    }

    /// Its habit on one line, as far as it still holds; nothing where it has none.
    pub(super) fn habit(&self, axis: Axis, number: i32) -> Habit {
        self.habit_at(axis, number, self.habit_strength())
    }

    /// Its habit on one line, times `strength`.
    pub(super) fn habit_at(&self, axis: Axis, number: i32, strength: f64) -> Habit {
        self.habits
            .iter()
            .find(|habit| habit.axis == axis && habit.number == number)
            .map(|habit| Habit {
                share: habit.share * strength,
                moment: habit.moment * strength,
                cross: habit.cross * strength,
                ..*habit
            })
            .unwrap_or(Habit::none(axis, number))
    }
}
