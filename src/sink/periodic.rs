//! Contacts at a steady rate, always the latest, from the engine's thread to a sending thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};
use std::time::Duration;

use crate::sense::Contact;
use crate::units::Instant;

/// Time between two reports of the contacts: the paper's 100 Hz.
const PERIOD: Duration = Duration::from_millis(10);

/// Interval between reports of an empty floor, so that late clients learn that the floor exists.
pub(super) const IDLE: Duration = Duration::from_secs(1);

/// Schedule of the contact reports.
#[derive(Debug, Default)]
pub(super) struct PeriodicSender {
    /// Due time of the next report; `None` while the floor is empty.
    due: Option<Instant>,
    /// Time of the last report of an empty floor.
    told_empty: Option<Instant>,
}

impl PeriodicSender {
    /// Whether `contacts` are due now.
    pub(super) fn is_due(&self, at: Instant, contacts: &[Contact]) -> bool {
        match (self.due, contacts.is_empty()) {
            (Some(due), _) => at >= due,
            (None, false) => true,
            (None, true) => self.told_empty.is_none_or(|told| at.since(told) >= IDLE),
        }
    }

    /// Whether the report of an empty floor is due while no frames come.
    pub(super) fn is_silence_due(&self, now: Instant) -> bool {
        self.due.is_some() || self.told_empty.is_none_or(|told| now.since(told) >= IDLE)
    }

    /// Records that `contacts` have been reported.
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

    /// Whether the last report had contacts.
    pub(super) const fn is_somebody_there(&self) -> bool {
        self.due.is_some()
    }
}

/// The contacts to send next; newer ones overwrite unsent ones.
#[derive(Debug, Default)]
pub(super) struct Latest {
    contacts: Mutex<(Instant, Vec<Contact>)>,
    queued: AtomicBool,
}

impl Latest {
    /// Stores `contacts`, and calls `queue` if no job is under way to fetch them; false if the worker is fetching the
    /// previous ones.
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

    /// Fetches the latest contacts.
    pub(super) fn fetch(&self) -> (Instant, Vec<Contact>) {
        self.queued.store(false, Ordering::Release);
        self.contacts.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the milliseconds of the reports for a contact from 5 to 35 ms.
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
