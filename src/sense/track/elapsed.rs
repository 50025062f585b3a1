//! Decay factors of all averages for the time between two frames: the same for every foot.

use super::params::associate::PENDING_S;
use super::params::explanation::WINDOW_S;
use super::params::model::{FORCE_FADE_S, HALF_FADE_S, PLACE_FADE_S};
use super::params::reach::{MEMORY_LIGHT_S, MEMORY_S};
use super::params::residual::{LEARN_EVERY_S, RESIDUAL_S};
use super::params::smoothed::SMOOTHED_S;
use super::params::state::RATE_S;
use super::params::stillness::{MEAN_SPEED_S, REST_POINT_S, STILL_REST_POINT_S};
use super::params::tracker::NIS_S;

/// The time since the last frame, and the decay factor exp(−dt/τ) of each average.
///
/// Computed for each foot separately, these exponentials took a twentieth of the work on a crowd.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elapsed {
    /// In seconds.
    pub dt: f64,
    /// Rates of a lone foot.
    pub rates: f64,
    pub mean_speed: f64,
    pub rest_point: f64,
    pub still_rest_point: f64,
    pub smoothed: f64,
    /// Outline of a foot that carries a person, and of a light foot.
    pub outline: f64,
    pub light_outline: f64,
    pub explanation: f64,
    pub pending: f64,
    pub nis: f64,
    /// Rates of feet that share tiles.
    pub force_rate: f64,
    pub velocity: f64,
    /// Shape of a lone foot at the regular learning interval.
    shape: ShapeFade,
}

/// Decay of the shape of a foot over some time.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeFade {
    /// In seconds.
    pub dt: f64,
    /// Decay factors of a half width and of a residual.
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

    /// Decay factors of a lone foot's shape over `since` seconds.
    pub(super) fn shape_fade(&self, since: f64) -> ShapeFade {
        if since == self.shape.dt { self.shape } else { ShapeFade::new(since) }
    }
}

/// Time between two updates of the shape at one frame every `dt` seconds, summed as for each foot.
fn learning_interval(dt: f64) -> f64 {
    let mut since = dt;
    while dt > 0.0 && since < LEARN_EVERY_S - 0.5 * dt {
        since += dt;
    }
    since
}
