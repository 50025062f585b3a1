//! How far a value can be trusted.

use serde::Serialize;

/// How far a value can be trusted; no force, tile or board travels without one.
///
/// Only `Live` data may start an engagement; `Degraded` may where a layout
/// allows it. Anything worse may only end one. Ordered from best to worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// Fresh and plausible.
    Live,
    /// Usable with a larger error: a neighbour sensor is out, a converter saturates, packets are being lost.
    Degraded,
    /// Nothing new for too long.
    #[default]
    Stale,
    /// Known to be wrong.
    Faulty,
}
