//! The boards that send to this machine, and how to describe them.

use std::collections::{BTreeSet, HashMap};
use std::net::IpAddr;

use underfoot::floor::{Network, PortName, SerialWire};
use underfoot::serve::{BoardSurvey, FoundBoard, SentNumbers};
use underfoot::units::Instant;

/// Maximum number of senders: as many as a floor file may have boards.
const MOST_SENDERS: usize = 16_384;

/// The boards that were found, the addresses from which they send, and the rates of their serial ports.
#[derive(Clone, Debug, Default)]
pub struct HeardBoards {
    survey: BoardSurvey,
    bauds: HashMap<PortName, u32>,
    senders: BTreeSet<IpAddr>,
}

impl HeardBoards {
    /// Adds a datagram from `sender`, which arrived at `received`.
    pub fn take_datagram(&mut self, datagram: &[u8], sender: IpAddr, received: Instant) {
        let unread = self.survey.unread();
        self.survey.take(datagram, None, received);
        if self.survey.unread() == unread && self.senders.len() < MOST_SENDERS {
            self.senders.insert(sender.to_canonical());
        }
    }

    /// Adds a frame of a serial port.
    pub fn take_frame(&mut self, frame: &[u8], port: &PortName, received: Instant) {
        self.survey.take(frame, Some(port), received);
    }

    /// Adds a line of text of a serial port.
    pub fn take_line(&mut self, line: &str, port: &PortName, received: Instant) {
        self.survey.take_line(line, port, received);
    }

    /// Sets the bits a second with which a port is read.
    pub fn set_baud(&mut self, port: &PortName, baud: u32) {
        if let Some(known) = self.bauds.get_mut(port) {
            *known = baud;
        } else {
            self.bauds.insert(port.clone(), baud);
        }
    }

    /// Returns the bits a second of a port.
    #[must_use]
    pub fn baud(&self, port: &PortName) -> u32 {
        self.bauds.get(port).copied().unwrap_or(SerialWire::BAUD)
    }

    /// Returns the boards, those of the network by their addresses.
    #[must_use]
    pub fn boards(&self) -> Vec<&FoundBoard> {
        self.survey.boards()
    }

    /// Returns the number of datagrams, frames and lines that no board sends.
    #[must_use]
    pub const fn unread(&self) -> u64 {
        self.survey.unread()
    }

    /// Returns the networks from which the boards send, as a floor file allows them: none if all send from this
    /// machine.
    #[must_use]
    pub fn networks(&self) -> Vec<Network> {
        if self.senders.iter().all(IpAddr::is_loopback) {
            return Vec::new();
        }
        let here = self.senders.iter().any(IpAddr::is_loopback);
        let elsewhere = self.senders.iter().filter(|sender| !sender.is_loopback());
        let here = Network::LOOPBACK.into_iter().filter(|_| here);
        elsewhere.copied().map(Network::from).chain(here).collect()
    }
}

/// Returns the name of a board: its address, its port, or both.
#[must_use]
pub fn board_name(board: &FoundBoard) -> String {
    match &board.port {
        None => board.address.clone(),
        Some(port) if board.address.is_empty() => format!("{port} (lines of text)"),
        Some(port) => format!("{} on {port}", board.address),
    }
}

/// Returns the kind of a board's numbers.
#[must_use]
pub const fn board_kind(board: &FoundBoard) -> &'static str {
    match board.numbers {
        SentNumbers::Counts => "counts",
        SentNumbers::Blob => "a blob of counts",
        SentNumbers::Newtons => "newtons",
        SentNumbers::Text => "counts in lines of text",
    }
}

/// Returns a line about a board while it sends.
#[must_use]
pub fn live_words(board: &FoundBoard) -> String {
    let readings: Vec<String> = board.readings().iter().take(8).map(|value| format!("{value:.0}")).collect();
    let more = if board.channels() > readings.len() { " ..." } else { "" };
    let rate = board.rate_hz().map_or_else(String::new, |hz| format!("{hz:.0}/s, "));
    format!("{}: {rate}{} channels: {}{more}", board_name(board), board.channels(), readings.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_senders_of_boards_are_allowed_and_this_machine_alone_needs_no_entry() {
        let board = b"/b\0\0,iii\0\0\0\0\0\0\0\x01\0\0\0\x02\0\0\0\x03";
        let (here, there): (IpAddr, IpAddr) = ("127.0.0.1".parse().unwrap(), "192.168.1.20".parse().unwrap());
        let mut heard = HeardBoards::default();
        heard.take_datagram(board, here, Instant::START);
        heard.take_datagram(b"nonsense", "10.0.0.1".parse().unwrap(), Instant::START);
        assert_eq!((heard.boards().len(), heard.unread(), heard.networks()), (1, 1, Vec::new()));
        heard.take_datagram(board, there, Instant::START);
        let networks: Vec<String> = heard.networks().iter().map(ToString::to_string).collect();
        assert_eq!(networks, ["192.168.1.20", "127.0.0.0/8", "::1"]);
    }
}
