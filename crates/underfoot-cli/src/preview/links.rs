//! Links of visits for the window: without a page, they begin with `#`.

use underfoot::floor::Geometry;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{LayoutToShare, ShareDesk};

use super::super::layout_args::LayoutArgs;
use super::super::share;

/// Links of layouts with the kinds and effects of the user's.
pub(super) struct ProgramLinks {
    files: LayoutArgs,
    geometry: Geometry,
}

impl ProgramLinks {
    /// Links of layouts on a floor of this geometry; `files` names the folders of kinds and effects.
    pub(super) fn new(files: &LayoutArgs, geometry: Geometry) -> Self {
        Self { files: files.clone(), geometry }
    }
}

impl ShareDesk for ProgramLinks {
    fn link(&self, layout: &LayoutToShare) -> Result<String, String> {
        let files = LayoutArgs { layout: layout.path.clone(), ..self.files.clone() };
        let own = share::own_texts(&files).map_err(|failure| failure.to_string())?;
        let (columns, rows) = (self.geometry.columns(), self.geometry.rows());
        if Geometry::of_paper_tiles(columns, rows).ok() != Some(self.geometry) {
            return Err("a link has floors of the paper\u{2019}s tiles alone".into());
        }
        let grid = (self.geometry != Geometry::default()).then_some((columns, rows));
        let shared = SharedLayout { name: layout.name.clone(), text: layout.text.clone(), grid, ..own };
        let mut used = shared.with_used_only(&self.geometry).map_err(|problems| problems.to_string())?;
        used.visit.clone_from(&layout.visit);
        used.fragment().map_err(|error| error.to_string())
    }

    fn has_page(&self) -> bool {
        false
    }
}
