//! `underfoot reference`: what files may say.

use underfoot::schema::write_reference;

use super::failure::Failure;

/// What `underfoot reference` is asked to do.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Only this: controls, feel, look, effects, grounds, or one of them by its name, such as Slider.
    name: Option<String>,
}

/// Prints what files may say: each field with its unit, range, default and meaning.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let text = write_reference(args.name.as_deref()).map_err(Failure::Other)?;
    outln!("{}", text.trim_end());
    Ok(())
}
