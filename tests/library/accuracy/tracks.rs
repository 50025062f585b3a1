//! Position errors of one foot: the paper's figures, on a simulated floor.
//!
//! The tables are snapshots: a change that moves a figure shows up as a diff.

use std::fmt::Write;
use std::time::Duration;

use underfoot::floor::{Floor, Geometry, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Assembler, CursorPicker, Method, Sensing};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::SensorPacket;
use underfoot_sim::{self as sim, Foot, Load, Print, SimConfig, SimFloor};

/// A simulated floor with the sensing behind it.
struct Bench {
    sim: SimFloor,
    floor: Floor,
    assembler: Assembler,
    sensing: Sensing,
    millis: u32,
}

impl Bench {
    fn new(config: SimConfig, seed: u64, method: Method) -> Self {
        let wired = Floor::of(Geometry::of_paper_tiles(3, 3).unwrap());
        let sim = SimFloor::new(&wired, config, seed);
        let floor = sim::calibrated(&wired, &sim, seed).unwrap();
        Self {
            assembler: Assembler::new(&floor),
            sensing: Sensing::new(floor.geometry, method),
            sim,
            floor,
            millis: 0,
        }
    }

    /// Advances by one millisecond under these loads; returns the contacts.
    fn step(&mut self, loads: &[Load]) -> &[underfoot::sense::Contact] {
        self.millis += 1;
        let received = Instant::from_millis(self.millis.into());
        let readings = self.sim.step_under(loads.iter().copied());
        for (board, readings) in (0..).zip(readings) {
            let sequence = self.millis;
            self.assembler.take(&SensorPacket { board, sequence, received, readings: readings.clone() });
        }
        while let Some(frame) = self.assembler.ready() {
            self.sensing.update(frame);
        }
        self.sensing.contacts()
    }

    /// The error in metres of a point load that has lain still for 30 ms.
    fn error(&mut self, at: Vec2, force: Newtons) -> f32 {
        for _ in 0..5 {
            self.step(&[]);
        }
        let load = Load { print: Print::Point, position: at, heading: 0.0, force };
        for _ in 0..30 {
            self.step(&[load]);
        }
        let contacts = self.sensing.contacts();
        assert_eq!(contacts.len(), 1, "one load at {at}");
        contacts[0].centroid.distance(at)
    }

    /// A raster of points over the middle tile's plate, `margin` metres inside its edges.
    fn raster(&self, margin: f32) -> Vec<Vec2> {
        let plate = self.floor.geometry.plate(TileId::new(1, 1)).grown(-margin);
        let share = |step: u8| f32::from(step) / 14.0;
        (0..15)
            .flat_map(|row| (0..15).map(move |column| Vec2::new(share(column), share(row))))
            .map(|share| plate.min + plate.size() * share)
            .collect()
    }
}

#[test]
fn a_point_load_on_an_ideal_tile_is_found_within_a_tenth_of_a_millimetre() {
    let mut bench = Bench::new(SimConfig::ideal(), 1, Method::Eq4);
    let worst = bench.raster(0.001).into_iter().map(|at| bench.error(at, Newtons(100.0))).fold(0.0, f32::max);
    assert!(worst < 1e-4, "{worst} m");
}

/// The paper's promise for sliding feet: the centroid crosses seams without a jump.
#[test]
fn a_foot_dragged_over_a_seam_leaves_a_track_without_jumps() {
    const SPEED: f32 = 0.3;
    let mut table =
        String::from("step of the cursor beyond the foot's own, mm per ms, 0.3 m/s over a seam\n");
    for (name, config) in [("ideal", SimConfig::ideal()), ("default", SimConfig::default())] {
        for method in [Method::Eq4, Method::Tracker] {
            let mut bench = Bench::new(config, 3, method);
            let mut picker = CursorPicker::default();
            let area = bench.floor.geometry.bounds();
            let mut last = None;
            let mut worst = 0.0f32;
            for milli in 0..1500_u16 {
                // 45 cm along the middle row, from inside the first tile to inside the last, heading askew.
                let along = SPEED * f32::from(milli) * 1e-3;
                let mut foot = Foot {
                    position: Vec2::new(0.2 + along, 0.44),
                    heading: 0.4,
                    length_m: 0.26,
                    force: Newtons(120.0),
                    roll: 0.6,
                    left: false,
                };
                foot.force = Newtons(120.0 * (f32::from(milli) / 60.0).min(1.0));
                bench.step(&[foot.as_load()]);
                let now = Instant::START + Duration::from_millis(milli.into());
                let cursor = picker.update(area, bench.sensing.contacts(), now);
                // The landing is over after 100 ms.
                if milli > 100 {
                    let at = cursor.unwrap().position;
                    if let Some(before) = last {
                        worst = worst.max(at.distance(before) - SPEED * 1e-3);
                    }
                    last = Some(at);
                }
            }
            writeln!(table, "{name:8} {method:?}: {:.2}", worst * 1e3).unwrap();
            assert!(worst < 0.005, "{name}, {method:?}: {worst} m");
        }
    }
    println!("{table}");
    insta::assert_snapshot!(table);
}
