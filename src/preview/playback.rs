//! A recording that is shown, as the window sees and leads it.

use std::sync::Arc;

/// A recording on its way through the sensing. Times are seconds since its first moment.
pub trait Playback {
    /// How it is now.
    fn state(&mut self) -> PlaybackState;

    /// Asks for something else; a time before the first moment or after the last counts as that one, NaN as the first.
    fn lead(&mut self, order: PlaybackOrder);
}

/// How a recording is on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaybackState {
    /// The moment that is shown.
    pub at_s: f64,
    /// The last moment that is known of; it grows while the file is being read.
    pub length_s: f64,
    /// Whether it is held still.
    pub is_paused: bool,
    /// How many times as fast it goes as it was recorded; infinite for as fast as can be.
    pub speed: f64,
    /// The moment that it hurries to.
    pub goes_to_s: Option<f64>,
    /// The stretch that it plays again and again.
    pub repeats: Option<(f64, f64)>,
    /// What people look for, in the order of time.
    pub marks: Arc<Vec<PlaybackMark>>,
    /// Why it breaks off, if it does.
    pub broken: Option<String>,
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
        }
    }
}

/// A moment that people look for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaybackMark {
    /// When.
    pub at_s: f64,
    /// What: `zoom pressed`.
    pub what: String,
    /// How much it matters.
    pub weight: MarkWeight,
}

/// How much a mark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkWeight {
    /// All is well.
    Usual,
    /// Somebody did not get what they wanted.
    Odd,
    /// The floor did not work.
    Fault,
}

/// What the person at the window wants of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaybackOrder {
    /// Hold it still, or go on.
    Pause(bool),
    /// Go so many times as fast as it was recorded.
    Speed(f64),
    /// Show this moment.
    GoTo(f64),
    /// Play this stretch again and again; `None` for no more.
    Repeat(Option<(f64, f64)>),
}
