//! The readings of all sensors: forces, noise on the empty floor, range.

use std::time::Duration;

use underfoot::floor::{Calibration, Floor, SensorId};
use underfoot::sense::Scatter;
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorPacket};

use crate::setup::view::{SensorState, SensorView};

/// Time for which the empty floor is measured.
const REST: Duration = Duration::from_secs(1);

/// Time without a packet after which a board is silent: three packets of the slowest boards.
const SILENT: Duration = Duration::from_millis(300);

/// Standard deviation of a reading, as a share of the full scale, above which somebody walks on the floor meanwhile.
const RESTLESS: f64 = 0.02;

/// Standard deviation of a force in newtons above which somebody walks on the floor meanwhile.
const RESTLESS_N: f64 = 5.0;

/// Standard deviation of the force on the empty floor above which a sensor is noisy (N): the limit of the tare.
const NOISY_N: f32 = 0.5;

/// Force with which a sensor answers (N): more than the noise and the weight of a plate that is moved.
const ANSWER_N: f32 = 15.0;

/// Share of the full scale above which the force of a sensor is unknown.
const SATURATED: f32 = 0.98;

/// Share of a new reading in the force that is shown, at each packet.
const SMOOTH: f32 = 0.2;

/// Watches the sensors of a floor; it assumes that the floor is empty at the beginning.
#[derive(Clone, Debug)]
pub(super) struct ReadingsWatch {
    boards: Vec<WatchedBoard>,
}

#[derive(Clone, Debug)]
struct WatchedBoard {
    /// The position of each channel's sensor among those of this board.
    channels: Vec<Option<usize>>,
    sensors: Vec<WatchedSensor>,
    /// Arrival of the first packet of the rest, and of the last packet.
    first: Option<Instant>,
    last: Option<Instant>,
    is_rested: bool,
}

#[derive(Clone, Debug)]
struct WatchedSensor {
    id: SensorId,
    law: Calibration,
    /// Share of the full scale, and force, on the empty floor.
    rest: [Scatter; 2],
    force_n: f32,
    greatest: Option<f32>,
    greatest_n: f32,
}

impl ReadingsWatch {
    /// A watch over the sensors that the boards of `floor` read.
    pub(super) fn new(floor: &Floor) -> Self {
        let boards = floor.boards.iter().map(|board| {
            let mut sensors = Vec::new();
            let channels = board.channels.iter().map(|sensor| {
                let id = sensor.filter(|sensor| floor.geometry.has(sensor.tile))?;
                let (law, rest) = (floor.law(id), [Scatter::default(); 2]);
                sensors.push(WatchedSensor { id, law, rest, force_n: 0.0, greatest: None, greatest_n: 0.0 });
                Some(sensors.len() - 1)
            });
            let channels = channels.collect();
            WatchedBoard { channels, sensors, first: None, last: None, is_rested: false }
        });
        Self { boards: boards.collect() }
    }

    /// Adds a packet; ignores those of other floors.
    pub(super) fn take(&mut self, packet: &SensorPacket) {
        let Some(board) = self.boards.get_mut(usize::from(packet.board)) else { return };
        if packet.readings.len() == board.channels.len() {
            board.take(&packet.readings, packet.received);
        }
    }

    /// Whether all boards that send have been measured on the empty floor, and any sends.
    pub(super) fn is_rested(&self) -> bool {
        let mut sending = self.boards.iter().filter(|board| board.last.is_some()).peekable();
        sending.peek().is_some() && sending.all(|board| board.is_rested)
    }

    /// The sensors at `now`, board by board.
    pub(super) fn sensors(&self, now: Instant) -> impl Iterator<Item = SensorView> + '_ {
        self.boards
            .iter()
            .flat_map(move |board| board.sensors.iter().map(move |sensor| sensor.view(board, now)))
    }
}

impl WatchedBoard {
    fn take(&mut self, readings: &Readings, received: Instant) {
        let first = *self.first.get_or_insert(received);
        self.last = Some(received);
        for (channel, sensor) in self.channels.iter().enumerate() {
            let Some(sensor) = sensor.and_then(|sensor| self.sensors.get_mut(sensor)) else { continue };
            if let Some((share, force_n)) = reading(readings, channel, &sensor.law) {
                sensor.take(share, force_n, self.is_rested);
            }
        }
        if !self.is_rested && received.since(first) >= REST {
            if self.sensors.iter().any(WatchedSensor::is_restless) {
                // Somebody walks on the floor: once more.
                self.first = None;
                self.sensors.iter_mut().for_each(|sensor| sensor.rest = [Scatter::default(); 2]);
            } else {
                self.is_rested = true;
            }
        }
    }
}

impl WatchedSensor {
    fn take(&mut self, share: Option<f32>, force_n: f32, is_rested: bool) {
        let [shares, forces] = &mut self.rest;
        if is_rested {
            let above_n = force_n - forces.mean() as f32;
            self.force_n += SMOOTH * (above_n - self.force_n);
            self.greatest_n = self.greatest_n.max(self.force_n);
        } else {
            shares.add(f64::from(share.unwrap_or(0.0)));
            forces.add(f64::from(force_n));
        }
        if let Some(share) = share {
            self.greatest = Some(self.greatest.map_or(share, |greatest| greatest.max(share)));
        }
    }

    fn is_restless(&self) -> bool {
        let [shares, forces] = &self.rest;
        // Without a law, the share alone tells.
        shares.deviation() > RESTLESS || (self.greatest.is_none() && forces.deviation() > RESTLESS_N)
    }

    fn view(&self, board: &WatchedBoard, now: Instant) -> SensorView {
        let noise_n = board.is_rested.then(|| self.rest[1].deviation() as f32);
        let state = match () {
            () if board.last.is_none_or(|last| now.since(last) > SILENT) => SensorState::Silent,
            () if self.rest[1].count() == 0 => SensorState::Unread,
            () if self.greatest.is_some_and(|greatest| greatest >= SATURATED) => SensorState::Saturated,
            () if noise_n.is_some_and(|noise| noise > NOISY_N) => SensorState::Noisy,
            () if self.greatest_n >= ANSWER_N => SensorState::Answers,
            () => SensorState::Waiting,
        };
        SensorView { sensor: self.id, force_n: self.force_n, noise_n, greatest: self.greatest, state }
    }
}

/// The reading of a channel: its share of the full scale, if it is in counts, and its force by this law in newtons;
/// `None` if it is missing or not a number.
fn reading(readings: &Readings, channel: usize, law: &Calibration) -> Option<(Option<f32>, f32)> {
    let share = match readings {
        Readings::Counts(counts) => f32::from(counts.get(channel).copied().flatten()?),
        Readings::Scaled(values) => *values.get(channel)?,
        Readings::Newtons(forces) => {
            let force_n = forces.get(channel).copied().filter(|force| force.is_finite())?;
            return Some((None, force_n));
        }
    } / f32::from(u16::MAX);
    let force_n = law.force_at(share * Calibration::FULL_SCALE_VOLTS).0;
    force_n.is_finite().then_some((Some(share), force_n))
}

#[cfg(test)]
mod tests {
    use underfoot::floor::{Geometry, TileId};
    use underfoot::glam::Vec2;
    use underfoot::units::Newtons;
    use underfoot_sim::{Foot, SensorFault, SimConfig, SimFloor};

    use super::*;

    /// Passes `ms` milliseconds with a foot at `at`.
    fn pass(watch: &mut ReadingsWatch, sim: &mut SimFloor, ms: &mut u32, count: u32, at: Option<Vec2>) {
        let foot = |position| Foot {
            position,
            heading: 0.0,
            length_m: 0.1,
            force: Newtons(500.0),
            roll: 0.5,
            left: false,
        };
        let feet: Vec<Foot> = at.into_iter().map(foot).collect();
        for _ in 0..count {
            *ms += 1;
            let received = Instant::from_millis((*ms).into());
            for (board, readings) in (0..).zip(sim.step(&feet)) {
                watch.take(&SensorPacket { board, sequence: *ms, received, readings: readings.clone() });
            }
        }
    }

    #[test]
    fn the_foot_of_a_person_is_read_above_the_empty_floor_and_a_dead_sensor_is_no_answer() {
        let floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 3);
        let (mut watch, mut ms) = (ReadingsWatch::new(&floor), 0);
        let now = |ms: u32| Instant::from_millis(ms.into());
        assert!(watch.sensors(now(0)).all(|sensor| sensor.state == SensorState::Silent));
        let tile = TileId::new(1, 0);
        let dead = SensorId { tile, corner: underfoot::floor::Corner::SouthEast };
        sim.set_fault(dead, Some(SensorFault::Open));
        let middle = floor.geometry.centre(tile);
        // Somebody steps on and off while the floor should be empty.
        for _ in 0..4 {
            pass(&mut watch, &mut sim, &mut ms, 200, Some(middle));
            pass(&mut watch, &mut sim, &mut ms, 200, None);
        }
        assert!(!watch.is_rested());
        pass(&mut watch, &mut sim, &mut ms, 2500, None);
        assert!(watch.is_rested());
        let noises: Vec<f32> = watch.sensors(now(ms)).filter_map(|sensor| sensor.noise_n).collect();
        assert!(noises.len() == 8 && noises.iter().all(|noise| *noise < NOISY_N), "{noises:?}");
        pass(&mut watch, &mut sim, &mut ms, 500, Some(middle));
        for sensor in watch.sensors(now(ms)) {
            let is_loaded = sensor.sensor.tile == tile && sensor.sensor != dead;
            assert_eq!(sensor.state == SensorState::Answers, is_loaded, "{sensor:?}");
            assert_eq!(sensor.force_n > 20.0, is_loaded, "{sensor:?}");
        }
        assert!(watch.sensors(now(ms + 400)).all(|sensor| sensor.state == SensorState::Silent));
    }
}
