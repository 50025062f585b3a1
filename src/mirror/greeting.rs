//! The greeting: the data that a window needs first when it joins.

use serde::Deserialize;
use thiserror::Error;

use super::VERSION;
use crate::engine::{ControlState, Snapshot};
use crate::floor::Floor;
use crate::layout::Layout;
use crate::outgoing::json::{Few, GreetingRecord, Head, Line, Message, StateRecord, json_value};
use crate::schema::{self, Diagnostics};
use crate::sense::Method;
use crate::source::log::read_layout;
use crate::units::Instant;

/// Reasons why a window can't join.
#[derive(Debug, Error)]
pub enum MirrorError {
    /// The server's message is not a greeting.
    #[error("the server does not greet as one of this program does: {0}")]
    Greeting(#[from] serde_json::Error),
    /// The server uses another version.
    #[error(
        "the server speaks version {0} of the stream, this program {VERSION}: use the same program on both sides"
    )]
    Version(u8),
    /// The server's floor or layout can't be read.
    #[error("{0}")]
    Diagnostics(#[from] Diagnostics),
}

/// The state of a running floor at the time when a window joins.
#[derive(Clone, Debug)]
pub struct Greeting {
    /// The floor, with the current tare.
    pub floor: Floor,
    /// The current layout.
    pub layout: Layout,
    /// The text of that layout.
    pub layout_text: String,
    /// The method that makes contacts from tile forces.
    pub method: Method,
    /// The server's time.
    pub now: Instant,
    /// The current page; `None` in a layout without pages.
    pub page: Option<String>,
    /// Whether the server accepts layouts from others.
    pub takes_layouts: bool,
    /// The state of each control.
    pub controls: Vec<StateRecord>,
}

/// Maximum number of controls in a greeting: as many as a layout has.
const MOST_CONTROLS: usize = 4096;

/// Parsed first, since another version may differ in everything else.
#[derive(Deserialize)]
struct Version {
    version: u64,
}

const EVENT: &str = "mirror";
const EQ4: &str = "eq4";
const TRACKER: &str = "tracker";

impl Greeting {
    /// The greeting of a server as a line of JSON.
    #[must_use]
    pub fn line(
        floor: &Floor,
        layout: &Layout,
        snapshot: &Snapshot,
        method: Method,
        takes_layouts: bool,
    ) -> String {
        let states = (0..layout.widgets.len()).filter_map(|index| ControlState::of(layout, index, snapshot));
        let line = |state: ControlState| Line::new(Instant::START, Message::State(StateRecord::from(&state)));
        let record = GreetingRecord {
            event: EVENT.into(),
            version: VERSION,
            method: if method == Method::Eq4 { EQ4 } else { TRACKER }.into(),
            t_s: snapshot.at.secs(),
            page: layout.pages.get(snapshot.page).map(|page| page.id.as_str().into()),
            takes_layouts,
            floor: schema::write_floor(floor),
            layout: schema::write_layout(layout),
            controls: states.map(|state| json_value(&line(state))).collect::<Vec<_>>(),
        };
        // Strings and numbers can always be written as JSON.
        serde_json::to_string(&record).unwrap_or_default()
    }

    /// Whether a line is a greeting, regardless of its content.
    #[must_use]
    pub fn is_in(head: &Head) -> bool {
        head.event() == EVENT
    }

    /// Parses a line of [`Greeting::line`].
    ///
    /// # Errors
    /// [`MirrorError`] if it is not a greeting, is of another version, or if its floor or layout can't be read.
    pub fn read(line: &str) -> Result<Self, MirrorError> {
        if let Ok(Version { version }) = serde_json::from_str(line)
            && version != u64::from(VERSION)
        {
            return Err(MirrorError::Version(u8::try_from(version).unwrap_or(u8::MAX)));
        }
        let words: GreetingRecord<Few<StateRecord, MOST_CONTROLS>> = serde_json::from_str(line)?;
        let floor = schema::parse_floor(&words.floor, "the server's floor")?;
        let layout = read_layout(&words.layout, &floor.geometry)?;
        // The cast saturates.
        let now = Instant::from_micros((words.t_s * 1e6).round() as u64);
        Ok(Self {
            floor,
            layout,
            layout_text: words.layout,
            method: if words.method == EQ4 { Method::Eq4 } else { Method::Tracker },
            now,
            page: words.page.map(|page| page.0),
            takes_layouts: words.takes_layouts,
            controls: words.controls.kept,
        })
    }
}
