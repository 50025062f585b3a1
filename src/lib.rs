//! User interfaces on the floor: force-sensing tiles in, foot controls and tactile feedback out.
//!
//! ```text
//! datagram -wire-> SensorPacket (counts, 1 kHz) -sense-> ForceFrame (N)
//!   -> Contacts (m, N) -> Cursor -widget-> WidgetEvent -> EventSink
//!   WidgetEvent -response-> Cue ==ring==> Renderer -> samples -> ActuatorSink
//!   Engine ==latest Snapshot==> preview
//! ```
//!
//! SI units everywhere. Floor space has its origin at the floor's south-west
//! corner, x east, y north, in metres ([`glam::Vec2`]). The sensor corners of a
//! tile are always in the order south-west, south-east, north-west, north-east.

#[cfg(feature = "lab")]
pub mod capacity;
pub mod engine;
#[cfg(feature = "ergonomics")]
pub mod ergonomics;
#[cfg(feature = "lab")]
pub mod experiment;
pub mod feel;
pub mod floor;
mod format;
pub mod ground;
pub mod layout;
pub mod outgoing;
#[cfg(feature = "picture")]
pub mod picture;
#[cfg(feature = "preview")]
pub mod preview;
#[cfg(feature = "scene")]
pub mod scene;
pub mod schema;
pub mod sense;
pub mod serve;
#[cfg(feature = "sim")]
pub mod sim;
pub mod sink;
pub mod source;
pub mod units;
pub mod widget;
pub mod wire;

pub use glam;

/// Whatever runs in an audio callback during a test is caught allocating.
#[cfg(test)]
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;

/// The Rust of the page for apps is a doctest.
#[cfg(doctest)]
#[doc = include_str!("../docs/in-your-app.md")]
struct InYourApp;
