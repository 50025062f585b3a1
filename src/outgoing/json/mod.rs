//! The vocabulary of JSON: one record for each kind of line, written and read by the same declaration.
//!
//! The sink for JSON lines, the web server, windows that join a floor, recordings and the commands of the program use
//! these records. `docs/osc-and-tuio.md` and `docs/web-app.md` describe the lines.
//!
//! | file | lines |
//! |---|---|
//! | `line.rs` | any line: its time and its message |
//! | `contact.rs` | contacts, and the cursor of a region |
//! | `control.rs` | events, states and holds of controls |
//! | `floor.rs` | pages, grounds, areas and gaps |
//! | `hardware.rs` | link, sensors and actuators |
//! | `web.rs` | requests and greetings of the web server |
//!
//! Readers accept fields that they do not know. A text, a list or a value that they keep has a limited length,
//! whatever a sender writes: `text.rs`, `value.rs`.

mod contact;
mod control;
mod floor;
mod hardware;
mod line;
#[cfg(test)]
mod tests;
mod text;
mod value;
mod web;

pub use contact::{ContactRecord, ContactsRecord, CursorRecord, SensedRecord};
pub use control::{EventRecord, HeldRecord, IgnoredRecord, StateRecord};
pub use floor::{AreaRecord, CrackRecord, GapRecord, PageRecord, SentRecord};
pub use hardware::{
    DeviceRecord, HealthRecord, LinkCauseRecord, LinkRecord, MuteRecord, RateRecord, TroubleRecord,
};
pub use line::{Head, Line, Message, event_line, ignored_line, sent_line};
pub use text::{Few, Sentence, Word};
pub use value::JsonValue;
pub use web::{ClientsRecord, FloorRecord, GreetingRecord, PlacedControl, RefusalRecord, RequestRecord};

/// Returns `record` as a JSON value, with its fields in the order of their names.
///
/// Numbers are those of the text: 0.1 is 0.1, not the nearest single-precision number.
#[must_use]
pub fn json_value(record: &impl serde::Serialize) -> serde_json::Value {
    // A record becomes a text in any case, and that text is JSON.
    serde_json::to_vec(record).and_then(|text| serde_json::from_slice(&text)).unwrap_or_default()
}
