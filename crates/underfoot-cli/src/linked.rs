//! A link in the place of a layout: its layout, its floor, and the visit in it.

use std::path::Path;
use std::sync::Arc;

use underfoot::floor::{Floor, Geometry};
use underfoot::layout::Layout;
use underfoot::schema::parse_layout;
use underfoot_sim::{FloorBuild, RecordedFeet};
use underfoot_window::link::{LinkError, SharedLayout};

use super::failure::Failure;

/// Whether an argument in place of a layout is a link.
pub(crate) fn is_link(argument: &Path) -> bool {
    let is_address = |text: &str| text.contains("://") || text.contains('#') && !text.ends_with(".ron");
    argument.to_str().is_some_and(is_address) && !argument.exists()
}

/// The size of the floor of a link; `None` for the usual one.
pub(crate) fn geometry_of(shared: &SharedLayout) -> Result<Option<Geometry>, Failure> {
    let geometry = shared.grid.map(|(columns, rows)| Geometry::of_paper_tiles(columns, rows)).transpose();
    geometry.map_err(|error| Failure::Other(format!("the floor of the link: {error}")))
}

/// A visit in a link.
#[derive(Clone, Debug)]
pub(crate) struct LinkedVisit {
    /// The feet over time.
    pub(crate) feet: Arc<RecordedFeet>,
    /// The way to the simulated floor.
    pub(crate) build: FloorBuild,
}

impl LinkedVisit {
    /// The visit of a link; `None` in a link without one.
    pub(crate) fn of(shared: &SharedLayout) -> Result<Option<Self>, Failure> {
        let read = |visit: &underfoot_window::link::SharedVisit| -> Result<Self, LinkError> {
            Ok(Self { feet: Arc::new(visit.feet()?), build: visit.build()? })
        };
        Ok(shared.visit.as_ref().map(read).transpose()?)
    }
}

/// The content of a link, checked for its floor.
pub(crate) struct Linked {
    pub(crate) floor: Floor,
    pub(crate) layout: Layout,
    pub(crate) visit: Option<LinkedVisit>,
}

impl Linked {
    /// Reads `link`; prints warnings about the layout on standard error.
    pub(crate) fn read(link: &str) -> Result<Self, Failure> {
        let shared = SharedLayout::of_link(link)?;
        let floor = Floor::of(geometry_of(&shared)?.unwrap_or_default());
        let loaded = parse_layout(&shared.text, &shared.name, &shared.all_kinds()?, &floor.geometry)?;
        if !loaded.warnings.is_empty() {
            err!("{}", loaded.warnings);
        }
        Ok(Self { floor, layout: loaded.layout, visit: LinkedVisit::of(&shared)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_no_link_and_an_address_is_one() {
        for (argument, is) in
            [("map", false), ("rooms/a#1.ron", false), ("#1.abc", true), ("https://a.example/#x", true)]
        {
            assert_eq!(is_link(Path::new(argument)), is, "{argument}");
        }
    }
}
