//! Listening to the boards that send to this machine, by the network and through serial ports.

use std::collections::BTreeMap;
use std::io::{Error, ErrorKind};
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::{Duration, Instant as HostInstant};

use underfoot::floor::PortName;
use underfoot::units::Instant;
use underfoot_io::serial::{PortPart, PortProbe, plugged_ports};
use underfoot_window::setup::{HeardBoards, board_kind, board_name, live_words};

use crate::failure::Failure;

/// Interval between two lines about the boards, and between two looks for ports that are plugged in.
const SHOW: Duration = Duration::from_secs(1);

/// Time after which further datagrams wait for the serial ports.
const ROUND: Duration = Duration::from_millis(20);

/// Size of the largest datagram.
const LARGEST: usize = 65_536;

/// Listens to the network and to all ports that are plugged in or named.
pub(super) struct BoardListener {
    address: SocketAddr,
    socket: UdpSocket,
    named: Vec<PortName>,
    ports: Vec<PortProbe>,
    /// Ports that do not open or are gone, by their names, with the reasons.
    refused: BTreeMap<String, String>,
    looked: Option<HostInstant>,
    begun: HostInstant,
    bytes: Vec<u8>,
}

impl BoardListener {
    /// Listens on `address`, to the plugged ports and to those `named`; the clock starts at `begun`.
    pub(super) fn open(address: SocketAddr, named: &[PortName], begun: HostInstant) -> Result<Self, Failure> {
        let socket = UdpSocket::bind(address).map_err(|error| failed(address, &error))?;
        let (ports, refused) = (Vec::new(), BTreeMap::new());
        let (named, bytes) = (named.to_vec(), vec![0; LARGEST]);
        let mut listener = Self { address, socket, named, ports, refused, looked: None, begun, bytes };
        listener.look_for_ports()?;
        Ok(listener)
    }

    /// The present on its clock.
    pub(super) fn now(&self) -> Instant {
        Instant::from_micros(u64::try_from(self.begun.elapsed().as_micros()).unwrap_or(u64::MAX))
    }

    /// Adds what has arrived to `heard`; waits some milliseconds for it.
    pub(super) fn poll(&mut self, heard: &mut HeardBoards) -> Result<(), Failure> {
        self.look_for_ports()?;
        let round = HostInstant::now();
        while let Some((length, sender)) = self.receive()? {
            let now = self.now();
            heard.take_datagram(self.bytes.get(..length).unwrap_or_default(), sender, now);
            if round.elapsed() > ROUND {
                break;
            }
        }
        let now = self.now();
        let refused = &mut self.refused;
        self.ports.retain_mut(|port| match read(port, heard, now) {
            Ok(()) => true,
            Err(error) => {
                let name = port.name().to_string();
                refused.insert(name.clone(), format!("{name} is gone: {error}"));
                false
            }
        });
        Ok(())
    }

    /// Opens ports that are new, and those that did not open before.
    fn look_for_ports(&mut self) -> Result<(), Failure> {
        if self.looked.is_some_and(|looked| looked.elapsed() < SHOW) {
            return Ok(());
        }
        self.looked = Some(HostInstant::now());
        let mut names = plugged_ports();
        names.retain(|port| !self.named.contains(port));
        names.extend_from_slice(&self.named);
        // The trouble of a port that has been pulled out is over.
        self.refused.retain(|refused, _| names.iter().any(|name| name.to_string() == *refused));
        for name in names {
            if self.ports.iter().any(|port| *port.name() == name) {
                continue;
            }
            let shown = name.to_string();
            match PortProbe::open(name) {
                Ok(port) => {
                    self.ports.push(port);
                    self.refused.remove(&shown);
                }
                Err(error) => _ = self.refused.insert(shown, error.to_string()),
            }
        }
        // The ports wait for bytes themselves.
        let wait = if self.ports.is_empty() { 50 } else { 1 };
        let timed = self.socket.set_read_timeout(Some(Duration::from_millis(wait)));
        timed.map_err(|error| failed(self.address, &error))
    }

    /// The length of the next datagram, and its sender; `None` if there is none in time.
    fn receive(&mut self) -> Result<Option<(usize, IpAddr)>, Failure> {
        match self.socket.recv_from(&mut self.bytes) {
            Ok((length, sender)) => Ok(Some((length, sender.ip()))),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => Ok(None),
            // On Windows, the answer of a closed port.
            Err(error) if error.kind() == ErrorKind::ConnectionReset => Ok(None),
            Err(error) => Err(failed(self.address, &error)),
        }
    }

    /// The troubles of the serial ports, in sentences.
    pub(super) fn troubles(&self) -> Vec<String> {
        let garbled = self.ports.iter().filter(|port| port.is_garbled()).map(|port| {
            format!(
                "The bytes of {} are neither OSC in SLIP frames nor lines of text: is its rate an unusual one?",
                port.name()
            )
        });
        self.refused.values().cloned().chain(garbled).collect()
    }
}

fn failed(address: SocketAddr, error: &Error) -> Failure {
    Failure::Other(format!("{address} cannot be listened on: {error}; --listen chooses another address"))
}

/// Reads the bytes of a port; an error if it is gone.
fn read(port: &mut PortProbe, heard: &mut HeardBoards, now: Instant) -> Result<(), Error> {
    let name = port.name().clone();
    port.read(|part| match part {
        PortPart::Frame(frame) => heard.take_frame(frame, &name, now),
        PortPart::Line(line) => heard.take_line(line, &name, now),
    })?;
    heard.set_baud(&name, port.baud());
    Ok(())
}

/// Listens for `span`, and shows each second which boards send, with their readings.
pub(super) fn listen(
    address: SocketAddr,
    named: &[PortName],
    span: Duration,
) -> Result<HeardBoards, Failure> {
    let begun = HostInstant::now();
    let mut listener = BoardListener::open(address, named, begun)?;
    let (mut heard, mut shown) = (HeardBoards::default(), Duration::ZERO);
    while begun.elapsed() < span {
        listener.poll(&mut heard)?;
        if begun.elapsed() - shown >= SHOW {
            shown = begun.elapsed();
            heard.boards().into_iter().for_each(|board| outln!("  {}", live_words(board)));
        }
    }
    listener.troubles().iter().for_each(|trouble| outln!("{trouble}"));
    Ok(heard)
}

/// Describes the boards that were found, and what cannot be told.
pub(super) fn describe(heard: &HeardBoards, address: SocketAddr) {
    let boards = heard.boards();
    if boards.is_empty() {
        outln!(
            "No board sends to {address} or through a serial port. Are they switched on, and do they send to this \
             machine and port?"
        );
        if address.ip().is_loopback() {
            outln!(
                "{address} gets packets of this machine only: --listen 0.0.0.0:{} hears others.",
                address.port()
            );
        }
        outln!(
            "A board that answers requests only cannot be found: its `request` stands in the floor file, under \
             `serial`."
        );
    }
    for board in boards {
        let rate = board.rate_hz().map_or("one packet".to_owned(), |hz| format!("{hz:.0} packets a second"));
        let number = if board.is_numbered() { "numbered" } else { "without numbers" };
        let (name, kind) = (board_name(board), board_kind(board));
        outln!("{name}: {} channels of {kind}, {rate}, {number}", board.channels());
        if let Some((full, bits)) = board.full_scale() {
            outln!(
                "  counts up to {:.0}: {bits} bits or more (full scale {full}); only a heavy load on each sensor tells",
                board.greatest()
            );
        }
    }
    if heard.unread() > 0 {
        outln!("{} datagrams, frames and lines are none of a board.", heard.unread());
    }
}
