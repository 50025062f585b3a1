//! A person who calibrates a floor by standing on marks.

use std::time::Duration;

use glam::Vec2;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::performance::Performance;
use super::person::{MoveError, Person};
use super::sensor::normal;
use underfoot::sense::StandingMark;

/// How well a person stands on marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingHabit {
    /// Standard deviation of the feet's distance from a mark along each axis (m).
    pub miss_m: f32,
    /// Standard deviation of the direction (rad).
    pub turn_rad: f32,
    /// Distance of the body's centre of pressure from where it usually is between the feet, to the right and
    /// forwards (m).
    pub lean_m: Vec2,
}

impl Default for StandingHabit {
    /// A centimetre and five degrees from the mark; a body that leans 1.5 cm forwards (our choice).
    fn default() -> Self {
        Self { miss_m: 0.01, turn_rad: 0.09, lean_m: Vec2::new(0.0, 0.015) }
    }
}

/// Time without a person at the beginning, for the readings of the empty floor.
const EMPTY: Duration = Duration::from_secs(2);

/// Time on a mark: a second until the stand counts as still, two to measure, and one to notice the end.
const STAND: Duration = Duration::from_millis(4200);

/// Returns the performance of a person who stands on `marks` in their order, with the feet together, from two seconds
/// after the start; `seed` determines the sway and the misses.
///
/// # Errors
/// [`MoveError::NotFinite`] for a mark that is not finite.
pub fn standing_on(
    marks: &[StandingMark],
    person: Person,
    habit: StandingHabit,
    seed: u64,
) -> Result<Performance, MoveError> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x57a2_d157);
    let mut performance = Performance::new(person, seed).rolling_as_people_do(seed);
    performance.wait(EMPTY);
    for mark in marks {
        let facing = mark.facing + habit.turn_rad * normal(&mut rng);
        let miss = habit.miss_m * Vec2::new(normal(&mut rng), normal(&mut rng));
        let at = mark.at + Vec2::from_angle(mark.facing).rotate(habit.lean_m) + miss;
        if performance.place().is_some() {
            performance.sidestep(at)?;
            performance.turn(facing)?;
        } else {
            performance.appear(at, facing)?;
        }
        performance.wait(STAND);
    }
    Ok(performance)
}
