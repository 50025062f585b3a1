//! Feet guided by hand: another thread sends paths, the feet move along them at the sensor rate.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};

use glam::Vec2;

use super::foot::{Foot, FootDriver};
use super::track::turn_between;
use underfoot::units::{Instant, Newtons};

/// Maximum number of paths in the channel to the simulated floor, which empties it each millisecond: a second of a
/// window's frames.
const PATHS_WAITING: usize = 64;

/// Returns a handle that guides feet, and the driver that moves them.
///
/// The driver goes to the simulated floor's thread; the guiding thread keeps the handle. When the handle is dropped,
/// the feet lift off and the performance ends.
#[must_use]
pub fn feet_by_hand() -> (FootHandle, HandDriver) {
    let (paths, led) = sync_channel(PATHS_WAITING);
    (FootHandle { paths }, HandDriver { led, followers: Vec::new(), last: None })
}

/// Guides feet along paths.
#[derive(Debug)]
pub struct FootHandle {
    paths: SyncSender<Led>,
}

/// Duration of the paths (s), and the paths of all feet.
type Led = (f32, Vec<Vec<Foot>>);

impl FootHandle {
    /// Guides each foot along its path, drawn by the hand in `over_s` seconds, after all its earlier paths.
    ///
    /// A path is a list of places with a force at each. A foot lands before it slides, stays down for at least 150
    /// ms, and lifts at the place where the path lifts it. It slides as fast as the hand, at most 2 m/s, so the
    /// motion follows the path however rarely the caller sends it. A foot's index in the list is its identity. A foot
    /// without a path, or beyond the list's end, lifts at its place; so does a foot with a place that is not finite.
    /// A time that is not finite counts as none. Never blocks.
    pub fn lead(&mut self, over_s: f32, feet: Vec<Vec<Foot>>) {
        // Sending fails if the floor has ended or is paused; then there are no feet to move.
        let _ = self.paths.try_send((over_s, feet));
    }
}

/// Moves the feet of a [`FootHandle`]: turns paths that arrive now and then into continuous motion at 1 kHz.
#[derive(Debug)]
pub struct HandDriver {
    led: Receiver<Led>,
    followers: Vec<Follower>,
    last: Option<Instant>,
}

/// Time constant of the critically damped filter of the motion (s): it lags 15 ms behind a steady motion.
const FOLLOW_S: f32 = 0.0075;

/// Time constant of the filter of the force (s): it reaches nine tenths within 47 ms, as in a brisk step rather than
/// a stamp.
const PRESS_S: f32 = 0.012;

/// Force below which a foot is in the air and may move freely (N).
const AIRBORNE: f32 = 0.5;

/// Share of its target force above which a foot has landed and may slide.
const LANDED: f32 = 0.8;

/// Minimum duration of a press (s): a mouse click is shorter than a footfall.
const SHORTEST_S: f32 = 0.150;

/// Maximum speed of a sliding foot (m/s): a leg can't follow a mouse that is flung across a screen.
const FASTEST_M_S: f32 = 2.0;

/// Maximum distance from the place of lift-off at which a foot may lift (m): it does not slide while it rises.
const THERE_M: f32 = 0.002;

/// Minimum time for the rest of a path (s), so that uneven frames of a window give an even motion.
const EVEN_S: f32 = 0.050;

/// Maximum time for the rest of a path (s), even after a long pause of the window.
const LONGEST_S: f32 = 0.250;

/// Maximum number of queued places: half a minute of a mouse that reports 125 times a second.
const MOST_PLACES: usize = 4096;

impl FootDriver for HandDriver {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        let dt = self.last.map_or(0.0, |last| at.since(last).as_secs_f32());
        self.last = Some(at);
        let dropped = loop {
            match self.led.try_recv() {
                Ok((over_s, paths)) => self.lead(over_s, &paths),
                Err(TryRecvError::Empty) => break false,
                Err(TryRecvError::Disconnected) => break true,
            }
        };
        if dropped {
            self.lead(0.0, &[]);
        }
        self.followers.iter_mut().for_each(|follower| follower.step(dt));
        while self.followers.last().is_some_and(Follower::is_gone) {
            self.followers.pop();
        }
        feet.extend(self.followers.iter().map(Follower::foot));
        !(dropped && feet.is_empty())
    }
}

impl HandDriver {
    fn lead(&mut self, over_s: f32, paths: &[Vec<Foot>]) {
        for index in 0..paths.len().max(self.followers.len()) {
            let path = paths.get(index).map_or(&[][..], Vec::as_slice);
            match self.followers.get_mut(index) {
                Some(follower) => follower.lead(over_s, path),
                None => {
                    let mut follower = Follower::over(path.first());
                    follower.lead(over_s, path);
                    self.followers.push(follower);
                }
            }
        }
    }
}

fn is_finite(foot: &Foot) -> bool {
    foot.position.is_finite()
        && [foot.heading, foot.length_m, foot.force.0, foot.roll].iter().all(|number| number.is_finite())
}

/// One foot on its path.
#[derive(Clone, Debug)]
struct Follower {
    x: Spring,
    y: Spring,
    heading: Spring,
    force: Spring,
    roll: Spring,
    /// Current target on the path.
    goal: Foot,
    /// Remaining path.
    path: VecDeque<Foot>,
    /// Time for the remaining path (s).
    left_s: f32,
    /// Time since touchdown (s).
    down_s: f32,
    /// True if the foot carries its target force and may slide.
    landed: bool,
    /// True if the last message had no path for this foot.
    left_out: bool,
}

impl Follower {
    /// Creates a foot in the air above the first place of its path.
    fn over(first: Option<&Foot>) -> Self {
        let anywhere = Foot {
            position: Vec2::ZERO,
            heading: 0.0,
            length_m: 0.27,
            force: Newtons::ZERO,
            roll: 0.0,
            left: false,
        };
        let goal = Foot { force: Newtons::ZERO, ..first.copied().filter(is_finite).unwrap_or(anywhere) };
        let mut follower = Self {
            x: Spring::at(0.0),
            y: Spring::at(0.0),
            heading: Spring::at(0.0),
            force: Spring::at(0.0),
            roll: Spring::at(0.0),
            goal,
            path: VecDeque::new(),
            left_s: 0.0,
            down_s: 0.0,
            landed: false,
            left_out: false,
        };
        follower.jump(goal);
        follower
    }

    fn lead(&mut self, over_s: f32, path: &[Foot]) {
        let before_m = self.length_left();
        self.left_out = path.is_empty();
        let last = self.path.back().copied().unwrap_or(self.goal);
        let lifted = Foot { force: Newtons::ZERO, ..last };
        if path.is_empty() && last.force > Newtons::ZERO {
            self.path.push_back(lifted);
        }
        for place in path {
            let last = self.path.back().copied().unwrap_or(self.goal);
            let place = if is_finite(place) { *place } else { Foot { force: Newtons::ZERO, ..last } };
            self.path.push_back(Foot { force: place.force.max(Newtons::ZERO), ..place });
        }
        // A resting hand does not extend the time for the earlier path.
        if self.length_left() > before_m {
            self.left_s = if over_s.is_finite() { over_s.clamp(EVEN_S, LONGEST_S) } else { EVEN_S };
        }
        // If the queue overflows, the oldest places are dropped.
        let excess = self.path.len().saturating_sub(MOST_PLACES);
        self.path.drain(..excess);
    }

    fn is_airborne(&self) -> bool {
        self.force.value < AIRBORNE
    }

    fn is_gone(&self) -> bool {
        self.left_out && self.path.is_empty() && self.is_airborne()
    }

    fn step(&mut self, dt: f32) {
        self.walk(dt);
        let Foot { position, heading, roll, force, .. } = self.goal;
        if self.is_airborne() && force == Newtons::ZERO {
            self.jump(self.goal);
        } else {
            let heading = self.heading.value + turn_between(self.heading.value, heading);
            self.x.follow(position.x, FOLLOW_S, dt);
            self.y.follow(position.y, FOLLOW_S, dt);
            self.heading.follow(heading, FOLLOW_S, dt);
            self.roll.follow(roll, FOLLOW_S, dt);
        }
        self.force.follow(force.0, PRESS_S, dt);
        self.down_s += dt;
        self.landed = force > Newtons::ZERO && (self.landed || self.force.value >= LANDED * force.0);
    }

    /// Moves the target along the path, as far as a foot slides in `dt` seconds.
    fn walk(&mut self, dt: f32) {
        let speed = (self.length_left() / self.left_s.max(dt).max(1e-4)).min(FASTEST_M_S);
        let mut way_m = speed * dt;
        while let Some(next) = self.path.front().copied() {
            match (self.goal.force > Newtons::ZERO, next.force > Newtons::ZERO) {
                // A lifted foot must be in the air before it moves to another place.
                (false, _) if !self.is_airborne() => return,
                (false, false) => self.goal = next,
                (false, true) => {
                    self.jump(next);
                    self.down_s = 0.0;
                    self.landed = false;
                    self.goal = next;
                }
                (true, _) if !self.landed => return,
                (true, _) if self.down_s < SHORTEST_S && next.force == Newtons::ZERO => return,
                (true, _) => {
                    let distance = self.goal.position.distance(next.position);
                    if distance > way_m {
                        let here = self.goal.position.lerp(next.position, way_m / distance);
                        let force = if next.force > Newtons::ZERO { next.force } else { self.goal.force };
                        self.goal = Foot { position: here, force, ..next };
                        self.left_s -= dt;
                        return;
                    }
                    way_m -= distance;
                    let is_there = self.place().distance(next.position) < THERE_M;
                    if next.force == Newtons::ZERO && !is_there {
                        self.goal = Foot { force: self.goal.force, ..next };
                        return;
                    }
                    self.goal = next;
                }
            }
            self.path.pop_front();
        }
    }

    /// Length of the path up to the next lift-off (m).
    fn length_left(&self) -> f32 {
        let mut here = self.goal.position;
        let mut length = 0.0;
        for place in &self.path {
            length += here.distance(place.position);
            here = place.position;
            if place.force == Newtons::ZERO {
                break;
            }
        }
        length
    }

    fn jump(&mut self, to: Foot) {
        self.x = Spring::at(to.position.x);
        self.y = Spring::at(to.position.y);
        self.heading = Spring::at(to.heading);
        self.roll = Spring::at(to.roll);
    }

    fn place(&self) -> Vec2 {
        Vec2::new(self.x.value, self.y.value)
    }

    fn foot(&self) -> Foot {
        // A lifted foot's force decays exponentially; the last trace of it is not a contact.
        let force = if self.force.value < 0.01 { 0.0 } else { self.force.value };
        Foot {
            position: self.place(),
            heading: self.heading.value,
            length_m: self.goal.length_m,
            force: Newtons(force),
            roll: self.roll.value,
            left: self.goal.left,
        }
    }
}

/// A value that follows its goal as a critically damped spring: `x'' = -(2 / T) x' - (x - goal) / T²`.
#[derive(Clone, Copy, Debug)]
struct Spring {
    value: f32,
    per_s: f32,
}

impl Spring {
    const fn at(value: f32) -> Self {
        Self { value, per_s: 0.0 }
    }

    /// Exact solution over `dt` seconds for the given time constant, so every step size is stable.
    fn follow(&mut self, goal: f32, constant_s: f32, dt: f32) {
        let rate = 1.0 / constant_s;
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
        Foot {
            position: Vec2::new(x, 0.5),
            heading: 0.0,
            length_m: 0.27,
            force: Newtons(force),
            roll: 0.4,
            left: false,
        }
    }

    /// The feet for a hand that sends its path every `frame_ms`; `at` gives its place at each millisecond.
    fn led(frame_ms: u64, length_ms: u64, at: impl Fn(u64) -> Foot) -> Vec<Foot> {
        let (mut handle, mut driver) = feet_by_hand();
        let (mut feet, mut walked) = (Vec::new(), Vec::new());
        for ms in 0..length_ms {
            if ms % frame_ms == 0 {
                // Mice report some 125 times a second.
                let path = (0..frame_ms.div_ceil(8)).rev().map(|back| at(ms.saturating_sub(8 * back)));
                handle.lead(frame_ms as f32 * 1e-3, vec![path.collect()]);
            }
            assert!(driver.feet(Instant::from_millis(ms), &mut feet));
            walked.push(feet[0]);
        }
        walked
    }

    #[test]
    fn a_mouse_becomes_a_smooth_slide_at_ten_frames_a_second_as_at_sixty() {
        for frame_ms in [16, 33, 100] {
            // Half a metre per second after the touchdown.
            let walked = led(frame_ms, 1500, |ms| foot(0.0005 * ms.saturating_sub(100) as f32, 300.0));
            let speeds: Vec<f32> = walked[500..]
                .windows(2)
                .map(|pair| (pair[1].position.x - pair[0].position.x) * 1e3)
                .collect();
            let (slow, fast) = speeds.iter().fold((9.0f32, 0.0f32), |(l, h), &v| (l.min(v), h.max(v)));
            // Without smoothing the foot would jump 50 mm in a millisecond (50 m/s) and then stop.
            assert!(slow > 0.3 && fast < 0.8, "{slow} to {fast} m/s at {frame_ms} ms");
            let lag_s = (0.0005 * 1399.0 - walked[1499].position.x) / 0.5;
            assert!(lag_s < 0.02 + 2e-3 * frame_ms.max(50) as f32, "{lag_s} s at {frame_ms} ms");
        }
    }

    #[test]
    fn force_comes_and_goes_without_steps() {
        let forces: Vec<f32> = led(16, 400, |ms| foot(0.5, if ms < 150 { 200.0 } else { 0.0 }))
            .iter()
            .map(|f| f.force.0)
            .collect();
        assert!(forces[0] < 1.0 && forces[60] > 190.0 && forces[149] > 199.9 && forces[399] == 0.0);
        let steepest = forces.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
        assert!(steepest < 12.0, "{steepest} N in a millisecond");
        assert!(forces.iter().all(|&force| (0.0..200.1).contains(&force)));
    }

    #[test]
    fn a_foot_lands_before_it_slides_and_lifts_where_the_path_lifts_it() {
        // All within one frame: down, 30 cm to the east, up.
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.lead(0.1, vec![vec![foot(0.2, 0.0), foot(0.2, 100.0), foot(0.5, 100.0), foot(0.5, 0.0)]]);
        let mut most = 0.0_f32;
        for ms in 0..600 {
            driver.feet(Instant::from_millis(ms), &mut feet);
            let foot = feet[0];
            if foot.force.0 > AIRBORNE && foot.force.0 < 0.7 * 100.0 {
                let off = (foot.position.x - 0.2).abs().min((foot.position.x - 0.5).abs());
                assert!(off < 0.001, "{foot:?} is neither where it came down nor where it lifts");
            }
            most = most.max(foot.force.0);
        }
        assert!(most > 95.0, "{most}");
        assert_eq!((feet[0].position.x, feet[0].force), (0.5, Newtons::ZERO));
    }

    #[test]
    fn a_click_is_a_whole_step_and_a_flung_mouse_is_followed_as_fast_as_a_leg_can() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.lead(0.016, vec![vec![foot(0.2, 150.0), foot(0.2, 0.0)]]);
        let mut down_ms = 0;
        for ms in 0..400 {
            driver.feet(Instant::from_millis(ms), &mut feet);
            down_ms += u64::from(feet[0].force.0 > 0.9 * 150.0);
        }
        assert!((80..250).contains(&down_ms), "{down_ms}");
        handle.lead(0.016, vec![vec![foot(0.2, 150.0), foot(1.2, 150.0)]]);
        let mut last = 0.2;
        for ms in 400..1200 {
            driver.feet(Instant::from_millis(ms), &mut feet);
            assert!(feet[0].position.x - last < 1.1e-3 * FASTEST_M_S);
            last = feet[0].position.x;
        }
        assert!((last - 1.2).abs() < 1e-3, "{last}");
    }

    #[test]
    fn a_lifted_foot_lands_where_it_is_wanted_and_not_on_the_way() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.lead(0.0, vec![vec![foot(0.2, 100.0)]]);
        (0..200).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        handle.lead(0.0, vec![vec![foot(0.2, 0.0), foot(1.2, 100.0)]]);
        for ms in 200..500 {
            driver.feet(Instant::from_millis(ms), &mut feet);
            let x = feet[0].position.x;
            assert!((x - 0.2).abs() < 1e-4 || (x - 1.2).abs() < 1e-4, "{x}");
        }
        assert_eq!(feet[0].position.x, 1.2);
    }

    #[test]
    fn feet_left_out_lift_and_go_and_a_dropped_handle_ends_the_performance() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.lead(0.0, vec![vec![foot(0.2, 100.0)], vec![foot(0.5, 100.0)]]);
        (0..200).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        handle.lead(0.0, vec![vec![foot(0.2, 100.0)]]);
        driver.feet(Instant::from_millis(200), &mut feet);
        assert_eq!(feet.len(), 2, "it lifts before it goes");
        (201..400).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        assert_eq!(feet.len(), 1);
        drop(handle);
        let end = (400..700).find(|&ms| !driver.feet(Instant::from_millis(ms), &mut feet));
        assert!(end.is_some_and(|ms| ms > 410), "{end:?}");
    }

    #[test]
    fn nonsense_lifts_the_foot_where_it_is() {
        let (mut handle, mut driver) = feet_by_hand();
        let mut feet = Vec::new();
        handle.lead(f32::NAN, vec![vec![foot(f32::NAN, 100.0)]]);
        driver.feet(Instant::START, &mut feet);
        assert!(is_finite(&feet[0]));
        handle.lead(0.0, vec![vec![foot(0.7, 100.0)]]);
        (1..200).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        assert_eq!(feet[0].position.x, 0.7);
        handle.lead(0.0, vec![vec![foot(0.7, f32::INFINITY)]]);
        (200..400).for_each(|ms| assert!(driver.feet(Instant::from_millis(ms), &mut feet)));
        assert_eq!((feet[0].position.x, feet[0].force), (0.7, Newtons::ZERO));
    }
}
