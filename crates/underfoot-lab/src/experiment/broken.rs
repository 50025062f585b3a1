//! Walks over one broken sensor: places of the feet, the time until the fault is found, and sound sensors accused.

use std::fmt;

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::follow::{ContactMatcher, Followed, Truth};
use super::rig::{ExperimentError, FaultHook, Rig};
use underfoot::floor::{Corner, Geometry, SensorId, TileId};
use underfoot::sense::Method;
use underfoot::units::{Instant, Newtons};
use underfoot_sim::{FloorQuality, Load, PlayedScene, SceneKind, SensorFault};

/// Walks over a sensor under the tile that bears most, broken in several ways, and over the same floor without fault.
///
/// One person walks over the floor several times; the sensor breaks after the first walk, in which nothing counts, and
/// stays broken. Its corner of the tile is drawn from the person's seed. Sensors that are broken on floors of this
/// quality anyway ([`FloorQuality::broken`]) are not sound: a report of one of them is right, and not counted.
#[derive(Clone, Debug, PartialEq)]
pub struct BrokenTable {
    floor: FloorQuality,
    /// One entry for each of [`SensorBreak::ALL`].
    scores: [BrokenScore; SensorBreak::ALL.len()],
}

/// How a sensor breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorBreak {
    /// Not at all.
    None,
    /// Its line opens: no force.
    Dead,
    /// Its reading stays where it is.
    Stuck,
    /// An additional force grows by [`DRIFT_N_S`] up to [`DRIFT_MOST_N`].
    Drifts,
    /// Noise of [`NOISE_N`], normally distributed and new in each millisecond.
    Noisy,
}

impl SensorBreak {
    /// All kinds, in the order of tables.
    pub const ALL: [Self; 5] = [Self::None, Self::Dead, Self::Stuck, Self::Drifts, Self::Noisy];

    /// Returns the name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Dead => "dead",
            Self::Stuck => "stuck",
            Self::Drifts => "drifts",
            Self::Noisy => "noisy",
        }
    }

    /// Returns the fault `since_s` seconds after the sensor broke.
    fn fault(self, since_s: f32, rng: &mut Pcg64Mcg) -> Option<SensorFault> {
        Some(match self {
            Self::None => return None,
            Self::Dead => SensorFault::Open,
            Self::Stuck => SensorFault::Stuck,
            Self::Drifts => SensorFault::Offset(Newtons((DRIFT_N_S * since_s).min(DRIFT_MOST_N))),
            Self::Noisy => SensorFault::Offset(Newtons(NOISE_N * noise(rng))),
        })
    }
}

/// Rate at which a drifting sensor's force grows (N/s): water on a board (our choice).
pub const DRIFT_N_S: f32 = 1.0;

/// Maximum additional force of a drifting sensor (N) (our choice).
pub const DRIFT_MOST_N: f32 = 40.0;

/// Standard deviation of a noisy sensor (N): a loose shield (our choice).
pub const NOISE_N: f32 = 10.0;

/// Number of walks of each person, the first one over a sound sensor.
const WALKS: u64 = 6;

/// Time that the floor is empty before the first walk, and between two walks (ms).
const EMPTY_MS: u64 = 1000;

/// Interval between two samples of the errors (ms).
const SAMPLE_MS: u64 = 10;

/// Results of one kind of break.
#[derive(Clone, Debug, Default, PartialEq)]
struct BrokenScore {
    feet: Followed,
    /// Time from the break to the first report of the sensor (s), of each floor that reported it.
    found_s: Vec<f32>,
    floors: u64,
    /// Number of times that a sound sensor was reported, and the time watched (s).
    accused: u64,
    watched_s: f64,
}

impl BrokenTable {
    /// Creates an empty table for floors of this quality.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        Self { floor, scores: Default::default() }
    }

    /// Simulates the person drawn from `seed` on floors with parts drawn from `seed` too: one for each kind of break.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`]; [`ExperimentError::Move`], which no seed should cause.
    pub fn add_person(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let geometry = Geometry::default();
        let walks = (0..WALKS).map(|walk| {
            let drawn = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (walk << 8);
            PlayedScene::of(SceneKind::Walking, drawn, &geometry)
        });
        let walks = walks.collect::<Result<Vec<_>, _>>()?;
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0xb20c_e400);
        let whole = Rig::of_quality(geometry, self.floor, seed)?;
        let sensor = SensorId { tile: busiest(&whole, &walks), corner: Corner::ALL[rng.random_range(0..4)] };
        let worn: Vec<_> = self.floor.broken(&geometry, seed).into_iter().map(|(sensor, _)| sensor).collect();
        for (kind, score) in SensorBreak::ALL.into_iter().zip(&mut self.scores) {
            let breaks = Breaks { kind, sensor, worn: worn.clone(), at_ms: None, rng: rng.clone() };
            walk(whole.clone(), breaks, &walks, score);
        }
        Ok(())
    }

    /// Adds all people of another table.
    pub fn append(&mut self, other: Self) {
        for (score, other) in self.scores.iter_mut().zip(other.scores) {
            score.feet.append(other.feet);
            score.found_s.extend(other.found_s);
            score.floors += other.floors;
            score.accused += other.accused;
            score.watched_s += other.watched_s;
        }
    }

    /// Returns all lines, for programs: one for each of [`SensorBreak::ALL`].
    pub fn lines(&self) -> impl Iterator<Item = BrokenLine> + '_ {
        SensorBreak::ALL.into_iter().zip(&self.scores).map(|(kind, score)| score.line(kind))
    }
}

fn noise(rng: &mut Pcg64Mcg) -> f32 {
    StandardNormal.sample(rng)
}

/// The tile that bears most over all `walks`.
fn busiest(rig: &Rig, walks: &[PlayedScene]) -> TileId {
    let geometry = rig.geometry();
    let mut borne = vec![0.0; geometry.tile_count()];
    let mut loads = Vec::new();
    for walk in walks {
        for milli in (0..walk.duration().as_millis() as u64).step_by(20) {
            loads.clear();
            walk.loads_at(Instant::from_millis(milli), &mut loads);
            loads
                .iter()
                .flat_map(|load| rig.carried(load))
                .for_each(|tile| borne[tile.index] += tile.force.0);
        }
    }
    let most = (0..borne.len()).max_by(|&a, &b| borne[a].total_cmp(&borne[b]));
    geometry.tile_at_index(most.unwrap_or_default())
}

/// Breaks a sensor from the start of the second walk on.
struct Breaks {
    kind: SensorBreak,
    sensor: SensorId,
    /// The sensors that are broken from the beginning.
    worn: Vec<SensorId>,
    /// Millisecond of the break, once it has happened.
    at_ms: Option<u64>,
    rng: Pcg64Mcg,
}

impl FaultHook for Breaks {
    fn before(&mut self, milli: u64, rig: &mut Rig) {
        let Some(at_ms) = self.at_ms else { return };
        let since_s = (milli - at_ms) as f32 * 1e-3;
        // A reading sticks once.
        if self.kind != SensorBreak::Stuck || milli == at_ms {
            rig.set_fault(self.sensor, self.kind.fault(since_s, &mut self.rng));
        }
    }
}

/// Reports of the sensors of one floor.
#[derive(Default)]
struct Reports {
    /// Sound sensors that are reported now.
    accused: Vec<SensorId>,
    found_ms: Option<u64>,
    accusations: u64,
}

impl Reports {
    /// Notes the reports at this millisecond.
    fn note(&mut self, milli: u64, rig: &Rig, breaks: &Breaks) {
        let before = std::mem::take(&mut self.accused);
        for (sensor, _) in rig.assembler().troubles() {
            if sensor == breaks.sensor && breaks.kind != SensorBreak::None {
                self.found_ms.get_or_insert(milli);
            } else if !breaks.worn.contains(&sensor) {
                self.accusations += u64::from(!before.contains(&sensor));
                self.accused.push(sensor);
            }
        }
    }
}

/// The person walks over the floor, again and again, and its sensor breaks after the first walk.
fn walk(mut rig: Rig, mut breaks: Breaks, walks: &[PlayedScene], score: &mut BrokenScore) {
    let (mut sensing, mut matcher) = (rig.sensing(Method::Tracker), ContactMatcher::default());
    let (mut loads, mut truth) = (Vec::<Load>::new(), Vec::<Truth>::new());
    let (mut reports, mut unscored, mut milli) = (Reports::default(), Followed::default(), 0);
    for (number, walk) in walks.iter().enumerate() {
        if number == 1 {
            breaks.at_ms = Some(milli + 1);
            reports = Reports::default();
        }
        let feet = if number > 0 { &mut score.feet } else { &mut unscored };
        for since_ms in 0..EMPTY_MS + walk.duration().as_millis() as u64 {
            milli += 1;
            loads.clear();
            if let Some(walked_ms) = since_ms.checked_sub(EMPTY_MS) {
                walk.loads_at(Instant::from_millis(walked_ms), &mut loads);
            }
            truth.clear();
            truth.extend(loads.iter().filter_map(|load| Truth::of(load, &rig)));
            let sampled = milli.is_multiple_of(SAMPLE_MS);
            rig.step_with(&mut breaks, milli, loads.iter().copied(), |frame| {
                matcher.compare(&truth, sensing.update(frame), sampled, feet);
            });
            if sampled {
                reports.note(milli, &rig, &breaks);
            }
        }
    }
    let broke_ms = breaks.at_ms.unwrap_or(milli);
    score.floors += 1;
    score.found_s.extend(reports.found_ms.map(|found_ms| (found_ms - broke_ms) as f32 * 1e-3));
    score.accused += reports.accusations;
    score.watched_s += (milli - broke_ms) as f64 * 1e-3;
}

/// One line of a [`BrokenTable`]; shares are 0 to 1, and `None` without a sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BrokenLine {
    /// Kind of break.
    pub sensor: &'static str,
    /// Number of feet to find: one per foot that is down in a sample of 10 ms.
    pub feet: usize,
    /// Share of feet found within 5 cm.
    pub within_5cm: f32,
    /// Share of samples with several feet down in which all were found within 5 cm.
    pub all_within_5cm: Option<f32>,
    /// Share of feet without a contact within a shoe's length.
    pub missed: f32,
    /// Number of contacts without a foot, as a share of the feet.
    pub extra: f32,
    /// Number of floors.
    pub floors: u64,
    /// Number of floors that reported the broken sensor.
    pub found: usize,
    /// Median time from the break to its first report, in seconds, of the floors that reported it.
    pub found_after_s: Option<f32>,
    /// Reports of sound sensors per minute.
    pub accused_per_min: Option<f64>,
}

impl BrokenScore {
    fn line(&self, kind: SensorBreak) -> BrokenLine {
        let mut found_s = self.found_s.clone();
        found_s.sort_by(f32::total_cmp);
        let feet = &self.feet;
        BrokenLine {
            sensor: kind.name(),
            feet: feet.feet,
            within_5cm: feet.share_of_all_within_5cm(),
            all_within_5cm: (feet.several > 0).then(|| feet.share_all_within_5cm()),
            missed: feet.share_missed(),
            extra: feet.share_extra(),
            floors: self.floors,
            found: found_s.len(),
            found_after_s: found_s.get(found_s.len() / 2).copied(),
            accused_per_min: (self.watched_s > 0.0).then(|| 60.0 * self.accused as f64 / self.watched_s),
        }
    }
}

impl fmt::Display for BrokenTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let floors = self.scores[0].floors;
        write!(
            f,
            "one broken sensor under the tile that bears most, {} walks of {floors} people, {} sensors\n\
             {:16}within 5 cm{:19}found on  after  sound ones\n\
             sensor        each    all  missed   extra      floors    s    accused a minute",
            WALKS - 1,
            self.floor.name(),
            "",
            ""
        )?;
        let number = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "-".into(), |value| format!("{value:.digits$}"))
        };
        for line in self.lines() {
            write!(
                f,
                "\n{:10}{:>7.1}%{:>6}%{:>7.2}%{:>7.2}%{:>12}{:>7}{:>12}",
                line.sensor,
                100.0 * line.within_5cm,
                number(line.all_within_5cm.map(|share| 100.0 * f64::from(share)), 1),
                100.0 * line.missed,
                100.0 * line.extra,
                if line.sensor == SensorBreak::None.name() { "-".into() } else { line.found.to_string() },
                number(line.found_after_s.map(f64::from), 2),
                number(line.accused_per_min, 2),
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dead_sensor_is_found_before_a_step_and_no_sound_one_is_reported() {
        let mut table = BrokenTable::on(FloorQuality::Slight);
        table.add_person(3).unwrap();
        let lines: Vec<BrokenLine> = table.lines().collect();
        assert_eq!(lines.len(), SensorBreak::ALL.len());
        let (sound, dead) = (&lines[0], &lines[1]);
        assert!(sound.within_5cm > 0.9 && sound.found == 0, "{table}");
        assert!(dead.found == 1 && dead.found_after_s < Some(0.3), "{table}");
        assert!(dead.within_5cm > 0.95 * sound.within_5cm && dead.feet == sound.feet, "{table}");
        assert!(lines.iter().all(|line| line.accused_per_min == Some(0.0)), "{table}");
        let mut both = table.clone();
        both.append(table);
        assert_eq!(both.lines().next().map(|line| line.feet), Some(2 * sound.feet));
    }
}
