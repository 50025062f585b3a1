//! The events and frames since the last message.

use underfoot::sink::Report;
use underfoot::wire::LinkState;

use crate::message::{NodeContact, NodeEvent, NodeFrame, NodeMessage};

/// Greatest number of events in a draft; older ones are dropped, which the numbers show.
const MOST_EVENTS: usize = 2048;

/// Greatest number of frames in a draft; older ones are dropped.
const MOST_FRAMES: usize = 64;

/// A message without its sender and time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draft {
    frame: Option<u64>,
    silent: bool,
    contacts: Vec<NodeContact>,
    earlier: Vec<NodeFrame>,
    /// The time of the last frame that has been, or will be, reported.
    told: u64,
    first_event: u64,
    events: Vec<NodeEvent>,
    held: Vec<String>,
    page: Option<String>,
}

impl Draft {
    /// Adds `report`; returns whether it holds a new frame.
    pub fn note(&mut self, report: &Report<'_>) -> bool {
        match report {
            Report::Event(event) => {
                if self.events.len() == MOST_EVENTS {
                    self.events.remove(0);
                    self.first_event += 1;
                }
                self.events.push(NodeEvent::of(event));
            }
            Report::Contacts(at, contacts) => {
                let at = at.micros();
                // Between two frames a landing foot moves some millimetres, and not in a straight line.
                if let Some(last) = self.frame.filter(|last| *last > self.told) {
                    if self.earlier.len() == MOST_FRAMES {
                        self.earlier.remove(0);
                    }
                    self.earlier.push(NodeFrame { at: last, contacts: self.contacts.clone() });
                    self.told = last;
                }
                self.frame = Some(at);
                self.contacts.clear();
                self.contacts.extend(contacts.iter().map(NodeContact::of));
                return true;
            }
            Report::Held(report) => {
                self.held.clear();
                self.held.extend(report.held.iter().map(|id| id.as_str().to_owned()));
            }
            Report::Page(shown) => self.page = Some(shown.page.as_str().to_owned()),
            Report::Link(_, state) => self.silent = matches!(state, LinkState::Lost | LinkState::Waiting),
            _ => {}
        }
        false
    }

    /// Whether the draft holds events.
    #[must_use]
    pub fn has_events(&self) -> bool {
        !self.events.is_empty()
    }

    /// Clears the draft after it was sent.
    pub fn sent(&mut self) {
        self.first_event += self.events.len() as u64;
        self.events.clear();
        self.earlier.clear();
        self.told = self.frame.unwrap_or(0);
    }

    /// The message; `head` has its sender, its time and all else that a draft lacks.
    #[must_use]
    pub fn message(self, head: NodeMessage) -> NodeMessage {
        let Self { frame, silent, contacts, earlier, first_event, events, held, page, .. } = self;
        NodeMessage { frame, silent, contacts, earlier, first_event, events, held, page, ..head }
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use underfoot::units::{Instant, Newtons};
    use underfoot::widget::{EventKind, WidgetEvent, WidgetId};

    use super::*;

    #[test]
    fn all_frames_that_come_at_once_are_told() {
        let mut draft = Draft::default();
        let note = |draft: &mut Draft, ms| {
            _ = draft.note(&Report::Contacts(Instant::from_millis(ms), Cow::Borrowed(&[])));
        };
        note(&mut draft, 1);
        draft.sent();
        (2..9).for_each(|ms| note(&mut draft, ms));
        let message = draft.clone().message(NodeMessage::default());
        let told: Vec<u64> = message.earlier.iter().map(|frame| frame.at / 1000).collect();
        assert_eq!((told, message.frame), ((2..8).collect(), Some(8000)));
        draft.sent();
        note(&mut draft, 10);
        assert!(draft.message(NodeMessage::default()).earlier.is_empty());
    }

    #[test]
    fn events_are_numbered_through_and_what_is_dropped_leaves_a_gap() {
        let event = WidgetEvent {
            at: Instant::START,
            id: WidgetId::new("zoom"),
            kind: EventKind::Ticked,
            contact: None,
            force: Newtons::ZERO,
            position: Default::default(),
        };
        let mut draft = Draft::default();
        draft.note(&Report::Event(Cow::Borrowed(&event)));
        draft.note(&Report::Event(Cow::Borrowed(&event)));
        assert_eq!((draft.first_event, draft.events.len()), (0, 2));
        draft.sent();
        (0..MOST_EVENTS + 3).for_each(|_| {
            draft.note(&Report::Event(Cow::Borrowed(&event)));
        });
        let message = draft.message(NodeMessage::default());
        assert_eq!((message.first_event, message.events.len()), (5, MOST_EVENTS));
    }
}
