//! The permanent id of a contact.

use serde::{Deserialize, Serialize};

/// The permanent id of one contact: assigned when it begins, never used again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ContactId(pub u32);
