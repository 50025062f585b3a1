//! One foot: what is known of it, and how that changes with time.

use super::params::explanation::ROLL_M;
use super::params::state::{BODY_N, BODY_SHARE, CALM_S, HALF_REST, LEAST_BODY_N};
use super::params::stillness::SWAY_MOST_M;
use arrayvec::ArrayVec;
use glam::{DVec2, IVec2};
use smallvec::SmallVec;

use super::elapsed::Elapsed;
use super::explanation::Explanation;
use super::initiate::Candidate;
use super::outline::Outline;
use super::patch::PatchOnTile;
use super::reach::NOTHING_BORNE;
use super::smoothed::Smoothed;
use super::strips::Residual;
use super::touchdown::Touchdown;
use crate::sense::Quality;
use crate::sense::contact::ContactId;
use crate::sense::tile::LoadedTile;

/// Numbers per foot: force and its rate, east and its rate, north and its rate, two half widths.
pub(super) const STATES: usize = 8;
pub(super) const FORCE: usize = 0;
pub(super) const EAST: usize = 2;
pub(super) const NORTH: usize = 4;
pub(super) const HALF_EAST: usize = 6;
pub(super) const HALF_NORTH: usize = 7;

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
    /// Where it was expected before this frame, from its slow past.
    pub smoothed: Smoothed,
    /// Positions of the tiles it may press, in the list of loaded tiles.
    pub tiles: SmallVec<[u32; 12]>,
    /// Seconds for which it has been too light to be there, less what has worn off of them.
    pub empty_s: f64,
    /// The most it has pressed with.
    pub peak: f64,
    /// From which force on it bears a body: that of whom it belongs to, as far as they have been seen to walk.
    pub body_n: f64,
    /// Seconds for which another foot alone has been enough.
    pub enough_s: f64,
    /// Seconds for which not even a slow shift of weight is.
    pub suppressed_s: f64,
    /// Which group of feet it is estimated with.
    pub group: u32,
    /// Which estimator has its links to others, if it has any, and where they begin in its list.
    pub links_from: (usize, usize),
    /// Whether it is one of a group of several.
    pub crowded: bool,
    /// Whether it is one more than the joint filter holds.
    pub beyond_filter: bool,
    /// Whether its part cannot be told from another's.
    pub ambiguous: bool,
    /// Whether other feet share its tiles.
    pub shared: bool,
    /// The track that it was split from, until it has carried a tile by itself: it may not be a foot.
    pub split_from: Option<ContactId>,
    /// How its shape differs from the model patch, as last seen alone.
    pub residuals: SmallVec<[Residual; 8]>,
    /// The lowest and the highest column and row on which these say that it has borne something.
    pub borne: (IVec2, IVec2),
    /// How badly the joint filter's predictions have fitted lately: 0 for perfectly.
    pub nis: f64,
    /// How badly the loads fitted it and the other foot when one was last placed beside the other, which stood still; 0
    /// once it is alone.
    pub misfit: f64,
    /// Mean speed of its centre of pressure over the last quarter of a second.
    pub mean_speed: f64,
    /// Seconds for which it has been alone without its shape being learnt.
    pub unlearnt_s: f64,
    /// Seconds for which it has been alone on its tiles.
    pub alone_s: f64,
    /// Where it was when last seen alone; `None` if it never was.
    pub alone_at: Option<DVec2>,
    /// Where its centre of pressure rests while it shares tiles, and how far it strays from there.
    pub rest_point: DVec2,
    pub sway_m: f64,
    /// Seconds for which it stood still there, and since when it has moved.
    pub still_s: f64,
    pub away_s: f64,
    /// How long ago another foot was last near it, which may be of the same person; infinite if none was.
    pub partner_s: f64,
    /// The worst quality of its tiles, and whether that has just changed.
    pub quality: Quality,
    pub quality_changed: bool,
    /// Beside whom it has landed.
    pub touchdown: Option<Touchdown>,
    /// Its centre of pressure when it landed.
    pub landed: DVec2,
    /// What it has pressed of late.
    pub outline: Outline,
    /// Where it stood still, for how long, and for how long it has been away from there.
    pub anchor: DVec2,
    pub anchored_s: f64,
    pub astray_s: f64,
    /// How far its centre of pressure has travelled from where it landed.
    pub travel: f64,
    /// Whether it has landed together with another and was never seen by itself since.
    pub landed_together: bool,
    /// Whether another foot was near it since it landed, so that it is one foot.
    pub accompanied: bool,
    /// Whether it is one foot or two.
    pub explanation: Explanation,
    /// Who may have landed among its tiles in this frame.
    pub candidate: Option<Candidate>,
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
            peak: 0.0,
            body_n: BODY_N,
            enough_s: 0.0,
            suppressed_s: 0.0,
            group: 0,
            links_from: (0, 0),
            crowded: false,
            beyond_filter: false,
            ambiguous: false,
            shared: false,
            split_from: None,
            residuals: SmallVec::new(),
            borne: NOTHING_BORNE,
            nis: 0.0,
            misfit: 0.0,
            mean_speed: 0.4,
            unlearnt_s: 0.0,
            alone_s: 0.0,
            alone_at: None,
            rest_point: centre,
            still_s: 0.0,
            away_s: 0.0,
            partner_s: f64::INFINITY,
            quality: Quality::Live,
            quality_changed: false,
            touchdown: None,
            sway_m: SWAY_MOST_M,
            landed: centre,
            outline: Outline::new(centre),
            anchor: centre,
            anchored_s: 0.0,
            astray_s: 0.0,
            travel: 0.0,
            landed_together: false,
            accompanied: false,
            explanation: Explanation::new(),
            candidate: None,
        };
        foot.reset_covariance(deviation);
        for half in [HALF_EAST, HALF_NORTH] {
            foot.covariance[half][half] = 0.04_f64.powi(2);
        }
        foot
    }

    /// Forgets what force and place had to do with each other and sets how sure both are.
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

    /// Whether it has borne the weight of a body.
    pub(super) fn bears(&self) -> bool {
        self.peak >= self.body_n
    }

    /// From which force on the feet of whom it belongs to bear their body: light people are known by their steps.
    pub(super) fn body_of_owner(&self) -> f64 {
        let stepped = self.travel > ROLL_M && self.peak > LEAST_BODY_N;
        if stepped { self.body_n.min((BODY_SHARE * self.peak).max(LEAST_BODY_N)) } else { self.body_n }
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

    /// What of it falls on the cell from `low` to `high`.
    pub(super) fn on(&self, cell: (DVec2, DVec2)) -> PatchOnTile {
        self.at(self.centre(), cell)
    }

    /// What of it would fall on the cell from `low` to `high` with its centre of pressure at `centre`.
    pub(super) fn at(&self, centre: DVec2, (low, high): (DVec2, DVec2)) -> PatchOnTile {
        PatchOnTile::new(low, high, centre, self.half())
    }

    /// Whether it was put down beside `existing` while that one stood still.
    pub(super) fn has_landed_beside(&self, existing: &Self) -> bool {
        self.touchdown.is_some_and(|touchdown| touchdown.existing == existing.id)
    }

    /// Its tiles and those of `other`, each once, as far as there is room: far more than two feet cover.
    pub(super) fn tiles_with(&self, other: &Self) -> ArrayVec<u32, 32> {
        let mut both = ArrayVec::new();
        for &position in self.tiles.iter().chain(&other.tiles) {
            if !both.is_full() && !both.contains(&position) {
                both.push(position);
            }
        }
        both
    }

    /// Takes over `tiles` as far as there is room without asking for memory.
    pub(super) fn inherit(&mut self, tiles: &[u32]) {
        for &position in tiles {
            if self.tiles.len() < self.tiles.capacity() && !self.tiles.contains(&position) {
                self.tiles.push(position);
            }
        }
    }

    /// Measures the track by the tiles that it has to itself, from now on or again.
    pub(super) fn measure(&mut self, list: &[LoadedTile], elapsed: &Elapsed) {
        let before = self.centre();
        let until_now = std::mem::replace(&mut self.shared, false);
        self.alone(list, elapsed);
        let quality_changed = std::mem::take(&mut self.quality_changed);
        if until_now || quality_changed {
            self.restart_smoothing();
            (self.anchor, self.anchored_s, self.astray_s) = (self.centre(), 0.0, 0.0);
        }
        if quality_changed {
            // Still it stands where it stood, only seen otherwise.
            self.rest_point = if self.suppressed_s > 0.0 {
                self.centre()
            } else {
                self.rest_point + self.centre() - before
            };
        }
    }

    /// Its force and place by Eq. 4.
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
        self.landed_together = false;
        self.ambiguous = false;
    }

    /// Moves the slow past on by `dt` seconds.
    pub(super) fn predict(&mut self, dt: f64) {
        self.age += dt;
        self.suppressed_s = (self.suppressed_s - dt).max(0.0);
        self.partner_s += dt;
        self.smoothed.centre += self.smoothed.velocity * dt;
        self.smoothed.force = (self.smoothed.force + self.smoothed.force_rate * dt).max(0.0);
    }

    /// Notes that its sensors are believed more or less than before, and takes nothing of the change for a newcomer.
    ///
    /// `lasts`: what they say goes on changing for a while.
    pub(super) fn on_quality_change(&mut self, quality: Quality, lasts: bool) {
        self.quality = quality;
        self.quality_changed = true;
        self.suppressed_s = if lasts { CALM_S } else { 0.0 };
    }

    /// Takes nothing of what happens in the next moment for a newcomer.
    pub(super) fn suppress_births(&mut self) {
        self.suppressed_s = CALM_S;
    }

    /// Stands alone with this force and centre of pressure from now on.
    pub(super) fn stand(&mut self, force: f64, centre: DVec2) {
        self.state[FORCE] = force;
        self.state[EAST] = centre.x;
        self.state[NORTH] = centre.y;
        self.rest_point = centre;
        self.reset_covariance(0.01);
    }
}
