//! The path from packet to frame allocates no memory once it runs: it may run for months.

use assert_no_alloc::{assert_no_alloc, violation_count};
use underfoot::floor::Floor;
use underfoot::sense::Assembler;
use underfoot::units::Instant;
use underfoot::wire::{Readings, SensorPacket};

// R4
#[test]
fn assembling_frames_allocates_nothing() {
    let floor = Floor::default();
    let mut assembler = Assembler::new(&floor);
    let packet = |board, ms: u64| {
        let readings = Readings::Counts([Some(30_000); 24].into_iter().collect());
        SensorPacket { board, sequence: ms as u32, received: Instant::from_millis(ms), readings }
    };
    let mut frames = 0;
    let mut run = |from, until, lost: fn(u16, u64) -> bool| {
        for ms in from..until {
            for board in (0..6).filter(|&board| !lost(board, ms)) {
                assembler.take(&packet(board, ms));
            }
            assembler.poll(Instant::from_millis(ms));
            while assembler.ready().is_some() {
                frames += 1;
            }
        }
    };
    // Losses, an outage and a reboot are part of normal operation.
    assert_no_alloc(|| {
        run(0, 500, |_, _| false);
        run(500, 1000, |board, ms| board == 2 && ms % 3 == 0);
        run(1000, 1500, |board, ms| board == 4 || ms > 1200);
        run(100_000, 100_500, |_, _| false);
        run(10, 500, |_, _| false);
    });
    assert_eq!(violation_count(), 0);
    assert!(frames > 1500, "{frames}");
}
