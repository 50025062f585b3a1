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
mod tests {
    use rosc::{OscMessage, encoder};

    use super::*;
    use crate::floor::Geometry;
    use crate::widget::{Value, WidgetId};
    use crate::wire::Readings;

    const NOW: Instant = Instant::from_millis(7);

    /// One tile, one board of four channels.
    fn decoder() -> Decoder {
        Decoder::new(&Floor::of(Geometry::of_paper_tiles(1, 1).unwrap()))
    }

    fn bytes(address: &str, args: Vec<OscType>) -> Vec<u8> {
        encoder::encode(&message(address, args)).unwrap()
    }

    fn message(address: &str, args: Vec<OscType>) -> OscPacket {
        OscPacket::Message(OscMessage { addr: address.into(), args })
    }

    fn ints(values: &[i32]) -> Vec<OscType> {
        values.iter().map(|&value| OscType::Int(value)).collect()
    }

    fn decode(datagram: &[u8]) -> Result<Batch, WireError> {
        let mut batch = Batch::default();
        decoder().decode(datagram, NOW, &mut batch).map(|()| batch)
    }

    fn readings(args: Vec<OscType>) -> Result<Readings, WireError> {
        decode(&bytes("/underfoot/board/0", args)).map(|mut batch| batch.packets.remove(0).readings)
    }

    #[test]
    fn counts_come_as_ints_or_as_one_blob() {
        let expected = Readings::Counts([Some(0), Some(1), Some(256), Some(65535)].into_iter().collect());
        assert_eq!(readings(ints(&[9, 0, 1, 256, 65535])), Ok(expected.clone()));
        let blob = OscType::Blob(vec![0, 0, 0, 1, 1, 0, 255, 255]);
        assert_eq!(readings(vec![OscType::Int(9), blob]), Ok(expected));
    }

    #[test]
    fn a_message_without_a_number_has_number_0() {
        let expected = Readings::Counts([Some(1), Some(2), Some(3), Some(4)].into_iter().collect());
        let blob = OscType::Blob(vec![0, 1, 0, 2, 0, 3, 0, 4]);
        for args in [ints(&[1, 2, 3, 4]), vec![blob]] {
            let batch = decode(&bytes("/underfoot/board/0", args)).unwrap();
            assert_eq!((batch.packets[0].sequence, &batch.packets[0].readings), (0, &expected));
        }
        let newtons = decode(&bytes("/underfoot/board/0", vec![OscType::Float(7.5); 4])).unwrap();
        assert_eq!(newtons.packets[0].readings, Readings::Newtons([7.5; 4].into_iter().collect()));
    }

    #[test]
    fn counts_of_other_converters_are_scaled() {
        use crate::floor::CountSign::{OffsetBinary, Signed, Unsigned};
        let read = |full_scale, sign, args| {
            let mut floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
            floor.boards[0].range = CountRange { full_scale, sign };
            let mut batch = Batch::default();
            Decoder::new(&floor).decode(&bytes("/underfoot/board/0", args), NOW, &mut batch).unwrap();
            batch.packets.remove(0).readings
        };
        let ten_bits = Readings::Counts([Some(0), Some(65_535), None, Some(32_800)].into_iter().collect());
        assert_eq!(read(1023, Unsigned, ints(&[9, 0, 1023, 1024, 512])), ten_bits);
        let near = |readings: Readings, expected: [f32; 4]| {
            let Readings::Scaled(values) = readings else { panic!("{readings:?}") };
            let is_near = |(value, expected): (&f32, f32)| (value - expected).abs() < 0.02;
            assert!(values.iter().zip(expected).all(is_near), "{values:?}");
        };
        let expected = [0.0, -32_767.5, 32_767.5, -0.0078];
        near(read(8_388_607, Signed, ints(&[9, 0, -4_194_304, 4_194_304, -1])), expected);
        // The same words without their signs, and with the zero in the middle.
        near(read(8_388_607, Signed, ints(&[9, 0, 12_582_912, 4_194_304, 16_777_215])), expected);
        near(
            read(16_777_215, OffsetBinary, ints(&[9, 8_388_608, 4_194_304, 12_582_912, 8_388_607])),
            expected,
        );
        let words =
            [0_i32, 0x40_0000, 0x80_0000, 0xFF_FFFF].iter().flat_map(|word| word.to_be_bytes()[1..].to_vec());
        let blob = vec![OscType::Int(9), OscType::Blob(words.collect())];
        near(read(16_777_215, Unsigned, blob), [0.0, 16_383.75, 32_767.5, 65_535.0]);
    }

    #[test]
    fn a_finer_converter_than_the_floor_file_s_shows_its_counts() {
        let Ok(Readings::Scaled(values)) = readings(ints(&[9, 8_388_700, 8_388_600, 8_388_650, 3])) else {
            panic!("not scaled")
        };
        assert_eq!(values[0], 8_388_700.0);
    }

    #[test]
    fn the_sequence_has_no_sign() {
        let batch = decode(&bytes("/underfoot/board/0", ints(&[-1, 1, 2, 3, 4]))).unwrap();
        assert_eq!(batch.packets[0].sequence, u32::MAX);
        assert_eq!(batch.packets[0].received, NOW);
    }

    #[test]
    fn a_count_out_of_range_spoils_only_its_own_channel() {
        let counts = Readings::Counts([None, None, Some(3), Some(4)].into_iter().collect());
        assert_eq!(readings(ints(&[9, -1, 65536, 3, 4])), Ok(counts));
    }

    #[test]
    fn newtons_keep_what_is_not_a_number_for_the_assembler_to_judge() {
        let floats = [f32::NAN, f32::INFINITY, -0.0, 1e38].map(OscType::Float);
        let args = std::iter::once(OscType::Int(1)).chain(floats).collect();
        let Ok(Readings::Newtons(forces)) = readings(args) else { panic!("not newtons") };
        assert!(forces[0].is_nan() && forces[1] == f32::INFINITY && forces[3] == 1e38);
    }

    #[test]
    fn other_shapes_are_refused() {
        let too_few = ints(&[9, 1, 2]);
        let too_many = ints(&[9, 1, 2, 3, 4, 5]);
        let far_too_many = ints(&[9; 200]);
        let mixed =
            vec![OscType::Int(9), OscType::Int(1), OscType::Float(1.0), OscType::Int(1), OscType::Int(1)];
        let no_sequence = vec![OscType::Float(1.0); 5];
        let odd_blob = vec![OscType::Int(9), OscType::Blob(vec![0; 7])];
        let short_blob = vec![OscType::Int(9), OscType::Blob(vec![0; 6])];
        let huge_blob = vec![OscType::Int(9), OscType::Blob(vec![0; 1024])];
        for args in
            [too_few, too_many, far_too_many, mixed, no_sequence, odd_blob, short_blob, huge_blob, vec![]]
        {
            let verdict = readings(args.clone());
            assert!(matches!(verdict, Err(WireError::WrongReadings { .. })), "{args:?}: {verdict:?}");
        }
    }

    // P11
    #[test]
    fn hostile_addresses_match_nothing() {
        for address in
            ["/*", "//", "/", "/underfoot/board/*", "/underfoot/board/[0-9]", "/underfoot/board/00"]
        {
            let verdict = decode(&bytes(address, ints(&[9, 1, 2, 3, 4])));
            assert_eq!(verdict, Err(WireError::UnknownAddress { address: address.into(), is_reading: true }));
        }
        // P11: a name of 60 kB is past the size limit, one of 6 kB past that of addresses.
        for length in [60_000, 6000] {
            let name = format!("/{}", "a".repeat(length));
            assert!(matches!(decode(&bytes(&name, vec![])), Err(WireError::Malformed(_))));
        }
    }

    fn bundle(elements: &[Vec<u8>]) -> Vec<u8> {
        // P10: the time tag may have any value.
        let mut bytes = b"#bundle\0\xFF\xFF\xFF\xFF\0\0\0\0".to_vec();
        for element in elements {
            bytes.extend(u32::try_from(element.len()).unwrap().to_be_bytes());
            bytes.extend(element);
        }
        bytes
    }

    fn good_readings() -> Vec<u8> {
        bytes("/underfoot/board/0", ints(&[9, 1, 2, 3, 4]))
    }

    /// Writes a message without the checks of an encoder.
    fn raw(address: &str, tags: Option<&str>, arguments: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for text in [Some(address.to_owned()), tags.map(|tags| format!(",{tags}"))].into_iter().flatten() {
            bytes.extend(text.as_bytes());
            bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
        }
        bytes.extend(arguments);
        bytes
    }

    // P4
    #[test]
    fn one_malformed_element_spoils_the_whole_datagram() {
        assert_eq!(decode(&bundle(&[good_readings(), good_readings()])).unwrap().packets.len(), 2);
        let cut_short = raw("/battery", Some("f"), &[]);
        let left_over = raw("/battery", Some("i"), &[0; 8]);
        let no_address = b"battery\0,\0\0\0".to_vec();
        let endless_array = raw("/battery", Some("[i"), &[0; 4]);
        for bad in [cut_short, left_over, no_address, endless_array] {
            let mut batch = Batch::default();
            decoder().decode(&bundle(&[good_readings()]), NOW, &mut batch).unwrap();
            let verdict = decoder().decode(&bundle(&[good_readings(), bad.clone()]), NOW, &mut batch);
            assert!(matches!(verdict, Err(WireError::Malformed(_))), "{bad:?}: {verdict:?}");
            assert_eq!(batch, Batch::default());
        }
    }

    /// Messages of other senders beside a board's readings.
    fn foreign_messages() -> Vec<Vec<u8>> {
        vec![
            bytes("/battery", vec![OscType::Float(3.7)]),
            // Older senders omit the type tags, with arguments and without.
            raw("/ping", None, &[]),
            raw("/level", None, &[0, 0, 0, 1]),
            // Type tags that are undefined in OSC, or defined only in some versions.
            raw("/symbol", Some("S"), b"kick"),
            raw("/odd", Some("iQz"), &[1, 2, 3, 4, 5, 6, 7, 8]),
            // More arguments and a longer address than in any message to a floor.
            bytes("/spectrum", vec![OscType::Float(0.5); 300]),
            bytes(&format!("/{}", "a".repeat(200)), vec![]),
            bundle(&[bytes("/cue/1", vec![]), bundle(&[bytes("/cue/2", vec![])])]),
        ]
    }

    #[test]
    fn a_message_for_another_receiver_costs_its_bundle_nothing() {
        for foreign in foreign_messages() {
            for elements in [
                [foreign.clone(), good_readings(), good_readings()],
                [good_readings(), foreign.clone(), good_readings()],
                [good_readings(), good_readings(), foreign.clone()],
            ] {
                let batch = decode(&bundle(&elements)).unwrap();
                assert_eq!(batch.packets.len(), 2, "{foreign:?}");
                assert!(!batch.refused.is_empty(), "{foreign:?}");
                let is_foreign = |error: &WireError| matches!(error, WireError::UnknownAddress { .. });
                assert!(batch.refused.iter().all(is_foreign), "{:?}", batch.refused);
                let nested = decode(&bundle(&[bundle(&elements)])).unwrap();
                assert_eq!(nested.packets.len(), 2, "{foreign:?}");
            }
        }
    }

    #[test]
    fn a_bundle_of_foreign_messages_alone_is_refused_message_by_message() {
        let batch = decode(&bundle(&foreign_messages())).unwrap();
        assert!(!batch.is_used());
        assert_eq!(batch.refused.len(), foreign_messages().len() + 1);
    }

    #[test]
    fn a_message_of_the_wrong_shape_costs_only_itself() {
        let short = bytes("/underfoot/board/0", ints(&[9, 1, 2]));
        let unclear = bytes("/underfoot/widget/zoom/set", vec![OscType::Nil]);
        let get = bytes("/underfoot/widget/zoom/get", vec![]);
        let batch = decode(&bundle(&[short, good_readings(), unclear, get])).unwrap();
        assert_eq!((batch.packets.len(), batch.controls.len()), (1, 1));
        assert!(
            matches!(
                batch.refused[..],
                [WireError::WrongReadings { board: 0, channels: 4, .. }, WireError::WrongShape { .. }]
            ),
            "{:?}",
            batch.refused
        );
    }

    #[test]
    fn a_message_without_type_tags_has_no_arguments() {
        let id = WidgetId::new("zoom");
        for (path, message) in [
            ("get", ControlMessage::GetAll),
            ("page/get", ControlMessage::GetPage),
            ("mute/get", ControlMessage::GetMute),
            ("cancel", ControlMessage::CancelAll),
            ("widget/zoom/get", ControlMessage::Get { id: id.clone() }),
            ("widget/zoom/enable", ControlMessage::Enable { id: id.clone() }),
        ] {
            let bare = raw(&format!("/underfoot/{path}"), None, &[]);
            assert_eq!(decode(&bare).unwrap().controls, std::slice::from_ref(&message), "{path}");
            assert_eq!(decode(&bundle(&[good_readings(), bare])).unwrap().controls, [message], "{path}");
        }
    }

    #[test]
    fn arguments_without_type_tags_are_refused() {
        for (address, arguments) in [
            ("/underfoot/widget/zoom/set", vec![0x3F, 0, 0, 0]),
            ("/underfoot/widget/zoom/set", vec![]),
            // 0 would mean the opposite of no argument.
            ("/underfoot/widget/zoom/enable", vec![0; 4]),
            ("/underfoot/mute/set", vec![0, 0, 0, 1]),
            ("/underfoot/board/0", vec![0; 20]),
            ("/underfoot/board/0", vec![]),
        ] {
            let verdict = decode(&raw(address, None, &arguments));
            let Err(WireError::WrongShape { found, .. } | WireError::WrongReadings { found, .. }) = &verdict
            else {
                panic!("{address}: {verdict:?}")
            };
            let expected = if arguments.is_empty() { "nothing" } else { "no type tags" };
            assert_eq!(found, expected, "{address}");
        }
    }

    #[test]
    fn unknown_type_tags_at_a_known_address_are_refused() {
        for address in ["/underfoot/board/0", "/underfoot/widget/zoom/set", "/underfoot/get"] {
            let verdict = decode(&raw(address, Some("iQ"), &[0; 8]));
            let Err(WireError::WrongShape { found, .. } | WireError::WrongReadings { found, .. }) = verdict
            else {
                panic!("{address}: {verdict:?}")
            };
            assert_eq!(found, "iQ");
        }
    }

    #[test]
    fn apps_set_enable_and_disable_controls() {
        let control =
            |address: &str, args| decode(&bytes(address, args)).map(|mut batch| batch.controls.remove(0));
        let id = WidgetId::new("zoom");
        let set = |value| Ok(ControlMessage::Set { id: id.clone(), value });
        let address = "/underfoot/widget/zoom/set";
        assert_eq!(control(address, vec![OscType::Float(0.5)]), set(Value::Number(0.5)));
        assert_eq!(control(address, vec![OscType::Int(1)]), set(Value::Number(1.0)));
        assert_eq!(control(address, vec![OscType::Bool(true)]), set(Value::Switch(true)));
        let pair = vec![OscType::Float(0.5), OscType::Int(-1)];
        assert_eq!(control(address, pair), set(Value::Pair(glam::Vec2::new(0.5, -1.0))));
        let enable = control("/underfoot/widget/zoom/enable", vec![]);
        assert_eq!(enable, Ok(ControlMessage::Enable { id: id.clone() }));
        let disable = control("/underfoot/widget/zoom/disable", vec![]);
        assert_eq!(disable, Ok(ControlMessage::Disable { id: id.clone() }));

        for args in [vec![], vec![OscType::Float(f32::NAN)], vec![OscType::Double(1e300)], vec![OscType::Nil]]
        {
            assert!(matches!(control(address, args), Err(WireError::WrongShape { .. })));
        }
        for address in ["/underfoot/widget/zoom", "/underfoot/widget//set", "/underfoot/widget/zoom/explode"]
        {
            assert!(matches!(control(address, vec![]), Err(WireError::UnknownAddress { .. })));
        }
    }

    #[test]
    fn every_refusal_has_its_counter() {
        let mut counters = LinkCounters::default();
        for datagram in [b"/a".to_vec(), bytes("/nobody", vec![]), bytes("/underfoot/board/0", vec![])] {
            decode(&datagram).unwrap_err().count(&mut counters);
        }
        assert_eq!((counters.malformed, counters.unknown_address, counters.wrong_shape), (1, 1, 1));
        assert_eq!(counters.refused(), 3);
    }
}
