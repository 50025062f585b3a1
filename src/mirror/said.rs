//! A text of a server, read.

use super::Greeting;
use crate::outgoing::json::{Head, Line};

/// Lines that are used; the receiver senses the same packets and so derives the rest.
const USED: [&str; 4] = ["state", "changed", "page", "error"];

/// A text that a server sends to a window.
#[derive(Debug)]
pub enum MirrorText {
    /// The state of its floor.
    Greeting(Box<Greeting>),
    /// A report about its controls or pages, or the reason for a refused request.
    Line(Box<Line>),
    /// A line that follows from the packets.
    Other,
}

impl MirrorText {
    /// Reads a text.
    ///
    /// # Errors
    /// The reason why the server can't be shown.
    pub fn read(text: &str) -> Result<Self, String> {
        let no_sense = |error| format!("the server says what makes no sense: {error}");
        let head = Head::read(text.as_bytes()).map_err(no_sense)?;
        if Greeting::is_in(&head) {
            return Ok(Self::Greeting(Box::new(Greeting::read(text).map_err(|error| error.to_string())?)));
        }
        if !USED.contains(&head.event()) {
            return Ok(Self::Other);
        }
        Ok(Self::Line(Box::new(head.line(text.as_bytes()).map_err(no_sense)?)))
    }
}
