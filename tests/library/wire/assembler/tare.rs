//! The tare measured at the start.

use underfoot::sense::{Tare, TareOutcome, TareRules};
use underfoot::units::Newtons;
use underfoot::wire::LinkState;

use super::*;

fn at_start() -> Assembler {
    Assembler::with_tare(&floor(), Tare::AtStart(TareRules::default()))
}

fn loaded(from: u64, until: u64, force: impl Fn(u16, u64) -> f32) -> Vec<SensorPacket> {
    steady(from, until)
        .map(|p| {
            let force = force(p.board, p.received.micros() / 1000);
            SensorPacket { readings: Readings::Newtons([force; 8].into_iter().collect()), ..p }
        })
        .collect()
}

#[test]
fn an_empty_floor_is_tared_before_the_first_frame() {
    let mut assembler = at_start();
    assert_eq!(assembler.tare_outcome(), TareOutcome::Measuring);
    let frames = feed(&mut assembler, loaded(0, 1000, |board, _| 10.0 + f32::from(board)));
    assert_eq!(assembler.tare_outcome(), TareOutcome::Taken);
    assert_eq!(frames[0], Shown { at_us: 500_000, samples: [0.0; 3], quality: LIVE });
    assert_eq!((assembler.counters().held_back, assembler.counters().frames), (500, 500));
    assert_eq!(assembler.tare()[4], [Newtons(12.0); 4]);
    let frames = feed(&mut assembler, loaded(1000, 1001, |_, _| 50.0));
    assert_eq!(frames[0].samples, [40.0, 39.0, 38.0]);
}

#[test]
fn somebody_on_the_floor_is_named_and_the_floors_tare_used() {
    let mut assembler = at_start();
    let sway = |board, ms: u64| if board == 2 { 90.0 + (ms % 50) as f32 } else { 10.0 };
    let frames = feed(&mut assembler, loaded(0, 6000, sway));
    let TareOutcome::Refused { sensor, deviation, .. } = assembler.tare_outcome() else {
        panic!("{:?}", assembler.tare_outcome())
    };
    assert_eq!(sensor.tile.row, 2);
    assert!(deviation > Newtons(10.0));
    assert!((5_000_000..5_600_000).contains(&frames[0].at_us));
    assert_eq!(frames[0].samples[..2], [0.0; 2], "the quiet boards are tared");
    assert!(frames[0].samples[2] >= 90.0);
}

#[test]
fn a_board_that_boots_late_is_stale_until_it_is_tared() {
    let mut assembler = at_start();
    let late = loaded(0, 3000, |_, _| 7.0).into_iter().filter(|p| p.board != 1 || p.sequence >= 1000);
    let frames = feed(&mut assembler, late);
    let first_live = frames.iter().find(|frame| frame.quality[1] == Quality::Live).unwrap();
    assert_eq!(first_live.at_us, 1_500_000);
    assert!(frames.iter().all(|frame| frame.samples == [0.0; 3]));
    assert_eq!(frames[0].quality, [Quality::Live, Quality::Stale, Quality::Live]);
    assert!(frames[0].at_us <= 502_000);
}

#[test]
fn a_floor_that_falls_silent_while_it_is_tared_gives_no_frame_and_is_tared_when_it_returns() {
    let mut assembler = at_start();
    assert_eq!(feed(&mut assembler, loaded(0, 200, |_, _| 7.0)), []);
    // Every board falls silent: there is no frame to show, and requests for frames must end.
    for now_ms in [250, 350, 500, 2000] {
        assert_eq!(poll(&mut assembler, now_ms), []);
    }
    assert_eq!(assembler.link_state(), LinkState::Lost);
    let frames = feed(&mut assembler, loaded(3000, 4000, |_, _| 7.0));
    assert_eq!(assembler.tare_outcome(), TareOutcome::Taken);
    assert_eq!(frames.last().map(|frame| (frame.samples, frame.quality)), Some(([0.0; 3], LIVE)));
}

#[test]
fn one_board_that_falls_silent_while_it_is_tared_does_not_hold_up_the_others() {
    let mut assembler = at_start();
    let mut packets = loaded(0, 2000, |_, _| 7.0);
    packets.retain(|p| p.board != 1 || p.sequence < 200);
    let frames = feed(&mut assembler, packets);
    assert!(frames[0].at_us < 700_000, "{:?}", frames.first());
    assert_eq!(frames[0].quality, [Quality::Live, Quality::Stale, Quality::Live]);
}
