//! The plan of a page's floor: the layout and the measured floor from which floors begin, or the reason why there is none.

use std::sync::Arc;

use thiserror::Error;
use underfoot::floor::{Floor, Geometry};
use underfoot::layout::Layout;
use underfoot::recording::RecordingError;
use underfoot::schema::{self, Diagnostics, Kinds};
use underfoot_sim::{BuildError, FloorBuild, FloorQuality, SimFloor};
use underfoot_window::edit::Document;
use underfoot_window::link::{LinkError, SharedLayout};
use underfoot_window::preview::Warnings;

use super::kinds::OwnTexts;
use super::recording::MOST_MEGABYTES;

/// Seed of the sensors, of their noise and of the faults.
pub(crate) const SEED: u64 = 1;

/// Maximum number of tiles of a floor that a page simulates.
const MOST_TILES: u32 = 144;

/// The reason why the page has no floor.
#[derive(Debug, Error)]
pub enum NoFloor {
    /// The layout, its kinds or its effects cannot be read.
    #[error("{0}")]
    Layout(#[from] Diagnostics),
    /// The visit cannot be played.
    #[error(transparent)]
    Visit(#[from] LinkError),
    /// There is no such floor, or the page could not simulate it in real time.
    #[error(
        "the layout is for a floor of {columns} x {rows} tiles; a page has floors of 1 to {MOST_TILES} tiles"
    )]
    Size {
        /// Number of columns.
        columns: u16,
        /// Number of rows.
        rows: u16,
    },
    /// The simulated floor cannot be measured.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The recording does not fit into the memory of a page.
    #[error(
        "a page plays recordings of up to {MOST_MEGABYTES} MB; the program plays any: underfoot preview FILE"
    )]
    Large,
}

/// The name of the layout with which the page begins unless a link has another.
pub const FIRST: &str = "map";

/// The shipped layout of this name; an empty text for an unknown one.
#[must_use]
pub fn shipped(name: &str) -> SharedLayout {
    let text = schema::builtin_layout(name).unwrap_or_default().to_owned();
    SharedLayout { name: name.to_owned(), text, ..SharedLayout::default() }
}

/// The floor of this many columns and rows, or the usual one.
fn geometry_of(grid: Option<(u16, u16)>) -> Result<Geometry, NoFloor> {
    let Some((columns, rows)) = grid else { return Ok(Geometry::default()) };
    let tiles = u32::from(columns) * u32::from(rows);
    let wrong = NoFloor::Size { columns, rows };
    if tiles > MOST_TILES { Err(wrong) } else { Geometry::of_paper_tiles(columns, rows).map_err(|_| wrong) }
}

/// A layout and a measured floor, from which floors begin.
pub(crate) struct FloorPlan {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) own: OwnTexts,
    pub(crate) kinds: Arc<Kinds>,
    pub(crate) warnings: Warnings,
    pub(crate) layout: Layout,
    pub(crate) sim: SimFloor,
    pub(crate) floor: Arc<Floor>,
    pub(crate) build: FloorBuild,
}

impl FloorPlan {
    /// The layout of `shared` on a floor of its size; that of its visit, if it has one.
    pub(crate) fn of(shared: &SharedLayout) -> Result<Self, NoFloor> {
        let nominal = Floor::of(geometry_of(shared.grid)?);
        let own = OwnTexts::of(shared);
        let kinds = Arc::new(shared.all_kinds()?);
        let document = Document::read(&shared.name, &shared.text, &kinds, &Arc::new(nominal.clone()))?;
        let build = match &shared.visit {
            Some(visit) => visit.build()?,
            None => FloorBuild::of(FloorQuality::default(), SEED),
        };
        let (sim, floor) = build.in_use(&nominal)?;
        Ok(Self {
            name: shared.name.clone(),
            text: shared.text.clone(),
            own,
            kinds,
            warnings: Warnings::from(&document.review()),
            layout: document.layout().clone(),
            sim,
            floor: Arc::new(floor),
            build,
        })
    }
}
