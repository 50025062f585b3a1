//! Checks the frozen pond against its model: onsets, energies, fronts, turns.

use std::collections::HashMap;
use std::fmt;

use glam::Vec2;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use serde::Serialize;
use smallvec::smallvec;

use super::goodness::{Goodness, normal_share};
use underfoot::floor::{Geometry, Rect};
use underfoot::ground::{
    CrackRules, EnergyLaw, Fracture, GroundMaterial, GroundSpec, Grounds, IceSpec, Sheet,
};
use underfoot::layout::{Colour, Ground};
use underfoot::sense::{Contact, ContactId, ForceFrame, TileLoad};
use underfoot::units::{Instant, Newtons};

/// One property of the pond, checked against the model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PondLaw {
    /// Name of the property.
    pub what: String,
    /// Number of events, pieces or seeds in the sample.
    pub count: u64,
    /// Value of the model, if it is a single number.
    pub expected: Option<f64>,
    /// Measured value.
    pub found: Option<f64>,
    /// Goodness of fit of the whole sample, for a distribution.
    pub fit: Option<Goodness>,
}

/// All checked properties.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PondLaws {
    /// The properties, in the order of the table.
    pub lines: Vec<PondLaw>,
}

/// Period of the force on the tile (ms): a person who bounces on one leg.
const PERIOD_MS: u64 = 256;

impl PondLaws {
    /// Simulates about `events` events of ice with the parameters `spec`, from `seed`, and compares them with the
    /// model.
    ///
    /// A periodic force drives one tile through the same [`Grounds`] as in an engine. The model's rate comes from an
    /// independent solution of the differential equation (Runge-Kutta of fourth order in steps of 50 us). Broken ice
    /// is as strong as whole ice here, so that the rate is known.
    #[must_use]
    pub fn measure(spec: IceSpec, seed: u32, events: u64) -> Self {
        let spec = IceSpec { sheet: Sheet { weakening: 0.0, ..spec.sheet }, ..spec };
        let mut laws = Self::default();
        laws.driven(&spec, seed, events);
        laws.fronts(&spec.cracks, seed, events / 10);
        laws.turns(&spec.cracks, seed, events);
        laws
    }

    /// Returns the line with the name `what`.
    #[must_use]
    pub fn line(&self, what: &str) -> Option<&PondLaw> {
        self.lines.iter().find(|line| line.what == what)
    }

    fn push(&mut self, what: &str, count: u64, numbers: Option<(f64, f64)>, fit: Option<Goodness>) {
        let (expected, found) = numbers.unzip();
        self.lines.push(PondLaw { what: what.into(), count, expected, found, fit });
    }

    /// Checks onsets and energies.
    fn driven(&mut self, spec: &IceSpec, seed: u32, events: u64) {
        let geometry = Geometry::default();
        let model = Model::of(spec);
        let per_period = *model.expected.last().unwrap_or(&1.0);
        let periods = (events as f64 / per_period.max(1e-9)).ceil().min(1e5) as u64;
        let mut grounds = Grounds::new([pond(*spec, seed, geometry.bounds()).spec], &geometry);
        let place = geometry.centre(geometry.tile_at_index(7));
        let (mut frame, mut previous) = (ForceFrame::empty(&geometry), ForceFrame::empty(&geometry));
        let (mut whole, mut energies) = (Vec::new(), Vec::new());
        // The empty sheet first, then periods without a pause.
        for millis in 0..=periods * PERIOD_MS {
            previous.at = frame.at;
            frame.at = Instant::from_millis(millis + 1);
            let force = drive(millis as f64 * 1e-3);
            frame.forces[7] = [0.25 * force as f32; 4];
            let load = TileLoad {
                tile: geometry.tile_at_index(7),
                index: 7,
                force: Newtons(force as f32),
                centroid: place,
            };
            let contact = Contact {
                id: ContactId(1),
                centroid: place,
                force: load.force,
                tiles: smallvec![load],
                ..Contact::default()
            };
            for event in grounds.step(&frame, &previous, &[contact], 0) {
                // The step reports an event one millisecond after it happened.
                let at_s = event.at.secs() - 2e-3;
                whole.push(model.passed(at_s));
                energies.push(f64::from(event.energy_j));
            }
        }
        // The first period starts from rest, the others from the state at the end of the previous one.
        let count = whole.len() as u64;
        let expected = per_period * periods as f64;
        self.push("onsets: how many", count, Some((expected, count as f64)), None);
        let mut shares: Vec<f64> = whole.windows(2).map(|pair| 1.0 - (pair[0] - pair[1]).exp()).collect();
        let fit = Goodness::kolmogorov_smirnov(&mut shares);
        self.push("onsets: waiting times, Kolmogorov-Smirnov", count, None, Some(fit));
        // Twenty parts of the period with equal expected counts.
        let mut counts = [0_u64; 20];
        for passed in &whole {
            let part = (passed / per_period).fract() * 20.0;
            counts[(part as usize).min(19)] += 1;
        }
        let fit = Goodness::chi_squared(&counts, &[count as f64 / 20.0; 20], 1);
        self.push("onsets: when in the step, chi-squared", count, None, Some(fit));

        let law = spec.energy;
        let mut shares: Vec<f64> = energies.iter().map(|energy| law.share_below(*energy)).collect();
        let fit = Goodness::kolmogorov_smirnov(&mut shares);
        self.push("energies: Kolmogorov-Smirnov", count, None, Some(fit));
        let mut counts = [0_u64; 20];
        shares.iter().for_each(|share| counts[((share * 20.0) as usize).min(19)] += 1);
        let fit = Goodness::chi_squared(&counts, &[count as f64 / 20.0; 20], 1);
        self.push("energies: chi-squared", count, None, Some(fit));
        let found = likeliest_gamma(&law, &energies);
        self.push("energies: exponent gamma", count, Some((law.gamma.into(), found)), None);
    }

    /// Checks the number of fronts of a seed, and the choice of a front by each event.
    fn fronts(&mut self, rules: &CrackRules, seed: u32, seeds: u64) {
        let mut rng = Pcg64Mcg::seed_from_u64(u64::from(seed) ^ 0xf0);
        let side = 2.0 * rules.apart_m.max(0.1);
        let across = (seeds as f64).sqrt().ceil() as u64;
        let area = Rect::new(Vec2::ZERO, Vec2::splat((across + 1) as f32 * side));
        let mut fracture = Fracture::new(CrackRules { most: 64, ..*rules }, area);
        let (mut counts, mut chosen, mut started) = ([0_u64; 5], [0_u64; 6], 0);
        for n in 0..seeds {
            let place = Vec2::new((n % across + 1) as f32, (n / across + 1) as f32) * side;
            let now = Instant::from_millis(n);
            let before = fracture.cracks().next_back().map(|crack| crack.number);
            fracture.grow(place, 0.1, now, &mut rng);
            let first = before.map_or(0, |number| number + 1);
            started += fracture.cracks().filter(|crack| crack.number >= first).count() as u64;
            let fronts = fracture.seeds().last().map_or(0, |seed| seed.fronts());
            if let Some(count) = fronts.checked_sub(2).and_then(|index| counts.get_mut(index)) {
                *count += 1;
            }
            if fronts == 6 {
                for _ in 0..6 {
                    chosen[fracture.grow(place, 0.1, now, &mut rng).front.min(5)] += 1;
                }
            }
        }
        let fit = Goodness::chi_squared(&counts, &[seeds as f64 / 5.0; 5], 1);
        self.push("fronts: 2 to 6 alike, chi-squared", seeds, None, Some(fit));
        self.push("fronts: started at once", seeds, Some((2.0, started as f64 / seeds as f64)), None);
        let picks: u64 = chosen.iter().sum();
        let fit = Goodness::chi_squared(&chosen, &[picks as f64 / 6.0; 6], 1);
        self.push("fronts: each of six alike, chi-squared", picks, None, Some(fit));
    }

    /// Checks the turns of cracks from piece to piece.
    fn turns(&mut self, rules: &CrackRules, seed: u32, pieces: u64) {
        let mut rng = Pcg64Mcg::seed_from_u64(u64::from(seed) ^ 0x70);
        let across = 40;
        // Far from each other and from the edge, so that nothing stops a crack.
        let area = Rect::new(Vec2::ZERO, Vec2::splat(4.0 * (across + 1) as f32));
        let mut fracture =
            Fracture::new(CrackRules { most: 256, branch: 0.0, refreeze_s: None, ..*rules }, area);
        let mut headings: HashMap<u32, Vec2> = HashMap::new();
        let mut sideways = Vec::new();
        let mut place = 0_u64;
        while (sideways.len() as u64) < pieces && place < pieces {
            let at = Vec2::new((place % across + 1) as f32, (place / across % across + 1) as f32) * 4.0;
            headings.clear();
            for step in 0..24 {
                // Always the same length, long compared with the rounding of positions.
                let length = 0.04 / rules.per_j_m;
                let growth = fracture.grow(at, length, Instant::from_millis(place * 24 + step), &mut rng);
                let Some(newest) = fracture.cracks().next_back().copied() else { continue };
                if growth.is_new || growth.tip.is_none() || newest.length_m() < 0.002 {
                    continue;
                }
                let way = (newest.to - newest.from).normalize();
                if let Some(before) = headings.insert(newest.line, way) {
                    sideways.push(f64::from(before.perp_dot(way) / before.dot(way)));
                }
            }
            place += 1;
        }
        let count = sideways.len() as u64;
        let mean = sideways.iter().sum::<f64>() / count as f64;
        let deviation =
            (sideways.iter().map(|turn| (turn - mean).powi(2)).sum::<f64>() / count as f64).sqrt();
        let sigma = f64::from(rules.turn);
        self.push("turns: sigma", count, Some((sigma, deviation)), None);
        let mut shares: Vec<f64> = sideways.iter().map(|turn| normal_share(turn / sigma)).collect();
        self.push("turns: Kolmogorov-Smirnov", count, None, Some(Goodness::kolmogorov_smirnov(&mut shares)));
    }
}

impl fmt::Display for PondLaws {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<46} {:>8} {:>10} {:>10} {:>10} {:>7}",
            "law", "sample", "model", "found", "statistic", "p"
        )?;
        for line in &self.lines {
            let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
            let statistic = number(line.fit.map(|fit| fit.statistic));
            let p = line.fit.map_or(String::new(), |fit| format!("{:.3}", fit.p));
            let (model, found) = (number(line.expected), number(line.found));
            writeln!(
                f,
                "{:<46} {:>8} {model:>10} {found:>10} {statistic:>10} {p:>7}",
                line.what, line.count
            )?;
        }
        Ok(())
    }
}

/// Ice with these parameters over `area`.
pub(super) fn pond(spec: IceSpec, seed: u32, area: Rect) -> Ground {
    let (surface, deep) = (Colour::rgb(0x9f, 0xd3, 0xd6), Colour::rgb(0x0b, 0x3a, 0x47));
    let spec = GroundSpec { area, page: None, seed, material: GroundMaterial::Ice(spec) };
    Ground { spec, surface, deep }
}

/// Force at a time since the start, in newtons: `380 (1 - cos(2 pi t / T))`, smooth from 0 to 760 N and back.
fn drive(at_s: f64) -> f64 {
    let turn = std::f64::consts::TAU * 1000.0 / PERIOD_MS as f64;
    380.0 * (1.0 - (turn * at_s).cos())
}

/// The model over one period, from an independent solution.
struct Model {
    /// Expected number of events from the start of the period to the end of each step.
    expected: Vec<f64>,
    step_s: f64,
}

impl Model {
    fn of(spec: &IceSpec) -> Self {
        let body = spec.body;
        let [m, b, k] = [body.mass_kg, body.damping_n_s_m, body.stiffness_n_m].map(f64::from);
        // The floor samples the force each millisecond; between samples the model interpolates linearly.
        let force = |t: f64| {
            let whole = (t * 1000.0 + 1e-9).floor();
            let share = t * 1000.0 - whole;
            drive(whole * 1e-3) * (1.0 - share) + drive((whole + 1.0) * 1e-3) * share
        };
        let (step_s, steps) = (5e-5, PERIOD_MS as usize * 20);
        let slope = |t: f64, x: f64, v: f64| (v, (force(t) - b * v - k * x) / m);
        let (mut x, mut v) = (0.0, 0.0);
        let mut expected = Vec::new();
        // Uses the second period, in which the motion is periodic as in all later ones.
        for n in 0..2 * steps {
            let t = n as f64 * step_s;
            let before = v;
            let (x1, v1) = slope(t, x, v);
            let (x2, v2) = slope(t + 0.5 * step_s, x + 0.5 * step_s * x1, v + 0.5 * step_s * v1);
            let (x3, v3) = slope(t + 0.5 * step_s, x + 0.5 * step_s * x2, v + 0.5 * step_s * v2);
            let (x4, v4) = slope(t + step_s, x + step_s * x3, v + step_s * v3);
            x += step_s / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4);
            v += step_s / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
            if n >= steps {
                let rate = |v: f64| spec.onsets_per_s(0.5 * m * v.max(0.0).powi(2), 0.0);
                let so_far = expected.last().copied().unwrap_or(0.0);
                expected.push(so_far + 0.5 * (rate(before) + rate(v)) * step_s);
            }
        }
        Self { expected, step_s }
    }

    /// Expected number of events up to a time since the start.
    fn passed(&self, at_s: f64) -> f64 {
        let period_s = PERIOD_MS as f64 * 1e-3;
        let (periods, within) = ((at_s / period_s).floor(), at_s.rem_euclid(period_s) / self.step_s);
        let at = |index: usize| {
            if index == 0 { 0.0 } else { self.expected[(index - 1).min(self.expected.len() - 1)] }
        };
        let index = within as usize;
        let share = within - within.floor();
        periods * self.expected[self.expected.len() - 1] + at(index) * (1.0 - share) + at(index + 1) * share
    }
}

/// Maximum-likelihood estimate of the exponent for `energies`.
///
/// # Source
/// Maximum likelihood for a power law between two limits: the mean logarithm of the energies equals the law's own;
/// solved by bisection.
fn likeliest_gamma(law: &EnergyLaw, energies: &[f64]) -> f64 {
    let least = f64::from(law.least_j);
    let wide = (f64::from(law.most_j) / least).ln();
    let mean =
        energies.iter().map(|energy| (energy / least).ln()).sum::<f64>() / energies.len().max(1) as f64;
    // Mean of ln(E / least): with s = (gamma + 1) wide, the mean of a truncated exponential on 0..wide.
    let model = |gamma: f64| {
        let s = (gamma + 1.0) * wide;
        if s.abs() < 1e-6 { 0.5 * wide } else { wide * (1.0 / (1.0 - (-s).exp()) - 1.0 / s) }
    };
    let (mut low, mut high) = (-20.0, 20.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if model(middle) < mean { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
