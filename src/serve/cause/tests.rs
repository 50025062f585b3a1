//! Faulty boards on a floor of two tiles with one board each.

use super::*;
use crate::floor::{Floor, Geometry};
use crate::wire::Readings;

/// Two tiles in a column: two boards of four channels.
fn floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(1, 2).unwrap())
}

/// A running floor that receives packets from the test.
struct Bench {
    assembler: Assembler,
    watch: CauseWatch,
    counters: LinkCounters,
    refused: Option<LinkCause>,
    /// Time in milliseconds and name of each reported cause; the name is empty where the cause ended.
    told: Vec<(u64, &'static str)>,
}

impl Bench {
    fn new() -> Self {
        let floor = floor();
        Self {
            watch: CauseWatch::new(&floor.boards),
            assembler: Assembler::new(&floor),
            counters: LinkCounters::default(),
            refused: None,
            told: Vec::new(),
        }
    }

    /// Sends the packets that `send` makes for each board and millisecond of the range.
    fn run(
        &mut self,
        milliseconds: std::ops::Range<u64>,
        send: impl Fn(u16, u64) -> Option<(u32, Readings)>,
    ) {
        for ms in milliseconds {
            let now = Instant::from_millis(ms);
            for board in 0..2 {
                let Some((sequence, readings)) = send(board, ms) else { continue };
                let packet = SensorPacket { board, sequence, received: now, readings };
                self.counters.datagrams += 1;
                self.watch.note(&packet);
                self.assembler.take(&packet);
            }
            self.assembler.poll(now);
            while let Some(frame) = self.assembler.ready() {
                let is_loaded = frame.forces.as_flattened().iter().sum::<f32>() > 20.0;
                self.watch.note_frame(frame, is_loaded, now);
            }
            if ms % 100 == 0 {
                let (link, refused) = (self.assembler.link_state(), self.refused.clone());
                let counters = self.counters + self.assembler.counters();
                let facts = Facts { assembler: &self.assembler, link, counters: &counters, refused };
                if self.watch.update(&facts, now) {
                    self.told.push((ms, self.watch.cause().map_or("", LinkCause::name)));
                }
            }
        }
    }
}

/// Readings of an empty floor, in newtons.
fn empty(ms: u64) -> Readings {
    let noise = |corner: u64| (ms * 7 + corner * 3) % 11;
    Readings::Newtons((0..4).map(|corner| 0.01 * noise(corner) as f32).collect())
}

/// A board without faults.
fn well(ms: u64) -> Option<(u32, Readings)> {
    Some((ms as u32, empty(ms)))
}

/// Returns the causes reported within five seconds for two boards, the second of them faulty.
fn told_of(strange: impl Fn(u64) -> Option<(u32, Readings)>) -> Vec<(u64, &'static str)> {
    let mut bench = Bench::new();
    bench.run(1..5000, |board, ms| if board == 0 { well(ms) } else { strange(ms) });
    bench.told
}

#[test]
fn boards_that_are_well_give_no_cause() {
    assert_eq!(told_of(well), []);
}

#[test]
fn a_strange_board_is_named_after_two_seconds() {
    let every = |n: u64, ms: u64| ms.is_multiple_of(n).then_some(ms / n);
    let number = |number: u64, ms: u64| Some((number as u32, empty(ms)));
    type Strange<'a> = (&'static str, &'a dyn Fn(u64) -> Option<(u32, Readings)>);
    let strange: [Strange<'_>; 10] = [
        ("rate_low", &|ms| every(100, ms).map(|n| (n as u32, empty(ms)))),
        // It hangs, and repeats its last packet.
        ("sequence_stands", &|ms| Some((ms.min(100) as u32, empty(ms.min(100))))),
        ("sequence_step", &|ms| number(2 * ms, ms)),
        ("sequence_step", &|ms| number(1000 * ms, ms)),
        ("sequence_falls", &|ms| number(100_000 - ms, ms)),
        ("sequence_restarts", &|ms| number(ms % 256, ms)),
        ("sequence_mixed", &|ms| number(ms / 2 + 3000 * (ms % 2), ms)),
        ("sequence_jumps", &|ms| number(ms.wrapping_mul(2_654_435_761), ms)),
        ("not_numbers", &|ms| Some((ms as u32, Readings::Newtons([f32::NAN; 4].into_iter().collect())))),
        ("boards_missing", &|_| None),
    ];
    for (name, strange) in strange {
        let told = told_of(strange);
        let [(at, said)] = told[..] else { panic!("{name}: {told:?}") };
        assert_eq!(said, name);
        assert!((2000..=3500).contains(&at), "{name} at {at} ms");
    }
}

#[test]
fn boards_at_other_rates_and_with_other_numbers_are_well() {
    let every = |n: u64, ms: u64| ms.is_multiple_of(n).then_some(ms / n);
    for period in [2, 5, 10, 20, 50] {
        let counts = |ms| every(period, ms).map(|n| (n as u32, empty(ms)));
        let stamps = |ms| every(period, ms).map(|_| (ms as u32, empty(ms)));
        let nothing = |ms| every(period, ms).map(|_| (0, empty(ms)));
        assert_eq!(told_of(counts), [], "{period} ms");
        assert_eq!(told_of(stamps), [], "{period} ms");
        assert_eq!(told_of(nothing), [], "{period} ms");
    }
}

#[test]
fn what_is_refused_of_boards_is_the_cause_where_nothing_else_comes() {
    let mut bench = Bench::new();
    let refused = LinkCause::WrongReadings { board: 1, channels: 4, found: "idddd".into() };
    bench.refused = Some(refused.clone());
    for ms in 1..5000 {
        bench.counters.wrong_shape += 1;
        bench.run(ms..ms + 1, |board, ms| (board == 0).then(|| well(ms)).flatten());
    }
    assert_eq!(bench.told.iter().map(|(_, name)| *name).collect::<Vec<_>>(), ["wrong_readings"]);
    assert_eq!(bench.watch.cause(), Some(&refused));
}

#[test]
fn without_another_cause_the_last_refusal_is_told() {
    let mut bench = Bench::new();
    bench.refused =
        Some(LinkCause::Unknown { last_refused: "nothing here has the address \"/ping\"".into() });
    for ms in 1..5000 {
        bench.counters.datagrams += 1;
        bench.counters.unknown_address += 1;
        bench.run(ms..ms + 1, |_, _| None);
    }
    let said = bench.watch.cause().unwrap().to_string();
    assert!(said.ends_with("last refused: nothing here has the address \"/ping\""), "{said}");
}

#[test]
fn requests_of_apps_alone_are_no_board_that_fails() {
    let mut bench = Bench::new();
    for ms in 1..5000 {
        bench.counters.datagrams += 1;
        bench.run(ms..ms + 1, |_, _| None);
    }
    assert_eq!(bench.told, []);
}

#[test]
fn a_floor_to_which_nothing_is_sent_has_no_cause() {
    let mut bench = Bench::new();
    bench.run(1..5000, |_, _| None);
    assert_eq!(bench.told, []);
}

#[test]
fn a_cause_is_gone_a_second_after_the_board_is_mended() {
    let mut bench = Bench::new();
    bench.run(1..5000, |board, ms| (board == 0).then(|| well(ms)).flatten());
    bench.run(5000..8000, |_, ms| well(ms));
    let [(_, "boards_missing"), (gone, "")] = bench.told[..] else { panic!("{:?}", bench.told) };
    assert!((5900..=6300).contains(&gone), "{gone}");
}

#[test]
fn a_board_that_reboots_is_no_cause() {
    let told = told_of(|ms| match ms {
        ..2500 => well(ms),
        2500..3200 => None,
        _ => well(ms - 3200),
    });
    assert_eq!(told, []);
}

/// Readings as shares of a newton while a person stands on the floor from 2 to 5 s.
fn shares(ms: u64) -> Option<(u32, Readings)> {
    let load = if (2000..5000).contains(&ms) { 0.6 } else { 0.0 };
    let noise = (ms * 7 % 11) as f32 * 1e-4;
    Some((ms as u32, Readings::Newtons([0.1 + load + noise; 4].into_iter().collect())))
}

#[test]
fn loads_that_never_show_are_told_while_they_last() {
    let mut bench = Bench::new();
    bench.run(1..8000, |_, ms| shares(ms));
    let [(at, "newtons_small")] = bench.told[..] else { panic!("{:?}", bench.told) };
    assert!((4000..4600).contains(&at), "{at}");
}

#[test]
fn a_floor_that_has_shown_a_load_is_believed() {
    let mut bench = Bench::new();
    let heavy = |ms: u64| Some((ms as u32, Readings::Newtons([100.0; 4].into_iter().collect())));
    bench.run(1..500, |_, ms| well(ms));
    bench.run(500..1500, |_, ms| heavy(ms));
    bench.run(1500..9000, |_, ms| shares(ms));
    assert_eq!(bench.told, []);
}
