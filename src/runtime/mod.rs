//! A running floor on a thread of its own, with a handle for apps.
//!
//! ```no_run
//! use underfoot::runtime::{Kind, Session};
//! use underfoot::widget::{EventKind, Value};
//!
//! let floor = Session::listen("127.0.0.1:9000").layout_file("layouts/map.ron")?.start()?;
//! for event in &floor {
//!     match (event.id(), event.kind) {
//!         ("zoom", Kind::Control(EventKind::Changed(Value::Number(zoom)))) => println!("zoom {zoom}"),
//!         ("home", Kind::Control(EventKind::Clicked)) => floor.control("zoom")?.set(0.0)?,
//!         (_, Kind::Ended(reason)) => println!("over: {reason}"),
//!         _ => {}
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Session`] is a handle that any number of threads may clone and share. Dropping the last handle ends the floor:
//! presses are cancelled, outputs send their closing messages, and the sensing thread has ended when the drop
//! returns.
//!
//! | an app | with |
//! |---|---|
//! | waits for events | [`Session::events`] |
//! | polls for events, such as after a call of [`SessionBuilder::wake`] | [`Session::next_event`], never blocks |
//! | acts while a control is held | [`Session::held`]: false as soon as it can't be confirmed any more |
//! | shows the floor | [`Session::snapshot`] |
//! | changes a control | [`Session::control`], [`Session::controls`] |
//! | replays a recording | `Session::replay` |
//! | drives actuators, and reports to other programs | [`SessionBuilder::actuators`], [`SessionBuilder::sink`] |

mod app_sink;
mod builder;
mod control;
mod controls_off;
mod event;
mod events;
mod held;
mod queue;
mod session;
mod snapshot;
mod thread;

pub use crate::serve::Refusal;
pub use builder::{SessionBuilder, StartError};
pub use control::ControlHandle;
pub use controls_off::ControlsOff;
pub use event::{EndReason, Event, Kind};
pub use events::Events;
pub use held::Held;
pub use session::Session;
pub use snapshot::SessionSnapshot;
pub use thread::Actuators;
