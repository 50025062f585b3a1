//! A floor at work, shown by windows elsewhere: what its server takes from the boards, as a stream, and as a source
//! again.
//!
//! [`MirrorFeed`] taps the source of a server as a recording does, and gives frames of bytes for whoever has joined.
//! [`MirrorSource`] is fed such frames, and gives the same packets, requests and layouts in the same order: what senses
//! them sees the same floor. What a window has to know first is a [`Greeting`]; [`Follower`] keeps the values of
//! controls as the server says they are. `docs/web-app.md` describes the stream.
//!
//! Where there are no packets to be had, as of a floor that several computers serve, [`TextMirror`] shows what its JSON
//! lines tell.

mod feed;
mod follower;
mod frame;
mod greeting;
mod line;
#[cfg(feature = "web")]
mod link;
mod source;
#[cfg(test)]
mod tests;
mod text;

pub use feed::MirrorFeed;
pub use follower::Follower;
pub use frame::BadFrame;
pub use greeting::{Greeting, MirrorError};
pub use line::ServerLine;
#[cfg(feature = "web")]
pub use link::{MirrorLink, MirrorNews};
pub use source::{MirrorInput, MirrorSource};
pub use text::{BadLine, TextMirror};

/// The version of the greeting and of the frames.
const VERSION: u8 = 1;
