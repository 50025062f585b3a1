//! The shape that the user chooses, and the floor that follows from it.

use std::sync::Arc;

use underfoot::floor::{Floor, Geometry};

use crate::setup::{FloorShape, GridShape, SHIPPED_SHAPES, SetupView};

/// The choice, with its floor.
pub(super) struct ShapeChoice {
    /// Position in [`SHIPPED_SHAPES`]; `None` for the grid.
    pub(super) shipped: Option<usize>,
    pub(super) grid: GridShape,
    /// Whether the user has changed anything: until then, the grid follows the boards that are found.
    pub(super) is_chosen: bool,
    /// The last shape and its floor.
    made: Option<(FloorShape, Result<Arc<Floor>, String>)>,
}

impl Default for ShapeChoice {
    fn default() -> Self {
        Self { shipped: None, grid: GridShape::suited_to(0), is_chosen: false, made: None }
    }
}

impl ShapeChoice {
    /// Follows the boards that are found, until the user chooses.
    pub(super) fn follow(&mut self, view: &SetupView) {
        if self.is_chosen {
            return;
        }
        match &view.floor {
            // The shape of the file, as far as a grid of squares has it.
            Some(floor) => {
                if let Some(grid) = grid_of(&floor.geometry) {
                    self.grid = grid;
                }
            }
            None => {
                let channels = view.boards.iter().map(|board| board.channels).sum();
                self.grid = GridShape::suited_to(channels);
            }
        }
    }

    /// The shape.
    pub(super) fn shape(&self) -> FloorShape {
        match self.shipped.and_then(|position| SHIPPED_SHAPES.get(position)) {
            Some((name, _)) => FloorShape::Shipped((*name).to_owned()),
            None => FloorShape::Grid(self.grid),
        }
    }

    /// The floor of this shape; the reason if it cannot be.
    pub(super) fn floor(&mut self) -> Result<Arc<Floor>, String> {
        let shape = self.shape();
        if let Some((made, floor)) = &self.made
            && *made == shape
        {
            return floor.clone();
        }
        let floor = shape.floor().map(Arc::new);
        self.made = Some((shape, floor.clone()));
        floor
    }
}

/// The grid of squares that is this floor, if it is one.
fn grid_of(geometry: &Geometry) -> Option<GridShape> {
    let inset_m = geometry.sensor_inset_m().filter(|_| geometry.is_square_grid())?;
    Some(GridShape {
        columns: geometry.columns(),
        rows: geometry.rows(),
        tile_m: geometry.tile_m().x,
        pitch_m: geometry.pitch_m().x,
        inset_m,
    })
}
