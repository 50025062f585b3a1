//! Contacts at a steady rate, always the latest: between the engine's thread and one that sends.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};
use std::time::Duration;

use crate::sense::Contact;
use crate::units::Instant;

/// Time between two reports of the contacts: the paper's 100 Hz.
const PERIOD: Duration = Duration::from_millis(10);

/// When contacts are to be reported.
#[derive(Debug)]
pub(super) struct PeriodicSender {
    /// How often it is said that nobody is there; `None` for once.
    idle: Option<Duration>,
    /// When the next report is due; `None` while nobody is on the floor.
    due: Option<Instant>,
    /// When it was last said that nobody is there.
    told_empty: Option<Instant>,
}

impl PeriodicSender {
    /// A sender that says once, or every `idle`, that nobody is on the floor.
    pub(super) const fn new(idle: Option<Duration>) -> Self {
        Self { idle, due: None, told_empty: None }
    }

    /// Whether `contacts` are to be reported now.
    pub(super) fn is_due(&self, at: Instant, contacts: &[Contact]) -> bool {
        match (self.due, contacts.is_empty(), self.idle) {
            (Some(due), _, _) => at >= due,
            (None, false, _) => true,
            (None, true, None) => false,
            (None, true, Some(idle)) => self.told_empty.is_none_or(|told| at.since(told) >= idle),
        }
    }

    /// Notes that `contacts` have been reported.
    pub(super) fn reported(&mut self, at: Instant, contacts: &[Contact]) {
        if contacts.is_empty() {
            self.due = None;
            self.told_empty = Some(at);
            return;
        }
        // Keep the period, unless a report is late.
        let next = self.due.unwrap_or(at) + PERIOD;
        self.due = Some(if next > at { next } else { at + PERIOD });
    }

    /// Whether somebody was there when contacts were last reported.
    pub(super) const fn is_somebody_there(&self) -> bool {
        self.due.is_some()
    }
}

/// The contacts to be sent next; older ones not yet sent are overwritten.
#[derive(Debug, Default)]
pub(super) struct Latest {
    contacts: Mutex<(Instant, Vec<Contact>)>,
    queued: AtomicBool,
}

impl Latest {
    /// Stores `contacts`, and has `queue` called if nobody is on the way to fetch them; false if the
    /// last ones are being fetched just now.
    pub(super) fn store(&self, at: Instant, contacts: &[Contact], queue: impl FnOnce() -> bool) -> bool {
        let mut stored = match self.contacts.try_lock() {
            Ok(stored) => stored,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return false,
        };
        stored.0 = at;
        stored.1.clear();
        stored.1.extend_from_slice(contacts);
        drop(stored);
        if !self.queued.swap(true, Ordering::AcqRel) && !queue() {
            self.queued.store(false, Ordering::Release);
        }
        true
    }

    /// Fetches them.
    pub(super) fn fetch(&self) -> (Instant, Vec<Contact>) {
        self.queued.store(false, Ordering::Release);
        self.contacts.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The milliseconds at which a report is made while somebody is there from 5 to 35 ms.
    fn reports(idle: Option<Duration>, until: u64) -> Vec<u64> {
        let mut periodic = PeriodicSender::new(idle);
        let mut reports = Vec::new();
        for ms in 0..until {
            let here = if (5..35).contains(&ms) { vec![Contact::default()] } else { vec![] };
            let at = Instant::from_millis(ms);
            if periodic.is_due(at, &here) {
                periodic.reported(at, &here);
                reports.push(ms);
            }
        }
        reports
    }

    #[test]
    fn the_rate_is_100_hz_and_ends_once_or_goes_on_slowly() {
        assert_eq!(reports(None, 1000), [5, 15, 25, 35]);
        assert_eq!(reports(Some(Duration::from_millis(300)), 1000), [0, 5, 15, 25, 35, 335, 635, 935]);
    }
}
