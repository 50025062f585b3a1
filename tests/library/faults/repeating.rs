//! Repeated readings under a foot: they end a control that acts while it is held, with any readings of the boards.

use std::time::Duration;

use underfoot::engine::Ignored;
use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot::widget::EventKind::{self, Cancelled, Clicked, Pressed, Released};
use underfoot::widget::OffReason;
use underfoot::wire::Readings;
use underfoot_sim::{PartConfig, SimulatedSensors};

use super::bench::{BUTTON, Bench, foot};

/// Longest time that a hold may outlive repeated readings.
const SOON: Duration = Duration::from_millis(150);

/// The formats of boards' readings.
fn formats() -> [SimulatedSensors; 2] {
    [SimulatedSensors::Counts(PartConfig::default()), SimulatedSensors::Newtons(PartConfig::default())]
}

/// A foot holds the dead man's pedal on the south-west tile.
fn held(sensing: SimulatedSensors, seed: u64) -> Bench {
    let mut bench = Bench::new_seed(sensing, seed);
    bench.run_pedal();
    bench.press(BUTTON, 150.0);
    bench.stay(BUTTON, 150.0, 1, |_, _, _| {});
    assert_eq!(bench.events.first(), Some(&Pressed), "{sensing:?} {seed}");
    bench.events.clear();
    bench
}

/// The events without the pedal's values, which accompany them.
fn told(bench: &Bench) -> Vec<EventKind> {
    bench.events.iter().filter(|event| !matches!(event, EventKind::Changed(_))).copied().collect()
}

/// The bits of one reading: counts, or the bits of newtons.
fn bits(readings: &Readings, channel: usize) -> u32 {
    match readings {
        Readings::Counts(counts) => counts[channel].unwrap_or_default().into(),
        Readings::Scaled(values) | Readings::Newtons(values) => values[channel].to_bits(),
    }
}

fn set_bits(readings: &mut Readings, channel: usize, bits: u32) {
    match readings {
        Readings::Counts(counts) => counts[channel] = Some(bits as u16),
        Readings::Scaled(values) | Readings::Newtons(values) => values[channel] = f32::from_bits(bits),
    }
}

/// The time for which the pedal is still held after the foot begins to leave, if from then on some channels of the
/// first board read the result of `stuck`: by channel and millisecond, from the channel's readings in the
/// milliseconds before.
fn outlives(bench: &mut Bench, stuck: impl Fn(usize, u64, &[u32]) -> Option<u32>) -> Option<Duration> {
    // Earlier readings, oldest first.
    let mut past: Vec<Vec<u32>> = vec![Vec::new(); 8];
    bench.run_altered(200, |_, board, readings| {
        if board == 0 {
            (0..8).for_each(|channel| past[channel].push(bits(readings, channel)));
        }
    });
    let began = bench.now();
    let mut ended = None;
    for ms in 0..400_u64 {
        let left = 1.0 - (ms as f32 / 60.0).min(1.0);
        bench.feet = vec![foot(BUTTON, 150.0 * left)];
        if left == 0.0 {
            bench.feet.clear();
        }
        bench.run_altered(1, |_, board, readings| {
            for channel in (0..8).filter(|_| board == 0) {
                if let Some(bits) = stuck(channel, ms, &past[channel]) {
                    set_bits(readings, channel, bits);
                }
            }
        });
        if ended.is_none() && bench.events.iter().any(|event| matches!(event, Cancelled | Released)) {
            ended = Some(bench.now().since(began));
        }
    }
    ended
}

/// The longest of some rounds, each on its own floor.
fn longest(sensing: SimulatedSensors, stuck: impl Fn(usize, u64, &[u32]) -> Option<u32>) -> Duration {
    let rounds = (1..=20).map(|seed| outlives(&mut held(sensing, seed), &stuck).unwrap_or(Duration::MAX));
    rounds.max().unwrap_or_default()
}

fn last(past: &[u32]) -> u32 {
    past[past.len() - 1]
}

/// The three patterns with which a hold once outlived its foot, and similar ones: name, and the readings of the
/// tile's four channels.
type Way = (&'static str, fn(usize, u64, &[u32]) -> Option<u32>);

const WAYS: [Way; 9] = [
    ("everything stands still", |_, _, past| Some(last(past))),
    ("two corners stand still", |channel, _, past| [0, 3].contains(&channel).then(|| last(past))),
    ("the four corners of the plate stand still", |channel, _, past| (channel < 4).then(|| last(past))),
    ("everything stands still but one bit, which toggles", |channel, ms, past| {
        Some(if channel == 1 { last(past) ^ (ms as u32 & 1) } else { last(past) })
    }),
    ("a bit of each sensor toggles at random", |channel, ms, past| {
        let random = (ms as u32 + 1).wrapping_mul(2_654_435_761) >> (20 + channel) & 1;
        Some(last(past) ^ random << 3)
    }),
    ("the last two readings alternate", |_, ms, past| Some(past[past.len() - 2 + ms as usize % 2])),
    ("the last three readings take turns", |_, ms, past| Some(past[past.len() - 3 + ms as usize % 3])),
    ("a buffer of 32 readings is sent again and again", |_, ms, past| {
        Some(past[past.len() - 32 + ms as usize % 32])
    }),
    ("a buffer of 128 readings is sent again and again", |_, ms, past| {
        Some(past[past.len() - 128 + ms as usize % 128])
    }),
];

#[test]
fn a_hold_ends_soon_after_its_sensors_stand_still() {
    for sensing in formats() {
        for (way, stuck) in WAYS {
            let longest = longest(sensing, stuck);
            println!("{way}, {}: {longest:?}", name(sensing));
            assert!(longest <= SOON, "{way}, {sensing:?}: {longest:?}");
        }
    }
}

fn name(sensing: SimulatedSensors) -> &'static str {
    if matches!(sensing, SimulatedSensors::Counts(_)) { "counts" } else { "newtons" }
}

/// One sensor alone may stand still; the others show that the foot has left.
#[test]
fn a_single_sensor_that_stands_still_does_not_keep_a_hold() {
    for sensing in formats() {
        let longest = longest(sensing, |channel, _, past| (channel == 2).then(|| last(past)));
        assert!(longest <= SOON, "{sensing:?}: {longest:?}");
    }
}

/// A converter of four channels reads two corners of this tile and two of the next one.
#[test]
fn a_converter_that_reads_corners_of_two_plates_stands_still_on_both() {
    for sensing in formats() {
        let longest = longest(sensing, |channel, _, past| (2..6).contains(&channel).then(|| last(past)));
        assert!(longest <= SOON, "{sensing:?}: {longest:?}");
    }
}

#[test]
fn sensors_that_stand_still_while_a_foot_lands_start_nothing() {
    for sensing in formats() {
        let mut bench = Bench::new(sensing);
        bench.run_pedal();
        bench.press(BUTTON, 150.0);
        let mut frozen: Vec<Readings> = Vec::new();
        bench.run_altered(2000, |ms, board, readings| {
            if ms == 0 {
                frozen.push(readings.clone());
            } else {
                readings.clone_from(&frozen[usize::from(board)]);
            }
        });
        assert_eq!(told(&bench), [], "{sensing:?}: it takes a quarter of a second to press");
    }
}

#[test]
fn sensors_that_stand_still_while_a_foot_lifts_end_the_hold() {
    for sensing in formats() {
        let mut bench = held(sensing, 5);
        // Between the release threshold and the press threshold of the pedal.
        bench.press(BUTTON, 80.0);
        assert_eq!(told(&bench), []);
        assert!(outlives(&mut bench, |_, _, past| Some(last(past))).is_some_and(|took| took <= SOON));
        assert_eq!(told(&bench), [Cancelled], "{sensing:?}: what was lost commits nothing");
    }
}

#[test]
fn a_plate_whose_sensors_move_again_works_after_the_foot_has_lifted() {
    let mut bench = held(SimulatedSensors::default(), 4);
    outlives(&mut bench, |channel, _, past| [1, 2].contains(&channel).then(|| last(past)));
    assert_eq!(told(&bench), [Cancelled]);
    assert!(bench.assembler.repeating().1.next().is_some() && bench.assembler.counters().repeats == 1);
    bench.run(300);
    assert_eq!(bench.assembler.repeating().1.count(), 0);
    bench.press(BUTTON, 150.0);
    bench.stay(BUTTON, 150.0, 1, |_, _, _| {});
    assert_eq!(told(&bench), [Cancelled, Pressed]);
}

/// A button is cancelled as well, not clicked, when the readings resume without the foot.
#[test]
fn a_plate_that_stands_still_commits_nothing() {
    let mut bench = Bench::new(SimulatedSensors::default());
    bench.press(BUTTON, 120.0);
    bench.run(60);
    assert_eq!(told(&bench), [Pressed]);
    outlives(&mut bench, |channel, _, past| [0, 1].contains(&channel).then(|| last(past)));
    bench.run(500);
    assert_eq!(told(&bench), [Pressed, Cancelled]);
}

/// Counts of a converter with `bits` bits.
fn coarse(bits: u32) -> impl FnMut(u64, u16, &mut Readings) {
    move |_, _, readings| {
        if let Readings::Counts(counts) = readings {
            counts.iter_mut().flatten().for_each(|count| *count = *count >> (16 - bits) << (16 - bits));
        }
    }
}

/// Stands on the floor for `seconds`, swaying by at most a millimetre, while `alter` changes readings.
fn stand(bench: &mut Bench, seconds: u64, mut alter: impl FnMut(u64, u16, &mut Readings)) {
    for tenth in 0..seconds * 10 {
        let sway = 0.001 * (0.5 * tenth as f32).sin();
        bench.feet = vec![foot(BUTTON + Vec2::new(0.0, sway), 150.0)];
        bench.run_altered(100, &mut alter);
    }
}

#[test]
fn a_foot_that_stands_very_still_for_minutes_keeps_its_hold() {
    // 12 bits have noise of 1.6 counts.
    for (sensing, bits) in [(formats()[0], 16), (formats()[0], 12), (formats()[1], 16)] {
        let mut bench = Bench::new(sensing);
        bench.run_altered(1500, coarse(bits));
        bench.run_pedal();
        bench.run_altered(1500, coarse(bits));
        bench.press(BUTTON, 30.0);
        stand(&mut bench, 50, coarse(bits));
        assert_eq!(told(&bench), [Pressed], "{bits} bits");
        assert_eq!(bench.assembler.counters().repeats, 0, "{bits} bits");
    }
}

/// 2 mV of noise are 0.1 and 0.4 counts of such converters, which repeat readings under a foot that keeps still.
#[test]
fn a_coarse_converter_works_and_holds_no_pedal() {
    for bits in [8, 10] {
        let mut bench = Bench::new(SimulatedSensors::default());
        bench.run_altered(1000, coarse(bits));
        bench.feet = vec![foot(BUTTON, 120.0)];
        stand(&mut bench, 50, coarse(bits));
        assert_eq!(told(&bench), [Pressed], "{bits} bits: a button");
        let counters = bench.assembler.counters();
        assert_eq!((counters.frozen, counters.repeats), (0, 0), "{bits} bits");
        bench.feet.clear();
        bench.run_altered(500, coarse(bits));
        assert_eq!(told(&bench), [Pressed, Released, Clicked], "{bits} bits");
        bench.run_pedal();
        bench.run_altered(100, coarse(bits));
        assert_eq!(bench.snapshot().widgets[0].off, Some(OffReason::CoarseReadings), "{bits} bits");
        stand(&mut bench, 2, coarse(bits));
        bench.feet.clear();
        bench.run_altered(200, coarse(bits));
        assert_eq!(told(&bench), [Pressed, Released, Clicked], "{bits} bits: nothing more");
        let ignored = bench.snapshot().ignored;
        let why = ignored.last().map(|press| press.why);
        assert_eq!(why, Some(Ignored::Off(OffReason::CoarseReadings)), "{bits} bits");
    }
}

#[test]
fn a_converter_that_samples_twenty_times_a_second_works_and_holds_no_pedal() {
    let mut sampled: Vec<Readings> = vec![Readings::Counts(Default::default()); 2];
    let mut slow = move |ms: u64, board: u16, readings: &mut Readings| {
        let kept = &mut sampled[usize::from(board)];
        if ms.is_multiple_of(50) {
            kept.clone_from(readings);
        } else {
            readings.clone_from(kept);
        }
    };
    let mut bench = Bench::new(SimulatedSensors::default());
    bench.run_altered(1000, &mut slow);
    stand(&mut bench, 50, &mut slow);
    assert_eq!(told(&bench), [Pressed], "a button");
    assert_eq!((bench.assembler.counters().frozen, bench.assembler.counters().repeats), (0, 0));
    bench.feet.clear();
    bench.run_altered(500, &mut slow);
    bench.run_pedal();
    bench.run_altered(100, &mut slow);
    assert_eq!(bench.snapshot().widgets[0].off, Some(OffReason::CoarseReadings));
}

/// 10 bits, 0.1 counts of noise and five counts of mains hum: two readings 8 ms apart always differ.
#[test]
fn hum_on_a_coarse_converter_is_not_a_buffer_that_is_sent_again() {
    let parts = PartConfig { noise_v: 0.0005, ..PartConfig::default() };
    let mut at = 0_u64;
    let mut hum = move |_: u64, board: u16, readings: &mut Readings| {
        at += u64::from(board == 0);
        let volts = 0.012 * (at as f32 * 0.001 * 50.0 * std::f32::consts::TAU).sin();
        if let Readings::Counts(counts) = readings {
            for count in counts.iter_mut().flatten() {
                let hummed = f32::from(*count) + volts * 65_535.0 / 5.0;
                *count = hummed.clamp(0.0, 65_535.0) as u16 >> 6 << 6;
            }
        }
    };
    let mut bench = Bench::new(SimulatedSensors::Counts(parts));
    bench.run_altered(3000, &mut hum);
    stand(&mut bench, 50, &mut hum);
    assert_eq!(bench.assembler.counters().repeats, 0);
    assert_eq!(told(&bench), [Pressed]);
}

/// Boards that send newtons and read 0 without a load: their noise shows under a load only.
#[test]
fn boards_that_read_nothing_without_a_load_hold_a_pedal_once_a_foot_has_shown_their_noise() {
    let dead_band = |_: u64, _: u16, readings: &mut Readings| {
        if let Readings::Newtons(newtons) = readings {
            newtons.iter_mut().filter(|force| force.abs() < 2.0).for_each(|force| *force = 0.0);
        }
    };
    let mut bench = Bench::new(formats()[1]);
    bench.run_altered(1000, dead_band);
    bench.run_pedal();
    bench.feet = vec![foot(BUTTON, 30.0)];
    bench.run_altered(40, dead_band);
    stand(&mut bench, 2, dead_band);
    assert_eq!(told(&bench), [Pressed], "the foot need not lift");
}

#[test]
fn readings_without_noise_hold_a_pedal_where_the_floor_says_that_they_have_none() {
    let noiseless = PartConfig { noise_v: 0.0, ..PartConfig::default() };
    for sensing in [SimulatedSensors::Exact, SimulatedSensors::Counts(noiseless)] {
        // The simulation declares this itself.
        let mut bench = Bench::new(sensing);
        bench.run_pedal();
        bench.press(BUTTON, 150.0);
        bench.run(3000);
        assert_eq!(told(&bench), [Pressed], "{sensing:?}");
        bench.lift(BUTTON);
        bench.run(100);
        assert_eq!(told(&bench), [Pressed, Released], "{sensing:?}");
    }
}

#[test]
fn readings_without_noise_hold_no_pedal_where_nobody_says_so() {
    let sim = Bench::new(SimulatedSensors::Exact).sim;
    let mut bench = Bench::with_floor(&Floor::of(*sim.geometry()), sim);
    bench.run_pedal();
    bench.press(BUTTON, 150.0);
    bench.run(3000);
    assert_eq!(told(&bench), []);
}
