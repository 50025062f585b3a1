//! Faults that the user switches on in the window, to watch their effect.

use std::collections::BTreeSet;
use std::time::Duration;

use underfoot::floor::{Floor, SensorId};
use underfoot::source::{LinkFaults, Outage};
use underfoot::units::Instant;
use underfoot_sim::{FaultSwitch, SensorFault};

/// The faults of the simulated floor.
pub(super) struct Rehearsal {
    switch: FaultSwitch,
    /// Number of boards of the floor.
    pub(super) boards: u16,
    /// The faults of the packets.
    pub(super) packets: PacketFaults,
    /// The faults of sensors.
    sensors: Vec<(SensorId, SensorFault)>,
}

/// Faults of packets, as chosen in the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct PacketFaults {
    /// Percentage of packets that are lost.
    pub(super) lost_percent: f64,
    /// Percentage of packets with a damaged number.
    pub(super) damaged_percent: f64,
    /// Maximum delay of the late half of the packets, in milliseconds.
    pub(super) late_ms: f64,
    /// Whether no packet arrives at all.
    pub(super) silent: bool,
    /// The unplugged boards.
    pub(super) unplugged: BTreeSet<u16>,
}

/// Share of late packets, if there are any.
const LATE: f64 = 0.5;

impl Rehearsal {
    pub(super) fn new(switch: FaultSwitch, floor: &Floor) -> Self {
        // The floor file numbers boards by u16, so there cannot be more.
        let boards = u16::try_from(floor.boards.len()).unwrap_or(u16::MAX);
        Self { switch, boards, packets: PacketFaults::default(), sensors: Vec::new() }
    }

    /// The number of faults that are switched on.
    pub(super) fn count(&self) -> usize {
        let PacketFaults { lost_percent, damaged_percent, late_ms, silent, unplugged } = &self.packets;
        let shares = [*lost_percent, *damaged_percent, *late_ms];
        shares.iter().filter(|share| **share > 0.0).count()
            + usize::from(*silent)
            + unplugged.len()
            + self.sensors.len()
    }

    /// The fault of `sensor`.
    pub(super) fn of_sensor(&self, sensor: SensorId) -> Option<SensorFault> {
        self.sensors.iter().find(|(broken, _)| *broken == sensor).map(|(_, fault)| *fault)
    }

    /// Sets or clears the fault of a sensor.
    pub(super) fn set_sensor(&mut self, sensor: SensorId, fault: Option<SensorFault>) {
        self.sensors.retain(|(broken, _)| *broken != sensor);
        self.sensors.extend(fault.map(|fault| (sensor, fault)));
        tell(self.switch.set_sensor(sensor, fault));
    }

    /// Applies the chosen faults of packets.
    pub(super) fn apply(&self) {
        tell(self.switch.set_packets(LinkFaults::from(&self.packets)));
    }

    /// Clears all faults.
    pub(super) fn mend(&mut self) {
        self.packets = PacketFaults::default();
        self.apply();
        for (sensor, _) in std::mem::take(&mut self.sensors) {
            tell(self.switch.set_sensor(sensor, None));
        }
    }
}

fn tell(heard: bool) {
    if !heard {
        tracing::debug!("the floor has ended and takes no faults");
    }
}

impl From<&PacketFaults> for LinkFaults {
    fn from(chosen: &PacketFaults) -> Self {
        let always = |board| Outage { board, from: Instant::START, until: Instant::from_micros(u64::MAX) };
        let outages = chosen.silent.then(|| always(None)).into_iter();
        let late = chosen.late_ms > 0.0;
        Self {
            loss: chosen.lost_percent / 100.0,
            damage: chosen.damaged_percent / 100.0,
            delay: if late { LATE } else { 0.0 },
            delay_up_to: Duration::try_from_secs_f64(chosen.late_ms / 1000.0).unwrap_or_default(),
            outages: outages.chain(chosen.unplugged.iter().map(|board| always(Some(*board)))).collect(),
            ..Self::default()
        }
    }
}
