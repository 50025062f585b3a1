//! Faults that can be switched on and off while a simulated floor runs.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

use super::sensor::SensorFault;
use super::simulated::SimulatedSource;
use underfoot::floor::SensorId;
use underfoot::source::{FaultInjector, LinkFaults, SensorSource, SourceError};
use underfoot::units::Instant;
use underfoot::wire::{LinkCounters, SensorPacket};

/// Maximum number of waiting changes; the simulated floor takes them each millisecond.
const CHANGES_WAITING: usize = 256;

/// Switches the faults of a [`RehearsalSource`] from another thread.
#[derive(Clone, Debug)]
pub struct FaultSwitch(SyncSender<Change>);

#[derive(Debug)]
enum Change {
    Packets(LinkFaults),
    Sensor(SensorId, Option<SensorFault>),
}

impl FaultSwitch {
    /// Replaces the packet faults of the last call by these from now on; false if the floor has ended or stands
    /// still.
    #[must_use]
    pub fn set_packets(&self, faults: LinkFaults) -> bool {
        self.0.try_send(Change::Packets(faults)).is_ok()
    }

    /// Breaks a sensor, or repairs it with `None`; false if the floor has ended or stands still. Ignores a sensor
    /// that the floor lacks.
    #[must_use]
    pub fn set_sensor(&self, sensor: SensorId, fault: Option<SensorFault>) -> bool {
        self.0.try_send(Change::Sensor(sensor, fault)).is_ok()
    }
}

/// A simulated floor with faults that can be switched on and off while it runs, in addition to its initial ones.
#[derive(Debug)]
pub struct RehearsalSource {
    injector: FaultInjector<SimulatedSource>,
    /// The initial faults.
    planned: LinkFaults,
    changes: Receiver<Change>,
}

impl RehearsalSource {
    /// `inner` with the faults of `planned`, which stay regardless of the switch; `seed` determines the affected
    /// packets.
    #[must_use]
    pub fn new(inner: SimulatedSource, planned: LinkFaults, seed: u64) -> (Self, FaultSwitch) {
        let (sender, changes) = sync_channel(CHANGES_WAITING);
        let injector = FaultInjector::new(inner, planned.clone(), seed);
        (Self { injector, planned, changes }, FaultSwitch(sender))
    }
}

impl SensorSource for RehearsalSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        for change in self.changes.try_iter() {
            match change {
                Change::Packets(faults) => self.injector.set_faults(self.planned.clone().and(faults)),
                Change::Sensor(sensor, fault) => {
                    self.injector.inner_mut().floor_mut().set_fault(sensor, fault);
                }
            }
        }
        self.injector.next(patience)
    }

    fn now(&self) -> Instant {
        self.injector.now()
    }

    fn counters(&self) -> LinkCounters {
        self.injector.counters()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pace, SimConfig, SimFloor, feet_by_hand};
    use underfoot::floor::{Corner, Floor, TileId};
    use underfoot::source::Outage;
    use underfoot::wire::Readings;

    /// The boards of the next 100 packets.
    fn heard(source: &mut RehearsalSource) -> Vec<SensorPacket> {
        (0..100).filter_map(|_| source.next(Duration::from_millis(5)).unwrap()).collect()
    }

    #[test]
    fn a_board_is_unplugged_and_a_sensor_torn_off_until_they_are_mended() {
        let floor = Floor::default();
        let sim = SimFloor::new(&floor, SimConfig::default(), 1);
        let (_handle, nobody) = feet_by_hand();
        let inner = SimulatedSource::new(sim, Box::new(nobody), Pace::FreeRunning);
        let (mut source, switch) = RehearsalSource::new(inner, LinkFaults::default(), 1);
        let from_three = |packets: &[SensorPacket]| packets.iter().filter(|packet| packet.board == 3).count();
        assert!(from_three(&heard(&mut source)) > 10, "six boards");

        let outage = Outage { board: Some(3), from: Instant::START, until: Instant::from_micros(u64::MAX) };
        assert!(switch.set_packets(LinkFaults { outages: vec![outage], ..LinkFaults::default() }));
        assert_eq!(from_three(&heard(&mut source)), 0);
        assert!(switch.set_packets(LinkFaults::default()));
        assert!(from_three(&heard(&mut source)) > 10);

        // An open line reads nothing; the plate and the part's own weight press on all working sensors.
        let zeros = |packets: &[SensorPacket]| {
            let last = packets.iter().rfind(|packet| packet.board == 0).unwrap();
            match &last.readings {
                Readings::Counts(counts) => counts.iter().filter(|count| **count == Some(0)).count(),
                Readings::Scaled(_) | Readings::Newtons(_) => unreachable!(),
            }
        };
        let sensor = SensorId { tile: TileId::new(0, 0), corner: Corner::SouthWest };
        let sound = zeros(&heard(&mut source));
        assert!(switch.set_sensor(sensor, Some(SensorFault::Open)));
        assert_eq!(zeros(&heard(&mut source)), sound + 1);
        assert!(switch.set_sensor(sensor, None));
        assert_eq!(zeros(&heard(&mut source)), sound);
    }
}
