//! The reports of a node about its floor, and its behaviour without a gateway.
//!
//! ```text
//! sensing thread: Report -NodeSink-> Draft ==bounded==> sending thread: NodeMessage -> gateway
//! sensing thread: cues -Border-> note ==UDP==> the neighbour's sensing thread: Border -> its actuators
//! gateway -> Guard: lost, disputed or silent -> what feet hold here is cancelled here too
//! ```

mod asked;
mod border;
mod draft;
mod guard;
mod layouts;
mod seal;
mod sink;

pub use asked::AskedRequests;
pub use border::{Border, BorderCounters, ReceivedNote, SendNote};
pub use draft::Draft;
pub use guard::{Action, CancelReason, GatewayGuard};
pub use layouts::NodeLayouts;
pub use seal::{NeighbourSeal, NeighbourSession};
pub use sink::NodeSink;
