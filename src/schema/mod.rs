//! RON files: floors, control kinds and layouts as written, checked into the types the engine uses.
//!
//! All problems of a file are found in one reading, each with its place; there
//! is never a part of a layout. A file is read in these steps, one module each:
//!
//! ```text
//! bytes -source-> text -scan-> brackets that close, bounded nesting
//!   -syntax-> tree with spans -reader, node, fields-> numbers, texts, names in range
//!   -page, control, ground, arrange, kind, inherit, floor-> what was meant -checks-> Layout, Kind, Effect, Floor
//! ```

mod ahap;
mod area;
mod arrange;
mod behaviour;
mod builtin;
mod chain;
mod checks;
mod complaint;
mod control;
mod day;
mod diagnostic;
mod effect;
mod excerpt;
mod feel;
mod fields;
mod floor;
mod floor_maps;
mod floor_sensors;
mod floor_sound;
mod floor_text;
mod ground;
mod ground_parts;
mod inherit;
mod kind;
mod look;
mod node;
mod number;
mod page;
mod pages;
mod pairs;
mod place;
mod places;
mod problem;
mod reader;
mod region;
mod remedy;
mod repeat;
mod save;
mod scan;
mod source;
mod suggest;
mod syntax;
mod units;
mod version;
mod words;

pub use ahap::{AhapError, read_ahap, write_ahap};
pub use builtin::{builtin_layout, builtin_layouts};
pub use diagnostic::{Diagnostic, Diagnostics, Severity};
pub use effect::{Effects, NamedEffect, is_effect_name, parse_effect, write_effect, write_named_effect};
pub use floor::{load_floor, parse_floor};
pub use floor_text::write_floor;
pub use kind::{Kind, Kinds};
pub use page::{Loaded, MAX_WIDGETS, load_layout, parse_layout};
pub use places::Places;
pub use save::{SaveError, Saved, save_floor, save_text};
pub use version::FORMAT_VERSION;
