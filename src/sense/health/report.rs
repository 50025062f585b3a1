//! The report on the health of the floor's sensors.

use crate::floor::SensorId;
use crate::sense::Quality;

use super::Trouble;
use crate::sense::BoardTiming;

/// The health of a floor's sensors, in numbers and by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorHealth {
    /// Sensors of each quality: live, degraded, stale, faulty.
    pub counts: [u32; 4],
    /// Number of sensors with the nominal law, without a calibration of their own.
    pub uncalibrated: u32,
    /// Whether the readings of the empty floor differ from its file on most tiles.
    pub foreign: bool,
    /// The boards that do not send once a millisecond, by number, each with its rate and time base.
    pub timings: Vec<(u16, BoardTiming)>,
    /// The faulty sensors, each with its fault.
    pub troubles: Vec<(SensorId, Trouble)>,
}

impl SensorHealth {
    /// Number of sensors of this quality.
    #[must_use]
    pub const fn count(&self, quality: Quality) -> u32 {
        self.counts[quality as usize]
    }

    /// Whether every sensor is live.
    #[must_use]
    pub fn is_well(&self) -> bool {
        self.counts[1..].iter().all(|&count| count == 0) && self.troubles.is_empty()
    }

    /// Whether it is worth a report after `told`: more than a short saturation of one tile's sensors by a foot.
    #[must_use]
    pub(crate) fn is_news_after(&self, told: &Self) -> bool {
        let [_, degraded, ..] = self.counts;
        degraded.abs_diff(told.counts[1]) > 4
            || self.counts[2..] != told.counts[2..]
            || (self.uncalibrated, self.foreign) != (told.uncalibrated, told.foreign)
            || self.troubles != told.troubles
            || self.timings.len() != told.timings.len()
            || self
                .timings
                .iter()
                .zip(&told.timings)
                .any(|(now, then)| now.0 != then.0 || now.1.is_news_after(&then.1))
    }

    /// Counts the sensors of `qualities`, one entry per tile, in place of those counted before.
    pub(crate) fn recount<'a>(&mut self, qualities: impl Iterator<Item = &'a [Quality; 4]>) {
        self.counts = [0; 4];
        for quality in qualities.flatten() {
            self.counts[*quality as usize] += 1;
        }
    }
}

/// One line: `all 144 live` if every sensor is live and none has a fault. Otherwise the number of sensors of each
/// quality, worst first, without the qualities that no sensor has: `1 faulty, 2 silent, 1 degraded, 140 live`. Stale
/// sensors are silent.
impl std::fmt::Display for SensorHealth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [live, degraded, stale, faulty] = self.counts;
        if self.is_well() {
            return write!(f, "all {live} live");
        }
        let counts = [(faulty, "faulty"), (stale, "silent"), (degraded, "degraded"), (live, "live")];
        for (number, (count, name)) in counts.into_iter().filter(|(count, _)| *count > 0).enumerate() {
            write!(f, "{}{count} {name}", if number > 0 { ", " } else { "" })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_worst_comes_first() {
        let mut health = SensorHealth::default();
        health.recount([[Quality::Live; 4]; 36].iter());
        assert_eq!(health.to_string(), "all 144 live");
        let mut tiles = [[Quality::Live; 4]; 36];
        tiles[3] = [Quality::Stale, Quality::Degraded, Quality::Faulty, Quality::Stale];
        health.recount(tiles.iter());
        assert_eq!(health.to_string(), "1 faulty, 2 silent, 1 degraded, 140 live");
        assert_eq!(health.count(Quality::Stale), 2);
        let saturated = SensorHealth { counts: [139, 2, 2, 1], ..health.clone() };
        assert!(!saturated.is_news_after(&health));
        let lossy = SensorHealth { counts: [116, 25, 2, 1], ..health.clone() };
        assert!(lossy.is_news_after(&health));
    }
}
