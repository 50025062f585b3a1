//! Contacts at a steady rate, always the latest: between the engine's thread and one that sends.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};
use std::time::Duration;

use crate::sense::Contact;
use crate::units::Instant;

/// Time between two reports of the contacts: the paper's 100 Hz.
const PERIOD: Duration = Duration::from_millis(10);

/// How often an empty floor is told of: clients that came late learn that it is there.
pub(super) const IDLE: Duration = Duration::from_secs(1);

/// When contacts are to be reported.
#[derive(Debug, Default)]
pub(super) struct PeriodicSender {
    /// When the next report is due; `None` while nobody is on the floor.
    due: Option<Instant>,
    /// When it was last said that nobody is there.
    told_empty: Option<Instant>,
}

impl PeriodicSender {
    /// Whether `contacts` are to be reported now.
    pub(super) fn is_due(&self, at: Instant, contacts: &[Contact]) -> bool {
        match (self.due, contacts.is_empty()) {
            (Some(due), _) => at >= due,
            (None, false) => true,
            (None, true) => self.told_empty.is_none_or(|told| at.since(told) >= IDLE),
        }
    }

    /// Whether it is time to say again that nobody is there, where no frames say it.
    pub(super) fn is_silence_due(&self, now: Instant) -> bool {
        self.due.is_some() || self.told_empty.is_none_or(|told| now.since(told) >= IDLE)
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
    fn reports(until: u64) -> Vec<u64> {
        let mut periodic = PeriodicSender::default();
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
    fn the_rate_is_100_hz_and_once_a_second_while_nobody_is_there() {
        assert_eq!(reports(3100), [0, 5, 15, 25, 35, 1035, 2035, 3035]);
    }
}
