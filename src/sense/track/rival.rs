//! A rival explanation of the loads of a group of feet, and its place in the filter's stead.

use super::params::reach::AROUND_M;
use super::params::rivals::{GONE_S, OVER_STEP_M, STRAYED_M};
use glam::DVec2;

use super::groups::Group;
use super::initiate::CandidateTrack;
use super::outline::FanExtents;
use super::state::Track;
use super::touchdown::Touchdown;
use crate::sense::centroid::tile::LoadedTile;

/// A rival explanation.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rival {
    /// All feet stayed but this one, which is at this place now.
    Moved(usize, DVec2),
    /// All feet have moved this way.
    Together(DVec2),
    /// A further foot has landed at this place.
    Further(DVec2),
    /// The first foot is a part of the second one, which is at this place now.
    Without(usize, usize, DVec2),
}

impl Rival {
    /// Whether it is the same explanation as `other`, whatever the places.
    pub(super) fn is_like(self, other: Self) -> bool {
        match (self, other) {
            (Self::Moved(one, _), Self::Moved(another, _)) => one == another,
            (Self::Without(one, ..), Self::Without(another, ..)) => one == another,
            _ => std::mem::discriminant(&self) == std::mem::discriminant(&other),
        }
    }

    /// Whether it has another number of feet than the filter, or one of them elsewhere.
    pub(super) fn differs_from(self, group: &Group<'_>) -> bool {
        let is_elsewhere = |(which, foot): (usize, &&mut Track)| foot.is_elsewhere_under(self, which);
        matches!(self, Self::Further(_) | Self::Without(..)) || group.iter().enumerate().any(is_elsewhere)
    }
}

impl Track {
    /// Its place as foot `which` of its group if `rival` is right.
    fn place_under(&self, rival: Rival, which: usize) -> DVec2 {
        match rival {
            Rival::Moved(moved, place) | Rival::Without(_, moved, place) if moved == which => place,
            Rival::Together(way) => self.stillness.rest_point + way,
            _ => self.stillness.rest_point,
        }
    }

    pub(super) fn is_elsewhere_under(&self, rival: Rival, which: usize) -> bool {
        self.place_under(rival, which).distance(self.centre()) > STRAYED_M
    }

    /// Distance of its centre of pressure from its rest point (m).
    pub(super) fn strayed(&self) -> f64 {
        self.centre().distance(self.stillness.rest_point)
    }
}

/// Replaces the filter's explanation by `rival`.
pub(super) fn adopt(group: &mut Group<'_>, rival: Rival, forces: &[f64], list: &[LoadedTile]) {
    for ((which, foot), &force) in group.iter_mut().enumerate().zip(forces) {
        if matches!(rival, Rival::Without(gone, ..) if gone == which) {
            foot.empty_s = GONE_S;
            continue;
        }
        let place = foot.place_under(rival, which);
        if foot.strayed() > STRAYED_M {
            foot.outline = FanExtents::new(foot.stillness.rest_point);
        }
        foot.rest_at(force, place);
        foot.restart_smoothing();
        foot.doubt.nis = 0.0;
    }
    // A touchdown beside one of them goes on from its new place.
    for which in 0..group.len() {
        let Some(existing) = group[which].arrivals.touchdown.map(|touchdown| touchdown.existing) else {
            continue;
        };
        let place = group.iter().find(|foot| foot.id == existing).map(|foot| foot.centre());
        group[which].arrivals.touchdown = place.map(|from| Touchdown { existing, from });
    }
    let Rival::Further(place) = rival else { return };
    let Some(&force) = forces.get(group.len()) else { return };
    let away = |foot: &&mut &mut Track| foot.stillness.rest_point.distance(place);
    let Some(nearest) = group.iter_mut().min_by(|a, b| away(a).total_cmp(&away(b))) else { return };
    let under = |position: &&u32| list[**position as usize].centroid.as_dvec2().distance(place) < AROUND_M;
    let tiles = nearest.tiles.iter().filter(under).copied().collect();
    nearest.arrivals.candidate = Some(CandidateTrack::found(force, place, OVER_STEP_M, tiles));
}
