//! What every figure gives: a drawing, a table, a summary.

use crate::scene::Scene;

/// An experiment that can be drawn and written as a table.
pub trait Figure {
    /// The drawing; its bounds are those of a page in metres.
    fn draw(&self) -> Scene;

    /// All that was measured, as CSV with a header line; lengths in metres, forces in newtons, angles in degrees.
    fn csv(&self) -> String;

    /// What came out, in a few lines for people.
    fn summary(&self) -> String;
}
