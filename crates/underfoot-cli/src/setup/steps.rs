//! Steps that are other commands, run on the floor file.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;
use crate::own_program;

/// Runs other commands of this program. Ctrl-C ends the command, and the set-up only at a question.
pub(super) struct FloorCommands {
    is_asking: Arc<AtomicBool>,
    listen: String,
}

impl FloorCommands {
    /// Commands that listen on `listen`.
    pub(super) fn new(listen: String) -> Result<Self, Failure> {
        let is_asking = Arc::new(AtomicBool::new(true));
        #[cfg(unix)]
        signal_hook::flag::register_conditional_default(signal_hook::consts::SIGINT, Arc::clone(&is_asking))
            .map_err(|error| Failure::Other(format!("signals can't be handled: {error}")))?;
        Ok(Self { is_asking, listen })
    }

    /// Runs a command on the floor file at `floor`; shows it, so that it can be run alone later. Returns whether it
    /// succeeded.
    pub(super) fn run(&self, command: &[&str], floor: &Path, options: &[&str]) -> bool {
        let floor = floor.to_string_lossy();
        let mut words: Vec<&str> = command.to_vec();
        words.extend(["--floor", &floor, "--listen", &self.listen]);
        words.extend(options);
        outln!("$ underfoot {}", words.join(" "));
        let done = own_program::command().and_then(|mut program| {
            self.is_asking.store(false, Ordering::Relaxed);
            let status = program.args(&words).status();
            self.is_asking.store(true, Ordering::Relaxed);
            status
        });
        match done {
            Ok(status) if status.success() => true,
            Ok(_) => {
                outln!("That did not succeed; the step can be repeated.");
                false
            }
            Err(error) => {
                outln!("The command cannot be run: {error}.");
                false
            }
        }
    }
}
