//! What happened when in a recording, at a glance.

use serde::Deserialize;

use super::entry::Entry;
use super::reader::{Part, Recording};
use crate::units::Instant;

/// What happened when in a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The recording's first and last moment so far.
    pub span: Option<(Instant, Instant)>,
    /// What people look for in it, in the order of time.
    pub marks: Vec<Mark>,
    /// Why it breaks off, if it does.
    pub broken: Option<String>,
}

/// A moment that people look for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    /// When.
    pub at: Instant,
    /// What.
    pub kind: MarkKind,
}

/// What people look for in a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// A press of the control with this id begins.
    Pressed(String),
    /// A press of the control with this id is cancelled.
    Cancelled(String),
    /// The link to the boards is lost.
    LinkLost,
}

/// Entries and lines between two calls of whoever wants to know how far it is: some seconds of a recording.
const ROUND: usize = 50_000;

impl Recording {
    /// Reads all of it. `tell` is called with what has been found now and then and at the end, and stops the reading by
    /// `false`.
    pub fn read_timeline(self, mut tell: impl FnMut(&Timeline) -> bool) {
        let (mut messages, mut timeline) = (self.into_messages(), Timeline::default());
        for round in 1_usize.. {
            match messages.next_part() {
                Part::Entry(_, Entry::Gap(_)) | Part::Attachment(..) | Part::Metadata { .. } => {}
                Part::Entry(taken, _) => {
                    let begins = timeline.span.map_or(taken, |(begins, _)| begins);
                    timeline.span = Some((begins, taken.max(begins)));
                }
                Part::Event(line) => timeline.marks.extend(mark(&line)),
                Part::Whole => break,
                Part::Broken(why) => {
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

/// What a line of events says of interest.
#[derive(Deserialize)]
struct Line {
    t_s: f64,
    #[serde(default)]
    event: String,
    #[serde(default)]
    id: String,
    #[serde(default)]
    state: serde_json::Value,
}

fn mark(line: &[u8]) -> Option<Mark> {
    let line: Line = serde_json::from_slice(line).ok()?;
    let kind = match line.event.as_str() {
        "pressed" => MarkKind::Pressed(line.id),
        "cancelled" => MarkKind::Cancelled(line.id),
        "link" if line.state == "lost" => MarkKind::LinkLost,
        _ => return None,
    };
    // A float becomes the nearest integer of its range.
    Some(Mark { at: Instant::from_micros((line.t_s * 1e6).round() as u64), kind })
}
