//! Apple's haptic patterns (AHAP, JSON), in and out.
//!
//! Intensity is a share of a level; sharpness is a position between a dull and a sharp pitch:
//!
//! | AHAP | here |
//! |---|---|
//! | `HapticTransient` | a click of one mode: 20 N at intensity 1; 90 to 324 Hz and 30 to 7.5 ms over sharpness 0 to 1 |
//! | `HapticContinuous` | a tone: 12 N at intensity 1; 70 to 280 Hz over sharpness 0 to 1 |
//! | `AttackTime`, `DecayTime`, `ReleaseTime`, `Sustained` | the tone's envelope, in seconds |
//! | `HapticIntensityControl`, `HapticSharpnessControl` as curve or parameter | the clicks' levels and pitches, the tones' curves |
//!
//! A warning names everything without a counterpart, out of range or beyond a limit.
//!
//! # Source
//! "Representing haptic patterns in AHAP files" and `CHHapticDynamicParameter`, Apple's documentation of Core
//! Haptics: the intensity control multiplies, the sharpness control adds; curves are straight between their points,
//! dynamic parameters change at once; out-of-range values are clamped.

mod control;
mod export;
mod file;
mod import;
mod long_tone;
mod warnings;

pub use export::write_ahap;
pub use import::read_ahap;

use thiserror::Error;

/// Reason for which a pattern cannot be read or an effect cannot be written as one.
#[derive(Debug, Error)]
pub enum AhapError {
    /// The file is larger than a pattern can be.
    #[error("{0}: larger than 4 MB: is it a pattern?")]
    TooLarge(String),
    /// The text is not JSON, or its fields have other types than those of a pattern.
    #[error("{name}:{line}:{column}: {reason}")]
    Json {
        /// Name of the text in messages.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The error there.
        reason: String,
    },
    /// An invalid time: negative or beyond a day.
    #[error("{name}: entry {entry} of the pattern: {field} is {seconds} s; expected 0 to 86400")]
    Time {
        /// Name of the text in messages.
        name: String,
        /// Number of the entry, from 1.
        entry: usize,
        /// The field.
        field: &'static str,
        /// Its value.
        seconds: f64,
    },
    /// No event in the pattern can be played.
    #[error("{name}: there is no haptic event in this pattern that can be played{}", listed(left_out))]
    Empty {
        /// Name of the text in messages.
        name: String,
        /// Everything that was dropped.
        left_out: Vec<String>,
    },
    /// An effect driven by a moving foot or a value has no counterpart.
    #[error("AHAP has no counterpart for {0}, which is driven by the foot")]
    Driven(&'static str),
}

fn listed(left_out: &[String]) -> String {
    left_out.iter().map(|line| format!("\n  {line}")).collect()
}

/// Levels at intensity 1, in newtons.
const TRANSIENT_N: f32 = 20.0;
const CONTINUOUS_N: f32 = 12.0;

/// Pitches and decays at sharpness 0, and their factors from there to sharpness 1.
const TRANSIENT_HZ: (f32, f32) = (90.0, 3.6);
const TRANSIENT_DECAY_S: (f32, f32) = (0.03, 0.25);
const CONTINUOUS_HZ: (f32, f32) = (70.0, 4.0);

/// Returns the value at a sharpness: `dull * factor ^ sharpness`.
fn at_sharpness((dull, factor): (f32, f32), sharpness: f32) -> f32 {
    dull * factor.powf(sharpness)
}

/// Returns the sharpness of a value: `ln(value / dull) / ln(factor)`; outside of 0 to 1 if no sharpness gives this
/// value.
fn sharpness_of((dull, factor): (f32, f32), value: f32) -> f32 {
    (value / dull).ln() / factor.ln()
}
