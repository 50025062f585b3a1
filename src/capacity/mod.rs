//! Standard work for measuring how large a floor a machine carries.
//!
//! Nothing here looks at a clock: each load does a known stretch of floor time, and whoever
//! measures divides it by the time that took. `underfoot capacity` and the benches measure the same loads.

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
