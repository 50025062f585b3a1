//! One floor served by several computers.
//!
//! A floor file names the floor's *areas*. Each is served by a **node**: a computer that senses the area and somewhat
//! beyond, decides its controls and moves its actuators, so that nothing on the way from foot to click crosses the
//! network. One **gateway** joins what the nodes tell into what a single floor would tell, so that an app sees no
//! difference.
//!
//! | module | what is in it |
//! |---|---|
//! | [`auth`] | which messages are of this floor, and new; pure |
//! | [`message`] | what nodes and gateway tell each other |
//! | [`gateway`] | many areas' contacts and events into one floor's; pure: time is handed in, no I/O |
//! | [`node`] | what a node tells of its floor |
//! | [`transport`] | messages through Zenoh; the only module that knows it |

pub mod auth;
pub mod gateway;
pub mod message;
pub mod node;
pub mod transport;
