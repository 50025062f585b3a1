//! One line: its time and its message.

use std::time::Duration;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize, Serializer};

use super::{
    AreaRecord, ClientsRecord, ContactsRecord, CrackRecord, DeviceRecord, EventRecord, GapRecord,
    HealthRecord, HeldRecord, IgnoredRecord, LinkCauseRecord, LinkRecord, MuteRecord, PageRecord,
    RefusalRecord, SentRecord, StateRecord, Word,
};
use crate::engine::IgnoredPress;
use crate::messages::MessageNews;
use crate::units::Instant;
use crate::widget::{Direction, EventKind, Value, WidgetEvent};

/// A line of JSON: a time, and the fields of a message.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Time on the floor's sample clock; `None` in lines of the web server's own.
    #[serde(rename = "t_s", skip_serializing_if = "Option::is_none", serialize_with = "seconds")]
    pub at: Option<Instant>,
    /// The message.
    #[serde(flatten)]
    pub message: Message,
}

/// The content of a line, by the name in its field `event`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Message {
    /// A page is shown.
    Page(PageRecord),
    /// A ground has cracked.
    Crack(CrackRecord),
    /// The state of the link.
    Link(LinkRecord),
    /// The cause of unusable frames.
    LinkCause(LinkCauseRecord),
    /// The muted actuators.
    Mute(MuteRecord),
    /// The state of the sensors.
    Health(HealthRecord),
    /// The state of the device that drives the actuators.
    Device(DeviceRecord),
    /// The state of an area.
    Area(AreaRecord),
    /// A message of a control or a foot to another program.
    Sent(SentRecord),
    /// Lines were left out.
    Gap(GapRecord),
    /// The contacts on the floor.
    Contacts(ContactsRecord),
    /// A press that a control ignored.
    Ignored(IgnoredRecord),
    /// The state of a control.
    State(StateRecord),
    /// A refused request.
    Error(RefusalRecord),
    /// The number of web clients.
    Clients(ClientsRecord),
    /// The held controls, in a line without an event.
    #[serde(untagged)]
    Held(HeldRecord),
    /// An event of a control; its name is that of its kind.
    #[serde(untagged)]
    Control(EventRecord),
    /// An event that this version does not know; only reading makes it.
    #[serde(untagged)]
    Other {
        /// Its name.
        event: Word,
    },
}

/// Writes a time in seconds.
fn seconds<S: Serializer>(at: &Option<Instant>, serializer: S) -> Result<S::Ok, S::Error> {
    // A division, not a multiplication: it gives the number nearest to the decimal fraction, with six places at most.
    at.map(|at| at.micros() as f64 / 1e6).serialize(serializer)
}

/// Returns the time of a field `t_s`; the start of the clock for a number that is not a time.
fn instant(t_s: f64) -> Instant {
    let is_time = Duration::try_from_secs_f64(t_s).is_ok();
    // The cast saturates.
    if is_time { Instant::from_micros((t_s * 1e6).round() as u64) } else { Instant::START }
}

/// The parts of a line that tell its kind.
#[derive(Debug, Deserialize)]
pub struct Head {
    t_s: Option<f64>,
    #[serde(default)]
    event: Word,
    held: Option<IgnoredAny>,
}

impl Head {
    /// Reads the head of a line.
    ///
    /// # Errors
    /// An error if the text is not a JSON object, or has another type in the place of the time or the event.
    pub fn read(text: &[u8]) -> Result<Self, serde_json::Error> {
        serde_json::from_slice(text)
    }

    /// The name of the event; empty for held controls.
    #[must_use]
    pub fn event(&self) -> &str {
        self.event.as_str()
    }

    /// Time of the line; `None` in a line without a time.
    #[must_use]
    pub fn at(&self) -> Option<Instant> {
        self.t_s.map(instant)
    }

    /// Reads the whole line; `text` is that of this head.
    ///
    /// # Errors
    /// An error if a field has another type than its record.
    pub fn line(self, text: &[u8]) -> Result<Line, serde_json::Error> {
        let at = self.at();
        let message = if self.held.is_some() {
            Message::Held(serde_json::from_slice(text)?)
        } else {
            message(self.event, text)?
        };
        Ok(Line { at, message })
    }
}

fn message(event: Word, text: &[u8]) -> Result<Message, serde_json::Error> {
    Ok(match event.as_str() {
        "page" => Message::Page(serde_json::from_slice(text)?),
        "crack" => Message::Crack(serde_json::from_slice(text)?),
        "link" => Message::Link(serde_json::from_slice(text)?),
        "link_cause" => Message::LinkCause(serde_json::from_slice(text)?),
        "mute" => Message::Mute(serde_json::from_slice(text)?),
        "health" => Message::Health(serde_json::from_slice(text)?),
        "device" => Message::Device(serde_json::from_slice(text)?),
        "area" => Message::Area(serde_json::from_slice(text)?),
        "sent" => Message::Sent(serde_json::from_slice(text)?),
        "gap" => Message::Gap(serde_json::from_slice(text)?),
        "contacts" => Message::Contacts(serde_json::from_slice(text)?),
        "ignored" => Message::Ignored(serde_json::from_slice(text)?),
        "state" => Message::State(serde_json::from_slice(text)?),
        "error" => Message::Error(serde_json::from_slice(text)?),
        "clients" => Message::Clients(serde_json::from_slice(text)?),
        name if is_kind(name) => Message::Control(serde_json::from_slice(text)?),
        _ => Message::Other { event },
    })
}

/// Whether controls have events of this name.
fn is_kind(name: &str) -> bool {
    let with_detail = [EventKind::Changed(Value::Switch(true)), EventKind::Swiped(Direction::North)];
    EventKind::PLAIN.into_iter().chain(with_detail).any(|kind| kind.name() == name)
}

impl Line {
    /// A message with a time.
    #[must_use]
    pub const fn new(at: Instant, message: Message) -> Self {
        Self { at: Some(at), message }
    }

    /// A message without a time.
    #[must_use]
    pub const fn timeless(message: Message) -> Self {
        Self { at: None, message }
    }

    /// Reads a line.
    ///
    /// # Errors
    /// An error if the text is not a JSON object, or if a field has another type than its record.
    pub fn read(text: &[u8]) -> Result<Self, serde_json::Error> {
        Head::read(text)?.line(text)
    }

    /// The line as JSON, without an end of line.
    #[must_use]
    pub fn text(&self) -> String {
        // A record becomes a text in any case.
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Returns one message to another program as the sink of JSON lines writes it, without the end of the line.
#[must_use]
pub fn sent_line(news: &MessageNews) -> String {
    Line::new(news.at, Message::Sent(news.into())).text()
}

/// Returns one event as the sink of JSON lines writes it, without the end of the line.
#[must_use]
pub fn event_line(event: &WidgetEvent) -> String {
    Line::new(event.at, Message::Control(event.into())).text()
}

/// Returns one ignored press as the sink of JSON lines writes it, without the end of the line.
#[must_use]
pub fn ignored_line(press: &IgnoredPress) -> String {
    Line::new(press.at, Message::Ignored(press.into())).text()
}
