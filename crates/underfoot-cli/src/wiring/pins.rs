//! The pins behind the channels of a board.

use underfoot::floor::{Floor, TextLines, TextNumbers};

/// The boards whose pins are known: those of `firmware/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub(crate) enum Pins {
    /// A Pico with four MCP3208 converters: `firmware/pico`.
    Pico,
    /// An Arduino with sensors at its analogue inputs: `firmware/arduino`.
    Arduino,
    /// An Arduino with HX711 amplifiers at these inputs: `firmware/arduino`.
    Amplifiers,
    /// Another board, of which only the channels are known.
    Channels,
}

/// Inputs of one converter.
pub(super) const CHANNELS: usize = 8;

/// A converter of the Pico, with the pins that differ among the four: each pair has an SPI bus.
#[derive(Clone, Copy, Debug)]
pub(super) struct Converter {
    pub(super) name: &'static str,
    pub(super) clock: PicoPin,
    pub(super) to_pico: PicoPin,
    pub(super) from_pico: PicoPin,
    pub(super) select: PicoPin,
}

/// A pin of a Pico.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PicoPin {
    /// The number in its name, `GP2`.
    pub(super) gp: u8,
    /// Its place on the board, from 1.
    pub(super) place: u8,
}

const fn pin(gp: u8, place: u8) -> PicoPin {
    PicoPin { gp, place }
}

const fn first(name: &'static str, select: PicoPin) -> Converter {
    Converter { name, clock: pin(2, 4), from_pico: pin(3, 5), to_pico: pin(4, 6), select }
}

const fn second(name: &'static str, select: PicoPin) -> Converter {
    Converter { name, clock: pin(10, 14), from_pico: pin(11, 15), to_pico: pin(12, 16), select }
}

/// The converters in the order of the channels, as in `firmware/pico/src/main.rs`.
pub(super) const CONVERTERS: [Converter; 4] =
    [first("U1", pin(5, 7)), first("U2", pin(6, 9)), second("U3", pin(13, 17)), second("U4", pin(14, 19))];

impl Pins {
    /// The likely board behind this number: one of text lines is an Arduino, one of OSC on a serial port a Pico.
    pub(super) fn guessed(floor: &Floor, board: usize) -> Self {
        match lines(floor, board).map(|lines| lines.numbers) {
            Some(TextNumbers::Counts { full_scale, .. }) if full_scale > f32::from(u16::MAX) => {
                Self::Amplifiers
            }
            Some(_) => Self::Arduino,
            None if floor.serial.iter().any(|port| port.lines.is_none()) => Self::Pico,
            None => Self::Channels,
        }
    }

    /// Number of inputs.
    pub(super) const fn inputs(self) -> usize {
        match self {
            Self::Pico => CONVERTERS.len() * CHANNELS,
            Self::Arduino | Self::Amplifiers => 16,
            Self::Channels => usize::MAX,
        }
    }

    /// The name of the board and of what is in front of it.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Pico => "Pico with MCP3208 converters",
            Self::Arduino => "Arduino",
            Self::Amplifiers => "Arduino with HX711 amplifiers",
            Self::Channels => "board",
        }
    }

    /// Its name in those of files.
    pub(super) const fn word(self) -> &'static str {
        match self {
            Self::Pico => "pico",
            Self::Arduino => "arduino",
            Self::Amplifiers => "amplifiers",
            Self::Channels => "channels",
        }
    }

    /// The input of this channel of this board: `U1 CH3`, `A3` or `channel 3`.
    pub(super) fn input(self, floor: &Floor, board: usize, channel: usize) -> String {
        match self {
            Self::Pico => {
                let converter = CONVERTERS.get(channel / CHANNELS).map_or("?", |converter| converter.name);
                format!("{converter} CH{}", channel % CHANNELS)
            }
            Self::Arduino | Self::Amplifiers => {
                let column = lines(floor, board).and_then(|lines| lines.columns.get(channel));
                let input = column.map_or(channel, |column| usize::from(column.saturating_sub(1)));
                format!("A{input}")
            }
            Self::Channels => format!("channel {channel}"),
        }
    }
}

/// The lines of text that this board sends.
fn lines(floor: &Floor, board: usize) -> Option<&TextLines> {
    let mut lines = floor.serial.iter().filter_map(|port| port.lines.as_ref());
    lines.find(|lines| usize::from(lines.board) == board)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picos_pins_are_those_of_its_firmware() {
        let firmware = include_str!("../../../../firmware/pico/src/main.rs");
        for (number, bus) in CONVERTERS.chunks(2).enumerate() {
            let [one, other] = bus else { panic!("two converters a bus") };
            let (out, back, clock) = (one.from_pico.gp, one.to_pico.gp, one.clock.gp);
            let lines = format!(
                "SPI{number}, (line(pins.gpio{out}), answer(pins.gpio{back}), line(pins.gpio{clock}))"
            );
            assert!(firmware.contains(&lines), "{lines}");
            let selects =
                format!("[select(pins.gpio{}), select(pins.gpio{})]", one.select.gp, other.select.gp);
            assert!(firmware.contains(&selects), "{selects}");
        }
    }

    #[test]
    fn boards_are_recognised_by_what_their_port_carries() {
        let read = |text: &str| underfoot::schema::parse_floor(text, "floor.ron").unwrap();
        let pico = read(include_str!("../../../../firmware/pico/floor.ron"));
        assert_eq!(Pins::guessed(&pico, 0), Pins::Pico);
        assert_eq!(Pins::Pico.input(&pico, 0, 31), "U4 CH7");
        let pad = read(include_str!("../../../../firmware/arduino/pad.ron"));
        assert_eq!(Pins::guessed(&pad, 0), Pins::Arduino);
        let cells = read(include_str!("../../../../firmware/arduino/cells.ron"));
        assert_eq!(Pins::guessed(&cells, 0), Pins::Amplifiers);
        assert_eq!(Pins::guessed(&Floor::default(), 0), Pins::Channels);
        let other_columns = read("Floor(columns: 1, rows: 1, serial: [(lines: (columns: [4, 3, 2, 1]))])");
        assert_eq!(Pins::Arduino.input(&other_columns, 0, 0), "A3");
    }
}
