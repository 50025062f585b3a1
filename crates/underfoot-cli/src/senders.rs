//! Options for permitted senders: boards for packets, apps for requests.

use std::io::ErrorKind;
use std::net::SocketAddr;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use tracing::warn;
use underfoot::floor::{Floor, Network, PortName, read_address};
use underfoot::source::{FloorInput, SourceError, UdpSource};
use underfoot::units::HostClock;
use underfoot_io::serial::{IfAbsent, SerialPorts, absent, wires};

use super::failure::Failure;
use super::floor_args::{FloorArgs, load_floor};

/// Options for permitted boards.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct BoardArgs {
    /// Accept sensor packets from this address or range, such as 192.168.1.20 or 192.168.1.0/24; several may be
    /// given. Without it, from the networks in the floor file, or else from this machine only.
    #[arg(long, value_name = "CIDR")]
    allow: Vec<Network>,
    /// Pin each board to the address of its first packet.
    #[arg(long)]
    pin: bool,
    /// Also read boards from this serial port: /dev/ttyACM0, COM3, or usb: and the serial number of its USB device;
    /// several may be given. Ports of the floor file without a name get these in order; each further one carries OSC
    /// in SLIP frames.
    #[arg(long, value_name = "PORT")]
    serial: Vec<PortName>,
    /// Start without the serial ports that are not plugged in yet.
    #[arg(long)]
    await_ports: bool,
}

/// Options for permitted apps.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct CommandArgs {
    /// Accept apps' requests on this port of their own; without it, on the sensors' port from this machine only.
    #[arg(long, value_name = "ADDR", value_parser = read_address)]
    commands: Option<SocketAddr>,
    /// Accept requests from this address or range; several may be given. Without it, from this machine only.
    #[arg(long, value_name = "CIDR", requires = "commands")]
    allow_commands: Vec<Network>,
}

/// Options of a command that reads the boards by itself.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct ListenArgs {
    /// Where the boards' packets arrive.
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1:9000", value_parser = read_address)]
    pub(crate) listen: SocketAddr,
    #[command(flatten)]
    pub(crate) boards: BoardArgs,
}

impl ListenArgs {
    /// Listens for the boards of `floor`, by the network and at its serial ports.
    pub(crate) fn open(&self, floor: &Floor) -> Result<FloorInput, Failure> {
        let source = self.boards.bind(self.listen, floor)?;
        let clock = source.clock();
        self.boards.beside(source, floor, clock)
    }
}

impl BoardArgs {
    /// The senders and ports of the floor file, also without ports that are not plugged in.
    #[cfg(feature = "preview")]
    pub(crate) fn awaiting_ports() -> Self {
        Self { await_ports: true, ..Self::default() }
    }

    /// Whether serial ports are given.
    #[cfg(feature = "preview")]
    pub(crate) const fn have_ports(&self) -> bool {
        !self.serial.is_empty()
    }

    /// Loads the chosen floor; an error if one of its serial ports is not there.
    pub(crate) fn load(&self, floor: &FloorArgs) -> Result<Floor, Failure> {
        match &floor.floor {
            Some(path) => self.load_file(path),
            None => floor.load(),
        }
    }

    /// Loads the floor file at `path`; an error if one of its serial ports is not there.
    pub(crate) fn load_file(&self, path: &Path) -> Result<Floor, Failure> {
        let absent = |port: &PortName| if self.await_ports { None } else { absent(port) };
        load_floor(path, &absent)
    }

    /// Opens the serial ports of `floor` and of the options beside `input`, whose packets `clock` stamps.
    pub(crate) fn beside(
        &self,
        input: impl Into<FloorInput>,
        floor: &Floor,
        clock: HostClock,
    ) -> Result<FloorInput, Failure> {
        let (input, wires) = (input.into(), wires(floor, &self.serial)?);
        if wires.is_empty() {
            return Ok(input);
        }
        let if_absent = if self.await_ports { IfAbsent::Wait } else { IfAbsent::Refuse };
        Ok(SerialPorts::open(&wires, floor, clock, if_absent)?.beside(input))
    }

    /// Listens for the boards of `floor`.
    pub(crate) fn bind(&self, listen: SocketAddr, floor: &Floor) -> Result<UdpSource, Failure> {
        let mut source = UdpSource::bind(listen, floor).map_err(|error| chosen_by("--listen", error))?;
        if !self.allow.is_empty() {
            source = source.allowing(self.allow.iter().copied());
        } else if floor.allow.is_empty() && !listen.ip().is_loopback() {
            errln!(
                "Packets of this machine only are taken on {listen}: name the boards with --allow or in the floor file."
            );
        }
        Ok(if self.pin { source.pinned() } else { source })
    }

    /// As [`BoardArgs::bind`], but waits for an address that this machine does not have yet; an error if it is
    /// stopped meanwhile.
    pub(crate) fn bind_once_there(
        &self,
        listen: SocketAddr,
        floor: &Floor,
        stop: &AtomicBool,
    ) -> Result<UdpSource, Failure> {
        let mut is_told = false;
        loop {
            match self.bind(listen, floor) {
                Err(Failure::Source(SourceError::Socket { source, .. }))
                    if source.kind() == ErrorKind::AddrNotAvailable && !stop.load(Ordering::Relaxed) =>
                {
                    if !std::mem::replace(&mut is_told, true) {
                        warn!("this machine has no address {} yet: waiting for it", listen.ip());
                    }
                    thread::sleep(AGAIN);
                }
                done => return done,
            }
        }
    }
}

/// The `error` of a socket, with the option that chooses its address.
fn chosen_by(option: &str, error: SourceError) -> SourceError {
    match error {
        SourceError::Socket { message, source } => {
            SourceError::Socket { message: format!("{message}; `{option}` chooses the address"), source }
        }
        SourceError::Ended => SourceError::Ended,
    }
}

/// Interval between attempts to open an address that this machine does not have yet.
const AGAIN: Duration = Duration::from_millis(250);

impl CommandArgs {
    /// Opens the port for apps, if one is given.
    pub(crate) fn open(&self, source: UdpSource) -> Result<UdpSource, Failure> {
        let Some(address) = self.commands else { return Ok(source) };
        let opened = source.with_commands(address, self.apps().iter().copied());
        Ok(opened.map_err(|error| chosen_by("--commands", error))?)
    }

    /// The port for apps: one of their own, or that of the sensors.
    pub(crate) fn port(&self, sensors: SocketAddr) -> SocketAddr {
        self.commands.unwrap_or(sensors)
    }

    /// Networks from which requests are accepted.
    pub(crate) fn apps(&self) -> &[Network] {
        if self.allow_commands.is_empty() { &Network::LOOPBACK } else { &self.allow_commands }
    }
}
