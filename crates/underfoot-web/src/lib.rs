//! The window of underfoot in a browser: Try and Design on a floor that is simulated in the page, or on the floor of the
//! server that serves the page.
//!
//! | module | content |
//! |---|---|
//! | [`floor`] | the simulated floor, advanced in the frames of the page |
//! | [`plan`] | the layout and the measured floor from which that floor begins, or why there is none |
//! | [`clock`] | the time of that floor |
//! | [`joined`] | the floor of a server, sensed again in the page |
//! | [`desk`] | layouts put on the floor, and the commands of the window |
//! | [`kinds`] | kinds and effects: those that come with underfoot, and those of a link |
//! | [`played`] | a visit or a recording, steered by the time line |
//! | [`visit`] | the visit of a link |
//! | [`recording`] | a recording in memory |
//! | [`sound`] | the sound of a frame in one piece |
//! | `page` | the start in a page on a simulated floor (WebAssembly only) |
//! | `join`, `socket` | the start in a page of a server, and its connection (WebAssembly only) |
//!
//! The rest compiles for every system, and its tests run on the desktop.

mod clicks;
pub mod clock;
pub mod desk;
pub mod floor;
#[cfg(target_arch = "wasm32")]
pub mod join;
pub mod joined;
pub mod kinds;
mod lag;
mod lines;
#[cfg(target_arch = "wasm32")]
pub mod page;
pub mod plan;
pub mod played;
pub mod recording;
#[cfg(target_arch = "wasm32")]
mod socket;
pub mod sound;
mod tape;
pub mod visit;
