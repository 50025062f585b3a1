//! Mirrors of a running floor in remote windows: the input of its server as a stream, and the stream as an input
//! again.
//!
//! `MirrorFeed` taps the input of a server as a recording does, and gives frames of bytes to all joined windows.
//! `MirrorSource` receives such frames, and returns the same packets, requests and layouts in the same order: sensing
//! on them sees the same floor. [`PolledMirror`] does so without threads. A window first needs a [`Greeting`];
//! [`Follower`] keeps the values of controls equal to the server's. `docs/web-app.md` describes the stream.
//!
//! If no packets are available, as from a floor that several computers serve, [`TextMirror`] shows the content of its
//! JSON lines.

#[cfg(feature = "record")]
mod feed;
mod follower;
mod frame;
mod greeting;
#[cfg(feature = "web")]
mod link;
mod polled;
mod said;
#[cfg(feature = "net")]
mod source;
mod stream;
#[cfg(test)]
#[cfg(feature = "record")]
mod tests;
mod text;

#[cfg(feature = "record")]
pub use feed::MirrorFeed;
pub use follower::Follower;
pub use frame::BadFrame;
pub use greeting::{Greeting, MirrorError};
#[cfg(feature = "web")]
pub use link::{MirrorLink, MirrorNews};
pub use polled::PolledMirror;
pub use said::MirrorText;
#[cfg(feature = "net")]
pub use source::{MirrorInput, MirrorSource};
pub use text::{BadLine, TextMirror};

/// The version of the greeting and of the frames.
const VERSION: u8 = 1;
