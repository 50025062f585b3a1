//! People in scenes.

use std::f32::consts::TAU;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::footwear::Footwear;
use crate::performance::Performance;
use crate::person::Person;
use crate::rolling::RollingHabit;
use underfoot::floor::Rect;

/// A person drawn from a seed, from a child of 20 kg to an adult of 140 kg.
#[derive(Clone, Debug)]
pub struct RandomPerson {
    person: Person,
    pub(super) habit: RollingHabit,
    pub(super) rng: Pcg64Mcg,
    seed: u64,
}

/// Mass and usual foot length: children of 6, adults of usual weight, heavy adults.
///
/// # Source
/// Our assumption from shoe sizes: 18 cm at 20 kg (six years), 26 cm at 70 kg; heavy people's feet are
/// hardly longer.
const FEET_M: [(f32, f32); 4] = [(20.0, 0.18), (45.0, 0.235), (75.0, 0.262), (140.0, 0.285)];

impl RandomPerson {
    /// Draws a person from a seed. Masses are spread evenly over their logarithm, so that one in five weighs less
    /// than 30 kg and one in four more than 86. People of 45 to 90 kg wear heels one time in four; the others wear
    /// shoes, boots or nothing.
    #[must_use]
    pub fn of(seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x0b0d_1e55);
        let mass_kg = 20.0 * 7.0f32.powf(rng.random_range(0.0..1.0));
        let usual = FEET_M.windows(2).find(|pair| mass_kg <= pair[1].0).map_or(0.285, |pair| {
            let share = (mass_kg - pair[0].0) / (pair[1].0 - pair[0].0);
            pair[0].1 + share * (pair[1].1 - pair[0].1)
        });
        let foot_length_m = usual * rng.random_range(0.94..1.06);
        let heels = (45.0..90.0).contains(&mass_kg) && rng.random_bool(0.25);
        let flat = [Footwear::Shoes, Footwear::Shoes, Footwear::Barefoot, Footwear::Boots];
        let footwear = if heels { Footwear::Heels } else { flat[rng.random_range(0..flat.len())] };
        let size = foot_length_m / 0.26;
        let person = Person {
            mass_kg,
            foot_length_m,
            speed_m_s: rng.random_range(0.8..1.8) * size.sqrt(),
            step_width_m: rng.random_range(0.10..0.16) * size,
            stand_width_m: rng.random_range(0.15..0.35) * size.max(0.8),
            reach_m: 0.85 * size,
            footwear,
            ..Person::default()
        };
        let habit = RollingHabit::new(rng.random());
        Self { person, habit, rng, seed }
    }

    /// Returns the person's measures.
    #[must_use]
    pub const fn person(&self) -> &Person {
        &self.person
    }

    /// Weight in newtons.
    pub(super) fn weight_n(&self) -> f32 {
        self.person.weight().0
    }

    /// A performance of the same person, for walking.
    pub(super) fn performance(&mut self) -> Performance {
        let seed = self.rng.random();
        Performance::new(self.person, seed).rolling_as_people_do(self.seed)
    }

    pub(super) fn within(&mut self, low: f32, high: f32) -> f32 {
        self.rng.random_range(low..high)
    }

    pub(super) fn normal(&mut self) -> f32 {
        StandardNormal.sample(&mut self.rng)
    }

    pub(super) fn sign(&mut self) -> f32 {
        if self.rng.random_bool(0.5) { 1.0 } else { -1.0 }
    }

    pub(super) fn angle(&mut self) -> f32 {
        self.within(0.0, TAU)
    }

    /// A place on the floor at least `margin_m` from its edges, or the floor's centre if there is none.
    pub(super) fn place(&mut self, bounds: Rect, margin_m: f32) -> Vec2 {
        let inner = bounds.grown(-margin_m);
        if inner.size().min_element() <= 0.0 {
            return bounds.centre();
        }
        inner.min + inner.size() * Vec2::new(self.within(0.0, 1.0), self.within(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_are_children_and_heavy_and_wear_everything() {
        let people: Vec<Person> = (0..400).map(|seed| *RandomPerson::of(seed).person()).collect();
        let share =
            |holds: fn(&Person) -> bool| people.iter().filter(|person| holds(person)).count() as f32 / 400.0;
        assert!((0.12..0.3).contains(&share(|person| person.mass_kg < 30.0)));
        assert!((0.12..0.3).contains(&share(|person| person.mass_kg > 95.0)));
        for footwear in Footwear::ALL {
            let wearing = people.iter().filter(|person| person.footwear == footwear).count();
            assert!(wearing > 20, "{footwear:?}: {wearing}");
        }
        assert!(people.iter().all(|person| (20.0..=140.0).contains(&person.mass_kg)));
        assert!(people.iter().all(|person| (0.16..0.31).contains(&person.foot_length_m)));
    }
}
