//! A contact receiver for measuring the work of a floor.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use super::cores::{Core, stay_on};
use underfoot::sense::Contact;
use underfoot::sink::{EventSink, Report};
use underfoot::units;

/// Sends contacts to another thread at the rate of a node.
pub(super) struct Listener {
    out: SyncSender<Vec<Contact>>,
    contacts: Vec<Contact>,
    told: Instant,
}

impl Listener {
    /// Starts the receiving thread, which ends when this listener is dropped.
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
    fn report(&mut self, report: &Report<'_>) {
        if let Report::Contacts(_, contacts) = report {
            self.contacts.clear();
            self.contacts.extend_from_slice(contacts);
        }
    }

    fn poll(&mut self, _: units::Instant) {
        if self.told.elapsed() >= TOLD_EVERY {
            self.told = Instant::now();
            // The receiving thread keeps up, so a full channel is rare; contacts that do not fit are dropped.
            let _ = self.out.try_send(self.contacts.clone());
        }
    }
}

/// Interval at which a node sends its contacts to a gateway.
const TOLD_EVERY: Duration = Duration::from_millis(2);
