//! Datagrams in, packets of sensors and requests of apps out.

use std::collections::HashMap;

use rosc::{OscMessage, OscPacket, OscTime, OscType};
use thiserror::Error;

use super::command::{self, NoCommand};
use super::guard::{self, Limits, Malformed};
use super::message::ControlMessage;
use super::sensor_message::RawMessage;
use super::{LinkCounters, Prefix, SensorPacket};
use crate::floor::Floor;
use crate::units::Instant;

/// Why a datagram is refused as a whole.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WireError {
    /// It is not well-formed OSC, or larger than what may come.
    #[error(transparent)]
    Malformed(#[from] Malformed),
    /// No board of this floor and no kind of control message has this address.
    #[error("nothing here has the address {address:?}")]
    UnknownAddress {
        /// The address, as sent.
        address: String,
    },
    /// A bundle of requests is to be met later than within a second.
    #[error("its time tag lies {seconds} s ahead: requests wait for 1 s at most")]
    TooEarly {
        /// How far ahead it lies.
        seconds: u32,
    },
    /// The arguments are not what this address takes.
    #[error("{address:?} takes {expected}, not {found}")]
    WrongShape {
        /// The address, as sent.
        address: String,
        /// What would have been right.
        expected: String,
        /// What came, by type tags.
        found: String,
    },
}

impl WireError {
    /// Adds this refusal to the counter it belongs to.
    pub fn count(&self, counters: &mut LinkCounters) {
        match self {
            Self::Malformed(_) => counters.malformed += 1,
            Self::UnknownAddress { .. } => counters.unknown_address += 1,
            Self::TooEarly { .. } => counters.denied += 1,
            Self::WrongShape { .. } => counters.wrong_shape += 1,
        }
    }
}

/// What one datagram held, in the order it was written; kept and refilled to save allocations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// Samples of boards.
    pub packets: Vec<SensorPacket>,
    /// What apps ask for.
    pub controls: Vec<ControlMessage>,
    /// When that is to be met: the latest time tag of the bundles that hold it; `None` at once.
    pub due: Option<OscTime>,
}

impl Batch {
    /// Forgets what it holds.
    pub fn clear(&mut self) {
        self.packets.clear();
        self.controls.clear();
        self.due = None;
    }
}

/// Turns the datagrams of one floor into sensor packets and control messages.
///
/// Boards' addresses are compared letter by letter, so that no pattern means them; those of
/// requests may be OSC's patterns (`*`, `?`, `[]`, `{}`). Time tags matter for requests only.
#[derive(Clone, Debug)]
pub struct Decoder {
    /// By the bytes of their addresses.
    boards: HashMap<Box<[u8]>, BoardShape>,
    prefix: Prefix,
}

#[derive(Clone, Copy, Debug)]
struct BoardShape {
    number: u16,
    channels: usize,
}

impl Decoder {
    /// A decoder for the boards of `floor`. Of two boards with one address, the first gets the packets.
    #[must_use]
    pub fn new(floor: &Floor) -> Self {
        let mut boards = HashMap::new();
        for (number, board) in (0..=u16::MAX).zip(&floor.boards) {
            let shape = BoardShape { number, channels: board.channels.len() };
            boards.entry(board.address.as_bytes().into()).or_insert(shape);
        }
        Self { boards, prefix: Prefix::default() }
    }

    /// The same decoder for requests whose addresses begin otherwise.
    #[must_use]
    pub fn with_prefix(mut self, prefix: Prefix) -> Self {
        self.prefix = prefix;
        self
    }

    /// What requests' addresses begin with.
    #[must_use]
    pub const fn prefix(&self) -> &Prefix {
        &self.prefix
    }

    /// Reads `datagram`, which arrived at `received`, into `batch`, replacing what was in it.
    ///
    /// A count outside 0 to 65535 becomes `None` in its place; NaN and
    /// infinities among newtons are kept as they came, for [`crate::sense::Assembler`] to judge.
    ///
    /// # Errors
    /// [`WireError`] if any part of the datagram is not right; `batch` is then
    /// empty, so that a datagram is never half applied.
    pub fn decode(&self, datagram: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        batch.clear();
        let result = self.fill(datagram, received, batch);
        if result.is_err() {
            batch.clear();
        }
        result
    }

    fn fill(&self, datagram: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        // Nearly all that comes are single messages of boards, which are checked while they are read.
        if datagram.len() <= Limits::SENSORS.bytes
            && let Some(packet) = RawMessage::split(datagram).and_then(|raw| self.sensors(&raw, received))
        {
            batch.packets.push(packet);
            return Ok(());
        }
        guard::check(datagram, &Limits::SENSORS)?;
        self.element(datagram, received, batch)
    }

    /// Reads a bundle or a message. Recursion is safe here: the guard has limited the depth.
    fn element(&self, bytes: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        let Some(bundle) = guard::Bundle::of(bytes) else { return self.message(bytes, received, batch) };
        let before = batch.controls.len();
        bundle.elements().try_for_each(|element| self.element(element, received, batch))?;
        if batch.controls.len() > before {
            let time = |tag: &OscTime| (tag.seconds, tag.fractional);
            batch.due = batch.due.into_iter().chain([bundle.time_tag]).max_by_key(time);
        }
        Ok(())
    }

    fn message(&self, bytes: &[u8], received: Instant, batch: &mut Batch) -> Result<(), WireError> {
        if let Some(packet) = RawMessage::split(bytes).and_then(|raw| self.sensors(&raw, received)) {
            batch.packets.push(packet);
            return Ok(());
        }
        // The guard passes nothing that rosc refuses (a property test says so); should they ever
        // disagree, the datagram is refused.
        let Ok((b"", OscPacket::Message(message))) = rosc::decoder::decode_udp(bytes) else {
            return Err(Malformed::Neither { at: 0 }.into());
        };
        match self.boards.get(message.addr.as_bytes()) {
            Some(shape) => Err(shape.refuses(message)),
            None => {
                batch.controls.extend(self.controls(&message)?);
                Ok(())
            }
        }
    }

    /// The packet, if this is one of a board of this floor.
    fn sensors(&self, raw: &RawMessage<'_>, received: Instant) -> Option<SensorPacket> {
        let shape = self.boards.get(raw.address)?;
        let (sequence, readings) = raw.read(&Limits::SENSORS)?;
        let packet = SensorPacket { board: shape.number, sequence, received, readings };
        (packet.readings.len() == shape.channels).then_some(packet)
    }

    fn controls(&self, message: &OscMessage) -> Result<Vec<ControlMessage>, WireError> {
        command::read(&self.prefix, &message.addr, &message.args).map_err(|error| match error {
            NoCommand::Unknown => WireError::UnknownAddress { address: message.addr.clone() },
            NoCommand::Expected(expected) => WireError::WrongShape {
                address: message.addr.clone(),
                expected: expected.into(),
                found: type_tags(&message.args),
            },
        })
    }

    /// The address of a request that was refused for this reason, if its sender hears why.
    ///
    /// Only those hear it who meant this floor: an address under its prefix, and none of those that floors send
    /// themselves, for another floor that sends here by mistake could take an answer for an answer.
    #[must_use]
    pub fn is_answered<'e>(&self, error: &'e WireError) -> Option<&'e str> {
        match error {
            WireError::WrongShape { address, .. } if !self.boards.contains_key(address.as_bytes()) => {
                Some(address)
            }
            WireError::UnknownAddress { address } => {
                let path = self.prefix.path(address)?;
                (!command::is_sent_by_floors(path)).then_some(address)
            }
            WireError::TooEarly { .. } => Some("#bundle"),
            _ => None,
        }
    }
}

impl BoardShape {
    fn refuses(self, message: OscMessage) -> WireError {
        WireError::WrongShape {
            expected: format!(
                "an int32 sequence and {} counts (i), newtons (f), or one blob of u16 counts",
                self.channels
            ),
            found: type_tags(&message.args),
            address: message.addr,
        }
    }
}

/// The type tags of `args` as OSC writes them, shortened to what fits in a log line.
fn type_tags(args: &[OscType]) -> String {
    const SHOWN: usize = 40;
    let mut tags: String = args.iter().take(SHOWN).map(tag).collect();
    if args.is_empty() {
        tags.push_str("nothing");
    } else if args.len() > SHOWN {
        tags.push_str(&format!("... ({} arguments)", args.len()));
    }
    tags
}

fn tag(arg: &OscType) -> char {
    match arg {
        OscType::Int(_) => 'i',
        OscType::Float(_) => 'f',
        OscType::String(_) => 's',
        OscType::Blob(_) => 'b',
        OscType::Time(_) => 't',
        OscType::Long(_) => 'h',
        OscType::Double(_) => 'd',
        OscType::Char(_) => 'c',
        OscType::Color(_) => 'r',
        OscType::Midi(_) => 'm',
        OscType::Bool(true) => 'T',
        OscType::Bool(false) => 'F',
        OscType::Array(_) => '[',
        OscType::Nil => 'N',
        OscType::Inf => 'I',
    }
}

#[cfg(test)]
mod tests {
    use rosc::{OscBundle, OscTime, encoder};

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
        let too_few = ints(&[9, 1, 2, 3]);
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
            assert!(matches!(verdict, Err(WireError::WrongShape { .. })), "{args:?}: {verdict:?}");
        }
    }

    // P11
    #[test]
    fn hostile_addresses_match_nothing() {
        for address in
            ["/*", "//", "/", "/underfoot/board/*", "/underfoot/board/[0-9]", "/underfoot/board/00"]
        {
            let verdict = decode(&bytes(address, ints(&[9, 1, 2, 3, 4])));
            assert_eq!(verdict, Err(WireError::UnknownAddress { address: address.into() }));
        }
        // P11: a name of 60 kB is past the size limit, one of 6 kB past that of addresses.
        for length in [60_000, 6000] {
            let name = format!("/{}", "a".repeat(length));
            assert!(matches!(decode(&bytes(&name, vec![])), Err(WireError::Malformed(_))));
        }
    }

    // P4
    #[test]
    fn one_bad_element_spoils_the_whole_datagram() {
        let good = message("/underfoot/board/0", ints(&[9, 1, 2, 3, 4]));
        let bad = message("/underfoot/board/0", ints(&[9, 1, 2, 3]));
        let bundle = |content| {
            // P10: the time tag may be anything.
            let timetag = OscTime { seconds: u32::MAX, fractional: 0 };
            encoder::encode(&OscPacket::Bundle(OscBundle { timetag, content })).unwrap()
        };
        assert_eq!(decode(&bundle(vec![good.clone(), good.clone()])).unwrap().packets.len(), 2);

        let mut batch = Batch::default();
        decoder().decode(&bundle(vec![good.clone()]), NOW, &mut batch).unwrap();
        let verdict = decoder().decode(&bundle(vec![good, bad]), NOW, &mut batch);
        assert!(matches!(verdict, Err(WireError::WrongShape { .. })));
        assert_eq!(batch, Batch::default());
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
