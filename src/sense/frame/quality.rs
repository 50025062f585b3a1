//! The quality of a value.

use serde::{Deserialize, Serialize};

/// Quality of a value; every force, tile and board has one.
///
/// Only `Live` data may start an engagement; `Degraded` may where a layout allows it. Anything worse may only end
/// one. Ordered from best to worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// Fresh and plausible.
    Live,
    /// Usable with a larger error: a neighbouring sensor is out, a converter saturates, packets are lost.
    Degraded,
    /// Outdated: no new value within the time-out.
    #[default]
    Stale,
    /// Wrong.
    Faulty,
}
