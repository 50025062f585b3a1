//! Converts the readings of a board's channels into the forces of sensors, many at a time.

// The loops over lanes stay plain indexed loops, which the compiler vectorises.
#![allow(clippy::needless_range_loop)]

use multiversion::multiversion;
use smallvec::SmallVec;

use super::board::Channel;
use super::sample::BoardSample;
use crate::floor::{Calibration, LawKind, exp};
use crate::sense::health::RangeEnd;
use crate::wire::MAX_CHANNELS;

/// Number of sensors converted together: those of as many tiles as most boards have.
pub(super) const WIDE: usize = 32;

/// The sensors of one tile.
pub(super) const NARROW: usize = 4;

/// Counts up to which a reading is zero (0.5 %: the converter's offset and noise).
const NOTHING: u16 = 327;

/// Flag of a sensor with a channel.
const WIRED: u8 = 1;

/// Flag of a sensor with so much of the plate's weight on it that it never reads zero.
const BEARS: u8 = 2;

/// Flag of a sensor with the nominal part's law.
const NOMINAL: u8 = 4;

/// Flag of a sensor whose converter has a sign: zero volts is the middle of its range.
const BIPOLAR: u8 = 8;

/// Consecutive sensors, tile by tile and corner by corner, and the channels that read them.
#[derive(Clone, Debug)]
pub(super) struct SensorWindow<const LANES: usize> {
    /// Number of the first sensor, four to a tile.
    pub(super) first: usize,
    /// The channel of each sensor, if it has one.
    channels: [u8; LANES],
    /// The channel of the first sensor, if the other channels follow in the sensors' order.
    run: Option<u8>,
    /// Flags of each sensor: [`WIRED`], [`BEARS`] and [`NOMINAL`].
    flags: [u8; LANES],
    /// Both parameters of exponential laws; meaningful only if all laws are exponential.
    factors: [f32; LANES],
    exponents: [f32; LANES],
    pub(super) tares: [f32; LANES],
    /// Whether all sensors have channels, and either all or none have the nominal law.
    pub(super) is_uniform: bool,
    /// The laws, if some are not exponential.
    laws: Option<Box<Laws<LANES>>>,
}

/// The laws of some sensors, of any kind.
#[derive(Clone, Debug)]
struct Laws<const LANES: usize> {
    laws: [Calibration; LANES],
    /// Counts of each sensor at and above which the reading is a lower bound.
    saturated: [u16; LANES],
}

/// The readings of a window's sensors, in newtons.
#[derive(Clone, Debug)]
pub(super) struct Read<const LANES: usize> {
    /// Before subtraction of the tare; NaN without a reading.
    pub(super) forces: [f32; LANES],
    pub(super) ends: [RangeEnd; LANES],
    /// As sent by the board, 0 for a zero reading; for newtons a digest of their bits.
    pub(super) raws: [u16; LANES],
    /// Whether the board itself converted them to newtons.
    pub(super) by_board: bool,
}

/// The windows for `channels` on a floor with `sensors` sensors.
///
/// Of two channels that read the same sensor the later one counts; channels beyond [`MAX_CHANNELS`] are ignored.
pub(super) fn windows(
    channels: &[Option<Channel>],
    sensors: usize,
) -> (SmallVec<[SensorWindow<WIDE>; 1]>, Vec<SensorWindow<NARROW>>) {
    let sensor = |channel: &Channel| 4 * channel.tile as usize + channel.corner.index();
    let wired = channels.iter().take(MAX_CHANNELS).enumerate();
    let mut wired: Vec<(usize, u8, Channel)> =
        wired.filter_map(|(number, channel)| channel.map(|it| (sensor(&it), number as u8, it))).collect();
    wired.sort_by_key(|(sensor, number, _)| (*sensor, *number));
    let (mut wide, mut narrow) = (SmallVec::new(), Vec::new());
    let mut rest = wired.as_slice();
    while let Some((first, ..)) = rest.first() {
        let first = first - first % NARROW;
        let within = |lanes: usize| rest.partition_point(|(sensor, ..)| *sensor < first + lanes);
        let taken = if within(WIDE) > NARROW && sensors >= WIDE {
            let (part, _) = rest.split_at(within(WIDE));
            wide.push(SensorWindow::new(first.min(sensors - WIDE), part));
            part.len()
        } else {
            let (part, _) = rest.split_at(within(NARROW));
            narrow.push(SensorWindow::new(first, part));
            part.len()
        };
        rest = &rest[taken..];
    }
    (wide, narrow)
}

impl<const LANES: usize> SensorWindow<LANES> {
    fn new(first: usize, wired: &[(usize, u8, Channel)]) -> Self {
        let mut window = Self {
            first,
            channels: [0; LANES],
            run: None,
            flags: [0; LANES],
            factors: [0.0; LANES],
            exponents: [0.0; LANES],
            tares: [0.0; LANES],
            is_uniform: false,
            laws: None,
        };
        let (mut laws, mut saturated) = ([Calibration::NOMINAL; LANES], [Calibration::SATURATED; LANES]);
        for (sensor, number, channel) in wired {
            let lane = sensor - first;
            window.channels[lane] = *number;
            let [bears, nominal, bipolar] =
                [(channel.bears, BEARS), (channel.is_nominal, NOMINAL), (channel.is_bipolar, BIPOLAR)]
                    .map(|(holds, flag)| if holds { flag } else { 0 });
            window.flags[lane] = WIRED | bears | nominal | bipolar;
            [window.factors[lane], window.exponents[lane]] = channel.calibration.numbers();
            laws[lane] = channel.calibration;
            window.tares[lane] = channel.tare;
            saturated[lane] = channel.saturated;
        }
        window.run = window.run();
        let first_flags = window.flags[0] & (WIRED | NOMINAL);
        window.is_uniform =
            window.is_wired(0) && window.flags.iter().all(|flags| flags & (WIRED | NOMINAL) == first_flags);
        let is_exponential = laws.iter().all(|law| law.kind() == LawKind::Exponential);
        window.laws = (!is_exponential).then(|| Box::new(Laws { laws, saturated }));
        window
    }

    #[inline(always)]
    pub(super) const fn is_wired(&self, lane: usize) -> bool {
        self.flags[lane] & WIRED != 0
    }

    /// Whether a sensor has the nominal part's law.
    #[inline(always)]
    pub(super) const fn is_nominal(&self, lane: usize) -> bool {
        self.flags[lane] & NOMINAL != 0
    }

    /// The channel of the first lane, if the channels of all wired lanes follow in order.
    fn run(&self) -> Option<u8> {
        let lane = (0..LANES).find(|lane| self.is_wired(*lane))?;
        let first = usize::from(self.channels[lane]).checked_sub(lane)?;
        let follows = |lane: usize| !self.is_wired(lane) || usize::from(self.channels[lane]) == first + lane;
        (0..LANES).all(follows).then_some(first as u8)
    }

    /// The readings of the sensors.
    #[inline(always)]
    pub(super) fn read(&self, sample: &BoardSample) -> Read<LANES> {
        match sample {
            BoardSample::Newtons(newtons) => {
                let (mut forces, mut raws) = ([f32::NAN; LANES], [0; LANES]);
                for lane in 0..LANES {
                    forces[lane] = newtons.get(usize::from(self.channels[lane])).copied().unwrap_or(f32::NAN);
                }
                for lane in 0..LANES {
                    raws[lane] = digest(forces[lane]);
                }
                Read { forces, ends: [RangeEnd::Within; LANES], raws, by_board: true }
            }
            BoardSample::Scaled(values) => self.read_scaled(values),
            BoardSample::Counts(counts) => {
                let run = self.run.and_then(|first| counts.run(first.into()));
                let picked;
                let values = if let Some(values) = run {
                    values
                } else {
                    picked = counts.pick(&self.channels);
                    &picked
                };
                let mut read = self.convert(values);
                // Written into a local list first: the compiler keeps a list written element by element in memory,
                // not in registers.
                if let Some(laws) = &self.laws {
                    let mut forces = [0.0; LANES];
                    for lane in 0..LANES {
                        forces[lane] = laws.laws[lane].force(values[lane]).0;
                    }
                    read.forces = forces;
                }
                if counts.is_any_missing() {
                    let mut forces = read.forces;
                    for lane in 0..LANES {
                        if counts.is_missing(self.channels[lane].into()) {
                            forces[lane] = f32::NAN;
                        }
                    }
                    read.forces = forces;
                }
                read
            }
        }
    }

    /// The readings of counts with fractions, by any law; NaN beyond the range of the converter.
    #[inline(never)]
    fn read_scaled(&self, values: &[f32]) -> Read<LANES> {
        const MOST: f32 = u16::MAX as f32;
        let mut read = Read {
            forces: [f32::NAN; LANES],
            ends: [RangeEnd::Within; LANES],
            raws: [0; LANES],
            by_board: false,
        };
        for lane in 0..LANES {
            let value = values.get(usize::from(self.channels[lane])).copied().unwrap_or(f32::NAN);
            let is_bipolar = self.flags[lane] & BIPOLAR != 0;
            let least = if is_bipolar { -MOST - 2.0 } else { 0.0 };
            // The comparison is false for NaN.
            if !(least..=MOST + 0.5).contains(&value) {
                continue;
            }
            let volts = Calibration::volts_of(value);
            let (force, saturated) = match &self.laws {
                Some(laws) => (laws.laws[lane].force_at(volts).0, laws.saturated[lane]),
                None => (self.factors[lane] * exp(self.exponents[lane] * volts), Calibration::SATURATED),
            };
            let size = if is_bipolar { value.abs() } else { value };
            read.forces[lane] = force;
            read.raws[lane] = digest(value);
            read.ends[lane] = if size >= f32::from(saturated) {
                RangeEnd::High
            } else if is_bipolar || value > f32::from(NOTHING) {
                RangeEnd::Within
            } else if self.flags[lane] & BEARS != 0 {
                RangeEnd::Low
            } else {
                RangeEnd::Bare
            };
        }
        read
    }

    /// Converts counts into forces by exponential laws, F = a exp(b U), and classifies them by the ends of the
    /// converters' ranges.
    ///
    /// A sensor that carries next to nothing of the empty floor is never missing: it may read zero.
    #[inline(always)]
    fn convert(&self, counts: &[u16; LANES]) -> Read<LANES> {
        let (mut forces, mut ends) = ([0.0; LANES], [RangeEnd::Within; LANES]);
        for lane in 0..LANES {
            let volts = Calibration::volts(counts[lane]);
            forces[lane] = self.factors[lane] * exp(self.exponents[lane] * volts);
        }
        let saturated = self.laws.as_ref().map_or([Calibration::SATURATED; LANES], |laws| laws.saturated);
        for lane in 0..LANES {
            let end = if self.flags[lane] & BEARS != 0 { RangeEnd::Low } else { RangeEnd::Bare };
            let end = if counts[lane] > NOTHING { RangeEnd::Within } else { end };
            ends[lane] = if counts[lane] >= saturated[lane] { RangeEnd::High } else { end };
        }
        Read { forces, ends, raws: *counts, by_board: false }
    }

    /// The net force of each sensor that is within its range and has an offset from `zero`, which is subtracted
    /// together with its tare.
    pub(super) fn net<'a>(
        &'a self,
        sample: &BoardSample,
        zero: impl Fn(usize, usize) -> Option<f32> + 'a,
    ) -> impl Iterator<Item = f32> + 'a {
        let read = self.read(sample);
        (0..LANES).filter_map(move |lane| {
            let is_known =
                self.is_wired(lane) && read.ends[lane] == RangeEnd::Within && read.forces[lane].is_finite();
            let sensor = self.first + lane;
            let zero = if is_known { zero(sensor / 4, sensor % 4) } else { None };
            zero.map(|zero| read.forces[lane] - (self.tares[lane] + zero))
        })
    }

    /// Number of sensors with a known distance of their readings from their tares, and number of those with a
    /// distance below `below`.
    #[inline(always)]
    pub(super) fn count_misses(&self, sample: &BoardSample, below: f32) -> (u32, u32) {
        let misses = self.misses(sample);
        let (mut known, mut less) = (0, 0);
        for lane in 0..LANES {
            known += u32::from(misses[lane].is_finite());
            less += u32::from(misses[lane] < below);
        }
        (known, less)
    }

    /// Distance of each sensor's reading from its tare; NaN if unknown.
    #[inline(always)]
    pub(super) fn misses(&self, sample: &BoardSample) -> [f32; LANES] {
        let read = self.read(sample);
        let mut misses = [f32::NAN; LANES];
        for lane in 0..LANES {
            let miss = (read.forces[lane] - self.tares[lane]).abs();
            misses[lane] = if self.is_wired(lane) { miss } else { f32::NAN };
        }
        misses
    }
}

/// 16-bit digest of a force in newtons: two different forces have the same digest once in 65,535; 0 for no force.
#[inline(always)]
fn digest(force: f32) -> u16 {
    let bits = force.to_bits();
    let mixed = (bits ^ bits >> 15).wrapping_mul(0x9e37_79b1) >> 16;
    if force == 0.0 { 0 } else { (mixed as u16).max(1) }
}

/// [`SensorWindow::misses`] of a wide window, without branches, over plain arrays, compiled for each vector instruction
/// set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn misses_wide(window: &SensorWindow<WIDE>, sample: &BoardSample) -> [f32; WIDE] {
    window.misses(sample)
}

/// [`SensorWindow::count_misses`] of a wide window, likewise.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
pub(super) fn count_misses_wide(window: &SensorWindow<WIDE>, sample: &BoardSample, below: f32) -> (u32, u32) {
    window.count_misses(sample, below)
}
