//! Standard loads for measuring the largest floor that a machine can serve.
//!
//! Nothing here reads a clock: each load does the work of a known length of floor time, and the caller divides that
//! length by the elapsed time. `underfoot capacity` and the benches measure the same loads.

mod crowd;
mod receiving;
mod rendering;
mod sensing;
mod serving;
mod socket;

pub use receiving::{AssemblyLoad, PacketLoad};
pub use rendering::{BankLoad, RenderLoad, RenderWork, modal_error_db};
pub use sensing::SensingLoad;
pub use serving::{BoardsLoad, ServeLoad};
pub use socket::SocketLoad;

pub(crate) use receiving::square;
