//! The whole simulated floor: turns feet into board readings, one millisecond at a time.

use arrayvec::ArrayVec;
use glam::Vec2;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use smallvec::SmallVec;

use super::foot::{Foot, Load, Part as Carried};
use super::plate::{Plate, PlateConfig, Press};
use super::seam::{SeamConfig, Seams};
use super::sensor::{Memory, Part, PartConfig, SensorFault, counts, normal};
use underfoot::floor::{Calibration, Corner, Floor, Geometry, SensorId};
use underfoot::sense::TileLoad;
use underfoot::units::Newtons;
use underfoot::wire::{MAX_CHANNELS, Readings};

/// Construction of a simulated floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimConfig {
    /// The plates and their mounting.
    pub plate: PlateConfig,
    /// The seams between plates.
    pub seam: SeamConfig,
    /// The boards' sensors and readings.
    pub sensing: Sensing,
}

impl SimConfig {
    /// A floor without error for first tests: plates screwed to exact sensors, boards that send newtons, no noise, no
    /// saturation, no tare.
    #[must_use]
    pub const fn ideal() -> Self {
        Self { plate: PlateConfig::ideal(), seam: SeamConfig::even(), sensing: Sensing::Exact }
    }
}

/// Sensors of a simulated floor, and the readings that its boards send.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sensing {
    /// Raw counts of parts with these tolerances.
    Counts(PartConfig),
    /// Newtons from boards that know the exponential law of each part and have tared themselves on the empty floor.
    /// The parts' deviation from the law, noise and saturation remain.
    Newtons(PartConfig),
    /// Newtons without error: the force on each sensor minus its force on the empty floor.
    Exact,
}

impl Default for Sensing {
    /// Raw counts of the paper's parts.
    fn default() -> Self {
        Self::Counts(PartConfig::default())
    }
}

/// A simulated floor.
///
/// Plates and parts are drawn once, from the seed. The same floor, config, seed and feet give the same readings to
/// the bit.
#[derive(Clone, Debug)]
pub struct SimFloor {
    geometry: Geometry,
    sensing: Sensing,
    plates: Vec<Plate>,
    seams: Seams,
    parts: Vec<[Part; 4]>,
    /// Support forces on the empty floor.
    rest: Vec<[f32; 4]>,
    /// Current support forces.
    forces: Vec<[f32; 4]>,
    /// Noise-free outputs on the empty floor, and current ones: volts, or newtons with exact sensing.
    rest_outputs: Vec<[f32; 4]>,
    outputs: Vec<[f32; 4]>,
    /// Tare that a board subtracts before it sends newtons.
    board_tare: Vec<[f32; 4]>,
    /// Memory of each sensor; empty for parts without memory.
    memories: Vec<[Memory; 4]>,
    /// Milliseconds since the last update of each tile's memories.
    behind_ms: Vec<u32>,
    /// Milliseconds since the start.
    ticks: usize,
    /// Tiles that were loaded a millisecond ago; empty for parts without memory.
    left: Vec<usize>,
    faults: Vec<Faulty>,
    /// Load, first moment about the tile's centre and twist ([`Press`]), for the tiles in `loaded`.
    loads: Vec<(f32, Vec2, f32)>,
    loaded: Vec<usize>,
    /// Tile and corner behind each channel of each board.
    channels: Vec<Vec<Option<(usize, usize)>>>,
    readings: Vec<Readings>,
    noise: Pcg64Mcg,
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
    /// Channels of a sensor outside the geometry, and channels beyond [`MAX_CHANNELS`], are not connected.
    #[must_use]
    pub fn new(floor: &Floor, config: SimConfig, seed: u64) -> Self {
        let geometry = floor.geometry;
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let plates: Vec<_> =
            geometry.tiles().map(|_| Plate::new(&geometry, &config.plate, &mut rng)).collect();
        let part_config = match config.sensing {
            Sensing::Counts(config) | Sensing::Newtons(config) => config,
            Sensing::Exact => PartConfig::exact(),
        };
        let parts: Vec<[Part; 4]> =
            geometry.tiles().map(|_| std::array::from_fn(|_| Part::draw(&part_config, &mut rng))).collect();
        let rest: Vec<[f32; 4]> = plates.iter().map(|plate| plate.supports(Press::default())).collect();
        let memories = if part_config.has_memory() {
            rest.iter().map(|supports| supports.map(Memory::settled)).collect()
        } else {
            Vec::new()
        };
        let channels = floor
            .boards
            .iter()
            .map(|board| {
                let place = |sensor: &SensorId| Some((geometry.index(sensor.tile)?, sensor.corner.index()));
                board
                    .channels
                    .iter()
                    .take(MAX_CHANNELS)
                    .map(|sensor| sensor.as_ref().and_then(place))
                    .collect()
            })
            .collect();
        let mut floor = Self {
            geometry,
            sensing: config.sensing,
            forces: rest.clone(),
            rest_outputs: vec![[0.0; 4]; rest.len()],
            outputs: vec![[0.0; 4]; rest.len()],
            board_tare: vec![[0.0; 4]; rest.len()],
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
            channels,
            readings: floor.boards.iter().map(|_| config.sensing.no_readings()).collect(),
            noise: Pcg64Mcg::from_rng(&mut rng),
        };
        for tile in 0..floor.rest.len() {
            floor.convert(tile);
        }
        floor.rest_outputs.clone_from(&floor.outputs);
        for (tile, tare) in floor.board_tare.iter_mut().enumerate() {
            *tare = std::array::from_fn(|corner| {
                newtons(&floor.parts[tile][corner], floor.outputs[tile][corner])
            });
        }
        floor.read_boards();
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
        &self.readings
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
            self.forces[tile] = self.plates[tile].supports(Press { force, at: moment / force, twist });
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
        self.read_boards();
        &self.readings
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
    pub(super) fn bench(&self, tile: usize, corner: Corner) -> (&Part, f32) {
        (&self.parts[tile][corner.index()], self.rest[tile][corner.index()])
    }

    /// Returns the output of one sensor on the empty floor (V), after a long rest if it has memory.
    pub(super) fn empty_volts(&self, tile: usize, corner: Corner) -> f32 {
        self.rest_outputs[tile][corner.index()]
    }

    /// Returns the support forces of one tile under `force` at `at`, relative to its centre, including weight and
    /// mounting.
    pub(super) fn pressed(&self, tile: usize, at: Vec2, force: f32) -> [f32; 4] {
        self.plates[tile].supports(Press::at(force, at))
    }

    /// Standard deviation of the noise (V).
    pub(super) fn noise_v(&self) -> f32 {
        match self.sensing {
            Sensing::Counts(config) | Sensing::Newtons(config) => config.noise_v,
            Sensing::Exact => 0.0,
        }
    }

    /// Returns true if the readings have no noise of their own, so that they repeat under a constant load.
    #[must_use]
    pub fn is_noiseless(&self) -> bool {
        self.noise_v() == 0.0
    }

    /// Returns the sensing model of this floor.
    #[must_use]
    pub const fn sensing(&self) -> Sensing {
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
        let exact = self.sensing == Sensing::Exact;
        let sound = |force: f32| if exact { force - rest } else { part.volts(force) };
        match self.faults.iter().find(|faulty| (faulty.tile, faulty.corner) == (tile, corner)) {
            None => sound(force),
            Some(Faulty { fault: SensorFault::Stuck, output, .. }) => *output,
            Some(Faulty { fault: SensorFault::Open, .. }) => 0.0,
            Some(Faulty { fault: SensorFault::Short, .. }) if exact => {
                sound(part.law.newtons(Calibration::volts(u16::MAX)))
            }
            Some(Faulty { fault: SensorFault::Short, .. }) => 2.0 * Calibration::FULL_SCALE_VOLTS,
            Some(Faulty { fault: SensorFault::Offset(offset), .. }) => sound(force + offset.0),
        }
    }

    fn read_boards(&mut self) {
        let noise_v = self.noise_v();
        let converter_v = noise_v.max(LEAST_NOISE_V);
        let full_scale = Calibration::FULL_SCALE_VOLTS;
        for (channels, readings) in self.channels.iter().zip(&mut self.readings) {
            let outputs = channels
                .iter()
                .map(|place| place.map(|(tile, corner)| (tile, corner, self.outputs[tile][corner])));
            match readings {
                Readings::Counts(read) => {
                    read.clear();
                    read.extend(outputs.map(|sensor| {
                        sensor.map_or(Some(0), |(_, _, volts)| {
                            Some(counts(volts + converter_v * normal(&mut self.noise)))
                        })
                    }));
                }
                Readings::Newtons(read) => {
                    read.clear();
                    read.extend(outputs.map(|sensor| match sensor {
                        None => 0.0,
                        Some((_, _, force)) if self.sensing == Sensing::Exact => force,
                        Some((tile, corner, volts)) => {
                            let volts = (volts + noise_v * normal(&mut self.noise)).clamp(0.0, full_scale);
                            newtons(&self.parts[tile][corner], volts) - self.board_tare[tile][corner]
                        }
                    }));
                }
            }
        }
    }
}

impl Sensing {
    const fn parts(&self) -> Option<&PartConfig> {
        match self {
            Self::Counts(config) | Self::Newtons(config) => Some(config),
            Self::Exact => None,
        }
    }

    const fn no_readings(&self) -> Readings {
        match self {
            Self::Counts(_) => Readings::Counts(ArrayVec::new_const()),
            Self::Newtons(_) | Self::Exact => Readings::Newtons(ArrayVec::new_const()),
        }
    }
}

/// Minimum noise of a converter, even with noise-free parts (V): half a count, about the error of rounding to counts
/// (our choice). Without noise, a floor under a constant load would look frozen.
const LEAST_NOISE_V: f32 = 0.5 * Calibration::FULL_SCALE_VOLTS / 65_535.0;

/// Force, moment and twist of an empty tile.
const NO_LOAD: (f32, Vec2, f32) = (0.0, Vec2::ZERO, 0.0);

/// Milliseconds between two updates of the memories of an empty tile.
const IDLE_TICKS: usize = 8;

/// Force that a board computes from `volts` with the part's law.
fn newtons(part: &Part, volts: f32) -> f32 {
    part.law.newtons(volts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Print;
    use underfoot::floor::TileId;

    fn foot(position: Vec2, force: f32) -> Foot {
        Foot { position, heading: 0.2, length_m: 0.27, force: Newtons(force), roll: 0.4, left: false }
    }

    /// Total force and centroid of everything on the floor, from the readings in newtons.
    fn sensed(floor: &Floor, readings: &[Readings]) -> (f32, Vec2) {
        let (mut force, mut moment) = (0.0, Vec2::ZERO);
        for (board, readings) in floor.boards.iter().zip(readings) {
            let Readings::Newtons(newtons) = readings else { panic!("a board that sends newtons") };
            for (sensor, newtons) in board.channels.iter().flatten().zip(newtons) {
                force += newtons;
                moment += floor.geometry.sensor(sensor.tile, sensor.corner) * *newtons;
            }
        }
        (force, moment / force)
    }

    fn all_counts(readings: &[Readings]) -> Vec<u16> {
        let counts = |board: &Readings| match board {
            Readings::Counts(counts) => counts.iter().map(|count| count.unwrap()).collect::<Vec<_>>(),
            Readings::Newtons(_) => panic!("a board that sends counts"),
        };
        readings.iter().flat_map(counts).collect()
    }

    #[test]
    fn an_ideal_floor_places_a_point_within_a_tenth_of_a_millimetre_wherever_it_presses() {
        let floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
        for x in 0..=30 {
            for y in 0..=30 {
                let position = Vec2::new(x as f32, y as f32) * (0.3039 / 30.0);
                let point = Load { print: Print::Point, position, heading: 0.0, force: Newtons(100.0) };
                let (force, at) = sensed(&floor, sim.step_under([point]));
                assert!((force - 100.0).abs() < 1e-3, "{force}");
                assert!(at.distance(position) < 1e-4, "{at} for {position}");
            }
        }
    }

    #[test]
    fn an_ideal_floor_feels_a_foot_across_four_tiles_as_one_centre_of_pressure() {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
        let foot = foot(Vec2::new(0.62, 0.59), 700.0);
        let (force, at) = sensed(&floor, sim.step(&[foot]));
        assert!((force - 700.0).abs() < 0.01);
        assert!(at.distance(foot.centre_of_pressure()) < 1e-4, "{at}");
        let (force, _) = sensed(&floor, sim.step(&[]));
        assert!(force.abs() < 1e-3, "nothing is left behind: {force}");
    }

    #[test]
    fn two_feet_on_one_tile_press_together() {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::ideal(), 1);
        let feet = [foot(Vec2::new(0.86, 1.0), 300.0), foot(Vec2::new(0.97, 1.0), 500.0)];
        let (force, at) = sensed(&floor, sim.step(&feet));
        let expected = (feet[0].centre_of_pressure() * 300.0 + feet[1].centre_of_pressure() * 500.0) / 800.0;
        assert!((force - 800.0).abs() < 0.01 && at.distance(expected) < 1e-4, "{force} at {at}");
    }

    #[test]
    fn standing_fits_the_converters_and_stamping_on_a_corner_saturates() {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 4);
        // 70 kg on one foot at the centre of a tile.
        let middle = floor.geometry.centre(TileId::new(2, 2));
        let counts = all_counts(sim.step(&[foot(middle, 690.0)]));
        assert!(counts.iter().all(|&count| count < u16::MAX));
        // A stamp of twice the body weight with the forefoot on a corner.
        let corner = floor.geometry.sensor(TileId::new(2, 2), Corner::NorthEast);
        let stamp = Load {
            print: Print::Disc { radius_m: 0.03 },
            position: corner - 0.02,
            heading: 0.0,
            force: Newtons(1400.0),
        };
        let counts = all_counts(sim.step_under([stamp]));
        assert_eq!(counts.iter().filter(|&&count| count == u16::MAX).count(), 1);
    }

    #[test]
    fn same_seed_same_counts_other_seed_other_floor() {
        let floor = Floor::default();
        let run = |seed| {
            let mut sim = SimFloor::new(&floor, SimConfig::default(), seed);
            (0..50)
                .map(|step| all_counts(sim.step(&[foot(Vec2::new(0.3 + 0.02 * step as f32, 0.9), 700.0)])))
                .collect::<Vec<_>>()
        };
        assert_eq!(run(9), run(9));
        assert_ne!(run(9), run(10));
    }

    #[test]
    fn noise_is_two_millivolts_on_every_sensor() {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 2);
        let samples: Vec<f32> =
            (0..2000).map(|_| Calibration::volts(all_counts(sim.step(&[]))[17])).collect();
        let mean = samples.iter().sum::<f32>() / 2000.0;
        let deviation = (samples.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 2000.0).sqrt();
        assert!((deviation - 0.002).abs() < 0.0002, "{deviation}");
    }

    #[test]
    fn boards_that_know_their_parts_send_tared_newtons_within_a_few_percent() {
        let floor = Floor::default();
        let config = SimConfig { sensing: Sensing::Newtons(PartConfig::default()), ..SimConfig::default() };
        let mut sim = SimFloor::new(&floor, config, 2);
        let (empty, _) = sensed(&floor, sim.step(&[]));
        // 144 sensors with 2 mV of noise at 11 N: about 0.03 N each.
        assert!(empty.abs() < 2.0, "{empty}");
        let foot = foot(Vec2::new(0.9, 0.75), 400.0);
        let (force, at) = sensed(&floor, sim.step(&[foot]));
        assert!((force / 400.0 - 1.0).abs() < 0.15, "{force}");
        assert!(at.distance(foot.centre_of_pressure()) < 0.03, "{at}");
    }

    #[test]
    fn broken_sensors_read_what_their_fault_says_until_repaired() {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 2);
        let tile = TileId::new(1, 0);
        let on_tile = foot(floor.geometry.centre(tile), 600.0);
        let sensor = |corner| SensorId { tile, corner };
        let before = all_counts(sim.step(&[]));
        sim.set_fault(sensor(Corner::SouthWest), Some(SensorFault::Stuck));
        sim.set_fault(sensor(Corner::SouthEast), Some(SensorFault::Open));
        sim.set_fault(sensor(Corner::NorthWest), Some(SensorFault::Short));
        sim.set_fault(sensor(Corner::NorthEast), Some(SensorFault::Offset(Newtons(50.0))));
        let read = |counts: &[u16]| [counts[4], counts[5], counts[6], counts[7]];
        let empty = read(&all_counts(sim.step(&[])));
        let loaded = read(&all_counts(sim.step(&[on_tile])));
        assert!(
            loaded[0].abs_diff(before[4]) < 200,
            "stuck, apart from noise: {loaded:?}, was {}",
            before[4]
        );
        assert!(loaded[1] < 200 && loaded[2] == u16::MAX, "{loaded:?}");
        assert!(empty[3] > before[7] + 5000, "50 N more on the empty floor: {empty:?}");
        for corner in Corner::ALL {
            sim.set_fault(sensor(corner), None);
        }
        let repaired = read(&all_counts(sim.step(&[])));
        assert!(repaired.iter().zip(&before[4..]).all(|(now, then)| now.abs_diff(*then) < 200));
        sim.set_fault(
            SensorId { tile: TileId::new(99, 0), corner: Corner::NorthEast },
            Some(SensorFault::Open),
        );
    }

    #[test]
    fn parts_with_memory_keep_a_trace_of_the_foot_that_left() {
        let floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        let parts = PartConfig { noise_v: 0.0, ..PartConfig::default() }.with_memory();
        let mut sim =
            SimFloor::new(&floor, SimConfig { sensing: Sensing::Counts(parts), ..SimConfig::default() }, 2);
        let before = all_counts(sim.step(&[]));
        for _ in 0..3000 {
            sim.step(&[foot(Vec2::splat(0.152), 700.0)]);
        }
        let after = all_counts(sim.step(&[]));
        assert!(
            after.iter().zip(&before).all(|(after, before)| after > before),
            "{after:?} after {before:?}"
        );
    }

    #[test]
    fn channels_without_a_sensor_read_zero() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        floor.boards[0].channels[3] = None;
        floor.boards[0].channels[4] = Some(SensorId { tile: TileId::new(9, 9), corner: Corner::SouthWest });
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 2);
        let counts = all_counts(sim.step(&[foot(Vec2::splat(0.304), 700.0)]));
        assert_eq!((counts[3], counts[4]), (0, 0));
        assert_eq!(counts.len(), 8);
        assert_ne!(counts[6], 0);
    }
}
