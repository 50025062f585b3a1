//! Causes for which a link gives no usable frame although boards send.

use std::fmt;

/// Minimum and maximum rate of boards, in packets a second (our choice: below, a press would take longer than a tenth
/// of a second; four samples a millisecond are more than a foot needs).
pub const BOARD_RATES_HZ: [f32; 2] = [20.0, 4000.0];

/// Reason for which a link gives no usable frame although boards send, or for which their readings contradict the
/// floor file.
///
/// If several boards have the same fault, the cause gives the first. Names and fields stay; later versions may add
/// variants.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LinkCause {
    /// A board sends fewer packets a second than [`BOARD_RATES_HZ`].
    RateLow {
        /// The board's number.
        board: u16,
        /// Packets a second, measured.
        hz: f32,
    },
    /// A board sends more packets a second than [`BOARD_RATES_HZ`].
    RateHigh {
        /// The board's number.
        board: u16,
        /// Packets a second, measured.
        hz: f32,
    },
    /// A board sends at another rate than the floor file says.
    RateOther {
        /// The board's number.
        board: u16,
        /// Packets a second, measured.
        hz: f32,
        /// Packets a second by the floor file.
        written: f32,
    },
    /// A board's sequence number stays the same, and so do its readings: it repeats one packet.
    SequenceStands {
        /// The board's number.
        board: u16,
        /// The sequence number.
        number: u32,
    },
    /// A board's sequence number grows by more than one from packet to packet.
    SequenceStep {
        /// The board's number.
        board: u16,
        /// The step; at least 2.
        step: u32,
    },
    /// A board's sequence number counts down.
    SequenceFalls {
        /// The board's number.
        board: u16,
    },
    /// A board's sequence number restarts repeatedly.
    SequenceRestarts {
        /// The board's number.
        board: u16,
        /// The greatest number before a restart.
        after: u32,
    },
    /// Two sequences are mixed under one board's address: two boards or two programs use it.
    SequenceMixed {
        /// The board's number.
        board: u16,
    },
    /// A board's sequence numbers have no order.
    SequenceJumps {
        /// The board's number.
        board: u16,
    },
    /// Messages with readings use an address that no board of the floor file has.
    OtherAddress {
        /// The address in the messages.
        found: String,
        /// The nearest address of the floor file.
        expected: String,
    },
    /// A board's messages have other types or another number of readings than in the floor file.
    WrongReadings {
        /// The board's number.
        board: u16,
        /// The number of its channels by the floor file.
        channels: usize,
        /// The OSC type tags of its messages, such as `idddd`.
        found: String,
    },
    /// Datagrams are not well-formed OSC.
    NotOsc {
        /// Their fault, and their likely format.
        why: String,
    },
    /// A serial port gives bytes that are not the expected lines or frames.
    PortGarbled {
        /// The name of the port.
        port: String,
        /// The fault of the last line or frame.
        why: String,
    },
    /// Datagrams come from a blocked address.
    SenderRefused {
        /// The sender, and the rule that blocks it.
        why: String,
    },
    /// Counts are outside of the range of their board.
    CountsBeyond {
        /// The board's number.
        board: u16,
        /// The greatest count beyond the range; `None` if unknown.
        greatest: Option<i64>,
        /// The greatest count by the floor file.
        full_scale: u32,
    },
    /// Newtons are NaN, infinite, or more than 50 kN.
    NotNumbers {
        /// The board's number.
        board: u16,
    },
    /// A board's readings repeat bit for bit under a load.
    ReadingsStand {
        /// The board's number.
        board: u16,
    },
    /// Readings move and no load was ever seen; the counts use only a small part of their range.
    CountsNarrow {
        /// The board's number.
        board: u16,
        /// The minimum count so far.
        least: i64,
        /// The maximum count so far.
        greatest: i64,
        /// The greatest count by the floor file.
        full_scale: u32,
    },
    /// Readings move and no load was ever seen; the newtons stay small.
    NewtonsSmall {
        /// The board's number.
        board: u16,
        /// The maximum so far.
        greatest: f32,
    },
    /// Newtons are more than any floor carries.
    NewtonsLarge {
        /// The board's number.
        board: u16,
        /// The maximum so far.
        greatest: f32,
    },
    /// Readings fall under load instead of rising, so that no load was ever seen.
    ReadingsFall {
        /// The board's number.
        board: u16,
    },
    /// Readings move, and no load was ever seen for another reason: most likely the calibration is of other sensors.
    NoLoad {
        /// The board's number.
        board: u16,
    },
    /// Two boards are swapped, or several in a ring.
    BoardsSwapped {
        /// The number of one of them.
        board: u16,
        /// The number of the board whose tiles it reads.
        reads: u16,
    },
    /// Only some of the floor's boards send.
    BoardsMissing {
        /// The first missing board.
        board: u16,
        /// Its address by the floor file.
        address: String,
        /// The number of missing boards.
        missing: u32,
        /// The number of boards of the floor.
        boards: u32,
    },
    /// None of the above.
    Unknown {
        /// The reason for the last rejected message; empty if there was none.
        last_refused: String,
    },
}

impl LinkCause {
    /// Its name in OSC, JSON and other languages, such as `rate_low`. The name never changes.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::RateLow { .. } => "rate_low",
            Self::RateHigh { .. } => "rate_high",
            Self::RateOther { .. } => "rate_other",
            Self::SequenceStands { .. } => "sequence_stands",
            Self::SequenceStep { .. } => "sequence_step",
            Self::SequenceFalls { .. } => "sequence_falls",
            Self::SequenceRestarts { .. } => "sequence_restarts",
            Self::SequenceMixed { .. } => "sequence_mixed",
            Self::SequenceJumps { .. } => "sequence_jumps",
            Self::OtherAddress { .. } => "other_address",
            Self::WrongReadings { .. } => "wrong_readings",
            Self::NotOsc { .. } => "not_osc",
            Self::PortGarbled { .. } => "port_garbled",
            Self::SenderRefused { .. } => "sender_refused",
            Self::CountsBeyond { .. } => "counts_beyond",
            Self::NotNumbers { .. } => "not_numbers",
            Self::ReadingsStand { .. } => "readings_stand",
            Self::CountsNarrow { .. } => "counts_narrow",
            Self::NewtonsSmall { .. } => "newtons_small",
            Self::NewtonsLarge { .. } => "newtons_large",
            Self::ReadingsFall { .. } => "readings_fall",
            Self::NoLoad { .. } => "no_load",
            Self::BoardsSwapped { .. } => "boards_swapped",
            Self::BoardsMissing { .. } => "boards_missing",
            Self::Unknown { .. } => "unknown",
        }
    }

    /// Returns the number of the faulty board; `None` if no board of the floor file is concerned.
    #[must_use]
    pub const fn board(&self) -> Option<u16> {
        match self {
            Self::RateLow { board, .. }
            | Self::RateHigh { board, .. }
            | Self::RateOther { board, .. }
            | Self::SequenceStands { board, .. }
            | Self::SequenceStep { board, .. }
            | Self::SequenceFalls { board }
            | Self::SequenceRestarts { board, .. }
            | Self::SequenceMixed { board }
            | Self::SequenceJumps { board }
            | Self::WrongReadings { board, .. }
            | Self::CountsBeyond { board, .. }
            | Self::NotNumbers { board }
            | Self::ReadingsStand { board }
            | Self::CountsNarrow { board, .. }
            | Self::NewtonsSmall { board, .. }
            | Self::NewtonsLarge { board, .. }
            | Self::ReadingsFall { board }
            | Self::NoLoad { board }
            | Self::BoardsSwapped { board, .. }
            | Self::BoardsMissing { board, .. } => Some(*board),
            Self::OtherAddress { .. }
            | Self::NotOsc { .. }
            | Self::PortGarbled { .. }
            | Self::SenderRefused { .. }
            | Self::Unknown { .. } => None,
        }
    }

    /// Whether both are the same cause at the same board; measured values may differ.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        self.name() == other.name() && self.board() == other.board()
    }
}

/// One sentence: the fault, and the correct form.
impl fmt::Display for LinkCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [lowest, highest] = BOARD_RATES_HZ;
        match self {
            Self::RateLow { board, hz } => write!(
                f,
                "board {board} sends {} packets a second: {lowest} at least are needed for presses in time",
                rounded(*hz)
            ),
            Self::RateHigh { board, hz } => write!(
                f,
                "board {board} sends {} packets a second: {highest} are understood at most",
                rounded(*hz)
            ),
            Self::RateOther { board, hz, written } => write!(
                f,
                "board {board} sends {} packets a second, and the floor file says rate_hz: {written}",
                rounded(*hz)
            ),
            Self::SequenceStands { board, number } => write!(
                f,
                "board {board} repeats one packet, with the number {number}: its program hangs, or nobody reads its converter"
            ),
            Self::SequenceStep { board, step } => write!(
                f,
                "the sequence number of board {board} counts by {step}: it must grow by one with each packet, so that \
                 lost packets are noticed"
            ),
            Self::SequenceFalls { board } => write!(
                f,
                "the sequence number of board {board} counts down: it must grow by one with each packet"
            ),
            Self::SequenceRestarts { board, after } => write!(
                f,
                "the sequence number of board {board} begins anew after {after}: it must grow up to 4294967295{}",
                width_of(*after)
            ),
            Self::SequenceMixed { board } => write!(
                f,
                "two counts are mixed under the address of board {board}: do two boards or two programs send under it?"
            ),
            Self::SequenceJumps { board } => write!(
                f,
                "the sequence numbers of board {board} follow no order: each must be one more than the one before, as a \
                 big-endian int32"
            ),
            Self::OtherAddress { found, expected } => write!(
                f,
                "readings come for {found:?}, and the floor file has no board of that address: the nearest is {expected:?}"
            ),
            Self::WrongReadings { board, channels, found } => wrong_readings(f, *board, *channels, found),
            Self::NotOsc { why } => write!(f, "datagrams arrive that are not OSC: {why}"),
            Self::PortGarbled { port, why } => {
                write!(f, "the serial port {port} does not give what the floor file says: {why}")
            }
            Self::SenderRefused { why } => write!(f, "datagrams arrive that are refused: {why}"),
            Self::CountsBeyond { board, greatest, full_scale } => {
                counts_beyond(f, *board, *greatest, *full_scale)
            }
            Self::NotNumbers { board } => {
                write!(f, "the newtons of board {board} are not numbers, or more than 50 kN")
            }
            Self::ReadingsStand { board } => write!(
                f,
                "all readings of board {board} stand still under a load, which no converter does that works"
            ),
            Self::CountsNarrow { board, least, greatest, full_scale } => {
                counts_narrow(f, *board, [*least, *greatest], *full_scale)
            }
            Self::NewtonsSmall { board, greatest } => write!(
                f,
                "no load was seen although the readings of board {board} move: its newtons never exceed {greatest:.2}; are \
                 they volts, or shares of the range?"
            ),
            Self::NewtonsLarge { board, greatest } => write!(
                f,
                "the newtons of board {board} reach {greatest:.0} on one sensor, which no floor carries: are they counts?"
            ),
            Self::ReadingsFall { board } => write!(
                f,
                "no load was seen although the readings of board {board} move: they fall where they should rise; are its \
                 sensors wired the other way round?"
            ),
            Self::NoLoad { board } => write!(
                f,
                "no load was seen although the readings of board {board} move: is the calibration in the floor file that \
                 of these sensors?"
            ),
            Self::BoardsSwapped { board, reads } => write!(
                f,
                "board {board} reads what the floor file says of the tiles of board {reads}: boards have changed places"
            ),
            Self::BoardsMissing { board, address, missing, boards } => write!(
                f,
                "nothing usable comes from {missing} of {boards} boards; the first is board {board}, {address:?}"
            ),
            Self::Unknown { last_refused } if last_refused.is_empty() => {
                write!(f, "packets arrive, and none of them makes a usable frame")
            }
            Self::Unknown { last_refused } => {
                write!(
                    f,
                    "packets arrive, and none of them makes a usable frame; last refused: {last_refused}"
                )
            }
        }
    }
}

/// Formats a rate for people: whole packets a second, or tenths below 10.
fn rounded(hz: f32) -> String {
    if hz < 10.0 { format!("{hz:.1}") } else { format!("{hz:.0}") }
}

/// A note on a counter of 8, 16 or 24 bits.
fn width_of(greatest: u32) -> &'static str {
    match greatest {
        0xFF => "; this one has 8 bits",
        0xFFFF => "; this one has 16 bits",
        0xFF_FFFF => "; this one has 24 bits",
        _ => "",
    }
}

fn wrong_readings(f: &mut fmt::Formatter<'_>, board: u16, channels: usize, found: &str) -> fmt::Result {
    write!(
        f,
        "board {board} sends {found:?}: expected an int32 sequence number (i) and {channels} counts (i), newtons (f), or \
         one blob (b) of {} bytes",
        2 * channels
    )?;
    let tags = found.split(' ').next().unwrap_or_default();
    let (first, readings) = tags.split_at(tags.len().min(1));
    let hint = if first != "i" {
        "; the first argument must be the sequence number"
    } else if readings.contains('d') {
        "; doubles (d) must be sent as floats (f)"
    } else if readings.contains('h') {
        "; 64-bit integers (h) must be sent as int32 (i)"
    } else if readings.contains('s') {
        "; numbers must not be sent as text (s)"
    } else {
        ""
    };
    f.write_str(hint)
}

fn counts_beyond(
    f: &mut fmt::Formatter<'_>,
    board: u16,
    greatest: Option<i64>,
    full_scale: u32,
) -> fmt::Result {
    write!(
        f,
        "the counts of board {board} are outside of the range that the floor file says, up to {full_scale}: "
    )?;
    match greatest.and_then(|greatest| Some((greatest, width(greatest)?))) {
        Some((greatest, bits)) => write!(
            f,
            "they reach {greatest}, as those of a {bits}-bit converter; write full_scale: {} to the board, and counts: \
             Signed or OffsetBinary if they have a sign",
            (1_u32 << bits) - 1
        ),
        None => write!(
            f,
            "write full_scale to the board, such as 16777215 for 24 bits, and counts: Signed or OffsetBinary if they \
             have a sign"
        ),
    }
}

fn counts_narrow(
    f: &mut fmt::Formatter<'_>,
    board: u16,
    [least, greatest]: [i64; 2],
    full_scale: u32,
) -> fmt::Result {
    write!(f, "no load was seen although the readings of board {board} move: ")?;
    match width(greatest).filter(|bits| 1_u64 << (bits + 2) <= u64::from(full_scale) + 1) {
        Some(bits) => write!(
            f,
            "its counts never exceed {0} of {full_scale}, as those of a {bits}-bit converter; write full_scale: {0} to \
             the board in the floor file",
            (1_u32 << bits) - 1
        ),
        None => write!(
            f,
            "its counts stay between {least} and {greatest} of {full_scale}: is full_scale in the floor file that of its \
             converter?"
        ),
    }
}

/// The bits of the narrowest usual converter that reaches this count; `None` beyond 24 bits, and for a negative count.
fn width(greatest: i64) -> Option<u32> {
    [8, 10, 12, 14, 16, 18, 20, 24].into_iter().find(|bits| (0..1_i64 << bits).contains(&greatest))
}

/// Returns the likely format of a datagram that is not OSC, as a message for people; `None` if there is no guess.
pub fn guess_format(datagram: &[u8]) -> Option<&'static str> {
    let length = datagram.split_first_chunk().map(|(length, _)| u32::from_be_bytes(*length));
    let is_text = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    match datagram {
        [] => Some("they are empty"),
        [0xC0, ..] | [.., 0xC0] => Some("they look like SLIP frames, which UDP does not need"),
        _ if length.is_some_and(|length| length as usize == datagram.len() - 4) => {
            Some("they begin with their length, as OSC over TCP does and OSC over UDP does not")
        }
        [b'/' | b'#', ..] => None,
        _ if datagram.iter().all(is_text) => Some("they look like text"),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
