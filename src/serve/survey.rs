//! Boards that send to this machine, before any floor file describes them.

use rosc::{OscPacket, OscType};

use crate::floor::PortName;
use crate::units::Instant;
use crate::wire::{DatagramLimits, check};

/// Maximum number of boards of a survey: as many as a floor file may have.
const MOST: usize = 16_384;

/// Boards found by their datagrams: for each address its channels, its rate and its counts.
#[derive(Clone, Debug, Default)]
pub struct BoardSurvey {
    boards: Vec<FoundBoard>,
    unread: u64,
}

/// Numbers that a board sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SentNumbers {
    /// Counts of a converter.
    Counts,
    /// A blob of big-endian counts of 16 bits.
    Blob,
    /// Newtons.
    Newtons,
    /// Numbers in lines of text.
    Text,
}

/// A board that sends to this machine.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundBoard {
    /// Its OSC address; empty for lines of text.
    pub address: String,
    /// The serial port that it is behind; `None` on the network.
    pub port: Option<PortName>,
    /// Its numbers, by the last packet.
    pub numbers: SentNumbers,
    /// Numbers of its last packet, with the number of the packet if there is one.
    values: Vec<f64>,
    /// Greatest number of each argument.
    greatest: Vec<f64>,
    /// Columns of words before the first number of a line.
    words: usize,
    /// Number of packets, and those of them whose first number is the last one plus 1 or more.
    packets: u64,
    counted: u64,
    /// Arrival of its first and last packet.
    span: (Instant, Instant),
}

impl BoardSurvey {
    /// Adds a datagram, or a frame from a serial port, that arrived at `received`.
    pub fn take(&mut self, datagram: &[u8], port: Option<&PortName>, received: Instant) {
        let packet = check(datagram, &DatagramLimits::SENSORS).ok();
        match packet.and_then(|()| rosc::decoder::decode_udp(datagram).ok()) {
            Some((_, packet)) => self.take_packet(packet, port, received),
            None => self.unread += 1,
        }
    }

    /// Adds a line of text from a serial port: numbers between spaces and commas, also after words.
    pub fn take_line(&mut self, line: &str, port: &PortName, received: Instant) {
        let mut columns = line.split([' ', '\t', ',']).filter(|column| !column.is_empty()).peekable();
        let number = |column: &str| column.parse::<f64>().ok().filter(|number| number.is_finite());
        let mut words = 0;
        while columns.next_if(|column| number(column).is_none()).is_some() {
            words += 1;
        }
        let values: Option<Vec<f64>> = columns.map(number).collect();
        match values.filter(|values| !values.is_empty()) {
            Some(values) => {
                self.add((String::new(), Some(port)), (SentNumbers::Text, values), words, received);
            }
            None => self.unread += 1,
        }
    }

    fn take_packet(&mut self, packet: OscPacket, port: Option<&PortName>, received: Instant) {
        match packet {
            OscPacket::Bundle(bundle) => {
                bundle.content.into_iter().for_each(|packet| self.take_packet(packet, port, received));
            }
            OscPacket::Message(message) => match numbers(&message.args) {
                Some(sent) => self.add((message.addr, port), sent, 0, received),
                None => self.unread += 1,
            },
        }
    }

    fn add(
        &mut self,
        (address, port): (String, Option<&PortName>),
        (numbers, values): (SentNumbers, Vec<f64>),
        words: usize,
        received: Instant,
    ) {
        let has_room = self.boards.len() < MOST;
        let known =
            self.boards.iter_mut().find(|board| board.address == address && board.port.as_ref() == port);
        match known {
            Some(board) => {
                board.words = words;
                board.add(numbers, values, received);
            }
            None if has_room => self.boards.push(FoundBoard {
                address,
                port: port.cloned(),
                numbers,
                greatest: values.clone(),
                values,
                words,
                packets: 1,
                counted: 0,
                span: (received, received),
            }),
            None => self.unread += 1,
        }
    }

    /// Returns the boards by their addresses, as people count: 2 before 10; lines of text come first.
    #[must_use]
    pub fn boards(&self) -> Vec<&FoundBoard> {
        let mut boards: Vec<&FoundBoard> = self.boards.iter().collect();
        boards.sort_by(|one, other| {
            (one.address.len(), &one.address).cmp(&(other.address.len(), &other.address))
        });
        boards
    }

    /// Returns the number of datagrams and messages that no board sends.
    #[must_use]
    pub const fn unread(&self) -> u64 {
        self.unread
    }
}

impl FoundBoard {
    fn add(&mut self, numbers: SentNumbers, values: Vec<f64>, received: Instant) {
        let first = |values: &[f64]| values.first().copied().unwrap_or_default();
        self.counted += u64::from(first(&values) > first(&self.values));
        self.packets += 1;
        self.span.1 = received;
        self.greatest.resize(values.len(), f64::MIN);
        for (greatest, value) in self.greatest.iter_mut().zip(&values) {
            *greatest = greatest.max(*value);
        }
        (self.numbers, self.values) = (numbers, values);
    }

    /// Whether its packets begin with a number that grows: a sequence or a time stamp. A board whose first channel
    /// only grew during the survey looks alike.
    #[must_use]
    pub const fn is_numbered(&self) -> bool {
        self.packets > 8 && self.counted + 2 >= self.packets
    }

    /// Returns the columns of its channels in a line of text, from 1.
    pub fn columns(&self) -> impl Iterator<Item = usize> {
        (1 + self.words + usize::from(self.is_numbered())..).take(self.channels())
    }

    /// Returns the number of its channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.values.len().saturating_sub(usize::from(self.is_numbered()))
    }

    /// Returns its packets a second; `None` before the second packet.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let seconds = self.span.1.since(self.span.0).as_secs_f64();
        (self.packets > 1 && seconds > 0.0).then(|| (self.packets - 1) as f64 / seconds)
    }

    /// Returns the number of its packets so far.
    #[must_use]
    pub const fn packets(&self) -> u64 {
        self.packets
    }

    /// Returns the arrival of its last packet.
    #[must_use]
    pub const fn last(&self) -> Instant {
        self.span.1
    }

    /// Returns the greatest of its readings so far.
    #[must_use]
    pub fn greatest(&self) -> f64 {
        let readings = self.greatest.iter().skip(usize::from(self.is_numbered()));
        readings.copied().fold(f64::MIN, f64::max)
    }

    /// Returns the readings of its last packet, one per channel.
    #[must_use]
    pub fn readings(&self) -> &[f64] {
        self.values.get(usize::from(self.is_numbered())..).unwrap_or_default()
    }

    /// Returns the greatest count of the coarsest usual converter that can send its counts, and its bits: a finer one
    /// looks alike until a heavy load is on each channel. `None` for newtons.
    #[must_use]
    pub fn full_scale(&self) -> Option<(u32, u32)> {
        let bits = [8, 10, 12, 14, 16, 18, 20, 24].into_iter();
        let fits = |bits: &u32| self.greatest() <= f64::from((1_u32 << bits) - 1);
        let counts = self.numbers != SentNumbers::Newtons;
        bits.clone().find(fits).filter(|_| counts).map(|bits| ((1 << bits) - 1, bits))
    }
}

/// The numbers of a message; `None` if it has other arguments, or fewer than three.
fn numbers(arguments: &[OscType]) -> Option<(SentNumbers, Vec<f64>)> {
    if let [number @ .., OscType::Blob(bytes)] = arguments {
        let number = number.iter().map(value).collect::<Option<Vec<f64>>>()?;
        let counts = bytes.as_chunks().0.iter().map(|pair| f64::from(u16::from_be_bytes(*pair)));
        return Some((SentNumbers::Blob, number.into_iter().chain(counts).collect()));
    }
    let values = arguments.iter().map(value).collect::<Option<Vec<f64>>>()?;
    let newtons = matches!(arguments, [_, OscType::Float(_) | OscType::Double(_), ..]);
    let numbers = if newtons { SentNumbers::Newtons } else { SentNumbers::Counts };
    (values.len() >= 3).then_some((numbers, values))
}

fn value(argument: &OscType) -> Option<f64> {
    match *argument {
        OscType::Int(number) => Some(number.into()),
        OscType::Float(number) => Some(number.into()),
        OscType::Double(number) => Some(number),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::{Floor, Geometry};
    use crate::wire::{Readings, SensorEncoder, SensorFormat, SensorPacket};

    fn surveyed(format: SensorFormat, rate_hz: u64, reading: impl Fn(u32) -> u16) -> BoardSurvey {
        let floor = Floor::of(Geometry::of_paper_tiles(3, 2).unwrap());
        let mut encoder = SensorEncoder::new(&floor, format);
        let mut survey = BoardSurvey::default();
        for sequence in 0..100 {
            let received = Instant::from_micros(u64::from(sequence) * 1_000_000 / rate_hz);
            for board in [1, 0] {
                let readings = Readings::Counts((0..12).map(|_| Some(reading(sequence))).collect());
                let packet = SensorPacket { board, sequence, received, readings };
                survey.take(encoder.encode(&packet).unwrap(), None, received);
            }
        }
        survey
    }

    #[test]
    fn boards_are_found_with_their_channels_rate_and_resolution() {
        for (format, numbers) in
            [(SensorFormat::Counts, SentNumbers::Counts), (SensorFormat::Blob, SentNumbers::Blob)]
        {
            let survey = surveyed(format, 200, |sequence| 900 + (sequence % 7) as u16);
            let boards = survey.boards();
            let addresses: Vec<&str> = boards.iter().map(|board| board.address.as_str()).collect();
            assert_eq!(addresses, ["/underfoot/board/0", "/underfoot/board/1"]);
            for board in boards {
                assert_eq!((board.numbers, board.channels(), board.is_numbered()), (numbers, 12, true));
                assert!((board.rate_hz().unwrap() - 200.0).abs() < 0.1, "{:?}", board.rate_hz());
                assert_eq!((board.greatest(), board.full_scale()), (906.0, Some((1023, 10))));
            }
        }
    }

    #[test]
    fn what_no_board_sends_is_counted_and_changes_nothing() {
        let mut survey = surveyed(SensorFormat::Counts, 1000, |_| 40_000);
        let before = survey.boards.clone();
        survey.take(b"GET / HTTP/1.1", None, Instant::START);
        survey.take(b"/underfoot/get\0\0,\0\0\0", None, Instant::START);
        assert_eq!((survey.unread(), &survey.boards), (2, &before));
        assert_eq!(survey.boards()[0].full_scale(), Some((65_535, 16)));
    }

    #[test]
    fn lines_of_text_are_found_with_the_columns_of_their_channels() {
        let port: PortName = "/dev/ttyACM0".parse().unwrap();
        for (line, columns) in [("{} 507,498,512,530", 2..=5), ("v 507 498 {0} 530 {1}", 2..=6)] {
            let mut survey = BoardSurvey::default();
            for number in 0..50_u64 {
                let line = line.replace("{}", &(71_000 + 10 * number).to_string());
                let line = line.replace("{0}", &(500 + number % 3).to_string()).replace("{1}", "499");
                survey.take_line(&line, &port, Instant::from_millis(10 * number));
            }
            survey.take_line("ready", &port, Instant::from_millis(501));
            let [board] = survey.boards()[..] else { panic!("{survey:?}") };
            assert_eq!((&board.port, board.numbers), (&Some(port.clone()), SentNumbers::Text));
            assert_eq!(board.columns().collect::<Vec<_>>(), columns.collect::<Vec<_>>());
            assert_eq!((board.full_scale(), survey.unread()), (Some((1023, 10)), 1));
            assert!((board.rate_hz().unwrap() - 100.0).abs() < 1.0);
        }
    }
}
