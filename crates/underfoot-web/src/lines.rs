//! Events as lines of JSON, for the page around the window.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use underfoot::outgoing::json::{event_line, ignored_line, sent_line};
use underfoot::sink::{EventSink, Report};

/// Maximum number of lines that wait for a frame of the page.
const MOST: usize = 4096;

/// Writes each event of a control, each ignored press and each message to another program as the sink of JSON lines
/// does.
#[derive(Debug)]
pub(crate) struct EventLines {
    lines: SyncSender<String>,
    missed: u64,
}

impl EventLines {
    /// The sink, and its lines.
    pub(crate) fn new() -> (Self, Receiver<String>) {
        let (lines, received) = sync_channel(MOST);
        (Self { lines, missed: 0 }, received)
    }
}

impl EventSink for EventLines {
    fn report(&mut self, report: &Report<'_>) {
        let line = match report {
            Report::Event(event) => event_line(event),
            Report::Ignored(press) => ignored_line(press),
            Report::Message(news) => sent_line(news),
            _ => return,
        };
        if self.lines.try_send(line).is_err() {
            self.missed += 1;
        }
    }

    fn dropped(&self) -> u64 {
        self.missed
    }
}
