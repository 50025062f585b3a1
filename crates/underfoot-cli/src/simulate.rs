//! `underfoot simulate`: a simulated floor that sends real packets.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use underfoot::floor::{Floor, read_address};
use underfoot::layout::Layout;
use underfoot::schema;
use underfoot::sink::{Rank, RealTime};
use underfoot::source::SourceError;
use underfoot::wire::{SensorEncoder, SensorFormat};
use underfoot_sim::{self as sim, FloorBuild, Pace, SimFloor, SimulatedSensors, SimulatedSource};

use super::failure::Failure;
use super::fault_args::FaultArgs;
use super::fitted_floor;
use super::floor_args::{FloorArgs, save_floor};
use super::layout_args::LayoutArgs;
use super::number::lifetime;
use super::play::{self, SimArgs};
use super::stop::stop_flag;

/// Default address to which boards send.
const SEND: SocketAddr = SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 9000));

/// Options of `underfoot simulate`.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// Scenario file; without it, the built-in session on the built-in map layout.
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    #[command(flatten)]
    layout: LayoutArgs,
    #[command(flatten)]
    floor: FloorArgs,
    #[command(flatten)]
    sim: SimArgs,
    /// Where all boards send their packets; several addresses, with commas between them, if several computers serve
    /// areas. Without it, each board sends to its area's computer if the floor file has its address, or else to
    /// 127.0.0.1:9000.
    #[arg(long, value_name = "ADDR", value_delimiter = ',', value_parser = read_address)]
    send: Vec<SocketAddr>,
    /// Format of the boards' readings; newtons with `--quality ideal`, counts otherwise.
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Where to write the floor file that fits this floor, as a lab would: calibrated sensor by sensor and tared.
    /// Without it, the file is written into the folder for the state of programs.
    #[arg(long, value_name = "FILE")]
    write_floor: Option<PathBuf>,
    /// Also write load-cell measurements of every sensor, for `underfoot calibrate curves`.
    #[arg(long, value_name = "FILE.csv")]
    write_loads: Option<PathBuf>,
    /// Also write the calibrated sensors' readings under known points, for `underfoot calibrate map`.
    #[arg(long, value_name = "FILE.csv")]
    write_presses: Option<PathBuf>,
    /// Stop after this many seconds, even within the scenario.
    #[arg(long, value_name = "S", value_parser = lifetime)]
    seconds: Option<Duration>,
    #[command(flatten)]
    faults: FaultArgs,
    /// Play the scenario again and again.
    #[arg(long = "loop")]
    again: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Raw 16-bit counts, one OSC integer per channel.
    Counts,
    /// Newtons, one OSC float per channel.
    Newtons,
    /// Raw counts in one OSC blob, big-endian.
    Blob,
}

/// Plays the scenario in real time and sends every board's packets.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let floor = args.floor.load()?;
    let layout = args.layout.load(&floor.geometry)?;
    let build = FloorBuild { sends_newtons: args.format == Some(Format::Newtons), ..args.sim.build() };
    let (sim, fitted) = build.in_use(&floor)?;
    let encoder = SensorEncoder::new(&floor, args.sensor_format(&sim)?);
    args.write_fitted(&floor, &fitted)?;
    if let Some(path) = &args.write_loads {
        write(path, &sim::load_table(&sim, args.sim.seed))?;
    }
    if let Some(path) = &args.write_presses {
        let (sim, calibrated) = args.sim.build().measured(&floor)?;
        write(path, &sim::press_table(&calibrated, &sim, args.sim.seed))?;
    }
    let sent = args.send_all(&floor, &layout, &sim, encoder)?;
    let targets: BTreeSet<SocketAddr> = args.targets(&floor).into_iter().flatten().collect();
    let targets: Vec<String> = targets.iter().map(ToString::to_string).collect();
    errln!("{sent} packets sent to {}.", targets.join(", "));
    Ok(())
}

fn write(path: &Path, table: &str) -> Result<(), Failure> {
    schema::save_text(table, path)?;
    errln!("Written to {}.", path.display());
    Ok(())
}

impl Args {
    /// The format of the readings that the boards of `sim` send.
    fn sensor_format(&self, sim: &SimFloor) -> Result<SensorFormat, Failure> {
        match (self.format, sim.sensing()) {
            (None | Some(Format::Newtons), SimulatedSensors::Exact) => Ok(SensorFormat::Newtons),
            (Some(_), SimulatedSensors::Exact) => {
                Err(Failure::Other("an ideal floor sends newtons; leave out --format".into()))
            }
            (Some(Format::Newtons), _) => Ok(SensorFormat::Newtons),
            (Some(Format::Blob), _) => Ok(SensorFormat::Blob),
            (None | Some(Format::Counts), _) => Ok(SensorFormat::Counts),
        }
    }

    /// Writes the floor file that fits this simulated floor, and prints the commands that serve it.
    fn write_fitted(&self, floor: &Floor, fitted: &Floor) -> Result<(), Failure> {
        let path = match (&self.write_floor, &self.floor.floor) {
            (Some(path), _) => {
                save_floor(fitted, path)?;
                Some(path.clone())
            }
            // A file that an earlier run wrote fits already.
            (None, Some(path)) if fitted == floor => Some(path.clone()),
            (None, _) => fitted_floor::keep(fitted, self.sim.seed),
        };
        if let Some(path) = path {
            let areas: Vec<&str> = floor.areas.iter().map(|area| area.id.as_str()).collect();
            let layout = self.layout.layout.as_deref();
            for command in fitted_floor::commands(&path, layout, self.listen(floor), &areas) {
                errln!("Serve this floor with: {command}");
            }
        }
        Ok(())
    }

    /// Address for the program that serves this floor, if all boards send to one address other than the default.
    fn listen(&self, floor: &Floor) -> Option<SocketAddr> {
        let targets: BTreeSet<SocketAddr> = self.targets(floor).into_iter().flatten().collect();
        targets.first().copied().filter(|first| targets.len() == 1 && *first != SEND)
    }

    /// Target addresses of each board.
    fn targets(&self, floor: &Floor) -> Vec<Vec<SocketAddr>> {
        let home = |board| floor.home(board).and_then(|area| area.listen).unwrap_or(SEND);
        let targets = |board| if self.send.is_empty() { vec![home(board)] } else { self.send.clone() };
        floor.boards.iter().map(targets).collect()
    }

    /// Sends the packets of all boards; returns their number.
    fn send_all(
        &self,
        floor: &Floor,
        layout: &Layout,
        sim: &SimFloor,
        mut encoder: SensorEncoder,
    ) -> Result<u64, Failure> {
        let no_socket =
            |to, error: io::Error| Failure::Other(format!("packets can't be sent to {to}: {error}"));
        let socket_to = |to: SocketAddr| {
            let here: SocketAddr = if to.is_ipv4() { ([0; 4], 0).into() } else { ([0; 16], 0).into() };
            UdpSocket::bind(here).map(|socket| (to, socket)).map_err(|error| no_socket(to, error))
        };
        let targets = self.targets(floor);
        let all: BTreeSet<SocketAddr> = targets.iter().flatten().copied().collect();
        let sockets: BTreeMap<_, _> = all.into_iter().map(socket_to).collect::<Result<_, _>>()?;
        let stop = stop_flag()?;
        let until = self.seconds.map(|seconds| Instant::now() + seconds);
        // Boards send on time.
        let mut realtime = RealTime::claim(Rank::Sensing);
        let mut sent = 0;
        loop {
            let (script, rehearsed) = play::script(self.scenario.as_deref(), layout, &floor.geometry)?;
            let source = SimulatedSource::new(sim.clone(), Box::new(script), Pace::RealTime);
            let mut source = self.faults.wrap(source, rehearsed).source;
            loop {
                if stop.load(Ordering::Relaxed) || until.is_some_and(|until| Instant::now() >= until) {
                    return Ok(sent);
                }
                let packet = match source.next(Duration::from_millis(10)) {
                    Ok(Some(packet)) => packet,
                    Ok(None) => continue,
                    Err(SourceError::Ended) => break,
                    Err(error) => return Err(error.into()),
                };
                realtime.look();
                let datagram = encoder.encode(&packet).map_err(|error| Failure::Other(error.to_string()))?;
                for to in targets.get(usize::from(packet.board)).into_iter().flatten() {
                    let Some(socket) = sockets.get(to) else { continue };
                    match socket.send_to(datagram, *to) {
                        Ok(_) => sent += 1,
                        // No program listens yet, which a real board ignores as well.
                        Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => {}
                        Err(error) => return Err(no_socket(*to, error)),
                    }
                }
            }
            if !self.again {
                return Ok(sent);
            }
        }
    }
}
