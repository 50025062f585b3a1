//! The state of one foot, and its change over time.

use super::params::explanation::ROLL_M;
use super::params::state::{BODY_SHARE, CALM_S, HALF_REST, LEAST_BODY_N, UNKNOWN_HALF_M};
use arrayvec::ArrayVec;
use glam::DVec2;
use smallvec::SmallVec;

use super::elapsed::Elapsed;
use super::outline::FanExtents;
use super::parts::{Arrivals, Company, Doubt, Sensors, Shape, Step, Stillness};
use super::patch::PatchOnTile;
use super::smoothed::Smoothed;
use crate::sense::Quality;
use crate::sense::centroid::tile::LoadedTile;
use crate::sense::contact::ContactId;

/// Numbers per foot: force and its rate, east and its rate, north and its rate, two half widths.
pub(super) const STATES: usize = 8;
pub(super) const FORCE: usize = 0;
pub(super) const EAST: usize = 2;
pub(super) const NORTH: usize = 4;
pub(super) const HALF_EAST: usize = 6;
pub(super) const HALF_NORTH: usize = 7;

/// Maximum number of tiles of a group of feet, far more than its feet cover.
pub(super) const MOST_TILES: usize = 32;

/// Positions of the tiles of `feet`, each once, up to the capacity.
pub(super) fn tiles_of<'a>(feet: impl IntoIterator<Item = &'a Track>) -> ArrayVec<u32, MOST_TILES> {
    let mut all = ArrayVec::new();
    for &position in feet.into_iter().flat_map(|foot| &foot.tiles) {
        if !all.is_full() && !all.contains(&position) {
            all.push(position);
        }
    }
    all
}

/// Force above which feet of a person carry the person (N), from the largest load of the person's feet together (N).
pub(super) fn body_n_of(weight: f64) -> f64 {
    (BODY_SHARE * weight).max(LEAST_BODY_N)
}

/// One foot on the floor.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub id: ContactId,
    /// Seconds since it landed.
    pub age: f64,
    pub state: [f64; STATES],
    pub covariance: [[f64; STATES]; STATES],
    /// Whether the covariance of force and place is that of a foot measured alone.
    pub has_lone_covariance: bool,
    /// Its smoothed state, which predicts it for the next frame.
    pub smoothed: Smoothed,
    /// Positions of the tiles it may press, in the list of loaded tiles.
    pub tiles: SmallVec<[u32; 12]>,
    /// Time for which the foot has been too light to exist, less the recovery since (s).
    pub empty_s: f64,
    /// The points that it has pressed recently.
    pub outline: FanExtents,
    pub shape: Shape,
    pub stillness: Stillness,
    pub step: Step,
    pub company: Company,
    pub doubt: Doubt,
    pub sensors: Sensors,
    pub arrivals: Arrivals,
}

impl Track {
    pub(super) fn new(id: ContactId, force: f64, centre: DVec2, deviation: f64) -> Self {
        let mut foot = Self {
            id,
            age: 0.0,
            state: [force, 0.0, centre.x, 0.0, centre.y, 0.0, HALF_REST, HALF_REST],
            covariance: [[0.0; STATES]; STATES],
            has_lone_covariance: false,
            smoothed: Smoothed { force, centre, ..Smoothed::default() },
            tiles: SmallVec::new(),
            empty_s: 0.0,
            outline: FanExtents::new(centre),
            shape: Shape::unknown(),
            stillness: Stillness::at(centre),
            step: Step::at(centre),
            company: Company::none(),
            doubt: Doubt::default(),
            sensors: Sensors::default(),
            arrivals: Arrivals::default(),
        };
        foot.reset_covariance(deviation);
        for half in [HALF_EAST, HALF_NORTH] {
            foot.covariance[half][half] = UNKNOWN_HALF_M * UNKNOWN_HALF_M;
        }
        foot
    }

    /// Removes the correlations between force and place and resets their variances.
    pub(super) fn reset_covariance(&mut self, deviation: f64) {
        self.has_lone_covariance = false;
        for row in 0..HALF_EAST {
            self.covariance[row] = [0.0; STATES];
        }
        for half in [HALF_EAST, HALF_NORTH] {
            for other in &mut self.covariance[half][..HALF_EAST] {
                *other = 0.0;
            }
        }
        let place = deviation * deviation;
        for (state, variance) in [
            (FORCE, 9.0),
            (FORCE + 1, 3000.0_f64.powi(2)),
            (EAST, place),
            (NORTH, place),
            (EAST + 1, 0.2_f64.powi(2)),
            (NORTH + 1, 0.2_f64.powi(2)),
        ] {
            self.covariance[state][state] = variance;
        }
    }

    /// Whether it has carried the weight of a person.
    pub(super) fn bears(&self) -> bool {
        self.step.peak >= self.step.body_n
    }

    /// Force above which the feet of the same person carry the person: the steps of a light person lower it.
    pub(super) fn body_of_owner(&self) -> f64 {
        let stepped = self.step.travel > ROLL_M && self.step.peak > LEAST_BODY_N;
        if stepped { self.step.body_n.min(body_n_of(self.step.peak)) } else { self.step.body_n }
    }

    pub(super) fn force(&self) -> f64 {
        self.state[FORCE]
    }

    pub(super) fn centre(&self) -> DVec2 {
        DVec2::new(self.state[EAST], self.state[NORTH])
    }

    pub(super) fn velocity(&self) -> DVec2 {
        DVec2::new(self.state[EAST + 1], self.state[NORTH + 1])
    }

    pub(super) fn half(&self) -> DVec2 {
        DVec2::new(self.state[HALF_EAST], self.state[HALF_NORTH])
    }

    /// The part of its patch on the cell from `low` to `high`.
    pub(super) fn on(&self, cell: (DVec2, DVec2)) -> PatchOnTile {
        self.at(self.centre(), cell)
    }

    /// The part of its patch on the cell from `low` to `high` with the centre of pressure at `centre`.
    pub(super) fn at(&self, centre: DVec2, (low, high): (DVec2, DVec2)) -> PatchOnTile {
        PatchOnTile::new(low, high, centre, self.half())
    }

    /// Whether it was put down beside `existing` while that foot stood still.
    pub(super) fn has_landed_beside(&self, existing: &Self) -> bool {
        self.arrivals.touchdown.is_some_and(|touchdown| touchdown.existing == existing.id)
    }

    /// Its tiles and those of `other`, each once, up to the capacity.
    pub(super) fn tiles_with(&self, other: &Self) -> ArrayVec<u32, MOST_TILES> {
        tiles_of([self, other])
    }

    /// Adds `tiles` without allocating memory.
    pub(super) fn inherit(&mut self, tiles: &[u32]) {
        for &position in tiles {
            if self.tiles.len() < self.tiles.capacity() && !self.tiles.contains(&position) {
                self.tiles.push(position);
            }
        }
    }

    /// Measures the track on tiles that no other track shares, for the first time or again.
    pub(super) fn measure(&mut self, list: &[LoadedTile], elapsed: &Elapsed) {
        let before = self.centre();
        let until_now = std::mem::replace(&mut self.company.shared, false);
        self.alone(list, elapsed);
        let quality_changed = std::mem::take(&mut self.sensors.quality_changed);
        if until_now || quality_changed {
            self.restart_smoothing();
            (self.stillness.anchor, self.stillness.anchored_s, self.stillness.astray_s) =
                (self.centre(), 0.0, 0.0);
        }
        if quality_changed {
            // The foot has not moved; only the measurement has changed.
            self.stillness.rest_point = if self.sensors.suppressed_s > 0.0 {
                self.centre()
            } else {
                self.stillness.rest_point + self.centre() - before
            };
        }
    }

    /// Measures its force and place by Eq. 4.
    fn alone(&mut self, list: &[LoadedTile], elapsed: &Elapsed) {
        let dt = elapsed.dt;
        let (mut force, mut weight) = (0.0, 0.0);
        let mut sum = DVec2::ZERO;
        for &position in self.tiles.as_slice() {
            let tile = &list[position as usize];
            let weighed = f64::from(tile.weight());
            force += f64::from(tile.wrench.force);
            weight += weighed;
            sum += tile.centroid.as_dvec2() * weighed;
        }
        let centre = sum / weight;
        if dt > 0.0 {
            let weight = 1.0 - elapsed.rates;
            let rate = (force - self.state[FORCE]) / dt;
            let velocity = ((centre - self.centre()) / dt).clamp(DVec2::splat(-2.0), DVec2::splat(2.0));
            self.state[FORCE + 1] += weight * (rate - self.state[FORCE + 1]);
            self.state[EAST + 1] += weight * (velocity.x - self.state[EAST + 1]);
            self.state[NORTH + 1] += weight * (velocity.y - self.state[NORTH + 1]);
        }
        self.state[FORCE] = force;
        self.state[EAST] = centre.x;
        self.state[NORTH] = centre.y;
        if !self.has_lone_covariance {
            self.reset_covariance(0.003);
            self.has_lone_covariance = true;
        }
        self.company.landed_together = false;
        self.doubt.ambiguous = false;
    }

    /// Advances the smoothed state by `dt` seconds.
    pub(super) fn predict(&mut self, dt: f64) {
        self.age += dt;
        self.sensors.suppressed_s = (self.sensors.suppressed_s - dt).max(0.0);
        self.doubt.contested_s = (self.doubt.contested_s - dt).max(0.0);
        self.company.partner_s += dt;
        self.smoothed.centre += self.smoothed.velocity * dt;
        self.smoothed.force = (self.smoothed.force + self.smoothed.force_rate * dt).max(0.0);
    }

    /// Notes a change of the quality of its sensors, and suppresses new tracks from it.
    ///
    /// `lasts`: the readings go on changing for a while.
    pub(super) fn on_quality_change(&mut self, quality: Quality, lasts: bool) {
        self.sensors.quality = quality;
        self.sensors.quality_changed = true;
        self.sensors.suppressed_s = if lasts { CALM_S } else { 0.0 };
    }

    /// Suppresses new tracks for the next [`CALM_S`].
    pub(super) fn suppress_births(&mut self) {
        self.sensors.suppressed_s = CALM_S;
    }

    /// Sets the foot to this force and centre of pressure, alone.
    pub(super) fn stand(&mut self, force: f64, centre: DVec2) {
        self.state[FORCE] = force;
        self.state[EAST] = centre.x;
        self.state[NORTH] = centre.y;
        self.stillness.rest_point = centre;
        self.reset_covariance(0.01);
    }
}
