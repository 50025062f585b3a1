//! Targets: the messages of controls as keys, pointer, OSC, MIDI, DMX and MQTT, and as programs that they start, with the
//! guarantee that each key that goes down comes up.
//!
//! ```text
//! sensing thread          supervisor thread               process `underfoot guardian`
//! TargetSink(Messenger) -> orders, heartbeats -> stdin ->  Guardian -> Outlets -> X server, OSC, ...
//!                          acknowledgements   <- stdout <-
//!                          guardian failed: Outlets of its own release everything, and a new guardian starts
//! ```
//!
//! The guardian releases everything when its input ends or no heartbeat has come for [`PATIENCE`]. A heartbeat goes out
//! only if the sensing thread has polled its sinks recently, so a server that hangs counts as dead.

#[cfg(feature = "dmx")]
mod dmx;
mod guardian;
mod link;
#[cfg(any(feature = "midi", feature = "jack"))]
mod midi;
#[cfg(feature = "mqtt")]
mod mqtt;
mod osc;
mod outlet;
mod outlets;
mod redirect;
#[cfg(feature = "run")]
mod run;
mod sink;
mod standby;
mod supervisor;
#[cfg(any(windows, target_os = "macos", test))]
mod system;
#[cfg(all(test, unix))]
mod tests;
#[cfg(all(unix, not(target_os = "macos")))]
mod x11;

use std::time::Duration;

pub use guardian::guard;
pub use outlet::{Outlet, OutletError};
pub use redirect::redirect;
pub use sink::{LoadedPlan, TargetCounts, TargetSink};
pub use supervisor::GuardianCommand;

/// Time between two heartbeats.
const BEAT: Duration = Duration::from_millis(20);

/// Longest time without a heartbeat before the guardian releases everything.
///
/// With a heartbeat that is `BEAT` old, a poll that is `POLLED` old and one turn of the threads this stays below
/// 150 ms.
pub const PATIENCE: Duration = Duration::from_millis(80);

/// Longest time since the sensing thread polled its sinks, which it does every 5 ms.
const POLLED: Duration = Duration::from_millis(30);
