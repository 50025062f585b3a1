//! A part of a recording, by the times on its time line.

use std::path::Path;
use std::time::Duration;

use underfoot::recording::{Recording, Speed};
use underfoot::units::Instant;

use super::super::failure::Failure;

/// A part of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RecordedPart {
    pub(crate) from: Instant,
    pub(crate) to: Instant,
    /// The last moment of the recording, if it is known.
    ends: Option<Instant>,
}

impl RecordedPart {
    /// The part of the recording at `path` from `from_s` to `to_s`, in seconds since its first moment on display;
    /// without `to_s`, up to the end.
    pub(crate) fn of(path: &Path, from_s: f64, to_s: Option<f64>) -> Result<Self, Failure> {
        let recording = Recording::open(path)?;
        let begins = recording.begins().unwrap_or(Instant::START);
        let first = recording.source(Speed::Max).now().max(begins);
        let at = |at_s: f64| {
            let after = Duration::try_from_secs_f64(at_s).ok().map(|after| first + after);
            after.ok_or_else(|| Failure::Other(format!("{at_s} s is no time of a recording")))
        };
        let (from, mut ends) = (at(from_s)?, None);
        Recording::open(path)?.read_timeline(|timeline| {
            ends = timeline.span.map(|(_, last)| last);
            true
        });
        let to = to_s.map(at).transpose()?.or(ends).unwrap_or(from);
        let length_s = ends.map_or(0.0, |ends| ends.since(first).as_secs_f64());
        if to <= from || ends.is_none_or(|ends| from >= ends) {
            let to_s = to.since(first).as_secs_f64();
            return Err(Failure::Other(format!(
                "nothing lies between {from_s} s and {to_s:.1} s: the recording has {length_s:.1} s"
            )));
        }
        Ok(Self { from, to, ends })
    }

    /// Whether a moment belongs to the part.
    pub(crate) fn holds(&self, at: Instant) -> bool {
        (self.from..=self.to).contains(&at)
    }

    /// As [`Self::holds`], for seconds on the floor's clock.
    pub(super) fn holds_s(&self, at_s: f64) -> bool {
        (self.from.secs()..=self.to.secs()).contains(&at_s)
    }

    /// Whether a moment is behind the part.
    pub(super) fn is_over(&self, at: Instant) -> bool {
        at > self.to
    }

    /// The share of the work that is done at a moment: all that precedes the part is sensed, too.
    pub(super) fn share(&self, at: Instant) -> f64 {
        let end = self.ends.map_or(self.to, |ends| ends.min(self.to));
        (at.secs() / end.secs().max(1e-9)).clamp(0.0, 1.0)
    }
}
