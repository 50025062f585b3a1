//! A foot as a voice of MPE (MIDI Polyphonic Expression 1.0, lower zone): the notes and messages of one foot.

use glam::Vec2;

use super::feet_settings::{MPE_BEND, MpeSettings};
use super::midi::{MidiMessage, MidiNote, between};

/// The controller of the third dimension of MPE.
const TIMBRE: u8 = 74;

impl MpeSettings {
    /// The note of foot `number`, from 0, that arrives at `share` of the region: the key nearest to its place.
    pub(super) fn note(&self, number: u8, share: Vec2) -> MidiNote {
        // Channel 1 is the zone's own; the members follow it.
        let channel = number.saturating_add(2).min(16);
        MidiNote { channel, key: between(self.from.into(), self.to.into(), share.x) as u8 }
    }

    /// The messages of a foot at `share` of the region that plays `note` with `force` newtons: bend, timbre, pressure.
    pub(super) fn expression(&self, note: MidiNote, share: Vec2, force: f32) -> [MidiMessage; 3] {
        let [from, to] = [self.from, self.to].map(f32::from);
        let semitones = from + (to - from) * share.x.clamp(0.0, 1.0) - f32::from(note.key);
        let bend = (semitones / f32::from(MPE_BEND) * 8192.0).round().clamp(-8192.0, 8191.0) as i16;
        let timbre = between(0.0, 127.0, share.y) as u8;
        [
            MidiMessage::Bend(note.channel, bend),
            MidiMessage::Controller(note.channel, TIMBRE, timbre),
            MidiMessage::Pressure(note.channel, between(0.0, 127.0, force / self.force_n) as u8),
        ]
    }

    /// The velocity of a foot that arrives with `force` newtons, 1 to 127.
    pub(super) fn velocity(&self, force: f32) -> u8 {
        (between(0.0, 127.0, force / self.force_n) as u8).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pitch_is_that_of_the_place_wherever_the_foot_arrived() {
        let mpe = MpeSettings { from: 48, to: 72, feet: 15, force_n: 800.0 };
        for arrived in [0.0, 0.3, 0.52, 1.0] {
            let note = mpe.note(0, Vec2::new(arrived, 0.5));
            for x in [0.0, 0.25, 0.77, 1.0] {
                let [bend, timbre, pressure] = mpe.expression(note, Vec2::new(x, 0.5), 400.0);
                let MidiMessage::Bend(2, bend) = bend else { panic!("{bend:?}") };
                let pitch = f32::from(note.key) + f32::from(bend) / 8192.0 * 48.0;
                assert!((pitch - (48.0 + 24.0 * x)).abs() < 0.01, "{arrived} {x}: {pitch}");
                assert_eq!(timbre, MidiMessage::Controller(2, 74, 64));
                assert_eq!(pressure, MidiMessage::Pressure(2, 64));
            }
        }
        assert_eq!(
            [0, 14].map(|foot| mpe.note(foot, Vec2::ZERO).channel),
            [2, 16],
            "channel 1 is the zone's"
        );
        assert_eq!([f32::NAN, 0.0, 1e9].map(|force| mpe.velocity(force)), [1, 1, 127]);
    }
}
