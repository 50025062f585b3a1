//! Movement of one board's readings while no load was ever seen on the floor.

use std::time::Duration;

use crate::floor::CountRange;
use crate::units::Instant;
use crate::wire::{LinkCause, MAX_CHANNELS, Readings};

/// Interval between two readings that are examined: a foot stands for longer.
const EVERY: Duration = Duration::from_millis(10);

/// Samples after which the rest value of a sensor is known: half a second.
const KNOWN: u16 = 50;

/// Samples in the average of the reading, and in that of its rest value: 50 ms, and 5 s.
const SHORT: f32 = 5.0;
const LONG: f32 = 500.0;

/// Distance from the rest value above which a reading counts as moved, in mean deviations of its noise.
const DEVIATIONS: f32 = 10.0;

/// Minimum of that distance: four counts, since a coarse converter toggles between two; for newtons the smallest
/// change of a board that sends shares of 1 or volts.
const LEAST_COUNTS: f32 = 4.0;
const LEAST_NEWTONS: f32 = 0.005;

/// Samples with moved readings needed in total: two seconds of a person standing or walking there.
const MOVED: u32 = 200;

/// Maximum of a narrow range of counts: a quarter of 16 bits, which is the full range of a 14-bit converter.
const NARROW: f32 = 16_384.0;

/// The end of the scale of 16 bits.
const WHOLE: f32 = u16::MAX as f32;

/// Maximum force on one sensor, in newtons: the wheel of a truck.
const HEAVY_N: f32 = 10_000.0;

/// Force in newtons that every sensor of a floor exceeds under a person.
const LIGHT_N: f32 = 5.0;

/// The readings of one board.
#[derive(Clone, Debug, Default)]
pub(super) struct Range {
    looked: Option<Instant>,
    channels: Vec<Channel>,
    is_newtons: bool,
    /// The range in the floor file.
    range: CountRange,
    /// Least and greatest reading within the range, on the scale of 16 bits, and the greatest beyond it.
    within: Option<(f32, f32)>,
    beyond: Option<f32>,
    greatest_newtons: f32,
    /// Number of samples with several readings above rest, below rest, and with a heavy reading.
    up: u32,
    down: u32,
    heavy: u32,
    /// Number of the latest consecutive samples in which most readings were unusable.
    bad: u32,
}

/// One channel.
#[derive(Clone, Copy, Debug, Default)]
struct Channel {
    looks: u16,
    now: f32,
    rest: f32,
    noise: f32,
}

impl Channel {
    /// Updates the channel with a reading: `now += (value - now) / SHORT`. Returns 1 above rest, -1 below, 0 at rest.
    /// At rest, `rest += (value - rest) / n` and `noise += (|value - now| - noise) / n`, n the samples so far up to
    /// `LONG`.
    fn take(&mut self, value: f32, least: f32) -> i8 {
        self.looks = self.looks.saturating_add(1);
        if self.looks == 1 {
            (self.now, self.rest) = (value, value);
        }
        self.now += (value - self.now) / SHORT;
        let off = self.now - self.rest;
        let has_moved = self.looks > KNOWN && off.abs() > least.max(DEVIATIONS * self.noise);
        if has_moved {
            return if off > 0.0 { 1 } else { -1 };
        }
        let memory = f32::from(self.looks).min(LONG);
        self.rest += (value - self.rest) / memory;
        self.noise += ((value - self.now).abs() - self.noise) / memory;
        0
    }
}

impl Range {
    /// The readings of a board whose counts have this range in the floor file.
    pub(super) fn new(range: CountRange) -> Self {
        Self { range, ..Self::default() }
    }

    /// Records the readings of a packet that arrived at `received`.
    pub(super) fn note(&mut self, readings: &Readings, received: Instant) {
        if self.looked.is_some_and(|looked| received.since(looked) < EVERY) {
            return;
        }
        self.looked = Some(received);
        match readings {
            Readings::Counts(counts) => {
                self.is_newtons = false;
                let counts = || counts.iter().map(|count| count.map(f32::from));
                counts().flatten().for_each(|count| self.widen(count));
                self.look(counts(), LEAST_COUNTS);
            }
            Readings::Scaled(values) => {
                self.is_newtons = false;
                let lowest = if self.range.is_bipolar() { -WHOLE - 1.0 } else { 0.0 };
                let inside =
                    |value: &f32| Some(*value).filter(|value| (lowest..=WHOLE + 0.5).contains(value));
                values.iter().filter_map(inside).for_each(|count| self.widen(count));
                let outside = values.iter().filter(|value| inside(value).is_none() && value.is_finite());
                let beyond = outside.copied().max_by(f32::total_cmp);
                self.beyond = self.beyond.into_iter().chain(beyond).max_by(f32::total_cmp);
                self.look(values.iter().map(inside), LEAST_COUNTS);
            }
            Readings::Newtons(newtons) => {
                self.is_newtons = true;
                let number = |newtons: &f32| Some(*newtons).filter(|newtons| newtons.abs() <= 50_000.0);
                let greatest = newtons.iter().filter_map(number).fold(0.0, f32::max);
                self.greatest_newtons = self.greatest_newtons.max(greatest);
                self.heavy += u32::from(greatest > HEAVY_N);
                self.look(newtons.iter().map(number), LEAST_NEWTONS);
            }
        }
    }

    fn widen(&mut self, count: f32) {
        let (least, greatest) = self.within.unwrap_or((count, count));
        self.within = Some((least.min(count), greatest.max(count)));
    }

    fn look(&mut self, readings: impl ExactSizeIterator<Item = Option<f32>>, least: f32) {
        let count = readings.len();
        self.channels.resize(count.min(MAX_CHANNELS), Channel::default());
        let (mut up, mut down, mut bad) = (0, 0, 0);
        for (channel, reading) in self.channels.iter_mut().zip(readings) {
            match reading.map(|reading| channel.take(reading, least)) {
                Some(1) => up += 1,
                Some(-1) => down += 1,
                Some(_) => {}
                None => bad += 1,
            }
        }
        // A single sensor that moves may be broken.
        let several = count.clamp(1, 2);
        self.up += u32::from(up >= several);
        self.down += u32::from(down >= several);
        self.bad = if 2 * bad > count { self.bad + 1 } else { 0 };
    }

    /// Returns a fault in the readings of board `board` that shows without a load.
    pub(super) fn fault(&self, board: u16) -> Option<LinkCause> {
        if self.bad >= MOVED / 2 {
            return Some(if self.is_newtons {
                LinkCause::NotNumbers { board }
            } else {
                let greatest = self.beyond.map(|beyond| self.range.count(beyond));
                LinkCause::CountsBeyond { board, greatest, full_scale: self.range.full_scale }
            });
        }
        let greatest = self.greatest_newtons;
        (self.heavy >= MOVED / 2).then_some(LinkCause::NewtonsLarge { board, greatest })
    }

    /// Returns the reason why no load was seen although the readings of board `board` move; `None` if they do not.
    pub(super) fn unseen(&self, board: u16) -> Option<LinkCause> {
        if self.up.max(self.down) < MOVED {
            return None;
        }
        let (least, greatest) = self.within.unwrap_or_default();
        Some(if self.is_newtons && self.up >= self.down && self.greatest_newtons < LIGHT_N {
            LinkCause::NewtonsSmall { board, greatest: self.greatest_newtons }
        } else if !self.is_newtons && (greatest < NARROW || greatest - least < 0.5 * NARROW) {
            let [least, greatest] = [least, greatest].map(|scaled| self.range.count(scaled));
            LinkCause::CountsNarrow { board, least, greatest, full_scale: self.range.full_scale }
        } else if self.down > 5 * self.up {
            LinkCause::ReadingsFall { board }
        } else {
            LinkCause::NoLoad { board }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the cause for a board with four sensors that read `reading` in each millisecond of ten seconds.
    fn unseen(reading: impl Fn(u32) -> f32, newtons: bool) -> Option<LinkCause> {
        let mut range = Range::default();
        for ms in 0..10_000 {
            let readings = if newtons {
                Readings::Newtons([reading(ms); 4].into_iter().collect())
            } else {
                Readings::Counts([Some(reading(ms) as u16); 4].into_iter().collect())
            };
            range.note(&readings, Instant::from_millis(ms.into()));
        }
        range.unseen(3)
    }

    /// Noise with a standard deviation of about one.
    fn noise(ms: u32) -> f32 {
        (ms.wrapping_mul(2_654_435_761) >> 16) as f32 / 65_536.0 * 3.4 - 1.7
    }

    /// 1 while a person stands on the floor, from 4 to 7 s.
    fn load(ms: u32) -> f32 {
        let seconds = ms as f32 / 1000.0;
        ((seconds - 4.0) / 0.12).min((7.0 - seconds) / 0.12).clamp(0.0, 1.0)
    }

    #[test]
    fn converters_of_few_bits_are_known_by_their_range() {
        for (bits, noise_counts) in [(8, 0.3), (10, 0.4), (12, 2.0), (14, 8.0)] {
            let full = (1 << bits) as f32;
            let read =
                |ms| (0.12 * full + 0.55 * full * load(ms) + noise_counts * noise(ms)).clamp(0.0, full - 1.0);
            let said = unseen(read, false);
            assert!(matches!(said, Some(LinkCause::CountsNarrow { board: 3, .. })), "{bits}: {said:?}");
            let words = format!("its counts never exceed {} of 65535", (1_u32 << bits) - 1);
            assert!(said.unwrap().to_string().contains(&words), "{bits}");
        }
    }

    #[test]
    fn counts_around_a_high_middle_are_told_with_their_range() {
        let said = unseen(|ms| 32_000.0 + 900.0 * load(ms) + 3.0 * noise(ms), false).unwrap().to_string();
        assert!(said.contains("stay between 319") && said.contains("and 329"), "{said}");
    }

    #[test]
    fn readings_that_fall_under_a_load_are_told() {
        let counts = unseen(|ms| 50_000.0 - 20_000.0 * load(ms) + 20.0 * noise(ms), false);
        assert_eq!(counts, Some(LinkCause::ReadingsFall { board: 3 }));
        let newtons = unseen(|ms| -200.0 * load(ms) + 0.1 * noise(ms), true);
        assert_eq!(newtons, Some(LinkCause::ReadingsFall { board: 3 }));
    }

    #[test]
    fn newtons_that_are_shares_or_volts_are_told() {
        for full in [1.0, 3.3, 5.0] {
            let said = unseen(|ms| 0.1 + 0.8 * full * load(ms) + 0.001 * noise(ms), true);
            assert!(matches!(said, Some(LinkCause::NewtonsSmall { .. })), "{full}: {said:?}");
        }
    }

    #[test]
    fn an_empty_floor_moves_nothing() {
        // Noise of the paper's converters, hum, zero drift, and a slammed door.
        let read = |ms: u32| {
            let seconds = ms as f32 / 1000.0;
            let hum = 40.0 * (seconds * 314.0).sin();
            let door = if (5000..5100).contains(&ms) { 900.0 } else { 0.0 };
            9000.0 + 26.0 * noise(ms) + hum + 15.0 * seconds + door
        };
        assert_eq!(unseen(read, false), None);
        assert_eq!(unseen(|_| 0.0, false), None);
        assert_eq!(unseen(|ms| 0.05 * noise(ms), true), None);
    }

    #[test]
    fn readings_that_are_none_or_too_heavy_are_told_at_once() {
        let fault = |readings: Readings| {
            let mut range = Range::default();
            (0..1100).for_each(|ms| range.note(&readings, Instant::from_millis(ms)));
            range.fault(0)
        };
        assert_eq!(
            fault(Readings::Counts([None; 4].into_iter().collect())),
            Some(LinkCause::CountsBeyond { board: 0, greatest: None, full_scale: 65_535 })
        );
        let fine = fault(Readings::Scaled([8_388_700.0; 4].into_iter().collect())).unwrap();
        assert!(fine.to_string().contains("full_scale: 16777215"), "{fine}");
        assert_eq!(
            fault(Readings::Newtons([f32::NAN; 4].into_iter().collect())),
            Some(LinkCause::NotNumbers { board: 0 })
        );
        assert_eq!(
            fault(Readings::Newtons([30_000.0; 4].into_iter().collect())),
            Some(LinkCause::NewtonsLarge { board: 0, greatest: 30_000.0 })
        );
        assert_eq!(fault(Readings::Newtons([300.0; 4].into_iter().collect())), None);
    }
}
