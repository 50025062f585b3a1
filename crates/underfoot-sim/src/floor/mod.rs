//! The whole simulated floor: turns feet into board readings, one millisecond at a time.

mod boards;
mod config;

use glam::Vec2;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use smallvec::SmallVec;

use super::foot::{Foot, Load, TilePart as Carried};
use super::plate::{Plate, PlatePress};
use super::seam::Seams;
use super::sensor::{PartConfig, SensorFault, SensorMemory, SensorPart};
use boards::Boards;
pub use config::{SimConfig, SimulatedSensors};
use underfoot::floor::{Calibration, Corner, Floor, Geometry, SensorId};
use underfoot::sense::TileLoad;
use underfoot::units::Newtons;
use underfoot::wire::Readings;

/// A simulated floor.
///
/// Plates and parts are drawn once, from the seed. The same floor, config, seed and feet give the same readings to
/// the bit.
#[derive(Clone, Debug)]
pub struct SimFloor {
    geometry: Geometry,
    sensing: SimulatedSensors,
    plates: Vec<Plate>,
    seams: Seams,
    parts: Vec<[SensorPart; 4]>,
    /// Support forces on the empty floor.
    rest: Vec<[f32; 4]>,
    /// Current support forces.
    forces: Vec<[f32; 4]>,
    /// Noise-free outputs on the empty floor, and current ones: volts, or newtons with exact sensing.
    rest_outputs: Vec<[f32; 4]>,
    outputs: Vec<[f32; 4]>,
    /// Memory of each sensor; empty for parts without memory.
    memories: Vec<[SensorMemory; 4]>,
    /// Milliseconds since the last update of each tile's memories.
    behind_ms: Vec<u32>,
    /// Milliseconds since the start.
    ticks: usize,
    /// Tiles that were loaded a millisecond ago; empty for parts without memory.
    left: Vec<usize>,
    faults: Vec<Faulty>,
    /// Load, first moment about the tile's centre and twist ([`PlatePress`]), for the tiles in `loaded`.
    loads: Vec<(f32, Vec2, f32)>,
    loaded: Vec<usize>,
    boards: Boards,
}

/// A broken sensor.
#[derive(Clone, Copy, Debug)]
struct Faulty {
    tile: usize,
    corner: usize,
    fault: SensorFault,
    /// Output of the sensor at the onset of the fault.
    output: f32,
}

impl SimFloor {
    /// Creates a floor with the geometry and boards of `floor`; its calibration and tare are not used.
    ///
    /// Channels of a sensor outside the geometry, and channels beyond [`underfoot::wire::MAX_CHANNELS`], are not connected.
    #[must_use]
    pub fn new(floor: &Floor, config: SimConfig, seed: u64) -> Self {
        let geometry = floor.geometry;
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let plates: Vec<_> =
            geometry.tiles().map(|tile| Plate::new(&geometry, tile, &config.plate, &mut rng)).collect();
        let part_config = match config.sensing {
            SimulatedSensors::Counts(config) | SimulatedSensors::Newtons(config) => config,
            SimulatedSensors::Exact => PartConfig::exact(),
        };
        let parts: Vec<[SensorPart; 4]> = geometry
            .tiles()
            .map(|_| std::array::from_fn(|_| SensorPart::draw(&part_config, &mut rng)))
            .collect();
        let rest: Vec<[f32; 4]> = plates.iter().map(|plate| plate.supports(PlatePress::default())).collect();
        let memories = if part_config.has_memory() {
            rest.iter().map(|supports| supports.map(SensorMemory::settled)).collect()
        } else {
            Vec::new()
        };
        let mut floor = Self {
            geometry,
            sensing: config.sensing,
            forces: rest.clone(),
            rest_outputs: vec![[0.0; 4]; rest.len()],
            outputs: vec![[0.0; 4]; rest.len()],
            loads: vec![NO_LOAD; rest.len()],
            seams: Seams::new(&geometry, &config.seam, seed),
            loaded: Vec::with_capacity(rest.len()),
            behind_ms: vec![0; rest.len()],
            ticks: 0,
            left: Vec::new(),
            plates,
            parts,
            rest,
            memories,
            faults: Vec::new(),
            boards: Boards::new(floor, config.sensing, Pcg64Mcg::from_rng(&mut rng)),
        };
        for tile in 0..floor.rest.len() {
            floor.convert(tile);
        }
        floor.rest_outputs.clone_from(&floor.outputs);
        floor.boards.tare(&floor.outputs, &floor.parts);
        floor.boards.read(&floor.outputs, &floor.parts);
        floor
    }

    /// Returns true if a reading depends on earlier loads: some part has hysteresis or creep.
    #[must_use]
    pub const fn has_memory(&self) -> bool {
        !self.memories.is_empty()
    }

    /// Returns the positions of tiles and sensors.
    #[must_use]
    pub const fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Returns the current readings: one entry per board, one reading per channel. Unconnected channels read zero.
    #[must_use]
    pub fn readings(&self) -> &[Readings] {
        self.boards.readings()
    }

    /// Advances by a millisecond with these feet on the floor, and returns the boards' readings.
    pub fn step(&mut self, feet: &[Foot]) -> &[Readings] {
        self.step_under(feet.iter().map(Foot::as_load))
    }

    /// Like [`SimFloor::step`], for any loads.
    pub fn step_under(&mut self, loads: impl IntoIterator<Item = Load>) -> &[Readings] {
        self.clear();
        for load in loads {
            for part in self.parts(&load) {
                self.put(&part);
            }
        }
        for &tile in &self.loaded {
            let (force, moment, twist) = self.loads[tile];
            self.forces[tile] = self.plates[tile].supports(PlatePress { force, at: moment / force, twist });
        }
        self.seams.leak(&mut self.forces, &self.rest, &mut self.loaded);
        if self.memories.is_empty() {
            for slot in 0..self.loaded.len() {
                self.convert(self.loaded[slot]);
            }
        } else {
            // The memory of an empty tile changes slowly, so it is updated every [`IDLE_TICKS`] milliseconds only.
            self.ticks = self.ticks.wrapping_add(1);
            for tile in 0..self.forces.len() {
                self.behind_ms[tile] += 1;
                let touched = self.loaded.contains(&tile) || self.left.contains(&tile);
                if touched || (self.ticks + tile).is_multiple_of(IDLE_TICKS) {
                    self.convert(tile);
                    self.behind_ms[tile] = 0;
                }
            }
            self.left.clear();
        }
        self.boards.read(&self.outputs, &self.parts);
        self.boards.readings()
    }

    /// Returns the true load of each tile, in tile-index order: like [`Load::on_tiles`], except that a higher plate
    /// carries more of a load on both it and a lower neighbour.
    #[must_use]
    pub fn carried(&self, load: &Load) -> SmallVec<[TileLoad; 4]> {
        self.parts(load).into_iter().map(|part| part.load).collect()
    }

    fn parts(&self, load: &Load) -> SmallVec<[Carried; 4]> {
        let mut parts = load.parts(&self.geometry);
        self.seams.share(&mut parts);
        parts
    }

    /// Returns the true support forces of the tile at `index`, including weight and mounting, in [`Corner::ALL`]
    /// order.
    #[must_use]
    pub fn support_forces(&self, index: usize) -> Option<[Newtons; 4]> {
        self.forces.get(index).map(|supports| supports.map(Newtons))
    }

    /// Breaks a sensor, or repairs it with `None`. Ignores a sensor that the floor does not have.
    pub fn set_fault(&mut self, sensor: SensorId, fault: Option<SensorFault>) {
        let Some(tile) = self.geometry.index(sensor.tile) else { return };
        let corner = sensor.corner.index();
        let output = self.outputs[tile][corner];
        self.faults.retain(|faulty| (faulty.tile, faulty.corner) != (tile, corner));
        self.faults.extend(fault.map(|fault| Faulty { tile, corner, fault, output }));
        self.rest_outputs[tile][corner] = self.output(tile, corner, self.rest[tile][corner]);
        self.outputs[tile][corner] = self.output(tile, corner, self.forces[tile][corner]);
    }

    /// Returns the part of one sensor, and its force on the empty floor.
    pub(super) fn bench(&self, tile: usize, corner: Corner) -> (&SensorPart, f32) {
        (&self.parts[tile][corner.index()], self.rest[tile][corner.index()])
    }

    /// Returns the output of one sensor on the empty floor (V), after a long rest if it has memory.
    pub(super) fn empty_volts(&self, tile: usize, corner: Corner) -> f32 {
        self.rest_outputs[tile][corner.index()]
    }

    /// Returns the support forces of one tile under `force` at `at`, relative to its centre, including weight and
    /// mounting.
    pub(super) fn pressed(&self, tile: usize, at: Vec2, force: f32) -> [f32; 4] {
        self.plates[tile].supports(PlatePress::at(force, at))
    }

    /// Standard deviation of the noise (V).
    pub(super) fn noise_v(&self) -> f32 {
        self.sensing.noise_v()
    }

    /// Returns true if the readings have no noise of their own, so that they repeat under a constant load.
    #[must_use]
    pub fn is_noiseless(&self) -> bool {
        self.noise_v() == 0.0
    }

    /// Returns the sensing model of this floor.
    #[must_use]
    pub const fn sensing(&self) -> SimulatedSensors {
        self.sensing
    }

    /// Removes all loads.
    fn clear(&mut self) {
        for tile in self.loaded.drain(..) {
            self.loads[tile] = NO_LOAD;
            self.forces[tile] = self.rest[tile];
            self.outputs[tile] = self.rest_outputs[tile];
            if !self.memories.is_empty() {
                self.left.push(tile);
            }
        }
    }

    fn put(&mut self, part: &Carried) {
        let Carried { load, lean } = part;
        let at = load.centroid - self.geometry.centre(load.tile);
        let (force, moment, twist) = &mut self.loads[load.index];
        if *force == 0.0 {
            self.loaded.push(load.index);
        }
        *force += load.force.0;
        *moment += at * load.force.0;
        *twist += load.force.0 * (at.x * at.y + lean);
    }

    /// Converts the support forces of a tile into outputs.
    fn convert(&mut self, tile: usize) {
        let mut forces = self.forces[tile];
        let elapsed_ms = self.behind_ms[tile];
        if let (Some(config), Some(memories)) = (self.sensing.parts(), self.memories.get_mut(tile)) {
            for (force, memory) in forces.iter_mut().zip(memories) {
                *force = memory.felt(*force, elapsed_ms, config);
            }
        }
        self.outputs[tile] = std::array::from_fn(|corner| self.output(tile, corner, forces[corner]));
    }

    /// Output of one sensor under `force`, including its fault.
    fn output(&self, tile: usize, corner: usize, force: f32) -> f32 {
        let part = &self.parts[tile][corner];
        let rest = self.rest[tile][corner];
        let exact = self.sensing == SimulatedSensors::Exact;
        let sound = |force: f32| if exact { force - rest } else { part.volts(force) };
        match self.faults.iter().find(|faulty| (faulty.tile, faulty.corner) == (tile, corner)) {
            None => sound(force),
            Some(Faulty { fault: SensorFault::Stuck, output, .. }) => *output,
            Some(Faulty { fault: SensorFault::Open, .. }) => 0.0,
            Some(Faulty { fault: SensorFault::Short, .. }) if exact => sound(part.law.force(u16::MAX).0),
            Some(Faulty { fault: SensorFault::Short, .. }) => 2.0 * Calibration::FULL_SCALE_VOLTS,
            Some(Faulty { fault: SensorFault::Offset(offset), .. }) => sound(force + offset.0),
        }
    }
}

/// Force, moment and twist of an empty tile.
const NO_LOAD: (f32, Vec2, f32) = (0.0, Vec2::ZERO, 0.0);

/// Milliseconds between two updates of the memories of an empty tile.
const IDLE_TICKS: usize = 8;

#[cfg(test)]
mod tests;
