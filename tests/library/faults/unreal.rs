//! Readings that no foot on a working converter causes: a whole board that repeats, a row that jumps.

use underfoot::sense::Quality;
use underfoot::widget::EventKind::{Cancelled, Clicked, Pressed, Released};
use underfoot::wire::{LinkState, Readings};
use underfoot_sim::{PartConfig, SimulatedSensors};

use super::bench::{BUTTON, Bench};

/// Repeats the first readings of the boards; `which` selects the boards.
fn freeze(bench: &mut Bench, millis: u64, which: impl Fn(u16) -> bool) {
    let mut frozen = Vec::new();
    bench.run_altered(millis, |ms, board, readings| {
        if ms == 0 {
            frozen.push(readings.clone());
        } else if which(board) {
            readings.clone_from(&frozen[usize::from(board)]);
        }
    });
}

#[test]
fn converters_that_stand_still_under_a_foot_are_noticed_within_a_tenth_of_a_second() {
    let mut bench = Bench::new(SimulatedSensors::default());
    // The noise of the sensors must be known.
    bench.run(200);
    bench.press(BUTTON, 120.0);
    bench.run(60);
    freeze(&mut bench, 98, |_| true);
    assert_eq!(bench.events, [Pressed], "less than 100 ms may be chance");
    freeze(&mut bench, 110, |_| true);
    assert_eq!(bench.events, [Pressed, Cancelled]);
    let board = bench.assembler.board(0).unwrap();
    assert!(board.frozen && board.quality == Quality::Stale, "{board:?}");
    assert_eq!(bench.assembler.counters().frozen, 1, "nobody stands on the other board");
    assert_eq!(bench.assembler.link_state(), LinkState::Partial);
    // They change again, under a foot that has been there all the time: it must lift first.
    bench.run(1500);
    assert_eq!(bench.events, [Pressed, Cancelled]);
    assert_eq!(bench.assembler.link_state(), LinkState::Live);
    bench.lift(BUTTON);
    bench.run(100);
    bench.press(BUTTON, 120.0);
    bench.run(60);
    assert_eq!(bench.events, [Pressed, Cancelled, Pressed]);
}

#[test]
fn an_empty_board_may_rest_and_so_may_newtons_that_nobody_disturbs() {
    let mut bench = Bench::new(SimulatedSensors::default());
    freeze(&mut bench, 1000, |_| true);
    assert_eq!(bench.assembler.counters().frozen, 0, "an empty floor");
    bench.press(BUTTON, 120.0);
    freeze(&mut bench, 1000, |board| board == 1);
    assert_eq!(bench.assembler.counters().frozen, 0, "the board beside");
    let noiseless = PartConfig { noise_v: 0.0, ..PartConfig::default() };
    for sensing in [SimulatedSensors::Exact, SimulatedSensors::Counts(noiseless)] {
        let mut bench = Bench::new(sensing);
        bench.press(BUTTON, 120.0);
        bench.run(1000);
        assert_eq!((bench.assembler.counters().frozen, bench.events), (0, vec![Pressed]), "{sensing:?}");
    }
}

#[test]
fn a_row_that_jumps_ends_a_press_at_once_and_starts_none() {
    let mut bench = Bench::new(SimulatedSensors::default());
    bench.press(BUTTON, 120.0);
    bench.run(60);
    assert_eq!(bench.events, [Pressed]);
    let jump = |_, board, readings: &mut Readings| {
        if let (0, Readings::Counts(counts)) = (board, readings) {
            counts.fill(Some(60_000));
        }
    };
    // A frame may wait a millisecond or two for its packets.
    bench.run_altered(3, jump);
    assert_eq!(bench.events, [Pressed, Cancelled]);
    bench.run_altered(800, jump);
    bench.run(800);
    assert_eq!(bench.events, [Pressed, Cancelled]);
    let (jumps, last) = bench.assembler.jumps();
    assert!(jumps == 4 && last.is_some_and(|(tile, _)| tile.row == 0), "two tiles, there and back: {last:?}");
    bench.lift(BUTTON);
    bench.run(100);
    bench.press(BUTTON, 120.0);
    bench.run(60);
    bench.lift(BUTTON);
    bench.run(60);
    assert_eq!(bench.events, [Pressed, Cancelled, Pressed, Released, Clicked]);
}
