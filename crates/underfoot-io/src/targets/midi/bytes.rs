//! The bytes of MIDI messages (MIDI 1.0).

use underfoot::messages::{Holdable, MidiMessage, MidiNote};

/// One message of two or three bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MidiBytes {
    bytes: [u8; 3],
    length: u8,
}

/// Status bytes, to which the channel is added.
const NOTE_OFF: u8 = 0x80;
const NOTE_ON: u8 = 0x90;
const KEY_PRESSURE: u8 = 0xa0;
const CONTROLLER: u8 = 0xb0;
const PROGRAM: u8 = 0xc0;
const CHANNEL_PRESSURE: u8 = 0xd0;
const BEND: u8 = 0xe0;

/// The lower half of a controller of 14 bits has a number that is greater by this.
const LOWER_HALF: u8 = 32;

/// The controllers that choose a registered parameter, its halves, and its value.
const PARAMETER: [u8; 2] = [101, 100];
const DATA: u8 = 6;

/// The registered parameter of an MPE zone.
const MPE: u8 = 6;

const ALL_NOTES_OFF: u8 = 123;

/// The velocity of a release that is not measured.
const RELEASE: u8 = 64;

impl MidiBytes {
    fn two(status: u8, channel: u8, value: u8) -> Self {
        Self { bytes: [status | on(channel), value & 0x7f, 0], length: 2 }
    }

    fn three(status: u8, channel: u8, first: u8, second: u8) -> Self {
        Self { bytes: [status | on(channel), first & 0x7f, second & 0x7f], length: 3 }
    }

    /// The message.
    #[cfg(any(test, not(feature = "jack")))]
    pub(super) fn as_slice(&self) -> &[u8] {
        self.bytes.get(..self.length.into()).unwrap_or(&self.bytes)
    }

    /// The message, its length first and filled up with zeros.
    #[cfg(feature = "jack")]
    pub(super) const fn packed(&self) -> [u8; 4] {
        let [first, second, third] = self.bytes;
        [self.length, first, second, third]
    }
}

/// The four bits of a channel from 1 to 16.
const fn on(channel: u8) -> u8 {
    channel.saturating_sub(1) & 0x0f
}

/// Returns the bytes of a message that holds nothing.
pub(super) fn said(message: MidiMessage) -> Vec<MidiBytes> {
    let halves = |value: u16| [(value >> 7) as u8 & 0x7f, (value & 0x7f) as u8];
    match message {
        MidiMessage::Controller(channel, number, value) => {
            vec![MidiBytes::three(CONTROLLER, channel, number, value)]
        }
        MidiMessage::FineController(channel, number, value) => {
            let [upper, lower] = halves(value);
            // The upper half sets the lower one to 0, so it goes first.
            vec![
                MidiBytes::three(CONTROLLER, channel, number, upper),
                MidiBytes::three(CONTROLLER, channel, number + LOWER_HALF, lower),
            ]
        }
        MidiMessage::Program(channel, number) => vec![MidiBytes::two(PROGRAM, channel, number)],
        MidiMessage::Bend(channel, bend) => {
            let [upper, lower] = halves((i32::from(bend.clamp(-8192, 8191)) + 8192) as u16);
            vec![MidiBytes::three(BEND, channel, lower, upper)]
        }
        MidiMessage::Pressure(channel, pressure) => vec![MidiBytes::two(CHANNEL_PRESSURE, channel, pressure)],
        MidiMessage::KeyPressure(MidiNote { channel, key }, pressure) => {
            vec![MidiBytes::three(KEY_PRESSURE, channel, key, pressure)]
        }
        MidiMessage::LowerZone(members) => {
            let [upper, lower] = PARAMETER;
            [(upper, 0), (lower, MPE), (DATA, members)]
                .map(|(number, value)| MidiBytes::three(CONTROLLER, 1, number, value))
                .to_vec()
        }
    }
}

/// Returns the bytes with which `what` goes down; none for a thing that is not of MIDI.
pub(super) fn pressed(what: &Holdable, velocity: u8) -> Vec<MidiBytes> {
    match what {
        Holdable::Note(MidiNote { channel, key }) => {
            // A velocity of 0 would be a release.
            vec![MidiBytes::three(NOTE_ON, *channel, *key, velocity.clamp(1, 127))]
        }
        Holdable::Controller(settings) => said(settings.with(settings.top())),
        _ => Vec::new(),
    }
}

/// Returns the bytes with which `what` comes up.
pub(super) fn released(what: &Holdable) -> Vec<MidiBytes> {
    match what {
        Holdable::Note(MidiNote { channel, key }) => {
            vec![MidiBytes::three(NOTE_OFF, *channel, *key, RELEASE)]
        }
        Holdable::Controller(settings) => said(settings.with(settings.from)),
        _ => Vec::new(),
    }
}

/// Returns the bytes that silence the channel of `what`, whose state is not known.
pub(super) fn silenced(what: &Holdable) -> Vec<MidiBytes> {
    match what {
        Holdable::Note(MidiNote { channel, .. }) | Holdable::Notes(channel) => {
            vec![MidiBytes::three(CONTROLLER, *channel, ALL_NOTES_OFF, 0)]
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::messages::ControllerSettings;

    fn hex(messages: &[MidiBytes]) -> Vec<String> {
        let text =
            |message: &MidiBytes| message.as_slice().iter().map(|byte| format!("{byte:02x}")).collect();
        messages.iter().map(text).collect()
    }

    #[test]
    fn messages_have_the_bytes_of_the_standard() {
        let all = [
            (MidiMessage::Controller(1, 7, 127), vec!["b0077f"]),
            (MidiMessage::FineController(16, 1, 0x2001), vec!["bf0140", "bf2101"]),
            (MidiMessage::Program(10, 5), vec!["c905"]),
            (MidiMessage::Bend(1, 0), vec!["e00040"]),
            (MidiMessage::Bend(1, -8192), vec!["e00000"]),
            (MidiMessage::Bend(2, 8191), vec!["e17f7f"]),
            (MidiMessage::Pressure(3, 64), vec!["d240"]),
            (MidiMessage::KeyPressure(MidiNote { channel: 1, key: 60 }, 1), vec!["a03c01"]),
            (MidiMessage::LowerZone(15), vec!["b06500", "b06406", "b0060f"]),
        ];
        for (message, bytes) in all {
            assert_eq!(hex(&said(message)), bytes, "{message}");
        }
    }

    #[test]
    fn a_note_goes_down_with_its_velocity_and_comes_up() {
        let note = Holdable::Note(MidiNote { channel: 2, key: 60 });
        assert_eq!(hex(&pressed(&note, 100)), ["913c64"]);
        assert_eq!(hex(&pressed(&note, 0)), ["913c01"], "a velocity of 0 would release it");
        assert_eq!(hex(&released(&note)), ["813c40"]);
        assert_eq!(hex(&silenced(&note)), ["b17b00"]);
        assert_eq!(hex(&silenced(&Holdable::Notes(16))), ["bf7b00"]);
        let pedal = ControllerSettings { channel: 1, number: 64, fine: false, from: 0, to: None };
        let pedal = Holdable::Controller(pedal);
        assert_eq!([hex(&pressed(&pedal, 1)), hex(&released(&pedal))], [["b0407f"], ["b04000"]]);
    }
}
