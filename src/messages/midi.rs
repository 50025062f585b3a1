//! MIDI: settings of messages as layouts write them, and messages as they go out.

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use underfoot_format::{Flag, Num, Opt, num, record};

/// Greatest number of seven bits: of velocities, keys, programs and most values.
pub const MIDI_MAX: u16 = 127;

/// Greatest number of fourteen bits.
pub const MIDI_FINE_MAX: u16 = 16_383;

/// Numbers of controllers; those from 120 on are modes of a channel.
const CONTROLLERS: Num = num(0.0..=119.0);

const CHANNELS: Num = num(1.0..=16.0);

const SEVEN_BITS: Num = num(0.0..=MIDI_MAX as f64);

record! {
    /// A note that a foot strikes or holds.
    pub struct NoteSettings = "Note", Copy;
    /// The channel.
    pub channel: u8 = "channel", CHANNELS => 1;
    /// The velocity; without it the force of the foot gives it.
    pub velocity: Option<u8> = "velocity", Opt(num(1.0..=127.0)) => None;
    /// The force that gives the velocity 127.
    pub force_n: f32 = "force_n", num(20.0..=2000.0) => 400.0;
    /// The time for which the note of an event sounds; one that is held sounds until the hold ends.
    pub length: Duration = "length_ms", num(10.0..=5000.0).milli() => Duration::from_millis(100);
}

record! {
    /// A controller: of an event, of a hold or of a value.
    pub struct ControllerSettings = "Cc", Copy, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize =>
    |it, faults| {
        if it.fine && it.number > 31 {
            let expected = "controllers of 14 bits are 0 to 31; 32 more is the number of their lower half";
            faults.error(&["number", "fine"], "this controller has 7 bits only", expected);
        }
        if !it.fine && it.from.max(it.top()) > MIDI_MAX {
            faults.error(&["from", "to"], "this value has more than 7 bits", "write up to 127, or fine: true");
        }
    };
    /// The channel.
    pub channel: u8 = "channel", CHANNELS => 1;
    /// The number of the controller.
    pub number: u8 = "number", CONTROLLERS;
    /// Whether it has 14 bits, in a pair of controllers.
    pub fine: bool = "fine", Flag => false;
    /// The value for the least value of the control, and after a hold.
    pub from: u16 = "from", num(0.0..=MIDI_FINE_MAX as f64) => 0;
    /// The value for the greatest value of the control, at an event and during a hold: 127, or 16383 with 14 bits,
    /// where none is written.
    pub to: Option<u16> = "to", Opt(num(0.0..=MIDI_FINE_MAX as f64)) => None;
}

record! {
    /// Pitch bend over the range of a value.
    pub struct BendSettings = "Bend", Copy, Eq;
    /// The channel.
    pub channel: u8 = "channel", CHANNELS => 1;
    /// The bend for the least value of the control.
    pub from: i16 = "from", num(-8192.0..=8191.0) => -8192;
    /// The bend for the greatest value of the control.
    pub to: i16 = "to", num(-8192.0..=8191.0) => 8191;
}

record! {
    /// Pressure over the range of a value: of a channel, or of one key.
    pub struct PressureSettings = "Pressure", Copy, Eq;
    /// The channel.
    pub channel: u8 = "channel", CHANNELS => 1;
    /// The key; without it the pressure is that of the channel.
    pub key: Option<u8> = "key", Opt(SEVEN_BITS) => None;
    /// The pressure for the least value of the control.
    pub from: u8 = "from", SEVEN_BITS => 0;
    /// The pressure for the greatest value of the control.
    pub to: u8 = "to", SEVEN_BITS => 127;
}

record! {
    /// The channel of a program.
    pub struct ProgramSettings = "Program", Copy, Eq;
    /// The channel.
    pub channel: u8 = "channel", CHANNELS => 1;
}

/// A key of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize)]
pub struct MidiNote {
    /// The channel, 1 to 16.
    pub channel: u8,
    /// The key, 0 to 127; 60 is the middle C, which is C4 here.
    pub key: u8,
}

/// A message that holds nothing; channels are 1 to 16.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum MidiMessage {
    /// A controller: channel, number, value of 7 bits.
    Controller(u8, u8, u8),
    /// A controller of 14 bits: channel, number, value.
    FineController(u8, u8, u16),
    /// A program: channel, number from 0.
    Program(u8, u8),
    /// Pitch bend: channel, -8192 to 8191.
    Bend(u8, i16),
    /// Pressure of a channel: channel, pressure.
    Pressure(u8, u8),
    /// Pressure of one key.
    KeyPressure(MidiNote, u8),
    /// The lower zone of MPE gets this number of member channels, from channel 2 on.
    LowerZone(u8),
}

const NAMES: [&str; 12] = ["C", "C#", "D", "D#", "E", "F", "F#", "G", "G#", "A", "A#", "B"];

impl MidiNote {
    /// The name of its key, such as `C4` for 60.
    #[must_use]
    pub fn name(&self) -> String {
        let name = NAMES.get(usize::from(self.key % 12)).copied().unwrap_or_default();
        format!("{name}{}", i32::from(self.key / 12) - 1)
    }

    /// The key called `name`: 0 to 127, or a note with its octave such as `C4` (60), `F#3` or `Bb2`.
    #[must_use]
    pub fn key_called(name: &str) -> Option<u8> {
        if let Ok(key) = name.parse::<u8>() {
            return (u16::from(key) <= MIDI_MAX).then_some(key);
        }
        let octave_at = name.find(|c: char| c == '-' || c.is_ascii_digit())?;
        let (note, octave) = name.split_at_checked(octave_at)?;
        let (letter, shift) = match (note.strip_suffix('#'), note.strip_suffix('b')) {
            (Some(letter), _) => (letter, 1),
            (_, Some(letter)) => (letter, -1),
            _ => (note, 0),
        };
        let step = NAMES.iter().position(|known| *known == letter && letter.len() == 1)?;
        let octave: i32 = octave.parse().ok().filter(|octave| (-1..=9).contains(octave))?;
        let key = 12 * (octave + 1) + i32::try_from(step).ok()? + shift;
        u8::try_from(key).ok().filter(|key| u16::from(*key) <= MIDI_MAX)
    }
}

impl NoteSettings {
    /// The settings where none are written.
    pub const USUAL: Self =
        Self { channel: 1, velocity: None, force_n: 400.0, length: Duration::from_millis(100) };

    /// The velocity of a foot that presses with `force` newtons, 1 to 127.
    pub(super) fn velocity_at(&self, force: f32) -> u8 {
        // A force that is no number gives the least velocity.
        self.velocity
            .unwrap_or_else(|| (127.0 * (force / self.force_n).clamp(0.0, 1.0)).round().max(1.0) as u8)
    }
}

impl ControllerSettings {
    /// The value at the upper end.
    #[must_use]
    pub fn top(&self) -> u16 {
        self.to.unwrap_or(if self.fine { MIDI_FINE_MAX } else { MIDI_MAX })
    }

    /// The message at `share` of the range, 0 to 1.
    pub(super) fn at(&self, share: f32) -> MidiMessage {
        self.with(between(self.from.into(), self.top().into(), share) as u16)
    }

    /// The message that sets the controller to `value`.
    #[must_use]
    pub fn with(&self, value: u16) -> MidiMessage {
        let Self { channel, number, fine, .. } = *self;
        if fine {
            MidiMessage::FineController(channel, number, value.min(MIDI_FINE_MAX))
        } else {
            MidiMessage::Controller(channel, number, u8::try_from(value.min(MIDI_MAX)).unwrap_or_default())
        }
    }
}

impl BendSettings {
    /// The message at `share` of the range, 0 to 1.
    pub(super) fn at(&self, share: f32) -> MidiMessage {
        MidiMessage::Bend(self.channel, between(self.from.into(), self.to.into(), share) as i16)
    }
}

impl PressureSettings {
    /// The message at `share` of the range, 0 to 1.
    pub(super) fn at(&self, share: f32) -> MidiMessage {
        let pressure = between(self.from.into(), self.to.into(), share) as u8;
        match self.key {
            Some(key) => MidiMessage::KeyPressure(MidiNote { channel: self.channel, key }, pressure),
            None => MidiMessage::Pressure(self.channel, pressure),
        }
    }
}

/// The whole number at `share` of the way from `from` to `to`; halves go upwards, so that the middle of a bend is 0.
pub(super) fn between(from: f32, to: f32, share: f32) -> f32 {
    (from + (to - from) * share.clamp(0.0, 1.0) + 0.5).floor()
}

impl fmt::Display for MidiNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "note {} on channel {}", self.name(), self.channel)
    }
}

impl fmt::Display for MidiMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Controller(channel, number, value) => {
                write!(f, "controller {number} on channel {channel}: {value}")
            }
            Self::FineController(channel, number, value) => {
                write!(f, "controller {number} on channel {channel}: {value} of {MIDI_FINE_MAX}")
            }
            Self::Program(channel, number) => write!(f, "program {number} on channel {channel}"),
            Self::Bend(channel, bend) => write!(f, "bend {bend:+} on channel {channel}"),
            Self::Pressure(channel, pressure) => write!(f, "pressure {pressure} on channel {channel}"),
            Self::KeyPressure(note, pressure) => write!(f, "pressure {pressure} of {note}"),
            Self::LowerZone(members) => write!(f, "MPE with {members} member channels"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_numbers_and_names() {
        let keys = ["60", "C4", "F#3", "Bb2", "C-1", "G9", "Cb4"].map(MidiNote::key_called);
        assert_eq!(keys, [60, 60, 54, 46, 0, 127, 59].map(Some));
        for wrong in ["128", "H4", "C", "C10", "G#9", "Cb-1", "", "C#b3"] {
            assert_eq!(MidiNote::key_called(wrong), None, "{wrong}");
        }
        assert_eq!(MidiNote { channel: 1, key: 61 }.to_string(), "note C#4 on channel 1");
    }

    #[test]
    fn a_harder_press_is_louder_and_no_force_is_silent() {
        let note = NoteSettings { channel: 1, velocity: None, force_n: 400.0, length: Duration::ZERO };
        let velocities =
            [0.0, 100.0, 400.0, 4000.0, f32::NAN, f32::INFINITY].map(|force| note.velocity_at(force));
        assert_eq!(velocities, [1, 32, 127, 127, 1, 127]);
        assert_eq!(NoteSettings { velocity: Some(90), ..note }.velocity_at(10.0), 90);
    }
}
