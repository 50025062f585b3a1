//! What a node tells of its floor, and what it does when nobody hears it.
//!
//! ```text
//! sensing thread: Report -NodeSink-> Draft ==bounded==> sending thread: NodeMessage -> gateway
//! gateway -> Guard: lost, disputed or silent -> what feet hold here is cancelled here too
//! ```

mod draft;
mod guard;
mod sink;

pub use draft::Draft;
pub use guard::{Action, Guard, Reason};
pub use sink::NodeSink;
