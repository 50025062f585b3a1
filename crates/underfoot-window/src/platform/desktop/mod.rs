//! A computer with files and threads.

pub(super) mod files;
#[cfg(feature = "window")]
pub(super) mod inbox;
#[cfg(feature = "window")]
pub(super) mod lock;
#[cfg(feature = "window")]
pub(super) mod repeat;
#[cfg(feature = "window")]
pub(super) mod screen;
