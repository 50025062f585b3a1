//! The state of the set-up, for the window.

use std::sync::Arc;

use underfoot::floor::{Floor, SensorId, TileId};
use underfoot::sense::{StandFit, StandingMark};
use underfoot::serve::{FeltLoad, StandNews, StandTask, WiringStep, WiringTask};

use super::step::SetupStep;

/// The state of the set-up.
#[derive(Clone, Debug, Default)]
pub struct SetupView {
    /// The boards that send, by their addresses.
    pub boards: Vec<BoardView>,
    /// Number of datagrams, frames and lines that no board sends.
    pub unread: u64,
    /// Troubles of the inputs, in sentences.
    pub troubles: Vec<String>,
    /// The floor of the file; `None` before there is one.
    pub floor: Option<Arc<Floor>>,
    /// The work under way.
    pub work: WorkView,
    /// The sensors of the floor while it is read.
    pub sensors: Vec<SensorView>,
    /// Whether the sensors have been measured on the empty floor.
    pub is_rested: bool,
    /// The steps, in the order of [`SetupStep::ALL`].
    pub steps: [StepView; 6],
    /// The last calibration by standing.
    pub fit: Option<Arc<StandFit>>,
    /// The tiles that need more stands.
    pub needy: Vec<TileId>,
}

impl SetupView {
    /// Returns the state of a step.
    #[must_use]
    pub fn step(&self, step: SetupStep) -> &StepView {
        &self.steps[step.index()]
    }
}

/// The state of a step, with what is known of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StepView {
    /// Its state.
    pub state: StepState,
    /// Its results, or the reasons for its trouble, in sentences.
    pub words: Vec<String>,
}

/// Whether a step is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StepState {
    /// Not yet.
    #[default]
    Open,
    /// Done.
    Done,
    /// Something is wrong or missing.
    Trouble,
}

/// A board that sends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoardView {
    /// Its address, its port, or both.
    pub name: String,
    /// Packets in the last second; `None` before the second packet.
    pub rate_hz: Option<f64>,
    /// Number of its channels.
    pub channels: usize,
    /// The kind of its numbers.
    pub kind: &'static str,
    /// Whether its packets are numbered.
    pub is_numbered: bool,
    /// Full scale and bits that its counts need so far; `None` for newtons.
    pub full_scale: Option<(u32, u32)>,
    /// The greatest of its readings so far.
    pub greatest: f64,
    /// Its last readings, at most 64.
    pub readings: Vec<f64>,
    /// Its troubles, in sentences.
    pub troubles: Vec<String>,
}

/// The work under way.
#[derive(Clone, Debug, Default)]
pub enum WorkView {
    /// None.
    #[default]
    Nothing,
    /// Listening for boards.
    Boards,
    /// A walk from board to board.
    Wiring(WiringView),
    /// The readings.
    Readings,
    /// The tare is being taken.
    Taring,
    /// A walk from mark to mark.
    Standing(Box<StandingView>),
    /// The laws are being fitted.
    Fitting,
    /// The first layout is open in another window.
    Open,
}

/// A walk from board to board.
#[derive(Clone, Debug)]
pub struct WiringView {
    /// The next task of the person.
    pub task: WiringTask,
    /// The steps so far.
    pub steps: Vec<WiringStep>,
    /// Number of all steps.
    pub length: usize,
    /// The heaviest load on the floor.
    pub felt: Option<FeltLoad>,
    /// The addresses of boards that have sent nothing.
    pub unheard: Vec<String>,
}

/// A walk from mark to mark.
#[derive(Clone, Debug)]
pub struct StandingView {
    /// The next task of the person.
    pub task: StandTask,
    /// All marks.
    pub marks: Arc<[StandingMark]>,
    /// Number of marks that are done or left out.
    pub done: usize,
    /// Share of the present stand that is measured, 0 to 1.
    pub share: f32,
    /// The last news, which stay until the next ones.
    pub news: Option<StandNews>,
    /// The reason why no stand can be measured, if any.
    pub trouble: Option<String>,
}

/// A sensor of the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorView {
    /// The sensor.
    pub sensor: SensorId,
    /// Its force by its law in the floor file, above that on the empty floor (N).
    pub force_n: f32,
    /// Standard deviation of its force on the empty floor (N); `None` before it is measured.
    pub noise_n: Option<f32>,
    /// Its greatest reading, as a share of the full scale of its board; `None` for newtons.
    pub greatest: Option<f32>,
    /// Its state.
    pub state: SensorState,
}

/// The state of a sensor, as far as its readings tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SensorState {
    /// Its board has sent nothing for a while, or never.
    #[default]
    Silent,
    /// Its board sends, without a reading for it.
    Unread,
    /// Nothing has been on it yet.
    Waiting,
    /// It has answered to a load.
    Answers,
    /// It is noisy on the empty floor.
    Noisy,
    /// A load has brought it to the end of its board's range.
    Saturated,
}

impl SensorState {
    /// Whether it is a trouble.
    #[must_use]
    pub const fn is_trouble(self) -> bool {
        !matches!(self, Self::Waiting | Self::Answers)
    }

    /// Returns a description, after the name of the sensor.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Silent => "its board sends nothing",
            Self::Unread => "gives no reading",
            Self::Waiting => "no load yet",
            Self::Answers => "answers",
            Self::Noisy => "is noisy on the empty floor",
            Self::Saturated => "has been at the end of its range",
        }
    }
}
