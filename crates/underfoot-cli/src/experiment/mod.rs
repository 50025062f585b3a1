//! `underfoot experiment`: the paper's figures and the accuracy tables.

mod figure;
mod intent;
mod options;
mod parallel;
mod pond;
mod tables;

use clap::Subcommand;
use underfoot_lab::experiment::{ExperimentError, Orientation, SeamObject, TileScan, TwoFeet};

use super::failure::Failure;
use options::{FeetArgs, FigureArgs, IntentArgs, PondArgs, ScenesArgs, SpotArgs, StandArgs};

/// Options of `underfoot experiment`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Measured orientation of lines, ellipses and a disc across a seam (the paper's figure 7).
    Figure7(FigureArgs),
    /// Estimated against true positions of a point load over one tile (the paper's figure 8).
    Figure8(FigureArgs),
    /// An object of 51 N over the seam of two tiles at several angles (the paper's figure 9).
    Figure9(FigureArgs),
    /// Two feet on 2 x 2 tiles, before and after they are separated (the paper's figure 11).
    Figure11(FigureArgs),
    /// Accuracy of one contact, over a whole tile and at its seams.
    Spot(SpotArgs),
    /// Accuracy of one foot by its force and its distance from a seam: the basis of the predictions of `underfoot
    /// check`.
    Place(SpotArgs),
    /// Accuracy of both feet of people, and of the cursor of a foot that operates beside a heavy one.
    Feet(FeetArgs),
    /// Accuracy of all contacts in fifteen scenes that are hard to sense, on floors of one quality or of several:
    /// walking, shifting weight, jumping, kneeling, sticks, wheels.
    Scenes(ScenesArgs),
    /// Walks over one sensor that is dead, stuck, drifting or noisy: places of the feet, the time until it is found, and
    /// sound sensors that are reported.
    Sensors(FeetArgs),
    /// Accuracy after calibration by standing, beside that by a load cell, on floors of each law; by the number of
    /// marks, and with the time that the person needs.
    Calibration(StandArgs),
    /// Rates of unintended activations and of missed presses: people who cross and use every shipped layout, and rows
    /// of buttons of many sizes and thresholds.
    Intent(IntentArgs),
    /// Sliders under the feet of seated people: time to the first answer, and changes of a value at rest; buttons tapped
    /// beside a foot that stands in their region, by its cursor rule.
    Controls(FeetArgs),
    /// Whether the frozen pond follows its model, and the number of cracks for each manner of walking.
    Pond(PondArgs),
}

/// Runs the experiment.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.what {
        What::Figure7(args) => args.make("figure7", &Orientation::measure(args.seed)?),
        What::Figure8(args) => args.make("figure8", &TileScan::measure(args.seed)?),
        What::Figure9(args) => args.make("figure9", &SeamObject::measure(args.seed)?),
        What::Figure11(args) => args.make("figure11", &TwoFeet::measure(args.seed)?),
        What::Spot(args) => tables::spot(args),
        What::Place(args) => tables::place(args),
        What::Feet(args) => tables::feet(args),
        What::Scenes(args) => tables::scenes(args),
        What::Sensors(args) => tables::sensors(args),
        What::Calibration(args) => tables::calibration(args),
        What::Intent(args) => intent::intent(args),
        What::Controls(args) => tables::controls(args),
        What::Pond(args) => pond::pond(args),
    }
}

impl From<ExperimentError> for Failure {
    fn from(error: ExperimentError) -> Self {
        Self::Other(error.to_string())
    }
}
