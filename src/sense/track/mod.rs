//! Several feet followed through time, also where they share tiles.
//!
//! Each foot is a force, a centre of pressure, their rates, and a patch around
//! that centre. A foot alone on its tiles is measured by Eq. 4. Feet that share
//! tiles are estimated together by an extended Kalman filter ([`joint`]) that
//! predicts the force and both moments of every tile.
//!
//! A newcomer is what a tile carries that the feet already there cannot account
//! for: load too far from all of them, or a leap of the common centroid that no
//! foot makes ([`birth`]). A foot is gone when it has no load left, or when what
//! the tiles carry is what another foot, known from when it was alone, presses.
//!
//! All numbers that describe feet come from what feet are and how people walk
//! and stand: the length of a shoe, how fast a centre of pressure rolls, how fast
//! weight is taken over. None is fitted to a recording.

mod birth;
mod describe;
mod foot;
mod joint;
mod lines;
mod measure;
mod patch;

use glam::DVec2;

use self::birth::APART_M;
use self::foot::{EAST, FORCE, Foot, NORTH, SHOE_M, STATES};
use self::joint::{Joint, MOST_FEET};
use self::lines::{Axis, Lines};
use self::measure::{observe, predict};
use super::contact::ContactId;
use super::doubt::SensorDoubt;
use super::loaded::LoadedTiles;
use super::pool::ContactPool;
use super::tile::LoadedTile;
use crate::floor::Geometry;

/// Follows feet over one floor.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    doubt: SensorDoubt,
    cells: Cells,
    next: u32,
    feet: Vec<Foot>,
    links: Vec<Link>,
    new_links: Vec<Link>,
    joint: Box<Joint>,
    /// Per loaded tile: the first foot that reaches it, or `NOBODY`.
    owner: Vec<u32>,
    orphans: Vec<u32>,
    members: Vec<u32>,
}

const NOBODY: u32 = u32::MAX;

/// The covariance between two feet that are estimated together.
#[derive(Clone, Copy, Debug)]
struct Link {
    first: ContactId,
    second: ContactId,
    cross: [[f64; STATES]; STATES],
}

/// Over which time surprise is averaged, in seconds.
const SURPRISE_S: f64 = 0.05;

/// Force below which a foot that shares its tiles may be gone, in newtons.
const FAINT_N: f64 = 4.0;

/// How long a foot must have seemed to be gone before it is, in seconds.
const FAINT_S: f64 = 0.01;

/// How long after a companion has gone a foot's own sway is not taken for a new one, in seconds.
const CALM_S: f64 = 0.25;

/// The cells of the floor's tiles, without gaps between them.
#[derive(Clone, Copy, Debug)]
struct Cells {
    pitch: f64,
    columns: u16,
    rows: u16,
}

impl Cells {
    fn count(&self, axis: Axis) -> i32 {
        match axis {
            Axis::East => self.columns.into(),
            Axis::North => self.rows.into(),
        }
    }

    fn of(&self, tile: &LoadedTile) -> (DVec2, DVec2) {
        let low = DVec2::new(tile.tile.column.into(), tile.tile.row.into()) * self.pitch;
        (low, low + self.pitch)
    }
}

impl Tracker {
    pub(super) fn new(geometry: &Geometry, doubt: SensorDoubt) -> Self {
        let room = geometry.tile_count().min(1024);
        Self {
            doubt,
            cells: Cells {
                pitch: geometry.pitch_m().into(),
                columns: geometry.columns(),
                rows: geometry.rows(),
            },
            next: 1,
            feet: Vec::with_capacity(room),
            links: Vec::with_capacity(room),
            new_links: Vec::with_capacity(room),
            joint: Box::new(Joint::new()),
            owner: Vec::with_capacity(room),
            orphans: Vec::with_capacity(room),
            members: Vec::with_capacity(room),
        }
    }

    /// Fills `pool` with this frame's contacts; `dt` seconds have passed since the last frame.
    pub(super) fn update(&mut self, tiles: &LoadedTiles, dt: f32, pool: &mut ContactPool) {
        let dt = f64::from(dt);
        for foot in &mut self.feet {
            foot.foretell(dt);
            foot.reach(tiles, self.cells.pitch);
        }
        self.adopt(tiles.list());
        self.find_newcomers(tiles);
        self.feet.retain(|foot| !foot.tiles.is_empty());
        self.group(tiles.list().len());
        self.estimate(tiles, dt);
        self.bury(tiles, dt);
        self.learn(tiles, dt);
        self.describe(tiles, pool);
    }

    fn name(&mut self) -> ContactId {
        let id = ContactId(self.next);
        self.next = self.next.wrapping_add(1);
        id
    }

    /// Finds who reaches which tile, gives tiles nobody reaches to the nearest foot that
    /// may have grown onto them, and lets new feet land on the rest.
    fn adopt(&mut self, list: &[LoadedTile]) {
        self.owner.clear();
        self.owner.resize(list.len(), NOBODY);
        for (which, foot) in self.feet.iter().enumerate() {
            for &position in &foot.tiles {
                self.owner[position as usize] = which as u32;
            }
        }
        self.orphans.clear();
        self.orphans
            .extend((0..list.len() as u32).filter(|&position| self.owner[position as usize] == NOBODY));
        self.orphans.sort_unstable_by(|&a, &b| {
            let force = |position: u32| list[position as usize].wrench.force;
            force(b).total_cmp(&force(a)).then(a.cmp(&b))
        });
        for orphan in 0..self.orphans.len() {
            let position = self.orphans[orphan];
            let tile = &list[position as usize];
            let centroid = tile.centroid.as_dvec2();
            let force = f64::from(tile.wrench.force);
            let nearest = self
                .feet
                .iter()
                .enumerate()
                .map(|(which, foot)| (which, foot.beyond(centroid)))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .filter(|&(_, beyond)| beyond < 0.0);
            match nearest {
                Some((which, _)) => {
                    let foot = &mut self.feet[which];
                    foot.tiles.push(position);
                    if foot.age == 0.0 {
                        // A foot that lands on several tiles at once: its middle is theirs.
                        let whole = foot.force() + force;
                        let centre = foot.centre() + (centroid - foot.centre()) * (force / whole);
                        foot.state[FORCE] = whole;
                        foot.state[EAST] = centre.x;
                        foot.state[NORTH] = centre.y;
                    }
                    self.owner[position as usize] = which as u32;
                }
                None => {
                    let mut foot = Foot::new(self.name(), force, centroid, 0.02);
                    foot.tiles.push(position);
                    self.owner[position as usize] = self.feet.len() as u32;
                    self.feet.push(foot);
                }
            }
        }
    }

    /// Numbers the groups of feet that share tiles: each foot's group is its first member's number.
    fn group(&mut self, tiles: usize) {
        self.owner.clear();
        self.owner.resize(tiles, NOBODY);
        for which in 0..self.feet.len() {
            self.feet[which].group = which as u32;
            self.feet[which].crowded = false;
            for at in 0..self.feet[which].tiles.len() {
                let position = self.feet[which].tiles[at] as usize;
                let owner = self.owner[position];
                if owner == NOBODY {
                    self.owner[position] = which as u32;
                    continue;
                }
                let (mine, theirs) = (self.feet[which].group, self.feet[owner as usize].group);
                if mine != theirs {
                    let (keep, drop) = (mine.min(theirs), mine.max(theirs));
                    for foot in &mut self.feet[..=which] {
                        if foot.group == drop {
                            foot.group = keep;
                        }
                    }
                    self.feet[keep as usize].crowded = true;
                }
            }
        }
    }

    /// Measures feet that are alone on their tiles, estimates those that are not.
    fn estimate(&mut self, tiles: &LoadedTiles, dt: f64) {
        self.new_links.clear();
        for which in 0..self.feet.len() {
            if self.feet[which].group != which as u32 {
                continue;
            }
            if !self.feet[which].crowded {
                self.feet[which].shared = false;
                self.feet[which].alone(tiles.list(), dt);
                continue;
            }
            self.members.clear();
            for (other, foot) in self.feet.iter_mut().enumerate().skip(which) {
                if foot.group != which as u32 {
                    continue;
                }
                if !foot.shared {
                    foot.keep_shape();
                }
                foot.shared = true;
                // A crowd beyond what one filter holds: the rest go on as foretold, as guesses.
                foot.beyond_filter = self.members.len() >= MOST_FEET;
                if !foot.beyond_filter {
                    self.members.push(other as u32);
                }
            }
            self.estimate_together(tiles, dt);
        }
        std::mem::swap(&mut self.links, &mut self.new_links);
    }

    /// One step of the joint filter over the feet in `members`.
    fn estimate_together(&mut self, tiles: &LoadedTiles, dt: f64) {
        let members = &self.members;
        let list = tiles.list();
        let joint = &mut self.joint;
        joint.clear();
        for &member in members {
            joint.add(&self.feet[member as usize]);
        }
        for (first, &a) in members.iter().enumerate() {
            for (second, &b) in members.iter().enumerate().skip(first + 1) {
                let (a, b) = (self.feet[a as usize].id, self.feet[b as usize].id);
                if let Some(link) = self.links.iter().find(|link| link.first == a && link.second == b) {
                    joint.link(first, second, &link.cross);
                }
            }
        }
        predict(joint, members, &self.feet, dt);
        joint.confine();
        for (which, &member) in members.iter().enumerate() {
            joint.take(which, &mut self.feet[member as usize]);
        }
        let surprise = observe(joint, members, &self.feet, list, &self.cells, dt);
        joint.confine();
        let weight = 1.0 - (-dt / SURPRISE_S).exp();
        for (which, &member) in members.iter().enumerate() {
            let foot = &mut self.feet[member as usize];
            joint.take(which, foot);
            foot.surprise += weight * (surprise - foot.surprise);
        }
        for (first, &a) in members.iter().enumerate() {
            for (second, &b) in members.iter().enumerate().skip(first + 1) {
                self.new_links.push(Link {
                    first: self.feet[a as usize].id,
                    second: self.feet[b as usize].id,
                    cross: joint.cross(first, second),
                });
            }
        }
    }

    /// Takes away feet that are not there: too light for too long, or no longer needed to
    /// explain what the tiles carry.
    fn bury(&mut self, tiles: &LoadedTiles, dt: f64) {
        for which in 0..self.feet.len() {
            let foot = &self.feet[which];
            let gone = foot.shared && (foot.force() < FAINT_N || self.superfluous(which, tiles.list()));
            let foot = &mut self.feet[which];
            foot.faint = if gone { foot.faint + dt } else { 0.0 };
            if foot.faint >= FAINT_S {
                let group = foot.group;
                for mate in self.feet.iter_mut().filter(|mate| mate.group == group) {
                    mate.calm = CALM_S;
                }
            }
        }
        self.feet.retain(|foot| foot.faint < FAINT_S);
    }

    /// Whether the tiles carry what the foot that shares them with foot `which` presses
    /// on them when alone, as if `which` were not there.
    fn superfluous(&self, which: usize, list: &[LoadedTile]) -> bool {
        let foot = &self.feet[which];
        let mut others =
            self.feet.iter().enumerate().filter(|&(other, o)| other != which && o.group == foot.group);
        let (Some((_, host)), None) = (others.next(), others.next()) else { return false };
        if host.centre().distance(foot.centre()) < 0.6 * APART_M {
            return host.age >= foot.age;
        }
        if foot.centre().distance(foot.landed) > SHOE_M {
            // Too far from where it landed to be the same foot still.
            return true;
        }
        let Some(home) = host.alone_at else { return false };
        if foot.force() > 0.4 * host.force() && foot.age > host.age {
            return false;
        }
        let mut seen = host.tiles.clone();
        for &position in &foot.tiles {
            if !seen.contains(&position) {
                seen.push(position);
            }
        }
        let pitch = self.cells.pitch;
        let lines = Lines::of(seen.iter().map(|&position| &list[position as usize]), pitch);
        lines.middle.distance(home) < 0.012
            && lines.lines.iter().all(|line| {
                let axis = line.axis;
                let slice = line.slice(pitch, axis.along(lines.middle), axis.along(host.half()));
                let habit = host.habit_at(axis, line.number, 1.0);
                (line.force / lines.force - slice.share - habit.share).abs() < 0.012
            })
    }

    /// Lets each foot's slow past learn from this frame.
    fn learn(&mut self, tiles: &LoadedTiles, dt: f64) {
        let list = tiles.list();
        for foot in &mut self.feet {
            foot.learn_past(dt);
            foot.roll(dt);
            if !foot.shared {
                foot.learn_habits(list, self.cells.pitch, dt);
            }
            for at in 0..foot.tiles.len() {
                let tile = &list[foot.tiles[at] as usize];
                let (force, moment) = if foot.shared {
                    let on = foot.on(self.cells.of(tile));
                    (on.share() * foot.force(), on.moment() * foot.force())
                } else {
                    let force = f64::from(tile.wrench.force);
                    (force, (tile.centroid - tile.centre).as_dvec2() * force)
                };
                foot.learn_load(tile.index, force, moment, dt);
            }
            foot.forget_loads();
        }
    }
}
