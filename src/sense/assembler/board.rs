//! One board: its packets that wait, its sensors' calibration and tare.

use super::stream::Stream;
use super::tare::{Found, Tare, TareMeter, TareOutcome};
use crate::floor::{Calibration, Corner, Floor, Geometry, SensorId};
use crate::sense::health::{End, Health, LOUD_N, Law};
use crate::sense::{ForceFrame, Quality};
use crate::units::Newtons;
use crate::wire::{LinkCounters, Readings};

/// How many slots may wait for their boards at once.
pub(super) const BUFFERS: usize = 4;

/// Counts up to which a sensor reads nothing (0.5 %: the converter's offset and noise).
const NOTHING: u16 = 327;

/// How much more than nothing a sensor must read on the empty floor to be missed there, in newtons.
const RESTS_N: f32 = 1.0;

/// More than any corner of a tile can carry, in newtons: 70 people of 70 kg on one corner. Chosen by us.
const MOST_N: f32 = 50_000.0;

/// One board: its stream, its wiring, and what it read in the slots that wait.
#[derive(Clone, Debug)]
pub(super) struct BoardTrack {
    pub(super) stream: Stream,
    geometry: Geometry,
    channels: Vec<Option<Channel>>,
    waiting: [Option<Readings>; BUFFERS],
    /// What its last packet read, and whether that was no news under a load.
    last: Option<Readings>,
    repeats: bool,
    /// Whether it sends counts, whose meaning only the floor's calibration tells.
    sends_counts: bool,
    /// Whether nobody has calibrated some of its sensors.
    has_nominal: bool,
    /// Whether it sends under another board's address.
    is_swapped: bool,
    tare: TareState,
}

/// What one channel measures. Small, for a large floor has many.
#[derive(Clone, Copy, Debug)]
struct Channel {
    tile: u32,
    corner: Corner,
    /// Whether its law is the nominal part's or its own.
    law: Law,
    /// Counts from which on it reads "at least".
    saturated: u16,
    calibration: Calibration,
    tare: f32,
    /// Whether so much rests on it while the floor is empty that it never reads nothing.
    bears: bool,
}

impl Channel {
    fn new(tile: u32, corner: Corner, calibration: Calibration, tare: f32) -> Self {
        let law = if calibration == Calibration::NOMINAL { Law::Nominal } else { Law::Measured };
        let saturated = calibration.saturated();
        let mut channel = Self { tile, corner, law, saturated, calibration, tare, bears: false };
        channel.set_tare(tare);
        channel
    }

    fn set_tare(&mut self, tare: f32) {
        self.tare = tare;
        self.bears = tare > self.calibration.force(0).0 + RESTS_N;
    }

    /// Where in the converter's range `count` lies. A sensor on which next to nothing
    /// rests while the floor is empty is never missed: it may well read nothing.
    fn end(&self, count: u16) -> End {
        if count >= self.saturated {
            End::High
        } else if count > NOTHING {
            End::Within
        } else if self.bears {
            End::Low
        } else {
            End::Bare
        }
    }
}

#[derive(Clone, Debug)]
enum TareState {
    FromFloor,
    Measuring(TareMeter),
    Taken,
    Refused(TareOutcome),
}

impl BoardTrack {
    pub(super) fn new(floor: &Floor, number: usize, tare: Tare) -> Self {
        let wiring = floor.boards.get(number).map(|board| board.channels.as_slice()).unwrap_or_default();
        let channel = |sensor: SensorId| {
            let (tile, corner) = (floor.geometry.index(sensor.tile)?, sensor.corner);
            let tare = floor.tare.get(tile).map_or(0.0, |all| all[corner.index()].0);
            Some(Channel::new(u32::try_from(tile).ok()?, corner, floor.law(sensor), tare))
        };
        let channels: Vec<_> = wiring.iter().map(|sensor| sensor.and_then(channel)).collect();
        let has_nominal = channels.iter().flatten().any(|channel| channel.law == Law::Nominal);
        let tare = match tare {
            Tare::FromFloor => TareState::FromFloor,
            Tare::AtStart(rules) => TareState::Measuring(TareMeter::new(channels.len(), rules)),
        };
        Self {
            stream: Stream::default(),
            geometry: floor.geometry,
            channels,
            waiting: Default::default(),
            last: None,
            repeats: false,
            sends_counts: false,
            has_nominal,
            is_swapped: false,
            tare,
        }
    }

    pub(super) fn channel_count(&self) -> usize {
        self.channels.len()
    }

    pub(super) const fn has(&self, buffer: usize) -> bool {
        self.waiting[buffer].is_some()
    }

    /// Keeps `readings` until the frame of `buffer`'s slot is made.
    pub(super) fn store(&mut self, buffer: usize, readings: &Readings) {
        self.sends_counts = matches!(readings, Readings::Counts(_));
        self.waiting[buffer] = Some(readings.clone());
    }

    /// Whether `readings` are, count for count, those of the packet before, although something rests on the
    /// board: a converter that works is noisy, and a foot never keeps still to a count.
    ///
    /// Nothing is said of an empty board, whose coarse converters may well rest, of sensors at the
    /// end of their range, nor of boards that send newtons, which may have smoothed them.
    pub(super) fn note_repeats(&mut self, readings: &Readings, health: &Health) -> bool {
        let is_same = self.last.as_ref() == Some(readings);
        if !is_same {
            self.last = Some(readings.clone());
        }
        self.repeats = is_same && !self.is_taring() && self.bears_load(readings, health);
        self.repeats
    }

    /// Whether its last packet said nothing new under a load.
    pub(super) const fn repeats(&self) -> bool {
        self.repeats
    }

    fn bears_load(&self, readings: &Readings, health: &Health) -> bool {
        let Readings::Counts(counts) = readings else { return false };
        let channels = self.channels.iter().zip(counts);
        channels.filter_map(|(channel, count)| channel.as_ref().zip(*count)).any(|(channel, count)| {
            let zero = channel.tare + health.zero(channel.tile as usize, channel.corner.index());
            channel.end(count) == End::Within && channel.calibration.force(count).0 - zero > LOUD_N
        })
    }

    /// Forgets what waits in `buffer`; true if there was something.
    pub(super) fn clear(&mut self, buffer: usize) -> bool {
        self.waiting[buffer].take().is_some()
    }

    /// Number of its sensors that send counts which nobody has calibrated.
    pub(super) fn uncalibrated(&self) -> usize {
        let nominal = |channel: &&Channel| channel.law == Law::Nominal;
        if self.sends_counts { self.channels.iter().flatten().filter(nominal).count() } else { 0 }
    }

    /// Whether newtons made of what it sends may be wrong: some of its counts are taken for a nominal part's, or it has
    /// changed places with another board.
    pub(super) const fn casts_doubt(&self) -> bool {
        (self.sends_counts && self.has_nominal) || self.is_swapped
    }

    pub(super) const fn set_swapped(&mut self, swapped: bool) {
        self.is_swapped = swapped;
    }

    /// Whether the floor file says what its sensors read on the empty floor.
    pub(super) const fn has_known_tare(&self) -> bool {
        matches!(self.tare, TareState::FromFloor)
    }

    /// By how many newtons the middle one of this board's sensors would miss its tare if it read `means`, channel by
    /// channel; `None` if these are not for its channels. `misses` is space for sorting.
    pub(super) fn misfit(&self, means: &[f32], is_counts: bool, misses: &mut Vec<f32>) -> Option<f32> {
        if means.len() != self.channels.len() {
            return None;
        }
        let force = |channel: &Channel, mean: f32| {
            if is_counts { channel.calibration.force(mean.round() as u16).0 } else { mean }
        };
        let channels = self.channels.iter().zip(means);
        let read = channels
            .filter_map(|(channel, mean)| Some((channel.as_ref()?, *mean)))
            .filter(|(_, mean)| mean.is_finite());
        misses.clear();
        misses.extend(read.map(|(channel, mean)| (force(channel, mean) - channel.tare).abs()));
        if misses.is_empty() {
            return None;
        }
        let middle = misses.len() / 2;
        Some(*misses.select_nth_unstable_by(middle, f32::total_cmp).1)
    }

    /// How far all of its values can be trusted.
    pub(super) fn quality(&self) -> Quality {
        if !self.stream.presence.is_live() || self.is_taring() {
            Quality::Stale
        } else if self.stream.loss.is_degraded() {
            Quality::Degraded
        } else {
            Quality::Live
        }
    }

    pub(super) const fn is_taring(&self) -> bool {
        matches!(self.tare, TareState::Measuring(_))
    }

    /// Starts averaging the tare afresh, if it is being measured.
    pub(super) fn interrupt_tare(&mut self) {
        if let TareState::Measuring(meter) = &mut self.tare {
            meter.interrupt();
        }
    }

    pub(super) fn tare_outcome(&self) -> TareOutcome {
        match self.tare {
            TareState::FromFloor => TareOutcome::FromFloor,
            TareState::Measuring(_) => TareOutcome::Measuring,
            TareState::Taken => TareOutcome::Taken,
            TareState::Refused(outcome) => outcome,
        }
    }

    /// The tare in use, sensor by sensor.
    pub(super) fn tares(&self) -> impl Iterator<Item = (usize, Corner, Newtons)> + '_ {
        self.channels
            .iter()
            .flatten()
            .map(|channel| (channel.tile as usize, channel.corner, Newtons(channel.tare)))
    }

    /// Writes what it read in `buffer` into `frame` and frees the buffer; without a sample there,
    /// what it read last stays.
    pub(super) fn apply(
        &mut self,
        buffer: Option<usize>,
        at_ns: i64,
        frame: &mut ForceFrame,
        health: &mut Health,
        counters: &mut LinkCounters,
    ) {
        let readings = buffer.and_then(|buffer| self.waiting[buffer].take());
        if let Some(readings) = &readings {
            self.measure_tare(readings, at_ns);
        }
        let quality = self.quality();
        match readings {
            Some(readings) if !self.is_taring() => {
                counters.bad_readings += self.write(&readings, quality, frame, health);
            }
            _ if quality == Quality::Stale => self.mark_stale(frame),
            _ => {}
        }
    }

    /// Writes calibrated and tared forces; gives the number of bad readings.
    fn write(
        &self,
        readings: &Readings,
        quality: Quality,
        frame: &mut ForceFrame,
        health: &mut Health,
    ) -> u64 {
        let mut bad = 0;
        let foreign = health.is_foreign();
        let mut put = |channel: &Channel, force: f32, end: End, law: Law| {
            let (tile, corner) = (channel.tile as usize, channel.corner.index());
            let force = force - channel.tare - health.zero(tile, corner);
            // NaN is not within any range.
            let own = if !(-MOST_N..=MOST_N).contains(&force) {
                bad += 1;
                Quality::Faulty
            } else if self.is_swapped {
                Quality::Faulty
            } else {
                frame.forces[tile][corner] = force;
                health.note(channel.tile, corner, force, end, law);
                if end == End::High || law == Law::Nominal || foreign {
                    Quality::Degraded
                } else {
                    Quality::Live
                }
            };
            frame.quality[tile][corner] = own.max(quality);
        };
        match readings {
            Readings::Counts(counts) => {
                for (channel, &count) in self.channels.iter().zip(counts) {
                    let Some(channel) = channel else { continue };
                    let force = count.map_or(f32::NAN, |count| channel.calibration.force(count).0);
                    let end = count.map_or(End::Within, |count| channel.end(count));
                    put(channel, force, end, channel.law);
                }
            }
            Readings::Newtons(forces) => {
                for (channel, &force) in self.channels.iter().zip(forces) {
                    let Some(channel) = channel else { continue };
                    put(channel, force, End::Within, Law::Board);
                }
            }
        }
        bad
    }

    fn mark_stale(&self, frame: &mut ForceFrame) {
        for channel in self.channels.iter().flatten() {
            let quality = &mut frame.quality[channel.tile as usize][channel.corner.index()];
            *quality = (*quality).max(Quality::Stale);
        }
    }

    fn measure_tare(&mut self, readings: &Readings, at_ns: i64) {
        let TareState::Measuring(meter) = &mut self.tare else { return };
        let forces = self.channels.iter().enumerate().map(|(number, channel)| match (channel, readings) {
            (None, _) => f32::NAN,
            (Some(channel), Readings::Counts(counts)) => {
                let count = counts.get(number).copied().flatten();
                count.map_or(f32::NAN, |count| channel.calibration.force(count).0)
            }
            (Some(_), Readings::Newtons(forces)) => forces.get(number).copied().unwrap_or(f32::NAN),
        });
        match meter.add(at_ns, forces) {
            None => {}
            Some(Found::Quiet(means)) => {
                for (channel, mean) in self.channels.iter_mut().zip(means) {
                    if let (Some(channel), Some(mean)) = (channel, mean) {
                        channel.set_tare(mean);
                    }
                }
                self.tare = TareState::Taken;
            }
            Some(Found::Noisy { channel, mean, deviation }) => {
                let sensor = self.channels.get(channel).copied().flatten().map(|channel| SensorId {
                    tile: self.geometry.tile_at_index(channel.tile as usize),
                    corner: channel.corner,
                });
                self.tare = sensor.map_or(TareState::FromFloor, |sensor| {
                    TareState::Refused(TareOutcome::Refused { sensor, mean, deviation })
                });
            }
        }
    }
}
