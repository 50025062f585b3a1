//! Between packets and contacts a running floor allocates no memory, with any faults: it may run for months.

#[cfg(feature = "threads")]
use std::num::NonZeroUsize;

#[cfg(feature = "threads")]
use crate::sense_support::Crowd;
use crate::sense_support::{Sensors, walk};
use assert_no_alloc::{assert_no_alloc, violation_count};
use underfoot::floor::{Corner, Floor, Geometry, SensorId};
#[cfg(feature = "threads")]
use underfoot::parallel::ThreadPool;
#[cfg(feature = "threads")]
use underfoot::sense::ForceFrame;
use underfoot::sense::{Assembler, Method, Sensing};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::SensorPacket;
use underfoot_lab::experiment::DrawnVisit;
use underfoot_sim::{self as sim, Foot, SensorFault, SimConfig, SimFloor};

#[test]
fn people_on_a_mapped_floor_whose_sensors_break_allocate_nothing() {
    let wired = Floor::default();
    let mut sim = SimFloor::new(&wired, SimConfig::default(), 2);
    let floor = sim::mapped(&sim::calibrated(&wired, &sim, 2).unwrap(), &sim, 2).unwrap();
    let visit = DrawnVisit::of(2, &Geometry::default()).unwrap();
    let mut assembler = Assembler::new(&floor);
    let mut ways = [Method::Eq4, Method::Tracker]
        .map(|method| Sensing::new(floor.geometry, method).with_maps(&floor.position_maps));
    let sensor = |column, row, corner| SensorId { tile: underfoot::floor::TileId::new(column, row), corner };
    let faults = [
        (4000, sensor(3, 3, Corner::NorthEast), SensorFault::Stuck),
        (5000, sensor(1, 1, Corner::SouthWest), SensorFault::Open),
        (6000, sensor(2, 2, Corner::SouthEast), SensorFault::Short),
        (7000, sensor(4, 4, Corner::NorthWest), SensorFault::Offset(Newtons(60.0))),
    ];
    let (mut sequence, mut frames, mut feet) = (0, 0, Vec::<Foot>::new());
    let length = visit.script().duration().as_millis() as u64;
    // Two passes, of which the first is for warming up.
    for ms in 1..2 * length {
        feet.clear();
        visit.script().feet_at(Instant::from_millis(ms % length), &mut feet);
        for (at, sensor, fault) in faults {
            if ms == at || ms == length + at {
                sim.set_fault(sensor, Some(fault));
            }
            if ms == length - 1 {
                sim.set_fault(sensor, None);
            }
        }
        sequence += 1;
        let readings = sim.step(&feet);
        let received = Instant::from_millis(ms);
        let packets: Vec<_> = (0..)
            .zip(readings)
            .map(|(board, readings)| SensorPacket { board, sequence, received, readings: readings.clone() })
            .collect();
        let mut work = || {
            for packet in &packets {
                assembler.take(packet);
            }
            while let Some(frame) = assembler.ready() {
                frames += 1;
                for sensing in &mut ways {
                    sensing.update(frame);
                }
            }
        };
        if ms < length {
            work();
        } else {
            assert_no_alloc(work);
        }
    }
    assert_eq!(violation_count(), 0);
    assert!(frames > 20_000, "{frames}");
    assert!(assembler.counters().sensor_troubles >= 6, "or nothing broke: {:?}", assembler.counters());
}

#[test]
fn once_warm_nothing_is_allocated() {
    for method in [Method::Eq4, Method::Tracker] {
        let scene = walk(5, Sensors::CALIBRATED);
        let mut sensing = Sensing::new(scene.geometry, method);
        for frame in &scene.frames {
            sensing.update(frame);
        }
        let before = violation_count();
        assert_no_alloc(|| {
            for frame in &scene.frames {
                sensing.update(frame);
            }
        });
        assert_eq!(violation_count(), before, "{method:?}");
    }
}

// R4
#[cfg(feature = "threads")]
#[test]
fn a_crowd_on_several_cores_allocates_nothing_on_the_sensing_thread() {
    let crowd = Crowd::of(60, 200, 300);
    let pool = ThreadPool::new(NonZeroUsize::new(3).unwrap()).unwrap();
    pool.run(|| {
        let mut sensing = Sensing::new(crowd.geometry, Method::Tracker);
        let mut frame = ForceFrame::empty(&crowd.geometry);
        let (mut before, mut most, mut watched) = (None, 0, 0);
        // To and fro, so that no foot jumps.
        let times = || crowd.moments.iter().chain(crowd.moments.iter().rev());
        for (ms, moment) in (0..).zip(times().chain(times())) {
            moment.show(&mut frame, before.replace(moment));
            frame.at = Instant::from_millis(ms);
            let (counted, is_first) = (violation_count(), ms < times().count() as u64);
            let contacts = if is_first {
                sensing.update(&frame).len()
            } else {
                assert_no_alloc(|| sensing.update(&frame).len())
            };
            // Only a fuller floor than ever before allocates memory.
            if !is_first && contacts <= most {
                assert_eq!(violation_count(), counted, "{ms} ms");
                watched += 1;
            }
            most = most.max(contacts);
        }
        assert!(watched > 500, "{watched} frames");
    });
}
