//! The shape of a foot: learnt while it stands alone, valid near that place.

use glam::DVec2;

use super::elapsed::{Elapsed, ShapeFade};
use super::number_of;
use super::params::reach::KNOWN;
use super::params::residual::{KNOWN_S, LEARN_EVERY_S, RESIDUAL_S, TOUCHES_S};
use super::params::state::{HALF_LEAST, HALF_MOST, HALF_REST, UNKNOWN_HALF_M};
use super::state::{HALF_EAST, HALF_NORTH, Track};
use super::strips::{Residual, StripAxis, Strips, Whole};
use crate::sense::centroid::tile::LoadedTile;

impl Track {
    /// Learns the patch's half widths from the division at seams of a foot with a known centre of pressure.
    ///
    /// Each half width h relaxes as h = rest + k (h − rest), followed by a scalar Kalman update for each strip's
    /// share and moment.
    fn learn_halves(&mut self, strips: &Strips, pitch: DVec2, fade: &ShapeFade) {
        let ShapeFade { dt, half: decay, .. } = *fade;
        // The model error is correlated over many frames.
        let noise = 0.015_f64.powi(2) * (1.0_f64).max(0.02 / dt.max(1e-4));
        for axis in StripAxis::BOTH {
            let half = axis.half();
            self.state[half] = HALF_REST + decay * (self.state[half] - HALF_REST);
            let mut variance = self.covariance[half][half];
            variance = variance * decay * decay + 0.03_f64.powi(2) * (1.0 - decay * decay);
            let along = axis.along(self.centre());
            for strip in strips.strips.iter().filter(|strip| strip.axis == axis) {
                // Strips with all or none of the foot show nothing about its width.
                if strip.is_divided_by_none(pitch, along, self.state[half]) {
                    continue;
                }
                let slice = strip.slice(pitch, along, self.state[half]);
                let seen =
                    [strip.force / strips.force - slice.share, strip.moment / strips.force - slice.moment];
                // A wrongly placed share lies half a pitch from the strip's middle.
                let jacobian = [slice.share_by[1], slice.moment_by[1]];
                for (innovation, derivative, lever) in
                    [(seen[0], jacobian[0], 1.0), (seen[1], jacobian[1], 0.5 * axis.along(pitch))]
                {
                    let gain =
                        variance * derivative / (derivative * derivative * variance + noise * lever * lever);
                    self.state[half] = (self.state[half] + gain * innovation).clamp(HALF_LEAST, HALF_MOST);
                    variance *= 1.0 - gain * derivative;
                }
            }
            self.covariance[half][half] = variance;
        }
    }

    /// Learns the difference between the foot, alone on its tiles, and its model patch, once per learning interval.
    pub(super) fn learn_shape(&mut self, list: &[LoadedTile], pitch: DVec2, elapsed: &Elapsed) {
        self.shape.unlearnt_s += elapsed.dt;
        if self.shape.alone_at.is_none() || self.shape.unlearnt_s >= LEARN_EVERY_S - 0.5 * elapsed.dt {
            let fade = elapsed.shape_fade(std::mem::take(&mut self.shape.unlearnt_s));
            self.learn_residuals(list, pitch, &fade);
            self.note_borne();
        }
    }

    /// The same, with the decay since the last update.
    fn learn_residuals(&mut self, list: &[LoadedTile], pitch: DVec2, fade: &ShapeFade) {
        let (centre, half) = (self.centre(), self.half());
        let tiles = self.tiles.as_slice().iter().map(|&position| &list[position as usize]);
        let mut strips = Strips::about(&Whole::of(tiles.clone()), pitch);
        strips.add(tiles);
        for axis in StripAxis::BOTH {
            let (c, h) = (axis.along(centre), axis.along(half));
            let along = axis.along(pitch);
            for number in number_of(c - h, along)..=number_of(c + h, along) {
                strips.strip(axis, number);
            }
        }
        self.learn_halves(&strips, pitch, fade);
        let half = self.half();
        // Slow enough that the first touch of a new foot, not yet detected, has hardly any effect.
        let weight =
            if self.shape.alone_at.is_none() || self.age < RESIDUAL_S { 1.0 } else { 1.0 - fade.residual };
        for residual in &mut self.shape.residuals {
            residual.seen = false;
        }
        for strip in &strips.strips {
            let slice = strip.slice(pitch, strip.axis.along(centre), strip.axis.along(half));
            let now = [
                strip.force / strips.force - slice.share,
                strip.moment / strips.force - slice.moment,
                strip.cross / strips.force,
            ];
            let same = |residual: &Residual| residual.axis == strip.axis && residual.number == strip.number;
            let position = self.shape.residuals.iter().position(same).unwrap_or_else(|| {
                self.shape.residuals.push(Residual::none(strip.axis, strip.number));
                self.shape.residuals.len() - 1
            });
            self.shape.residuals[position].learn(now, weight);
        }
        self.shape.residuals.retain(|residual| residual.seen);
        if self.age > TOUCHES_S {
            self.shape.alone_s += fade.dt;
        }
        let before = self.shape.alone_at.unwrap_or(centre);
        self.shape.alone_at = Some(before + (centre - before) * weight);
    }

    /// Fixes the shape of a foot that was alone until now: its shape residuals describe the difference from the
    /// model, at any half widths.
    pub(super) fn keep_shape(&mut self) {
        if self.shape.alone_at.is_some() {
            let unknown = (-self.shape.alone_s / KNOWN_S).exp();
            let deviation = 0.0005 + 0.03 * unknown;
            for half in [HALF_EAST, HALF_NORTH] {
                self.state[half] += unknown * (HALF_REST - self.state[half]);
                let variance = &mut self.covariance[half][half];
                *variance = variance.min(deviation * deviation);
            }
        }
    }

    /// Forgets its shape, which was that of two feet.
    pub(super) fn forget_shape(&mut self) {
        (self.shape.alone_at, self.shape.alone_s) = (None, 0.0);
        self.shape.residuals.clear();
        self.note_borne();
        for half in [HALF_EAST, HALF_NORTH] {
            self.state[half] = HALF_REST;
            self.covariance[half][half] = UNKNOWN_HALF_M * UNKNOWN_HALF_M;
        }
    }

    /// Weight of its shape residuals: exp(−(d / 0.05 m)²) (1 − exp(−t/τ)) with the distance d from its last place
    /// alone and the time t alone.
    pub(super) fn residual_weight(&self) -> f64 {
        self.residual_weight_at(self.centre())
    }

    /// The same if its centre of pressure were at `centre`.
    pub(super) fn residual_weight_at(&self, centre: DVec2) -> f64 {
        self.shape.alone_at.map_or(0.0, |place| {
            let moved = place.distance(centre) / 0.05;
            (-moved * moved).exp() * (1.0 - (-self.shape.alone_s / KNOWN_S).exp())
        })
    }

    /// Whether the weight of its shape residuals suffices to list its tiles. Most feet need no exponential for that.
    pub(super) fn is_shape_known(&self) -> bool {
        const { assert!(KNOWN > 0.3 - 1e-9 && KNOWN < 0.3 + 1e-9, "between the bounds below") };
        let Some(place) = self.shape.alone_at else { return false };
        let moved = place.distance_squared(self.centre()) / (0.05 * 0.05);
        // exp(-1.21) < 0.3, and exp(-0.7) (1 - exp(-1)) > 0.31.
        if moved > 1.21 {
            return false;
        }
        if moved < 0.7 && self.shape.alone_s > KNOWN_S {
            return true;
        }
        self.residual_weight() > KNOWN
    }

    /// Its shape residual on one strip, times `strength`; zero without one.
    pub(super) fn residual_at(&self, axis: StripAxis, number: i32, strength: f64) -> Residual {
        self.shape
            .residuals
            .iter()
            .find(|residual| residual.axis == axis && residual.number == number)
            .map(|residual| Residual {
                share: residual.share * strength,
                moment: residual.moment * strength,
                cross: residual.cross * strength,
                ..*residual
            })
            .unwrap_or(Residual::none(axis, number))
    }
}
