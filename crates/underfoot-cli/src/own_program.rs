//! This program, started once more as another process: the guardian, a window, a step of the set-up.

use std::io;
use std::process::Command;

/// The command that starts this program again: the same version, also after an update has replaced its file.
///
/// # Errors
/// The system does not tell where its file is.
pub(crate) fn command() -> io::Result<Command> {
    let program = std::env::current_exe()?;
    // Linux keeps the file of a program that runs, and the link to it leads there once the name is gone.
    #[cfg(target_os = "linux")]
    if !program.exists() {
        let mut command = Command::new("/proc/self/exe");
        std::os::unix::process::CommandExt::arg0(&mut command, "underfoot");
        return Ok(command);
    }
    Ok(Command::new(program))
}
