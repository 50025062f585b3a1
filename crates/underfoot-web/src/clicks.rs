//! Clicks under the feet, for the motor of a phone.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use underfoot::sink::{EventSink, Report};
use underfoot::widget::EventKind;

/// Whether a control clicked since the last look.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clicks(Arc<AtomicBool>);

impl Clicks {
    /// Returns whether a control clicked since the last call.
    pub(crate) fn take(&self) -> bool {
        self.0.swap(false, Ordering::Relaxed)
    }
}

impl EventSink for Clicks {
    fn report(&mut self, report: &Report<'_>) {
        use EventKind::{Armed, Clicked, HardPressed, Pressed, Ticked};
        if let Report::Event(event) = report
            && matches!(event.kind, Pressed | Clicked | HardPressed | Ticked | Armed)
        {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}
