//! Scripts: performances of several people over one floor, as feet and loads at each moment.

use std::time::Duration;

use glam::Vec2;

use super::foot::{Foot, FootDriver, Load};
use super::footprint::shoe_size;
use super::performance::Performance;
use underfoot::floor::Rect;
use underfoot::units::Instant;

/// Performances of one or several people over one floor, from the clock's start.
///
/// The feet are in the order of the people, left before right; a foot entirely beside the floor is omitted.
#[derive(Clone, Debug)]
pub struct Script {
    cast: Vec<Performance>,
    bounds: Rect,
}

impl Script {
    /// Combines these people's performances over a floor with these bounds.
    #[must_use]
    pub fn new(cast: Vec<Performance>, bounds: Rect) -> Self {
        Self { cast, bounds }
    }

    /// Returns the time from the clock's start to the end of the longest performance.
    #[must_use]
    pub fn duration(&self) -> Duration {
        self.cast.iter().map(Performance::duration).max().unwrap_or_default()
    }

    /// Adds the feet on or above the floor at `at`; moments may come in any order.
    pub fn feet_at(&self, at: Instant, feet: &mut Vec<Foot>) {
        for performance in &self.cast {
            feet.extend(performance.feet(at.secs()).into_iter().flatten().filter(|foot| {
                let reach = 0.5 * shoe_size(foot.length_m).length();
                self.bounds.grown(reach).contains(foot.position)
            }));
        }
    }
}

impl Script {
    /// Like [`Script::feet_at`], but adds loads. People who roll like recorded people
    /// ([`Performance::rolling_as_people_do`]) have recorded prints; others have the prints of [`Foot::as_load`].
    pub fn loads_at(&self, at: Instant, loads: &mut Vec<Load>) {
        for performance in &self.cast {
            let feet = performance.feet(at.secs());
            for (side, foot) in feet.into_iter().enumerate() {
                let near = |foot: &Foot| {
                    self.bounds.grown(0.5 * shoe_size(foot.length_m).length()).contains(foot.position)
                };
                loads.extend(foot.filter(near).map(|foot| performance.load(side, &foot, at.secs())));
            }
        }
    }
}

impl FootDriver for Script {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        let over = at.since(Instant::START) > self.duration();
        if !over {
            self.feet_at(at, feet);
        }
        !over
    }
}

impl Performance {
    /// The load of one foot.
    fn load(&self, side: usize, foot: &Foot, at_s: f64) -> Load {
        let load = foot.as_load();
        let (Some(_), Some(track)) = (&self.habit, self.tracks.get(side)) else { return load };
        let (mut centre, mut variance) = (load.print.centre_of_pressure(), load.print.variance());
        if let Some(step) = track.step(at_s) {
            let share = track.stepping.at(at_s);
            let (stepping, radii) = step.pressure(foot.roll);
            centre = centre.lerp(stepping, share);
            variance = variance.lerp(radii * radii, share);
        }
        let radii = Vec2::new(variance.x.sqrt(), variance.y.sqrt());
        Load { print: self.person.footwear.print(centre, radii, foot.length_m), ..load }
    }

    /// The left and the right foot at a moment; `None` before the person has appeared.
    fn feet(&self, at_s: f64) -> [Option<Foot>; 2] {
        let (shifted, rolled) = self.sway.at(at_s);
        let loads = [self.tracks[0].load.at(at_s), self.tracks[1].load.at(at_s)];
        // Weight can only shift to a standing foot.
        let shifted = if loads.iter().all(|&load| load > 0.1) { shifted } else { 0.0 };
        let weight = self.person.weight();
        [(0, shifted), (1, -shifted)].map(|(side, shifted)| {
            let track = &self.tracks[side];
            let pose = track.pose(at_s)?;
            Some(Foot {
                position: pose.position,
                heading: pose.heading,
                length_m: self.person.foot_length_m,
                force: weight * (loads[side] + shifted).max(0.0),
                roll: (track.roll.at(at_s) + rolled).clamp(0.0, 1.0),
                left: side == 0,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::{MoveError, Person, Slide};
    use underfoot::floor::Geometry;
    use underfoot::units::Newtons;

    const EAST: f32 = -0.5 * PI;

    fn someone() -> Performance {
        Performance::new(Person::default(), 5)
    }

    fn standing_at(x: f32, y: f32, facing: f32) -> Performance {
        let mut someone = someone();
        someone.appear(Vec2::new(x, y), facing).unwrap();
        someone
    }

    #[test]
    fn who_rolls_as_people_do_walks_with_the_same_weight_and_other_prints() {
        let bounds = Geometry::of_paper_tiles(10, 6).unwrap().bounds();
        let walk = |mut walker: Performance| {
            walker.appear(Vec2::new(0.4, 0.9), EAST).unwrap();
            walker.walk(&[Vec2::new(2.6, 0.9)]).unwrap();
            walker.wait(Duration::from_millis(500));
            Script::new(vec![walker], bounds)
        };
        let script = walk(someone().rolling_as_people_do(3));
        let (mut loads, mut feet, mut whole, mut jump) = (Vec::new(), Vec::new(), 0.0, 0.0f32);
        let mut before: Vec<Load> = Vec::new();
        let length = script.duration().as_millis() as u64;
        for ms in 0..length {
            let at = Instant::from_millis(ms);
            loads.clear();
            feet.clear();
            script.loads_at(at, &mut loads);
            script.feet_at(at, &mut feet);
            whole += loads.iter().map(|load| load.force.0).sum::<f32>();
            for (load, foot) in loads.iter().zip(&feet) {
                assert_eq!((load.position, load.force), (foot.position, foot.force));
                let away = load.centre_of_pressure().distance(foot.position);
                assert!(away < 0.16, "{away} from the middle of the foot at {ms} ms");
            }
            for (now, before) in loads.iter().zip(&before) {
                if now.force.0 > 50.0 && before.force.0 > 50.0 {
                    jump = jump.max(now.centre_of_pressure().distance(before.centre_of_pressure()));
                }
            }
            before.clone_from(&loads);
        }
        // The mean force is the weight of 70 kg, and the centre of pressure never jumps.
        let mean = whole / length as f32;
        assert!((mean / 686.7 - 1.0).abs() < 0.06, "{mean} N");
        assert!(jump < 0.006, "{jump} m in a millisecond");
        // A different seed gives different steps.
        let other = walk(someone().rolling_as_people_do(4));
        loads.clear();
        feet.clear();
        let mut others = Vec::new();
        script.loads_at(Instant::from_millis(1500), &mut loads);
        other.loads_at(Instant::from_millis(1500), &mut others);
        assert_ne!(loads, others);
    }

    /// Feet at every millisecond of a performance on a floor of ten by six tiles.
    fn play(performance: Performance) -> Vec<Vec<Foot>> {
        let mut script = Script::new(vec![performance], Geometry::of_paper_tiles(10, 6).unwrap().bounds());
        let mut feet = Vec::new();
        let mut frames = Vec::new();
        for ms in 0.. {
            if !script.feet(Instant::from_millis(ms), &mut feet) {
                assert!(feet.is_empty());
                break;
            }
            frames.push(feet.clone());
        }
        frames
    }

    fn total(feet: &[Foot]) -> f32 {
        feet.iter().map(|foot| foot.force.0).sum()
    }

    fn body_centre_of_pressure(feet: &[Foot]) -> Vec2 {
        feet.iter().map(|foot| foot.centre_of_pressure() * foot.force.0).sum::<Vec2>() / total(feet)
    }

    /// Checks that no loaded foot moves, unless a move slides it.
    fn assert_no_slip(frames: &[Vec<Foot>]) {
        for pair in frames.windows(2) {
            for (before, after) in pair[0].iter().zip(&pair[1]) {
                if pair[0].len() == pair[1].len() && before.force.0 > 1.0 && after.force.0 > 1.0 {
                    assert!(
                        before.position.distance(after.position) < 1e-6,
                        "{before:?} slipped to {after:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn standing_people_sway_by_millimetres_and_weigh_what_they_weigh() {
        let mut person = standing_at(0.9, 0.9, 0.0);
        person.wait(Duration::from_secs(30));
        let frames = play(person);
        let places: Vec<Vec2> = frames.iter().map(|feet| body_centre_of_pressure(feet)).collect();
        let (low, high) = places.iter().fold((Vec2::MAX, Vec2::MIN), |(l, h), &p| (l.min(p), h.max(p)));
        let range = high - low;
        assert!(range.min_element() > 0.001 && range.max_element() < 0.02, "{range}");
        assert!(frames.iter().all(|feet| (total(feet) - 686.7).abs() < 0.5));
        assert_no_slip(&frames);
    }

    #[test]
    fn walkers_step_as_their_gait_says_and_arrive() {
        let mut person = standing_at(0.3, 0.9, EAST);
        person.walk(&[Vec2::new(1.6, 0.9)]).unwrap();
        person.wait(Duration::from_millis(300));
        let frames = play(person);
        assert_no_slip(&frames);
        // 1.3 m are two steps of 65 cm: the right foot, the left foot, and the right foot beside it.
        let last = frames.last().unwrap();
        let middle = (last[0].position + last[1].position) * 0.5;
        assert!(middle.distance(Vec2::new(1.6, 0.9)) < 0.03, "{middle}");
        assert!((last[0].position.y - last[1].position.y - 0.16).abs() < 1e-3, "{last:?}");
        // For a person facing east, the left foot is the northern one.
        assert!(last[0].left && !last[1].left, "{last:?}");
        for feet in &frames {
            let share = total(feet) / 686.7;
            assert!((0.6..1.35).contains(&share), "{share}");
        }
        let most = frames.iter().flatten().map(|foot| foot.force.0 / 686.7).fold(0.0, f32::max);
        assert!((1.05..1.15).contains(&most), "{most}");
    }

    #[test]
    fn a_foot_rolls_from_heel_to_toe_in_each_stance() {
        let mut person = standing_at(0.2, 0.9, EAST);
        person.walk(&[Vec2::new(2.3, 0.9)]).unwrap();
        let frames = play(person);
        // Three steps, the right foot first: the left foot makes the step in the middle of the walk.
        let landing = (1..frames.len())
            .find(|&k| frames[k - 1][0].force.0 <= 0.0 && frames[k][0].force.0 > 0.0)
            .unwrap();
        let stance: Vec<&Foot> =
            frames[landing..].iter().map(|feet| &feet[0]).take_while(|f| f.force.0 > 0.0).collect();
        assert!((600..720).contains(&stance.len()), "a stance takes about 0.65 s: {} ms", stance.len());
        assert!(stance[5].roll < 0.05 && stance[stance.len() - 5].roll > 0.95);
        assert!(stance.windows(2).all(|pair| pair[1].roll >= pair[0].roll));
    }

    #[test]
    fn a_press_puts_the_asked_force_on_the_asked_place_while_the_other_foot_stands() {
        let target = Vec2::new(1.1, 1.3);
        let mut person = standing_at(0.9, 0.9, 0.0);
        person.wait(Duration::from_millis(500));
        person.press(target, Newtons(120.0), Duration::from_millis(300)).unwrap();
        person.wait(Duration::from_millis(500));
        let frames = play(person);
        assert_no_slip(&frames);
        let pressing = |feet: &&Vec<Foot>| {
            feet[1].position.distance(frames[0][1].position) > 0.05 && feet[1].force.0 > 0.0
        };
        let pressed: Vec<_> = frames.iter().filter(pressing).collect();
        let held = pressed.iter().filter(|feet| (feet[1].force.0 - 120.0).abs() < 0.01).count();
        assert!((300..=305).contains(&held), "{held} ms");
        let rise = pressed.iter().take_while(|feet| feet[1].force.0 < 119.9).count();
        assert!((60..=120).contains(&rise), "{rise} ms");
        for feet in &pressed {
            assert!(feet[1].centre_of_pressure().distance(target) < 1e-4);
            assert_eq!(feet[0].position, frames[0][0].position);
            assert!((total(feet) - 686.7).abs() < 0.1, "{}", total(feet));
        }
        // Both feet are back in place.
        let last = frames.last().unwrap();
        assert!(last[1].position.distance(frames[0][1].position) < 1e-6);
        assert!((last[1].force.0 - 343.0).abs() < 30.0);
    }

    #[test]
    fn a_drag_slides_at_its_speed_under_its_force() {
        let (from, to) = (Vec2::new(0.8, 1.3), Vec2::new(1.1, 1.3));
        let mut person = standing_at(0.95, 0.95, 0.0);
        person.drag(Slide::Line { from, to }, 0.3, Newtons(80.0)).unwrap();
        let frames = play(person);
        let held: Vec<_> = frames
            .iter()
            .filter_map(|feet| feet.iter().find(|foot| (foot.force.0 - 80.0).abs() < 0.01))
            .collect();
        let first = held.first().unwrap().centre_of_pressure();
        let last = held.last().unwrap().centre_of_pressure();
        assert!(first.distance(from) < 1e-4 && last.distance(to) < 1e-4, "{first} to {last}");
        let speeds: Vec<f32> = held.windows(2).map(|p| p[0].position.distance(p[1].position) * 1e3).collect();
        let fastest = speeds.iter().copied().fold(0.0, f32::max);
        assert!((fastest - 0.3).abs() < 0.005, "{fastest}");
        // 1.0 s of sliding, 0.1 s of ramps, 0.15 s of rest at both ends.
        assert!((1390..1410).contains(&held.len()), "{}", held.len());
    }

    #[test]
    fn turning_on_the_spot_never_crosses_the_feet() {
        for turn in [0.4, -1.5, 3.0, -3.1] {
            let mut person = standing_at(0.9, 0.9, 0.2);
            person.turn(0.2 + turn).unwrap();
            let frames = play(person);
            assert_no_slip(&frames);
            for feet in &frames {
                let apart = feet[0].position.distance(feet[1].position);
                assert!(apart > 0.08, "turn of {turn}: {apart}");
                assert!((total(feet) - 686.7).abs() < 0.5);
            }
            let last = frames.last().unwrap();
            let facing = 0.5 * (last[0].heading + last[1].heading);
            assert!((facing - 0.2 - turn).abs() < 1e-3, "{facing}");
        }
    }

    #[test]
    fn impossible_moves_are_refused_and_change_nothing() {
        let hold = Duration::from_millis(100);
        let mut nobody = someone();
        assert_eq!(nobody.press(Vec2::ONE, Newtons(50.0), hold), Err(MoveError::NotThere));
        assert_eq!(nobody.walk(&[Vec2::ONE]), Err(MoveError::NotThere));
        let mut person = standing_at(0.9, 0.9, 0.0);
        let before = person.duration();
        assert_eq!(person.appear(Vec2::ONE, 0.0), Err(MoveError::AlreadyThere));
        let far = person.press(Vec2::new(1.8, 1.8), Newtons(50.0), hold);
        assert!(matches!(far, Err(MoveError::OutOfReach { .. })), "{far:?}");
        let own = person.press(Vec2::new(0.9, 0.9), Newtons(50.0), hold);
        assert!(matches!(own, Err(MoveError::Occupied { .. })), "between the feet: {own:?}");
        assert_eq!(person.press(Vec2::NAN, Newtons(50.0), hold), Err(MoveError::NotFinite));
        assert_eq!(person.walk(&[Vec2::new(1.0, f32::INFINITY)]), Err(MoveError::NotFinite));
        let heavy = person.press(Vec2::new(1.1, 1.2), Newtons(900.0), hold);
        assert!(matches!(heavy, Err(MoveError::TooHeavy { .. })), "{heavy:?}");
        assert_eq!(person.duration(), before);
    }

    #[test]
    fn somebody_outside_the_floor_has_no_feet_on_it() {
        let mut person = standing_at(-0.9, 0.9, EAST);
        person.wait(Duration::from_millis(200));
        person.walk(&[Vec2::new(0.9, 0.9)]).unwrap();
        person.walk(&[Vec2::new(4.0, 0.9)]).unwrap();
        person.disappear().unwrap();
        let frames = play(person);
        assert!(frames[0].is_empty() && frames.last().unwrap().is_empty());
        assert!(frames.iter().any(|feet| feet.len() == 2));
    }

    #[test]
    fn two_people_perform_together() {
        let mut other = standing_at(1.4, 1.4, 0.0);
        other.wait(Duration::from_secs(2));
        let cast = vec![standing_at(0.4, 0.4, 0.0), other];
        let both = Script::new(cast, Geometry::default().bounds());
        assert_eq!(both.duration(), Duration::from_secs(2));
        let mut feet = Vec::new();
        both.feet_at(Instant::from_millis(1000), &mut feet);
        assert_eq!(feet.len(), 4);
    }
}
