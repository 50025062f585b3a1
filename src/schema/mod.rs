//! RON files: floors, control kinds and layouts, checked and converted to the engine's types.
//!
//! One reading finds all problems of a file, each with its place; the result is a complete layout or none. A file is
//! read in these steps, one module each:
//!
//! ```text
//! bytes -format-> tree with spans, fields in range
//!   -layout_record, control, ground, arrange, kind, inherit, floor-> what was meant -checks-> Layout, ControlKind, Effect, Floor
//! ```
//!
//! Apps may also read values that can be read alone, and write all of them, by the crate `ron`; what such a value
//! names comes from the kinds and effects that come with underfoot:
//!
//! ```
//! use underfoot::schema::ControlKind;
//!
//! let text = r#"Kind(name: "bell", from: "button", press_n: 80, feel: (press: "soft_click"))"#;
//! let kind: ControlKind = ron::from_str(text)?;
//! assert_eq!(kind.look.face.to_string(), "#d8e4f0");
//! let written = ron::ser::to_string_pretty(&kind, ron::ser::PrettyConfig::new())?;
//! assert_eq!(ron::from_str::<ControlKind>(&written)?, kind);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ahap;
mod area;
mod arrange;
mod behaviour;
mod builtin;
mod chain;
mod checks;
mod context;
mod control;
mod effect;
mod floor;
mod floor_areas;
mod floor_codecs;
mod floor_measures;
mod floor_off;
mod floor_parts;
mod floor_plates;
mod floor_serial;
mod floor_text;
mod ground;
mod inherit;
mod kind;
mod layout_record;
mod lists;
mod locate;
mod page;
mod pages;
mod place;
mod places;
mod reference;
mod repeat;
#[cfg(feature = "save")]
mod save;
mod saved;
mod send;
mod send_checks;
mod send_codecs;
mod send_contacts;
mod send_devices;
mod send_midi;
#[cfg(feature = "save")]
mod state;
mod target_devices;
mod targets;
#[cfg(test)]
mod tests;
mod undrawn;
mod units;
mod values;
mod version;
mod write;

use underfoot_format::{diagnostic, fields, file, node, number, pairs, problem, reader, source, suggest};

pub use crate::feel::{Effects, NamedEffect};
pub use ahap::{AhapError, read_ahap, write_ahap};
pub use builtin::{builtin_floor, builtin_floors, builtin_layout, builtin_layouts, head_comment};
pub use diagnostic::{Diagnostic, Diagnostics, Severity};
pub use effect::parse_effect;
pub use floor::{load_floor, load_floor_with_ports, parse_floor, parse_floor_with_ports};
pub use floor_text::write_floor;
pub use ground::ground_fields;
pub use kind::{ControlKind, Kinds};
pub use locate::{ControlPart, Remark};
pub use page::{Loaded, folder_beside, kinds_beside, load_layout, load_layout_and_kinds, parse_layout};
pub use places::Places;
pub use reference::{Chapter, reference, write_reference};
#[cfg(feature = "save")]
pub use save::{save_floor, save_text, write_over};
pub use saved::{SaveError, Saved};
pub use send::written_messages;
#[cfg(feature = "save")]
pub use state::usual_state;
pub use underfoot_format::describe::{Description, FieldDescription, FieldType};
pub use version::{FORMAT_VERSION, version_with};
pub use write::write_layout;

pub use effect::{is_effect_name, write_named_effect};
pub use file::{BoundedFile, open_bounded, read_bounded};
pub use lists::MAX_WIDGETS;
