//! Options that choose a layout, its kinds and its effects.

use std::path::{Path, PathBuf};

use clap::Args;
#[cfg(feature = "preview")]
use underfoot::floor::Floor;
use underfoot::floor::Geometry;
use underfoot::layout::Layout;
use underfoot::schema::{self, Diagnostics, Effects, Kinds, Loaded};
#[cfg(feature = "preview")]
use underfoot_scene::ergonomics;
#[cfg(feature = "preview")]
use underfoot_window::edit::Template;

use super::failure::Failure;
use super::fonts::fonts;

/// Options that choose the layout.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct LayoutArgs {
    #[arg(value_name = "LAYOUT", help = format!("Layout file, or the name of a built-in one ({})", builtin_names()))]
    pub(crate) layout: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) misplaced: MisplacedLayout,
    /// Folder of control kinds to add; without it, a `widgets` folder beside the layout or beside its folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) widgets: Option<PathBuf>,
    /// Folder of effects to add; without it, an `effects` folder beside the layout or beside its folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) effects: Option<PathBuf>,
}

/// The names of all built-in layouts, for help.
pub(crate) fn builtin_names() -> String {
    schema::builtin_layouts().collect::<Vec<_>>().join(", ")
}

/// The option that other programs have for their files: accepted only to report where the layout belongs here.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct MisplacedLayout {
    #[arg(long = "layout", hide = true, value_name = "LAYOUT", value_parser = misplaced)]
    _option: Option<String>,
}

fn misplaced(layout: &str) -> Result<String, String> {
    let layout = if layout.is_empty() { "LAYOUT" } else { layout };
    Err(format!("the layout stands without an option: leave out `--layout` and write {layout} alone"))
}

/// The layout that is used if none is given.
pub(crate) const DEFAULT_LAYOUT: &str = "map";

impl LayoutArgs {
    /// Reads the chosen layout, checked for this floor, with its warnings.
    pub(crate) fn read(&self, geometry: &Geometry) -> Result<Loaded, Diagnostics> {
        let kinds = self.kinds()?;
        match self.path() {
            Some(path) => schema::load_layout(path, &kinds, geometry),
            None => {
                let name = self.layout.as_deref().and_then(Path::to_str).unwrap_or(DEFAULT_LAYOUT);
                let text = schema::builtin_layout(name).unwrap_or_default();
                schema::parse_layout(text, &format!("{name} (built in)"), &kinds, geometry)
            }
        }
    }

    /// Reads the chosen layout, checked for this floor; prints its warnings on standard error.
    pub(crate) fn load(&self, geometry: &Geometry) -> Result<Layout, Failure> {
        let loaded = self.read(geometry)?;
        if !loaded.warnings.is_empty() {
            err!("{}", loaded.warnings);
        }
        Ok(loaded.layout)
    }

    /// As [`LayoutArgs::load`], for a picture: also warns of letters that no font has.
    pub(crate) fn load_drawn(&self, geometry: &Geometry) -> Result<Layout, Failure> {
        let Loaded { layout, mut warnings, places, kinds: _ } = self.read(geometry)?;
        warnings.merge(places.undrawn(|text| fonts().missing(text)));
        if !warnings.is_empty() {
            err!("{warnings}");
        }
        Ok(layout)
    }

    /// As [`LayoutArgs::load`], with all warnings of `underfoot check`, and without output on standard error.
    #[cfg(feature = "preview")]
    pub(crate) fn reviewed(&self, floor: &Floor) -> Result<(Layout, Diagnostics), Failure> {
        let loaded = match self.begun() {
            Some(path) => {
                let text = Template::Empty.text(&floor.geometry);
                schema::parse_layout(&text, &path.display().to_string(), &self.kinds()?, &floor.geometry)?
            }
            None => self.read(&floor.geometry)?,
        };
        let mut warnings = loaded.warnings;
        warnings.merge(ergonomics::locate(&loaded.places, &ergonomics::review(&loaded.layout, floor)));
        warnings.merge(loaded.places.undrawn(|text| fonts().missing(text)));
        Ok((loaded.layout, warnings))
    }

    /// The file that a window begins: an empty one, or a missing one that could be created, since its name ends in
    /// `.ron` and its folder exists. `None` for any other.
    #[cfg(feature = "preview")]
    pub(crate) fn begun(&self) -> Option<&Path> {
        let path = self.path()?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let can_be_made =
            path.extension().is_some_and(|ending| ending == "ron") && folder.is_none_or(Path::is_dir);
        match std::fs::metadata(path) {
            Ok(file) => (file.is_file() && file.len() == 0).then_some(path),
            Err(error) => (error.kind() == std::io::ErrorKind::NotFound && can_be_made).then_some(path),
        }
    }

    /// The file to read and to watch; `None` for a built-in layout.
    pub(crate) fn path(&self) -> Option<&Path> {
        let path = self.layout.as_deref()?;
        let builtin = path.to_str().is_some_and(|name| schema::builtin_layout(name).is_some());
        (!builtin || path.exists()).then_some(path)
    }

    /// The shipped kinds and the user's.
    pub(crate) fn kinds(&self) -> Result<Kinds, Diagnostics> {
        let mut effects = Effects::builtin();
        if let Some(folder) = self.effects_folder() {
            effects.read_folder(&folder)?;
        }
        let mut kinds = Kinds::shipped(effects)?;
        if let Some(folder) = self.kinds_folder() {
            kinds.read_folder(&folder)?;
        }
        Ok(kinds)
    }

    /// The folder with the user's kinds, if there is one.
    pub(crate) fn kinds_folder(&self) -> Option<PathBuf> {
        if let Some(folder) = &self.widgets {
            return Some(folder.clone());
        }
        schema::folder_beside(self.path()?, "widgets")
    }

    /// The folder with the user's effects, if there is one.
    pub(crate) fn effects_folder(&self) -> Option<PathBuf> {
        // A built-in layout has no folder: the effects in the current folder are the user's.
        let here =
            || Some(PathBuf::from("effects")).filter(|folder| self.path().is_none() && folder.is_dir());
        let beside = || schema::folder_beside(self.path()?, "effects");
        self.effects.clone().or_else(beside).or_else(here)
    }
}
