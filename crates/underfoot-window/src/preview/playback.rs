//! Playback of a recording: its state, and the commands of the window.

use std::sync::Arc;

use underfoot::recording::{MarkKind, TimelineMark};
use underfoot::units::Instant;

use super::feed::PreviewInput;

/// A recording that plays through the sensing. Times are seconds since its first moment.
pub trait Playback {
    /// The present state.
    fn state(&mut self) -> PlaybackState;

    /// Sends a command; a time before the first moment or after the last is clamped, NaN counts as the first.
    fn lead(&mut self, order: PlaybackOrder);

    /// Ends playback at the present moment and returns the floor that goes on from there under the window's own feet;
    /// `None` where that is impossible.
    fn take_over(&mut self) -> Option<PreviewInput> {
        None
    }
}

/// The state of playback.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaybackState {
    /// The time on display.
    pub at_s: f64,
    /// The last known time; it grows while the file is being read.
    pub length_s: f64,
    /// Whether playback is paused.
    pub is_paused: bool,
    /// Speed relative to the recording; infinite for the maximum speed.
    pub speed: f64,
    /// The target of a seek in progress.
    pub goes_to_s: Option<f64>,
    /// The part that is repeated.
    pub repeats: Option<(f64, f64)>,
    /// Marks of interest, in order of time.
    pub marks: Arc<Vec<PlaybackMark>>,
    /// Why the recording breaks off, if it does.
    pub broken: Option<String>,
    /// Whether [`Playback::take_over`] is possible.
    pub can_take_over: bool,
}

impl Default for PlaybackState {
    fn default() -> Self {
        Self {
            at_s: 0.0,
            length_s: 0.0,
            is_paused: false,
            speed: 1.0,
            goes_to_s: None,
            repeats: None,
            marks: Arc::default(),
            broken: None,
            can_take_over: false,
        }
    }
}

/// A mark of interest.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaybackMark {
    /// The time of the mark.
    pub at_s: f64,
    /// The text of the mark: `zoom pressed`.
    pub what: String,
    /// Its importance.
    pub weight: MarkWeight,
}

impl PlaybackMark {
    /// The mark of a recording whose first moment is `first`; marks before it are at its beginning.
    #[must_use]
    pub fn of_recording(mark: &TimelineMark, first: Instant) -> Self {
        let (what, weight) = match &mark.kind {
            MarkKind::Pressed(id) => (format!("{id} pressed"), MarkWeight::Usual),
            MarkKind::Cancelled(id) => (format!("{id} cancelled"), MarkWeight::Odd),
            MarkKind::LinkLost => ("link lost".into(), MarkWeight::Fault),
        };
        Self { at_s: mark.at.since(first).as_secs_f64(), what, weight }
    }
}

/// The importance of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkWeight {
    /// A normal event.
    Usual,
    /// A failed attempt of a user.
    Odd,
    /// A fault of the floor.
    Fault,
}

/// A command of the user for a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaybackOrder {
    /// Pause, or continue.
    Pause(bool),
    /// Play at this speed relative to the recording.
    Speed(f64),
    /// Show this time.
    GoTo(f64),
    /// Repeat this part; `None` to stop repeating.
    Repeat(Option<(f64, f64)>),
}
