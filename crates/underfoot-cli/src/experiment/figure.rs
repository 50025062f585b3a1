//! Figures as pictures and data.

use std::path::Path;

use underfoot_lab::experiment::Figure;
use underfoot_scene::picture;

use super::options::FigureArgs;
use crate::failure::Failure;
use crate::fonts::fonts;

impl FigureArgs {
    /// Writes the picture twice and its data, and reports the results and the paths.
    pub(super) fn make(&self, name: &str, figure: &dyn Figure) -> Result<(), Failure> {
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |error| Failure::File(path, error)
        };
        std::fs::create_dir_all(&self.out).map_err(failed(&self.out))?;
        let scene = figure.draw();
        out!("{}", figure.summary());
        for ending in ["png", "svg"] {
            let path = self.out.join(name).with_extension(ending);
            picture::write(&scene, fonts(), &path, self.width)?;
            outln!("{}", path.display());
        }
        let path = self.out.join(name).with_extension("csv");
        std::fs::write(&path, figure.csv()).map_err(failed(&path))?;
        outln!("{}", path.display());
        Ok(())
    }
}
