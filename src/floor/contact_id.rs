//! The lasting name of a contact.

use serde::Serialize;

/// The lasting name of one contact: given when it lands, never used again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(transparent)]
pub struct ContactId(pub u32);
