//! Laws of sensors from loads of a load cell.

use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;

use super::*;

/// By `scipy.optimize.curve_fit` on the points of the test below: both parameters and the residual.
const SCIPY: [(LawKind, [f32; 2], f32); 4] = [
    (LawKind::Exponential, [10.881, 0.786_848], 0.020_650_4),
    (LawKind::Power, [5.979_21, 2.743_09], 0.021_752_2),
    (LawKind::Divider, [122.224, 5.983_33], 0.024_978_9),
    (LawKind::Linear, [88.5816, 0.994_526], 0.117_444),
];

fn ramp(law: Calibration, points: usize) -> Vec<LoadPoint> {
    (0..points)
        .map(|step| {
            let volts = 5.0 * (step as f32 + 0.5) / points as f32;
            LoadPoint::new(volts, law.force_at(volts))
        })
        .collect()
}

#[test]
fn parameters_come_back_within_one_percent_through_two_percent_of_noise() {
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let noise = Normal::new(1.0, 0.02).unwrap();
    // Parts at both ends of the spread in underfoot's simulation.
    for law in
        [Calibration::NOMINAL, Calibration::exponential(0.625, 1.41), Calibration::exponential(0.375, 1.27)]
    {
        // Eight seconds of a slow press at 1 kHz: the heavy end determines the curve, so `a`, far from it, needs
        // many points.
        let mut points = ramp(law, 8000);
        for point in &mut points {
            point.force = point.force * noise.sample(&mut rng);
        }
        let fit = Fit::of(&points).unwrap();
        let ([a, b], [true_a, true_b]) = (fit.calibration.numbers(), law.numbers());
        let (a, b) = (a / true_a, b / true_b);
        assert!((a - 1.0).abs() < 0.01 && (b - 1.0).abs() < 0.01, "a {a}, b {b}");
        assert!(fit.residual < 0.01, "{}", fit.residual);
    }
}

#[test]
fn every_law_comes_back_from_its_own_curve() {
    for law in [
        Calibration::exponential(4.4e-6, 3.7),
        Calibration::of(LawKind::Power, [2.2, 3.1]),
        // Nearly zero at one volt.
        Calibration::of(LawKind::Power, [2e-11, 19.0]),
        Calibration::of(LawKind::Divider, [35.0, 5.05]),
        Calibration::of(LawKind::Divider, [35.0, 40.0]),
        Calibration::of(LawKind::Linear, [82.0, 0.4]),
        Calibration::of(LawKind::Linear, [82.0, -1.0]),
    ] {
        let fit = MeasuredLoads::of(&ramp(law, 40))
            .and_then(|loads| loads.fit(law.kind()))
            .unwrap_or_else(|error| panic!("{law}: {error}"));
        let near = |(found, truth): (f32, f32)| (found - truth).abs() <= 1e-3 * truth.abs();
        let numbers = fit.calibration.numbers().into_iter().zip(law.numbers());
        assert!(numbers.into_iter().all(near) && fit.residual < 1e-5, "{law}: {fit:?}");
    }
}

#[test]
fn squares_are_those_that_an_independent_fit_finds() {
    let points = [
        (0.4, 3.0),
        (0.9, 11.0),
        (1.5, 30.0),
        (2.1, 52.0),
        (2.8, 109.0),
        (3.5, 170.0),
        (4.1, 283.0),
        (4.6, 400.0),
    ]
    .map(|(volts, force)| LoadPoint::new(volts, Newtons(force)));
    for (kind, numbers, residual) in SCIPY {
        let fit = MeasuredLoads::of(&points).unwrap().fit(kind).unwrap();
        let near = |found: f32, truth: f32| (found / truth - 1.0).abs() < 2e-4;
        let [a, b] = fit.calibration.numbers();
        assert!(near(a, numbers[0]) && near(b, numbers[1]) && near(fit.residual, residual), "{fit:?}");
    }
}

#[test]
fn squares_are_of_force_and_not_of_its_logarithm() {
    // A part that reads a factor 2 too low when light: the heavy end must still be right.
    let mut points = ramp(Calibration::NOMINAL, 50);
    for point in points.iter_mut().filter(|p| p.force.0 < 5.0) {
        point.force = point.force * 0.5;
    }
    let law = Fit::of(&points).unwrap().calibration;
    let heavy = points.last().unwrap();
    let modelled = law.force_at(heavy.volts).0;
    assert!((modelled / heavy.force.0 - 1.0).abs() < 0.01, "{modelled}");
}

#[test]
fn residual_is_a_share_of_the_greatest_force() {
    let mut points = ramp(Calibration::NOMINAL, 51);
    let full = points.last().unwrap().force;
    // No fit can remove alternating errors of 5 % of full scale.
    for (index, point) in points.iter_mut().enumerate() {
        point.force += full * if index % 2 == 0 { 0.05 } else { -0.05 };
    }
    let residual = Fit::of(&points).unwrap().residual;
    assert!((0.045..0.052).contains(&residual), "{residual}");
}

#[test]
fn each_lack_of_data_has_its_name() {
    let good = ramp(Calibration::NOMINAL, 20);
    assert_eq!(Fit::of(&[]), Err(FitError::TooFewPoints { points: 0 }));
    assert_eq!(Fit::of(&good[..2]), Err(FitError::TooFewPoints { points: 2 }));

    let mut broken = good.clone();
    broken[4].volts = f32::NAN;
    assert_eq!(Fit::of(&broken), Err(FitError::NotFinite { index: 4 }));

    let unplugged = vec![LoadPoint::new(0.0, Newtons(20.0)); 10];
    assert_eq!(Fit::of(&unplugged), Err(FitError::NoSpread { spread_v: 0.0 }));

    // The wires are swapped: the voltage falls as the load grows.
    let falling: Vec<_> = good.iter().map(|p| LoadPoint::new(5.0 - p.volts, p.force)).collect();
    assert!(matches!(Fit::of(&falling), Err(FitError::Unphysical { .. })), "{:?}", Fit::of(&falling));
}

#[test]
fn forces_that_no_law_can_reach_do_not_converge_or_are_unphysical() {
    let absurd: Vec<_> = (0..10).map(|k| LoadPoint::new(k as f32 * 1e20, Newtons(1e30))).collect();
    assert!(Fit::of(&absurd).is_err());
}
