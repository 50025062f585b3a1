//! `underfoot wiring`: a walk from board to board that finds which board reads which tiles.

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use underfoot::floor::{Calibration, Floor, TileId};
use underfoot::source::{SensorSource, UdpSource};
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorPacket};

use super::doors::BoardArgs;
use super::failure::Failure;
use super::floor_args::{FloorArgs, FloorOut};
use super::number::patience;
use super::stop::stop_flag;

/// What `underfoot wiring` is asked to do.
///
/// For each board the floor file names a tile that it should read. Step on that tile when it is shown, and off again:
/// the board that feels it is the one that is there. Where boards have changed places, the floor file kept with --out
/// has their addresses exchanged.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    #[command(flatten)]
    floor: FloorArgs,
    /// Where the boards' packets arrive.
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1:9000")]
    listen: SocketAddr,
    #[command(flatten)]
    boards: BoardArgs,
    /// How long to wait for a step on each tile.
    #[arg(long, value_name = "S", default_value = "60", value_parser = patience)]
    wait: Duration,
    /// Where to keep the floor with the wiring that was found.
    #[arg(long, value_name = "FLOOR.ron")]
    out: Option<PathBuf>,
}

/// Load of a tile from which on somebody stands on it, and below which it is empty again, in newtons by nominal parts:
/// a third of a person of 45 kg, and more than a plate rings (our choice).
const STEP_N: f32 = 150.0;
const EMPTY_N: f32 = 40.0;

/// For how many packets a board's tile must be loaded, and how many make the mean of the empty floor.
const FIRM: u32 = 200;
const REST: u32 = 300;

/// Walks from board to board.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let out = args.out.as_deref().map(FloorOut::new);
    let floor = args.floor.load()?;
    let source = args.boards.bind(args.listen, &floor)?;
    let mut walk = Walk { stop: stop_flag()?, wait: args.wait, source, feet: Feet::new(&floor) };
    errln!("Listening on {}; keep off the floor for a moment.", args.listen);
    walk.until("packets of every board", Feet::is_rested)?;
    let mut places = Vec::new();
    for (number, board) in floor.boards.iter().enumerate() {
        let Some(tile) = board.channels.iter().flatten().map(|sensor| sensor.tile).next() else {
            places.push(number);
            continue;
        };
        outln!("Step on tile {tile}, and off again.");
        walk.until(&format!("a step on tile {tile}"), |feet| feet.stepped().is_some())?;
        let (found, felt) = walk.feet.stepped().unwrap_or((number, tile));
        let address = &floor.boards[found].address;
        if felt == tile || found != number {
            outln!("  {address} feels it.");
        } else {
            outln!(
                "  {address} feels it where the floor file has its tile {felt}: its channels are in another order."
            );
        }
        places.push(found);
        walk.until("the floor to be empty again", Feet::is_empty)?;
    }
    conclude(out.as_ref(), floor, &places)
}

/// Says what was found, and keeps it if that is wanted.
fn conclude(out: Option<&FloorOut<'_>>, mut floor: Floor, places: &[usize]) -> Result<(), Failure> {
    let mut seen = places.to_vec();
    seen.sort_unstable();
    seen.dedup();
    if seen.len() < places.len() {
        return Err(Failure::Other(
            "one board felt the steps on tiles of several: was each step on the tile that was shown? Walk again".into(),
        ));
    }
    let moved: Vec<_> = (0..).zip(places).filter(|(place, found)| place != *found).collect();
    outln!("{} boards where the floor file has them, {} elsewhere.", places.len() - moved.len(), moved.len());
    let addresses: Vec<_> = floor.boards.iter().map(|board| board.address.clone()).collect();
    for (place, found) in &moved {
        outln!("  {} is where {} should be.", addresses[**found], addresses[*place]);
        floor.boards[*place].address.clone_from(&addresses[**found]);
    }
    match out {
        Some(out) => out.save(&floor).map(|_| ()),
        None if moved.is_empty() => Ok(()),
        None => {
            errln!(
                "Nothing is kept: exchange their cables, or say where to keep the new floor file with --out."
            );
            Ok(())
        }
    }
}

/// Somebody on the way from board to board.
struct Walk {
    stop: Arc<AtomicBool>,
    wait: Duration,
    source: UdpSource,
    feet: Feet,
}

impl Walk {
    /// Takes packets until `done`; an error if that takes too long or somebody ends it.
    fn until(&mut self, what: &str, done: impl Fn(&Feet) -> bool) -> Result<(), Failure> {
        let until: Instant = self.source.now() + self.wait;
        while !done(&self.feet) {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Failure::Other("the walk was ended".into()));
            }
            if self.source.now() >= until {
                let missing = self.feet.unheard();
                let unheard = if missing.is_empty() {
                    String::new()
                } else {
                    format!("; nothing has come from {}", missing.join(", "))
                };
                let seconds = self.wait.as_secs_f64();
                return Err(Failure::Other(format!("waited {seconds} s for {what}{unheard}")));
            }
            if let Some(packet) = self.source.next(Duration::from_millis(20))? {
                self.feet.take(&packet);
            }
        }
        Ok(())
    }
}

/// What each board feels on each of its tiles.
struct Feet {
    boards: Vec<Reader>,
}

struct Reader {
    address: String,
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

impl Feet {
    fn new(floor: &Floor) -> Self {
        let reader = |board: &underfoot::floor::Board| {
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
            Reader {
                address: board.address.clone(),
                rest: vec![0.0; channels.len()],
                rested: 0,
                loads: vec![0.0; tiles.len()],
                firm: (0, 0),
                tiles,
                channels,
            }
        };
        Self { boards: floor.boards.iter().map(reader).collect() }
    }

    fn take(&mut self, packet: &SensorPacket) {
        if let Some(reader) = self.boards.get_mut(usize::from(packet.board)) {
            reader.take(&packet.readings);
        }
    }

    fn is_rested(&self) -> bool {
        self.boards.iter().all(|reader| reader.rested >= REST || reader.tiles.is_empty())
    }

    fn unheard(&self) -> Vec<&str> {
        let silent = self.boards.iter().filter(|reader| reader.rested == 0 && !reader.tiles.is_empty());
        silent.map(|reader| reader.address.as_str()).collect()
    }

    /// The board that feels somebody stand, and where the floor file says that is; of several the one that feels most.
    fn stepped(&self) -> Option<(usize, TileId)> {
        let firm = self.boards.iter().enumerate().filter(|(_, reader)| reader.firm.1 >= FIRM);
        let (number, reader) = firm.max_by(|(_, a), (_, b)| a.most().1.total_cmp(&b.most().1))?;
        Some((number, *reader.tiles.get(reader.most().0)?))
    }

    fn is_empty(&self) -> bool {
        self.boards.iter().all(|reader| reader.most().1 < EMPTY_N)
    }
}

impl Reader {
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
        for (channel, tile) in self.channels.iter().enumerate() {
            if let (Some(tile), Some(force)) = (*tile, force(channel)) {
                self.loads[tile] += force - self.rest[channel] / REST as f32;
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
