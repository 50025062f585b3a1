//! Feet moved by hand: set from another thread, smoothed at the sensor rate.

use std::sync::Arc;

use glam::Vec2;
use triple_buffer::{Input, Output, triple_buffer};

use super::foot::{Foot, FootDriver};
use super::track::turn_between;
use crate::units::{Instant, Newtons};

/// A handle to set feet with, and the driver that moves them.
///
/// The driver goes to the simulated floor's thread, the handle stays with
/// whoever knows where the feet shall be. When the handle is dropped the feet
/// lift off and the performance is over.
#[must_use]
pub fn feet_by_hand() -> (FootHandle, HandDriver) {
    let (input, output) = triple_buffer(&Vec::new());
    let held = Arc::new(());
    let handle = FootHandle { input, _held: Arc::clone(&held) };
    (handle, HandDriver { output, held, followers: Vec::new(), last: None })
}

/// Says where feet shall be; the latest word counts.
#[derive(Debug)]
pub struct FootHandle {
    input: Input<Vec<Foot>>,
    _held: Arc<()>,
}

impl FootHandle {
    /// Where the feet shall be from now on, and what they shall press with.
    ///
    /// A foot's place in the list is its identity: lift one by setting its force
    /// to zero, or leave out the last ones. A foot that is not finite is taken as
    /// lifted. Never blocks.
    pub fn set(&mut self, feet: Vec<Foot>) {
        self.input.write(feet);
    }
}

/// Moves the feet of a [`FootHandle`]: 60 words a second become motion at 1 kHz without steps.
#[derive(Debug)]
pub struct HandDriver {
    output: Output<Vec<Foot>>,
    held: Arc<()>,
    followers: Vec<Follower>,
    last: Option<Instant>,
}

/// Time constant of the followers, in seconds: they lag 15 ms behind a steady motion.
const FOLLOW_S: f32 = 0.0075;

/// Below this a foot is in the air and may be anywhere, in newtons.
const AIRBORNE: f32 = 0.5;

impl FootDriver for HandDriver {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        let dt = self.last.map_or(0.0, |last| at.since(last).as_secs_f32());
        self.last = Some(at);
        let dropped = Arc::strong_count(&self.held) == 1;
        let wanted: &[Foot] = if dropped { &[] } else { self.output.read() };
        let missing = wanted.len().saturating_sub(self.followers.len());
        self.followers.extend(wanted.iter().rev().take(missing).rev().map(Follower::over));
        for (index, follower) in self.followers.iter_mut().enumerate() {
            follower.follow(wanted.get(index).filter(|foot| is_finite(foot)), dt);
        }
        while self.followers.len() > wanted.len() && self.followers.last().is_some_and(Follower::is_airborne)
        {
            self.followers.pop();
        }
        feet.extend(self.followers.iter().map(Follower::foot));
        !(dropped && feet.is_empty())
    }
}

fn is_finite(foot: &Foot) -> bool {
    foot.position.is_finite()
        && [foot.heading, foot.length_m, foot.force.0, foot.roll].iter().all(|number| number.is_finite())
}

/// One foot on its way to where it is wanted.
#[derive(Clone, Copy, Debug)]
struct Follower {
    length_m: f32,
    x: Spring,
    y: Spring,
    heading: Spring,
    force: Spring,
    roll: Spring,
}

impl Follower {
    /// A foot in the air over where it is wanted.
    fn over(wanted: &Foot) -> Self {
        let safe = if is_finite(wanted) {
            *wanted
        } else {
            Foot { position: Vec2::ZERO, heading: 0.0, length_m: 0.27, force: Newtons::ZERO, roll: 0.0 }
        };
        Self {
            length_m: safe.length_m,
            x: Spring::at(safe.position.x),
            y: Spring::at(safe.position.y),
            heading: Spring::at(safe.heading),
            force: Spring::at(0.0),
            roll: Spring::at(safe.roll),
        }
    }

    fn is_airborne(&self) -> bool {
        self.force.value < AIRBORNE
    }

    fn follow(&mut self, wanted: Option<&Foot>, dt: f32) {
        if let Some(wanted) = wanted {
            self.length_m = wanted.length_m;
            let heading = self.heading.value + turn_between(self.heading.value, wanted.heading);
            let goals = [wanted.position.x, wanted.position.y, heading, wanted.roll];
            let springs = [&mut self.x, &mut self.y, &mut self.heading, &mut self.roll];
            for (spring, goal) in springs.into_iter().zip(goals) {
                if self.force.value < AIRBORNE {
                    *spring = Spring::at(goal);
                } else {
                    spring.follow(goal, dt);
                }
            }
        }
        self.force.follow(wanted.map_or(0.0, |foot| foot.force.0.max(0.0)), dt);
    }

    fn foot(&self) -> Foot {
        // A lifted foot's force only fades out; the last trace of it is not a contact.
        let force = if self.force.value < 0.01 { 0.0 } else { self.force.value };
        Foot {
            position: Vec2::new(self.x.value, self.y.value),
            heading: self.heading.value,
            length_m: self.length_m,
            force: Newtons(force),
            roll: self.roll.value,
        }
    }
}

/// A value that follows its goal as a critically damped spring does.
#[derive(Clone, Copy, Debug)]
struct Spring {
    value: f32,
    per_s: f32,
}

impl Spring {
    const fn at(value: f32) -> Self {
        Self { value, per_s: 0.0 }
    }

    /// The exact motion over `dt` seconds, so any step is stable.
    fn follow(&mut self, goal: f32, dt: f32) {
        let rate = 1.0 / FOLLOW_S;
        let off = self.value - goal;
        let push = self.per_s + rate * off;
        let fade = (-rate * dt).exp();
        self.value = goal + (off + push * dt) * fade;
        self.per_s = (self.per_s - rate * push * dt) * fade;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn foot(x: f32, force: f32) -> Foot {
        Foot { position: Vec2::new(x, 0.5), heading: 0.0, length_m: 0.27, force: Newtons(force), roll: 0.4 }
    }

    #[test]
    fn a_mouse_at_sixty_hertz_becomes_a_smooth_slide() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        let mut places = Vec::new();
        for ms in 0..600u64 {
            if ms % 17 == 0 {
                // Half a metre per second.
                handle.set(vec![foot(0.0005 * ms as f32, 300.0)]);
            }
            assert!(driver.feet(Instant::from_millis(ms), &mut feet));
            places.push(feet[0].position.x);
        }
        let speeds: Vec<f32> = places[100..].windows(2).map(|pair| (pair[1] - pair[0]) * 1e3).collect();
        let (slow, fast) = speeds.iter().fold((9.0f32, 0.0f32), |(l, h), &v| (l.min(v), h.max(v)));
        // Unsmoothed it would jump 8.5 mm in a millisecond (8.5 m/s) and then rest.
        assert!(slow > 0.2 && fast < 0.9, "{slow} to {fast} m/s");
        let lag = 0.0005 * 599.0 - places[599];
        assert!((0.005..0.018).contains(&lag), "15 ms plus the mouse's own 8 ms are about 12 mm: {lag}");
    }

    #[test]
    fn force_comes_and_goes_without_steps() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        let mut forces = Vec::new();
        handle.set(vec![foot(0.5, 200.0)]);
        for ms in 0..300u64 {
            if ms == 150 {
                handle.set(vec![foot(0.5, 0.0)]);
            }
            driver.feet(Instant::from_millis(ms), &mut feet);
            forces.push(feet[0].force.0);
        }
        assert!(forces[0] < 1.0 && forces[60] > 195.0 && forces[149] > 199.9 && forces[299] == 0.0);
        let steepest = forces.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        assert!(steepest < 12.0, "{steepest} N in a millisecond");
        assert!(forces.iter().all(|&force| (0.0..200.1).contains(&force)));
    }

    #[test]
    fn a_lifted_foot_lands_where_it_is_wanted_and_not_on_the_way() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.set(vec![foot(0.2, 100.0)]);
        (0..100).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        handle.set(vec![foot(0.2, 0.0)]);
        (100..200).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        handle.set(vec![foot(1.2, 100.0)]);
        for ms in 200..300 {
            driver.feet(Instant::from_millis(ms), &mut feet);
            assert_eq!(feet[0].position.x, 1.2);
        }
    }

    #[test]
    fn feet_left_out_lift_and_go_and_a_dropped_handle_ends_the_performance() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.set(vec![foot(0.2, 100.0), foot(0.5, 100.0)]);
        (0..100).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        handle.set(vec![foot(0.2, 100.0)]);
        driver.feet(Instant::from_millis(100), &mut feet);
        assert_eq!(feet.len(), 2, "it lifts before it goes");
        (101..200).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        assert_eq!(feet.len(), 1);
        drop(handle);
        let end = (200..400).find(|&ms| !driver.feet(Instant::from_millis(ms), &mut feet));
        assert!(end.is_some_and(|ms| ms > 210), "{end:?}");
    }

    #[test]
    fn nonsense_lifts_the_foot_where_it_is() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.set(vec![foot(f32::NAN, 100.0)]);
        driver.feet(Instant::START, &mut feet);
        assert!(is_finite(&feet[0]));
        handle.set(vec![foot(0.7, 100.0)]);
        (1..100).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        assert_eq!(feet[0].position.x, 0.7);
        handle.set(vec![foot(0.7, f32::INFINITY)]);
        (100..200).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        assert_eq!((feet[0].position.x, feet[0].force), (0.7, Newtons::ZERO));
    }
}
