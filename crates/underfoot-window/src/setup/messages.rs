//! The messages between the window, the steps at work and the program.

use underfoot::floor::{Day, Floor, TileId};
use underfoot::sense::{StandError, StandFit};
use underfoot::units::Newtons;

use super::bench::FitJob;
use super::shape::FloorShape;
use super::step::SetupStep;

/// An order of the window.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupOrder {
    /// Begin a step, or begin it again.
    Go(SetupStep),
    /// Write the floor file for this shape, with the boards that were found.
    WriteFloor(FloorShape),
    /// Take the tare of the empty floor.
    TakeTare,
    /// Begin the walk over the marks of these tiles, of all tiles if there are none.
    Stand {
        /// Weight of the person in kilograms.
        weight_kg: f64,
        /// The tiles.
        tiles: Vec<TileId>,
    },
    /// Leave out the present mark.
    SkipMark,
    /// Use the stands so far.
    EndStanding,
    /// Open a first layout on the floor.
    OpenLayout,
}

/// The boards that the program listens to.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupInput {
    /// Nobody: another program may listen.
    Nobody,
    /// All that send.
    Anybody,
    /// Those of this floor.
    Floor(Box<Floor>),
}

/// A request to the program, for the things that need files, sockets or threads. Each gets its answer.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupRequest {
    /// Listen to these boards from now on: [`SetupAnswer::Listening`].
    Listen(SetupInput),
    /// Write the floor file, and keep its previous content as a backup: [`SetupAnswer::Saved`].
    Save(Box<Floor>),
    /// Take the tare of this floor, to which the program listens: [`SetupAnswer::Tared`].
    TakeTare(Box<Floor>),
    /// Fit the laws on a thread of its own: [`SetupAnswer::Fitted`].
    Fit(Box<FitJob>),
    /// Open a first layout on the floor file: [`SetupAnswer::Opened`], and later [`SetupAnswer::Closed`].
    Open,
}

/// The answer of the program to a request; failures are sentences for the user.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupAnswer {
    /// It listens; the reason why it does not, or only in part.
    Listening(Result<(), String>),
    /// The floor file is written: where it is, and its backup.
    Saved(Result<String, String>),
    /// The tare in the order of [`Floor::tare`], and today.
    Tared(Result<(Vec<[Newtons; 4]>, Day), String>),
    /// The laws, and today.
    Fitted(Box<Result<StandFit, StandError>>, Day),
    /// The layout is open: where it is written.
    Opened(Result<String, String>),
    /// The layout has been closed; the reason if that was a failure.
    Closed(Result<(), String>),
    /// Troubles of the inputs, such as serial ports that do not open; they replace the earlier ones.
    Troubles(Vec<String>),
}
