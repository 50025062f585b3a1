//! Calibration by standing at work: the walk, its measurements, the problem to solve.

use std::sync::Arc;
use std::time::Duration;

use underfoot::floor::{Floor, Geometry, TileId};
use underfoot::sense::{StandData, StandError, StandFit, StandingMark};
use underfoot::serve::{StandNews, StandTask, StandWalk};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::SensorPacket;

use super::{Listens, NO_FLOOR, SetupBench, Work};
use crate::setup::messages::SetupRequest;
use crate::setup::step::SetupStep;
use crate::setup::view::{StandingView, StepView};

/// Acceleration of gravity (m/s²), the standard value.
const GRAVITY: f64 = 9.806_65;

/// Weight of the person in kilograms.
const WEIGHTS_KG: std::ops::RangeInclusive<f64> = 15.0..=300.0;

/// Difference of two weights that count as one (N).
const SAME_N: f32 = 0.5;

/// Time after which an empty floor has been measured, unless something moves on it.
const EMPTY: Duration = Duration::from_secs(6);

/// The problem of a calibration by standing.
#[derive(Clone, Debug, PartialEq)]
pub struct FitJob {
    data: StandData,
    weight: Newtons,
    geometry: Geometry,
}

impl FitJob {
    /// Solves it; this takes seconds on large floors.
    ///
    /// # Errors
    /// [`StandError`]
    pub fn run(&self) -> Result<StandFit, StandError> {
        StandFit::of(&self.data, self.weight, &self.geometry, None)
    }
}

/// The stands of one person, also of several walks, with their fit.
#[derive(Clone, Debug)]
pub(super) struct StandRecord {
    pub(super) data: StandData,
    pub(super) marks: Vec<StandingMark>,
    weight: Newtons,
    /// Number of walks.
    walks: usize,
    pub(super) fit: Option<Arc<StandFit>>,
    pub(super) needy: Vec<TileId>,
}

impl StandRecord {
    /// Whether its person has this weight.
    fn is_of(&self, weight: Newtons) -> bool {
        (self.weight.0 - weight.0).abs() < SAME_N
    }
}

/// A walk from mark to mark.
#[derive(Clone, Debug)]
pub(super) struct StandingWork {
    walk: StandWalk,
    marks: Arc<[StandingMark]>,
    weight: Newtons,
    news: Option<StandNews>,
    /// Arrival of the first packet.
    begun: Option<Instant>,
}

impl StandingWork {
    fn new(floor: &Floor, marks: Vec<StandingMark>, weight: Newtons) -> Self {
        let shown = marks.clone().into();
        Self { walk: StandWalk::new(floor, marks), marks: shown, weight, news: None, begun: None }
    }

    pub(super) fn take(&mut self, packet: &SensorPacket) {
        self.begun.get_or_insert(packet.received);
        if let Some(news) = self.walk.take(packet) {
            self.news = Some(news);
        }
    }

    pub(super) fn skip(&mut self) {
        self.walk.skip();
    }

    pub(super) fn is_done(&self) -> bool {
        self.walk.task() == StandTask::Nothing
    }

    /// The reason for which no stand can calibrate this floor, if any.
    pub(super) fn failure(&self) -> Option<String> {
        let words =
            "The boards send newtons, so they calibrate themselves: calibration by standing needs counts.";
        self.walk.has_newtons().then(|| words.to_owned())
    }

    /// The reason for which no stand can be measured now, if any.
    fn trouble(&self, now: Instant) -> Option<String> {
        let silent: Vec<&str> = self.walk.silent(now).collect();
        if !silent.is_empty() {
            return Some(format!("Nothing comes from {}.", silent.join(", ")));
        }
        if self.walk.task() != StandTask::KeepOff {
            return None;
        }
        if let Some(sensor) = self.walk.unread().next() {
            return Some(format!("The sensor of {sensor} gives no reading."));
        }
        let is_late = self.begun.is_some_and(|begun| now.since(begun) > EMPTY);
        is_late.then(|| "The floor is not empty and quiet: something moves on it.".to_owned())
    }

    /// The state of the walk at `now`.
    pub(super) fn view(&self, now: Instant) -> StandingView {
        StandingView {
            task: self.walk.task(),
            marks: Arc::clone(&self.marks),
            done: self.walk.done(),
            share: self.walk.measured_share(),
            news: self.news,
            trouble: self.trouble(now),
        }
    }
}

impl SetupBench {
    /// Begins the walk over the marks of `tiles`, of all without any.
    pub(super) fn stand(&mut self, weight_kg: f64, tiles: &[TileId]) {
        let Some(floor) = self.floor.clone() else {
            return self.fail(SetupStep::Standing, NO_FLOOR.to_owned());
        };
        if !WEIGHTS_KG.contains(&weight_kg) {
            let reason = "A person weighs 15 to 300 kg: write the weight as a number.".to_owned();
            return self.fail(SetupStep::Standing, reason);
        }
        let mut walked = StandingMark::walk(&floor.geometry);
        if !tiles.is_empty() {
            walked.retain(|tile| tiles.contains(tile));
        }
        let weight = Newtons((weight_kg * GRAVITY) as f32);
        // In each walk of the same person the feet face the other way than in the one before.
        let record = self.record.as_ref().filter(|record| record.is_of(weight));
        let rounds = record.map_or(0, |record| record.walks) + 1;
        let mut marks = StandingMark::of_tiles(&floor.geometry, &walked, rounds);
        marks.drain(..marks.len() - marks.len() / rounds);
        self.listen(Listens::Floor);
        self.steps[SetupStep::Standing.index()] = StepView::default();
        self.work = Work::Standing(Box::new(StandingWork::new(&floor, marks, weight)));
    }

    /// Ends the walk, and asks for the laws from its stands and those of earlier walks of the same person.
    pub(super) fn end_standing(&mut self) {
        let Work::Standing(work) = &self.work else { return };
        let Some(floor) = &self.floor else { return };
        let (mut data, mut marks) = (work.walk.data().clone(), work.marks.to_vec());
        let weight = work.weight;
        if data.stands.is_empty() {
            let reason = "No stand was measured: stand still on the marks, for three seconds each.";
            self.work = Work::Readings;
            return self.fail(SetupStep::Standing, reason.to_owned());
        }
        let is_same =
            |record: &&StandRecord| record.is_of(weight) && record.data.empty.len() == data.empty.len();
        let mut walks = 1;
        if let Some(earlier) = self.record.as_ref().filter(is_same) {
            walks += earlier.walks;
            data.stands.splice(0..0, earlier.data.stands.iter().cloned());
            data.crossings.splice(0..0, earlier.data.crossings.iter().cloned());
            marks.splice(0..0, earlier.marks.iter().copied());
        }
        let job = FitJob { data: data.clone(), weight, geometry: floor.geometry };
        self.requests.push_back(SetupRequest::Fit(Box::new(job)));
        let record = StandRecord { data, marks, weight, walks, fit: None, needy: Vec::new() };
        self.work = Work::Fitting(Box::new(record));
    }
}
