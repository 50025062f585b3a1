//! Decoding of datagrams into sensor packets and requests of apps.

use std::collections::HashMap;

use rosc::{OscPacket, OscTime, OscType};
use thiserror::Error;

use super::command::{self, NoCommand};
use super::guard::{self, DatagramLimits, Form, Malformed};
use super::message::ControlMessage;
use super::sensor_message::RawMessage;
use super::sent::is_sent_by_floors;
use super::{LinkCause, LinkCounters, Prefix, SensorPacket};
use crate::floor::{CountRange, Floor};
use crate::units::Instant;
use underfoot_format::suggest::nearest;

/// Reason for which a datagram, or one message of a bundle, is rejected.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WireError {
    /// It is not well-formed OSC, or exceeds the limits.
    #[error(transparent)]
    Malformed(#[from] Malformed),
    /// No board of this floor and no kind of control message has this address.
    #[error("nothing here has the address {address:?}")]
    UnknownAddress {
        /// The address, as sent.
        address: String,
        /// Whether its arguments look like readings of a board.
        is_reading: bool,
    },
    /// A bundle of requests is due more than a second ahead.
    #[error("its time tag lies {seconds} s ahead: requests wait for 1 s at most")]
    TooEarly {
        /// How far ahead it is due.
        seconds: u32,
    },
    /// The arguments differ from those of this board in the floor file.
    #[error(
        "{address:?} takes an int32 number and {channels} counts (i), newtons (f), or one blob of counts, not {found}"
    )]
    WrongReadings {
        /// The board's number.
        board: u16,
        /// The number of its channels.
        channels: usize,
        /// The address, as sent.
        address: String,
        /// Its arguments, by type tags.
        found: String,
    },
    /// The arguments differ from those that this request takes.
    #[error("{address:?} takes {expected}, not {found}")]
    WrongShape {
        /// The address, as sent.
        address: String,
        /// The expected arguments.
        expected: String,
        /// The received arguments, by type tags.
        found: String,
    },
}

impl WireError {
    /// Increments the counter for this rejection.
    pub fn count(&self, counters: &mut LinkCounters) {
        match self {
            Self::Malformed(_) => counters.malformed += 1,
            Self::UnknownAddress { .. } => counters.unknown_address += 1,
            Self::TooEarly { .. } => counters.denied += 1,
            Self::WrongReadings { .. } | Self::WrongShape { .. } => counters.wrong_shape += 1,
        }
    }
}

/// The messages of one datagram, in their order; reused to save allocations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// Samples of boards.
    pub packets: Vec<SensorPacket>,
    /// Requests of apps.
    pub controls: Vec<ControlMessage>,
    /// Time at which the requests are due: the latest time tag of the bundles around them; `None` means at once.
    pub due: Option<OscTime>,
    /// Well-formed messages of a bundle that are not used: for another receiver, or of the wrong shape.
    pub refused: Vec<WireError>,
}

impl Batch {
    /// Removes the contents.
    pub fn clear(&mut self) {
        self.packets.clear();
        self.controls.clear();
        self.due = None;
        self.refused.clear();
    }

    /// Whether any message of the datagram is used.
    #[must_use]
    pub fn is_used(&self) -> bool {
        !self.packets.is_empty() || !self.controls.is_empty()
    }
}

/// Decodes the datagrams of one floor into sensor packets and control messages.
///
/// Boards' addresses are compared literally, so that no pattern matches them; those of requests may be OSC patterns
/// (`*`, `?`, `[]`, `{}`). Time tags apply to requests only.
#[derive(Clone, Debug)]
pub struct Decoder {
    /// The boards, by the bytes of their addresses.
    boards: HashMap<Box<[u8]>, BoardShape>,
    prefix: Prefix,
}

#[derive(Clone, Copy, Debug)]
struct BoardShape {
    number: u16,
    channels: usize,
    range: CountRange,
}

impl Decoder {
    /// A decoder for the boards of `floor`. If two boards share an address, the first gets the packets.
    #[must_use]
    pub fn new(floor: &Floor) -> Self {
        let mut boards = HashMap::new();
        for (number, board) in (0..=u16::MAX).zip(&floor.boards) {
            let shape = BoardShape { number, channels: board.channels.len(), range: board.range };
            boards.entry(board.address.as_bytes().into()).or_insert(shape);
        }
        Self { boards, prefix: Prefix::default() }
    }

    /// Sets another prefix for the addresses of requests.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.prefix = prefix;
        self
    }

    /// Returns the prefix of requests' addresses.
    #[must_use]
    pub const fn prefix(&self) -> &Prefix {
        &self.prefix
    }

    /// Reads `datagram`, which arrived at `received`, into `batch` and replaces its contents.
    ///
    /// Counts are scaled by the range of their board ([`crate::floor::Board::range`]). A count outside of it becomes
    /// `None` in its place, or stays beyond the scale of 16 bits where the readings have fractions; NaN and infinite newtons stay for
    /// [`crate::sense::Assembler`] to check. Messages of a bundle that are for another receiver or have the wrong
    /// shape are dropped and listed in [`Batch::refused`].
    ///
    /// # Errors
    /// [`WireError`] if any part of the datagram is malformed, or if its only message is not used; `batch` is then
    /// empty.
    pub fn decode(&self, datagram: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        batch.clear();
        let result = self.fill(datagram, received, batch);
        if result.is_err() {
            batch.clear();
        }
        result
    }

    fn fill(&self, datagram: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        // Nearly all datagrams are single messages of boards, which are checked while they are read.
        if datagram.len() <= DatagramLimits::SENSORS.bytes
            && let Some(packet) = RawMessage::split(datagram).and_then(|raw| self.sensors(&raw, received))
        {
            batch.packets.push(packet);
            return Ok(());
        }
        guard::check_parts(datagram, &DatagramLimits::SENSORS)?;
        match guard::Bundle::of(datagram) {
            Some(bundle) => self.bundle(&bundle, received, batch),
            None => self.message(datagram, received, batch),
        }
    }

    /// Reads a bundle. Recursion is safe here: the guard has limited the depth.
    fn bundle(
        &self,
        bundle: &guard::Bundle<'_>,
        received: Instant,
        batch: &mut Batch,
    ) -> Result<(), WireError> {
        let before = batch.controls.len();
        for element in bundle.elements() {
            let read = match guard::Bundle::of(element) {
                Some(inner) => self.bundle(&inner, received, batch),
                None => self.message(element, received, batch),
            };
            match read {
                Err(error @ WireError::Malformed(_)) => return Err(error),
                Err(error) => batch.refused.push(error),
                Ok(()) => {}
            }
        }
        if batch.controls.len() > before {
            let time = |tag: &OscTime| (tag.seconds, tag.fractional);
            batch.due = batch.due.into_iter().chain([bundle.time_tag]).max_by_key(time);
        }
        Ok(())
    }

    fn message(&self, bytes: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        let Some(raw) = RawMessage::split(bytes) else { return Err(Malformed::Neither { at: 0 }.into()) };
        if let Some(packet) = self.sensors(&raw, received) {
            batch.packets.push(packet);
            return Ok(());
        }
        if let Some(shape) = self.boards.get(raw.address) {
            return Err(shape.refuses(&raw));
        }
        let address = raw.address_text();
        let controls = match guard::form(bytes, &DatagramLimits::SENSORS) {
            // The guard passes nothing that rosc rejects (a property test checks this); if they ever disagree, the
            // datagram is rejected.
            Ok(Form::Whole) => match rosc::decoder::decode_udp(bytes) {
                Ok((b"", OscPacket::Message(message))) => self.controls(address, Some(&message.args)),
                _ => return Err(Malformed::Neither { at: 0 }.into()),
            },
            Ok(Form::Bare { .. }) => self.controls(address, Some(&[])),
            Ok(Form::Untagged { .. } | Form::Unknown { .. }) | Err(_) => self.controls(address, None),
        };
        batch.controls.extend(controls.map_err(|error| match error {
            NoCommand::Unknown => WireError::UnknownAddress {
                address: address.to_owned(),
                is_reading: raw.looks_like_readings(),
            },
            NoCommand::Expected(expected) => {
                let (address, found) = (address.to_owned(), raw.found());
                WireError::WrongShape { address, expected: expected.into(), found }
            }
        })?);
        Ok(())
    }

    /// Returns the packet, if the message belongs to a board of this floor.
    fn sensors(&self, raw: &RawMessage<'_>, received: Instant) -> Option<SensorPacket> {
        let shape = self.boards.get(raw.address)?;
        let (sequence, readings) = raw.read(&DatagramLimits::SENSORS, shape.channels, shape.range)?;
        let packet = SensorPacket { board: shape.number, sequence, received, readings };
        (packet.readings.len() == shape.channels).then_some(packet)
    }

    /// Returns the requests at `address` with these arguments; `None` stands for unreadable arguments.
    fn controls(&self, address: &str, args: Option<&[OscType]>) -> Result<Vec<ControlMessage>, NoCommand> {
        // No request takes nil.
        command::read(&self.prefix, address, args.unwrap_or(&[OscType::Nil]))
    }

    /// Returns the address of the rejected request if its sender gets an answer.
    ///
    /// The answer goes only to senders that meant this floor: the address must have its prefix, and must not be one
    /// that floors themselves send, since another floor that sends here by mistake could mistake an answer for a
    /// request.
    #[must_use]
    pub fn is_answered<'e>(&self, error: &'e WireError) -> Option<&'e str> {
        match error {
            WireError::WrongShape { address, .. } => Some(address),
            WireError::UnknownAddress { address, .. } => {
                let path = self.prefix.path(address)?;
                (!is_sent_by_floors(path)).then_some(address)
            }
            WireError::TooEarly { .. } => Some("#bundle"),
            _ => None,
        }
    }
}

impl Decoder {
    /// Returns the fault of a board that `error` indicates; [`LinkCause::Unknown`] with the error for a request.
    ///
    /// `None` for a malformed datagram: its bytes contain more information than the error.
    pub fn cause_of(&self, error: &WireError) -> Option<LinkCause> {
        Some(match error {
            WireError::Malformed(_) => return None,
            WireError::WrongReadings { board, channels, found, .. } => {
                LinkCause::WrongReadings { board: *board, channels: *channels, found: found.clone() }
            }
            WireError::UnknownAddress { address, is_reading: true } => {
                LinkCause::OtherAddress { found: address.clone(), expected: self.nearest_board(address) }
            }
            WireError::UnknownAddress { .. } | WireError::WrongShape { .. } | WireError::TooEarly { .. } => {
                LinkCause::Unknown { last_refused: error.to_string() }
            }
        })
    }

    /// Returns the board address nearest to `address`; empty on a floor without boards.
    fn nearest_board(&self, address: &str) -> String {
        let addresses = || {
            self.boards.iter().filter_map(|(bytes, shape)| Some((std::str::from_utf8(bytes).ok()?, shape)))
        };
        let nearest = nearest(address, addresses().map(|(address, _)| address));
        let first = || addresses().min_by_key(|(_, shape)| shape.number).map(|(address, _)| address);
        nearest.or_else(first).unwrap_or_default().to_owned()
    }
}

impl BoardShape {
    fn refuses(self, message: &RawMessage<'_>) -> WireError {
        let (address, found) = (message.address_text().to_owned(), message.found());
        WireError::WrongReadings { board: self.number, channels: self.channels, address, found }
    }
}

#[cfg(test)]
mod tests;
