//! Programs that messages start, with arguments from the layout only and without a shell.

use std::process::{Child, Command, Stdio};
use std::time::Duration;

use underfoot::messages::{Act, Holdable, ProgramTarget};

use super::outlet::{Outlet, OutletError};

/// Maximum number of processes of one target at once (our choice: a program that hangs must not fill the computer).
const MOST: usize = 8;

/// A program as a target.
pub(super) struct ProgramOutlet {
    program: String,
    running: Vec<Child>,
}

impl ProgramOutlet {
    /// A program that the operator allows.
    pub(super) fn open(target: &ProgramTarget) -> Result<Self, OutletError> {
        if !target.is_allowed {
            let reason = format!("{} does not start: programs start with --allow-run only", target.program);
            return Err(OutletError::Gone(reason));
        }
        Ok(Self { program: target.program.clone(), running: Vec::new() })
    }

    /// Lets go of the processes that have ended; returns the failure of one, if there is any.
    fn reap(&mut self) -> Result<(), OutletError> {
        let mut failed = None;
        self.running.retain_mut(|child| match child.try_wait() {
            Ok(None) => true,
            Ok(Some(status)) => {
                failed = failed.take().or((!status.success()).then_some(status));
                false
            }
            Err(_) => false,
        });
        match failed {
            Some(status) => Err(OutletError::Refused(format!("{} has failed: {status}", self.program))),
            None => Ok(()),
        }
    }

    fn start(&mut self, arguments: &[String]) -> Result<(), OutletError> {
        if self.running.len() >= MOST {
            let reason = format!("{MOST} processes of {} run already", self.program);
            return Err(OutletError::Refused(reason));
        }
        let mut command = Command::new(&self.program);
        // The standard output of this process is its link to the server.
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null());
        // Ctrl-C is for the server alone.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let refused = |error| OutletError::Refused(format!("{} can't be started: {error}", self.program));
        self.running.push(command.spawn().map_err(refused)?);
        Ok(())
    }
}

impl Outlet for ProgramOutlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Run(arguments) => self.start(arguments),
            _ => Err(OutletError::Refused("a program starts at events only".into())),
        }
    }

    fn release(&mut self, _: &Holdable) -> Result<(), OutletError> {
        Ok(())
    }

    fn work(&mut self) -> Result<Option<Duration>, OutletError> {
        self.reap().map(|()| None)
    }
}
