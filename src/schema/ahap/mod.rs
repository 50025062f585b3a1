//! Apple's haptic patterns (AHAP, JSON), in and out.
//!
//! Intensity is a share of a level, sharpness a place between a dull and a
//! sharp pitch:
//!
//! | AHAP | here |
//! |---|---|
//! | `HapticTransient` | a click of one mode: 20 N at intensity 1; 90 to 324 Hz and 30 to 7.5 ms over sharpness 0 to 1 |
//! | `HapticContinuous` | a tone: 12 N at intensity 1; 70 to 280 Hz over sharpness 0 to 1 |
//! | `AttackTime`, `DecayTime`, `ReleaseTime`, `Sustained` | the tone's envelope, in seconds |
//! | `HapticIntensityControl`, `HapticSharpnessControl` as curve or parameter | the clicks' levels and pitches, the tones' curves |
//!
//! Everything that has no counterpart, is out of range or beyond a limit is named in a warning.
//!
//! # Source
//! "Representing haptic patterns in AHAP files" and `CHHapticDynamicParameter`, Apple's documentation of Core
//! Haptics: control of intensity multiplies, that of sharpness adds; curves run straight between their points, dynamic
//! parameters change at once; out-of-range values are brought into range.

mod control;
mod export;
mod file;
mod import;
mod long_tone;
mod warnings;

pub use export::write_ahap;
pub use import::read_ahap;

use thiserror::Error;

/// Why a pattern can't be read or an effect can't be written as one.
#[derive(Debug, Error)]
pub enum AhapError {
    /// The file is larger than any pattern.
    #[error("{0}: larger than 4 MB: is it a pattern?")]
    TooLarge(String),
    /// The text is not JSON, or its fields are of other types than a pattern's.
    #[error("{name}:{line}:{column}: {reason}")]
    Json {
        /// What messages call the text.
        name: String,
        /// Where, from 1.
        line: usize,
        /// Where, from 1.
        column: usize,
        /// What is wrong there.
        reason: String,
    },
    /// A time that cannot be one: negative or beyond a day.
    #[error("{name}: entry {entry} of the pattern: {field} is {seconds} s; expected 0 to 86400")]
    Time {
        /// What messages call the text.
        name: String,
        /// Number of the entry, from 1.
        entry: usize,
        /// The field.
        field: &'static str,
        /// Its value.
        seconds: f64,
    },
    /// Nothing in it can be felt.
    #[error("{name}: there is no haptic event in this pattern that can be played{}", listed(left_out))]
    Empty {
        /// What messages call the text.
        name: String,
        /// Everything that was left out.
        left_out: Vec<String>,
    },
    /// What a moving foot or a value drives has no counterpart.
    #[error("AHAP has no counterpart for {0}, which is driven by the foot")]
    Driven(&'static str),
}

fn listed(left_out: &[String]) -> String {
    left_out.iter().map(|line| format!("\n  {line}")).collect()
}

/// Levels at intensity 1, in newtons.
const TRANSIENT_N: f32 = 20.0;
const CONTINUOUS_N: f32 = 12.0;

/// Pitches and decays at sharpness 0, and the factors by which they differ at sharpness 1.
const TRANSIENT_HZ: (f32, f32) = (90.0, 3.6);
const TRANSIENT_DECAY_S: (f32, f32) = (0.03, 0.25);
const CONTINUOUS_HZ: (f32, f32) = (70.0, 4.0);

/// The value at a sharpness.
fn at_sharpness((dull, factor): (f32, f32), sharpness: f32) -> f32 {
    dull * factor.powf(sharpness)
}

/// The sharpness of a value; outside of 0 to 1 for one that no sharpness has.
fn sharpness_of((dull, factor): (f32, f32), value: f32) -> f32 {
    (value / dull).ln() / factor.ln()
}
