//! The output of every figure: a drawing, a table, a summary.

use underfoot_scene::scene::Scene;

/// An experiment that can be drawn and written as a table.
pub trait Figure {
    /// Returns the drawing; its bounds are the page in metres.
    fn draw(&self) -> Scene;

    /// Returns all measurements, as CSV with a header line; lengths in metres, forces in newtons, angles in degrees.
    fn csv(&self) -> String;

    /// Returns the result in a few readable lines.
    fn summary(&self) -> String;
}
