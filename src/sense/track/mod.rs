//! Several feet followed through time, also where they share tiles.
//!
//! Each foot is a force, a centre of pressure, their rates, and a patch around
//! that centre. A foot alone on its tiles is measured by Eq. 4. Feet that share
//! tiles are estimated together by an extended Kalman filter ([`joint`]) that
//! predicts the force and both moments of every tile.
//!
//! A newcomer is what a tile carries that the feet already there cannot account
//! for: load too far from all of them, or a leap of the common centroid that no
//! foot makes.

mod foot;
mod joint;
mod lines;
mod patch;

use glam::DVec2;
use smallvec::SmallVec;

use self::foot::{EAST, FORCE, Foot, HALF_EAST, HALF_NORTH, HALF_REST, NORTH, SHOE_M, STATES};
use self::joint::{Joint, MOST_FEET, Slope};
use self::lines::{Axis, Lines};
use super::contact::{ContactId, Covariance, TileLoad};
use super::doubt::SensorDoubt;
use super::loaded::LoadedTiles;
use super::pool::ContactPool;
use super::tile::LoadedTile;
use crate::floor::Geometry;
use crate::units::Newtons;

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

/// A foot that has just landed among another's tiles.
#[derive(Clone, Debug, Default)]
struct Newcomer {
    force: f64,
    place: DVec2,
    deviation: f64,
    /// Positions of the tiles on which it was noticed, in the list of loaded tiles.
    tiles: SmallVec<[u32; 4]>,
}

/// How far force that strays over a seam is spread along it, as a standard deviation.
const SPREAD_M: f64 = 0.05;

/// Least distance between the centres of pressure of two feet: side by side, touching.
const APART_M: f64 = 0.08;

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

    /// Lets feet land on tiles that others already press.
    fn find_newcomers(&mut self, tiles: &LoadedTiles) {
        let list = tiles.list();
        for which in 0..self.feet.len() {
            let foot = &self.feet[which];
            if foot.age == 0.0 || foot.shared {
                continue;
            }
            let Some(newcomer) = self.newcomer(foot, list) else { continue };
            let others = self.feet.iter().enumerate().filter(|&(other, _)| other != which);
            let nearest = others
                .map(|(other, foot)| {
                    (other, foot.beyond(newcomer.place), foot.centre().distance(newcomer.place))
                })
                .filter(|&(_, beyond, distance)| beyond < 0.0 || distance < APART_M)
                .min_by(|a, b| a.2.total_cmp(&b.2));
            if let Some((other, ..)) = nearest {
                // Not a newcomer, but more of a foot that is already there.
                let known = &mut self.feet[other];
                for &position in &newcomer.tiles {
                    if !known.tiles.contains(&position) {
                        known.tiles.push(position);
                    }
                }
                continue;
            }
            if foot.centre().distance(newcomer.place) < APART_M {
                continue;
            }
            let mut newborn = Foot::new(self.name(), newcomer.force, newcomer.place, newcomer.deviation);
            newborn.covariance[FORCE][FORCE] = (0.3 * newcomer.force + 5.0).powi(2);
            newborn.covariance[FORCE + 1][FORCE + 1] = 8000.0_f64.powi(2);
            newborn.reach(tiles, self.cells.pitch);
            for &position in &newcomer.tiles {
                if !newborn.tiles.contains(&position) {
                    newborn.tiles.push(position);
                }
            }
            if !newborn.tiles.is_empty() {
                self.feet[which].step_back();
                self.feet.push(newborn);
            }
        }
    }

    /// The foot that has landed among the tiles of `foot`, if one has.
    fn newcomer(&self, foot: &Foot, list: &[LoadedTile]) -> Option<Newcomer> {
        let mut whole = 0.0;
        let mut sum = DVec2::ZERO;
        let mut found = Newcomer::default();
        for &position in &foot.tiles {
            let tile = &list[position as usize];
            let force = f64::from(tile.wrench.force);
            let centroid = tile.centroid.as_dvec2();
            whole += force;
            sum += centroid * force;
            let slow = foot.slow_load(tile.index);
            let centre = tile.centre.as_dvec2();
            let added = force - slow.force;
            if added < 10.0 {
                continue;
            }
            let moment = (centroid - centre) * force - slow.moment;
            // Moment of what was added about the foot's own centre of pressure.
            let about = moment + (centre - foot.past.centre) * added;
            let place = centre + moment / added;
            let (low, high) = self.cells.of(tile);
            let inside = place.cmpge(low - 0.02).all() && place.cmple(high + 0.02).all();
            // What the foot's own sway may look like, at its own centre of pressure.
            let sway = slow.force * 0.012;
            if inside && about.length() > added * 0.08 + sway && foot.beyond(place) > sway / added {
                found.place =
                    (found.place * found.force + place.clamp(low, high) * added) / (found.force + added);
                found.force += added;
                found.deviation = found.deviation.max(0.02 + (slow.force * 0.006 / added).min(0.1));
                found.tiles.push(position);
            }
        }
        if found.force > 0.0 {
            return Some(found);
        }
        let leap = sum / whole - foot.past.centre;
        if foot.age > 0.12 && whole > 120.0 && leap.length() > 0.02 {
            let moment = leap * whole;
            let added = (whole - foot.past.force).max(moment.length() / 0.45);
            if added < whole {
                let place = foot.past.centre + moment / added;
                return Some(Newcomer { force: added, place, deviation: 0.08, ..Newcomer::default() });
            }
        }
        None
    }

    /// Numbers the groups of feet that share tiles: each foot's group is its first member's number.
    fn group(&mut self, tiles: usize) {
        self.owner.clear();
        self.owner.resize(tiles, NOBODY);
        for which in 0..self.feet.len() {
            self.feet[which].group = which as u32;
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
                }
            }
        }
    }

    fn estimate(&mut self, tiles: &LoadedTiles, dt: f64) {
        self.new_links.clear();
        for which in 0..self.feet.len() {
            if self.feet[which].group != which as u32 {
                continue;
            }
            self.members.clear();
            for (other, foot) in self.feet.iter().enumerate().skip(which) {
                if foot.group == which as u32 {
                    self.members.push(other as u32);
                }
            }
            let shared = self.members.len() > 1;
            for &member in &self.members {
                let foot = &mut self.feet[member as usize];
                if shared && !foot.shared {
                    foot.keep_shape();
                }
                foot.shared = shared;
            }
            if shared {
                self.estimate_together(tiles, dt);
            } else {
                self.feet[which].alone(tiles.list(), dt);
            }
        }
        std::mem::swap(&mut self.links, &mut self.new_links);
    }

    /// One step of the joint filter over the feet in `members`.
    fn estimate_together(&mut self, tiles: &LoadedTiles, dt: f64) {
        self.members.truncate(MOST_FEET);
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
        observe(joint, members, &self.feet, list, &self.cells, dt);
        joint.confine();
        for (which, &member) in members.iter().enumerate() {
            joint.take(which, &mut self.feet[member as usize]);
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
            let gone = foot.shared && (foot.force() < 8.0 || self.superfluous(which, tiles.list()));
            let foot = &mut self.feet[which];
            foot.faint = if gone { foot.faint + dt } else { 0.0 };
        }
        self.feet.retain(|foot| foot.faint < 0.01);
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

    fn describe(&mut self, tiles: &LoadedTiles, pool: &mut ContactPool) {
        let list = tiles.list();
        pool.clear();
        // What all feet together are expected to press on each tile.
        for foot in &mut self.feet {
            let variance = foot.covariance[EAST][EAST].max(foot.covariance[NORTH][NORTH]);
            foot.ambiguous = foot.shared && variance > 0.04_f64.powi(2);
            let contact = pool.add(foot.id);
            contact.centroid = foot.centre().as_vec2();
            contact.force = Newtons(foot.force() as f32);
            contact.velocity = foot.velocity().as_vec2();
            contact.ambiguous = foot.ambiguous;
            let mut covariance = if foot.shared {
                Covariance {
                    xx: foot.covariance[EAST][EAST] as f32,
                    xy: foot.covariance[EAST][NORTH] as f32,
                    yy: foot.covariance[NORTH][NORTH] as f32,
                }
            } else {
                Covariance::default()
            };
            for &position in &foot.tiles {
                let tile = &list[position as usize];
                let (share, load) = part_of(foot, tile, &self.cells);
                if load.force.0 > 0.0 {
                    contact.tiles.push(load);
                }
                contact.quality = contact.quality.max(tile.quality);
                covariance +=
                    self.doubt.covariance(tiles.geometry(), tile, share, contact.centroid, contact.force.0);
            }
            contact.covariance = covariance;
            contact.finish();
        }
        pool.sort_by_id();
    }
}

/// What `foot` presses on `tile`: as a share of the tile's load, and in newtons.
fn part_of(foot: &Foot, tile: &LoadedTile, cells: &Cells) -> (f32, TileLoad) {
    let whole = TileLoad {
        tile: tile.tile,
        index: tile.index as usize,
        force: Newtons(tile.wrench.force),
        centroid: tile.centroid,
    };
    if !foot.shared {
        return (1.0, whole);
    }
    let on = foot.on(cells.of(tile));
    let force = (foot.force() * on.share()) as f32;
    let share = (force / tile.wrench.force).min(1.0);
    let arm = if on.share() > 1e-6 { (on.moment() / on.share()).as_vec2() } else { glam::Vec2::ZERO };
    (share, TileLoad { force: Newtons(force.min(tile.wrench.force)), centroid: tile.centre + arm, ..whole })
}

/// Lets `dt` seconds pass for the feet in `members`.
fn predict(joint: &mut Joint, members: &[u32], feet: &[Foot], dt: f64) {
    const FORCE_FADE_S: f64 = 0.03;
    const FORCE_RATE: f64 = 5000.0;
    const PLACE_FADE_S: f64 = 0.08;
    const SPEED: f64 = 0.4;
    const HALF_FADE_S: f64 = 0.3;
    const HALF_SPREAD: f64 = 0.04;
    for (which, &member) in members.iter().enumerate() {
        let at = which * STATES;
        // A foot that has stood still is expected to go on standing still.
        let speed = (2.0 * feet[member as usize].restless).clamp(0.05, SPEED);
        for (value, fade_s, rate) in
            [(FORCE, FORCE_FADE_S, FORCE_RATE), (EAST, PLACE_FADE_S, speed), (NORTH, PLACE_FADE_S, speed)]
        {
            let fade = (-dt / fade_s).exp();
            joint.drift(at + value, fade_s * (1.0 - fade), fade, rate * rate * (1.0 - fade * fade));
        }
        // What a foot is known to be shaped like, it keeps while it stays where it is.
        let loose = 1.0 - feet[member as usize].habit_strength();
        let fade = (-dt * loose / HALF_FADE_S).exp();
        for half in [HALF_EAST, HALF_NORTH] {
            joint.relax(at + half, HALF_REST, fade, HALF_SPREAD * HALF_SPREAD * (1.0 - fade * fade));
        }
    }
}

/// Shows the joint filter what the tiles of its feet carry.
fn observe(joint: &mut Joint, members: &[u32], feet: &[Foot], list: &[LoadedTile], cells: &Cells, dt: f64) {
    // Errors of the patch model last for tens of milliseconds: many frames see the same one.
    let frames = (0.03 / dt.max(1e-4)).max(1.0);
    let mut seen: arrayvec::ArrayVec<u32, 64> = arrayvec::ArrayVec::new();
    for &member in members {
        for &position in &feet[member as usize].tiles {
            if !seen.contains(&position) && !seen.is_full() {
                seen.push(position);
            }
        }
    }
    let mut lines = Lines::of(seen.iter().map(|&position| &list[position as usize]), cells.pitch);
    let (force, middle) = (lines.force, lines.middle);
    for &member in members {
        // Lines that a patch would reach but that carry nothing speak too.
        let foot = &feet[member as usize];
        for axis in Axis::BOTH {
            let wide = foot.covariance[axis.half()][axis.half()].sqrt();
            let (c, h) = (axis.along(foot.centre()), axis.along(foot.half()) + wide);
            for number in ((c - h) / cells.pitch).floor() as i32..=((c + h) / cells.pitch).floor() as i32 {
                if (0..cells.count(axis)).contains(&number) {
                    lines.line(axis, number);
                }
            }
        }
    }
    // The whole of it, free of any patch model.
    let mut slopes = [[(0, 0.0); 2 * MOST_FEET]; 3];
    for which in 0..members.len() {
        let at = which * STATES;
        let state = &joint.x[at..at + STATES];
        slopes[0][which] = (at + FORCE, 1.0);
        slopes[1][2 * which] = (at + FORCE, state[EAST] - middle.x);
        slopes[1][2 * which + 1] = (at + EAST, state[FORCE]);
        slopes[2][2 * which] = (at + FORCE, state[NORTH] - middle.y);
        slopes[2][2 * which + 1] = (at + NORTH, state[FORCE]);
    }
    let n = members.len();
    let start = joint.x;
    let now = |joint: &Joint, slopes: &[Slope]| -> f64 {
        // What the linearised prediction still misses after the observations so far.
        slopes.iter().map(|&(state, slope)| slope * (joint.x[state] - start[state])).sum()
    };
    let whole: f64 = (0..n).map(|which| start[which * STATES + FORCE]).sum();
    joint.observe(force - whole, &slopes[0][..n], 4.0);
    for (axis, slopes) in [(EAST, slopes[1]), (NORTH, slopes[2])] {
        let middle = if axis == EAST { middle.x } else { middle.y };
        let moment: f64 =
            (0..n).map(|which| start[which * STATES + FORCE] * (start[which * STATES + axis] - middle)).sum();
        let missing = -moment - now(joint, &slopes[..2 * n]);
        joint.observe(missing, &slopes[..2 * n], 0.09);
    }
    for line in &lines.lines {
        let axis = line.axis;
        let (place, half) = (axis.place(), axis.half());
        let aside = EAST + NORTH - place;
        let middle = (f64::from(line.number) + 0.5) * cells.pitch;
        let mut missing = [line.force, line.moment, line.cross];
        let mut rows: Rows = Default::default();
        let mut doubt = [[4.0, 0.0, 0.0], [0.0, 0.09, 0.0], [0.0, 0.0, 0.09]];
        for (which, &member) in members.iter().enumerate() {
            let foot = &feet[member as usize];
            let habit = foot.habit(axis, line.number);
            let place_along = axis.along(foot.centre());
            let width = foot.covariance[half][half].sqrt();
            let slice = line.slice_in_doubt(cells.pitch, place_along, axis.along(foot.half()), width);
            let share = (slice.share + habit.share).clamp(0.0, 1.0);
            if share <= 0.0 && slice.share <= 0.0 {
                continue;
            }
            let (f, at) = (foot.force(), which * STATES);
            let offset = axis.across(foot.centre() - lines.middle);
            let moment = slice.moment + habit.moment;
            let cross = share * offset + habit.cross;
            missing[0] -= f * share;
            missing[1] -= f * moment;
            missing[2] -= f * cross;
            // What the patch model leaves open: force that lies on the other side of the seam
            // through the foot, and how that force is spread along the seam.
            let strength = foot.habit_strength();
            let straddle =
                4.0 * (share * (1.0 - share)).max((1.0 - strength) * slice.share * (1.0 - slice.share));
            let strange = 0.01 + 0.06 * (1.0 - strength);
            let strayed = frames * (f * strange).powi(2) * straddle;
            let lever = [1.0, (0.5 * cells.pitch).copysign(place_along - middle), offset];
            for (row, values) in doubt.iter_mut().enumerate() {
                for (column, value) in values.iter_mut().enumerate() {
                    *value += strayed * lever[row] * lever[column];
                }
            }
            doubt[1][1] += strayed * SPREAD_M * SPREAD_M;
            doubt[2][2] += strayed * SPREAD_M * SPREAD_M;
            for (row, value, along, wider, across) in [
                (0, share, slice.share_by[0], slice.share_by[1], 0.0),
                (1, moment, slice.moment_by[0], slice.moment_by[1], 0.0),
                (2, cross, slice.share_by[0] * offset, slice.share_by[1] * offset, share),
            ] {
                rows[row].push((at + FORCE, value));
                rows[row].push((at + place, f * along));
                rows[row].push((at + half, f * wider));
                rows[row].push((at + aside, f * across));
            }
        }
        let variances = decorrelate(&mut missing, &mut rows, doubt);
        for row in 0..3 {
            let missing = missing[row] - now(joint, &rows[row]);
            joint.observe(missing, &rows[row], variances[row]);
        }
    }
}

/// The slopes of a line's force, moment and cross moment.
type Rows = [arrayvec::ArrayVec<Slope, { 4 * MOST_FEET }>; 3];

/// Turns three observations with correlated errors into three independent ones; gives their variances.
///
/// # Source
/// R = L D Lᵀ: multiplied by the inverse of L, errors of covariance R have the diagonal covariance D.
fn decorrelate(missing: &mut [f64; 3], rows: &mut Rows, mut doubt: [[f64; 3]; 3]) -> [f64; 3] {
    for pivot in 0..2 {
        for row in pivot + 1..3 {
            let factor = doubt[row][pivot] / doubt[pivot][pivot];
            for column in 0..3 {
                doubt[row][column] -= factor * doubt[pivot][column];
            }
            missing[row] -= factor * missing[pivot];
            let (above, below) = rows.split_at_mut(row);
            for (slope, taken) in below[0].iter_mut().zip(&above[pivot]) {
                slope.1 -= factor * taken.1;
            }
        }
    }
    [doubt[0][0], doubt[1][1], doubt[2][2]]
}
