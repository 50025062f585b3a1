//! Channels of the boards that were found, given to the sensors of a floor.

use underfoot::floor::{
    Board, CountRange, CountSign, Floor, PortName, SensorId, SerialWire, TextLines, TextNumbers,
};
use underfoot::serve::{FoundBoard, SentNumbers};

use super::heard::HeardBoards;

/// How channels and sensors fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wires {
    /// Number of boards; without any, the floor keeps its usual ones.
    pub boards: usize,
    /// Number of channels of all boards.
    pub channels: usize,
    /// Number of sensors without a channel.
    pub unread: usize,
    /// Number of channels without a sensor: the last ones.
    pub spare: usize,
}

impl Wires {
    /// Describes the wires, and what cannot be told, in sentences.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let Self { boards, channels, unread, spare } = self;
        if *boards == 0 {
            return vec![
                "No board was found: the file gets the usual ones. Look for boards, then choose the floor again."
                    .to_owned(),
            ];
        }
        let mut words = Vec::new();
        if *unread > 0 {
            words.push(format!(
                "{unread} sensors have no channel: the boards have {channels} in all. Switch on the others and look \
                 again."
            ));
        }
        if *spare > 0 {
            words.push(format!("{spare} of {channels} channels are left over: the last ones."));
        }
        words.push(
            "Channels go tile by tile from the south-west, sw se nw ne each; the step of the wiring finds boards that \
             are swapped."
                .to_owned(),
        );
        words
    }
}

/// Gives the sensors of `floor`, tile by tile, to the channels of the boards in the order of their addresses, and lets
/// the floor take packets from where they come.
pub fn assign(floor: &mut Floor, heard: &HeardBoards) -> Wires {
    let found: Vec<&FoundBoard> = heard.boards();
    let channels: usize = found.iter().map(|board| board.channels()).sum();
    let geometry = floor.geometry;
    let tiles = geometry.tiles().filter(move |tile| geometry.has(*tile));
    let mut sensors = tiles
        .flat_map(move |tile| geometry.sensors(tile).iter().map(move |&corner| SensorId { tile, corner }));
    if found.is_empty() {
        return Wires { boards: 0, channels, unread: 0, spare: 0 };
    }
    let boards = found.iter().enumerate().map(|(number, board)| {
        let channels = (0..board.channels()).map(|_| sensors.next()).collect();
        Board { range: range(board), ..Board::new(address(board, number, &found), channels) }
    });
    floor.boards = boards.collect();
    floor.serial = ports(&found, |port| heard.baud(port));
    floor.allow = heard.networks();
    let wired = floor.boards.iter().flat_map(|board| &board.channels);
    let spare = wired.filter(|sensor| sensor.is_none()).count();
    Wires { boards: found.len(), channels, unread: sensors.count(), spare }
}

/// The counts of a board, as far as its readings tell.
fn range(board: &FoundBoard) -> CountRange {
    let full_scale = board.full_scale().map_or(CountRange::WHOLE.full_scale, |(full, _)| full);
    CountRange { full_scale, sign: CountSign::Unsigned }
}

/// The OSC address of the board with this number; one that no other board has for lines of text.
fn address(board: &FoundBoard, number: usize, found: &[&FoundBoard]) -> String {
    if !board.address.is_empty() {
        return board.address.clone();
    }
    let free = |number: &usize| {
        let address = format!("/underfoot/board/{number}");
        !found.iter().any(|other| other.address == address)
    };
    // Lines come first, so the numbers from here on are free of theirs.
    let number = (0..).filter(free).nth(number).unwrap_or(number);
    format!("/underfoot/board/{number}")
}

/// The serial ports of these boards.
fn ports(found: &[&FoundBoard], baud: impl Fn(&PortName) -> u32) -> Vec<SerialWire> {
    let mut wires: Vec<SerialWire> = Vec::new();
    for (number, board) in (0..).zip(found) {
        let Some(port) = &board.port else { continue };
        let is_text = board.numbers == SentNumbers::Text;
        if !is_text && wires.iter().any(|wire| wire.port.as_ref() == Some(port)) {
            continue;
        }
        let CountRange { full_scale, sign } = range(board);
        let columns: Vec<u8> = board.columns().filter_map(|column| u8::try_from(column).ok()).collect();
        let lines = is_text.then(|| TextLines {
            board: number,
            request: Vec::new(),
            separators: " ,".to_owned(),
            width: columns.last().copied().unwrap_or(1),
            columns,
            numbers: TextNumbers::Counts { full_scale: full_scale as f32, sign },
        });
        wires.push(SerialWire { port: Some(port.clone()), baud: baud(port), lines });
    }
    wires
}

#[cfg(test)]
mod tests {
    use underfoot::floor::Geometry;
    use underfoot::units::Instant;
    use underfoot::wire::{Readings, SensorEncoder, SensorFormat, SensorPacket};

    use super::*;

    #[test]
    fn sensors_without_a_channel_and_channels_without_a_sensor_are_counted() {
        let sent = Floor::of(Geometry::of_paper_tiles(3, 1).unwrap());
        let mut encoder = SensorEncoder::new(&sent, SensorFormat::Counts);
        let mut heard = HeardBoards::default();
        for sequence in 0..20 {
            let readings = Readings::Counts(std::iter::repeat_n(Some(900), 12).collect());
            let packet = SensorPacket { board: 0, sequence, received: Instant::START, readings };
            let datagram = encoder.encode(&packet).unwrap();
            heard.take_datagram(
                datagram,
                "127.0.0.1".parse().unwrap(),
                Instant::from_millis(sequence.into()),
            );
        }
        for (columns, unread, spare) in [(2, 0, 4), (3, 0, 0), (4, 4, 0)] {
            let mut floor = Floor::of(Geometry::of_paper_tiles(columns, 1).unwrap());
            let wires = assign(&mut floor, &heard);
            assert_eq!(wires, Wires { boards: 1, channels: 12, unread, spare });
            assert_eq!(floor.boards[0].range.full_scale, 1023);
            assert_eq!(wires.words().len(), if columns == 3 { 1 } else { 2 });
        }
    }
}
