//! Messages of controls to other programs, and the state machine that decides when each goes out.
//!
//! ```text
//! layout -MessagePlan-> Messenger <- events, held controls, state of the link, time
//!                Messenger -> orders: down, up, stroke, steps of a wheel, motion, OSC
//! ```
//!
//! Everything here is pure: the caller passes the time, and carries out the orders.

mod key;
mod key_names;
mod messenger;
mod order;
mod pace;
mod plan;
mod pointer;
mod sending;
mod target;
#[cfg(test)]
mod tests;
mod trigger;

pub use key::{KeyStroke, KeySymbol};
pub use messenger::Messenger;
pub use order::{Act, Holdable, MessageOrder, OscValue, Unsent};
pub use plan::MessagePlan;
pub use sending::{MAX_MESSAGES, MouseButton, OscArgument, OscSettings, Payload, Sending, When};
pub use target::{Destination, KeyboardTarget, MAX_TARGETS, OscTarget, OscTransport, SendTarget};
pub use trigger::Trigger;
