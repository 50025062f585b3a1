//! The boards that send to this machine.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant as HostInstant};

use underfoot::serve::{BoardSurvey, FoundBoard, SentNumbers};
use underfoot::units::Instant;
use underfoot_io::serial::port_names;

use crate::failure::Failure;

/// Interval between two lines about the boards.
const SHOW: Duration = Duration::from_secs(1);

/// Size of the largest datagram.
const LARGEST: usize = 65_536;

/// Listens for `span`, and shows each second which boards send, with their rates, channels and readings.
pub(super) fn listen(address: SocketAddr, span: Duration) -> Result<BoardSurvey, Failure> {
    let failed = |error: std::io::Error| {
        Failure::Other(format!("{address} cannot be listened on: {error}; --listen chooses another address"))
    };
    let socket = UdpSocket::bind(address).map_err(failed)?;
    socket.set_read_timeout(Some(Duration::from_millis(50))).map_err(failed)?;
    let (begun, mut shown) = (HostInstant::now(), Duration::ZERO);
    let (mut survey, mut bytes) = (BoardSurvey::default(), vec![0; LARGEST]);
    loop {
        let received = match socket.recv(&mut bytes) {
            Ok(length) => Some(length),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => None,
            // On Windows, the answer of a closed port.
            Err(error) if error.kind() == ErrorKind::ConnectionReset => None,
            Err(error) => return Err(failed(error)),
        };
        let elapsed = begun.elapsed();
        if let Some(datagram) = received.and_then(|length| bytes.get(..length)) {
            let micros = u64::try_from(elapsed.as_micros()).unwrap_or(u64::MAX);
            survey.take(datagram, Instant::from_micros(micros));
        }
        if elapsed - shown >= SHOW {
            shown = elapsed;
            survey.boards().into_iter().for_each(|board| outln!("  {}", live(board)));
        }
        if elapsed >= span {
            return Ok(survey);
        }
    }
}

/// A line about a board while it sends.
fn live(board: &FoundBoard) -> String {
    let readings: Vec<String> = board.readings().iter().take(8).map(|value| format!("{value:.0}")).collect();
    let more = if board.channels() > readings.len() { " ..." } else { "" };
    format!("{}: {}{more}", board.address, readings.join(" "))
}

/// Describes the boards that were found, and what cannot be told.
pub(super) fn describe(survey: &BoardSurvey, address: SocketAddr) {
    let boards = survey.boards();
    if boards.is_empty() {
        outln!(
            "No board sends to {address}. Are they switched on, and do they send to this machine and port?"
        );
        if address.ip().is_loopback() {
            outln!(
                "{address} gets packets of this machine only: --listen 0.0.0.0:{} hears others.",
                address.port()
            );
        }
    }
    for board in boards {
        let rate = board.rate_hz().map_or("one packet".to_owned(), |hz| format!("{hz:.0} packets a second"));
        let number = if board.is_numbered() { "numbered" } else { "without numbers" };
        let kind = match board.numbers {
            SentNumbers::Counts => "counts",
            SentNumbers::Blob => "a blob of counts",
            SentNumbers::Newtons => "newtons",
        };
        outln!("{}: {} channels of {kind}, {rate}, {number}", board.address, board.channels());
        if let Some((full, bits)) = board.full_scale() {
            outln!(
                "  counts up to {:.0}: {bits} bits or more (full scale {full}); only a heavy load on each sensor tells",
                board.greatest()
            );
        }
    }
    if survey.unread() > 0 {
        outln!("{} datagrams and messages are none of a board.", survey.unread());
    }
    let ports = port_names();
    if !ports.is_empty() {
        outln!("Serial ports: {}. `underfoot run --serial PORT` reads boards there.", ports.join(", "));
    }
}
