//! Entries in the order in which the server took them, even if a tool has sorted the file by time.

use std::collections::VecDeque;
use std::fmt;
use std::path::Path;

use super::messages::{LogPart, MessageReader, Numbered};
use crate::source::log::LogEntry;
use crate::units::Instant;

/// Maximum number of entries of one time that are sorted: a second of a floor of 65 boards.
const MOST_AT_ONCE: usize = 1 << 16;

/// The parts of a recording in order: entries with the same time are sorted by number.
///
/// The first recordings have no numbers; their entries keep the order of the file.
pub(super) struct Ordered {
    messages: MessageReader,
    /// Entries of one time, and whether they are complete and sorted.
    waiting: VecDeque<(Instant, u32, LogEntry)>,
    is_sorted: bool,
    /// The part after them.
    ahead: Option<Numbered>,
    last: Option<(Instant, u32)>,
}

impl Ordered {
    pub(super) const fn new(messages: MessageReader) -> Self {
        Self { messages, waiting: VecDeque::new(), is_sorted: false, ahead: None, last: None }
    }

    /// Name of the file.
    pub(super) fn path(&self) -> &Path {
        self.messages.path()
    }

    /// Number of messages so far on topics of other programs.
    pub(super) const fn foreign(&self) -> u64 {
        self.messages.foreign()
    }

    /// The next part; after the end or a fault, the same part again.
    pub(super) fn next_part(&mut self) -> LogPart {
        loop {
            if self.is_sorted {
                if let Some((taken, number, entry)) = self.waiting.pop_front() {
                    self.last = Some((taken, number));
                    return LogPart::Entry(taken, entry);
                }
                self.is_sorted = false;
            }
            if let Some(other) = self.fill() {
                return other;
            }
            self.sort();
        }
    }

    /// Collects the entries of the next time; returns `None` once they are complete, or a part that is not an entry.
    fn fill(&mut self) -> Option<LogPart> {
        loop {
            let next = self.ahead.take().unwrap_or_else(|| self.messages.next());
            let moment = self.waiting.front().map(|(taken, ..)| *taken);
            match next {
                Numbered::Entry(taken, number, entry)
                    if moment.is_none_or(|moment| moment == taken) && self.waiting.len() < MOST_AT_ONCE =>
                {
                    if let Some((last, _)) = self.last.filter(|(last, _)| taken < *last) {
                        return Some(LogPart::Broken(out_of_order(taken, last)));
                    }
                    self.waiting.push_back((taken, number, entry));
                }
                // Lines of events come from another thread, so their order among entries is undefined.
                Numbered::Part(LogPart::Event(line)) => return Some(LogPart::Event(line)),
                Numbered::Part(part) if self.waiting.is_empty() => return Some(part),
                behind => {
                    self.ahead = Some(behind);
                    return None;
                }
            }
        }
    }

    fn sort(&mut self) {
        // Numbers wrap: they are sorted relative to the last returned one.
        let base = self.last.map_or(0, |(_, number)| number);
        self.waiting.make_contiguous().sort_by_key(|(_, number, _)| number.wrapping_sub(base));
        self.is_sorted = true;
    }
}

fn out_of_order(taken: Instant, last: Instant) -> String {
    format!(
        "its messages are not in the order of time: one of {:.6} s follows one of {:.6} s (`mcap sort` puts them in \
         order)",
        taken.secs(),
        last.secs()
    )
}

impl fmt::Debug for Ordered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Ordered").field("path", &self.path()).finish_non_exhaustive()
    }
}
