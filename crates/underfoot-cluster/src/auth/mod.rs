//! Authenticated messages between the computers of a floor.
//!
//! ```text
//! at its start each program draws a random number, its nonce
//! each message: nonce of the sender, counter, time on the sender's clock,
//!               for each receiver heard within 250 ms: its nonce and the time of its last message,
//!               body, and a MAC (keyed BLAKE3) over all of it
//! a receiver accepts a message if  the MAC is right                          else it is forged
//!                                  it answers the receiver's own nonce       else unanswered
//!                                  with a time less than 250 ms ago          else stale
//!                                  its counter is new                        else repeated
//!                                  and not far beyond the last one           else jumped
//! ```
//!
//! Each message is a challenge to its receivers and answers theirs. The nonce makes a recording worthless after the
//! receiver's next start. The time is one that the receiver wrote itself, so that it bounds the message's age by the
//! receiver's own clock; no clock of another computer decides about age.
//!
//! Packets of boards carry no answers, which would be longer than the packet. Each is as new as its sender's last
//! note; the time between the two on the sender's clock adds to its age.
//!
//! This module is pure: the caller passes time, nonces and bytes.

mod envelope;
mod key;
mod refusals;
mod session;
mod window;

pub use envelope::{Echo, EnvelopeHead, MessageKind};
pub use key::{Key, KeyError};
pub use refusals::{AuthRefusal, AuthRefusals};
pub use session::{AuthSession, Opened, Role};
