//! N11 swapped boards: detected from the weights of their plates.

use std::time::Duration;

use underfoot::floor::{Floor, Geometry};
use underfoot::glam::Vec2;
use underfoot::sense::{Assembler, Quality, Tare};
use underfoot::units::Instant;
use underfoot::wire::SensorPacket;
use underfoot_sim::{self as sim, Foot, SimConfig, SimFloor};

use super::bench::foot;

/// A floor of four boards under feet, for a while; `place` gives the board number under which each board sends.
struct Rows {
    sim: SimFloor,
    assembler: Assembler,
    ms: u32,
}

impl Rows {
    fn new(seed: u64) -> Self {
        let wired = Floor::of(Geometry::of_paper_tiles(5, 4).unwrap());
        let sim = SimFloor::new(&wired, SimConfig::default(), seed);
        let floor = sim::calibrated(&wired, &sim, seed).unwrap();
        Self { sim, assembler: Assembler::with_tare(&floor, Tare::FromFloor), ms: 0 }
    }

    /// The swapped boards with their places, and whether frames count as calibrated.
    fn run(&mut self, ms: u32, place: [u16; 4], feet: &[Foot]) -> (Vec<(u16, u16)>, bool) {
        let mut calibrated = true;
        for _ in 0..ms {
            self.ms += 1;
            let received = Instant::START + Duration::from_millis(self.ms.into());
            for (board, readings) in place.into_iter().zip(self.sim.step(feet)) {
                let packet = SensorPacket { board, sequence: self.ms, received, readings: readings.clone() };
                self.assembler.take(&packet);
            }
            while let Some(frame) = self.assembler.ready() {
                calibrated = frame.calibration_fault.is_none();
            }
        }
        (self.assembler.swapped().1.collect(), calibrated)
    }
}

const RIGHT: [u16; 4] = [0, 1, 2, 3];
const SWAPPED: [u16; 4] = [0, 2, 1, 3];
const BOTH: [(u16, u16); 2] = [(1, 2), (2, 1)];

#[test]
fn n11_boards_that_change_places_are_found_within_a_fifth_of_a_second_and_believed_again_when_they_are_right()
{
    for seed in 0..20 {
        let mut rows = Rows::new(seed);
        assert_eq!(rows.run(1000, RIGHT, &[]), (vec![], true), "seed {seed}");
        assert_eq!(rows.run(200, SWAPPED, &[]), (BOTH.to_vec(), false), "seed {seed}");
        let mut health = underfoot::sense::SensorHealth::default();
        rows.assembler.health(&mut health);
        assert_eq!(health.count(Quality::Faulty), 2 * 5 * 4, "seed {seed}: every sensor of both");
        assert_eq!(rows.run(200, RIGHT, &[]), (vec![], true), "seed {seed}");
    }
}

#[test]
fn n11_feet_on_the_boards_hide_nothing_and_accuse_nobody() {
    for seed in 0..10 {
        let mut rows = Rows::new(seed);
        let feet = [foot(Vec2::new(0.4, 0.45), 400.0), foot(Vec2::new(0.9, 0.75), 350.0)];
        assert_eq!(rows.run(2000, RIGHT, &feet), (vec![], true), "seed {seed}");
        assert_eq!(rows.run(400, SWAPPED, &feet), (BOTH.to_vec(), false), "seed {seed}");
        assert_eq!(rows.run(400, RIGHT, &feet), (vec![], true), "seed {seed}");
    }
}

/// Board 0 sends as 1, 1 as 2 and 2 as 0, like a bundle of cables plugged in one socket further; then all four.
#[test]
fn n11_boards_that_have_moved_on_in_a_ring_are_found_as_one() {
    for seed in 0..20 {
        let mut rows = Rows::new(seed);
        let feet = [foot(Vec2::new(0.4, 0.45), 400.0)];
        assert_eq!(rows.run(1000, RIGHT, &feet), (vec![], true), "seed {seed}");
        assert_eq!(
            rows.run(300, [1, 2, 0, 3], &feet),
            (vec![(0, 2), (1, 0), (2, 1)], false),
            "seed {seed}: whose tiles each number's readings are of"
        );
        assert_eq!(
            rows.run(300, [1, 2, 3, 0], &feet),
            (vec![(0, 3), (1, 0), (2, 1), (3, 2)], false),
            "seed {seed}"
        );
        assert_eq!(rows.run(300, [1, 0, 3, 2], &feet).0, [(0, 1), (1, 0), (2, 3), (3, 2)], "seed {seed}");
        assert_eq!(rows.run(300, RIGHT, &feet), (vec![], true), "seed {seed}");
    }
}
