//! A simulated floor with its assembler and engine, for experiments.

use std::time::Duration;

use smallvec::SmallVec;
use thiserror::Error;

use underfoot::engine::Engine;
use underfoot::feel::Cue;
use underfoot::floor::{Floor, Geometry, PositionMap, SensorId};
use underfoot::layout::Layout;
use underfoot::sense::{Assembler, ForceFrame, Method, Sensing, SensingConfig, SensorUncertainty, TileLoad};
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorPacket};
use underfoot_sim::{
    self as sim, BuildError, FloorBuild, FloorQuality, Load, MoveError, SensorFault, SimConfig, SimFloor,
    drift_zeros,
};

/// Standard deviation of a sensor's zero drift since the tare (N).
pub const OFFSET_N: f32 = 0.5;

/// Reason why an experiment can't run.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// A sensor or a tile of the simulated floor can't be measured.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A simulated person can't make a move of the experiment.
    #[error("a simulated person cannot move so: {0}")]
    Move(#[from] MoveError),
    /// The experiment's own layout is rejected.
    #[error("the experiment's layout is refused: {0}")]
    Layout(String),
}

/// A simulated floor with all processing up to the force frames: packets, calibration, tare.
#[derive(Clone, Debug)]
pub struct Rig {
    sim: SimFloor,
    geometry: Geometry,
    maps: Vec<Option<PositionMap>>,
    assembler: Assembler,
    now: Instant,
    sequence: u32,
}

impl Rig {
    /// Creates a floor of the paper's parts, drawn and calibrated in the laboratory from `seed`, with a position map
    /// for each tile; then each sensor's zero drifts by [`OFFSET_N`].
    ///
    /// # Errors
    /// [`ExperimentError::Build`] if no law fits a part, or no map a tile's presses.
    pub fn of_mapped_parts(geometry: Geometry, seed: u64) -> Result<Self, ExperimentError> {
        Self::of_quality(geometry, FloorQuality::Paper, seed)
    }

    /// Creates a floor of a given quality with calibration, position maps, drifted zeros and broken sensors.
    ///
    /// The paper's quality gives [`Rig::of_mapped_parts`], the ideal one [`Rig::ideal`].
    ///
    /// # Errors
    /// The same as [`Rig::of_mapped_parts`].
    pub fn of_quality(geometry: Geometry, quality: FloorQuality, seed: u64) -> Result<Self, ExperimentError> {
        if quality == FloorQuality::Ideal {
            return Ok(Self::ideal(geometry));
        }
        let build = FloorBuild { is_mapped: true, ..FloorBuild::of(quality, seed) };
        let (sim, floor) = build.in_use(&Floor::of(geometry))?;
        Ok(Self::over(sim, &floor))
    }

    /// Like [`Rig::of_mapped_parts`], with other plates or parts, and without position maps.
    ///
    /// # Errors
    /// [`ExperimentError::Build`] if no law fits a part.
    pub fn of_parts(geometry: Geometry, config: SimConfig, seed: u64) -> Result<Self, ExperimentError> {
        let wired = Floor::of(geometry);
        let sim = SimFloor::new(&wired, config, seed);
        let mut floor = sim::calibrated(&wired, &sim, seed).map_err(BuildError::from)?;
        drift_zeros(&mut floor, OFFSET_N, seed);
        Ok(Self::over(sim, &floor))
    }

    /// Like [`Rig::of_mapped_parts`], without position maps: the paper's floor.
    ///
    /// # Errors
    /// [`ExperimentError::Build`] if no law fits a part.
    pub fn of_calibrated_parts(geometry: Geometry, seed: u64) -> Result<Self, ExperimentError> {
        Self::of_parts(geometry, SimConfig::default(), seed)
    }

    /// Creates a floor without error.
    #[must_use]
    pub fn ideal(geometry: Geometry) -> Self {
        let floor = Floor::of(geometry);
        Self::over(SimFloor::new(&floor, SimConfig::ideal(), 0), &floor)
    }

    /// Combines the simulated floor `sim` with the calibration, tare and position maps of `floor`.
    #[must_use]
    pub fn over(sim: SimFloor, floor: &Floor) -> Self {
        let geometry = floor.geometry;
        let mut floor = floor.clone();
        floor.noiseless |= sim.is_noiseless();
        Self {
            sim,
            geometry,
            maps: floor.position_maps.clone(),
            assembler: Assembler::new(&floor),
            now: Instant::START,
            sequence: 0,
        }
    }

    /// Returns the positions of the tiles.
    #[must_use]
    pub const fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Creates the sensing for this floor's calibration, with an empty floor as its initial state.
    #[must_use]
    pub fn sensing(&self, method: Method) -> Sensing {
        self.sensing_without_maps(method).with_maps(&self.maps)
    }

    /// Creates an engine with the controls of `layout` on this floor.
    #[must_use]
    pub fn engine(&self, layout: Layout, method: Method) -> Engine {
        Engine::new(self.geometry, layout, method).with_maps(&self.maps)
    }

    /// Returns the time of the last step.
    #[must_use]
    pub const fn now(&self) -> Instant {
        self.now
    }

    /// Creates sensing with the floor's calibration, but without position maps.
    #[must_use]
    pub fn sensing_without_maps(&self, method: Method) -> Sensing {
        let uncertainty = if self.sim.has_memory() {
            SensorUncertainty::default()
        } else {
            SensorUncertainty::without_memory()
        };
        Sensing::with_config(self.geometry, method, SensingConfig { uncertainty, ..SensingConfig::default() })
    }

    /// Advances by a millisecond under `loads`, and calls `sensed` once with each frame.
    pub fn step(&mut self, loads: impl IntoIterator<Item = Load>, sensed: impl FnMut(&ForceFrame)) {
        self.step_with(&mut (), 0, loads, sensed);
    }

    /// Like [`Rig::step`], with the faults of `fault` at this millisecond of its scene.
    pub fn step_with(
        &mut self,
        fault: &mut impl FaultHook,
        milli: u64,
        loads: impl IntoIterator<Item = Load>,
        mut sensed: impl FnMut(&ForceFrame),
    ) {
        fault.before(milli, self);
        self.now = self.now + Duration::from_millis(1);
        self.sequence = self.sequence.wrapping_add(1);
        let (sequence, received) = (self.sequence, self.now);
        for (board, readings) in (0..).zip(self.sim.step_under(loads)) {
            let mut readings = readings.clone();
            fault.disturb(milli, usize::from(board), &mut readings);
            self.assembler.take(&SensorPacket { board, sequence, received, readings });
        }
        while let Some(frame) = self.assembler.ready() {
            fault.sensed(milli, frame);
            sensed(frame);
        }
    }

    /// Returns the true load of each tile; see [`SimFloor::carried`].
    #[must_use]
    pub fn carried(&self, load: &Load) -> SmallVec<[TileLoad; 4]> {
        self.sim.carried(load)
    }

    /// Breaks a sensor, or repairs it with `None`.
    pub fn set_fault(&mut self, sensor: SensorId, fault: Option<SensorFault>) {
        self.sim.set_fault(sensor, fault);
    }

    /// Returns the assembler, which turns packets into frames and monitors the sensors' health.
    #[must_use]
    pub const fn assembler(&self) -> &Assembler {
        &self.assembler
    }

    /// Advances by `millis` milliseconds under constant loads.
    pub fn hold(&mut self, millis: u32, loads: &[Load], mut sensed: impl FnMut(&ForceFrame)) {
        for _ in 0..millis {
            self.step(loads.iter().copied(), &mut sensed);
        }
    }
}

/// Faults during an experiment; by default every method does nothing.
///
/// Milliseconds count from 1 at the start of the experiment's scene.
pub trait FaultHook {
    /// Called before each millisecond; may break sensors.
    fn before(&mut self, milli: u64, rig: &mut Rig) {
        let _ = (milli, rig);
    }

    /// Called with the readings of each board before it sends them, in each millisecond.
    fn disturb(&mut self, milli: u64, board: usize, readings: &mut Readings) {
        let _ = (milli, board, readings);
    }

    /// Called with each frame before the contacts are computed.
    fn sensed(&mut self, milli: u64, frame: &ForceFrame) {
        let _ = (milli, frame);
    }

    /// Called with the cues of the tracker's engine, if there is one.
    fn felt(&mut self, milli: u64, cues: &[Cue]) {
        let _ = (milli, cues);
    }
}

/// No faults.
impl FaultHook for () {}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use underfoot::units::Newtons;
    use underfoot_sim::Print;

    fn load(force: f32) -> Load {
        Load { print: Print::Point, position: Vec2::splat(0.2), heading: 0.0, force: Newtons(force) }
    }

    fn sum(frame: &ForceFrame) -> f32 {
        frame.forces.iter().flatten().sum()
    }

    #[test]
    fn every_millisecond_gives_its_own_frame() {
        let mut rig = Rig::ideal(Geometry::of_paper_tiles(2, 3).unwrap());
        for step in 1..=50_u16 {
            let mut frames = Vec::new();
            rig.step([load(f32::from(step))], |frame| frames.push((frame.at, sum(frame).round() as u16)));
            assert_eq!(frames, [(Instant::from_millis(step.into()), step)]);
            assert_eq!(rig.now(), Instant::from_millis(step.into()));
        }
    }

    #[test]
    fn an_empty_floor_of_calibrated_parts_is_half_a_newton_off_per_sensor() {
        let geometry = Geometry::default();
        let mut rig = Rig::of_calibrated_parts(geometry, 3).unwrap();
        let mut squares = 0.0;
        rig.hold(1, &[], |frame| squares = frame.forces.iter().flatten().map(|force| force * force).sum());
        let deviation = (squares / 144.0_f32).sqrt();
        assert!((0.4..0.6).contains(&deviation), "{deviation} N over 144 sensors");
    }
}
