//! The window of the first layout: `underfoot preview` as a process of its own.

use std::process::Child;

use super::super::{Args, layout_to_open};
use crate::failure::Failure;
use crate::own_program;

/// The open layout. It stays open if the set-up ends.
pub(super) struct LayoutWindow(Child);

impl LayoutWindow {
    /// Opens the layout on the floor file; returns also where the layout is.
    pub(super) fn open(args: &Args) -> Result<(Self, String), Failure> {
        let layout = layout_to_open(args)?;
        let child = own_program::command()
            .map_err(|error| failed(&error))?
            .arg("preview")
            .arg(&layout)
            .arg("--floor")
            .arg(&args.floor)
            .args(["--listen", &args.listen.to_string()])
            .spawn()
            .map_err(|error| failed(&error))?;
        Ok((Self(child), format!("{} is open on the floor.", layout.display())))
    }

    /// How it ended, once it has.
    pub(super) fn ended(&mut self) -> Option<Result<(), String>> {
        match self.0.try_wait() {
            Ok(None) => None,
            Ok(Some(status)) if status.success() => Some(Ok(())),
            Ok(Some(_)) => Some(Err("The layout did not stay open: the terminal has the reason.".to_owned())),
            Err(error) => Some(Err(failed(&error).to_string())),
        }
    }
}

fn failed(error: &std::io::Error) -> Failure {
    Failure::Other(format!("the layout cannot be opened: {error}"))
}
