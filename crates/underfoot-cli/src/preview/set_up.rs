//! The set-up of a real floor, opened from the window: `underfoot setup --window` as a process of its own.

use std::thread;

use super::super::own_program;

/// Opens the set-up beside the window, where it stays when the window closes; returns the message for the user.
pub(super) fn open() -> String {
    let started = own_program::command().and_then(|mut program| program.args(["setup", "--window"]).spawn());
    // The system keeps an ended process until somebody asks how it ended.
    let waiting = started
        .and_then(|mut child| thread::Builder::new().name("set-up ends".into()).spawn(move || child.wait()));
    match waiting {
        Ok(_) => {
            "The set-up opens in a window of its own, and writes floor.ron in the present folder.".into()
        }
        Err(error) => {
            format!("The set-up cannot be opened ({error}): run underfoot setup --window in a terminal.")
        }
    }
}
