//! The model of the frozen pond, and people who walk on it.

use std::path::Path;

use serde::Serialize;
use underfoot::ground::IceSpec;
use underfoot_lab::experiment::{PondLaws, PondWalk};
use underfoot_scene::picture;

use super::options::PondArgs;
use crate::failure::Failure;
use crate::fonts::fonts;
use crate::output::print_json;

/// Measures model and walks, and writes the pictures.
pub(super) fn pond(args: &PondArgs) -> Result<(), Failure> {
    let laws = PondLaws::measure(IceSpec::POND, args.seed, args.events);
    let walk = PondWalk::measure(args.seed.into(), args.steps)?;
    if args.json {
        #[derive(Serialize)]
        struct Tables {
            laws: PondLaws,
            walk: PondWalk,
        }
        return print_json(&Tables { laws, walk });
    }
    outln!("{laws}\n{walk}");
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |error| Failure::File(path, error)
    };
    std::fs::create_dir_all(&args.out).map_err(failed(&args.out))?;
    for (name, scene) in PondWalk::pictures(args.seed.into())? {
        let path = args.out.join(name).with_extension("png");
        picture::write(&scene, fonts(), &path, args.width)?;
        outln!("{}", path.display());
    }
    let path = args.out.join("pond_walk.csv");
    std::fs::write(&path, walk.csv()).map_err(failed(&path))?;
    outln!("{}", path.display());
    Ok(())
}
