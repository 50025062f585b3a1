//! RON records: each is described once, where its type is; reader, writer, knobs and reference follow from that.
//!
//! ```text
//! record! { pub struct Mode ... }   name, type, unit, range, default and one line of each field
//!   -record, codec-> read_fields, write_fields, turn_fields, describe
//!
//! bytes -file, source-> text -scan-> brackets that close, bounded nesting
//!   -syntax-> tree with spans -reader, node, fields-> numbers, texts, names in range -record-> the typed record
//! ```
//!
//! All problems of a file are found in one reading, each with its place and the
//! nearest valid name. A record is read over a base, which says what is not
//! written. This module knows no record itself: it stands below all of them.
//!
//! Serde's derive cannot do this: it stops at the first problem, has neither
//! places nor ranges, and cannot read over a base. With schemars beside it every
//! record would be a second struct of what is written, and a conversion with the
//! units; here the record is the type that is used.

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
