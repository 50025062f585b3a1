//! An overview of a recording: its span and its important events.

use super::messages::LogPart;
use super::reader::Recording;
use crate::outgoing::json::{Line, Message};
use crate::source::log::LogEntry;
use crate::units::Instant;

/// An overview of a recording; of a trimmed one, of the part on display.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// First and last time of the recording so far.
    pub span: Option<(Instant, Instant)>,
    /// The important events, in the order of time.
    pub marks: Vec<TimelineMark>,
    /// Reason for a break in the recording, if any.
    pub broken: Option<String>,
}

/// An important event.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimelineMark {
    /// Time of the event.
    pub at: Instant,
    /// Kind of the event.
    pub kind: MarkKind,
}

/// Kind of an important event.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// A press of the control with this id begins.
    Pressed(String),
    /// A press of the control with this id is cancelled.
    Cancelled(String),
    /// The link to the boards is lost.
    LinkLost,
}

/// Number of entries and lines between two progress reports: some seconds of a recording.
const ROUND: usize = 50_000;

impl Recording {
    /// Reads the whole recording. Calls `tell` from time to time and at the end with the results so far; `false` from
    /// it stops the reading.
    pub fn read_timeline(self, mut tell: impl FnMut(&Timeline) -> bool) {
        let from = self.begins().unwrap_or(Instant::START);
        let (mut parts, mut timeline) = (self.into_parts(), Timeline::default());
        for round in 1_usize.. {
            match parts.next_part() {
                LogPart::Entry(_, LogEntry::Gap(_)) => {}
                LogPart::Entry(taken, _) => {
                    let begins = timeline.span.map_or(taken.max(from), |(begins, _)| begins);
                    timeline.span = Some((begins, taken.max(begins)));
                }
                LogPart::Event(line) => {
                    timeline.marks.extend(mark(&line).filter(|mark| mark.at >= from));
                }
                LogPart::Whole => break,
                LogPart::Broken(why) => {
                    timeline.broken = Some(why);
                    break;
                }
            }
            if round % ROUND == 0 && !tell(&timeline) {
                return;
            }
        }
        tell(&timeline);
    }
}

fn mark(line: &[u8]) -> Option<TimelineMark> {
    let line = Line::read(line).ok()?;
    let kind = match line.message {
        Message::Control(event) if event.event == "pressed" => MarkKind::Pressed(event.id.0),
        Message::Control(event) if event.event == "cancelled" => MarkKind::Cancelled(event.id.0),
        Message::Link(link) if link.state == "lost" => MarkKind::LinkLost,
        _ => return None,
    };
    Some(TimelineMark { at: line.at?, kind })
}
