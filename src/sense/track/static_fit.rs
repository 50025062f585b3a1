//! Feet at given places fitted to the loads of columns and rows of tiles, without memory.

use super::params::static_fit::{ASIDE, KNOWN, SEAM_M, UNKNOWN};
use super::params::touchdown::{MISREAD_N, SWAY_M};
use arrayvec::ArrayVec;
use glam::DVec2;

use super::strips::{MOST_STRIPS, StripAxis, Strips};
use crate::sense::centroid::tile::LoadedTile;

/// Maximum number of feet of one fit.
pub(super) const MOST_PARTS: usize = 5;

/// Share of the step of a grid by which a place on it is off, as a standard deviation.
const OFF_GRID: f64 = 0.3;

/// The load of one newton of a foot on one strip.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    /// Its share, first moment, and moment across.
    of: [f64; 3],
    /// Variance of the share.
    unlike: f64,
}

/// One foot on every strip.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub place: DVec2,
    on: ArrayVec<Load, MOST_STRIPS>,
    /// Step of the grid on which its place lies (m); 0 for a known place.
    step: f64,
}

impl Part {
    /// The same foot without load.
    pub(super) fn absent(mut self) -> Self {
        self.on.iter_mut().for_each(|on| *on = Load::default());
        self
    }
}

/// Forces of feet (N), and their cost: twice the negative log likelihood of the loads, up to a constant.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub forces: [f64; MOST_PARTS],
    pub cost: f64,
    /// Mean squared deviation of the loads from those of the feet, in standard deviations.
    pub misfit: f64,
}

impl Fit {
    /// The same at a cost that is higher by `cost`.
    pub(super) fn and(self, cost: f64) -> Self {
        Self { cost: self.cost + cost, ..self }
    }
}

/// The loads of a group's tiles by columns and rows.
#[derive(Clone, Debug)]
pub(super) struct StripLoads {
    strips: Strips,
    pitch: DVec2,
}

impl StripLoads {
    pub(super) fn of<'a>(tiles: impl Iterator<Item = &'a LoadedTile> + Clone, pitch: DVec2) -> Self {
        let mut strips = Strips::of(tiles.clone(), pitch);
        strips.add_noise(tiles);
        Self { strips, pitch }
    }

    /// Force of all tiles (N).
    pub(super) fn force(&self) -> f64 {
        self.strips.force
    }

    /// The loads of one newton of a foot with its centre of pressure at `place`, on a grid with this `step`. `residual`
    /// returns the difference of its shape from the patch with the half widths `half` on a strip; the shape is known
    /// with the weight `known`, 0 to 1.
    pub(super) fn part(
        &self,
        place: DVec2,
        half: DVec2,
        step: f64,
        known: f64,
        residual: impl Fn(StripAxis, i32) -> [f64; 3],
    ) -> Part {
        let at_seam = KNOWN * KNOWN + (1.0 - known) * UNKNOWN * UNKNOWN;
        let on = self.strips.strips.iter().map(|strip| {
            let axis = strip.axis;
            let (along, pitch) = (axis.along(place), axis.along(self.pitch));
            let slice = strip.slice(self.pitch, along, axis.along(half));
            let [share, moment, cross] = residual(axis, strip.number);
            let share = (slice.share + share).clamp(0.0, 1.0);
            let near = |seam: i32| (-2.0 * ((along - f64::from(seam) * pitch) / SEAM_M).powi(2)).exp();
            Load {
                of: [share, slice.moment + moment, share * axis.across(place - self.strips.middle) + cross],
                unlike: at_seam * (near(strip.number) + near(strip.number + 1)),
            }
        });
        Part { place, on: on.collect(), step }
    }

    /// Fits the forces of `parts`, none of them negative, by weighted least squares: first with the variances of equal
    /// forces, then with those of the forces found. `None` if the loads don't determine them.
    pub(super) fn fit(&self, parts: &[&Part]) -> Option<Fit> {
        // Loops over a number of feet that the compiler knows need no counter.
        match *parts {
            [a] => self.fit_of([a]),
            [a, b] => self.fit_of([a, b]),
            [a, b, c] => self.fit_of([a, b, c]),
            [a, b, c, d] => self.fit_of([a, b, c, d]),
            [a, b, c, d, e] => self.fit_of([a, b, c, d, e]),
            _ => None,
        }
    }

    fn fit_of<const N: usize>(&self, parts: [&Part; N]) -> Option<Fit> {
        let first = self.solve(parts, &[self.strips.force / N as f64; N])?;
        let found = self.solve(parts, &first)?;
        let (cost, misfit) = self.cost(parts, &found);
        let mut forces = [0.0; MOST_PARTS];
        forces[..N].copy_from_slice(&found);
        Some(Fit { forces, cost, misfit })
    }

    /// Way by which feet of `force` newtons together lie off if all loads are to have their common centroid: at most
    /// `step` along each axis.
    pub(super) fn off(&self, parts: &[&Part], fit: &Fit, force: f64, step: f64) -> DVec2 {
        let moment: DVec2 =
            parts.iter().zip(fit.forces).map(|(part, force)| (part.place - self.strips.middle) * force).sum();
        (-moment / force.max(1.0)).clamp(DVec2::splat(-step), DVec2::splat(step))
    }

    /// Calls `visit` with each observation, its coefficients for every foot, and its variance under `forces`.
    #[inline(always)]
    fn observe<const N: usize>(
        &self,
        parts: [&Part; N],
        forces: &[f64; N],
        mut visit: impl FnMut(f64, [f64; N], f64),
    ) {
        let sway = parts.map(|part| SWAY_M.max(OFF_GRID * part.step));
        for (at, strip) in self.strips.strips.iter().enumerate() {
            let lever = 0.5 * strip.axis.along(self.pitch);
            let loads = parts.map(|part| part.on[at]);
            let (mut unsure, mut swaying) = (0.0, 0.0);
            for ((load, force), sway) in loads.iter().zip(forces).zip(sway) {
                unsure += force * force * load.unlike;
                swaying += (sway * force * load.of[0]).powi(2);
            }
            let misread = MISREAD_N * MISREAD_N;
            let variances = [
                misread + unsure,
                (misread + unsure) * lever * lever + swaying,
                (misread + ASIDE * ASIDE * unsure) * lever * lever + swaying,
            ];
            let observed = [strip.force, strip.moment, strip.cross];
            for (row, (observed, variance)) in observed.into_iter().zip(variances).enumerate() {
                visit(observed, loads.map(|load| load.of[row]), variance + strip.noise[row]);
            }
        }
    }

    /// The forces of weighted least squares, with the variances under `forces`.
    fn solve<const N: usize>(&self, parts: [&Part; N], forces: &[f64; N]) -> Option<[f64; N]> {
        let mut normal = [[0.0; N]; N];
        let mut right = [0.0; N];
        self.observe(parts, forces, |observed, coefficients, variance| {
            for (row, coefficient) in coefficients.into_iter().enumerate() {
                right[row] += coefficient * observed / variance;
                for (sum, other) in normal[row].iter_mut().zip(coefficients) {
                    *sum += coefficient * other / variance;
                }
            }
        });
        let mut used: ArrayVec<usize, N> = (0..N).filter(|&which| normal[which][which] > 0.0).collect();
        loop {
            let found = solved(&normal, &right, &used)?;
            let Some(negative) = used.iter().position(|&which| found[which] < 0.0) else {
                return Some(found);
            };
            used.remove(negative);
        }
    }

    fn cost<const N: usize>(&self, parts: [&Part; N], forces: &[f64; N]) -> (f64, f64) {
        let (mut cost, mut squares) = (0.0, 0.0);
        self.observe(parts, forces, |observed, coefficients, variance| {
            let expected: f64 = coefficients.iter().zip(forces).map(|(share, force)| share * force).sum();
            let square = (observed - expected).powi(2) / variance;
            squares += square;
            cost += square + variance.ln();
        });
        (cost, squares / (3 * self.strips.strips.len()) as f64)
    }
}

/// Solves the normal equations of the unknowns in `used`; the others are zero. `None` if they are singular.
fn solved<const N: usize>(normal: &[[f64; N]; N], right: &[f64; N], used: &[usize]) -> Option<[f64; N]> {
    let (mut normal, mut right) = (*normal, *right);
    for (step, &pivot) in used.iter().enumerate() {
        let by = normal[pivot][pivot];
        if by.is_nan() || by <= 1e-12 {
            return None;
        }
        for &row in &used[step + 1..] {
            let factor = normal[row][pivot] / by;
            for &column in &used[step..] {
                normal[row][column] -= factor * normal[pivot][column];
            }
            right[row] -= factor * right[pivot];
        }
    }
    let mut found = [0.0; N];
    for (step, &row) in used.iter().enumerate().rev() {
        let known: f64 = used[step + 1..].iter().map(|&column| normal[row][column] * found[column]).sum();
        found[row] = (right[row] - known) / normal[row][row];
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_solved_and_unknowns_left_out_are_zero() {
        // 4 a + b = 9 and a + 3 b = 5 have the solution a = 2, b = 1; the third unknown stands by itself.
        let mut normal = [[0.0; MOST_PARTS]; MOST_PARTS];
        (normal[0][0], normal[0][1], normal[1][0], normal[1][1], normal[2][2]) = (4.0, 1.0, 1.0, 3.0, 1.0);
        let right = [9.0, 5.0, 7.0, 0.0, 0.0];
        let found = solved(&normal, &right, &[0, 1]).unwrap();
        assert!(
            (found[0] - 2.0).abs() < 1e-12 && (found[1] - 1.0).abs() < 1e-12 && found[2] == 0.0,
            "{found:?}"
        );
        assert_eq!(solved(&normal, &right, &[3]), None, "nothing determines the fourth");
    }
}
