//! Feet over time as points with straight lines between them: small enough for a link, and the same feet on every
//! machine.
//!
//! | file | content |
//! |---|---|
//! | `mod.rs` | the feet at each millisecond |
//! | `recorder.rs` | feet of each millisecond to points |
//! | `code.rs` | points to bytes and back |
//! | `tape.rs` | a recorder between a driver and its floor |
//! | `take_over.rs` | a driver that goes on from a moment of recorded feet |

mod code;
mod recorder;
mod take_over;
mod tape;
#[cfg(test)]
mod tests;

use std::sync::Arc;
use std::time::Duration;

use glam::Vec2;

use super::foot::{Foot, FootDriver};
use underfoot::units::{Instant, Newtons};

pub use code::BadFeet;
pub use recorder::FeetRecorder;
pub use take_over::{TakeOver, go_on_from};
pub use tape::{FeetTape, taped};

/// Maximum length of recorded feet, in milliseconds: ten minutes.
pub(super) const MOST_MS: u32 = 600_000;

/// Maximum number of points: ten minutes of a foot that never rests.
pub(super) const MOST_POINTS: usize = 60_000;

/// Maximum number of lines: a foot that comes down somewhere else begins one.
pub(super) const MOST_LINES: usize = 4000;

/// Maximum number of feet at the same time: more than stand on a floor that a page simulates.
pub(super) const MOST_FEET: usize = 64;

/// Time of empty floor at the end, in milliseconds: every control is released in it.
pub(super) const END_MS: u32 = 1000;

/// Units of the numbers of a point.
const METRES: f64 = 1e-4;
const RADIANS: f64 = 1e-3;
const NEWTONS: f64 = 0.1;
const ROLL: f64 = 1e-3;
const MILLIMETRES: f64 = 1e-3;

/// Number of values of a point beside its time.
pub(super) const VALUES: usize = 5;

/// Index of the force among them.
pub(super) const FORCE: usize = 3;

/// A foot at one moment, in whole units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FootPoint {
    /// Milliseconds since the beginning.
    pub(super) ms: u32,
    /// Place east and north (0.1 mm), heading (mrad, unwrapped), force (0.1 N) and roll (1/1000).
    pub(super) values: [i32; VALUES],
}

/// One foot from its first to its last moment; between two points its values change evenly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FootLine {
    pub(super) left: bool,
    /// Length of the bare foot, in millimetres.
    pub(super) length_mm: u16,
    /// At least one, with increasing times.
    pub(super) points: Vec<FootPoint>,
}

impl FootLine {
    fn first_ms(&self) -> u32 {
        self.points.first().map_or(u32::MAX, |point| point.ms)
    }

    fn last_ms(&self) -> u32 {
        self.points.last().map_or(0, |point| point.ms)
    }

    /// The foot at this moment; `None` before its first and after its last one.
    fn foot(&self, ms: u32) -> Option<Foot> {
        let next = self.points.partition_point(|point| point.ms <= ms);
        let from = self.points.get(next.checked_sub(1)?)?;
        let to = match self.points.get(next) {
            Some(to) => to,
            None if from.ms == ms => from,
            None => return None,
        };
        // Whole numbers and one division: the same bits on every machine.
        let share = f64::from(ms - from.ms) / f64::from((to.ms - from.ms).max(1));
        let value = |index: usize| {
            let [from, to] = [from, to].map(|point| f64::from(point.values[index]));
            from + (to - from) * share
        };
        Some(Foot {
            position: Vec2::new((value(0) * METRES) as f32, (value(1) * METRES) as f32),
            heading: (value(2) * RADIANS) as f32,
            length_m: (f64::from(self.length_mm) * MILLIMETRES) as f32,
            force: Newtons((value(FORCE) * NEWTONS) as f32),
            roll: (value(4) * ROLL) as f32,
            left: self.left,
        })
    }
}

/// Feet over time, from millisecond 0.
///
/// They keep the recorded feet within 0.3 mm, 4 mrad, half a newton and half a percent of the force, and 0.004 of the
/// roll; a foot in the air within 10 mm. The feet at a moment do not depend on the machine, to the bit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedFeet {
    length_ms: u32,
    /// In the order of their first points.
    lines: Vec<FootLine>,
}

impl RecordedFeet {
    /// Records the feet of `driver` to its end, at most ten minutes of them.
    #[must_use]
    pub fn of(driver: &mut dyn FootDriver) -> Self {
        let (mut recorder, mut feet) = (FeetRecorder::default(), Vec::new());
        for ms in 0..u64::from(MOST_MS) {
            let at = Instant::from_millis(ms);
            if !driver.feet(at, &mut feet) || !recorder.note(at, &feet) {
                break;
            }
        }
        recorder.finish()
    }

    /// Time from the beginning to the end, with a second of empty floor in the end.
    #[must_use]
    pub fn duration(&self) -> Duration {
        Duration::from_millis(self.length_ms.into())
    }

    /// Whether no foot is ever there.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Replaces `feet` by those at the moment `at`; moments may come in any order.
    pub fn feet_at(&self, at: Instant, feet: &mut Vec<Foot>) {
        feet.clear();
        let Ok(ms) = u32::try_from(at.micros() / 1000) else { return };
        let begun = self.lines.partition_point(|line| line.first_ms() <= ms);
        feet.extend(self.lines.iter().take(begun).filter_map(|line| line.foot(ms)));
    }

    /// Writes the feet as bytes, which [`RecordedFeet::decode`] reads.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        code::encode(self)
    }

    /// Reads the bytes of [`RecordedFeet::encode`].
    ///
    /// # Errors
    /// [`BadFeet`] for all other bytes: any bytes give feet or an error, in time and memory in proportion to them.
    pub fn decode(bytes: &[u8]) -> Result<Self, BadFeet> {
        code::decode(bytes)
    }
}

/// Drives recorded feet.
#[derive(Clone, Debug)]
pub struct PlayedFeet(Arc<RecordedFeet>);

impl PlayedFeet {
    /// The feet of `recorded` from the clock's start; the performance ends with them.
    #[must_use]
    pub fn new(recorded: Arc<RecordedFeet>) -> Self {
        Self(recorded)
    }
}

impl FootDriver for PlayedFeet {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        self.0.feet_at(at, feet);
        let goes_on = at.since(Instant::START) <= self.0.duration();
        if !goes_on {
            feet.clear();
        }
        goes_on
    }
}
