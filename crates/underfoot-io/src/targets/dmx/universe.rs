//! The levels of a universe.

use underfoot::messages::{DMX_CHANNELS, DmxLevel};

/// The levels of all channels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Universe([u8; DMX_CHANNELS as usize]);

impl Default for Universe {
    /// All lights are dark.
    fn default() -> Self {
        Self([0; DMX_CHANNELS as usize])
    }
}

impl Universe {
    /// The levels, from channel 1 on.
    pub(super) const fn levels(&self) -> &[u8] {
        &self.0
    }

    /// Sets the level of a channel, or of a pair of channels; returns whether that changes it.
    pub(super) fn set(&mut self, level: DmxLevel) -> bool {
        let first = usize::from(level.channel).saturating_sub(1);
        let [upper, lower] = level.level.to_be_bytes();
        let (bytes, count) = if level.fine { ([upper, lower], 2) } else { ([lower, 0], 1) };
        let mut changes = false;
        // The reader of layouts refuses channels that a universe lacks.
        for (slot, byte) in self.0.iter_mut().skip(first).zip(bytes).take(count) {
            changes |= std::mem::replace(slot, byte) != byte;
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_stands_in_its_channel_and_a_fine_one_in_two() {
        let mut universe = Universe::default();
        let level = |channel, fine, level| DmxLevel { channel, fine, level };
        assert!(universe.set(level(1, false, 255)));
        assert!(!universe.set(level(1, false, 255)), "it has that level");
        assert!(universe.set(level(511, true, 0x1234)));
        assert_eq!(universe.levels()[..2], [255, 0]);
        assert_eq!(universe.levels()[510..], [0x12, 0x34]);
    }
}
