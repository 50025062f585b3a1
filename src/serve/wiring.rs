//! The walk from board to board that finds which of them reads which tiles.

use crate::floor::{Calibration, Floor, TileId};
use crate::wire::{Readings, SensorPacket};

/// Load of a tile from which on somebody stands on it, in newtons by nominal parts: a third of a person of 45 kg (our
/// choice).
pub const STEP_N: f32 = 150.0;

/// Load below which a tile is empty again: more than a plate rings.
const EMPTY_N: f32 = 40.0;

/// For how many packets a board's tile must be loaded, and how many make the mean of the empty floor.
const FIRM: u32 = 200;
const REST: u32 = 300;

/// Somebody on the way from board to board: steps on a tile of each, and off again.
///
/// Give it every packet; it says what is to be done next, goes on by itself, and knows at the end which boards have
/// changed places. It needs no tare: it takes for granted that the floor is empty at the beginning.
#[derive(Clone, Debug)]
pub struct WiringWalk {
    readers: Vec<Reader>,
    /// Numbers of boards and the tile of each that is to be stepped on.
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

/// What has to be done next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WiringTask {
    /// Keep off the floor, until all boards have been heard for a while.
    KeepOff,
    /// Step on this tile.
    Step(TileId),
    /// Step off again.
    StepOff,
    /// Nothing: [`WiringWalk::outcome`] says what was found.
    Nothing,
}

/// A tile that was stepped on, and what felt it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WiringStep {
    /// The board that should feel it, and the tile.
    pub board: usize,
    /// Which tile was stepped on.
    pub tile: TileId,
    /// The board that felt it.
    pub found: usize,
    /// Where the floor file has the tile that felt it.
    pub felt: TileId,
}

/// What a tile feels now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeltLoad {
    /// Which board feels it.
    pub board: usize,
    /// Where the floor file has the tile.
    pub tile: TileId,
    /// How much, in newtons by nominal parts.
    pub force_n: f32,
}

/// One board felt the steps on tiles of several, so that nothing can be said of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("one board felt the steps on tiles of several: was each step on the tile that was shown? Walk again")]
pub struct FeltTwice;

/// What the walk has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Wiring {
    /// The boards that are not where the floor file has them: the place, and the board that is there.
    pub moved: Vec<(usize, usize)>,
    /// The floor with their addresses exchanged.
    pub floor: Floor,
}

impl WiringWalk {
    /// A walk over all boards of `floor` that read something.
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

    /// Takes a packet; the step that was made with it, if one was.
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

    /// What has to be done now.
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

    /// How many steps it takes.
    #[must_use]
    pub fn length(&self) -> usize {
        self.way.len()
    }

    /// Boards that have sent nothing yet, by their numbers.
    pub fn unheard(&self) -> impl Iterator<Item = usize> + '_ {
        let silent = |(_, reader): &(usize, &Reader)| reader.rested == 0 && !reader.tiles.is_empty();
        self.readers.iter().enumerate().filter(silent).map(|(number, _)| number)
    }

    /// The heaviest load on the floor now; `None` while it is empty or not known.
    #[must_use]
    pub fn felt(&self) -> Option<FeltLoad> {
        let loads = self.readers.iter().enumerate().map(|(board, reader)| (board, reader, reader.most()));
        let (board, reader, (tile, force_n)) = loads.max_by(|a, b| a.2.1.total_cmp(&b.2.1))?;
        let tile = *reader.tiles.get(tile)?;
        (force_n >= EMPTY_N).then_some(FeltLoad { board, tile, force_n })
    }

    /// The board that feels somebody stand, and where the floor file says that is; of several the one that feels most.
    fn stepped(&self) -> Option<(usize, TileId)> {
        let firm = self.readers.iter().enumerate().filter(|(_, reader)| reader.firm.1 >= FIRM);
        let (number, reader) = firm.max_by(|(_, a), (_, b)| a.most().1.total_cmp(&b.most().1))?;
        Some((number, *reader.tiles.get(reader.most().0)?))
    }

    /// What was found on `floor`, which is the one that the walk began with; `None` before its end.
    ///
    /// # Errors
    /// [`FeltTwice`] if a board felt the steps on tiles of several.
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

/// What one board feels on each of its tiles.
#[derive(Clone, Debug)]
struct Reader {
    /// Its tiles, and for each channel which of them it belongs to.
    tiles: Vec<TileId>,
    channels: Vec<Option<usize>>,
    /// The sum of what each channel read at rest, and of how many packets.
    rest: Vec<f32>,
    rested: u32,
    loads: Vec<f32>,
    /// Its tile that is loaded, and for how many packets.
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
        let (rest, loads) = (vec![0.0; channels.len()], vec![0.0; tiles.len()]);
        Self { tiles, channels, rest, rested: 0, loads, firm: (0, 0) }
    }

    fn is_rested(&self) -> bool {
        self.rested >= REST || self.tiles.is_empty()
    }

    fn take(&mut self, readings: &Readings) {
        if readings.len() != self.channels.len() {
            return;
        }
        let force = |channel: usize| match readings {
            Readings::Counts(counts) => {
                counts.get(channel).copied().flatten().map(|count| Calibration::NOMINAL.force(count).0)
            }
            Readings::Newtons(forces) => forces.get(channel).copied().filter(|force| force.is_finite()),
        };
        if self.rested < REST {
            self.rested += 1;
            for (channel, rest) in self.rest.iter_mut().enumerate() {
                *rest += force(channel).unwrap_or(0.0);
            }
            return;
        }
        self.loads.fill(0.0);
        for (channel, (tile, rest)) in self.channels.iter().zip(&self.rest).enumerate() {
            let load = tile.and_then(|tile| self.loads.get_mut(tile));
            if let (Some(load), Some(force)) = (load, force(channel)) {
                *load += force - rest / REST as f32;
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
