//! One sole or two, fitted to the loads of one instant.
//!
//! Two feet that have landed together are one contact until their places show. All pairs of soles side by side with
//! the contact's centre of pressure between them are tried, and all single soles at that point; the mean likelihoods of
//! both give the odds, and the likely pairs the places. Two feet that carry a person have the size of that weight; a
//! single one that operates a control may be anybody's.

use super::params::pair::{
    APART_M, FIRST_S, FORCE_SHARES, HEADINGS, LIKELIHOODS, ON_HEEL, ON_HEEL_ALONE, ONE_SOLE, PLACED_M,
    SIZES_ALONE, STEP_M,
};
use arrayvec::ArrayVec;
use glam::DVec2;

use super::refits::Refits;
use super::sole::{LoadsAround, Sole};

/// Two feet that explain the loads of one contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pair {
    /// Log odds of two soles against one, with equal prior odds.
    pub log_odds: f64,
    pub places: [DVec2; 2],
    /// Force (N) of each.
    pub forces: [f64; 2],
    /// Standard deviation of the place of each (m).
    pub deviations: [f64; 2],
}

/// The pair fitted to the loads of a contact that may be two feet, again and again while it may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    /// The latest pair.
    pub pair: Option<Pair>,
    /// Counts the time for which it may have been two feet.
    pub refits: Refits,
}

impl Default for Fitted {
    fn default() -> Self {
        Self { pair: None, refits: Refits::first_after(FIRST_S) }
    }
}

/// Number of pairs tried, and of single soles.
const PAIRS: usize = HEADINGS * ON_HEEL.len() * APART_M.len() * FORCE_SHARES.len();

const ALONE: usize = 2 * HEADINGS * ON_HEEL_ALONE.len() * SIZES_ALONE.len();

impl Pair {
    /// Whether two soles are likelier than one by more than one may reach by its own shape, and both have a place.
    pub(super) fn is_placed(&self) -> bool {
        self.log_odds > ONE_SOLE && self.deviations.iter().all(|one| *one < PLACED_M)
    }

    /// The likeliest pair whose common centre of pressure is `centre`, of `force` newtons together. `None` if no pair
    /// explains the loads at all.
    pub(super) fn of(loads: &LoadsAround, centre: DVec2, force: f64) -> Option<Self> {
        let pairs: ArrayVec<f64, PAIRS> =
            (0..PAIRS).map(|number| loads.log_likelihood(&pair(number, centre, force))).collect();
        let alone: ArrayVec<f64, ALONE> =
            (0..ALONE).map(|number| loads.log_likelihood(&[sole(number, centre, force)])).collect();
        let (likeliest, &most) = pairs.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        if !most.is_finite() {
            return None;
        }
        let best = pair(likeliest, centre, force);
        let weights = pairs.iter().map(|likelihood| (likelihood - most).exp()).enumerate();
        let likely = weights.filter(|&(_, weight)| weight >= LIKELIHOODS);
        let feet = likely.map(|(number, weight)| (matched(pair(number, centre, force), &best), weight));
        let log_odds = log_mean_exp(&pairs) - log_mean_exp(&alone);
        Some(Self { log_odds, ..Self::mean_of(feet, centre) })
    }

    /// The weighted mean of pairs about `centre`.
    fn mean_of(pairs: impl Iterator<Item = ([Sole; 2], f64)>, centre: DVec2) -> Self {
        let mut mean = Self::default();
        let (mut sum, mut squares) = (0.0, [0.0; 2]);
        for (feet, weight) in pairs {
            sum += weight;
            for (which, foot) in feet.iter().enumerate() {
                mean.places[which] += foot.centre * weight;
                mean.forces[which] += foot.force * weight;
                squares[which] += foot.centre.distance_squared(centre) * weight;
            }
        }
        for (which, square) in squares.into_iter().enumerate() {
            mean.places[which] /= sum;
            mean.forces[which] /= sum;
            let spread = square / sum - mean.places[which].distance_squared(centre);
            mean.deviations[which] = (0.5 * spread.max(0.0) + STEP_M * STEP_M).sqrt();
        }
        mean
    }
}

/// Pair number `number` of all that are tried.
fn pair(number: usize, centre: DVec2, force: f64) -> [Sole; 2] {
    let (heading, number) = (heading_of(number % HEADINGS), number / HEADINGS);
    let (on_heel, number) = (ON_HEEL[number % ON_HEEL.len()], number / ON_HEEL.len());
    let (apart, number) = (APART_M[number % APART_M.len()], number / APART_M.len());
    let share = FORCE_SHARES[number % FORCE_SHARES.len()];
    let aside = heading.perp() * apart;
    let size = Sole::size_of(force);
    let sole = |centre, force| Sole { centre, heading, on_heel, force, size };
    [sole(centre - aside * share, force * (1.0 - share)), sole(centre + aside * (1.0 - share), force * share)]
}

/// Single sole number `number` of all that are tried.
fn sole(number: usize, centre: DVec2, force: f64) -> Sole {
    let (heading, number) = (heading_of(number % (2 * HEADINGS)), number / (2 * HEADINGS));
    let (on_heel, number) = (ON_HEEL_ALONE[number % ON_HEEL_ALONE.len()], number / ON_HEEL_ALONE.len());
    Sole { centre, heading, on_heel, force, size: SIZES_ALONE[number] }
}

fn heading_of(number: usize) -> DVec2 {
    DVec2::from_angle(number as f64 * std::f64::consts::PI / HEADINGS as f64)
}

/// The feet in the order of those of `best`.
fn matched(feet: [Sole; 2], best: &[Sole; 2]) -> [Sole; 2] {
    let [first, second] = feet;
    let away = |a: &Sole, b: &Sole| a.centre.distance_squared(b.centre);
    let crossed = away(&first, &best[1]) + away(&second, &best[0]);
    if away(&first, &best[0]) + away(&second, &best[1]) <= crossed {
        [first, second]
    } else {
        [second, first]
    }
}

/// Logarithm of the mean of the exponentials.
fn log_mean_exp(logarithms: &[f64]) -> f64 {
    let most = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = logarithms.iter().map(|one| (one - most).exp()).sum();
    most + (sum / logarithms.len() as f64).ln()
}
