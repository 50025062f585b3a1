//! What the time between two frames makes of averages: the same for every foot.

use super::params::associate::PENDING_S;
use super::params::explanation::WINDOW_S;
use super::params::model::{FORCE_FADE_S, HALF_FADE_S, PLACE_FADE_S};
use super::params::reach::{MEMORY_LIGHT_S, MEMORY_S};
use super::params::residual::{LEARN_EVERY_S, RESIDUAL_S};
use super::params::smoothed::SMOOTHED_S;
use super::params::state::RATE_S;
use super::params::stillness::{MEAN_SPEED_S, REST_POINT_S, STILL_REST_POINT_S};
use super::params::tracker::NIS_S;

/// The time since the last frame, and how much of each average is left after it.
///
/// Computed for each foot, these exponentials took a twentieth of the work on a crowd.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elapsed {
    /// In seconds.
    pub dt: f64,
    /// Of a lone foot's rates.
    pub rates: f64,
    pub mean_speed: f64,
    pub rest_point: f64,
    pub still_rest_point: f64,
    pub smoothed: f64,
    /// Of the outline of a foot that bears a body, and of a light one's.
    pub outline: f64,
    pub light_outline: f64,
    pub explanation: f64,
    pub pending: f64,
    pub nis: f64,
    /// Of the rates of feet that share tiles.
    pub force_rate: f64,
    pub velocity: f64,
    /// Of a lone foot's shape, where it is learnt as often as it should be.
    shape: ShapeFade,
}

/// What a time makes of what was known of a foot's shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeFade {
    /// In seconds.
    pub dt: f64,
    /// How much of a half width is left, and of a residual.
    pub half: f64,
    pub residual: f64,
}

impl ShapeFade {
    fn new(dt: f64) -> Self {
        Self { dt, half: (-dt / HALF_FADE_S).exp(), residual: (-dt / RESIDUAL_S).exp() }
    }
}

impl Elapsed {
    pub(super) fn new(dt: f64) -> Self {
        let kept = |time_s: f64| (-dt / time_s).exp();
        Self {
            dt,
            rates: kept(RATE_S),
            mean_speed: kept(MEAN_SPEED_S),
            rest_point: kept(REST_POINT_S),
            still_rest_point: kept(STILL_REST_POINT_S),
            smoothed: kept(SMOOTHED_S),
            outline: kept(MEMORY_S),
            light_outline: kept(MEMORY_LIGHT_S),
            explanation: kept(WINDOW_S),
            pending: kept(PENDING_S),
            nis: kept(NIS_S),
            force_rate: kept(FORCE_FADE_S),
            velocity: kept(PLACE_FADE_S),
            shape: ShapeFade::new(learning_interval(dt)),
        }
    }

    /// What `since` seconds make of a lone foot's shape.
    pub(super) fn shape_fade(&self, since: f64) -> ShapeFade {
        if since == self.shape.dt { self.shape } else { ShapeFade::new(since) }
    }
}

/// The time after which a shape is learnt anew with a frame every `dt` seconds, added up as it is for each foot.
fn learning_interval(dt: f64) -> f64 {
    let mut since = dt;
    while dt > 0.0 && since < LEARN_EVERY_S - 0.5 * dt {
        since += dt;
    }
    since
}
