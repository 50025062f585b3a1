use super::stream::Stream;
use super::tare::{Found, Tare, TareMeter, TareOutcome};
use crate::floor::{Calibration, Floor, SensorId};
use crate::sense::{ForceFrame, Quality};
use crate::units::Newtons;
use crate::wire::{LinkCounters, Readings};

/// How many slots may wait for their boards at once.
pub(super) const BUFFERS: usize = 4;

/// Counts from which on a sensor is near the end of its range (98 %) and reads "at least".
const SATURATED: u16 = 64225;

/// One board: its stream, its wiring, and what it read in the slots that wait.
#[derive(Clone, Debug)]
pub(super) struct BoardTrack {
    pub(super) stream: Stream,
    channels: Vec<Option<Channel>>,
    samples: [Vec<Sample>; BUFFERS],
    filled: [bool; BUFFERS],
    tare: TareState,
}

/// What one channel measures.
#[derive(Clone, Copy, Debug)]
struct Channel {
    sensor: SensorId,
    tile: usize,
    corner: usize,
    calibration: Calibration,
    tare: f32,
}

/// One reading before the tare is taken off; NaN if it was bad.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    force: f32,
    saturated: bool,
}

#[derive(Clone, Debug)]
enum TareState {
    FromFloor,
    Measuring(TareMeter),
    Taken,
    Refused(TareOutcome),
}

impl BoardTrack {
    pub(super) fn new(floor: &Floor, number: usize, tare: Tare) -> Self {
        let wiring = floor.boards.get(number).map(|board| board.channels.as_slice()).unwrap_or_default();
        let channels: Vec<_> = wiring
            .iter()
            .map(|sensor| {
                let sensor = (*sensor)?;
                let (tile, corner) = (floor.geometry.index(sensor.tile)?, sensor.corner.index());
                Some(Channel {
                    sensor,
                    tile,
                    corner,
                    calibration: floor.calibration.get(tile).map_or(Calibration::NOMINAL, |all| all[corner]),
                    tare: floor.tare.get(tile).map_or(0.0, |all| all[corner].0),
                })
            })
            .collect();
        let samples = std::array::from_fn(|_| vec![Sample::default(); channels.len()]);
        let tare = match tare {
            Tare::FromFloor => TareState::FromFloor,
            Tare::AtStart(rules) => TareState::Measuring(TareMeter::new(channels.len(), rules)),
        };
        Self { stream: Stream::default(), channels, samples, filled: [false; BUFFERS], tare }
    }

    pub(super) fn channel_count(&self) -> usize {
        self.channels.len()
    }

    pub(super) const fn has(&self, buffer: usize) -> bool {
        self.filled[buffer]
    }

    /// Stores calibrated `readings` in `buffer`, counting bad ones.
    pub(super) fn store(&mut self, buffer: usize, readings: &Readings, counters: &mut LinkCounters) {
        self.filled[buffer] = true;
        let channels = self.channels.iter().zip(&mut self.samples[buffer]);
        let mut bad = 0;
        match readings {
            Readings::Counts(counts) => {
                for ((channel, sample), &count) in channels.zip(counts) {
                    bad += u64::from(channel.is_some() && count.is_none());
                    let force = match (channel, count) {
                        (Some(channel), Some(count)) => channel.calibration.force(count).0,
                        _ => f32::NAN,
                    };
                    *sample = Sample { force, saturated: count.is_some_and(|count| count >= SATURATED) };
                }
            }
            Readings::Newtons(forces) => {
                for ((channel, sample), &force) in channels.zip(forces) {
                    bad += u64::from(channel.is_some() && !force.is_finite());
                    *sample = Sample { force, saturated: false };
                }
            }
        }
        counters.bad_readings += bad;
    }

    /// Frees `buffer` for a later slot.
    pub(super) fn clear(&mut self, buffer: usize) {
        self.filled[buffer] = false;
    }

    /// How far all of its values can be trusted.
    pub(super) fn quality(&self) -> Quality {
        if !self.stream.presence.is_live() || self.is_taring() {
            Quality::Stale
        } else if self.stream.loss.is_degraded() {
            Quality::Degraded
        } else {
            Quality::Live
        }
    }

    pub(super) const fn is_taring(&self) -> bool {
        matches!(self.tare, TareState::Measuring(_))
    }

    /// Starts averaging the tare afresh, if it is being measured.
    pub(super) fn interrupt_tare(&mut self) {
        if let TareState::Measuring(meter) = &mut self.tare {
            meter.interrupt();
        }
    }

    pub(super) fn tare_outcome(&self) -> TareOutcome {
        match self.tare {
            TareState::FromFloor => TareOutcome::FromFloor,
            TareState::Measuring(_) => TareOutcome::Measuring,
            TareState::Taken => TareOutcome::Taken,
            TareState::Refused(outcome) => outcome,
        }
    }

    /// The tare in use, sensor by sensor.
    pub(super) fn tares(&self) -> impl Iterator<Item = (usize, usize, Newtons)> + '_ {
        self.channels.iter().flatten().map(|channel| (channel.tile, channel.corner, Newtons(channel.tare)))
    }

    /// Writes what it read in `buffer` into `frame`; without a sample there, what it read last stays.
    pub(super) fn apply(&mut self, buffer: Option<usize>, at_ns: i64, frame: &mut ForceFrame) {
        let buffer = buffer.filter(|&buffer| self.filled[buffer]);
        if let Some(buffer) = buffer {
            self.measure_tare(buffer, at_ns);
        }
        let quality = self.quality();
        match buffer {
            Some(buffer) if !self.is_taring() => self.write(buffer, quality, frame),
            _ if quality == Quality::Stale => self.mark_stale(frame),
            _ => {}
        }
    }

    fn write(&self, buffer: usize, quality: Quality, frame: &mut ForceFrame) {
        for (channel, sample) in self.channels.iter().zip(&self.samples[buffer]) {
            let Some(channel) = channel else { continue };
            let force = sample.force - channel.tare;
            let own = match sample {
                _ if !force.is_finite() => Quality::Faulty,
                Sample { saturated: true, .. } => Quality::Degraded,
                Sample { saturated: false, .. } => Quality::Live,
            };
            if force.is_finite() {
                frame.forces[channel.tile][channel.corner] = force;
            }
            frame.quality[channel.tile][channel.corner] = own.max(quality);
        }
    }

    fn mark_stale(&self, frame: &mut ForceFrame) {
        for channel in self.channels.iter().flatten() {
            let quality = &mut frame.quality[channel.tile][channel.corner];
            *quality = (*quality).max(Quality::Stale);
        }
    }

    fn measure_tare(&mut self, buffer: usize, at_ns: i64) {
        let TareState::Measuring(meter) = &mut self.tare else { return };
        let used = self.channels.iter().zip(&self.samples[buffer]);
        let forces = used.map(|(channel, sample)| if channel.is_some() { sample.force } else { f32::NAN });
        match meter.add(at_ns, forces) {
            None => {}
            Some(Found::Quiet(means)) => {
                for (channel, mean) in self.channels.iter_mut().zip(means) {
                    if let (Some(channel), Some(mean)) = (channel, mean) {
                        channel.tare = mean;
                    }
                }
                self.tare = TareState::Taken;
            }
            Some(Found::Noisy { channel, mean, deviation }) => {
                let sensor = self.channels.get(channel).copied().flatten().map(|channel| channel.sensor);
                self.tare = sensor.map_or(TareState::FromFloor, |sensor| {
                    TareState::Refused(TareOutcome::Refused { sensor, mean, deviation })
                });
            }
        }
    }
}
