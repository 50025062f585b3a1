//! Sliders under the feet of seated people: the time to the first answer, and the rest of the value.

use std::f32::consts::TAU;
use std::fmt;
use std::time::Duration;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::intent::shipped_layouts;
use super::rig::{ExperimentError, Rig};
use underfoot::engine::Engine;
use underfoot::floor::Geometry;
use underfoot::layout::Widget;
use underfoot::sense::Method;
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, EventKind};
use underfoot_sim::{FloorQuality, Foot, Load};

/// Sliders of the shipped layouts, each used by the foot of a seated person.
///
/// The foot lands on the track with 60 to 150 N within 60 to 120 ms and rests there. The other foot rests a shoe's
/// length south of it with 20 to 90 N, or, for every second person, on no tile. A resting foot sways by half as much
/// as a standing one.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatedTable {
    floor: FloorQuality,
    /// Without and with the other foot on the floor.
    scores: [SeatedScore; 2],
}

/// Results of the people with the other foot on the floor, or of those without.
#[derive(Clone, Debug, Default, PartialEq)]
struct SeatedScore {
    /// Time from the first force to the press, in milliseconds; sorted when read.
    answers_ms: Vec<f32>,
    unanswered: u64,
    /// Changes of the value while the foot rests, and the time of rest in seconds.
    changes: u64,
    rest_s: f64,
    /// Changes a second of the slider that changes most.
    worst: f64,
}

/// Time that the floor is empty, or the other foot alone on it (ms).
const BEFORE_MS: u64 = 3000;

/// Time after the landing from which on the foot rests, and time of its rest (ms).
const SETTLED_MS: u64 = 1000;
const REST_MS: u64 = 20_000;

/// Maximum time between the landing and the answer (ms).
const PATIENCE_MS: u64 = 1000;

impl SeatedTable {
    /// Creates an empty table for floors of this quality.
    #[must_use]
    pub fn on(floor: FloorQuality) -> Self {
        Self { floor, scores: Default::default() }
    }

    /// Simulates the seated person drawn from `seed` on each slider of each shipped layout, on a floor with parts drawn
    /// from `seed` too.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`]; [`ExperimentError::Layout`], which no layout should cause.
    pub fn add_person(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let geometry = Geometry::default();
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ 0x5ea7_ed00);
        let score = &mut self.scores[usize::from(seed.is_multiple_of(2))];
        for layout in shipped_layouts(&geometry)? {
            for widget in
                layout.widgets.iter().filter(|widget| matches!(widget.behaviour, Behaviour::Slider(_)))
            {
                let mut rig = Rig::of_quality(geometry, self.floor, seed)?;
                let visit = SeatedVisit::draw(widget, &mut rng, seed.is_multiple_of(2));
                let engine = rig.engine(layout.clone(), Method::Tracker);
                score.add(&visit.play(&mut rig, engine, widget));
            }
        }
        Ok(())
    }

    /// Adds all people of another table.
    pub fn append(&mut self, other: Self) {
        for (score, other) in self.scores.iter_mut().zip(other.scores) {
            score.answers_ms.extend(other.answers_ms);
            score.unanswered += other.unanswered;
            score.changes += other.changes;
            score.rest_s += other.rest_s;
            score.worst = score.worst.max(other.worst);
        }
    }

    /// Returns all lines, for programs: without and with the other foot on the floor.
    pub fn lines(&self) -> impl Iterator<Item = SeatedLine> + '_ {
        let names = ["in the air", "rests beside"];
        names.into_iter().zip(&self.scores).map(|(other_foot, score)| score.line(other_foot))
    }
}

impl SeatedScore {
    fn add(&mut self, visit: &Answered) {
        self.answers_ms.extend(visit.first_ms.map(|ms| ms as f32));
        self.unanswered += u64::from(visit.first_ms.is_none());
        if visit.first_ms.is_some() {
            let rest_s = REST_MS as f64 * 1e-3;
            self.changes += visit.changes;
            self.rest_s += rest_s;
            self.worst = self.worst.max(visit.changes as f64 / rest_s);
        }
    }

    fn line(&self, other_foot: &'static str) -> SeatedLine {
        let mut sorted = self.answers_ms.clone();
        sorted.sort_by(f32::total_cmp);
        let at = |share: f32| {
            sorted.get((share * sorted.len().saturating_sub(1) as f32).round() as usize).copied()
        };
        SeatedLine {
            other_foot,
            answers: sorted.len(),
            unanswered: self.unanswered,
            median_ms: at(0.5),
            p5_ms: at(0.05),
            p95_ms: at(0.95),
            changes_per_s: (self.rest_s > 0.0).then(|| self.changes as f64 / self.rest_s),
            worst_changes_per_s: self.worst,
        }
    }
}

/// The feet of one seated person who uses one slider.
struct SeatedVisit {
    foot: Foot,
    other: Option<Foot>,
    ramp_ms: u64,
    /// Phases of the sway.
    phases: [f32; 4],
}

/// The answers of the slider.
struct Answered {
    first_ms: Option<u64>,
    changes: u64,
}

impl SeatedVisit {
    fn draw(widget: &Widget, rng: &mut Pcg64Mcg, has_other: bool) -> Self {
        let size = widget.area.size();
        let share = rng.random_range(0.2..0.8);
        let place = match &widget.behaviour {
            Behaviour::Slider(slider) => slider.track.place_at(share, size),
            _ => Vec2::splat(0.5),
        };
        let aim = widget.area.min + place * size;
        let mut foot = Foot {
            position: aim,
            heading: rng.random_range(-0.3..0.3),
            length_m: rng.random_range(0.22..0.30),
            force: Newtons(rng.random_range(60.0..150.0)),
            roll: 0.55,
            left: false,
        };
        foot.position += aim - foot.centre_of_pressure();
        let aside = Vec2::new(rng.random_range(-0.2..0.2), -0.33);
        let other =
            Foot { position: foot.position + aside, force: Newtons(rng.random_range(20.0..90.0)), ..foot };
        Self {
            foot,
            other: has_other.then_some(other),
            ramp_ms: rng.random_range(60..120),
            phases: std::array::from_fn(|_| rng.random_range(0.0..TAU)),
        }
    }

    /// The loads at this millisecond after the landing; negative before it.
    fn loads(&self, since_ms: i64) -> impl Iterator<Item = Load> {
        let at_s = since_ms as f32 * 1e-3;
        let wave = |hertz: f32, phase: usize| (TAU * hertz * at_s + self.phases[phase]).sin();
        let heavier = 1.0 + 0.02 * (wave(0.13, 0) + 0.6 * wave(0.31, 1));
        let rolled = 0.004 * (wave(0.11, 2) + 0.6 * wave(0.27, 3));
        let landed = (since_ms as f32 / self.ramp_ms as f32).clamp(0.0, 1.0);
        let swaying = |foot: Foot, share: f32| Foot {
            force: Newtons(foot.force.0 * heavier * share),
            roll: foot.roll + rolled,
            ..foot
        };
        let feet = [Some(swaying(self.foot, landed)), self.other.map(|other| swaying(other, 1.0))];
        feet.into_iter().flatten().filter(|foot| foot.force.0 > 0.0).map(|foot| foot.as_load())
    }

    fn play(&self, rig: &mut Rig, mut engine: Engine, widget: &Widget) -> Answered {
        let mut answered = Answered { first_ms: None, changes: 0 };
        for milli in 1..=BEFORE_MS + SETTLED_MS + REST_MS {
            let since_ms = milli as i64 - BEFORE_MS as i64;
            let loads: Vec<Load> = self.loads(since_ms).collect();
            rig.step(loads, |frame| {
                for event in engine.step(frame).events.iter().filter(|event| event.id == widget.id) {
                    let since_ms = since_ms.max(0) as u64;
                    if event.kind == EventKind::Pressed && since_ms <= PATIENCE_MS {
                        answered.first_ms.get_or_insert(since_ms);
                    }
                    let rests = since_ms > SETTLED_MS;
                    answered.changes += u64::from(rests && matches!(event.kind, EventKind::Changed(_)));
                }
            });
            if since_ms > PATIENCE_MS as i64 && answered.first_ms.is_none() {
                break;
            }
        }
        answered
    }
}

/// One line of a [`SeatedTable`]; times in milliseconds, `None` without an answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeatedLine {
    /// The place of the other foot.
    pub other_foot: &'static str,
    /// Number of landings that the slider answered.
    pub answers: usize,
    /// Number of landings without an answer within a second.
    pub unanswered: u64,
    /// Median of the time from the first force to the press.
    pub median_ms: Option<f32>,
    /// 5th percentile of that time.
    pub p5_ms: Option<f32>,
    /// 95th percentile of that time.
    pub p95_ms: Option<f32>,
    /// Changes of the value a second while the foot rests.
    pub changes_per_s: Option<f64>,
    /// The same, of the slider that changes most.
    pub worst_changes_per_s: f64,
}

impl fmt::Display for SeatedTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rest = Duration::from_millis(REST_MS).as_secs();
        writeln!(
            f,
            "sliders of the shipped layouts under feet of seated people ({}): time to the first answer, ms; changes of the\n\
             value a second while the foot rests for {rest} s",
            self.floor
        )?;
        writeln!(f, "other foot    answers  none  median     p5    p95  changes  most")?;
        for line in self.lines() {
            let ms = |time: Option<f32>| time.map_or_else(|| "-".into(), |ms| format!("{ms:.0}"));
            writeln!(
                f,
                "{:12}{:9}{:6}{:>8}{:>7}{:>7}{:9.2}{:6.2}",
                line.other_foot,
                line.answers,
                line.unanswered,
                ms(line.median_ms),
                ms(line.p5_ms),
                ms(line.p95_ms),
                line.changes_per_s.unwrap_or_default(),
                line.worst_changes_per_s
            )?;
        }
        Ok(())
    }
}
