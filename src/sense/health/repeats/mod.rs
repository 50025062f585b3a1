//! Detects plates with repeated readings: their converters are frozen or replay earlier readings.
//!
//! A working converter is noisy, and a foot never keeps still to a count. The probability of a repetition by chance
//! is learnt while the tile is idle ([`noise`]). Under a load each reading is compared with earlier ones ([`run`],
//! [`history`]): the same value, the same two values, or the same readings in the same order count as a repetition. A
//! plate repeats if two of its sensors, or all usable ones, have done so for 100 ms and
//!
//! ```text
//! L = -sum over these sensors of (readings / 8) ln q > 30
//! ```
//!
//! with q the probability that the sensor reads the same value 8 ms later. Two sensors with noise of one count reach
//! that in 100 ms. By chance it happens once in 10^13 times.
//!
//! ```text
//! Unlearned --noise known--> trusted or Coarse
//! trusted   --repeats-->     Repeats --100 ms without--> trusted
//! ```

mod history;
mod noise;
mod run;

use std::ops::Range;

use self::history::{MOST_LAG, ReadingHistory};
use self::noise::{ExaminedReadings, NoiseClass, SensorNoise, is_within};
use self::run::{REPEATED_FOR, Run};
use super::RangeEnd;
use super::intervals::SampleIntervals;
use super::trouble::Sensor;
use crate::sense::{ForceFrame, HoldDoubt, Quality};
use crate::units::Instant;

/// Negative log likelihood above which a repetition is not chance, in nats.
const IMPROBABLE: f32 = 30.0;

/// Load of a tile above which its readings are compared, and below which the comparison ends (N): less than the
/// minimum of a loaded tile.
const LOADED_N: f32 = 4.0;
const EMPTY_N: f32 = 2.0;

/// Load of a tile up to which its sensors show their own noise (N): a drifted zero may read this much, and such a
/// load operates nothing (our choice).
const IDLE_N: f32 = 12.0;

/// Number of visits without load after which the comparison of a tile's readings ends.
const EMPTY_VISITS: u8 = 8;

/// Maximum number of tiles compared at once.
const MOST_WATCHED: usize = 4096;

/// Marks a tile without a watch.
const NONE: u32 = u32::MAX;

/// Watches the plates of one floor for repeated readings. Allocates memory only at its creation.
#[derive(Clone, Debug)]
pub(super) struct Repeats {
    /// Whether the readings have no noise of their own, so that repetitions are meaningless.
    noiseless: bool,
    noise: SensorNoise,
    /// Whether each tile was nearly empty at its last visit.
    idle: Vec<[bool; 4]>,
    watched: Vec<Watch>,
    /// Position in `watched` of each tile, or [`NONE`].
    place: Vec<u32>,
    count: u64,
}

/// A plate under load.
#[derive(Clone, Debug)]
struct Watch {
    tile: u32,
    runs: [Run; 4],
    history: ReadingHistory,
    /// Readings of its sensors at the last visit.
    raws: [u16; 4],
    newtons: [f32; 4],
    /// Number of visits for which it has been empty.
    empty: u8,
    /// Time until which its readings are stale.
    until: Option<Instant>,
}

/// The readings of all tiles' sensors, in the present frame.
#[derive(Clone, Copy)]
pub(super) struct Heard<'a> {
    /// The readings as sent by the boards; 0 for a zero reading.
    pub raws: &'a [[u16; 4]],
    pub ends: &'a [[RangeEnd; 4]],
    /// Whether each reading arrived with this frame.
    pub news: &'a [[bool; 4]],
    pub sensors: &'a [[Sensor; 4]],
}

impl Repeats {
    pub(super) fn new(tiles: usize, noiseless: bool) -> Self {
        Self {
            noiseless,
            noise: SensorNoise::new(tiles),
            idle: vec![[true; 4]; tiles],
            watched: Vec::with_capacity(tiles.min(MOST_WATCHED)),
            place: vec![NONE; tiles],
            count: 0,
        }
    }

    /// Number of repetitions found.
    pub(super) const fn count(&self) -> u64 {
        self.count
    }

    /// Whether the readings have no noise of their own.
    pub(super) const fn is_noiseless(&self) -> bool {
        self.noiseless
    }

    /// Whether a repetition of this sensor's readings is improbable.
    pub(super) fn tells(&self, tile: usize, corner: usize) -> bool {
        !self.noiseless && self.noise.is_fine(tile, corner)
    }

    /// Indices of the plates with repeated readings.
    pub(super) fn repeating(&self) -> impl Iterator<Item = usize> + '_ {
        self.watched.iter().filter(|watch| watch.until.is_some()).map(|watch| watch.tile as usize)
    }

    /// Compares the readings of the plates under load, and marks repeating plates in `frame`.
    pub(super) fn compare(
        &mut self,
        frame: &mut ForceFrame,
        heard: Heard<'_>,
        intervals: &SampleIntervals,
        now: Instant,
    ) {
        let Self { noise, watched, count, .. } = self;
        for watch in watched {
            let tile = watch.tile as usize;
            watch.read(heard.raws[tile], heard.ends[tile], heard.news[tile], now);
            if watch.repeats(noise, heard.ends[tile], &heard.sensors[tile], intervals.ms(tile), now) {
                *count += u64::from(watch.until.is_none());
                watch.until = Some(now + REPEATED_FOR);
            } else if watch.until.is_some_and(|until| now >= until) {
                watch.until = None;
                frame.hold_doubts[tile] = doubt(noise, tile, &heard.sensors[tile]);
            }
            if watch.until.is_some() {
                frame.hold_doubts[tile] = Some(HoldDoubt::Repeats);
                for quality in &mut frame.quality[tile] {
                    *quality = (*quality).max(Quality::Stale);
                }
            }
        }
    }

    /// Visits `tiles` for the time numbered `visit`, every 8 ms: learns the noise of nearly empty tiles, finds
    /// replayed readings, and starts and ends the watches of plates.
    pub(super) fn visit(
        &mut self,
        tiles: Range<usize>,
        frame: &mut ForceFrame,
        heard: Heard<'_>,
        intervals: &SampleIntervals,
        visit: u32,
    ) {
        if self.noiseless {
            return;
        }
        for tile in tiles.clone() {
            let load = frame.forces[tile].iter().sum::<f32>().abs();
            let place = self.place[tile];
            self.idle[tile] = [load < IDLE_N; 4];
            if place != NONE {
                self.visit_watched(place as usize, load, &frame.forces[tile], heard, intervals.ms(tile));
            } else if load >= LOADED_N {
                self.watch(tile, &frame.forces[tile], heard.raws[tile]);
            }
        }
        let seen = ExaminedReadings {
            raws: heard.raws,
            ends: heard.ends,
            news: heard.news,
            idle: &self.idle,
            has_pauses: !intervals.are_all_one(),
        };
        self.noise.look(tiles.clone(), seen, visit);
        for tile in tiles {
            if frame.hold_doubts[tile] != Some(HoldDoubt::Repeats) {
                frame.hold_doubts[tile] = doubt(&mut self.noise, tile, &heard.sensors[tile]);
            }
        }
    }

    fn watch(&mut self, tile: usize, newtons: &[f32; 4], raws: [u16; 4]) {
        if self.watched.len() < self.watched.capacity() {
            self.place[tile] = self.watched.len() as u32;
            let (tile, newtons) = (tile as u32, *newtons);
            let (runs, history) = ([Run::default(); 4], ReadingHistory::EMPTY);
            self.watched.push(Watch { tile, runs, history, raws, newtons, empty: 0, until: None });
        }
    }

    fn visit_watched(
        &mut self,
        place: usize,
        load: f32,
        newtons: &[f32; 4],
        heard: Heard<'_>,
        interval_ms: f32,
    ) {
        let watch = &mut self.watched[place];
        let tile = watch.tile as usize;
        watch.empty = if load < EMPTY_N { watch.empty + 1 } else { 0 };
        for corner in 0..4 {
            watch.runs[corner].note_cycle(watch.history.cycle(corner, interval_ms));
            let raws = [heard.raws[tile][corner], watch.raws[corner]];
            let is_known = heard.news[tile][corner] && is_within(heard.ends[tile][corner], raws[0]);
            if load >= IDLE_N && is_known && watch.until.is_none() {
                let newtons = [newtons[corner], watch.newtons[corner]];
                self.noise.look_under_load((tile, corner), raws, newtons);
            }
        }
        (watch.raws, watch.newtons) = (heard.raws[tile], *newtons);
        if watch.empty >= EMPTY_VISITS && watch.until.is_none() {
            self.watched.swap_remove(place);
            self.place[tile] = NONE;
            if let Some(moved) = self.watched.get(place) {
                self.place[moved.tile as usize] = place as u32;
            }
        }
    }
}

impl Watch {
    fn read(&mut self, raws: [u16; 4], ends: [RangeEnd; 4], news: [bool; 4], now: Instant) {
        for corner in (0..4).filter(|&corner| news[corner]) {
            self.runs[corner].read(raws[corner], now);
            if is_within(ends[corner], raws[corner]) {
                self.history.read(corner, raws[corner]);
            } else {
                // At an end of its range a sensor repeats one value, and nothing follows from that.
                self.history.forget(corner);
                self.runs[corner].note_cycle(0);
            }
        }
    }

    /// Whether two of its sensors, or all usable ones, repeat with an improbable run.
    fn repeats(
        &self,
        noise: &SensorNoise,
        ends: [RangeEnd; 4],
        sensors: &[Sensor; 4],
        interval_ms: f32,
        now: Instant,
    ) -> bool {
        let (mut told, mut repeated, mut nats) = (0, 0, 0.0);
        let tile = self.tile as usize;
        for corner in 0..4 {
            let can_tell = is_within(ends[corner], self.runs[corner].value())
                && !sensors[corner].is_out()
                && noise.is_fine(tile, corner);
            if can_tell {
                let found =
                    self.runs[corner].nats(noise.same(tile, corner), MOST_LAG as u32, interval_ms, now);
                told += 1;
                repeated += u8::from(found > 0.0);
                nats += found;
            }
        }
        nats > IMPROBABLE && (repeated >= 2 || repeated == told)
    }
}

/// The reason for which the sensors of this tile may not hold a control, from their noise: a tile needs three fine
/// sensors, the minimum with which it continues.
fn doubt(noise: &mut SensorNoise, tile: usize, sensors: &[Sensor; 4]) -> Option<HoldDoubt> {
    let (mut fine, mut unknown) = (0, 0);
    for (corner, sensor) in sensors.iter().enumerate() {
        match noise.grain(tile, corner) {
            _ if sensor.is_out() => {}
            NoiseClass::Fine => fine += 1,
            NoiseClass::Unknown => unknown += 1,
            NoiseClass::Coarse => {}
        }
    }
    match (fine, unknown) {
        (3.., _) => None,
        _ if fine + unknown >= 3 => Some(HoldDoubt::Unlearned),
        _ => Some(HoldDoubt::Coarse),
    }
}
