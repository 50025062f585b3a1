//! The events of a session, one after the other.

use std::time::Duration;

use super::event::{Event, Kind};
use super::session::Session;

/// Duration of one wait before the next one begins.
const HOUR: Duration = Duration::from_secs(3600);

/// The events of a session, one after the other; see [`Session::events`].
#[derive(Debug)]
pub struct Events<'a> {
    session: &'a Session,
    is_over: bool,
}

impl<'a> Events<'a> {
    pub(super) fn new(session: &'a Session) -> Self {
        Self { session, is_over: false }
    }
}

impl Iterator for Events<'_> {
    type Item = Event;

    fn next(&mut self) -> Option<Event> {
        while !self.is_over {
            match self.session.next_event_timeout(HOUR) {
                Some(event) => {
                    self.is_over = matches!(event.kind, Kind::Ended(_));
                    return Some(event);
                }
                // Another handle has taken the last event.
                None => self.is_over = self.session.is_drained(),
            }
        }
        None
    }
}

impl<'a> IntoIterator for &'a Session {
    type Item = Event;
    type IntoIter = Events<'a>;

    fn into_iter(self) -> Events<'a> {
        self.events()
    }
}
