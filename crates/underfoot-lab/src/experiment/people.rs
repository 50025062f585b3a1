//! Accuracy of both feet of walking, turning and standing people.

use std::f32::consts::{PI, TAU};
use std::fmt;
use std::time::Duration;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::METHODS;
use super::errors::Summary;
use super::follow::{ContactMatcher, Followed, Truth};
use super::rig::{ExperimentError, FaultHook, Rig};
use underfoot::floor::Geometry;
use underfoot::units::Instant;
use underfoot_sim::{FloorQuality, Load, MoveError, Performance, Person, Script};

/// Activity of a person at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Activity {
    /// Walking at 0.8 to 1.8 m/s, onto the floor, over it and off it.
    Walking,
    /// Turning on the spot, by small steps.
    Turning,
    /// Standing with the feet 15 to 60 cm apart, swaying.
    Standing,
}

impl Activity {
    /// All activities, in the order of the table.
    pub const ALL: [Self; 3] = [Self::Walking, Self::Turning, Self::Standing];

    const fn name(self) -> &'static str {
        match self {
            Self::Walking => "walking",
            Self::Turning => "turning",
            Self::Standing => "standing",
        }
    }
}

/// A person drawn from a seed, and the person's visit to a 6 x 6 floor.
#[derive(Clone, Debug)]
pub struct DrawnVisit {
    person: Person,
    script: Script,
    /// End of each activity, in order.
    parts: Vec<(Duration, Activity)>,
}

impl DrawnVisit {
    /// Draws a person of 45 to 120 kg with feet of 22 to 30 cm, who walks at 0.8 to 1.8 m/s and stands with the feet
    /// 15 to 60 cm apart: onto the floor, turning there, to another place and off again.
    ///
    /// # Errors
    /// [`ExperimentError::Move`], which no seed should cause.
    pub fn of(seed: u64, geometry: &Geometry) -> Result<Self, ExperimentError> {
        Self::made_up(seed, geometry, false)
    }

    /// The same visit by a person with feet that roll like those of recorded people.
    ///
    /// # Errors
    /// The same as [`DrawnVisit::of`].
    pub fn rolling_as_people_do(seed: u64, geometry: &Geometry) -> Result<Self, ExperimentError> {
        Self::made_up(seed, geometry, true)
    }

    fn made_up(seed: u64, geometry: &Geometry, rolling: bool) -> Result<Self, ExperimentError> {
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x7e09_1e55);
        let person = Person {
            mass_kg: rng.random_range(45.0..120.0),
            foot_length_m: rng.random_range(0.22..0.30),
            speed_m_s: rng.random_range(0.8..1.8),
            step_width_m: rng.random_range(0.08..0.16),
            stand_width_m: rng.random_range(0.15..0.60),
            toe_out: rng.random_range(0.0..0.2),
            ..Person::default()
        };
        let mut performance = Performance::new(person, seed);
        if rolling {
            performance = performance.rolling_as_people_do(seed);
        }
        let mut parts = Parts { performance, ends: Vec::new() };
        // Far enough inside that both feet of a wide stance are on the floor.
        let bounds = geometry.bounds();
        let inner = bounds.grown(-0.45);
        let mut place =
            || inner.min + inner.size() * Vec2::new(rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
        let (first, second) = (place(), place());
        let outside = |angle: f32| bounds.centre() + Vec2::from_angle(angle) * (bounds.size().length());
        let (from, to) = (outside(rng.random_range(0.0..TAU)), outside(rng.random_range(0.0..TAU)));
        let turns = [(); 2].map(|()| rng.random_range(0.5..2.8) * [-1.0, 1.0][rng.random_range(0..2_usize)]);

        let heading = |way: Vec2| way.to_angle() - 0.5 * PI;
        let mut facing = heading(first - from);
        parts.performance.appear(from, facing)?;
        parts.does(Activity::Standing, |person| {
            person.wait(Duration::from_millis(200));
            Ok(())
        })?;
        for (goal, turn) in [(first, turns[0]), (second, turns[1])] {
            let way = goal - parts.performance.place().unwrap_or(goal);
            facing = if way.length() > 0.02 { heading(way) } else { facing };
            parts.does(Activity::Walking, |person| person.walk(&[goal]))?;
            parts.does(Activity::Standing, |person| {
                person.wait(Duration::from_millis(1500));
                Ok(())
            })?;
            facing += turn;
            parts.does(Activity::Turning, |person| person.turn(facing))?;
            parts.does(Activity::Standing, |person| {
                person.wait(Duration::from_millis(1000));
                Ok(())
            })?;
        }
        parts.does(Activity::Walking, |person| person.walk(&[to]))?;
        Ok(Self { person, script: Script::new(vec![parts.performance], bounds), parts: parts.ends })
    }

    /// Returns the person.
    #[must_use]
    pub const fn person(&self) -> &Person {
        &self.person
    }

    /// Returns the script of the feet.
    #[must_use]
    pub const fn script(&self) -> &Script {
        &self.script
    }

    fn activity(&self, at: Duration) -> Activity {
        let part = self.parts.partition_point(|(end, _)| *end <= at);
        self.parts.get(part).map_or(Activity::Standing, |(_, activity)| *activity)
    }
}

struct Parts {
    performance: Performance,
    ends: Vec<(Duration, Activity)>,
}

impl Parts {
    fn does(
        &mut self,
        activity: Activity,
        act: impl FnOnce(&mut Performance) -> Result<(), MoveError>,
    ) -> Result<(), MoveError> {
        act(&mut self.performance)?;
        self.ends.push((self.performance.duration(), activity));
        Ok(())
    }
}

/// Accuracy of people's feet on the paper's 6 x 6 floor, by method and activity.
///
/// Every person is alone on the floor, and every floor has its own parts.
#[derive(Clone, Debug, PartialEq)]
pub struct PeopleTable {
    /// One entry per method ([`METHODS`]) and activity ([`Activity::ALL`]).
    pub scores: [[Followed; 3]; 2],
    floor: FloorQuality,
    people: usize,
}

/// A table for the paper's floor.
impl Default for PeopleTable {
    fn default() -> Self {
        Self::on(FloorQuality::Paper)
    }
}

/// Interval between two samples of the errors (ms).
const SAMPLE_MS: u64 = 10;

impl PeopleTable {
    /// Creates an empty table for floors of this quality. On floors with real errors ([`FloorQuality::REAL`]), feet
    /// roll like those of recorded people.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        Self { scores: Default::default(), floor, people: 0 }
    }

    /// Simulates the person drawn from `seed` on a floor with parts drawn from `seed` too.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`] and [`DrawnVisit::of`].
    pub fn add_person(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let mut rig = Rig::of_quality(Geometry::default(), self.floor, seed)?;
        let visit = DrawnVisit::made_up(seed, rig.geometry(), self.floor.is_real())?;
        self.add_visit(&mut rig, &visit, &mut ());
        Ok(())
    }

    /// Simulates `visit` on the floor of `rig`, with the faults of `fault`.
    pub fn add_visit(&mut self, rig: &mut Rig, visit: &DrawnVisit, fault: &mut impl FaultHook) {
        let mut methods = METHODS.map(|(method, _)| (rig.sensing(method), ContactMatcher::default()));
        let mut loads: Vec<Load> = Vec::new();
        let mut truth: Vec<Truth> = Vec::new();
        let scores = &mut self.scores;
        for milli in 1..=visit.script.duration().as_millis() as u64 {
            let at = Duration::from_millis(milli);
            loads.clear();
            visit.script.loads_at(Instant::START + at, &mut loads);
            truth.clear();
            truth.extend(loads.iter().filter_map(|load| Truth::of(load, rig)));
            let activity = visit.activity(at) as usize;
            rig.step_with(fault, milli, loads.iter().copied(), |frame| {
                for ((sensing, follower), scores) in methods.iter_mut().zip(scores.iter_mut()) {
                    let contacts = sensing.update(frame);
                    follower.compare(
                        &truth,
                        contacts,
                        milli.is_multiple_of(SAMPLE_MS),
                        &mut scores[activity],
                    );
                }
            });
        }
        self.people += 1;
    }

    /// Adds all people of another table.
    pub fn append(&mut self, other: Self) {
        for (score, others) in self.scores.iter_mut().flatten().zip(other.scores.into_iter().flatten()) {
            score.append(others);
        }
        self.people += other.people;
    }

    /// Returns the sum over all activities of one method: 0 for Eq. 4, 1 for the tracker.
    #[must_use]
    pub fn whole(&self, method: usize) -> Followed {
        let mut whole = Followed::default();
        self.scores.get(method).into_iter().flatten().for_each(|score| whole.append(score.clone()));
        whole
    }

    /// Names of method and activity, and the score, line by line.
    fn named(&self) -> impl Iterator<Item = (&'static str, &'static str, Followed)> + '_ {
        let names = Activity::ALL.map(Activity::name);
        METHODS.into_iter().enumerate().flat_map(move |(method, (_, name))| {
            let parts = names.into_iter().zip(self.scores[method].iter().cloned());
            parts
                .chain(std::iter::once(("all", self.whole(method))))
                .map(move |(part, score)| (name, part, score))
        })
    }

    /// Returns all lines, for programs.
    pub fn lines(&self) -> impl Iterator<Item = PeopleLine> + '_ {
        self.named().map(|(method, activity, score)| PeopleLine {
            method,
            activity,
            one_foot: score.one_foot.summary(),
            two_feet: score.two_feet.summary(),
            within_5cm: score.share_within_5cm(),
            missed: score.share_missed(),
            extra: score.share_extra(),
            steps: score.steps,
            swaps_per_1000_steps: score.swaps_per_1000_steps(),
        })
    }
}

/// One line of a [`PeopleTable`], for programs; shares are 0 to 1.
#[derive(Debug, Serialize)]
pub struct PeopleLine {
    method: &'static str,
    activity: &'static str,
    one_foot: Option<Summary>,
    two_feet: Option<Summary>,
    within_5cm: f32,
    missed: f32,
    extra: f32,
    steps: usize,
    swaps_per_1000_steps: Option<f32>,
}

impl fmt::Display for PeopleTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "error of each foot's centre of pressure, {} people on a floor of 6 x 6 tiles{}, cm",
            self.people,
            quality_note(self.floor)
        )?;
        writeln!(
            f,
            "                   one foot down           both feet down          within  missed   extra          swaps per"
        )?;
        writeln!(
            f,
            "method  doing      median     p95   worst  median     p95   worst    5 cm       %       %   steps  1000 steps"
        )?;
        for (method, activity, score) in self.named() {
            let Followed { one_foot, two_feet, steps, .. } = &score;
            let [within, missed, extra] =
                [score.share_within_5cm(), score.share_missed(), score.share_extra()]
                    .map(|share| 100.0 * share);
            writeln!(
                f,
                "{method:8}{activity:9}{one_foot}{two_feet}{within:7.1}%{missed:8.2}{extra:8.2}{steps:8}{:>12}",
                score.swaps_per_1000_steps().map_or_else(|| "-".into(), |swaps| format!("{swaps:.1}"))
            )?;
        }
        Ok(())
    }
}

/// Note on the floor in a table's heading; empty for the paper's floor.
pub(super) fn quality_note(floor: FloorQuality) -> String {
    if floor == FloorQuality::Paper { String::new() } else { format!(" ({floor})") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_come_stand_on_the_floor_and_leave() {
        let geometry = Geometry::default();
        for seed in 0..40 {
            let visit = DrawnVisit::of(seed, &geometry).unwrap();
            let end = visit.script.duration().as_millis() as u64;
            let mut both = 0;
            let mut feet = Vec::new();
            for milli in (0..end).step_by(10) {
                feet.clear();
                visit.script.feet_at(Instant::from_millis(milli), &mut feet);
                let down = feet.iter().filter(|foot| foot.force.0 > 10.0);
                let on = down.filter(|foot| geometry.bounds().grown(-0.1).contains(foot.position)).count();
                both += usize::from(on == 2);
                assert!(
                    (10..end - 1000).contains(&milli) || on == 0,
                    "seed {seed}: on the floor at {milli} ms"
                );
            }
            assert!(both > 400, "seed {seed}: both feet on the floor for {both} x 10 ms");
        }
    }

    #[test]
    fn people_are_as_different_as_the_table_says() {
        let people: Vec<Person> =
            (0..200).map(|seed| *DrawnVisit::of(seed, &Geometry::default()).unwrap().person()).collect();
        let range = |measure: fn(&Person) -> f32| {
            people.iter().map(measure).fold((f32::MAX, f32::MIN), |(low, high), m| (low.min(m), high.max(m)))
        };
        let spans = |(low, high): (f32, f32), from: f32, to: f32| {
            let slack = 0.05 * (to - from);
            (from..from + slack).contains(&low) && (to - slack..=to).contains(&high)
        };
        assert!(spans(range(|person| person.mass_kg), 45.0, 120.0));
        assert!(spans(range(|person| person.foot_length_m), 0.22, 0.30));
        assert!(spans(range(|person| person.stand_width_m), 0.15, 0.60));
        assert!(spans(range(|person| person.speed_m_s), 0.8, 1.8));
    }

    #[test]
    fn activities_follow_each_other() {
        let visit = DrawnVisit::of(4, &Geometry::default()).unwrap();
        let end = visit.script.duration();
        let mut doing: Vec<Activity> =
            (0..end.as_millis() as u64).map(|ms| visit.activity(Duration::from_millis(ms))).collect();
        doing.dedup();
        use Activity::{Standing as S, Turning as T, Walking as W};
        assert_eq!(doing, [S, W, S, T, S, W, S, T, S, W]);
    }
}
