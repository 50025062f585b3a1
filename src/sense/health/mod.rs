//! Watching the sensors: which readings can be a foot's, which sensor is broken, where zero has drifted to.
//!
//! ```text
//! counts --calibration, tare, drift--> ForceFrame --Health--> ForceFrame with honest qualities
//!              ^                                    |
//!              +------------ zero -----------------+   (only on an empty, quiet tile)
//! ```
//!
//! [`plate`] knows what a rigid plate allows, [`averages`] are those of each tile over
//! 64 ms, in which [`slow`] looks for what takes seconds, [`drift`] follows the zero, [`creep`] what
//! lingers of a load, [`jump`] finds what no body does, [`repeats`] what no converter does that works. What must be known before a control could be pressed is decided here,
//! in the same frame.

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
use crate::sense::{ForceFrame, Quality, corners};
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

/// Force beside zero from which on a tile is examined in every frame: the least that counts as load.
pub(super) const LOUD_N: f32 = 6.0;

/// A sensor's load that grows by more in a millisecond is not a foot's: the hardest heel strike takes five to
/// put its weight on (our choice).
const SUDDEN_N: f32 = 30.0;

/// A sensor that loses more in a millisecond is not lifted off: what rests on a corner of an empty plate (our choice).
const FELL_N: f32 = 8.0;

/// Where in the converter's range a reading lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum End {
    /// Where readings should be.
    #[default]
    Within,
    /// Below what the sensor reads on the empty floor, and next to zero volts.
    Low,
    /// Next to zero volts, where it is on the empty floor as well.
    Bare,
    /// At 98 % or above: the force is this or more.
    High,
}

impl End {
    /// Whether nothing presses the sensor, or nothing that it can tell.
    const fn reads_nothing(self) -> bool {
        matches!(self, Self::Low | Self::Bare)
    }

    /// Whether the reading alone is a reason to look at the tile.
    const fn is_odd(self) -> bool {
        matches!(self, Self::Low | Self::High)
    }
}

/// The sensors' health on one floor.
///
/// Costs nothing per frame for tiles at rest but an eighth of a visit; allocates nothing.
#[derive(Clone, Debug)]
pub(super) struct Health {
    geometry: Geometry,
    /// What each sensor reads without load beyond its tare, as followed so far.
    zeros: Vec<[f32; 4]>,
    /// What each reads too much besides, for it creeps, and why.
    crept: Vec<[f32; 4]>,
    /// Both together.
    offsets: Vec<[f32; 4]>,
    memories: Vec<Memory>,
    creep: Creep,
    /// How far the floor's plates give way to twist.
    twist: Twist,
    /// The first tile of each share of the floor, and the end of the last one.
    shares: [usize; SHARES + 1],
    /// When each share of the floor was last visited.
    visited: [Option<Instant>; SHARES],
    /// How far each may be followed: 20 % of the sensor's range.
    limits: Vec<[f32; 4]>,
    ends: Vec<[End; 4]>,
    /// What each has read as its board sent it, 0 for nothing; of newtons a digest of their bits.
    raws: Vec<[u16; 4]>,
    /// Sensors that go by the nominal law: what a plate allows cannot be held against forces that may be off by a
    /// third.
    guessed: Vec<[bool; 4]>,
    sensors: Vec<[Sensor; 4]>,
    averages: Averages,
    slow: Vec<Slow>,
    /// Which tiles' sensors were all connected when they were last visited.
    connected: Vec<bool>,
    /// Which tiles carry something, by their last whole blocks.
    loaded: Vec<bool>,
    /// Tiles with a reading to be examined in this frame.
    loud: Vec<u32>,
    /// Tiles with a sensor in trouble, or that may start nothing.
    watched: Vec<u32>,
    /// For building the next `watched`.
    spare: Vec<u32>,
    /// Number of the frame in which each tile was last checked, and what its sensors read then.
    checked: Vec<u32>,
    read: Vec<[f32; 4]>,
    number: u32,
    changes: u64,
    found: u64,
    /// Tiles judged by their first block, and how many of them read what no empty tile of this floor should.
    judged: usize,
    strange: usize,
    seen: Vec<bool>,
    /// How many tiles of those carried something, which says nothing of their zeros.
    laden: usize,
    /// Whether boards make the newtons themselves: then the file says nothing of them.
    by_boards: bool,
    is_foreign: bool,
    jumps: Jumps,
    repeats: Repeats,
}

/// How much a sensor may read at first, in newtons, on a floor that is the file's: far more than zeros drift in a day.
const STRANGE_N: f32 = 2.0;

/// From which force on a tile is taken to carry a foot: more than another floor's zeros add up to.
const LADEN_N: f32 = 25.0;

/// The share of empty tiles that must read strangely for the floor to be another one, and how many there must be.
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

    /// What to take off a reading of this sensor besides its tare.
    pub(super) fn zero(&self, tile: usize, corner: usize) -> f32 {
        self.offsets[tile][corner]
    }

    /// Marks in `frame`, whose forces have all been taken and which was `sampled` then, what cannot be trusted.
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
                // It was not worth looking at: nothing to speak of lay on it.
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

    /// Finds the plates whose readings repeat, and learns what the noise of every [`SHARES`]th part of the floor leaves
    /// to chance.
    fn look_for_repeats(&mut self, frame: &mut ForceFrame, sampled: Instant) {
        let share = self.number as usize % SHARES;
        let tiles = self.shares[share]..self.shares[share + 1];
        let Self { repeats, raws, ends, sensors, jumps, .. } = self;
        let heard = Heard { raws, ends, news: jumps.read(), sensors };
        repeats.compare(frame, heard, sampled);
        repeats.visit(tiles, frame, heard, self.number / SHARES as u32);
    }

    /// Looks at one tile; true if it must be examined again in the next frame.
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
                        // On a limp plate a foot that comes down over a sensor is not answered either; but it pushes,
                        // and not from one millisecond to the next.
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

    /// Whether somebody may be standing with part of a foot on this tile, by what its neighbours carry.
    fn has_loaded_neighbour(&self, tile: usize) -> bool {
        let first = self.geometry.tile_at_index(tile);
        let around = TileBlock { first, columns: 1, rows: 1 }.grown(1);
        let others = around.tiles().filter_map(|other| self.geometry.index(other));
        others.filter(|&other| other != tile).any(|other| self.loaded[other])
    }

    /// How often a sensor has fallen ill or got well.
    pub(super) const fn changes(&self) -> u64 {
        self.changes
    }

    /// How often a sensor has fallen ill.
    pub(super) const fn found(&self) -> u64 {
        self.found
    }

    /// How often the load of a tile has jumped, and the last such tile and by how many newtons.
    pub(super) fn jumps(&self) -> (u64, Option<(TileId, f32)>) {
        let (count, last) = self.jumps.found();
        (count, last.map(|(tile, newtons)| (self.geometry.tile_at_index(tile), newtons)))
    }

    /// Whether a repetition of this sensor's readings shows that it stands still.
    pub(super) fn tells(&self, tile: usize, corner: usize) -> bool {
        self.repeats.tells(tile, corner)
    }

    /// How often the readings of a plate have repeated, and the plates whose do now.
    pub(super) fn repeating(&self) -> (u64, impl Iterator<Item = TileId> + '_) {
        (self.repeats.count(), self.repeats.repeating().map(|tile| self.geometry.tile_at_index(tile)))
    }

    /// Whether most tiles read what no empty tile of the file's floor should, at the start.
    pub(super) const fn is_foreign(&self) -> bool {
        self.is_foreign
    }

    fn judge_floor(&mut self) {
        let empty = self.judged - self.laden;
        let all_seen = self.judged == self.seen.len() && !self.by_boards;
        self.is_foreign =
            all_seen && empty >= FEWEST_TILES && self.strange as f32 > MOST_TILES * empty as f32;
    }

    /// The sensors in trouble.
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

    /// How much the sensors creep, as a share of their load for each decade.
    pub(super) const fn creep(&self) -> f32 {
        self.creep.share()
    }

    /// How far each sensor's zero has been followed, per tile and corner.
    pub(super) fn drift(&self) -> impl ExactSizeIterator<Item = [Newtons; 4]> + '_ {
        self.zeros.iter().map(|zeros| zeros.map(Newtons))
    }
}

/// Whether all four sensors deliver, those known to be broken apart.
/// The first tile of each share of the floor, and the end of the last one.
///
/// A tile is in the same share however the whole floor is cut, so that each computer that senses it averages it over
/// the same frames.
fn shares(geometry: &Geometry) -> [usize; SHARES + 1] {
    let (columns, rows) = geometry.whole();
    let (columns, whole) = (usize::from(columns), usize::from(columns) * usize::from(rows));
    let place = |tile: TileId| usize::from(tile.row) * columns + usize::from(tile.column);
    let places: Vec<usize> = geometry.tiles().map(place).collect();
    std::array::from_fn(|share| places.partition_point(|&place| place < whole * share / SHARES))
}

fn is_connected(quality: &[Quality; 4], sensors: &[Sensor; 4]) -> bool {
    quality.iter().zip(sensors).all(|(quality, sensor)| *quality < Quality::Stale || sensor.is_out())
}
