//! The boards of a simulated floor: outputs of sensors to the readings that boards send.

use rand_pcg::Pcg64Mcg;

use super::config::SimulatedSensors;
use crate::sensor::{SensorPart, counts, normal};
use underfoot::floor::{Calibration, Floor, SensorId};
use underfoot::wire::{MAX_CHANNELS, Readings};

/// Minimum noise of a converter, even with noise-free parts (V): half a count, about the error of rounding to counts
/// (our choice). Without noise, a floor under a constant load would look frozen.
const LEAST_NOISE_V: f32 = 0.5 * Calibration::FULL_SCALE_VOLTS / 65_535.0;

/// The boards, and their current readings.
#[derive(Clone, Debug)]
pub(super) struct Boards {
    sensing: SimulatedSensors,
    /// Tile and corner behind each channel of each board.
    channels: Vec<Vec<Option<(usize, usize)>>>,
    /// Tare that a board subtracts before it sends newtons.
    tare: Vec<[f32; 4]>,
    readings: Vec<Readings>,
    noise: Pcg64Mcg,
}

impl Boards {
    /// The boards of `floor` with a tare of zero; `noise` is the source of their readings' noise.
    pub(super) fn new(floor: &Floor, sensing: SimulatedSensors, noise: Pcg64Mcg) -> Self {
        let geometry = &floor.geometry;
        let place = |sensor: &SensorId| Some((geometry.index(sensor.tile)?, sensor.corner.index()));
        let channels = floor.boards.iter().map(|board| {
            let channels = board.channels.iter().take(MAX_CHANNELS);
            channels.map(|sensor| sensor.as_ref().and_then(place)).collect()
        });
        Self {
            sensing,
            channels: channels.collect(),
            tare: vec![[0.0; 4]; geometry.tile_count()],
            readings: floor.boards.iter().map(|_| sensing.no_readings()).collect(),
            noise,
        }
    }

    /// Returns the current readings: one entry per board, one reading per channel.
    pub(super) fn readings(&self) -> &[Readings] {
        &self.readings
    }

    /// Measures the tare from the `outputs` of these `parts` on the empty floor.
    pub(super) fn tare(&mut self, outputs: &[[f32; 4]], parts: &[[SensorPart; 4]]) {
        for ((tare, outputs), parts) in self.tare.iter_mut().zip(outputs).zip(parts) {
            *tare = std::array::from_fn(|corner| newtons(&parts[corner], outputs[corner]));
        }
    }

    /// Reads the `outputs` of these `parts`.
    pub(super) fn read(&mut self, outputs: &[[f32; 4]], parts: &[[SensorPart; 4]]) {
        let noise_v = self.sensing.noise_v();
        let noise_share = self.sensing.noise_share();
        let converter_v = noise_v.max(LEAST_NOISE_V);
        let full_scale = Calibration::FULL_SCALE_VOLTS;
        for (channels, readings) in self.channels.iter().zip(&mut self.readings) {
            let outputs = channels
                .iter()
                .map(|place| place.map(|(tile, corner)| (tile, corner, outputs[tile][corner])));
            match readings {
                Readings::Counts(read) => {
                    read.clear();
                    read.extend(outputs.map(|sensor| {
                        sensor.map_or(Some(0), |(tile, corner, mut volts)| {
                            if noise_share > 0.0 {
                                let error = noise_share * normal(&mut self.noise);
                                volts = parts[tile][corner].with_force_error(volts, error);
                            }
                            Some(counts(volts + converter_v * normal(&mut self.noise)))
                        })
                    }));
                }
                // No simulated board gives counts with fractions.
                Readings::Scaled(_) => {}
                Readings::Newtons(read) => {
                    read.clear();
                    read.extend(outputs.map(|sensor| match sensor {
                        None => 0.0,
                        Some((_, _, force)) if self.sensing == SimulatedSensors::Exact => force,
                        Some((tile, corner, volts)) => {
                            let volts = (volts + noise_v * normal(&mut self.noise)).clamp(0.0, full_scale);
                            newtons(&parts[tile][corner], volts) - self.tare[tile][corner]
                        }
                    }));
                }
            }
        }
    }
}

/// Force that a board computes from `volts` with the part's law.
fn newtons(part: &SensorPart, volts: f32) -> f32 {
    part.law.force_at(volts).0
}
