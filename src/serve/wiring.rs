//! A walk from board to board that finds which board reads which tiles.

use super::rest::{REST, Rest, reading};
use crate::floor::{Calibration, Floor, TileId};
use crate::wire::{Readings, SensorPacket};

/// Load of a tile above which a person stands on it, in newtons by nominal parts: a third of a person of 45 kg (our
/// choice).
pub const STEP_N: f32 = 150.0;

/// Load below which a tile is empty again: more than the ringing of a plate.
const EMPTY_N: f32 = 40.0;

/// Number of packets for which a tile must be loaded.
const FIRM: u32 = 200;

/// A walk from board to board: a person steps on a tile of each board, and off again.
///
/// The caller passes every packet. The walk gives the next task, advances by itself, and reports at the end which
/// boards are swapped. It needs no tare: it assumes that the floor is empty at the beginning.
#[derive(Clone, Debug)]
pub struct WiringWalk {
    readers: Vec<Reader>,
    /// Numbers of boards, with the tile to step on for each.
    way: Vec<(usize, TileId)>,
    found: Vec<WiringStep>,
    stage: Stage,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Rest,
    Step,
    Off,
    Done,
}

/// The next task of the person.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WiringTask {
    /// Keep off the floor until all boards have sent packets for a while.
    KeepOff,
    /// Step on this tile.
    Step(TileId),
    /// Step off again.
    StepOff,
    /// No task: [`WiringWalk::outcome`] gives the result.
    Nothing,
}

/// A step on a tile, and the tile that read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WiringStep {
    /// The board that should read the step.
    pub board: usize,
    /// The tile that was stepped on.
    pub tile: TileId,
    /// The board that read the step.
    pub found: usize,
    /// The tile that read the step, by the floor file.
    pub felt: TileId,
}

/// The present load of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeltLoad {
    /// The board that reads the load.
    pub board: usize,
    /// The tile, by the floor file.
    pub tile: TileId,
    /// The load, in newtons by nominal parts.
    pub force_n: f32,
}

/// One board read the steps for several boards, so that the walk has no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("one board felt the steps on tiles of several: was each step on the tile that was shown? Walk again")]
pub struct FeltTwice;

/// The result of the walk.
#[derive(Clone, Debug, PartialEq)]
pub struct Wiring {
    /// The boards in other places than in the floor file: the place, and the board found there.
    pub moved: Vec<(usize, usize)>,
    /// The floor with their addresses exchanged.
    pub floor: Floor,
}

impl WiringWalk {
    /// A walk over all boards of `floor` that read sensors.
    #[must_use]
    pub fn new(floor: &Floor) -> Self {
        let first = |(number, board): (usize, &crate::floor::Board)| {
            let sensor = board.channels.iter().flatten().next()?;
            Some((number, sensor.tile))
        };
        Self {
            readers: floor.boards.iter().map(Reader::new).collect(),
            way: floor.boards.iter().enumerate().filter_map(first).collect(),
            found: Vec::new(),
            stage: Stage::Rest,
        }
    }

    /// Processes a packet; returns the step that it completes, if any.
    pub fn take(&mut self, packet: &SensorPacket) -> Option<WiringStep> {
        self.readers.get_mut(usize::from(packet.board))?.take(&packet.readings);
        match self.stage {
            Stage::Rest if self.readers.iter().all(Reader::is_rested) => self.stage = self.next(),
            Stage::Step => {
                let &(board, tile) = self.way.get(self.found.len())?;
                let (found, felt) = self.stepped()?;
                let step = WiringStep { board, tile, found, felt };
                self.found.push(step);
                self.stage = Stage::Off;
                return Some(step);
            }
            Stage::Off if self.readers.iter().all(|reader| reader.most().1 < EMPTY_N) => {
                self.stage = self.next();
            }
            Stage::Rest | Stage::Off | Stage::Done => {}
        }
        None
    }

    fn next(&self) -> Stage {
        if self.found.len() < self.way.len() { Stage::Step } else { Stage::Done }
    }

    /// Returns the present task.
    #[must_use]
    pub fn task(&self) -> WiringTask {
        match self.stage {
            Stage::Rest => WiringTask::KeepOff,
            Stage::Step => match self.way.get(self.found.len()) {
                Some(&(_, tile)) => WiringTask::Step(tile),
                None => WiringTask::Nothing,
            },
            Stage::Off => WiringTask::StepOff,
            Stage::Done => WiringTask::Nothing,
        }
    }

    /// The steps made so far.
    #[must_use]
    pub fn steps(&self) -> &[WiringStep] {
        &self.found
    }

    /// Returns the number of steps of the whole walk.
    #[must_use]
    pub fn length(&self) -> usize {
        self.way.len()
    }

    /// Returns the numbers of the boards that have sent nothing yet.
    pub fn unheard(&self) -> impl Iterator<Item = usize> + '_ {
        let silent = |(_, reader): &(usize, &Reader)| reader.rested == 0 && !reader.tiles.is_empty();
        self.readers.iter().enumerate().filter(silent).map(|(number, _)| number)
    }

    /// Returns the heaviest load on the floor; `None` while the floor is empty or unknown.
    #[must_use]
    pub fn felt(&self) -> Option<FeltLoad> {
        let loads = self.readers.iter().enumerate().map(|(board, reader)| (board, reader, reader.most()));
        let (board, reader, (tile, force_n)) = loads.max_by(|a, b| a.2.1.total_cmp(&b.2.1))?;
        let tile = *reader.tiles.get(tile)?;
        (force_n >= EMPTY_N).then_some(FeltLoad { board, tile, force_n })
    }

    /// Returns the board that reads a standing person, and the tile by the floor file; of several boards, the one
    /// with the greatest load.
    fn stepped(&self) -> Option<(usize, TileId)> {
        let firm = self.readers.iter().enumerate().filter(|(_, reader)| reader.firm.1 >= FIRM);
        let (number, reader) = firm.max_by(|(_, a), (_, b)| a.most().1.total_cmp(&b.most().1))?;
        Some((number, *reader.tiles.get(reader.most().0)?))
    }

    /// Returns the result of the walk; `None` before its end. `floor` is the floor of [`WiringWalk::new`].
    ///
    /// # Errors
    /// [`FeltTwice`] if one board read the steps for several boards.
    #[must_use]
    pub fn outcome(&self, floor: &Floor) -> Option<Result<Wiring, FeltTwice>> {
        if self.stage != Stage::Done {
            return None;
        }
        let mut seen: Vec<usize> = self.found.iter().map(|step| step.found).collect();
        seen.sort_unstable();
        seen.dedup();
        if seen.len() < self.found.len() {
            return Some(Err(FeltTwice));
        }
        let moved = self.found.iter().filter(|step| step.board != step.found);
        let moved: Vec<_> = moved.map(|step| (step.board, step.found)).collect();
        let mut wired = floor.clone();
        for &(place, found) in &moved {
            if let (Some(place), Some(found)) = (wired.boards.get_mut(place), floor.boards.get(found)) {
                place.address.clone_from(&found.address);
            }
        }
        Some(Ok(Wiring { moved, floor: wired }))
    }
}

/// Loads of one board's tiles.
#[derive(Clone, Debug)]
struct Reader {
    /// Its tiles, and for each channel the index of its tile.
    tiles: Vec<TileId>,
    channels: Vec<Option<usize>>,
    /// Readings of each channel at rest, and number of packets.
    rest: Vec<Rest>,
    rested: u32,
    loads: Vec<f32>,
    /// The loaded tile, and the number of packets for which it has been loaded.
    firm: (usize, u32),
}

impl Reader {
    fn new(board: &crate::floor::Board) -> Self {
        let mut tiles: Vec<TileId> = Vec::new();
        let mut channels = Vec::new();
        for sensor in &board.channels {
            channels.push(sensor.map(|sensor| {
                tiles.iter().position(|tile| *tile == sensor.tile).unwrap_or_else(|| {
                    tiles.push(sensor.tile);
                    tiles.len() - 1
                })
            }));
        }
        let (rest, loads) = (vec![Rest::default(); channels.len()], vec![0.0; tiles.len()]);
        Self { tiles, channels, rest, rested: 0, loads, firm: (0, 0) }
    }

    fn is_rested(&self) -> bool {
        self.rested >= REST || self.tiles.is_empty()
    }

    fn take(&mut self, readings: &Readings) {
        if readings.len() != self.channels.len() {
            return;
        }
        let force = |channel: usize| reading(readings, channel, &Calibration::NOMINAL);
        if self.rested < REST {
            self.rested += 1;
            for (channel, rest) in self.rest.iter_mut().enumerate() {
                rest.add(force(channel));
            }
            return;
        }
        self.loads.fill(0.0);
        for (channel, (tile, rest)) in self.channels.iter().zip(&self.rest).enumerate() {
            let load = tile.and_then(|tile| self.loads.get_mut(tile));
            if let (Some(load), Some(force)) = (load, force(channel)) {
                *load += force - rest.mean();
            }
        }
        let (tile, most) = self.most();
        let times = if most >= STEP_N && tile == self.firm.0 { self.firm.1 + 1 } else { 0 };
        self.firm = (tile, times);
    }

    fn most(&self) -> (usize, f32) {
        let loads = self.loads.iter().copied().enumerate();
        loads.max_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::Geometry;
    use crate::units::Instant;

    #[test]
    fn readings_that_are_missing_on_the_empty_floor_do_not_count_as_zero() {
        let floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        let mut walk = WiringWalk::new(&floor);
        for sequence in 0..=REST {
            // Every second packet has no reading of any sensor.
            let count = sequence.is_multiple_of(2).then_some(40_000);
            let readings = Readings::Counts(std::iter::repeat_n(count, 4).collect());
            walk.take(&SensorPacket { board: 0, sequence, received: Instant::START, readings });
        }
        assert_eq!(walk.task(), WiringTask::Step(TileId::new(0, 0)));
        assert_eq!(walk.felt(), None);
    }
}
