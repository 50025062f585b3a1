//! A walk over all tiles, in any order, that finds sensors without a response.

use super::rest::{REST, Rest, reading};
use crate::floor::{Corner, Floor, SensorId, SensorPlaces, TileId};
use crate::wire::SensorPacket;

/// Minimum reading of a working sensor, and minimum expected force for a failure to count, in newtons: a footstep
/// puts several times that on each nearby corner (our choice).
const READS_N: f32 = 20.0;
const DEMANDS_N: f32 = 60.0;

/// Minimum share of the expected force that a sensor must read: uncalibrated parts differ by a quarter, plates that
/// bend by as much again.
const SHARE: f32 = 0.3;

/// Number of packets with a plausible reading that a working sensor needs, and with a failure that a faulty one
/// needs.
const ENOUGH: u32 = 20;
const FAILED: u32 = 100;

/// Maximum ratio of failures to plausible readings: a dead sensor distorts the expected force of the opposite one.
const MISLED: u32 = 4;

/// Maximum reading, in newtons, of a sensor without any response.
const NOTHING_N: f32 = 10.0;

/// A walk over all tiles: each sensor must respond to a load on its plate.
///
/// The plate is rigid: the force on one of four corners follows from the other three as the sum of its neighbours less
/// the opposite corner. A sensor that reads a fair share of this expected force for a while works; one with a large
/// expected force and no such reading is faulty. The walk needs no tare: it assumes that the floor is empty at the
/// beginning.
#[derive(Clone, Debug)]
pub struct WalkTest {
    tiles: Vec<TileTest>,
    boards: Vec<BoardRest>,
}

/// Result for a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorVerdict {
    /// It has not been loaded yet.
    Untried,
    /// It reads the expected force.
    Answers,
    /// Its board gives no reading for it.
    NoReading,
    /// It does not respond to any load on its tile.
    Still,
    /// It reads far less than the expected force.
    Weak,
}

impl SensorVerdict {
    /// Whether the result is a fault.
    #[must_use]
    pub const fn is_fault(self) -> bool {
        matches!(self, Self::NoReading | Self::Still | Self::Weak)
    }

    /// Returns the result in words, after the sensor's name.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Untried => "has not been loaded yet",
            Self::Answers => "answers",
            Self::NoReading => "gives no reading",
            Self::Still => "does not react",
            Self::Weak => "reads far too little",
        }
    }
}

#[derive(Clone, Debug)]
struct TileTest {
    id: TileId,
    /// Its sensors; none under a missing tile.
    known: &'static [Corner],
    places: SensorPlaces,
    /// Force above the reading at rest per corner; `None` while no board reads the corner.
    forces: [Option<f32>; 4],
    sensors: [SensorTest; 4],
}

#[derive(Clone, Copy, Debug, Default)]
struct SensorTest {
    plausible: u32,
    failed: u32,
    missing: u32,
    most_n: f32,
}

/// One board: the places of its channels and their readings on the empty floor.
#[derive(Clone, Debug)]
struct BoardRest {
    channels: Vec<Option<Channel>>,
    /// Indices of the tiles with a sensor of this board.
    tiles: Vec<usize>,
    rested: u32,
}

#[derive(Clone, Copy, Debug)]
struct Channel {
    tile: usize,
    corner: usize,
    calibration: crate::floor::Calibration,
    /// Readings on the empty floor.
    rest: Rest,
}

impl WalkTest {
    /// A walk over all tiles of `floor`.
    #[must_use]
    pub fn new(floor: &Floor) -> Self {
        let tile = |id| TileTest {
            id,
            known: floor.geometry.sensors(id),
            places: *floor.geometry.sensor_places(id),
            forces: [None; 4],
            sensors: Default::default(),
        };
        let channel = |sensor: &SensorId| {
            let tile = floor.geometry.index(sensor.tile)?;
            let corner = sensor.corner.index();
            let calibration = *floor.calibration.get(tile)?.get(corner)?;
            Some(Channel { tile, corner, calibration, rest: Rest::default() })
        };
        let board = |board: &crate::floor::Board| {
            let channels: Vec<Option<Channel>> =
                board.channels.iter().map(|sensor| sensor.as_ref().and_then(channel)).collect();
            let mut tiles: Vec<usize> = channels.iter().flatten().map(|channel| channel.tile).collect();
            tiles.sort_unstable();
            tiles.dedup();
            BoardRest { channels, tiles, rested: 0 }
        };
        Self {
            tiles: floor.geometry.tiles().map(tile).collect(),
            boards: floor.boards.iter().map(board).collect(),
        }
    }

    /// Processes a packet.
    pub fn take(&mut self, packet: &SensorPacket) {
        let Some(board) = self.boards.get_mut(usize::from(packet.board)) else { return };
        if packet.readings.len() != board.channels.len() {
            return;
        }
        let is_rested = board.rested >= REST;
        board.rested = board.rested.saturating_add(1);
        for (number, channel) in board.channels.iter_mut().enumerate() {
            let Some(channel) = channel else { continue };
            let force = reading(&packet.readings, number, &channel.calibration);
            if !is_rested {
                channel.rest.add(force);
                continue;
            }
            let Some(tile) = self.tiles.get_mut(channel.tile) else { continue };
            let rest = channel.rest.mean();
            if let Some(place) = tile.forces.get_mut(channel.corner) {
                *place = force.map(|force| force - rest);
            }
        }
        for &tile in board.tiles.iter().filter(|_| is_rested) {
            if let Some(tile) = self.tiles.get_mut(tile) {
                tile.judge();
            }
        }
    }

    /// Whether the reading of the empty floor is complete: before that, people must keep off the floor.
    #[must_use]
    pub fn is_rested(&self) -> bool {
        self.boards.iter().all(|board| board.rested >= REST || board.channels.iter().flatten().count() == 0)
    }

    /// Returns the results of the sensors of the tile with this index, in [`Corner::ALL`] order; one that a plate with
    /// three does not have counts as working. `None` if there is no such tile.
    #[must_use]
    pub fn tile(&self, index: usize) -> Option<[SensorVerdict; 4]> {
        let tile = self.tiles.get(index).filter(|tile| !tile.known.is_empty())?;
        let mut verdicts = [SensorVerdict::Answers; 4];
        for (sensor, test) in tile.sensors() {
            verdicts[sensor.index()] = test.verdict();
        }
        Some(verdicts)
    }

    /// Returns the number of tiles.
    #[must_use]
    pub fn length(&self) -> usize {
        self.tiles.iter().filter(|tile| !tile.known.is_empty()).count()
    }

    /// Returns the number of tiles of which all sensors work.
    #[must_use]
    pub fn passed(&self) -> usize {
        let passes = |tile: &&TileTest| {
            !tile.known.is_empty()
                && tile.sensors().all(|(_, sensor)| sensor.verdict() == SensorVerdict::Answers)
        };
        self.tiles.iter().filter(passes).count()
    }

    /// Whether every sensor has a result.
    #[must_use]
    pub fn is_done(&self) -> bool {
        let mut sensors = self.tiles.iter().flat_map(TileTest::sensors);
        self.is_rested() && sensors.all(|(_, sensor)| sensor.verdict() != SensorVerdict::Untried)
    }

    /// Returns the faulty sensors.
    pub fn faults(&self) -> impl Iterator<Item = (SensorId, SensorVerdict)> + '_ {
        self.tiles.iter().flat_map(|tile| {
            tile.sensors().filter_map(|(corner, sensor)| {
                let verdict = sensor.verdict();
                verdict.is_fault().then_some((SensorId { tile: tile.id, corner }, verdict))
            })
        })
    }
}

impl TileTest {
    /// Its sensors and their tests.
    fn sensors(&self) -> impl Iterator<Item = (Corner, SensorTest)> {
        self.known.iter().map(|&corner| (corner, self.sensors[corner.index()]))
    }

    /// Counts plausible readings and failures of each sensor.
    fn judge(&mut self) {
        let known = self.forces.map(|force| force.unwrap_or(0.0));
        let total: f32 = known.iter().sum();
        for corner in self.known.iter().map(|corner| corner.index()) {
            // Of three sensors, the others do not tell.
            let demanded = self.places.balanced(known, corner).unwrap_or(0.0);
            let sensor = &mut self.sensors[corner];
            let Some(reading) = self.forces[corner] else {
                sensor.missing = sensor.missing.saturating_add(u32::from(total >= DEMANDS_N));
                continue;
            };
            sensor.most_n = sensor.most_n.max(reading);
            if reading >= READS_N && reading >= SHARE * demanded {
                sensor.plausible = sensor.plausible.saturating_add(1);
            } else if demanded >= DEMANDS_N && reading < SHARE * demanded {
                sensor.failed = sensor.failed.saturating_add(1);
            }
        }
    }
}

impl SensorTest {
    const fn verdict(self) -> SensorVerdict {
        if self.plausible >= ENOUGH && self.failed / MISLED <= self.plausible {
            SensorVerdict::Answers
        } else if self.missing >= FAILED {
            SensorVerdict::NoReading
        } else if self.failed < FAILED {
            SensorVerdict::Untried
        } else if self.most_n < NOTHING_N {
            SensorVerdict::Still
        } else {
            SensorVerdict::Weak
        }
    }
}
