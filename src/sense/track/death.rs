//! Feet that have left, and feet that never were.

use super::birth::APART_M;
use super::foot::{Foot, LANDS_S, SHOE_M};
use super::landing::Landing;
use super::lines::{Axis, Lines};
use super::{Tracker, first_of_least};
use crate::sense::loaded::LoadedTiles;
use crate::sense::tile::LoadedTile;

/// Force below which a foot that shares its tiles may be gone, in newtons.
const FAINT_N: f64 = 4.0;

/// How long a foot must have seemed to be gone before it is, in seconds.
const FAINT_S: f64 = 0.01;

/// How fast it then is no longer taken to be, in seconds per second: a rim that comes and goes proves nothing.
const RECOVERS: f64 = 0.2;

/// How long a foot must seem to have handed its weight over to be gone, in seconds.
const HANDED_S: f64 = 0.04;

/// How long it must do so if only a rim's load on some tile may still be its own, in seconds.
const GHOST_S: f64 = 0.3;

/// Shares of what it once pressed with, and of what all feet there press with, below which a foot may have
/// handed its weight over.
const OF_ITS_MOST: f64 = 0.5;
const OF_ALL: f64 = 0.23;

/// How far the centre of pressure may then be from where the foot that has taken over rests, in metres.
const TAKEN_OVER_M: f64 = 0.05;

/// How far beyond the other feet's centres of pressure a tile is proof that a foot is there, in metres: for
/// one that seems to have handed over, and for one too light to be seen otherwise.
const OWN_M: f64 = 0.17;
const OWN_OF_FAINT_M: f64 = 0.23;

/// Share of all below which a tile's load is no proof.
const OWN_SHARE: f64 = 0.015;

/// How far from where the standing foot stands the common centre of pressure lies at least once another foot has taken
/// over, in metres: shoes do not overlap.
const BESIDE_M: f64 = 0.11;

/// A light load this near to a heavy foot, as a share of it, may be that foot's rim.
const RIM_SHARE: f64 = 0.08;
const RIM_M: f64 = 0.22;

/// How far no foot's centre of pressure moves by itself as its load goes, in metres.
const FAR_M: f64 = 0.12;

/// How long one foot must have been enough before two become one, in seconds.
const ENOUGH_S: f64 = 0.06;

/// How long it takes until weight is shifted to a foot put down beside a standing one, in seconds.
const SETTLES_S: f64 = 0.7;

/// How near to it the centre of pressure lies once it has taken over all of it, in metres.
const OVER_M: f64 = 0.025;

/// How little, as a share of all, the standing foot then still carries.
const LITTLE: f64 = 0.08;

/// How long a foot that has just landed is not doubted, in seconds.
const FRESH_S: f64 = 0.08;

/// How far from its home the centre of pressure of a foot that stands alone may lie, in metres.
const AT_HOME_M: f64 = 0.04;

/// Distance below which two feet may be two halves of one, in metres: side by side they are farther apart.
const HALVES_M: f64 = 0.12;

/// Half widths that the pressed patch of one whole foot may have, in metres.
const HALVES: [f64; 5] = [0.045, 0.065, 0.085, 0.11, 0.14];

/// What one foot's division over the tiles may differ from a patch's, as a share of its force.
const UNLIKE: f64 = 0.05;

impl Tracker {
    /// Takes away feet that are not there: too light for too long, or no longer needed to
    /// explain what the tiles carry.
    pub(super) fn bury(&mut self, tiles: &LoadedTiles, dt: f64) {
        self.near.renew(self.feet.iter().map(Foot::centre));
        for which in 0..self.feet.len() {
            let foot = &self.feet[which];
            let gone = if foot.shared {
                !self.has_own(foot, tiles.list(), OWN_OF_FAINT_M, 0.0)
                    && (foot.force() < FAINT_N || self.superfluous(which, tiles.list()))
            } else {
                self.is_rim(foot)
            };
            let haste = if gone {
                1.0
            } else if foot.shared {
                self.handed_over(foot, tiles.list()).map_or(0.0, |time_s| FAINT_S / time_s)
            } else {
                0.0
            };
            let foot = &mut self.feet[which];
            let change = if haste > 0.0 { haste } else { -RECOVERS };
            foot.faint = (foot.faint + change * dt).max(0.0);
            if foot.faint >= FAINT_S {
                for mate in self.mates.of(foot.group) {
                    self.feet[mate].be_calm();
                }
            }
        }
        for which in 0..self.feet.len() {
            if self.feet[which].faint >= FAINT_S {
                self.bequeath(which);
            }
        }
        let groups = self.feet.len();
        self.feet.retain(|foot| foot.faint < FAINT_S);
        self.find_mates(groups);
        self.unite(tiles, dt);
    }

    /// Leaves what foot `which`, which is gone, still pressed to the nearest of those it was with: that is no newcomer.
    fn bequeath(&mut self, which: usize) {
        let gone = &self.feet[which];
        let mates = self.mates.of(gone.group).filter(|&mate| self.feet[mate].faint < FAINT_S);
        let away = mates.map(|mate| (self.feet[mate].centre().distance(gone.centre()), mate));
        // Farther away than a shoe is long, it is nothing of theirs.
        let heir = away.filter(|&(distance, _)| distance < SHOE_M).min_by(first_of_least);
        let Some((_, heir)) = heir else { return };
        let left = std::mem::take(&mut self.feet[which].tiles);
        self.feet[heir].inherit(&left);
    }

    /// For how many seconds a foot must seem to have handed its weight over to the others, as it does now, to be gone:
    /// what little is left to it may as well be what is not known of them. `None` if it does not seem so.
    fn handed_over(&self, foot: &Foot, list: &[LoadedTile]) -> Option<f64> {
        let all: f64 = self.mates.of(foot.group).map(|mate| self.feet[mate].force()).sum();
        if foot.force() > OF_ITS_MOST * foot.peak || foot.force() > OF_ALL * all {
            return None;
        }
        let mut others = self.mates(foot);
        if let (Some(other), None) = (others.next(), others.next()) {
            let both = foot.tiles_with(other);
            let lines = Lines::of(both.iter().map(|&position| &list[position as usize]), self.cells.pitch);
            if lines.middle.distance(other.home) > TAKEN_OVER_M {
                return None;
            }
            // Nobody has a foot where the other one stands.
            if other.landing.is_some_and(|landing| landing.host == foot.id && is_on_host(landing, &lines)) {
                return None;
            }
        }
        if self.has_own(foot, list, OWN_M, OWN_SHARE * all) {
            None
        } else if self.has_own(foot, list, OWN_M, 0.0) {
            Some(GHOST_S)
        } else {
            Some(HANDED_S)
        }
    }

    /// The other feet of its group.
    fn mates(&self, foot: &Foot) -> impl Iterator<Item = &Foot> {
        let id = foot.id;
        self.mates.of(foot.group).map(|mate| &self.feet[mate]).filter(move |mate| mate.id != id)
    }

    /// Whether it is all that is left of a foot that has gone: the rim of a heavy one, on a tile that both pressed.
    fn is_rim(&self, foot: &Foot) -> bool {
        let (place, force) = (foot.centre(), foot.force());
        foot.home.distance(place).max(foot.landed.distance(place)) > FAR_M
            && self.near.around(place).map(|other| &self.feet[other]).any(|other| {
                other.id != foot.id
                    && force < RIM_SHARE * other.force()
                    && other.centre().distance(place) < RIM_M
            })
    }

    /// Whether it presses a tile with more than `least` newtons that none of the others can reach: proof that it is still
    /// there.
    fn has_own(&self, foot: &Foot, list: &[LoadedTile], reach: f64, least: f64) -> bool {
        let tiles = foot.tiles.iter().map(|&position| &list[position as usize]);
        tiles.filter(|tile| f64::from(tile.wrench.force) > least).any(|tile| {
            let place = tile.centroid.as_dvec2();
            self.mates(foot).all(|other| other.centre().distance(place) > reach)
        })
    }

    /// Makes one foot of two where one has been enough for some time.
    fn unite(&mut self, tiles: &LoadedTiles, dt: f64) {
        for a in 0..self.feet.len() {
            let foot = &self.feet[a];
            let mut mates = self.mates.of(foot.group).filter(|&b| b != a);
            let (Some(b), None) = (mates.next(), mates.next()) else {
                self.feet[a].spare = 0.0;
                continue;
            };
            if b < a || !foot.shared {
                continue;
            }
            let both = foot.tiles_with(&self.feet[b]);
            let list = tiles.list();
            let lines = Lines::of(both.iter().map(|&position| &list[position as usize]), self.cells.pitch);
            let stay = self.enough(a, b, &lines);
            for which in [a, b] {
                let foot = &mut self.feet[which];
                foot.spare = if stay.is_some_and(|stay| stay != which) { foot.spare + dt } else { 0.0 };
            }
            if let Some(stay) = stay {
                let gone = if stay == a { b } else { a };
                if self.feet[gone].spare > ENOUGH_S {
                    let foot = &mut self.feet[stay];
                    foot.stand(lines.force, lines.middle);
                    foot.inherit(&both);
                    foot.be_calm();
                }
            }
        }
        self.feet.retain(|foot| foot.spare <= ENOUGH_S);
    }

    /// Whether the tiles carry what the foot that shares them with foot `which` presses
    /// on them when alone, as if `which` were not there.
    fn superfluous(&self, which: usize, list: &[LoadedTile]) -> bool {
        let foot = &self.feet[which];
        if foot.age < FRESH_S {
            return false;
        }
        let mut others = self.mates(foot);
        let (Some(host), None) = (others.next(), others.next()) else { return false };
        if host.centre().distance(foot.centre()) < 0.6 * APART_M {
            return host.age >= foot.age;
        }
        if foot.alone_at.is_none() && foot.centre().distance(foot.landed) > SHOE_M {
            // Never seen by itself, and too far from where it landed to be the same foot still.
            return true;
        }
        let Some(home) = host.alone_at else { return false };
        if foot.force() > 0.4 * host.force() && foot.age > host.age {
            return false;
        }
        let both = host.tiles_with(foot);
        let pitch = self.cells.pitch;
        let lines = Lines::of(both.iter().map(|&position| &list[position as usize]), pitch);
        lines.middle.distance(home) < 0.012
            && lines.lines.iter().all(|line| {
                let axis = line.axis;
                let slice = line.slice(pitch, axis.along(lines.middle), axis.along(host.half()));
                let habit = host.habit_at(axis, line.number, 1.0);
                (line.force / lines.force - slice.share - habit.share).abs() < 0.012
            })
    }

    /// Which of the two feet `a` and `b`, if either, is enough to explain what their tiles carry.
    fn enough(&self, a: usize, b: usize, lines: &Lines) -> Option<usize> {
        let (first, second) = (&self.feet[a], &self.feet[b]);
        // Of a foot put down beside a standing one more is known than what one frame's tiles carry.
        let age = first.age.min(second.age);
        let guest = if first.has_landed_beside(second) {
            Some(a)
        } else {
            second.has_landed_beside(first).then_some(b)
        };
        if guest.is_some() && age < SETTLES_S {
            return None;
        }
        if age < LANDS_S {
            return None;
        }
        let landing = guest.and_then(|guest| self.feet[guest].landing);
        if landing.is_some_and(|landing| is_on_host(landing, lines)) {
            return None;
        }
        let apart = [first, second].map(|foot| foot.home.distance(lines.middle));
        let (near, stay) = if apart[0] <= apart[1] { (apart[0], a) } else { (apart[1], b) };
        let gone = if stay == a { second } else { first };
        if guest.is_some_and(|guest| guest != stay || near > OVER_M || gone.force() > LITTLE * lines.force) {
            return None;
        }
        let close = first.centre().distance(second.centre()) < HALVES_M;
        ((near < AT_HOME_M || close) && one_patch(lines, self.cells.pitch)).then_some(stay)
    }
}

/// Whether the common centre of pressure still lies where only the foot stands that another has landed beside.
fn is_on_host(landing: Landing, lines: &Lines) -> bool {
    lines.middle.distance(landing.from) < BESIDE_M - lines.doubt
}

/// Whether one foot's patch can divide over the lines as their loads do.
fn one_patch(lines: &Lines, pitch: f64) -> bool {
    Axis::BOTH.into_iter().all(|axis| {
        HALVES.into_iter().any(|half| {
            lines.lines.iter().filter(|line| line.axis == axis).all(|line| {
                let slice = line.slice(pitch, axis.along(lines.middle), half);
                let share = line.force / lines.force - slice.share;
                let moment = line.moment / lines.force - slice.moment;
                share.abs() < UNLIKE && moment.abs() < UNLIKE * 0.5 * pitch
            })
        })
    })
}
