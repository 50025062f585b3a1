//! Monitoring of the sensors: readings that no foot causes, broken sensors, and drift of the zero.
//!
//! ```text
//! counts --calibration, tare, drift--> ForceFrame --Health--> ForceFrame with honest qualities
//!              ^                                    |
//!              +------------ zero -----------------+   (only on an empty, quiet tile)
//! ```
//!
//! [`plate`] models a rigid plate, by which [`examine`] finds the faults that must be known before a press of a
//! control, in the same frame. [`visit`] goes round the floor: [`averages`] holds the means of each tile over 64 ms, in
//! which [`slow`] looks for faults that take seconds, [`drift`] tracks the zero, and [`creep`] corrects the remainder
//! of a load ([`zero`] has both). [`jump`] finds changes too fast for a body, [`repeats`] readings impossible for a
//! working converter, and [`foreign`] a file of another floor.

mod averages;
mod creep;
mod drift;
mod examine;
mod foreign;
mod intake;
mod intervals;
mod jump;
mod plate;
mod queue;
mod repeats;
mod report;
mod slow;
mod stuck;
mod trouble;
mod visit;
#[cfg(test)]
mod walks;
mod zero;

use crate::floor::{Corner, Floor, Geometry, SensorId, TileId};
use crate::sense::{ForceFrame, Quality};
use crate::units::{Instant, Newtons};

pub(super) use intake::Lanes;
pub use report::SensorHealth;
pub use trouble::Trouble;

use self::averages::{Averages, SHARES};
use self::examine::TileReadings;
use self::foreign::FirstReadings;
use self::intake::Intake;
use self::intervals::SampleIntervals;
use self::jump::Jumps;
use self::plate::Twist;
use self::queue::TileQueue;
use self::repeats::{Heard, Repeats};
use self::slow::Slow;
use self::trouble::Sensor;
use self::visit::FloorShares;
use self::zero::Zeros;

/// Force beside zero above which a tile is examined in every frame (N): the least that counts as load.
pub(super) const LOUD_N: f32 = 6.0;

/// Position of a reading in the converter's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum RangeEnd {
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

impl RangeEnd {
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
    /// Number of the present frame.
    number: u32,
    intake: Intake,
    intervals: SampleIntervals,
    zeros: Zeros,
    sensors: Vec<[Sensor; 4]>,
    queue: TileQueue,
    /// Whether the four sensors of each tile form a parallelogram; without that, their readings show no faults of each
    /// other.
    coupled: Vec<bool>,
    /// The tiles with three sensors.
    three_legged: Vec<usize>,
    /// Flexibility of the floor's plates under twist.
    twist: Twist,
    shares: FloorShares,
    averages: Averages,
    slow: Vec<Slow>,
    /// Whether each tile's sensors were all connected at the last visit.
    connected: Vec<bool>,
    /// Whether each tile carries a load, by its last complete block.
    loaded: Vec<bool>,
    first: FirstReadings,
    jumps: Jumps,
    repeats: Repeats,
    changes: u64,
    found: u64,
}

impl Health {
    pub(super) fn new(floor: &Floor) -> Self {
        let tiles = floor.geometry.tile_count();
        let mut health = Self {
            geometry: floor.geometry,
            number: 0,
            intake: Intake::new(tiles),
            intervals: SampleIntervals::default(),
            zeros: Zeros::new(floor),
            sensors: vec![[Sensor::default(); 4]; tiles],
            queue: TileQueue::new(tiles),
            three_legged: floor
                .geometry
                .tiles()
                .enumerate()
                .filter(|(_, tile)| floor.geometry.sensors(*tile).len() == 3)
                .map(|(index, _)| index)
                .collect(),
            coupled: floor
                .geometry
                .tiles()
                .map(|tile| floor.geometry.sensor_places(tile).is_parallelogram())
                .collect(),
            twist: Twist::default(),
            shares: FloorShares::new(&floor.geometry),
            averages: Averages::new(tiles),
            slow: vec![Slow::default(); tiles],
            connected: vec![false; tiles],
            loaded: vec![false; tiles],
            first: FirstReadings::new(tiles),
            jumps: Jumps::new(tiles),
            repeats: Repeats::new(tiles, floor.noiseless),
            changes: 0,
            found: 0,
        };
        floor.off.iter().for_each(|sensor| health.switch(*sensor, false));
        health
    }

    /// Switches a sensor off, or on again: an off one never counts.
    pub(super) fn switch(&mut self, sensor: SensorId, on: bool) {
        let Some(tile) = self.geometry.index(sensor.tile) else { return };
        let Some(sensors) = self.sensors.get_mut(tile) else { return };
        if sensors[sensor.corner.index()].switch(on) {
            self.changes += 1;
            self.queue.watch(tile);
        }
    }

    /// Offset to subtract from a reading of this sensor besides its tare.
    pub(super) fn zero(&self, tile: usize, corner: usize) -> f32 {
        self.zeros.offsets()[tile][corner]
    }

    /// Marks unreliable readings in `frame`, which holds all forces `sampled` at that time.
    pub(super) fn inspect(&mut self, frame: &mut ForceFrame, sampled: Instant) {
        self.number = self.number.wrapping_add(1);
        self.examine(frame);
        self.look_for_repeats(frame, sampled);
        self.visit_share(frame, sampled);
        self.jumps.mark(frame, &self.sensors, sampled);
        // A plate that stands on three sensors is lost with one of them: the unused position counts as lost, too.
        for &tile in &self.three_legged {
            let [first, second, third, unused] = &mut frame.quality[tile];
            *unused = (*first).max(*second).max(*third);
        }
    }

    /// Examines the tiles with a load or a fault.
    fn examine(&mut self, frame: &mut ForceFrame) {
        let is_foreign = self.is_foreign();
        let Self { number, intake, intervals, sensors, queue, coupled, twist, changes, found, .. } = self;
        let ForceFrame { forces, quality, may_start, .. } = frame;
        queue.examine(
            *number,
            forces,
            |tile| intervals.frames(tile),
            |tile, before| {
                let readings = TileReadings {
                    forces: forces[tile],
                    before,
                    ends: intake.ends[tile],
                    interval_ms: intervals.ms(tile),
                    is_measured: intake.has_laws(tile) && !is_foreign,
                    is_coupled: coupled[tile],
                };
                let examined = readings.examine(&mut sensors[tile], &mut quality[tile], twist);
                may_start[tile] = examined.may_start;
                *changes += u64::from(examined.found);
                *found += u64::from(examined.found);
                examined.is_open()
            },
        );
    }

    /// Finds the plates with repeated readings, and learns the probability of chance repetitions of every
    /// [`SHARES`]th part of the floor.
    fn look_for_repeats(&mut self, frame: &mut ForceFrame, sampled: Instant) {
        let tiles = self.shares.tiles(self.number as usize % SHARES);
        let Self { repeats, intake, intervals, sensors, jumps, .. } = self;
        let heard = Heard { raws: &intake.raws, ends: &intake.ends, news: jumps.read(), sensors };
        repeats.compare(frame, heard, intervals, sampled);
        let visit = self.number / SHARES as u32;
        if intervals.are_all_one() {
            repeats.visit(tiles, frame, heard, intervals, visit);
        } else {
            intervals.note_news(heard.news);
            intervals.visit(tiles.clone());
            let news = intervals.visited();
            repeats.visit(tiles, frame, Heard { news, ..heard }, intervals, visit);
        }
    }

    /// Sets the time between two samples of these tiles' boards, in milliseconds; it is 1 for all others.
    pub(super) fn set_intervals(&mut self, intervals: impl Iterator<Item = (usize, f32)>) {
        self.intervals.set(self.sensors.len(), intervals);
    }

    /// The floor's geometry.
    pub(super) const fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Whether readings have no noise of their own.
    pub(super) const fn is_noiseless(&self) -> bool {
        self.repeats.is_noiseless()
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
        self.first.are_foreign()
    }

    /// The faulty sensors.
    pub(super) fn troubles(&self) -> impl Iterator<Item = (SensorId, Trouble)> + '_ {
        self.queue.watched().flat_map(move |tile| {
            let id = self.geometry.tile_at_index(tile);
            let sensors = &self.sensors[tile];
            Corner::ALL.into_iter().filter_map(move |corner| {
                let trouble = sensors[corner.index()].trouble()?;
                Some((SensorId { tile: id, corner }, trouble))
            })
        })
    }

    /// Creep of the sensors, as a share of their load for each decade.
    pub(super) const fn creep(&self) -> f32 {
        self.zeros.creep()
    }

    /// Tracked offset of each sensor's zero, per tile and corner.
    pub(super) fn drift(&self) -> impl ExactSizeIterator<Item = [Newtons; 4]> + '_ {
        self.zeros.drifted().iter().map(|drifted| drifted.map(Newtons))
    }
}

/// Whether all four sensors deliver, not counting those known to be broken.
fn is_connected(quality: &[Quality; 4], sensors: &[Sensor; 4]) -> bool {
    quality.iter().zip(sensors).all(|(quality, sensor)| *quality < Quality::Stale || sensor.is_out())
}
