//! The parts of a track: groups of numbers that belong together.

use super::params::state::BODY_N;
use super::params::stillness::SWAY_MOST_M;
use glam::{DVec2, IVec2};
use smallvec::SmallVec;

use super::explanation::Explanation;
use super::initiate::CandidateTrack;
use super::pair::Fitted;
use super::reach::NOTHING_BORNE;
use super::rivals::Lead;
use super::soles::SolesAhead;
use super::stance::Stance;
use super::strips::Residual;
use super::touchdown::Touchdown;
use crate::sense::Quality;
use crate::sense::contact::ContactId;

/// The shape of a foot, learnt while it is alone on its tiles.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Differences between its shape and the model patch, from its last time alone.
    pub residuals: SmallVec<[Residual; 8]>,
    /// Lowest and highest column and row on which the residuals show load.
    pub borne: (IVec2, IVec2),
    /// Time alone since the last update of its shape (s).
    pub unlearnt_s: f64,
    /// Time for which it has been alone on its tiles (s).
    pub alone_s: f64,
    /// Its place when last measured alone; `None` before.
    pub alone_at: Option<DVec2>,
}

/// Where and for how long a foot stands still.
#[derive(Clone, Debug)]
pub(super) struct Stillness {
    /// Rest point of its centre of pressure while it shares tiles, and its stray about that point (m).
    pub rest_point: DVec2,
    pub sway_m: f64,
    /// Time for which it stood still there, and time for which it has moved since (s).
    pub still_s: f64,
    pub away_s: f64,
    /// Anchor point where it stood still, the time there and the time away from it (s).
    pub anchor: DVec2,
    pub anchored_s: f64,
    pub astray_s: f64,
    /// Mean speed of its centre of pressure over the last 0.25 s (m/s).
    pub mean_speed: f64,
}

/// The step that a foot has made, and the weight of its person.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Its centre of pressure when it landed.
    pub landed: DVec2,
    /// Largest distance of its centre of pressure from the place of its touchdown (m).
    pub travel: f64,
    /// Peak force (N).
    pub peak: f64,
    /// Force above which this track carries a person (N), as known from the person's steps.
    pub body_n: f64,
}

/// The feet around a foot.
#[derive(Clone, Debug)]
pub(super) struct Company {
    /// Number of the group of feet with which it is estimated.
    pub group: u32,
    /// The estimator that holds its covariances with other feet, if it has any, and their start in its list.
    pub links_from: (usize, usize),
    /// Whether its group has several feet.
    pub crowded: bool,
    /// Whether its group has more feet than the joint filter holds.
    pub beyond_filter: bool,
    /// Whether other feet share its tiles.
    pub shared: bool,
    /// Time since another foot, possibly of the same person, was last near it (s); infinite if none was.
    pub partner_s: f64,
    /// Whether another foot has been near it since its touchdown; then it is one foot.
    pub accompanied: bool,
    /// Whether it has landed together with another foot and has not been measured alone since.
    pub landed_together: bool,
}

/// Evidence against the estimate of a foot.
#[derive(Clone, Debug, Default)]
pub(super) struct Doubt {
    /// Whether its share is indistinguishable from that of another foot.
    pub ambiguous: bool,
    /// The track of which it may be a part, until it has carried a tile by itself: it was split from that one, or is
    /// lighter while other explanations are likely.
    pub part_of: Option<ContactId>,
    /// Recent mean NIS of the joint filter: 0 for a perfect fit.
    pub nis: f64,
    /// Misfit of the loads when this foot and another one, which stood still, were last placed beside each other; 0
    /// once it is alone.
    pub misfit: f64,
    /// Time for which it stays ambiguous since another explanation of its loads was likely (s).
    pub contested_s: f64,
    /// The rival explanation of its group that is ahead of the filter's, if it is the first of the group.
    pub lead: Lead,
    /// Two soles that were ahead when they were last compared, if it is the first of a group of two.
    pub soles: Option<SolesAhead>,
    /// Time for which another foot alone has explained the loads (s).
    pub enough_s: f64,
}

/// The sensors under a foot.
#[derive(Clone, Debug)]
pub(super) struct Sensors {
    /// The worst quality of its tiles, and whether that has just changed.
    pub quality: Quality,
    pub quality_changed: bool,
    /// Time for which new tracks stay suppressed (s).
    pub suppressed_s: f64,
}

/// Feet that land beside a foot or with it.
#[derive(Clone, Debug, Default)]
pub(super) struct Arrivals {
    /// Log odds of two feet against one.
    pub explanation: Explanation,
    /// Two soles fitted to its loads.
    pub fitted: Fitted,
    /// A foot that may have landed among its tiles in this frame.
    pub candidate: Option<CandidateTrack>,
    /// The foot with which it landed and stands.
    pub stance: Option<Stance>,
    /// The touchdown beside another foot.
    pub touchdown: Option<Touchdown>,
}

impl Shape {
    /// That of a foot that has not been alone.
    pub(super) fn unknown() -> Self {
        Self {
            residuals: SmallVec::new(),
            borne: NOTHING_BORNE,
            unlearnt_s: 0.0,
            alone_s: 0.0,
            alone_at: None,
        }
    }
}

impl Stillness {
    /// That of a foot that has just landed at `centre`.
    pub(super) fn at(centre: DVec2) -> Self {
        Self {
            rest_point: centre,
            sway_m: SWAY_MOST_M,
            still_s: 0.0,
            away_s: 0.0,
            anchor: centre,
            anchored_s: 0.0,
            astray_s: 0.0,
            mean_speed: 0.4,
        }
    }
}

impl Step {
    /// That of a foot that has just landed at `centre`.
    pub(super) fn at(centre: DVec2) -> Self {
        Self { landed: centre, travel: 0.0, peak: 0.0, body_n: BODY_N }
    }
}

impl Company {
    /// That of a foot that has never been near another one.
    pub(super) fn none() -> Self {
        Self {
            group: 0,
            links_from: (0, 0),
            crowded: false,
            beyond_filter: false,
            shared: false,
            partner_s: f64::INFINITY,
            accompanied: false,
            landed_together: false,
        }
    }
}

impl Default for Sensors {
    fn default() -> Self {
        Self { quality: Quality::Live, quality_changed: false, suppressed_s: 0.0 }
    }
}
