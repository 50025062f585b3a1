//! The plates to choose from: shipped floors, and tiles in a grid.

use underfoot::floor::{Floor, Geometry};
use underfoot::schema;

/// The shipped floors whose shape is fixed: the name of each in [`schema::builtin_floor`], and a description.
pub const SHIPPED_SHAPES: [(&str, &str); 3] = [
    ("dance_pad", "a dance pad, 3 x 3 panels with sensors at the middles of their edges"),
    ("balance_board", "a balance board, one plate with four sensors"),
    ("load_cells", "four plates, each on three load cells"),
];

/// The shape of a floor.
#[derive(Clone, Debug, PartialEq)]
pub enum FloorShape {
    /// A shipped floor, by its name.
    Shipped(String),
    /// Square tiles with sensors near their corners.
    Grid(GridShape),
}

/// Measures of square tiles in a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridShape {
    /// Columns, west to east.
    pub columns: u16,
    /// Rows, south to north.
    pub rows: u16,
    /// Side of a plate (m).
    pub tile_m: f32,
    /// Distance between the middles of neighbouring plates (m).
    pub pitch_m: f32,
    /// Distance of each sensor from both edges of its corner (m).
    pub inset_m: f32,
}

impl GridShape {
    /// The paper's tiles.
    #[must_use]
    pub const fn of_paper(columns: u16, rows: u16) -> Self {
        Self { columns, rows, tile_m: 0.304, pitch_m: 0.304, inset_m: 0.02 }
    }

    /// Returns the grid of the paper's tiles that has as many sensors as the boards have channels, as near to a square
    /// as possible; 2 x 2 without boards.
    #[must_use]
    pub fn suited_to(channels: usize) -> Self {
        let tiles = u16::try_from(channels / 4).unwrap_or(u16::MAX).min(Geometry::MAX_SIDE);
        if tiles == 0 {
            return Self::of_paper(2, 2);
        }
        let least_side = (1..=tiles).take_while(|rows| rows.saturating_mul(*rows) <= tiles);
        let rows = least_side.filter(|rows| tiles.is_multiple_of(*rows)).last().unwrap_or(1);
        Self::of_paper(tiles / rows, rows)
    }

    /// Returns its plates.
    ///
    /// # Errors
    /// The measure that cannot be, and its range.
    pub fn geometry(&self) -> Result<Geometry, String> {
        let made = Geometry::new(self.columns, self.rows, self.tile_m, self.pitch_m, self.inset_m);
        made.map_err(|error| error.to_string())
    }
}

impl FloorShape {
    /// Returns a floor of this shape, with its usual boards.
    ///
    /// # Errors
    /// The measure that cannot be, or the name of a floor that is not shipped.
    pub fn floor(&self) -> Result<Floor, String> {
        match self {
            Self::Grid(grid) => grid.geometry().map(Floor::of),
            Self::Shipped(name) => {
                let text = schema::builtin_floor(name).ok_or_else(|| format!("no floor is called {name}"))?;
                schema::parse_floor(text, name).map_err(|problems| problems.to_string())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_suggested_grid_has_a_sensor_for_each_channel() {
        for (channels, columns, rows) in
            [(0, 2, 2), (4, 1, 1), (16, 2, 2), (24, 3, 2), (28, 7, 1), (144, 6, 6)]
        {
            let shape = GridShape::suited_to(channels);
            assert_eq!((shape.columns, shape.rows), (columns, rows), "{channels}");
        }
        assert!(GridShape::suited_to(usize::MAX).geometry().is_ok());
    }

    #[test]
    fn every_shipped_shape_is_a_floor_and_measures_that_cannot_be_are_named() {
        for (name, _) in SHIPPED_SHAPES {
            FloorShape::Shipped(name.to_owned()).floor().unwrap();
        }
        let wide = GridShape { pitch_m: 0.1, ..GridShape::of_paper(2, 2) };
        assert!(FloorShape::Grid(wide).floor().unwrap_err().contains("0.1"));
        assert!(FloorShape::Shipped("trampoline".to_owned()).floor().is_err());
    }
}
