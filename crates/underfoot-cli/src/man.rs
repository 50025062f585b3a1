//! `underfoot man`: pages for `man`, from the descriptions of the commands.

use std::path::PathBuf;

use clap::Command;
use clap_mangen::Man;

use super::failure::Failure;

/// Options of `underfoot man`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Write this page and one of each command into a folder, which is made if it is missing; without it, print this
    /// page.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Prints the page of the program `command`, or writes it and those of its commands.
pub(crate) fn run(args: &Args, command: Command) -> Result<(), Failure> {
    if let Some(folder) = &args.out {
        return std::fs::create_dir_all(folder)
            .and_then(|()| clap_mangen::generate_to(command, folder))
            .map_err(|error| Failure::File(folder.clone(), error));
    }
    let mut page = Vec::new();
    // As in the folder of all pages.
    Man::new(command.disable_help_subcommand(true))
        .render(&mut page)
        .map_err(|error| Failure::Other(error.to_string()))?;
    out!("{}", String::from_utf8_lossy(&page));
    Ok(())
}
