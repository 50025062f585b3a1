//! Monitoring of the sensors: readings that no foot causes, broken sensors, and drift of the zero.
//!
//! ```text
//! counts --calibration, tare, drift--> ForceFrame --Health--> ForceFrame with honest qualities
//!              ^                                    |
//!              +------------ zero -----------------+   (only on an empty, quiet tile)
//! ```
//!
//! [`plate`] models a rigid plate, [`averages`] holds the means of each tile over 64 ms, in which [`slow`] looks for
//! faults that take seconds, [`drift`] tracks the zero, [`creep`] corrects the remainder of a load, [`jump`] finds
//! changes too fast for a body, and [`repeats`] finds readings impossible for a working converter. Checks that must
//! precede a press of a control run here, in the same frame.

mod averages;
mod creep;
mod drift;
mod intake;
mod jump;
mod plate;
mod repeats;
mod report;
mod slow;
mod trouble;
#[cfg(test)]
mod walks;

use crate::floor::{Corner, Floor, Geometry, SensorId, TileBlock, TileId};
use crate::sense::centroid::corners;
use crate::sense::{ForceFrame, Quality};
use crate::units::{Instant, Newtons};

pub(super) use intake::Lanes;
pub use report::SensorHealth;
pub use trouble::Trouble;

use self::averages::{Averages, SHARES};
use self::creep::{Creep, Memory, Parts};
use self::jump::Jumps;
use self::plate::Twist;
use self::repeats::{Heard, Repeats};
use self::slow::{GAP_S, Slow};
use self::trouble::Sensor;

/// Force beside zero above which a tile is examined in every frame (N): the least that counts as load.
pub(super) const LOUD_N: f32 = 6.0;

/// Maximum increase of a sensor's load by a foot within a millisecond (N): the hardest heel strike takes five to
/// apply its weight (our choice).
const SUDDEN_N: f32 = 30.0;

/// Maximum decrease of a sensor's load within a millisecond when its corner lifts (N): the load on a corner of an
/// empty plate (our choice).
const FELL_N: f32 = 8.0;

/// Position of a reading in the converter's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum End {
    /// The normal range.
    #[default]
    Within,
    /// Next to zero volts, and below the sensor's reading on the empty floor.
    Low,
    /// Next to zero volts, as on the empty floor.
    Bare,
    /// At 98 % or above: the force is this or more.
    High,
}

impl End {
    /// Whether the sensor carries no measurable load.
    const fn reads_nothing(self) -> bool {
        matches!(self, Self::Low | Self::Bare)
    }

    /// Whether the reading alone requires an examination of the tile.
    const fn is_odd(self) -> bool {
        matches!(self, Self::Low | Self::High)
    }
}

/// The sensors' health on one floor.
///
/// Tiles at rest cost only an eighth of a visit per frame; allocates no memory.
#[derive(Clone, Debug)]
pub(super) struct Health {
    geometry: Geometry,
    /// Offset of each sensor without load beyond its tare, as tracked so far.
    zeros: Vec<[f32; 4]>,
    /// Additional offset of each due to creep.
    crept: Vec<[f32; 4]>,
    /// Sum of both.
    offsets: Vec<[f32; 4]>,
    memories: Vec<Memory>,
    creep: Creep,
    /// Flexibility of the floor's plates under twist.
    twist: Twist,
    /// The first tile of each share of the floor, and the end of the last one.
    shares: [usize; SHARES + 1],
    /// Time of the last visit to each share of the floor.
    visited: [Option<Instant>; SHARES],
    /// Maximum tracked offset of each: 20 % of the sensor's range.
    limits: Vec<[f32; 4]>,
    ends: Vec<[End; 4]>,
    /// Reading of each as sent by its board, 0 for zero; for newtons a digest of their bits.
    raws: Vec<[u16; 4]>,
    /// Sensors with the nominal law: the plate checks do not apply to forces that may be off by a third.
    guessed: Vec<[bool; 4]>,
    sensors: Vec<[Sensor; 4]>,
    averages: Averages,
    slow: Vec<Slow>,
    /// Whether each tile's sensors were all connected at the last visit.
    connected: Vec<bool>,
    /// Whether each tile carries a load, by its last complete block.
    loaded: Vec<bool>,
    /// Tiles with a reading to be examined in this frame.
    loud: Vec<u32>,
    /// Tiles with a faulty sensor, or that may start nothing.
    watched: Vec<u32>,
    /// Space for the next `watched`.
    spare: Vec<u32>,
    /// Number of the frame in which each tile was last checked, and its sensors' readings then.
    checked: Vec<u32>,
    read: Vec<[f32; 4]>,
    number: u32,
    changes: u64,
    found: u64,
    /// Number of tiles judged by their first block, and number of those with readings that no empty tile of this
    /// floor should have.
    judged: usize,
    strange: usize,
    seen: Vec<bool>,
    /// Number of those tiles with a load, which reveal nothing of their zeros.
    laden: usize,
    /// Whether the boards convert to newtons themselves: then the file does not apply.
    by_boards: bool,
    is_foreign: bool,
    jumps: Jumps,
    repeats: Repeats,
}

/// Maximum initial reading of a sensor (N) on the floor of the file: far more than zeros drift in a day.
const STRANGE_N: f32 = 2.0;

/// Force above which a tile counts as carrying a foot (N): more than the sum of another floor's zeros.
const LADEN_N: f32 = 25.0;

/// Share of empty tiles with strange readings above which the floor is a different one, and minimum number of empty
/// tiles.
const MOST_TILES: f32 = 0.4;
const FEWEST_TILES: usize = 4;

impl Health {
    pub(super) fn new(floor: &Floor) -> Self {
        let tiles = floor.geometry.tile_count();
        let limits = |tile: usize| match floor.calibration.get(tile) {
            Some(laws) => laws.map(|law| drift::LIMIT * law.force(u16::MAX).0),
            None => [drift::LIMIT * crate::floor::Calibration::NOMINAL.force(u16::MAX).0; 4],
        };
        Self {
            geometry: floor.geometry,
            shares: shares(&floor.geometry),
            zeros: vec![[0.0; 4]; tiles],
            crept: vec![[0.0; 4]; tiles],
            offsets: vec![[0.0; 4]; tiles],
            memories: vec![Memory::default(); tiles],
            creep: Creep::default(),
            twist: Twist::default(),
            visited: [None; SHARES],
            limits: (0..tiles).map(limits).collect(),
            ends: vec![[End::Within; 4]; tiles],
            raws: vec![[0; 4]; tiles],
            guessed: vec![[false; 4]; tiles],
            sensors: vec![[Sensor::default(); 4]; tiles],
            averages: Averages::new(tiles),
            slow: vec![Slow::default(); tiles],
            connected: vec![false; tiles],
            loaded: vec![false; tiles],
            loud: Vec::with_capacity(4 * tiles),
            watched: Vec::with_capacity(tiles),
            spare: Vec::with_capacity(tiles),
            checked: vec![0; tiles],
            read: vec![[0.0; 4]; tiles],
            number: 0,
            changes: 0,
            found: 0,
            judged: 0,
            strange: 0,
            seen: vec![false; tiles],
            laden: 0,
            by_boards: false,
            is_foreign: false,
            jumps: Jumps::new(tiles),
            repeats: Repeats::new(tiles, floor.noiseless),
        }
    }

    /// Offset to subtract from a reading of this sensor besides its tare.
    pub(super) fn zero(&self, tile: usize, corner: usize) -> f32 {
        self.offsets[tile][corner]
    }

    /// Marks unreliable readings in `frame`, which holds all forces `sampled` at that time.
    pub(super) fn inspect(&mut self, frame: &mut ForceFrame, sampled: Instant) {
        self.number = self.number.wrapping_add(1);
        let mut loud = std::mem::take(&mut self.loud);
        let mut watched = std::mem::take(&mut self.watched);
        self.spare.clear();
        for tile in loud.drain(..).chain(watched.drain(..)) {
            let before = std::mem::replace(&mut self.checked[tile as usize], self.number);
            if before == self.number {
                continue;
            }
            if before != self.number.wrapping_sub(1) {
                // The tile was not examined: it carried hardly any load.
                self.read[tile as usize] = [0.0; 4];
            }
            if self.look(tile as usize, frame) {
                self.spare.push(tile);
            }
            self.read[tile as usize] = frame.forces[tile as usize];
        }
        self.loud = loud;
        self.watched = std::mem::replace(&mut self.spare, watched);
        self.look_for_repeats(frame, sampled);
        self.visit_share(frame, sampled);
        self.jumps.mark(frame, &self.sensors, sampled);
    }

    /// Finds the plates with repeated readings, and learns the probability of chance repetitions of every
    /// [`SHARES`]th part of the floor.
    fn look_for_repeats(&mut self, frame: &mut ForceFrame, sampled: Instant) {
        let share = self.number as usize % SHARES;
        let tiles = self.shares[share]..self.shares[share + 1];
        let Self { repeats, raws, ends, sensors, jumps, .. } = self;
        let heard = Heard { raws, ends, news: jumps.read(), sensors };
        repeats.compare(frame, heard, sampled);
        repeats.visit(tiles, frame, heard, self.number / SHARES as u32);
    }

    /// Examines one tile; returns true if the next frame must examine it again.
    fn look(&mut self, tile: usize, frame: &mut ForceFrame) -> bool {
        let foreign = self.is_foreign();
        let (forces, ends, sensors) = (frame.forces[tile], self.ends[tile], &mut self.sensors[tile]);
        let quality = &mut frame.quality[tile];
        let mut may_start = true;
        if is_connected(quality, sensors) {
            let out = sensors.map(|sensor| sensor.is_out());
            let alone = plate::unanswered(forces, out);
            let measured = self.guessed[tile] == [false; 4] && !foreign;
            let before = self.read[tile];
            let twist = self.twist.range();
            for (corner, sensor) in sensors.iter_mut().enumerate() {
                let found = match ends[corner] {
                    End::High if alone == Some(corner) => Some(Trouble::Short),
                    End::Low
                        if measured
                            && plate::should_bear_more(
                                forces,
                                ends,
                                out,
                                corner,
                                before[corner] - forces[corner] > FELL_N,
                                twist,
                            ) =>
                    {
                        Some(Trouble::Open)
                    }
                    _ if measured && alone == Some(corner) => {
                        // On a limp plate the other sensors do not respond to a foot on one sensor either; but a foot
                        // pushes, and not from one millisecond to the next.
                        let is_sudden = (forces[corner] - before[corner]).abs() > SUDDEN_N;
                        let is_none = is_sudden || forces[corner] < 0.0 || !self.twist.may_be_limp();
                        may_start &= is_none;
                        is_none.then_some(Trouble::Offset)
                    }
                    _ => None,
                };
                if let Some(found) = found {
                    let is_news = sensor.find(found, forces[corner]);
                    self.changes += u64::from(is_news);
                    self.found += u64::from(is_news);
                    if (forces[corner] - before[corner]).abs() > SUDDEN_N {
                        sensor.struck();
                    }
                }
            }
        }
        let mut in_trouble = false;
        for corner in 0..4 {
            let sensor = &sensors[corner];
            quality[corner] = quality[corner].max(sensor.quality());
            may_start &= !sensor.forbids_start() && (ends[corner] != End::High || sensor.is_out());
            in_trouble |= sensor.trouble().is_some();
        }
        frame.may_start[tile] = may_start;
        in_trouble || !may_start
    }

    /// Adds this frame to the averages of every [`SHARES`]th part of the floor in turn.
    fn visit_share(&mut self, frame: &ForceFrame, sampled: Instant) {
        let share = self.number as usize % SHARES;
        let last = self.visited[share].replace(sampled);
        let dt = last.map_or(0.0, |last| sampled.since(last).as_secs_f32().min(GAP_S));
        let parts = Parts::of(dt);
        self.creep.ease(dt / SHARES as f32);
        let tiles = self.shares[share]..self.shares[share + 1];
        for tile in tiles.clone() {
            self.connected[tile] = is_connected(&frame.quality[tile], &self.sensors[tile]);
        }
        let Self { averages, ends, connected, .. } = self;
        if averages.add(share, tiles.clone(), &frame.forces, ends, connected) {
            tiles.clone().for_each(|tile| self.finish_block(tile, sampled));
        }
        self.creep.follow(
            &parts,
            &frame.forces[tiles.clone()],
            &self.connected[tiles.clone()],
            &mut self.memories[tiles.clone()],
            &mut self.crept[tiles.clone()],
        );
        let (zeros, crept) = (&self.zeros[tiles.clone()], &self.crept[tiles.clone()]);
        let both = zeros.as_flattened().iter().zip(crept.as_flattened());
        let offsets = self.offsets[tiles].as_flattened_mut();
        offsets.iter_mut().zip(both).for_each(|(offset, (zero, crept))| *offset = zero + crept);
    }

    fn finish_block(&mut self, tile: usize, at: Instant) {
        let alone = !self.has_loaded_neighbour(tile);
        let foreign = self.is_foreign();
        let is_first = !self.seen[tile];
        let Self { zeros, limits, guessed, sensors, averages, slow, crept, memories, creep, twist, .. } =
            self;
        let (slow, sensors) = (&mut slow[tile], &mut sensors[tile]);
        let had_trouble = sensors.map(|sensor| sensor.trouble());
        if let Some(block) = slow.finish(averages.block(tile), at) {
            self.loaded[tile] = block.is_loaded();
            self.seen[tile] = true;
            if is_first {
                self.judged += 1;
                let laden = block.means.iter().sum::<f32>().abs() > LADEN_N;
                let strange = block.means.iter().filter(|mean| mean.abs() > STRANGE_N).count() > 1;
                self.laden += usize::from(laden);
                self.strange += usize::from(strange && !laden);
            }
            if guessed[tile] == [false; 4] && !foreign {
                slow.judge(&block, alone, twist.range(), sensors);
            }
            let is_sound = sensors.iter().all(|sensor| sensor.trouble().is_none());
            let has_lifted = block.lows.into_iter().any(corners::has_lifted)
                || block.ends.iter().any(|end| end.reads_nothing());
            if is_sound && guessed[tile] == [false; 4] && !has_lifted && !block.ends.contains(&End::High) {
                twist.learn(block.means);
            }
            if is_sound && !block.ends.contains(&End::High) {
                let reads: f32 = block.means.iter().chain(&crept[tile]).sum();
                creep.learn(&mut memories[tile], reads, block.seconds);
            }
            slow.drift.follow(&block, alone, &limits[tile], &mut zeros[tile], sensors);
        }
        let has_trouble = sensors.map(|sensor| sensor.trouble());
        if had_trouble != has_trouble {
            self.changes += 1;
            let fell_ill =
                had_trouble.iter().zip(has_trouble).filter(|(had, has)| has.is_some() && **had != *has);
            self.found += fell_ill.count() as u64;
            if !self.watched.contains(&(tile as u32)) {
                self.watched.push(tile as u32);
            }
        }
        if is_first {
            self.judge_floor();
        }
    }

    /// Whether a part of a foot may stand on this tile, by the loads of its neighbours.
    fn has_loaded_neighbour(&self, tile: usize) -> bool {
        let first = self.geometry.tile_at_index(tile);
        let around = TileBlock { first, columns: 1, rows: 1 }.grown(1);
        let others = around.tiles().filter_map(|other| self.geometry.index(other));
        others.filter(|&other| other != tile).any(|other| self.loaded[other])
    }

    /// Number of times that a sensor became faulty or recovered.
    pub(super) const fn changes(&self) -> u64 {
        self.changes
    }

    /// Number of times that a sensor became faulty.
    pub(super) const fn found(&self) -> u64 {
        self.found
    }

    /// Number of jumps of a tile's load, and the last such tile with its jump in newtons.
    pub(super) fn jumps(&self) -> (u64, Option<(TileId, f32)>) {
        let (count, last) = self.jumps.found();
        (count, last.map(|(tile, newtons)| (self.geometry.tile_at_index(tile), newtons)))
    }

    /// Whether a repetition of this sensor's readings indicates a frozen converter.
    pub(super) fn tells(&self, tile: usize, corner: usize) -> bool {
        self.repeats.tells(tile, corner)
    }

    /// Number of repetitions found, and the plates that repeat now.
    pub(super) fn repeating(&self) -> (u64, impl Iterator<Item = TileId> + '_) {
        (self.repeats.count(), self.repeats.repeating().map(|tile| self.geometry.tile_at_index(tile)))
    }

    /// Whether, at the start, most tiles had readings that no empty tile of the file's floor should have.
    pub(super) const fn is_foreign(&self) -> bool {
        self.is_foreign
    }

    fn judge_floor(&mut self) {
        let empty = self.judged - self.laden;
        let all_seen = self.judged == self.seen.len() && !self.by_boards;
        self.is_foreign =
            all_seen && empty >= FEWEST_TILES && self.strange as f32 > MOST_TILES * empty as f32;
    }

    /// The faulty sensors.
    pub(super) fn troubles(&self) -> impl Iterator<Item = (SensorId, Trouble)> + '_ {
        self.watched.iter().flat_map(move |&tile| {
            let id = self.geometry.tile_at_index(tile as usize);
            let sensors = &self.sensors[tile as usize];
            Corner::ALL.into_iter().filter_map(move |corner| {
                let trouble = sensors[corner.index()].trouble()?;
                Some((SensorId { tile: id, corner }, trouble))
            })
        })
    }

    /// Creep of the sensors, as a share of their load for each decade.
    pub(super) const fn creep(&self) -> f32 {
        self.creep.share()
    }

    /// Tracked offset of each sensor's zero, per tile and corner.
    pub(super) fn drift(&self) -> impl ExactSizeIterator<Item = [Newtons; 4]> + '_ {
        self.zeros.iter().map(|zeros| zeros.map(Newtons))
    }
}

/// The first tile of each share of the floor, and the end of the last one.
///
/// A tile is in the same share for every division of the whole floor, so that each computer with this tile averages
/// it over the same frames.
fn shares(geometry: &Geometry) -> [usize; SHARES + 1] {
    let (columns, rows) = geometry.whole();
    let (columns, whole) = (usize::from(columns), usize::from(columns) * usize::from(rows));
    let place = |tile: TileId| usize::from(tile.row) * columns + usize::from(tile.column);
    let places: Vec<usize> = geometry.tiles().map(place).collect();
    std::array::from_fn(|share| places.partition_point(|&place| place < whole * share / SHARES))
}

/// Whether all four sensors deliver, not counting those known to be broken.
fn is_connected(quality: &[Quality; 4], sensors: &[Sensor; 4]) -> bool {
    quality.iter().zip(sensors).all(|(quality, sensor)| *quality < Quality::Stale || sensor.is_out())
}
