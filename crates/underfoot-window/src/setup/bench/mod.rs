//! The steps at work: packets and orders in, requests and a view out.
//!
//! The program calls it on the thread that reads the boards, so that a covered or slow window delays no measurement.
//! Orders come from the window at any time; a new one ends the work under way.

mod conclude;
mod rates;
mod readings;
mod show;
mod standing;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::sync::Arc;

use underfoot::floor::Floor;
use underfoot::serve::{WiringTask, WiringWalk};
use underfoot::units::Instant;
use underfoot::wire::SensorPacket;

use self::rates::LiveRates;
use self::readings::ReadingsWatch;
pub use self::standing::FitJob;
use self::standing::{StandRecord, StandingWork};
use super::heard::HeardBoards;
use super::messages::{SetupInput, SetupOrder, SetupRequest};
use super::shape::FloorShape;
use super::step::SetupStep;
use super::view::{BoardView, StepState, StepView};
use super::wires::assign;

/// The steps at work.
#[derive(Clone, Debug)]
pub struct SetupBench {
    /// The floor of the file.
    floor: Option<Arc<Floor>>,
    heard: HeardBoards,
    rates: LiveRates,
    /// The boards as last shown; they stay while the floor is read.
    boards: Vec<BoardView>,
    /// Troubles of the inputs.
    troubles: Vec<String>,
    listens: Listens,
    work: Work,
    /// The readings of the floor while it is read.
    watch: Option<ReadingsWatch>,
    steps: [StepView; 6],
    /// The last calibration by standing.
    record: Option<StandRecord>,
    /// The floors that are being written, for which step, with its results.
    saving: VecDeque<(Floor, SetupStep, StepView)>,
    requests: VecDeque<SetupRequest>,
    now: Instant,
}

/// The boards to which the program was asked to listen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Listens {
    Nobody,
    Anybody,
    Floor,
}

/// The work under way.
#[derive(Clone, Debug)]
enum Work {
    Nothing,
    Boards,
    Wiring(Box<WiringWalk>),
    Readings,
    Taring,
    Standing(Box<StandingWork>),
    Fitting(Box<StandRecord>),
    Open,
}

/// The reason for which a step does not begin.
const NO_FLOOR: &str = "There is no floor file yet: choose the floor's shape first.";

impl SetupBench {
    /// The steps on the floor of the file, if there is one.
    #[must_use]
    pub fn new(floor: Option<Floor>) -> Self {
        let mut steps = <[StepView; 6]>::default();
        if floor.is_some() {
            let words = vec!["The floor file is there already.".to_owned()];
            steps[SetupStep::Shape.index()] = StepView { state: StepState::Done, words };
        }
        Self {
            floor: floor.map(Arc::new),
            heard: HeardBoards::default(),
            rates: LiveRates::default(),
            boards: Vec::new(),
            troubles: Vec::new(),
            listens: Listens::Nobody,
            work: Work::Nothing,
            watch: None,
            steps,
            record: None,
            saving: VecDeque::new(),
            requests: VecDeque::new(),
            now: Instant::START,
        }
    }

    /// Returns the boards that were found, to add what they send.
    pub fn heard(&mut self) -> &mut HeardBoards {
        &mut self.heard
    }

    /// Sets the time: that of the input to which the program listens.
    pub fn set_now(&mut self, now: Instant) {
        self.now = now;
    }

    /// Processes a packet of the floor.
    pub fn take(&mut self, packet: &SensorPacket) {
        self.now = packet.received;
        if let Some(watch) = &mut self.watch {
            watch.take(packet);
        }
        match &mut self.work {
            Work::Wiring(walk) if walk.task() != WiringTask::Nothing => {
                walk.take(packet);
                if walk.task() == WiringTask::Nothing {
                    self.conclude_wiring();
                }
            }
            Work::Standing(work) => {
                work.take(packet);
                if let Some(failure) = work.failure() {
                    self.fail(SetupStep::Standing, failure);
                    self.work = Work::Readings;
                } else if work.is_done() {
                    self.end_standing();
                }
            }
            _ => {}
        }
    }

    /// Carries out an order of the window.
    pub fn order(&mut self, order: &SetupOrder) {
        match order {
            SetupOrder::Go(step) => self.go(*step),
            SetupOrder::WriteFloor(shape) => self.write_floor(shape),
            SetupOrder::TakeTare => self.take_tare(),
            SetupOrder::Stand { weight_kg, tiles } => self.stand(*weight_kg, tiles),
            SetupOrder::SkipMark => {
                if let Work::Standing(work) = &mut self.work {
                    work.skip();
                    if work.is_done() {
                        self.end_standing();
                    }
                }
            }
            SetupOrder::EndStanding => self.end_standing(),
            SetupOrder::OpenLayout => self.open_layout(),
        }
    }

    /// Returns the next request to the program, in order; the program answers each by [`SetupBench::answer`].
    pub fn next_request(&mut self) -> Option<SetupRequest> {
        self.requests.pop_front()
    }

    /// Begins a step.
    fn go(&mut self, step: SetupStep) {
        if step.needs_floor() && self.floor.is_none() {
            self.work = Work::Nothing;
            return self.fail(step, NO_FLOOR.to_owned());
        }
        match step {
            SetupStep::Boards => {
                self.heard = HeardBoards::default();
                self.rates = LiveRates::default();
                self.listen(Listens::Anybody);
                self.work = Work::Boards;
            }
            SetupStep::Shape => {
                self.listen(Listens::Anybody);
                self.work = Work::Boards;
            }
            SetupStep::Wiring => {
                self.listen(Listens::Floor);
                self.steps[step.index()] = StepView::default();
                self.work = match &self.floor {
                    Some(floor) => Work::Wiring(Box::new(WiringWalk::new(floor))),
                    None => Work::Nothing,
                };
            }
            SetupStep::Readings | SetupStep::Standing => {
                self.listen(Listens::Floor);
                self.work = Work::Readings;
            }
            SetupStep::Layout => self.work = Work::Nothing,
        }
    }

    /// Asks the program to listen; the readings of a floor begin anew.
    fn listen(&mut self, listens: Listens) {
        if self.listens != listens {
            self.listens = listens;
            let input = match (listens, &self.floor) {
                (Listens::Anybody, _) => SetupInput::Anybody,
                (Listens::Floor, Some(floor)) => SetupInput::Floor(Box::new(Floor::clone(floor))),
                (Listens::Nobody | Listens::Floor, _) => SetupInput::Nobody,
            };
            self.requests.push_back(SetupRequest::Listen(input));
        }
        let floor = self.floor.as_ref().filter(|_| listens == Listens::Floor);
        self.watch = floor.map(|floor| ReadingsWatch::new(floor));
    }

    /// Writes the floor file for a shape.
    fn write_floor(&mut self, shape: &FloorShape) {
        match shape.floor() {
            Err(reason) => self.fail(SetupStep::Shape, reason),
            Ok(mut floor) => {
                let wires = assign(&mut floor, &self.heard);
                let is_whole = wires.boards > 0 && wires.unread == 0;
                let state = if is_whole { StepState::Done } else { StepState::Trouble };
                self.save(floor, SetupStep::Shape, StepView { state, words: wires.words() });
            }
        }
    }

    /// Asks the program to write the floor file.
    fn save(&mut self, floor: Floor, step: SetupStep, result: StepView) {
        self.requests.push_back(SetupRequest::Save(Box::new(floor.clone())));
        self.saving.push_back((floor, step, result));
    }

    fn take_tare(&mut self) {
        match &self.floor {
            None => self.fail(SetupStep::Readings, NO_FLOOR.to_owned()),
            Some(floor) => {
                let floor = Box::new(Floor::clone(floor));
                self.listen(Listens::Floor);
                self.requests.push_back(SetupRequest::TakeTare(floor));
                self.work = Work::Taring;
            }
        }
    }

    fn open_layout(&mut self) {
        if self.floor.is_none() {
            return self.fail(SetupStep::Layout, NO_FLOOR.to_owned());
        }
        // The layout listens to the boards itself.
        self.listen(Listens::Nobody);
        self.requests.push_back(SetupRequest::Open);
        self.work = Work::Open;
    }

    /// Notes the trouble of a step.
    fn fail(&mut self, step: SetupStep, reason: String) {
        self.steps[step.index()] = StepView { state: StepState::Trouble, words: vec![reason] };
    }
}
