//! `underfoot reference`: the fields of files.

use underfoot::schema::{reference, write_reference};
use underfoot_sim as sim;

use super::failure::Failure;

/// Options of `underfoot reference`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Only this part: controls, feel, look, effects, grounds, or one of them by its name, such as Slider.
    name: Option<String>,
}

/// Prints the fields of files: each with its unit, range, default and meaning.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut chapters = reference();
    chapters.extend(sim::reference());
    let text = write_reference(&chapters, args.name.as_deref()).map_err(Failure::Other)?;
    outln!("{}", text.trim_end());
    Ok(())
}
