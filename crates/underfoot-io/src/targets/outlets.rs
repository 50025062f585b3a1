//! The open ways to all targets of a layout: opened when needed, and again after a failure.

use std::time::{Duration, Instant};

use underfoot::messages::{Act, Holdable, SendTarget};

use super::outlet::{self, Outlet, OutletError};

/// Time between two attempts to open a target.
const AGAIN: Duration = Duration::from_millis(500);

/// All targets of one layout.
pub(super) struct Outlets {
    doors: Vec<Door>,
}

/// One target, with the state of the way to it.
struct Door {
    target: SendTarget,
    open: Option<Box<dyn Outlet>>,
    /// The last attempt to open it.
    tried: Option<Instant>,
    /// The last problem that was reported; each is reported once.
    told: Option<String>,
}

impl Outlets {
    /// The ways to `targets`, none of them open yet.
    pub(super) fn new(targets: Vec<SendTarget>) -> Self {
        let door = |target| Door { target, open: None, tried: None, told: None };
        Self { doors: targets.into_iter().map(door).collect() }
    }

    /// Carries out `act` at the target with this index; returns whether it was done. `notice` gets problems, each once,
    /// and their ends.
    pub(super) fn carry_out(&mut self, target: usize, act: &Act, notice: &mut dyn FnMut(String)) -> bool {
        self.with(target, notice, |outlet| outlet.carry_out(act))
    }

    /// Lets `what` come up at the target with this index; returns whether that was done.
    pub(super) fn release(&mut self, target: usize, what: &Holdable, notice: &mut dyn FnMut(String)) -> bool {
        self.with(target, notice, |outlet| outlet.release(what))
    }

    fn with(
        &mut self,
        target: usize,
        notice: &mut dyn FnMut(String),
        work: impl FnOnce(&mut dyn Outlet) -> Result<(), OutletError>,
    ) -> bool {
        let Some(door) = self.doors.get_mut(target) else { return false };
        let done = door.opened().and_then(work);
        match done {
            Ok(()) => {
                if door.told.take().is_some() {
                    notice(format!("target {}: it works again", door.target.name));
                }
                true
            }
            Err(error) => {
                if matches!(error, OutletError::Gone(_)) {
                    door.open = None;
                }
                let problem = error.to_string();
                if door.told.as_ref() != Some(&problem) {
                    notice(format!("target {}: {problem}", door.target.name));
                    door.told = Some(problem);
                }
                false
            }
        }
    }
}

impl Door {
    /// The open way; opens it unless that has just failed.
    fn opened(&mut self) -> Result<&mut dyn Outlet, OutletError> {
        if self.open.is_none() {
            if let Some(told) = &self.told
                && self.tried.is_some_and(|tried| tried.elapsed() < AGAIN)
            {
                return Err(OutletError::Gone(told.clone()));
            }
            self.tried = Some(Instant::now());
            self.open = Some(outlet::open(&self.target)?);
        }
        match &mut self.open {
            Some(open) => Ok(open.as_mut()),
            None => Err(OutletError::Gone("it is not open".into())),
        }
    }
}
