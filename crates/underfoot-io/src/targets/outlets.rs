//! The open ways to all targets of a layout: opened when needed, and again after a failure.

use std::time::{Duration, Instant};

use underfoot::messages::{Act, Holdable, SendTarget};

use super::outlet::{self, Outlet, OutletError};

/// Time between two attempts to open a target.
const AGAIN: Duration = Duration::from_millis(500);

/// Time until a target that cannot be reached is asked again for what is due.
const TROUBLE: Duration = Duration::from_millis(20);

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
    /// The ports that received from it when somebody looked last.
    receivers: Vec<String>,
    /// Those of them that it must be connected to once both are there.
    missing: Vec<String>,
}

impl Outlets {
    /// The ways to `targets`, none of them open yet.
    pub(super) fn new(targets: Vec<SendTarget>) -> Self {
        Self { doors: targets.into_iter().map(Door::new).collect() }
    }

    /// Changes to the ways to `targets`; one that was there before stays open, with its connections.
    pub(super) fn change(&mut self, targets: Vec<SendTarget>) {
        let mut before = std::mem::take(&mut self.doors);
        let door = |target: SendTarget| match before.iter().position(|door| door.target == target) {
            Some(index) => before.swap_remove(index),
            None => Door::new(target),
        };
        self.doors = targets.into_iter().map(door).collect();
        before.iter_mut().for_each(Door::end);
    }

    /// Opens all targets; those that are gone are tried again later.
    pub(super) fn open(&mut self) {
        self.doors.iter_mut().for_each(|door| drop(door.opened()));
    }

    /// Whether the way to a target is still being opened.
    pub(super) fn are_opening(&mut self) -> bool {
        self.doors.iter_mut().filter_map(|door| door.open.as_mut()).any(|open| open.is_opening())
    }

    /// Does what is due at all open targets; returns the time until it must be called again, if there is one. `notice` gets
    /// problems, each once, and their ends.
    pub(super) fn work(&mut self, notice: &mut dyn FnMut(String)) -> Option<Duration> {
        let mut soonest: Option<Duration> = None;
        for door in &mut self.doors {
            let Some(open) = &mut door.open else { continue };
            let due = match open.work() {
                Ok(None) => continue,
                Ok(Some(due)) => {
                    door.works(notice);
                    due
                }
                Err(error) => {
                    door.fails(&error, notice);
                    TROUBLE
                }
            };
            soonest = Some(soonest.map_or(due, |soonest| soonest.min(due)));
        }
        soonest
    }

    /// Forgets the states of an earlier layout at all open targets.
    pub(super) fn forget(&mut self) {
        self.doors.iter_mut().filter_map(|door| door.open.as_mut()).for_each(|open| open.forget());
    }

    /// Says goodbye to all open targets.
    pub(super) fn end(&mut self) {
        self.doors.iter_mut().for_each(Door::end);
    }

    /// The ports that receive from each open target by connections, with the index of the target.
    pub(super) fn receivers(&mut self) -> Vec<(usize, Vec<String>)> {
        let open = self.doors.iter_mut().enumerate().filter_map(|(index, door)| {
            let mut receivers = door.open.as_mut()?.receivers()?;
            receivers.extend(door.missing.iter().cloned());
            receivers.sort();
            receivers.dedup();
            door.receivers.clone_from(&receivers);
            Some((index, receivers))
        });
        open.collect()
    }

    /// Opens the target with this index, and connects it to these ports.
    pub(super) fn connect(&mut self, target: usize, receivers: Vec<String>) {
        if let Some(door) = self.doors.get_mut(target) {
            door.missing = receivers;
            // Problems appear with its first message.
            let _ = door.opened();
        }
    }

    /// Opens targets again that were gone, and connects ports that have opened or appeared meanwhile.
    pub(super) fn settle(&mut self) {
        let waiting = self.doors.iter_mut().filter(|door| match door.open {
            Some(_) => !door.missing.is_empty(),
            None => door.told.is_some(),
        });
        waiting.for_each(|door| drop(door.opened()));
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
                door.works(notice);
                true
            }
            Err(error) => {
                door.fails(&error, notice);
                false
            }
        }
    }
}

impl Door {
    const fn new(target: SendTarget) -> Self {
        Self { target, open: None, tried: None, told: None, receivers: Vec::new(), missing: Vec::new() }
    }

    /// Says goodbye to the target.
    fn end(&mut self) {
        if let Some(open) = &mut self.open {
            open.end();
        }
    }

    /// Reports the end of a problem.
    fn works(&mut self, notice: &mut dyn FnMut(String)) {
        if self.told.take().is_some() {
            notice(format!("target {}: it works again", self.target.name));
        }
    }

    /// Reports a problem, if it is a new one; closes a way that is gone.
    fn fails(&mut self, error: &OutletError, notice: &mut dyn FnMut(String)) {
        if matches!(error, OutletError::Gone(_)) {
            self.open = None;
            self.missing.clone_from(&self.receivers);
        }
        let problem = error.to_string();
        if self.told.as_ref() != Some(&problem) {
            notice(format!("target {}: {problem}", self.target.name));
            self.told = Some(problem);
        }
    }

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
            Some(open) => {
                if !self.missing.is_empty()
                    && let Ok(missing) = open.connect(&self.missing)
                {
                    self.missing = missing;
                }
                Ok(open.as_mut())
            }
            None => Err(OutletError::Gone("it is not open".into())),
        }
    }
}
