//! Who is told of contacts while a floor's work is measured.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use super::cores::{Core, stay_on};
use crate::sense::Contact;
use crate::sink::{EventSink, Report};
use crate::units;

/// Hands contacts to another thread, as often as a node does.
pub(super) struct Listener {
    out: SyncSender<Vec<Contact>>,
    contacts: Vec<Contact>,
    told: Instant,
}

impl Listener {
    /// Starts the other thread, which ends with this.
    pub(super) fn start() -> Self {
        let (out, told) = sync_channel(16);
        thread::spawn(move || {
            stay_on(Core::First);
            while told.recv().is_ok() {}
        });
        Self { out, contacts: Vec::new(), told: Instant::now() }
    }
}

impl EventSink for Listener {
    fn report(&mut self, report: Report<'_>) {
        if let Report::Contacts(_, contacts) = report {
            self.contacts.clear();
            self.contacts.extend_from_slice(contacts);
        }
    }

    fn poll(&mut self, _: units::Instant) {
        if self.told.elapsed() >= TOLD_EVERY {
            self.told = Instant::now();
            // The other thread is never behind for long.
            let _ = self.out.try_send(self.contacts.clone());
        }
    }
}

/// How often a node tells a gateway its contacts.
const TOLD_EVERY: Duration = Duration::from_millis(2);
