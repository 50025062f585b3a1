//! People on a frozen pond: the number of cracks for each manner of walking, and pictures of the pond.

use std::fmt;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;

use super::{ExperimentError, Rig};
use underfoot::engine::{Engine, Snapshot};
use underfoot::floor::Geometry;
use underfoot::ground::GroundEvent;
use underfoot::layout::Layout;
use underfoot::schema::{Kinds, builtin_layout, parse_layout};
use underfoot::sense::Method;
use underfoot::units::{Instant, Newtons};
use underfoot_scene::scene::{self, Scene, Shoe, Show, Theme, View};
use underfoot_sim::{Foot, FootDriver, Gait, PREFERRED_M_S, Scenario};

/// Manner of putting a foot down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WalkManner {
    /// Full force within 50 ms.
    Stamping,
    /// Ordinary walking.
    Walking,
    /// Walking at 0.6 of the loading rate: the same forces, more slowly.
    Careful,
    /// Stamping with 0.6 of the force, and so of the loading rate.
    Lighter,
    /// Stamping with the full force, at 0.6 of the loading rate.
    Slower,
}

impl WalkManner {
    /// All manners, in the order of the table.
    pub const ALL: [Self; 5] = [Self::Stamping, Self::Slower, Self::Lighter, Self::Walking, Self::Careful];

    /// Returns the name in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stamping => "stamping",
            Self::Walking => "walking",
            Self::Careful => "careful walking: 0.6 of its loading rate",
            Self::Lighter => "stamping with 0.6 of the force",
            Self::Slower => "stamping with 0.6 of the loading rate",
        }
    }

    /// Force in body weights at a time after the touchdown (s).
    fn load(self, at_s: f32) -> f32 {
        let smooth = |share: f32| {
            let share = share.clamp(0.0, 1.0);
            share * share * (3.0 - 2.0 * share)
        };
        let stamp = |rise_s: f32, peak: f32| {
            let down = smooth(at_s / rise_s) * peak;
            let settled = (peak - 1.0).max(0.0) * smooth((at_s - rise_s) / 0.15);
            (down - settled) * (1.0 - smooth((at_s - 0.6) / 0.15))
        };
        let gait = Gait::at_speed(PREFERRED_M_S);
        match self {
            Self::Stamping => stamp(0.05, 1.5),
            Self::Lighter => stamp(0.05, 0.9),
            Self::Slower => stamp(0.05 / 0.6, 1.5),
            Self::Walking => gait.load(at_s / gait.stance_s),
            Self::Careful => gait.load(0.6 * at_s / gait.stance_s),
        }
    }
}

/// Effect of one manner of walking on the pond.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MannerLine {
    /// The manner.
    pub manner: WalkManner,
    /// Number of steps.
    pub steps: u64,
    /// Maximum loading rate, in body weights per second.
    pub rate_per_s: f32,
    /// Mean number of events per step.
    pub events_per_step: f32,
    /// Mean energy of the events per step, in joules.
    pub energy_per_step_j: f32,
    /// Number of events as a share of the number for stamping.
    pub share: f32,
}

/// All manners, on ponds of the same seed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PondWalk {
    /// One line for each manner.
    pub lines: Vec<MannerLine>,
}

/// Maximum time that a foot stays on the floor (ms).
const STEP_MS: u32 = 1300;

/// Weight of the walking person: 70 kg.
const WEIGHT_N: f32 = 687.0;

impl PondWalk {
    /// Simulates `steps` steps of each manner on the shipped pond, each on a floor with parts drawn from `seed`.
    ///
    /// Each step is at another place, after the ice has frozen again.
    ///
    /// # Errors
    /// [`ExperimentError`] if the floor can't be calibrated or the layout is rejected.
    pub fn measure(seed: u64, steps: u64) -> Result<Self, ExperimentError> {
        let mut lines: Vec<MannerLine> = Vec::new();
        for manner in WalkManner::ALL {
            let mut pond = Pond::new(seed)?;
            let (mut events, mut energy) = (0_usize, 0.0);
            for _ in 0..steps {
                let made = pond.step(manner);
                events += made.len();
                energy += made.iter().map(|event| event.energy_j).sum::<f32>();
            }
            let rates = (0..STEP_MS).map(|millis| {
                let at = millis as f32 * 1e-3;
                (manner.load(at + 1e-3) - manner.load(at)) * 1000.0
            });
            let per_step = events as f32 / steps.max(1) as f32;
            let stamping = lines.first().map_or(per_step, |first| first.events_per_step);
            lines.push(MannerLine {
                manner,
                steps,
                rate_per_s: rates.fold(0.0, f32::max),
                events_per_step: per_step,
                energy_per_step_j: energy / steps.max(1) as f32,
                share: per_step / stamping.max(f32::MIN_POSITIVE),
            });
        }
        Ok(Self { lines })
    }

    /// Returns the line of one manner.
    #[must_use]
    pub fn line(&self, manner: WalkManner) -> Option<&MannerLine> {
        self.lines.iter().find(|line| line.manner == manner)
    }

    /// Returns pictures of the shipped pond: untouched, after one step, after a stroll, and after stamping all over
    /// it. Each has a name for its file.
    ///
    /// # Errors
    /// The same as [`PondWalk::measure`].
    pub fn pictures(seed: u64) -> Result<Vec<(&'static str, Scene)>, ExperimentError> {
        let mut pictures = Vec::new();
        let mut pond = Pond::new(seed)?;
        pond.rest(200);
        pictures.push(("pond_before", pond.picture(&[])));
        let layout = shipped(&Geometry::default())?;
        let refused = |error: underfoot::schema::Diagnostics| ExperimentError::Layout(error.to_string());
        let stroll = Scenario::parse("the built-in stroll", Scenario::STROLL).map_err(refused)?;
        let mut script = stroll.resolve(&layout, &Geometry::default()).map_err(refused)?;
        let mut feet = Vec::new();
        let mut first: Option<Instant> = None;
        while script.feet(pond.rig.now(), &mut feet) {
            let loads: Vec<_> = feet.iter().map(Foot::as_load).collect();
            pond.pass(&loads);
            let down = pond.snapshot().contacts.iter().any(|contact| contact.force.0 > 300.0);
            let now = pond.rig.now();
            first = first.or(down.then_some(now));
            if pictures.len() == 1 && first.is_some_and(|first| now.since(first).as_millis() >= 300) {
                pictures.push(("pond_step", pond.picture(&feet)));
            }
        }
        pictures.push(("pond_stroll", pond.picture(&[])));
        let mut pond = Pond::new(seed)?;
        for _ in 0..24 {
            pond.step(WalkManner::Stamping);
        }
        pictures.push(("pond_stamped", pond.picture(&[])));
        Ok(pictures)
    }

    /// Returns all lines as CSV.
    #[must_use]
    pub fn csv(&self) -> String {
        let head = "manner,steps,rate_per_s,events_per_step,energy_per_step_j,share\n".to_owned();
        self.lines.iter().fold(head, |csv, line| {
            let MannerLine { manner, steps, rate_per_s, events_per_step, energy_per_step_j, share } = line;
            let name = manner.name();
            csv + &format!("\"{name}\",{steps},{rate_per_s},{events_per_step},{energy_per_step_j},{share}\n")
        })
    }
}

impl fmt::Display for PondWalk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<42} {:>6} {:>12} {:>12} {:>8} {:>7}",
            "manner", "steps", "rate", "cracks/step", "J/step", "share"
        )?;
        for line in &self.lines {
            writeln!(
                f,
                "{:<42} {:>6} {:>8.1} W/s {:>12.1} {:>8.1} {:>7.2}",
                line.manner.name(),
                line.steps,
                line.rate_per_s,
                line.events_per_step,
                line.energy_per_step_j,
                line.share
            )?;
        }
        Ok(())
    }
}

/// The shipped pond on a floor of parts.
struct Pond {
    rig: Rig,
    engine: Engine,
    geometry: Geometry,
    rng: Pcg64Mcg,
    events: Vec<GroundEvent>,
}

impl Pond {
    fn new(seed: u64) -> Result<Self, ExperimentError> {
        let geometry = Geometry::default();
        let rig = Rig::of_calibrated_parts(geometry, seed)?;
        let engine = rig.engine(shipped(&geometry)?, Method::default());
        let rng = Pcg64Mcg::seed_from_u64(seed);
        let mut pond = Self { rig, engine, geometry, rng, events: Vec::new() };
        pond.rest(100);
        Ok(pond)
    }

    fn pass(&mut self, loads: &[underfoot_sim::Load]) {
        let Self { rig, engine, events, .. } = self;
        rig.step(loads.iter().copied(), |frame| events.extend_from_slice(engine.step(frame).grounds));
    }

    fn rest(&mut self, millis: u32) {
        for _ in 0..millis {
            self.pass(&[]);
        }
    }

    /// Takes one step at a random place and returns its events.
    fn step(&mut self, manner: WalkManner) -> Vec<GroundEvent> {
        self.events.clear();
        let room = self.geometry.bounds().grown(-0.2);
        let share = Vec2::new(self.rng.random(), self.rng.random());
        let position = room.min + room.size() * share;
        let heading = self.rng.random_range(-0.5..0.5);
        for millis in 0..STEP_MS {
            let force = Newtons(WEIGHT_N * manner.load(millis as f32 * 1e-3));
            let foot = Foot { position, heading, length_m: 0.27, force, roll: 0.5, left: false };
            self.pass(&[foot.as_load()]);
        }
        std::mem::take(&mut self.events)
    }

    fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        snapshot
    }

    fn picture(&self, feet: &[Foot]) -> Scene {
        let snapshot = self.snapshot();
        let shoes: Vec<Shoe> = feet.iter().map(Shoe::from).collect();
        let show = Show { ruler: true, ..Show::PROJECTOR };
        let mut scene = Scene::new();
        let view = View {
            show,
            shoes: &shoes,
            ..View::new(&self.geometry, self.engine.layout(), &snapshot, &Theme::LIGHT)
        };
        scene::draw(&mut scene, &view);
        scene
    }
}

fn shipped(geometry: &Geometry) -> Result<Layout, ExperimentError> {
    let text = builtin_layout("pond").unwrap_or_default();
    let loaded = parse_layout(text, "pond", &Kinds::builtin(), geometry);
    loaded.map(|loaded| loaded.layout).map_err(|problems| ExperimentError::Layout(problems.to_string()))
}
