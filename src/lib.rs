//! User interfaces on the floor: force-sensing tiles in, foot controls and tactile feedback out.
//!
//! A floor is a grid of rigid square tiles, each with four force sensors and an actuator. A layout, written in RON,
//! places controls on it. Give an [`Engine`](engine::Engine) the layout and one frame of forces per millisecond, and
//! it reports the events of the controls:
//!
//! ```
//! use underfoot::engine::Engine;
//! use underfoot::floor::Floor;
//! use underfoot::schema::{self, Kinds};
//! use underfoot::sense::{ForceFrame, Method};
//! use underfoot::units::{Instant, Newtons};
//!
//! let floor = Floor::default();
//! let text = schema::builtin_layout("first_steps").unwrap_or_default();
//! let kinds = Kinds::builtin();
//! let layout = schema::parse_layout(text, "first_steps", &kinds, &floor.geometry)?.layout;
//! let light = layout.widgets[layout.widget_index("light").unwrap_or(0)].area.centre();
//! let mut engine = Engine::new(floor.geometry, layout, Method::Tracker);
//!
//! let mut heard = Vec::new();
//! for millis in 0..1000 {
//!     let mut frame = ForceFrame::empty(&floor.geometry);
//!     frame.at = Instant::from_millis(millis);
//!     if (400..600).contains(&millis) {
//!         frame.add_load(&floor.geometry, light, Newtons(150.0));
//!     }
//!     let events = engine.step(&frame).events;
//!     heard.extend(events.iter().map(|event| format!("{} {}", event.id, event.kind.name())));
//! }
//! assert!(heard.iter().any(|event| event == "light pressed"));
//! # Ok::<(), schema::Diagnostics>(())
//! ```
//!
//! # Modules, in the order in which an app needs them
//!
//! | module | content |
//! |---|---|
//! | `runtime` | a running floor on a thread of its own, with a handle: events, held controls, controls by id (feature `net`) |
//! | [`engine`] | a frame of forces in, events, cues and a snapshot out; no clocks, threads or devices |
//! | [`serve`] | a running floor in one thread: packets in, events and samples out |
//! | [`schema`] | layouts, kinds of controls, effects and floors as RON, with all problems at their places |
//! | [`widget`] | the controls and their events |
//! | [`floor`] | tiles, sensors, boards, actuators of one floor |
//! | [`sense`] | forces, contacts, cursors, the health of sensors |
//! | [`layout`] | a checked layout: controls, regions, pages |
//! | [`source`] | sources of packets: a socket, a simulated floor |
//! | [`sink`] | outputs for events and samples: OSC, TUIO, JSON lines, sound cards, files |
//! | `recording` | all inputs of a floor in an MCAP file, and replay from it (features `record` and `replay`) |
//! | [`wire`] | packets, requests and their limits |
//! | [`feel`], [`ground`] | haptics: cues, effects, materials, and the renderer of actuator samples |
//! | [`units`] | newtons, instants |
//!
//! Before 1.0 every 0.x version may change names; those that only the crates of this toolkit use (calibration, tables,
//! parts of sensing and rendering) change most. Other crates simulate a floor with people on it (`underfoot-sim`), draw
//! a floor and review its layout (`underfoot-scene`), show and edit it in a window (`underfoot-window`), and measure it
//! (`underfoot-lab`).
//!
//! # Path of a packet
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

pub mod engine;
pub mod feel;
pub mod floor;
pub mod ground;
pub mod layout;
pub mod messages;
#[cfg(feature = "mirror")]
pub mod mirror;
pub mod outgoing;
#[cfg(feature = "threads")]
pub mod parallel;
#[cfg(not(feature = "threads"))]
mod parallel;
pub mod rate_limit;
#[cfg(feature = "replay")]
pub mod recording;
#[cfg(feature = "net")]
pub mod runtime;
pub mod schema;
pub mod sense;
pub mod serve;
pub mod sink;
pub mod source;
pub mod units;
pub mod widget;
pub mod wire;

pub use underfoot_format::label;

// Public signatures contain types of these crates.
pub use {arrayvec, glam, smallvec, triple_buffer};

/// Detects allocations in audio callbacks during tests.
#[cfg(test)]
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;

/// Tests the Rust code in the page for apps.
#[cfg(doctest)]
#[doc = include_str!("../docs/rust-app.md")]
struct RustApp;

/// Tests the Rust code in the page about the engine.
#[cfg(doctest)]
#[doc = include_str!("../docs/in-your-app.md")]
struct InYourApp;
