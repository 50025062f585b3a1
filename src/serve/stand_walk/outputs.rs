//! The outputs of all sensors, in volts, from the packets of all boards.

use std::time::Duration;

use crate::floor::{Calibration, Floor, SensorId};
use crate::units::Instant;
use crate::wire::{Readings, SensorPacket};

/// Time without a packet after which a board's sensors are unknown: the longest loss that a held control survives.
const LOST: Duration = Duration::from_millis(150);

/// The mean outputs of all sensors since the last moment.
#[derive(Clone, Debug)]
pub(super) struct VoltMeter {
    boards: Vec<MeteredBoard>,
    sensors: Vec<MeteredSensor>,
    has_newtons: bool,
}

#[derive(Clone, Debug)]
struct MeteredBoard {
    address: String,
    /// For each channel the position of its sensor.
    channels: Vec<Option<usize>>,
    last: Option<Instant>,
}

#[derive(Clone, Copy, Debug)]
struct MeteredSensor {
    id: SensorId,
    /// Sum and number of the readings since the last moment.
    sum: f64,
    count: u32,
    volts: Option<f32>,
}

impl VoltMeter {
    /// A meter of all sensors that the boards of `floor` read.
    pub(super) fn new(floor: &Floor) -> Self {
        let mut sensors: Vec<MeteredSensor> = Vec::new();
        let boards = floor.boards.iter().map(|board| {
            let channels = board.channels.iter().map(|sensor| {
                let id = sensor.filter(|sensor| floor.geometry.has(sensor.tile))?;
                sensors.push(MeteredSensor { id, sum: 0.0, count: 0, volts: None });
                Some(sensors.len() - 1)
            });
            MeteredBoard { address: board.address.clone(), channels: channels.collect(), last: None }
        });
        Self { boards: boards.collect(), sensors, has_newtons: false }
    }

    /// Adds a packet; false if its board is unknown, or has another number of channels.
    pub(super) fn take(&mut self, packet: &SensorPacket) -> bool {
        let Some(board) = self.boards.get_mut(usize::from(packet.board)) else { return false };
        if packet.readings.len() != board.channels.len() {
            return false;
        }
        board.last = Some(packet.received);
        self.has_newtons |= matches!(packet.readings, Readings::Newtons(_));
        for (channel, sensor) in board.channels.iter().enumerate() {
            let sensor = sensor.and_then(|sensor| self.sensors.get_mut(sensor));
            if let (Some(sensor), Some(volts)) = (sensor, volts(&packet.readings, channel)) {
                sensor.sum += f64::from(volts);
                sensor.count += 1;
            }
        }
        true
    }

    /// Ends a moment: the outputs since the last one. A sensor without a reading meanwhile keeps its output.
    pub(super) fn close(&mut self) {
        for sensor in &mut self.sensors {
            if sensor.count > 0 {
                sensor.volts = Some((sensor.sum / f64::from(sensor.count)) as f32);
                (sensor.sum, sensor.count) = (0.0, 0);
            }
        }
    }

    /// Output of each sensor in volts; `None` before its first reading.
    pub(super) fn volts(&self) -> impl Iterator<Item = Option<f32>> + '_ {
        self.sensors.iter().map(|sensor| sensor.volts)
    }

    /// The sensors.
    pub(super) fn sensors(&self) -> impl ExactSizeIterator<Item = SensorId> + '_ {
        self.sensors.iter().map(|sensor| sensor.id)
    }

    /// The sensors without any reading so far.
    pub(super) fn unread(&self) -> impl Iterator<Item = SensorId> + '_ {
        self.sensors
            .iter()
            .filter(|sensor| sensor.volts.is_none() && sensor.count == 0)
            .map(|sensor| sensor.id)
    }

    /// The addresses of boards with sensors that have sent nothing lately.
    pub(super) fn silent(&self, now: Instant) -> impl Iterator<Item = &str> + '_ {
        let is_silent = move |board: &&MeteredBoard| {
            board.channels.iter().any(Option::is_some) && board.last.is_none_or(|last| now.since(last) > LOST)
        };
        self.boards.iter().filter(is_silent).map(|board| board.address.as_str())
    }

    /// Whether a board sends newtons, which no law converts.
    pub(super) const fn has_newtons(&self) -> bool {
        self.has_newtons
    }
}

/// The output of one channel in volts; `None` if it is missing, not a number, or in newtons.
fn volts(readings: &Readings, channel: usize) -> Option<f32> {
    match readings {
        Readings::Counts(counts) => counts.get(channel).copied().flatten().map(Calibration::volts),
        Readings::Scaled(values) => {
            let value = values.get(channel).copied().filter(|value| value.is_finite());
            value.map(Calibration::volts_of)
        }
        Readings::Newtons(_) => None,
    }
}
