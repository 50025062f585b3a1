//! Messages that only computers with the floor's key can write, and that count once, while they are new.
//!
//! ```text
//! at its start each program draws a random number, its nonce
//! every message: nonce of the sender, counter, time of the sender's clock,
//!                for each receiver heard of late: its nonce and the time that it sent last,
//!                body, and a keyed BLAKE3 hash over all of it
//! a message is taken if  the hash is right                              else forged
//!                        it answers the receiver's own nonce            else unanswered
//!                        with a time less than 250 ms ago               else stale
//!                        its counter is new                             else repeated
//!                        and not far beyond the last one                else jumped
//! ```
//!
//! Every message is a challenge to those that hear it, and answers theirs: the nonce makes what was recorded before a
//! start worthless after it, and the time, which the receiver reads on the clock that it wrote it by, says how old a
//! message can be at most. No clock of another computer is believed for that. Packets of boards go without answers, which
//! would be longer than they are: each is as new as its sender's last note, and what lies between the two by the sender's
//! clock counts as age.
//!
//! Everything here is pure: time, nonces and bytes are handed in.

mod envelope;
mod key;
mod refusals;
mod session;
mod window;

pub use envelope::{Echo, Head, Kind};
pub use key::{Key, KeyError};
pub use refusals::{Refusal, Refusals};
pub use session::{Opened, Role, Session};
