//! One floor served by several computers.
//!
//! A floor file names the floor's *areas*. Each is served by a **node**: a computer that senses the area and a margin
//! around it, decides its controls and moves its actuators, so that no step between foot and click crosses the
//! network.
//! One **gateway** joins the reports of the nodes into those of a single floor, so that an app sees no difference.
//!
//! | module | contents |
//! |---|---|
//! | [`auth`] | authentication and replay protection of messages; pure |
//! | [`message`] | the messages that nodes and gateway exchange |
//! | [`gateway`] | joins the contacts and events of many areas into one floor's; pure: the caller passes the time, no
//! I/O |
//! | [`node`] | the reports of a node, and its behaviour without a gateway |
//! | [`transport`] | messages through Zenoh; the only module that uses it |

pub mod auth;
pub mod gateway;
pub mod message;
pub mod node;
pub mod transport;
