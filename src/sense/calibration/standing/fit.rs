//! The laws of all sensors from a person's stands.

use glam::{DVec2, Vec2};
use thiserror::Error;

use super::data::StandData;
use super::equations::Used;
use super::rivals::is_alike;
use super::search::{RobustFit, StandSearch};
use crate::floor::{Calibration, Geometry, LawKind, SensorId};
use crate::units::Newtons;

/// The result of a calibration by standing.
#[derive(Clone, Debug, PartialEq)]
pub struct StandFit {
    /// The kind of law that all sensors follow.
    pub kind: LawKind,
    /// The kinds that were compared.
    pub laws: Vec<StandLaws>,
    /// The sensors under tiles with a stand, and those that carried a load elsewhere, in the order of
    /// [`StandData::empty`].
    pub sensors: Vec<SensorFit>,
    /// Root mean square error of the sum of all forces of the stands that count, as a share of the weight.
    pub weight_residual: f32,
    /// Root mean square distance of the stands that count from their marks, after the lean (m): mostly the errors of
    /// the feet, not those of the sensors.
    pub place_residual_m: f32,
    /// The person's lean: distance of the centre of pressure from the middle between the feet, to the right and
    /// forwards (m).
    pub lean_m: Vec2,
    /// Number of stands that count.
    pub stands: usize,
    /// Positions of the stands that disagree with all others and do not count: the person was elsewhere.
    pub astray: Vec<usize>,
    /// Positions of the stands with a sensor at the end of its range: its force is unknown there, so the stand tells
    /// less; with three such sensors, nothing.
    pub saturated: Vec<usize>,
    /// Number of crossings that count.
    pub crossings: usize,
}

/// The fit of all sensors by laws of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandLaws {
    /// The kind.
    pub kind: LawKind,
    /// Sum of the squares of all errors in units of their standard errors, those of each stand no greater than chance
    /// allows, and the logarithm of the determinant of the normal equations: the less, the better (less by 2 is about
    /// e times as probable). Infinite if no such laws fit.
    pub misfit: f64,
}

/// The law of one sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorFit {
    /// The sensor.
    pub sensor: SensorId,
    /// Its law.
    pub law: Calibration,
    /// The force of this law on the empty floor.
    pub tare: Newtons,
    /// Greatest load in a stand that counts.
    pub most: Newtons,
    /// Standard error of its force under an eighth and a quarter of the person's weight, the greater of both, as a
    /// share of the force.
    pub uncertainty: f32,
    /// How many combinations of the law's two numbers the measurements determine, 0 to 2; the typical part gives the
    /// others. A straight line has one that matters, and counts with two once that is found.
    pub determined: u8,
    /// Load above which another kind of law, which fits about as well, gives a force that differs by more than a tenth;
    /// infinite without such a kind.
    pub sure_to: Newtons,
}

/// Reason for which stands give no calibration.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum StandError {
    /// Too few stands on the floor.
    #[error("a calibration needs at least {} stands, not {stands}", StandFit::MIN_STANDS)]
    TooFew {
        /// Stands that count.
        stands: usize,
    },
    /// The weight is not that of a search.
    #[error("a person weighs {} to {} N, not {weight_n} N", StandFit::WEIGHTS_N[0], StandFit::WEIGHTS_N[1])]
    Weight {
        /// The weight in newtons.
        weight_n: f32,
    },
    /// An output is not a number, or its position belongs to no sensor.
    #[error("stand {number} has an output that is not a number")]
    NotFinite {
        /// Position of the stand.
        number: usize,
    },
    /// One problem with more sensors takes too long.
    #[error(
        "{sensors} sensors are too many for one calibration: at most {}; take the tiles in parts",
        StandFit::MOST_SENSORS
    )]
    TooMany {
        /// Number of sensors.
        sensors: usize,
    },
    /// Many stands disagree with the others.
    #[error(
        "{astray} of {stands} stands disagree with the others: was each of them on the mark that was shown, and is \
         the weight right?"
    )]
    Astray {
        /// Stands that disagree.
        astray: usize,
        /// All stands without saturated sensors.
        stands: usize,
    },
    /// No law of any kind fits.
    #[error("no law fits: do the sensors answer to a load, and are they where the floor file has them?")]
    NoLaw,
}

/// Maximum share of the stands that may be astray (our choice).
const MOST_ASTRAY: f64 = 0.25;

impl StandFit {
    /// Minimum number of stands: as many as the unknowns of one sensor and a person's lean, less one.
    pub const MIN_STANDS: usize = 3;

    /// Maximum number of sensors: the time of a step grows with the third power, to seconds at this number.
    pub const MOST_SENSORS: usize = 1024;

    /// Range of a person's weight (N): 15 to 300 kg.
    pub const WEIGHTS_N: [f32; 2] = [147.0, 2942.0];

    /// Uncertainty of a sensor above which it needs more stands: the errors of the two to four sensors that share a
    /// foot average out to about 5 % of the foot.
    pub const MOST_UNCERTAIN: f32 = 0.08;

    /// Fits a law to each sensor of `data`, by laws of the kind that fits best, or of `kind`.
    ///
    /// One least-squares problem contains all sensors. Its equations: the forces of each stand add up to the weight;
    /// their centroid is at the mark, displaced by a lean that is the same for all stands; the mean force of each
    /// crossing is the weight. The parts of a floor resemble each other: each sensor's numbers are near common ones,
    /// which are unknown, and a sensor that carried little keeps those. Stands that disagree with the others by more
    /// than chance allows are left out.
    ///
    /// # Errors
    /// [`StandError`]
    ///
    /// # Source
    /// Bayesian linear regression with a common prior (Gelman and others, Bayesian Data Analysis, chapter 15), by
    /// Gauss-Newton steps for the laws' curves.
    pub fn of(
        data: &StandData,
        weight: Newtons,
        geometry: &Geometry,
        kind: Option<LawKind>,
    ) -> Result<Self, StandError> {
        validate(data, weight)?;
        let data = &data.compact();
        let silent = data.silent();
        let mut used = Used::of(data, &silent);
        let all = used.stands();
        let is_felt = data.stands.iter().any(|stand| !stand.loaded.is_empty());
        match data.stands.len() {
            Self::MIN_STANDS.. if !is_felt => return Err(StandError::NoLaw),
            _ if all < Self::MIN_STANDS => return Err(StandError::TooFew { stands: all }),
            _ => {}
        }
        let sensors = data.empty.len();
        if sensors > Self::MOST_SENSORS {
            return Err(StandError::TooMany { sensors });
        }
        let places: Vec<DVec2> = data
            .empty
            .iter()
            .map(|rest| geometry.sensor(rest.sensor.tile, rest.sensor.corner).as_dvec2())
            .collect();
        let search = StandSearch { data, places: &places, weight_n: weight.0.into(), silent };
        let kinds = || LawKind::ALL.into_iter().filter(|one| kind.is_none_or(|kind| kind == *one));
        let fits: Vec<RobustFit> = kinds().filter_map(|kind| search.robust(kind, &used)).collect();
        let laws = kinds().map(|kind| {
            let fit = fits.iter().find(|fit| fit.kind == kind);
            StandLaws { kind, misfit: fit.map_or(f64::INFINITY, |fit| fit.misfit) }
        });
        let laws: Vec<StandLaws> = laws.collect();
        let best = fits.iter().min_by(|one, other| one.misfit.total_cmp(&other.misfit));
        let RobustFit { kind, found, astray, misfit } = best.ok_or(StandError::NoLaw)?;
        if astray.len() as f64 > MOST_ASTRAY * all as f64 {
            return Err(StandError::Astray { astray: astray.len(), stands: all });
        }
        for stand in astray {
            if let Some(weight) = used.stands.get_mut(*stand) {
                *weight = 0.0;
            }
        }
        let fit = |kind, found| {
            let (curve, found) = search.solve(kind, &used, Some(found))?;
            Some(search.conclude(&curve, &used, &found, (laws.clone(), astray.clone())))
        };
        let mut best = fit(*kind, found).ok_or(StandError::NoLaw)?;
        let rivals = fits.iter().filter(|other| other.kind != *kind && is_alike(other.misfit, *misfit));
        rivals.filter_map(|other| fit(other.kind, &other.found)).for_each(|rival| best.note_rival(&rival));
        Ok(best)
    }

    /// Returns the sensors that need more stands: with a law that is not determined, or too uncertain.
    pub fn needy(&self) -> impl Iterator<Item = &SensorFit> {
        self.sensors.iter().filter(|sensor| sensor.needs_more())
    }
}

impl SensorFit {
    /// Whether it needs more stands.
    #[must_use]
    pub fn needs_more(&self) -> bool {
        self.determined == 0 || self.uncertainty.is_nan() || self.uncertainty > StandFit::MOST_UNCERTAIN
    }
}

/// Checks the weight and the outputs.
fn validate(data: &StandData, weight: Newtons) -> Result<(), StandError> {
    let [least, most] = StandFit::WEIGHTS_N;
    if !(least..=most).contains(&weight.0) {
        return Err(StandError::Weight { weight_n: weight.0 });
    }
    let sensors = data.empty.len();
    let is_known = |(sensor, volts): &(usize, f32)| *sensor < sensors && volts.is_finite();
    let is_whole = data.empty.iter().all(|rest| rest.volts.is_finite());
    let broken = data
        .stands
        .iter()
        .position(|stand| !is_whole || !stand.mark.at.is_finite() || !stand.loaded.iter().all(is_known));
    broken.map_or(Ok(()), |number| Err(StandError::NotFinite { number }))
}
