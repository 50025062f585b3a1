//! A floor at work on a thread of its own, with a handle for apps.
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
//! [`Session`] is a handle that any number of threads may clone and share. With the last one the floor ends:
//! what feet hold is cancelled, outputs say goodbye, and the sensing thread has ended when the drop returns.
//!
//! | an app | with |
//! |---|---|
//! | hears what happens | [`Session::events`], which waits; [`Session::next_event`], which never blocks; [`SessionBuilder::wake`] says when to look |
//! | acts while a control is held | [`Session::held`]: false as soon as it can't be confirmed any more |
//! | shows the floor | [`Session::snapshot`] |
//! | changes a control | [`Session::control`], [`Session::controls`] |
//! | plays a floor of the past | `Session::replay` |
//! | is felt, and tells others | [`SessionBuilder::actuators`], [`SessionBuilder::sink`] |

mod app_sink;
mod builder;
mod control;
#[cfg(any(feature = "internals", test))]
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
pub use control::Control;
#[cfg(any(feature = "internals", test))]
pub use controls_off::ControlsOff;
pub use event::{EndReason, Event, Kind};
pub use events::Events;
pub use held::Held;
pub use session::Session;
pub use snapshot::Snapshot;
pub use thread::Actuators;
