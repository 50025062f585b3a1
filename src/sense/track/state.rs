//! The state of one foot, and its change over time.

use super::params::explanation::ROLL_M;
use super::params::state::{BODY_N, BODY_SHARE, CALM_S, HALF_REST, LEAST_BODY_N, UNKNOWN_HALF_M};
use super::params::stillness::SWAY_MOST_M;
use arrayvec::ArrayVec;
use glam::{DVec2, IVec2};
use smallvec::SmallVec;

use super::elapsed::Elapsed;
use super::explanation::Explanation;
use super::initiate::CandidateTrack;
use super::outline::FanExtents;
use super::pair::Fitted;
use super::patch::PatchOnTile;
use super::reach::NOTHING_BORNE;
use super::rivals::Lead;
use super::smoothed::Smoothed;
use super::stance::Stance;
use super::strips::Residual;
use super::touchdown::Touchdown;
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
    /// Peak force (N).
    pub peak: f64,
    /// Force above which this track carries a person (N), as known from the person's steps.
    pub body_n: f64,
    /// Time for which another foot alone has explained the loads (s).
    pub enough_s: f64,
    /// Time for which new tracks stay suppressed (s).
    pub suppressed_s: f64,
    /// Number of the group of feet with which it is estimated.
    pub group: u32,
    /// The estimator that holds its covariances with other feet, if it has any, and their start in its list.
    pub links_from: (usize, usize),
    /// Whether its group has several feet.
    pub crowded: bool,
    /// Whether its group has more feet than the joint filter holds.
    pub beyond_filter: bool,
    /// Whether its share is indistinguishable from that of another foot.
    pub ambiguous: bool,
    /// Whether other feet share its tiles.
    pub shared: bool,
    /// The track of which it may be a part, until it has carried a tile by itself: it was split from that one, or is
    /// lighter while other explanations are likely.
    pub split_from: Option<ContactId>,
    /// Differences between its shape and the model patch, from its last time alone.
    pub residuals: SmallVec<[Residual; 8]>,
    /// Lowest and highest column and row on which the residuals show load.
    pub borne: (IVec2, IVec2),
    /// Recent mean NIS of the joint filter: 0 for a perfect fit.
    pub nis: f64,
    /// Misfit of the loads when this foot and another one, which stood still, were last placed beside each other; 0
    /// once it is alone.
    pub misfit: f64,
    /// Mean speed of its centre of pressure over the last 0.25 s (m/s).
    pub mean_speed: f64,
    /// Time alone since the last update of its shape (s).
    pub unlearnt_s: f64,
    /// Time for which it has been alone on its tiles (s).
    pub alone_s: f64,
    /// Its place when last measured alone; `None` before.
    pub alone_at: Option<DVec2>,
    /// Rest point of its centre of pressure while it shares tiles, and its stray about that point (m).
    pub rest_point: DVec2,
    pub sway_m: f64,
    /// Time for which it stood still there, and time for which it has moved since (s).
    pub still_s: f64,
    pub away_s: f64,
    /// Time since another foot, possibly of the same person, was last near it (s); infinite if none was.
    pub partner_s: f64,
    /// The worst quality of its tiles, and whether that has just changed.
    pub quality: Quality,
    pub quality_changed: bool,
    /// The touchdown beside another foot.
    pub touchdown: Option<Touchdown>,
    /// Its centre of pressure when it landed.
    pub landed: DVec2,
    /// The points that it has pressed recently.
    pub outline: FanExtents,
    /// Anchor point where it stood still, the time there and the time away from it (s).
    pub anchor: DVec2,
    pub anchored_s: f64,
    pub astray_s: f64,
    /// Largest distance of its centre of pressure from the place of its touchdown (m).
    pub travel: f64,
    /// Whether it has landed together with another foot and has not been measured alone since.
    pub landed_together: bool,
    /// Whether another foot has been near it since its touchdown; then it is one foot.
    pub accompanied: bool,
    /// Log odds of two feet against one.
    pub explanation: Explanation,
    /// The rival explanation of its group that is ahead of the filter's, if it is the first of the group.
    pub lead: Lead,
    /// Time for which it stays ambiguous since another explanation of its loads was likely (s).
    pub contested_s: f64,
    /// The foot with which it landed and stands.
    pub stance: Option<Stance>,
    /// Two soles fitted to its loads.
    pub fitted: Fitted,
    /// A foot that may have landed among its tiles in this frame.
    pub candidate: Option<CandidateTrack>,
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
            outline: FanExtents::new(centre),
            anchor: centre,
            anchored_s: 0.0,
            astray_s: 0.0,
            travel: 0.0,
            landed_together: false,
            accompanied: false,
            explanation: Explanation::new(),
            lead: Lead::default(),
            contested_s: 0.0,
            stance: None,
            fitted: Fitted::default(),
            candidate: None,
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
        self.peak >= self.body_n
    }

    /// Force above which the feet of the same person carry the person: the steps of a light person lower it.
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
        self.touchdown.is_some_and(|touchdown| touchdown.existing == existing.id)
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
        let until_now = std::mem::replace(&mut self.shared, false);
        self.alone(list, elapsed);
        let quality_changed = std::mem::take(&mut self.quality_changed);
        if until_now || quality_changed {
            self.restart_smoothing();
            (self.anchor, self.anchored_s, self.astray_s) = (self.centre(), 0.0, 0.0);
        }
        if quality_changed {
            // The foot has not moved; only the measurement has changed.
            self.rest_point = if self.suppressed_s > 0.0 {
                self.centre()
            } else {
                self.rest_point + self.centre() - before
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
        self.landed_together = false;
        self.ambiguous = false;
    }

    /// Advances the smoothed state by `dt` seconds.
    pub(super) fn predict(&mut self, dt: f64) {
        self.age += dt;
        self.suppressed_s = (self.suppressed_s - dt).max(0.0);
        self.contested_s = (self.contested_s - dt).max(0.0);
        self.partner_s += dt;
        self.smoothed.centre += self.smoothed.velocity * dt;
        self.smoothed.force = (self.smoothed.force + self.smoothed.force_rate * dt).max(0.0);
    }

    /// Notes a change of the quality of its sensors, and suppresses new tracks from it.
    ///
    /// `lasts`: the readings go on changing for a while.
    pub(super) fn on_quality_change(&mut self, quality: Quality, lasts: bool) {
        self.quality = quality;
        self.quality_changed = true;
        self.suppressed_s = if lasts { CALM_S } else { 0.0 };
    }

    /// Suppresses new tracks for the next [`CALM_S`].
    pub(super) fn suppress_births(&mut self) {
        self.suppressed_s = CALM_S;
    }

    /// Sets the foot to this force and centre of pressure, alone.
    pub(super) fn stand(&mut self, force: f64, centre: DVec2) {
        self.state[FORCE] = force;
        self.state[EAST] = centre.x;
        self.state[NORTH] = centre.y;
        self.rest_point = centre;
        self.reset_covariance(0.01);
    }
}
