//! The boards that send to this machine, by the network and through serial ports.

use std::collections::HashMap;
use std::io::{Error, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant as HostInstant};

use underfoot::floor::{PortName, SerialWire};
use underfoot::serve::{BoardSurvey, FoundBoard, SentNumbers};
use underfoot::units::Instant;
use underfoot_io::serial::{PortPart, PortProbe, plugged_ports};

use crate::failure::Failure;

/// Interval between two lines about the boards.
const SHOW: Duration = Duration::from_secs(1);

/// Size of the largest datagram.
const LARGEST: usize = 65_536;

/// The boards that were found, and the rates of their serial ports.
#[derive(Default)]
pub(super) struct HeardBoards {
    pub(super) survey: BoardSurvey,
    bauds: HashMap<PortName, u32>,
}

impl HeardBoards {
    /// Bits a second of a port.
    pub(super) fn baud(&self, port: &PortName) -> u32 {
        self.bauds.get(port).copied().unwrap_or(SerialWire::BAUD)
    }
}

/// Listens for `span` to the network and to all ports that are plugged in or `named`, and shows each second which
/// boards send, with their readings.
pub(super) fn listen(
    address: SocketAddr,
    named: &[PortName],
    span: Duration,
) -> Result<HeardBoards, Failure> {
    let failed = |error: Error| {
        Failure::Other(format!("{address} cannot be listened on: {error}; --listen chooses another address"))
    };
    let socket = UdpSocket::bind(address).map_err(failed)?;
    let mut ports = open(named);
    // The ports wait for bytes themselves.
    let wait = if ports.is_empty() { 50 } else { 1 };
    socket.set_read_timeout(Some(Duration::from_millis(wait))).map_err(failed)?;
    let (begun, mut shown) = (HostInstant::now(), Duration::ZERO);
    let now = || Instant::from_micros(u64::try_from(begun.elapsed().as_micros()).unwrap_or(u64::MAX));
    let (mut survey, mut bytes) = (BoardSurvey::default(), vec![0; LARGEST]);
    while begun.elapsed() < span {
        let round = begun.elapsed();
        while let Some(datagram) = receive(&socket, &mut bytes).map_err(failed)? {
            survey.take(datagram, None, now());
            if begun.elapsed() - round > SHOW / 10 {
                break;
            }
        }
        ports.retain_mut(|port| read(port, &mut survey, now()));
        if begun.elapsed() - shown >= SHOW {
            shown = begun.elapsed();
            survey.boards().into_iter().for_each(|board| outln!("  {}", live(board)));
        }
    }
    for port in ports.iter().filter(|port| port.is_garbled()) {
        outln!(
            "The bytes of {} are neither OSC in SLIP frames nor lines of text: is its rate an unusual one?",
            port.name()
        );
    }
    let bauds = ports.iter().map(|port| (port.name().clone(), port.baud())).collect();
    Ok(HeardBoards { survey, bauds })
}

/// Opens the ports that are plugged in or `named`; names those that cannot be opened.
fn open(named: &[PortName]) -> Vec<PortProbe> {
    let mut names = plugged_ports();
    names.retain(|port| !named.contains(port));
    names.extend_from_slice(named);
    let opened = |port: PortName| {
        let opened = PortProbe::open(port);
        opened.inspect_err(|error| outln!("{error}")).ok()
    };
    names.into_iter().filter_map(opened).collect()
}

/// The next datagram; `None` if there is none in time.
fn receive<'a>(socket: &UdpSocket, bytes: &'a mut [u8]) -> Result<Option<&'a [u8]>, Error> {
    match socket.recv(bytes) {
        Ok(length) => Ok(bytes.get(..length)),
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => Ok(None),
        // On Windows, the answer of a closed port.
        Err(error) if error.kind() == ErrorKind::ConnectionReset => Ok(None),
        Err(error) => Err(error),
    }
}

/// Reads the bytes of a port; false if it is gone.
fn read(port: &mut PortProbe, survey: &mut BoardSurvey, now: Instant) -> bool {
    let name = port.name().clone();
    let read = port.read(|part| match part {
        PortPart::Frame(frame) => survey.take(frame, Some(&name), now),
        PortPart::Line(line) => survey.take_line(line, &name, now),
    });
    read.inspect_err(|error| outln!("{name} is gone: {error}")).is_ok()
}

/// Name of a board: its address, its port, or both.
fn name(board: &FoundBoard) -> String {
    match &board.port {
        None => board.address.clone(),
        Some(port) if board.address.is_empty() => format!("{port} (lines of text)"),
        Some(port) => format!("{} on {port}", board.address),
    }
}

/// A line about a board while it sends.
fn live(board: &FoundBoard) -> String {
    let readings: Vec<String> = board.readings().iter().take(8).map(|value| format!("{value:.0}")).collect();
    let more = if board.channels() > readings.len() { " ..." } else { "" };
    let rate = board.rate_hz().map_or_else(String::new, |hz| format!("{hz:.0}/s, "));
    format!("{}: {rate}{} channels: {}{more}", name(board), board.channels(), readings.join(" "))
}

/// Describes the boards that were found, and what cannot be told.
pub(super) fn describe(survey: &BoardSurvey, address: SocketAddr) {
    let boards = survey.boards();
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
        let kind = match board.numbers {
            SentNumbers::Counts => "counts",
            SentNumbers::Blob => "a blob of counts",
            SentNumbers::Newtons => "newtons",
            SentNumbers::Text => "counts in lines of text",
        };
        outln!("{}: {} channels of {kind}, {rate}, {number}", name(board), board.channels());
        if let Some((full, bits)) = board.full_scale() {
            outln!(
                "  counts up to {:.0}: {bits} bits or more (full scale {full}); only a heavy load on each sensor tells",
                board.greatest()
            );
        }
    }
    if survey.unread() > 0 {
        outln!("{} datagrams, frames and lines are none of a board.", survey.unread());
    }
}
