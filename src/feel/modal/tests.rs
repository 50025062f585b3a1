//! Modal banks against double precision.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::*;

const RATE: f64 = 96_000.0;

/// The exact output of the bank, in double precision from the definition.
fn reference(modes: &[(f32, f32, f32)], samples: usize) -> Vec<f64> {
    reference_at(RATE, modes, samples)
}

fn reference_at(rate: f64, modes: &[(f32, f32, f32)], samples: usize) -> Vec<f64> {
    (1..=samples)
        .map(|n| {
            let t = n as f64 / rate;
            modes
                .iter()
                .map(|&(f, d, a)| f64::from(a) * (-t / f64::from(d)).exp() * (TAU * f64::from(f) * t).sin())
                .sum()
        })
        .collect()
}

fn error_db(got: &[f32], wanted: &[f64]) -> f64 {
    let error: f64 = got.iter().zip(wanted).map(|(g, w)| (f64::from(*g) - w).powi(2)).sum();
    let signal: f64 = wanted.iter().map(|w| w * w).sum();
    10.0 * (error / signal).log10()
}

/// Blocks of 441 end in the middle of a quantum, as those of a 44.1 kHz device do.
#[test]
fn error_stays_below_minus_100_db_whatever_the_block() {
    for modes in [
        vec![(60.0, 2.0, 1.0)],
        vec![(20.0, 2.0, 0.5), (60.0, 0.3, 1.0), (231.7, 0.05, -0.4), (999.0, 0.01, 0.3), (500.0, 1.0, 0.1)],
    ] {
        let wanted = reference(&modes, 96_000);
        for block in [1, 7, 64, 441, 96_000] {
            let mut bank = ModalBank::new(RATE, 8);
            for &(f, d, a) in &modes {
                bank.strike(f, d, a);
            }
            let mut got = vec![0.0; wanted.len()];
            got.chunks_mut(block).for_each(|out| bank.render(out));
            let error = error_db(&got, &wanted);
            assert!(error < -130.0, "{} modes in blocks of {block}: {error:.1} dB", modes.len());
        }
    }
}

/// A bank of eight modes drawn at random, struck twice, alone and side by side with others, in blocks of 64.
#[test]
fn random_modes_are_exact_at_both_rates_alone_and_side_by_side() {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut worst = [f64::NEG_INFINITY; 2];
    for rate in [48_000.0, 96_000.0] {
        for set in 0..40 {
            // Every second bank has smooth modes only, up to just below their limit.
            let highest = if set % 2 == 0 { 1000.0 } else { 0.0047 * rate as f32 };
            let modes: Vec<(f32, f32, f32)> = (0..8)
                .map(|_| {
                    let decay_s = 0.001 * 2000_f32.powf(random.random_range(0.0..=1.0));
                    (random.random_range(20.0..=highest), decay_s, random.random_range(-1.0..=1.0))
                })
                .collect();
            let mut banks = vec![ModalBank::new(rate, 8); LANES];
            let mut alone = vec![0.0; 9600];
            let mut together = Vec::new();
            for number in 0..150 {
                if number == 0 || number == 70 {
                    modes.iter().for_each(|&(f, d, a)| _ = banks[0].strike(f, d, a));
                    modes.iter().for_each(|&(f, d, a)| _ = banks[5].strike(f, d, a));
                }
                banks[0].render(&mut alone[number * 64..][..64]);
                let mut columns = [[0.0; LANES]; SPAN];
                ring_side_by_side(&mut banks, 0xffe0, 64, &mut columns);
                together.extend(columns.map(|column| column[5]));
                assert!(columns.iter().all(|column| column[4] == 0.0 && column[6] == 0.0));
            }
            let mut wanted = reference_at(rate, &modes, 9600);
            for (n, again) in reference_at(rate, &modes, 9600 - 70 * 64).into_iter().enumerate() {
                wanted[70 * 64 + n] += again;
            }
            for (worst, got) in worst.iter_mut().zip([&alone, &together]) {
                *worst = worst.max(error_db(got, &wanted));
            }
        }
    }
    assert!(worst.iter().all(|worst| *worst < -115.0), "{worst:?} dB");
}

#[test]
fn a_slow_device_gets_the_same_modes() {
    let modes = [(20.0, 2.0, 0.5), (231.7, 0.05, -0.4), (999.0, 0.01, 0.3)];
    let mut bank = ModalBank::new(8000.0, 8);
    modes.iter().for_each(|&(f, d, a)| _ = bank.strike(f, d, a));
    let mut got = vec![0.0; 8000];
    got.chunks_mut(100).for_each(|out| bank.render(out));
    assert!(error_db(&got, &reference_at(8000.0, &modes, 8000)) < -115.0);
}

#[test]
fn what_is_no_mode_is_not_struck() {
    let mut bank = ModalBank::new(RATE, 8);
    for (f, d, a) in [
        (f32::NAN, 0.1, 1.0),
        (-100.0, 0.1, 1.0),
        (5000.0, 0.1, 1.0),
        (100.0, 0.0, 1.0),
        (100.0, f32::NAN, 1.0),
        (100.0, f32::INFINITY, 1.0),
        (100.0, 0.1, f32::NAN),
        (100.0, 0.1, f32::INFINITY),
    ] {
        assert!(!bank.strike(f, d, a));
    }
    assert!(bank.is_silent());
}

/// After minutes every number of the bank is zero: from then on it costs no more than silence.
#[test]
fn a_bank_that_has_decayed_for_minutes_is_all_exact_zeros() {
    let mut bank = ModalBank::new(RATE, 16);
    for number in 0..16_u8 {
        bank.strike(20.0 + 60.0 * f32::from(number), 2.0, 1.0);
    }
    let mut out = [0.0; 960];
    // Two minutes of a mode that takes 2 s to fall to 1/e.
    for _ in 0..12_000 {
        out.fill(0.0);
        bank.render(&mut out);
        assert!(out.iter().all(|sample| !sample.is_subnormal()));
        for eight in &bank.eights {
            let states = eight.state.re.iter().chain(&eight.state.im);
            assert!(states.copied().all(|state| state == 0.0 || state.is_normal()));
            let tables = eight.power_terms.as_flattened().as_flattened().iter();
            assert!(tables.copied().all(|number| number == 0.0 || number.is_normal()));
        }
    }
    assert!(bank.is_silent());
    assert_eq!(out, [0.0; 960]);
    let left = bank.eights.iter().flat_map(|eight| eight.state.re.into_iter().chain(eight.state.im));
    assert_eq!(left.filter(|state| *state != 0.0).count(), 0);
}

/// The kernel for processors without fused multiplication, which this machine would not select.
#[test]
fn the_plainest_kernel_is_as_exact() {
    let mut bank = ModalBank::new(RATE, 4);
    bank.strike(60.0, 0.5, 1.0);
    bank.strike(417.0, 0.03, -0.7);
    let mut got = vec![0.0; 9600];
    got.chunks_mut(100).for_each(|out| render_spans_with::<false>(&mut bank, out, Basis::get()));
    let error = error_db(&got, &reference(&[(60.0, 0.5, 1.0), (417.0, 0.03, -0.7)], 9600));
    assert!(error < -100.0, "{error:.1} dB");
}

#[test]
fn the_sample_after_a_strike_is_the_first_that_moves() {
    let mut bank = ModalBank::new(RATE, 4);
    let mut out = [0.0; 10];
    bank.render(&mut out[..3]);
    bank.strike(100.0, 0.1, 1.0);
    bank.render(&mut out[3..]);
    assert_eq!(out[..3], [0.0; 3]);
    assert!((out[3] - 0.00654).abs() < 1e-5, "{}", out[3]);
}

#[test]
fn equal_modes_share_a_slot_and_add_up() {
    let mut twice = ModalBank::new(RATE, 4);
    let mut once = ModalBank::new(RATE, 4);
    let mut out = [[0.0; 500]; 2];
    twice.strike(120.0, 0.05, 0.25);
    twice.strike(120.0, 0.05, 0.25);
    once.strike(120.0, 0.05, 0.5);
    assert_eq!(twice.active_modes(), 1);
    twice.render(&mut out[0]);
    once.render(&mut out[1]);
    assert_eq!(out[0], out[1]);
}

#[test]
fn a_mode_that_has_rung_out_frees_its_slot_and_leaves_the_others_alone() {
    let mut bank = ModalBank::new(RATE, 8);
    for (f, d) in [(300.0, 0.002), (60.0, 1.0), (500.0, 0.002), (80.0, 1.0), (90.0, 1.0)] {
        bank.strike(f, d, 0.2);
    }
    let wanted = reference(&[(60.0, 1.0, 0.2), (80.0, 1.0, 0.2), (90.0, 1.0, 0.2)], 19_200);
    let mut out = vec![0.0; 19_200];
    out.chunks_mut(96).for_each(|block| bank.render(block));
    assert_eq!(bank.active_modes(), 3);
    // The short ones are gone after 0.05 s; the three long ones are left.
    assert!(error_db(&out[9600..], &wanted[9600..]) < -100.0);
}

#[test]
fn a_full_bank_gives_up_its_weakest_mode() {
    let mut bank = ModalBank::new(RATE, 4);
    for number in 1..=8_u8 {
        let amplitude = if number == 2 { 0.1 } else { 0.5 };
        assert!(!bank.strike(100.0 * f32::from(number), 1.0, amplitude));
    }
    assert!(bank.strike(900.0, 1.0, 0.5));
    assert_eq!(bank.active_modes(), 8);
    assert!(!bank.keys.iter().any(|key| key.frequency_hz == 200.0));
}

#[test]
fn silence_is_exact_and_reached() {
    let mut bank = ModalBank::new(RATE, 4);
    bank.strike(150.0, 0.01, 1.0);
    let mut out = vec![0.0; 96_000];
    out.chunks_mut(64).for_each(|block| bank.render(block));
    assert!(bank.is_silent());
    assert_eq!(out[90_000..], vec![0.0; 6000]);
    // No sample is a denormal number, which would be slow to compute with.
    assert!(out.iter().all(|x| *x == 0.0 || x.is_normal()));
}
