//! RON records: each is described once, at its type; reader, writer, knobs and reference follow from that.
//!
//! ```text
//! record! { pub struct Mode ... }   name, type, unit, range, default and one line of each field
//!   -record, codec-> read_fields, write_fields, turn_fields, describe
//!
//! bytes -file, source-> text -scan-> brackets that close, bounded nesting
//!   -syntax-> tree with spans -reader, node, fields-> numbers, texts, names in range -record-> the typed record
//! ```
//!
//! One reading finds all problems of a file, each with its place and the nearest valid name. A record is read over a
//! base, which supplies the fields that are not written. It is read in a context ([`Record::Context`]), which holds the
//! values that the file refers to: `record! { pub struct Mode = "Mode" with Effects; ... }`. This crate depends on no
//! particular record: it stands below all of them.
//!
//! Serde's derive cannot do this: it stops at the first problem, has neither places nor ranges, and cannot read over
//! a base. With schemars, every record would need a second struct for the file format and a conversion of the units;
//! here the record is the type that the program uses. Towards apps the records are values like any other
//! ([`mod@filed`]): `ron` writes them through [`serde::Serialize`] and reads them through [`serde::Deserialize`].

pub mod call;
pub mod codec;
mod complaint;
mod context;
pub mod describe;
pub mod diagnostic;
mod excerpt;
pub mod fault;
pub mod fields;
pub mod file;
pub mod filed;
pub mod hand;
pub mod label;
pub mod node;
pub mod number;
pub mod outline;
pub mod pairs;
pub mod problem;
pub mod reader;
pub mod record;
mod remedy;
pub mod scan;
pub mod source;
pub mod suggest;
mod syntax;
pub mod text;
pub mod words;

pub use codec::{
    Codec, Flag, Flat, Follow, Id, List, Name, Named, Num, OneOf, Opt, Own, Pair, Rec, Text, list, num,
};
pub use context::Includes;
pub use fault::Faults;
pub use record::{Record, Variants};

// Public signatures contain types of this crate.
pub use ron2;

#[doc(hidden)]
pub use serde;
