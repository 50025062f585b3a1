//! The content of packets, in newtons and qualities.

use underfoot::floor::{Calibration, Corner, TileId};
use underfoot::units::Newtons;
use underfoot::wire::{LinkCounters, LinkState};

use super::*;

#[test]
fn a_steady_floor_gives_a_frame_each_millisecond_exact_to_the_microsecond() {
    let mut assembler = assembler();
    assert_eq!(assembler.link_state(), LinkState::Waiting);
    let frames = feed(&mut assembler, steady(500, 5500));
    assert_eq!(frames.len(), 5000);
    for (ms, frame) in (500..).zip(&frames) {
        assert_eq!(*frame, Shown { at_us: ms * 1000, samples: [ms as f32; 3], quality: LIVE });
    }
    assert_eq!(assembler.link_state(), LinkState::Live);
    let counters = LinkCounters { packets: 15_000, frames: 5000, ..LinkCounters::default() };
    assert_eq!(assembler.counters(), counters);
}

#[test]
fn boards_that_boot_at_different_times_share_their_milliseconds() {
    let own_number = |packet: SensorPacket| {
        at_us(packet.board, packet.sequence + 7777 * u32::from(packet.board), packet.received.micros())
    };
    let frames = feed(&mut assembler(), steady(0, 50).map(own_number));
    for (ms, frame) in (0..).zip(&frames) {
        assert_eq!(frame.samples, [ms as f32, (ms + 7777) as f32, (ms + 15_554) as f32]);
        assert_eq!(frame.at_us, ms * 1000);
    }
}

#[test]
fn counts_pass_through_each_sensors_own_calibration_and_tare() {
    let mut floor = floor();
    floor.calibration[1][2] = Calibration::exponential(2.0, 1.0);
    floor.tare[1][2] = Newtons(1.5);
    let mut assembler = Assembler::new(&floor);
    // 26214 counts are 2 V.
    for board in 0..BOARDS {
        let readings = Readings::Counts([Some(26214); 8].into_iter().collect());
        assembler.take(&SensorPacket { readings, ..packet(board, 0, 0) });
    }
    let frame = assembler.ready().unwrap();
    assert!((frame.forces[1][2] - (2.0 * 2f32.exp() - 1.5)).abs() < 1e-3);
    assert!((frame.forces[1][3] - 0.5 * 2.68f32.exp()).abs() < 1e-3);
}

// P7
#[test]
fn readings_that_no_sensor_gives_spoil_their_sensor_only_and_are_counted() {
    let mut assembler = assembler();
    feed(&mut assembler, steady(0, 10));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, 50_001.0] {
        let sequence = 10 + assembler.counters().bad_readings as u32;
        let mut forces = [5.0; 8];
        forces[0] = bad;
        for board in 0..BOARDS {
            let readings =
                Readings::Newtons(if board == 1 { forces } else { [5.0; 8] }.into_iter().collect());
            assembler.take(&SensorPacket { readings, ..packet(board, sequence, sequence.into()) });
        }
        let frame = assembler.ready().unwrap();
        assert_eq!((frame.forces[2][0], frame.quality[2][0]), (9.0, Quality::Faulty), "the last good value");
        assert_eq!((frame.forces[2][1], frame.quality[2][1]), (5.0, Quality::Live));
        assert!(frame.forces.iter().flatten().all(|force| force.is_finite()));
    }
    assert_eq!(assembler.counters().bad_readings, 6);
    let frame = feed(&mut assembler, steady(16, 17))[0];
    assert_eq!(frame.quality, LIVE, "good again with the next good reading");
}

#[test]
fn strange_but_finite_newtons_stay_as_they_are() {
    let mut assembler = assembler();
    let forces = [-0.0, f32::MIN_POSITIVE / 4.0, 5e4, -5e4, 0.0, 0.0, 0.0, 0.0];
    for board in 0..BOARDS {
        let readings = Readings::Newtons(forces.into_iter().collect());
        assembler.take(&SensorPacket { readings, ..packet(board, 0, 0) });
    }
    let frame = assembler.ready().unwrap();
    assert_eq!(frame.forces[0], forces[..4]);
    assert_eq!(frame.quality[0], [Quality::Live; 4]);
}

#[test]
fn sensors_at_the_end_of_their_range_are_degraded() {
    let mut floor = floor();
    // Calibrated, since the nominal law would itself cause uncertainty.
    floor.calibration.fill([Calibration::exponential(0.6, 1.3); 4]);
    let mut assembler = Assembler::new(&floor);
    let counts = [Some(64_224), Some(64_225), Some(65_535), None, Some(0), Some(0), Some(0), Some(0)];
    for board in 0..BOARDS {
        let readings = Readings::Counts(counts.into_iter().collect());
        assembler.take(&SensorPacket { readings, ..packet(board, 0, 0) });
    }
    let frame = assembler.ready().unwrap();
    assert_eq!(frame.quality[0], [Quality::Live, Quality::Degraded, Quality::Degraded, Quality::Faulty]);
    assert_eq!(assembler.counters().bad_readings, 3);
}

#[test]
fn packets_of_no_board_or_of_the_wrong_length_are_counted() {
    let mut assembler = assembler();
    assembler.take(&packet(3, 0, 0));
    let readings = Readings::Newtons([1.0; 7].into_iter().collect());
    assembler.take(&SensorPacket { readings, ..packet(0, 0, 0) });
    assert_eq!((assembler.counters().unknown_address, assembler.counters().wrong_shape), (1, 1));
    assert!(assembler.ready().is_none());
}

#[test]
fn floors_of_96_x_96_tiles_work() {
    let floor = Floor::of(Geometry::of_paper_tiles(96, 96).unwrap());
    let mut assembler = Assembler::new(&floor);
    for ms in 0..3 {
        for (number, board) in (0..).zip(&floor.boards) {
            let readings =
                Readings::Newtons((0..board.channels.len()).map(|channel| channel as f32).collect());
            assembler.take(&SensorPacket {
                board: number,
                sequence: ms,
                received: Instant::from_millis(ms.into()),
                readings,
            });
        }
        let frame = assembler.ready().unwrap();
        assert!(frame.quality.iter().flatten().all(|quality| *quality == Quality::Live));
        let tile = floor.geometry.index(TileId::new(9, 95)).unwrap();
        assert_eq!(frame.forces[tile][Corner::NorthWest.index()], 6.0);
    }
    assert_eq!(assembler.counters().packets, 3 * 1152);
}
