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
//! base, which supplies the fields that are not written. This module depends on no particular record: it stands below
//! all of them.
//!
//! Serde's derive cannot do this: it stops at the first problem, has neither places nor ranges, and cannot read over
//! a base. With schemars, every record would need a second struct for the file format and a conversion of the units;
//! here the record is the type that the program uses.

pub(crate) mod codec;
mod complaint;
pub(crate) mod describe;
pub(crate) mod diagnostic;
mod excerpt;
pub(crate) mod fault;
pub(crate) mod fields;
pub(crate) mod file;
pub(crate) mod hand;
pub(crate) mod node;
pub(crate) mod number;
#[cfg(any(feature = "edit", feature = "letters"))]
#[cfg_attr(not(feature = "edit"), expect(dead_code, reason = "only edits ask where commas and brackets are"))]
pub(crate) mod outline;
pub(crate) mod pairs;
pub(crate) mod problem;
pub(crate) mod reader;
pub(crate) mod record;
mod remedy;
pub(crate) mod scan;
pub(crate) mod source;
pub(crate) mod suggest;
mod syntax;
pub(crate) mod text;
pub(crate) mod words;

pub(crate) use codec::{
    Codec, Flag, Flat, Follow, Id, List, Name, Named, Num, OneOf, Opt, Own, Pair, Rec, Text, list, num,
};
pub(crate) use fault::Faults;
pub(crate) use record::{Record, Variants, choices, record};
