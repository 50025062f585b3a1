//! Performance of one computer, as constants.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Performance of one computer. Times are microseconds of one core per millisecond of floor time.
///
/// `underfoot plan` measures them, or reads them from a file, so that you can plan for other machines too.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Number of cores, 1 to 1024.
    pub cores: u32,
    /// Fixed time of a running floor, independent of its size.
    pub base_us: f64,
    /// Time to receive and decode one board packet.
    pub packet_us: f64,
    /// Time to forward one board packet to one other computer.
    pub forward_us: f64,
    /// Time of one more wake-up per millisecond, for the packets that one other computer forwards.
    pub wake_us: f64,
    /// Time to put one tile's readings into a frame and to monitor its sensors.
    pub assemble_tile_us: f64,
    /// Time to sense a tile without load.
    pub sense_tile_us: f64,
    /// Time to sense one person: usually two feet.
    pub person_us: f64,
    /// Time to render a silent channel.
    pub channel_us: f64,
    /// Additional time to render a channel with clicks and friction.
    pub active_channel_us: f64,
    /// Number of channels of the sound card, 1 to 65,535.
    pub channels: u32,
    /// Bandwidth of the network card in each direction (Mb/s).
    pub link_mbit: f64,
}

/// Error: a constant of a machine is out of its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the machine's `{name}` must be {expected}")]
pub struct MachineError {
    /// Name of the constant.
    pub name: &'static str,
    /// Range of the constant.
    pub expected: &'static str,
}

impl Machine {
    /// Checks that every constant is in its range.
    ///
    /// # Errors
    /// Returns [`MachineError`] with the name of the first constant out of its range.
    pub fn check(&self) -> Result<(), MachineError> {
        let times = [
            ("base_us", self.base_us),
            ("packet_us", self.packet_us),
            ("forward_us", self.forward_us),
            ("wake_us", self.wake_us),
            ("assemble_tile_us", self.assemble_tile_us),
            ("sense_tile_us", self.sense_tile_us),
            ("person_us", self.person_us),
            ("channel_us", self.channel_us),
            ("active_channel_us", self.active_channel_us),
        ];
        // NaN is outside every range.
        if let Some((name, _)) = times.into_iter().find(|(_, time)| !(0.0..=1e6).contains(time)) {
            return Err(MachineError { name, expected: "0 to 1,000,000 microseconds" });
        }
        if !(1..=1024).contains(&self.cores) {
            return Err(MachineError { name: "cores", expected: "1 to 1024" });
        }
        if !(1..=65_535).contains(&self.channels) {
            return Err(MachineError { name: "channels", expected: "1 to 65,535" });
        }
        if !(1.0..=1e7).contains(&self.link_mbit) {
            return Err(MachineError { name: "link_mbit", expected: "1 to 10,000,000" });
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Round numbers, easy to add up: 1 us per packet, 3 us per wake-up, 0.1 us per tile twice, 10 us per person.
    pub(in crate::plan) const ROUND: Machine = Machine {
        cores: 2,
        base_us: 20.0,
        packet_us: 1.0,
        forward_us: 0.5,
        wake_us: 3.0,
        assemble_tile_us: 0.1,
        sense_tile_us: 0.1,
        person_us: 10.0,
        channel_us: 1.0,
        active_channel_us: 2.0,
        channels: 64,
        link_mbit: 1000.0,
    };

    #[test]
    fn constants_out_of_their_range_are_named() {
        assert_eq!(ROUND.check(), Ok(()));
        let name = |machine: Machine| machine.check().unwrap_err().name;
        for wrong in [f64::NAN, f64::INFINITY, -1.0, 2e6] {
            assert_eq!(name(Machine { person_us: wrong, ..ROUND }), "person_us", "{wrong}");
        }
        assert_eq!(name(Machine { cores: 0, ..ROUND }), "cores");
        assert_eq!(name(Machine { channels: 70_000, ..ROUND }), "channels");
        assert_eq!(name(Machine { link_mbit: 0.0, ..ROUND }), "link_mbit");
    }
}
