//! The serial ports of floor files.

use std::ops::Range;

use super::problem::Problem;
use super::reader::Reader;
use crate::floor::{
    Board, CountRange, Floor, PORT, PortName, RequestEnd, SerialWire, TextLines, TextNumbers,
};
use crate::wire::MAX_CHANNELS;
use underfoot_format::codec::{At, Distinct, Spelled, Written};
use underfoot_format::{Flag, Name, Opt, Rec, list, num, record};

record! {
    /// A serial port with boards behind it: OSC in SLIP frames, or lines of text.
    pub(super) struct SerialRecord = "Serial";
    /// Its name; without it, `--serial` gives one.
    port: Option<Written<PortName>> = "port", Opt(At(PORT)) => None;
    /// Bits a second; USB devices without a serial line of their own ignore it.
    baud: u32 = "baud", num(50.0..=12_000_000.0) => SerialWire::BAUD;
    /// The lines of text that its board sends; without it, it sends OSC in SLIP frames.
    lines: Option<Written<LinesRecord>> = "lines", Opt(At(Rec)) => None;
}

record! {
    /// Lines of text, one sample of a board a line.
    struct LinesRecord = "Lines" => |it, faults| {
        if it.newtons && it.full_scale.is_some() {
            let message = "`full_scale` is of counts, and these numbers are newtons";
            faults.error(&["full_scale", "newtons"], message, "one too many");
        }
        if it.request.is_empty() && it.request_end != RequestEnd::Nothing {
            let message = "`request_end` ends a request, and there is none";
            faults.error(&["request_end"], message, "the end of what?");
        }
    };
    /// Number of the board that sends them, from 0.
    board: Written<u16> = "board", At(num(0.0..=16_383.0)) => 0.into();
    /// Text that asks for the next line; without it, the board sends by itself.
    request: String = "request", REQUEST => String::new();
    /// The line end behind the request.
    request_end: RequestEnd = "request_end", Name => RequestEnd::Nothing;
    /// Characters between columns; a space stands for any number of spaces and tabs.
    separators: String = "separators", SEPARATORS => " ,".to_owned();
    /// The column of each channel of the board, from 1; by default the first columns in order.
    columns: Option<Vec<Written<u8>>> = "columns",
        Opt(list("column", MAX_CHANNELS, At(num(1.0..=MOST_COLUMNS as f64)))) => None;
    /// Number of columns of a line, if more follow the last one of `columns`.
    width: Option<Written<u8>> = "width", Opt(At(num(1.0..=MOST_COLUMNS as f64))) => None;
    /// The count at the converter's full voltage: 1023 with 10 bits; by default that of the board.
    full_scale: Option<f32> = "full_scale", Opt(num(1.0..=16_777_215.0)) => None;
    /// Whether the numbers are newtons instead of counts.
    newtons: bool = "newtons", Flag => false;
}

/// Maximum number of columns of a line.
const MOST_COLUMNS: u8 = 128;

/// Maximum number of serial ports of a floor.
const MOST_PORTS: usize = 64;

pub(super) const SERIAL: Distinct<SerialRecord> = Distinct {
    entry: "port",
    most: MOST_PORTS,
    about: |_, serial, fields, seen| {
        if let Some(port) = &serial.port {
            seen.check(fields, format!("the port {}", port.value), port.at.clone());
        }
    },
};

const REQUEST: Spelled<String> = Spelled {
    about: "1 to 16 visible ASCII characters in quotes",
    parse: |text| {
        let is_fit = (1..=16).contains(&text.len()) && text.bytes().all(|byte| matches!(byte, b' '..=b'~'));
        is_fit.then(|| text.to_owned())
    },
    wrong: |name, text| format!("`{name}` cannot be {text:?}"),
    expected: "expected 1 to 16 visible ASCII characters",
    help: |_| Some("write the line end of a request as request_end: Lf".to_owned()),
    stand_in: String::new(),
};

const SEPARATORS: Spelled<String> = Spelled {
    about: "spaces and punctuation that separate numbers, in quotes",
    parse: |text| {
        let splits = |c: char| c == ' ' || (c.is_ascii_punctuation() && !"+-.".contains(c));
        ((1..=8).contains(&text.len()) && text.chars().all(splits)).then(|| text.to_owned())
    },
    wrong: |_, text| format!("{text:?} cannot separate numbers"),
    expected: "expected spaces and punctuation that numbers do not hold",
    help: |_| Some("write \" ,\" for spaces or commas".to_owned()),
    stand_in: String::new(),
};

impl SerialRecord {
    /// Makes the wire that the record describes, on a floor with these boards.
    pub(super) fn wire(&self, boards: &[Board]) -> SerialWire {
        SerialWire {
            port: self.port.as_ref().map(|port| port.value.clone()),
            baud: self.baud,
            lines: self.lines.as_ref().map(|lines| lines.value.format(boards)),
        }
    }

    pub(super) fn of(wire: &SerialWire, boards: &[Board]) -> Self {
        Self {
            port: wire.port.clone().map(Written::from),
            baud: wire.baud,
            lines: wire.lines.as_ref().map(|lines| LinesRecord::of(lines, boards).into()),
        }
    }
}

impl LinesRecord {
    fn format(&self, boards: &[Board]) -> TextLines {
        let board = boards.get(usize::from(self.board.value));
        let channels = board.map_or(0, |board| board.channels.len());
        let range = board.map_or(CountRange::WHOLE, |board| board.range);
        let written =
            self.columns.as_ref().map(|columns| columns.iter().map(|column| column.value).collect());
        let columns: Vec<u8> = written.unwrap_or_else(|| (1..).take(channels).collect());
        let last = columns.iter().copied().max().unwrap_or(0);
        let request = [self.request.as_bytes(), self.request_end.bytes()].concat();
        TextLines {
            board: self.board.value,
            request,
            separators: self.separators.clone(),
            width: self.width.as_ref().map_or(last, |width| width.value),
            columns,
            numbers: match self.newtons {
                true => TextNumbers::Newtons,
                false => TextNumbers::Counts {
                    full_scale: self.full_scale.unwrap_or(range.full_scale as f32),
                    sign: range.sign,
                },
            },
        }
    }

    fn of(lines: &TextLines, boards: &[Board]) -> Self {
        let (request, request_end) = RequestEnd::split(&lines.request);
        let range = boards.get(usize::from(lines.board)).map_or(CountRange::WHOLE, |board| board.range);
        let full_scale = match lines.numbers {
            TextNumbers::Counts { full_scale, .. } => {
                Some(full_scale).filter(|full_scale| *full_scale != range.full_scale as f32)
            }
            TextNumbers::Newtons => None,
        };
        let last = lines.columns.iter().max();
        Self {
            board: lines.board.into(),
            request: String::from_utf8_lossy(request).into_owned(),
            request_end,
            separators: lines.separators.clone(),
            columns: Some(lines.columns.iter().map(|column| (*column).into()).collect()),
            width: Some(lines.width).filter(|width| Some(width) != last).map(Written::from),
            full_scale,
            newtons: lines.numbers == TextNumbers::Newtons,
        }
    }

    /// Reports columns that do not fit the board with these channels.
    fn check(&self, reader: &Reader<'_>, at: &Range<usize>, channels: usize) {
        let board = self.board.value;
        let columns = self.columns.iter().flatten();
        if let Some(columns) = self.columns.as_ref().filter(|columns| columns.len() != channels) {
            let at = columns.last().map_or_else(|| at.clone(), |column| column.at.clone());
            let message =
                format!("there are {} columns for the {channels} channels of board {board}", columns.len());
            reader.report(Problem::error(at, message).expected("expected one column for each channel"));
        }
        for (index, column) in columns.clone().enumerate() {
            if let Some(first) = columns.clone().take(index).find(|first| first.value == column.value) {
                let message = format!("column {} comes twice", column.value);
                let first = format!("the first is on line {}", reader.line(&first.at));
                reader.report(Problem::error(column.at.clone(), message).expected(first));
            }
        }
        let Some(width) = &self.width else { return };
        if self.columns.is_none() && channels > usize::from(width.value) {
            let message = format!("{} columns are too few for {channels} channels", width.value);
            reader
                .report(Problem::error(width.at.clone(), message).expected("expected one for each channel"));
        }
        if let Some(beyond) = columns.clone().find(|column| column.value > width.value) {
            let message = format!("column {} is beyond the {} columns of a line", beyond.value, width.value);
            reader
                .report(Problem::error(beyond.at.clone(), message).expected("expected a column of the line"));
        }
    }
}

/// The place of the number of the board, or the start of its lines if the number is not written.
fn board_place(lines: &Written<LinesRecord>) -> Range<usize> {
    match &lines.value.board.at {
        at if at.is_empty() => lines.at.start..(lines.at.start + 1).min(lines.at.end),
        at => at.clone(),
    }
}

/// Reports ports that do not fit the floor: of boards that it does not have, or of one that another port has.
pub(super) fn check(reader: &Reader<'_>, ports: &[SerialRecord], floor: &Floor) {
    let all = || ports.iter().filter_map(|port| port.lines.as_ref());
    for (index, lines) in all().enumerate() {
        let board = lines.value.board.value;
        let at = board_place(lines);
        match floor.boards.get(usize::from(board)) {
            None => {
                let message = format!("the floor has no board {board}");
                let last = floor.boards.len().saturating_sub(1);
                reader.report(Problem::error(at, message).expected(format!("expected 0 to {last}")));
            }
            Some(found) => lines.value.check(reader, &at, found.channels.len()),
        }
        if all().take(index).any(|other| other.value.board.value == board) {
            let message = format!("board {board} has two ports");
            let problem = Problem::error(board_place(lines), message);
            reader.report(problem.expected("expected another board").help("write board: and its number"));
        }
    }
    if !floor.areas.is_empty()
        && let Some(port) = ports.iter().find_map(|port| port.port.as_ref())
    {
        let problem = Problem::error(port.at.clone(), "a floor of several computers has no serial ports");
        let problem = problem.expected("a port belongs to one computer");
        reader.report(problem.help("give --serial where the computer of its area is started"));
    }
}

/// Reports the ports for which `absent` returns what to do.
pub(super) fn check_ports(
    reader: &Reader<'_>,
    ports: &[SerialRecord],
    absent: &dyn Fn(&PortName) -> Option<String>,
) {
    for port in ports.iter().filter_map(|port| port.port.as_ref()) {
        if let Some(help) = absent(&port.value) {
            let problem = Problem::error(port.at.clone(), format!("there is no serial port {}", port.value));
            reader.report(problem.expected("not plugged in?").help(help));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::CountSign;
    use crate::schema::{parse_floor, write_floor};

    fn read(ports: &str) -> Floor {
        let text = format!("Floor(columns: 2, rows: 2, serial: [{ports}])");
        parse_floor(&text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn an_older_file_cannot_have_ports() {
        let problems = parse_floor("Floor(version: 1, columns: 2, rows: 2, serial: [()])", "floor.ron");
        let problems = problems.unwrap_err().to_string();
        assert!(problems.contains("serial ports need version 2") && problems.contains("write version: 2"));
        let floor = parse_floor("Floor(version: 1, columns: 2, rows: 2)", "floor.ron").unwrap();
        assert!(write_floor(&floor).contains("version: 1,"), "older programs read what has nothing new");
    }

    #[test]
    fn a_port_carries_osc_unless_lines_are_described() {
        let floor = read("(port: \"usb:A9\"), (baud: 1000000)");
        let slip = SerialWire::slip(PortName::Usb("A9".into()));
        let nameless = SerialWire { port: None, baud: 1_000_000, lines: None };
        assert_eq!(floor.serial, [slip, nameless]);
        assert_eq!(parse_floor(&write_floor(&floor), "floor.ron"), Ok(floor));
    }

    #[test]
    fn lines_are_described_by_their_columns() {
        let floor = read(
            r#"(port: "/dev/ttyUSB0", lines: (board: 1, full_scale: 1023)),
               (lines: (request: "v", request_end: CrLf, separators: ";", columns: [3, 2, 9, 8, 7, 6, 5, 4],
                   width: 12, newtons: true))"#,
        );
        let lines: Vec<&TextLines> = floor.serial.iter().filter_map(|wire| wire.lines.as_ref()).collect();
        let usual = TextLines {
            board: 1,
            request: Vec::new(),
            separators: " ,".into(),
            columns: (1..=8).collect(),
            width: 8,
            numbers: TextNumbers::Counts { full_scale: 1023.0, sign: CountSign::Unsigned },
        };
        let own = TextLines {
            board: 0,
            request: b"v\r\n".into(),
            separators: ";".into(),
            columns: vec![3, 2, 9, 8, 7, 6, 5, 4],
            width: 12,
            numbers: TextNumbers::Newtons,
        };
        assert_eq!(lines, [&usual, &own]);
        assert_eq!(parse_floor(&write_floor(&floor), "floor.ron"), Ok(floor));
    }
}
