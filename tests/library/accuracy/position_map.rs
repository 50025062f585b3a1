//! Position error of one foot with and without position maps, on simulated floors calibrated by our own procedure.
//!
//! The table is a snapshot: a change that moves a figure shows up as a diff.

use std::fmt::Write;

use underfoot::floor::{Corner, Floor, Geometry, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Assembler, Method, Quality, Sensing};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::SensorPacket;
use underfoot_sim::{self as sim, Load, PartConfig, Print, SensorFault, SimConfig, SimFloor};

/// One simulated floor, read through its calibration twice: without and with maps.
struct Bench {
    sim: SimFloor,
    geometry: Geometry,
    assembler: Assembler,
    sensing: [Sensing; 2],
    millis: u32,
}

impl Bench {
    /// Default parts, calibrated and mapped; then every sensor's zero drifts by half a newton (standard deviation),
    /// as on a floor tared in the morning.
    fn new(seed: u64, method: Method) -> Self {
        let wired = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        let config = SimConfig {
            sensing: sim::SimulatedSensors::Counts(PartConfig::default()),
            ..SimConfig::default()
        };
        let mut sim = SimFloor::new(&wired, config, seed);
        let floor = sim::calibrated(&wired, &sim, seed).unwrap();
        let floor = sim::mapped(&floor, &sim, seed).unwrap();
        let plain = Sensing::new(floor.geometry, method);
        for (corner, offset) in Corner::ALL.into_iter().zip(offsets(seed)) {
            let sensor = SensorId { tile: TileId::new(0, 0), corner };
            sim.set_fault(sensor, Some(SensorFault::Offset(Newtons(offset))));
        }
        Self {
            assembler: Assembler::new(&floor),
            sensing: [plain.clone(), plain.with_maps(&floor.position_maps)],
            geometry: floor.geometry,
            sim,
            millis: 0,
        }
    }

    /// Errors in metres of a point load that has lain still for 30 ms, without and with the map; and whether no
    /// sensor was at the end of its range.
    fn errors(&mut self, at: Vec2, force: f32) -> ([f32; 2], bool) {
        let load = Load { print: Print::Point, position: at, heading: 0.0, force: Newtons(force) };
        for pressed in [false, true] {
            // A tile that becomes unloaded at once is uncertain for 100 ms.
            for milli in 1..=if pressed { 30_u8 } else { 110 } {
                self.millis += 1;
                // No load comes at once: it lands within 5 ms.
                let landed = Load { force: Newtons(force * (0.2 * f32::from(milli)).min(1.0)), ..load };
                let readings = self.sim.step_under(pressed.then_some(landed));
                let received = Instant::from_millis(self.millis.into());
                for (board, readings) in (0..).zip(readings) {
                    let sequence = self.millis;
                    let readings = readings.clone();
                    self.assembler.take(&SensorPacket { board, sequence, received, readings });
                }
                while let Some(frame) = self.assembler.ready() {
                    for sensing in &mut self.sensing {
                        sensing.update(frame);
                    }
                }
            }
        }
        let contacts = [0, 1].map(|sensing| {
            let contacts = self.sensing[sensing].contacts();
            assert_eq!(contacts.len(), 1, "one load at {at}");
            &contacts[0]
        });
        let is_live = contacts[1].quality == Quality::Live;
        (contacts.map(|contact| contact.centroid.distance(at)), is_live)
    }

    /// 15 x 15 points over the tile's plate, up to 5 mm from its edges; not those pressed for the map.
    fn raster(&self) -> Vec<Vec2> {
        let plate = self.geometry.plate(TileId::new(0, 0)).grown(-0.005);
        let share = |step: u8| f32::from(step) / 14.0;
        (0..15)
            .flat_map(|row| (0..15).map(move |column| Vec2::new(share(column), share(row))))
            .map(|share| plate.min + plate.size() * share)
            .collect()
    }
}

/// Four draws with a standard deviation of 0.5 N.
fn offsets(seed: u64) -> [f32; 4] {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(seed ^ 0x0ff5e7);
    let normal = Normal::new(0.0, 0.5).unwrap();
    std::array::from_fn(|_| normal.sample(&mut rng))
}

/// The error within which a share of the sorted errors lies, in centimetres.
fn percentile(errors: &[f32], share: f32) -> f32 {
    errors[((errors.len() - 1) as f32 * share).round() as usize] * 100.0
}

/// Sorted errors on some floors: without a map, with it, and with it and no saturated sensor.
fn errors_on(seeds: impl Iterator<Item = u64>, method: Method, force: f32) -> [Vec<f32>; 3] {
    let mut errors = [Vec::new(), Vec::new(), Vec::new()];
    for seed in seeds {
        let mut bench = Bench::new(seed, method);
        for at in bench.raster() {
            let ([plain, mapped], is_live) = bench.errors(at, force);
            errors[0].push(plain);
            errors[1].push(mapped);
            errors[2].extend(is_live.then_some(mapped));
        }
    }
    errors.map(|mut errors| {
        errors.sort_by(f32::total_cmp);
        errors
    })
}

#[test]
fn a_position_map_brings_a_point_load_closer_everywhere() {
    // Different floors from those for which the fit's constants were chosen, 1 to 40.
    const FLOORS: std::ops::RangeInclusive<u64> = 101..=140;
    let mut table = String::from("centroid error over one whole tile, 40 tiles, zeros off by 0.5 N, cm\n");
    table += "              without map               with map              with map, none saturated\n";
    table += "force_n    median  p95   worst      median  p95   worst      median  p95   worst  points\n";
    for force in [50.0, 100.0, 200.0, 400.0] {
        let errors = errors_on(FLOORS, Method::Eq4, force);
        let share = 100.0 * errors[2].len() as f32 / errors[1].len() as f32;
        let figures = errors.map(|errors| [0.5, 0.95, 1.0].map(|share| percentile(&errors, share)));
        let [plain, mapped, live] =
            figures.map(|[median, p95, worst]| format!("{median:<6.2}  {p95:<4.2}  {worst:<5.2}"));
        writeln!(table, "{force:7}    {plain}      {mapped}      {live}  {share:5.1} %").unwrap();
        assert!(
            figures[0][1] < 2.5 && figures[0][2] < 5.0,
            "without a map as in the paper: {plain} at {force} N"
        );
        // The goals of the project; a saturated sensor gives a lower bound, and no map can correct it.
        let [median, p95, worst] = figures[2];
        assert!(median <= 0.4 && p95 <= 1.0 && worst <= 2.0, "{live} at {force} N");
    }
    println!("{table}");
    insta::assert_snapshot!(table);
}

#[test]
fn the_tracker_gains_from_the_map_as_well() {
    let [plain, mapped, _] = errors_on(101..=105, Method::Tracker, 100.0);
    let [plain, mapped] = [plain, mapped].map(|errors| percentile(&errors, 0.95));
    assert!(mapped < 0.6 && plain > 2.0 * mapped, "{plain} cm without, {mapped} cm with");
}
