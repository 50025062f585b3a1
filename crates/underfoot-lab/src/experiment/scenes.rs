//! Accuracy of all contacts in scenes that are hard to sense, on floors with errors.

use std::fmt;

use serde::Serialize;

use super::METHODS;
use super::follow::{ContactMatcher, Followed, Truth};
use super::rig::{ExperimentError, Rig};
use underfoot::floor::Geometry;
use underfoot::units::Instant;
use underfoot_sim::{FloorQuality, Load, MoveError, PlayedScene, SceneKind};

/// Scenes of people and objects ([`SceneKind`]) on floors of several qualities, by method.
///
/// One person acts in every scene on a floor of each quality with parts drawn from the person's seed, after a second
/// on which the floor is empty. Feet, knees, wheels and sticks all count as feet: they are down from 10 N on,
/// as in [`super::PeopleTable`].
#[derive(Clone, Debug, PartialEq)]
pub struct SceneTable {
    floors: Vec<FloorQuality>,
    /// One entry per scene ([`SceneKind::ALL`]), floor and method ([`METHODS`]).
    scores: Vec<Vec<[Followed; 2]>>,
    /// Number of people in each scene.
    people: [u64; SceneKind::ALL.len()],
}

/// Interval between two samples of the errors (ms).
const SAMPLE_MS: u64 = 10;

/// Time that the floor is empty before each scene (ms).
const EMPTY_MS: u32 = 1000;

impl SceneTable {
    /// Creates an empty table of scenes on floors of these qualities.
    #[must_use]
    pub fn on(floors: &[FloorQuality]) -> Self {
        let none = vec![Default::default(); floors.len()];
        Self { floors: floors.to_vec(), scores: vec![none; SceneKind::ALL.len()], people: Default::default() }
    }

    /// Simulates the person drawn from `seed` in all scenes.
    ///
    /// # Errors
    /// Those of [`SceneTable::add_scene`].
    pub fn add_person(&mut self, seed: u64) -> Result<(), ExperimentError> {
        SceneKind::ALL.into_iter().try_for_each(|kind| self.add_scene(kind, seed))
    }

    /// Simulates the person drawn from `seed` in one scene on a floor of each quality.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`]; [`ExperimentError::Move`], which no seed should cause.
    pub fn add_scene(&mut self, kind: SceneKind, seed: u64) -> Result<(), ExperimentError> {
        let geometry = Geometry::default();
        let scene = scene(kind, seed, &geometry)?;
        let Some(row) = SceneKind::ALL.iter().position(|&other| other == kind) else { return Ok(()) };
        for (floor, scores) in self.floors.iter().zip(&mut self.scores[row]) {
            let mut rig = Rig::of_quality(geometry, *floor, seed)?;
            rig.hold(EMPTY_MS, &[], |_| {});
            play(&mut rig, &scene, scores);
        }
        self.people[row] += 1;
        Ok(())
    }

    /// Adds all people of another table with the same floors.
    pub fn append(&mut self, other: Self) {
        let scores = self.scores.iter_mut().flatten().flatten();
        for (score, others) in scores.zip(other.scores.into_iter().flatten().flatten()) {
            score.append(others);
        }
        for (people, others) in self.people.iter_mut().zip(other.people) {
            *people += others;
        }
    }

    /// Returns the result of one scene on one floor, by method ([`METHODS`]); `None` for a floor that is not in the
    /// table.
    #[must_use]
    pub fn score(&self, kind: SceneKind, floor: FloorQuality) -> Option<&[Followed; 2]> {
        let scene = SceneKind::ALL.iter().position(|&other| other == kind)?;
        let slot = self.floors.iter().position(|&other| other == floor)?;
        self.scores.get(scene)?.get(slot)
    }

    /// Returns all lines, for programs: scene by scene, the floors in their order, each method; all scenes together
    /// last.
    pub fn lines(&self) -> impl Iterator<Item = SceneLine> + '_ {
        SceneKind::ALL.into_iter().map(Some).chain([None]).flat_map(move |kind| self.lines_of(kind))
    }

    /// Returns the lines of one scene, or of all scenes together.
    fn lines_of(&self, kind: Option<SceneKind>) -> Vec<SceneLine> {
        let name = kind.map_or("all scenes", SceneKind::name);
        let mut lines = Vec::new();
        for (slot, floor) in self.floors.iter().enumerate() {
            let mut whole: [Followed; 2] = Default::default();
            for (row, scores) in SceneKind::ALL.into_iter().zip(&self.scores) {
                if kind.is_none_or(|kind| kind == row) {
                    let scores = scores.get(slot).into_iter().flatten();
                    whole.iter_mut().zip(scores).for_each(|(whole, score)| whole.append(score.clone()));
                }
            }
            let methods = METHODS.into_iter().zip(whole);
            lines.extend(methods.map(|((_, method), score)| SceneLine::of(name, *floor, method, score)));
        }
        lines
    }

    /// Returns the head of the table of this many people, with a line break at its end.
    #[must_use]
    pub fn heading(people: u64) -> String {
        format!(
            "everything that presses, {people} people of 20 to 140 kg in each scene on floors of 6 x 6 tiles\n\
             {:36}within 5 cm     error, cm{:28}changes per  inside  one foot\n\
             scene             quality   method     each    all  median    p95  missed   extra  steps  1000 steps    \
             95 %  ambiguous\n",
            "", ""
        )
    }

    /// Returns the rows of one scene, or those of all scenes together, for people: one per floor and method.
    #[must_use]
    pub fn rows(&self, kind: Option<SceneKind>) -> SceneRows {
        SceneRows(self.lines_of(kind))
    }
}

/// Rows of a [`SceneTable`], as text.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneRows(Vec<SceneLine>);

/// The scene of one person: each kind draws independently from the person's seed.
fn scene(kind: SceneKind, seed: u64, geometry: &Geometry) -> Result<PlayedScene, MoveError> {
    PlayedScene::of(kind, seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ kind as u64, geometry)
}

fn play(rig: &mut Rig, scene: &PlayedScene, scores: &mut [Followed; 2]) {
    let mut methods = METHODS.map(|(method, _)| (rig.sensing(method), ContactMatcher::default()));
    let (mut loads, mut truth) = (Vec::<Load>::new(), Vec::<Truth>::new());
    for milli in 1..=scene.duration().as_millis() as u64 {
        loads.clear();
        scene.loads_at(Instant::from_millis(milli), &mut loads);
        truth.clear();
        truth.extend(loads.iter().filter_map(|load| Truth::of(load, rig)));
        rig.step(loads.iter().copied(), |frame| {
            for ((sensing, follower), score) in methods.iter_mut().zip(scores.iter_mut()) {
                let contacts = sensing.update(frame);
                follower.compare(&truth, contacts, milli.is_multiple_of(SAMPLE_MS), score);
            }
        });
    }
}

/// One line of a [`SceneTable`]; shares are 0 to 1, and `None` without a sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneLine {
    /// Name of the scene, or `all scenes`.
    pub scene: &'static str,
    /// Quality of the floors.
    pub floor: &'static str,
    /// Method of computing contacts.
    pub method: &'static str,
    /// Number of feet to find: one per foot that is down in a sample of 10 ms.
    pub feet: usize,
    /// Share of feet found within 5 cm.
    pub within_5cm: f32,
    /// Share of samples with several feet down in which all were found within 5 cm.
    pub all_within_5cm: Option<f32>,
    /// Median error of the found feet, in centimetres.
    pub median_cm: Option<f32>,
    /// 95th percentile of the error of the found feet, in centimetres.
    pub p95_cm: Option<f32>,
    /// Share of feet without a contact within a shoe's length.
    pub missed: f32,
    /// Number of contacts without a foot, as a share of the feet.
    pub extra: f32,
    /// Number of touchdowns.
    pub steps: usize,
    /// Changes of a foot's identity per 1000 touchdowns.
    pub changes_per_1000_steps: Option<f32>,
    /// Share of found feet with the true position inside the 95 % ellipse.
    pub inside_95: Option<f32>,
    /// Share of the time of one foot alone in which its contact was ambiguous.
    pub ambiguous: Option<f32>,
}

impl SceneLine {
    fn of(scene: &'static str, floor: FloorQuality, method: &'static str, score: Followed) -> Self {
        let some = |of: usize, share: f32| (of > 0).then_some(share);
        let (all_within_5cm, ambiguous) = (
            some(score.several, score.share_all_within_5cm()),
            some(score.one_foot.count(), score.share_ambiguous()),
        );
        let (feet, missed, extra) = (score.feet, score.share_missed(), score.share_extra());
        let (steps, changes) = (score.steps, score.swaps_per_1000_steps());
        let (inside, within_5cm) = (score.inside[0] + score.inside[1], score.share_of_all_within_5cm());
        let mut errors = score.one_foot;
        errors.append(score.two_feet);
        let found = errors.count();
        let cm = |share| errors.quantile(share).map(|error| 100.0 * error);
        Self {
            scene,
            floor: floor.name(),
            method,
            feet,
            within_5cm,
            all_within_5cm,
            median_cm: cm(0.5),
            p95_cm: cm(0.95),
            missed,
            extra,
            steps,
            changes_per_1000_steps: changes,
            inside_95: some(found, inside as f32 / found.max(1) as f32),
            ambiguous,
        }
    }
}

impl fmt::Display for SceneTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&Self::heading(self.people.into_iter().max().unwrap_or_default()))?;
        for kind in SceneKind::ALL {
            writeln!(f, "{}", self.rows(Some(kind)))?;
        }
        write!(f, "{}", self.rows(None))
    }
}

impl fmt::Display for SceneRows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent =
            |share: Option<f32>| share.map_or_else(|| "-".into(), |share| format!("{:.1}%", 100.0 * share));
        let plain = |value: Option<f32>| value.map_or_else(|| "-".into(), |value| format!("{value:.1}"));
        for (number, line) in self.0.iter().enumerate() {
            writeln!(
                f,
                "{:18}{:10}{:8}{:>7}{:>7}{:>8}{:>7}{:>7.2}%{:>7.2}%{:>7}{:>12}{:>8}{:>11}",
                if number > 0 { "" } else { line.scene },
                line.floor,
                line.method,
                percent(Some(line.within_5cm)),
                percent(line.all_within_5cm),
                plain(line.median_cm),
                plain(line.p95_cm),
                100.0 * line.missed,
                100.0 * line.extra,
                line.steps,
                plain(line.changes_per_1000_steps),
                percent(line.inside_95),
                percent(line.ambiguous),
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_line_for_each_floor_and_method_and_the_sum_of_all() {
        let floors = [FloorQuality::Ideal, FloorQuality::Severe];
        let mut table = SceneTable::on(&floors);
        table.add_person(5).unwrap();
        let lines: Vec<SceneLine> = table.lines().collect();
        assert_eq!(lines.len(), (SceneKind::ALL.len() + 1) * 2 * 2);
        assert!(lines.iter().all(|line| line.feet > 50 && line.steps > 0), "{table}");
        for slot in 0..4 {
            let scenes = lines.iter().skip(slot).step_by(4).take(SceneKind::ALL.len());
            let whole = lines.get(4 * SceneKind::ALL.len() + slot).unwrap();
            assert_eq!(whole.feet, scenes.map(|line| line.feet).sum::<usize>());
        }
        let standing = table.score(SceneKind::Press, FloorQuality::Ideal).unwrap();
        assert!(standing[0].share_missed() < 0.6);
        assert!(table.score(SceneKind::Press, FloorQuality::Paper).is_none());
    }

    #[test]
    fn tables_of_two_people_add_up_in_any_order_and_repeat() {
        let one = |seed| {
            let mut table = SceneTable::on(&[FloorQuality::Moderate]);
            table.add_person(seed).unwrap();
            table
        };
        let (first, second) = (one(1), one(2));
        let (mut both, mut other) = (first.clone(), second.clone());
        both.append(second.clone());
        other.append(first.clone());
        assert_eq!(both.to_string(), other.to_string());
        assert_ne!(both.to_string(), first.to_string());
        assert_eq!(second, one(2));
    }
}
