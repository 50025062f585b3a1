//! What one computer does, as numbers.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What one computer does: times are microseconds of one core for a millisecond of floor.
///
/// `underfoot plan` measures them, or reads them from a file, so that plans are made for other machines too.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Cores, 1 to 1024.
    pub cores: u32,
    /// What a floor at work takes whatever its size.
    pub base_us: f64,
    /// Receiving one board's packet and reading it.
    pub packet_us: f64,
    /// Forwarding one board's packet to one other computer.
    pub forward_us: f64,
    /// Waking once more in a millisecond, for what one other computer forwards.
    pub wake_us: f64,
    /// Putting one tile's readings into a frame, and looking after its sensors.
    pub assemble_tile_us: f64,
    /// Sensing a tile that carries nothing.
    pub sense_tile_us: f64,
    /// Sensing one person: usually two feet.
    pub person_us: f64,
    /// Rendering a channel that is silent.
    pub channel_us: f64,
    /// Rendering a channel that clicks and rubs, in addition.
    pub active_channel_us: f64,
    /// Channels of the sound card, 1 to 65,535.
    pub channels: u32,
    /// Megabits per second of the network card, in each direction.
    pub link_mbit: f64,
}

/// A constant of a machine that nothing can be planned with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the machine's `{name}` must be {expected}")]
pub struct MachineError {
    /// Which one.
    pub name: &'static str,
    /// Its range.
    pub expected: &'static str,
}

impl Machine {
    /// Whether every constant is in its range.
    ///
    /// # Errors
    /// [`MachineError`] names the first that is not.
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
        // NaN is in no range.
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

    /// Round numbers, so that a reader can follow the sums: 1 us a packet, 3 to wake, 0.1 a tile twice, 10 a person.
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
