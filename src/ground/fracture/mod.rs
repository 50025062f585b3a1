//! Cracks: their beginning, spreading, branching and end.

use std::collections::VecDeque;
use std::f32::consts::TAU;
use std::time::Duration;

use arrayvec::ArrayVec;
use glam::Vec2;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::Crack;
use crate::floor::Rect;
use crate::units::Instant;
use underfoot_format::{Own, num, record};

record! {
    /// The rules for the growth of cracks.
    pub struct CrackRules = "Cracks", Copy;
    /// Minimum distance between two seeds, in metres: the paper's Δp.
    pub apart_m: f32 = "apart_m", num(0.01..=10.0);
    /// Length of crack per joule, in metres: the paper's α.
    pub per_j_m: f32 = "growth_m_per_j", num(0.0001..=10.0);
    /// Standard deviation of the sideways step β that turns a crack at each event: the paper's σ.
    /// A crack turns by the arc tangent of β.
    pub turn: f32 = "turn", num(0.0..=3.0);
    /// Probability that a piece of crack ends in two branches, 0 to 1; none in the paper.
    pub branch: f32 = "branch", num(0.0..=1.0);
    /// Angle between branches, in radians; in degrees in files.
    pub branch_rad: f32 = "branch_deg", num(1.0..=120.0).degrees();
    /// Maximum number of pieces, 16 and more; the oldest heal for new ones.
    pub most: usize = "pieces", num(16.0..=20_000.0);
    /// Time in which a crack freezes shut, in seconds; `None`: never. The same as for the sheet around it.
    pub refreeze_s: Option<f32> = "", Own(None);
}

/// The origin of cracks.
#[derive(Clone, Debug, PartialEq)]
pub struct Seed {
    /// Its number; numbers are not reused.
    pub number: u32,
    /// Its place, in floor metres.
    pub at: Vec2,
    /// Time of its last event.
    pub latest: Instant,
    /// Total energy of its events, in joules.
    pub energy_j: f32,
    /// Number of its pieces of crack; a seed without any has healed.
    cracks: u32,
    fronts: ArrayVec<Front, 6>,
}

impl Seed {
    /// Number of its crack fronts, 2 to 6, grown or not yet.
    #[must_use]
    pub fn fronts(&self) -> usize {
        self.fronts.len()
    }
}

/// One of the directions in which cracks grow from a seed, with its branches.
#[derive(Clone, Debug, Default, PartialEq)]
struct Front {
    /// Ends that can still grow; none once all have met an obstacle.
    tips: ArrayVec<Tip, TIPS>,
    /// Number of its latest piece.
    latest: u64,
}

/// Maximum number of growing ends of one front.
const TIPS: usize = 5;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Tip {
    at: Vec2,
    way: Vec2,
    line: u32,
    rank: u8,
}

/// The effect of one event on the cracks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Growth {
    /// Number of the seed.
    pub seed: u32,
    /// Whether that seed is new.
    pub is_new: bool,
    /// The front of the seed that grew; the first of two for a new seed.
    pub front: usize,
    /// The end of the new piece; `None` if an existing crack widened instead.
    pub tip: Option<Vec2>,
}

/// The cracks in one sheet: a graph that grows by events and heals with time.
///
/// Its memory is bounded, and allocated at the start.
///
/// # Source
/// Paper, section 4.1.2. Beyond it: fronts branch, stop at the sheet's edge and
/// at other cracks, and heal.
#[derive(Clone, Debug)]
pub struct Fracture {
    rules: CrackRules,
    area: Rect,
    /// In the order of opening.
    cracks: VecDeque<Crack>,
    /// Number of pieces removed from the front of `cracks`.
    healed: u64,
    /// Number of these that were evicted by new ones.
    evicted: u64,
    seeds: Vec<Seed>,
    next_seed: u32,
    next_line: u32,
    /// Increases with every change.
    revision: u64,
}

/// Maximum number of seeds of one sheet; a new one evicts the seed without events for the longest time.
const MOST_SEEDS: usize = 512;

/// Time for which a seed without cracks is stored after its last event.
const BARE_SEED: Duration = Duration::from_secs(10);

/// Minimum length of a piece of crack, in metres; a shorter one does not open.
const SHORTEST_M: f32 = 0.001;

impl Fracture {
    /// A whole sheet that covers `area`.
    #[must_use]
    pub fn new(rules: CrackRules, area: Rect) -> Self {
        let most = rules.most.max(16);
        Self {
            rules: CrackRules { most, ..rules },
            area,
            cracks: VecDeque::with_capacity(most),
            healed: 0,
            evicted: 0,
            seeds: Vec::with_capacity(MOST_SEEDS),
            next_seed: 0,
            next_line: 0,
            revision: 0,
        }
    }

    /// The pieces of crack, oldest first.
    pub fn cracks(&self) -> impl DoubleEndedIterator<Item = &Crack> + ExactSizeIterator + '_ {
        self.cracks.iter()
    }

    /// The seeds, including those whose cracks have not opened yet or have healed.
    #[must_use]
    pub fn seeds(&self) -> &[Seed] {
        &self.seeds
    }

    /// Maximum number of pieces of crack and of seeds.
    #[must_use]
    pub const fn most(&self) -> (usize, usize) {
        (self.rules.most, MOST_SEEDS)
    }

    /// A number that changes whenever a crack opens, widens or heals.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Number of pieces that new ones evicted before their time.
    #[must_use]
    pub fn evicted(&self) -> u64 {
        self.evicted
    }

    /// Processes an event of `energy_j` joules at `at`.
    ///
    /// With a seed within Δp the event goes to one of the fronts of the nearest, each with the same probability;
    /// otherwise it makes a new seed with 2 to 6 fronts at equal angles, and grows two of them.
    pub fn grow(&mut self, at: Vec2, energy_j: f32, now: Instant, rng: &mut Pcg64Mcg) -> Growth {
        self.revision += 1;
        let at = at.clamp(self.area.min, self.area.max);
        let nearest = self
            .seeds
            .iter()
            .enumerate()
            .map(|(index, seed)| (index, seed.at.distance_squared(at)))
            .min_by(|one, other| one.1.total_cmp(&other.1))
            .filter(|(_, squared)| *squared <= self.rules.apart_m * self.rules.apart_m);
        let (index, is_new) = match nearest {
            Some((index, _)) => (index, false),
            None => (self.place_seed(at, now, rng), true),
        };
        let Some(seed) = self.seeds.get_mut(index) else { return Growth::default() };
        seed.latest = now;
        seed.energy_j += energy_j;
        let (number, fronts) = (seed.number, seed.fronts.len());
        let front = rng.random_range(0..fronts);
        let tip = self.extend(index, front, energy_j, now, rng);
        if is_new {
            let other = (front + rng.random_range(1..fronts)) % fronts;
            self.extend(index, other, energy_j, now, rng);
        }
        Growth { seed: number, is_new, front, tip }
    }

    /// Closes the cracks that are old enough to be frozen shut.
    pub fn heal(&mut self, now: Instant) {
        let whole = self.rules.refreeze_s.map(|seconds| Duration::from_secs_f32(seconds.clamp(0.0, 1e9)));
        if let Some(whole) = whole {
            while self.cracks.front().is_some_and(|oldest| now.since(oldest.born) >= whole) {
                self.drop_oldest();
            }
        }
        // A seed without cracks is soon of no use.
        let before = self.seeds.len();
        let rest = whole.unwrap_or(BARE_SEED).min(BARE_SEED);
        self.seeds.retain(|seed| seed.cracks > 0 || now.since(seed.latest) < rest);
        self.revision += u64::from(self.seeds.len() != before);
    }

    /// Inserts a new seed; returns its index in `seeds`.
    fn place_seed(&mut self, at: Vec2, now: Instant, rng: &mut Pcg64Mcg) -> usize {
        if self.seeds.len() == MOST_SEEDS
            && let Some((idlest, _)) = self.seeds.iter().enumerate().min_by_key(|(_, seed)| seed.latest)
        {
            self.seeds.swap_remove(idlest);
        }
        let count = rng.random_range(2..=6);
        let first = rng.random_range(0.0..TAU);
        let fronts = (0..count).map(|front| {
            let way = Vec2::from_angle(first + TAU * front as f32 / count as f32);
            let tip = Tip { at, way, line: self.next_line + front, rank: 0 };
            Front { tips: ArrayVec::from_iter([tip]), latest: u64::MAX }
        });
        let fronts = fronts.collect();
        let number = self.next_seed;
        self.next_seed = self.next_seed.wrapping_add(1);
        self.next_line = self.next_line.wrapping_add(count);
        self.seeds.push(Seed { number, at, latest: now, energy_j: 0.0, cracks: 0, fronts });
        self.seeds.len() - 1
    }

    /// Grows a front by the length for `energy_j`; a front that cannot grow any more gets a branch or widens.
    fn extend(
        &mut self,
        seed: usize,
        front: usize,
        energy_j: f32,
        now: Instant,
        rng: &mut Pcg64Mcg,
    ) -> Option<Vec2> {
        let rules = self.rules;
        let tips = self.seeds.get(seed)?.fronts.get(front)?.tips.len();
        if tips == 0 {
            self.branch(seed, front, rng);
        }
        let found = self.seeds.get(seed)?.fronts.get(front)?;
        if found.tips.is_empty() {
            self.widen(found.latest, energy_j);
            return None;
        }
        let found_latest = found.latest;
        let chosen = rng.random_range(0..found.tips.len());
        let tip = *found.tips.get(chosen)?;
        let sideways: f32 = StandardNormal.sample(rng);
        let way = (tip.way + tip.way.perp() * (rules.turn * sideways)).normalize_or(tip.way);
        let wished = tip.at + way * (rules.per_j_m * energy_j);
        let (to, is_stopped) = self.reach(tip.at, wished);
        let is_short = tip.at.distance(to) < SHORTEST_M;
        if is_short {
            self.widen(found_latest, energy_j);
        } else {
            let seed = self.seeds.get(seed)?.number;
            let Tip { at: from, line, rank, .. } = tip;
            self.open(Crack { from, to, energy_j, born: now, number: 0, line, rank, seed });
        }
        let piece = (self.healed + self.cracks.len() as u64).wrapping_sub(1);
        let branches = !is_stopped && !is_short && rng.random::<f32>() < rules.branch;
        let side = if rng.random::<bool>() { 1.0 } else { -1.0 };
        let aside = Vec2::from_angle(side * rules.branch_rad * rng.random_range(0.7..1.3)).rotate(way);
        let line = self.next_line;
        let Seed { fronts, cracks, .. } = self.seeds.get_mut(seed)?;
        let front = fronts.get_mut(front)?;
        if !is_short {
            *cracks += 1;
            front.latest = piece;
        }
        if is_stopped {
            front.tips.remove(chosen);
        } else if !is_short {
            front.tips[chosen] = Tip { at: to, way, ..tip };
            if branches && !front.tips.is_full() {
                front.tips.push(Tip { at: to, way: aside, line, rank: tip.rank.saturating_add(1) });
                self.next_line = self.next_line.wrapping_add(1);
            }
        }
        (!is_short).then_some(to)
    }

    /// The point that a crack from `start` reaches towards `end`, and whether an obstacle stops it: the edge or
    /// another crack.
    fn reach(&self, start: Vec2, end: Vec2) -> (Vec2, bool) {
        let mut share = 1.0_f32;
        for axis in 0..2 {
            let (low, high) = (self.area.min[axis], self.area.max[axis]);
            let step = end[axis] - start[axis];
            if end[axis] < low {
                share = share.min((low - start[axis]) / step);
            } else if end[axis] > high {
                share = share.min((high - start[axis]) / step);
            }
        }
        for crack in &self.cracks {
            if let Some(met) = crack.met_by(start, end) {
                share = share.min(met);
            }
        }
        if share < 1.0 {
            ((start + (end - start) * share.max(0.0)).clamp(self.area.min, self.area.max), true)
        } else {
            (end, false)
        }
    }

    fn open(&mut self, crack: Crack) {
        if self.cracks.len() >= self.rules.most {
            self.drop_oldest();
            self.evicted += 1;
        }
        let number = self.healed + self.cracks.len() as u64;
        self.cracks.push_back(Crack { number, ..crack });
    }

    /// Restarts a front without growing ends from the start of one of its seed's cracks, with a certain probability.
    fn branch(&mut self, seed: usize, front: usize, rng: &mut Pcg64Mcg) {
        if self.cracks.is_empty() || rng.random::<f32>() >= self.rules.branch.max(0.25) {
            return;
        }
        let Some(number) = self.seeds.get(seed).map(|seed| seed.number) else { return };
        // A few attempts: most cracks near the newest are the seed's own.
        for _ in 0..8 {
            let back = (rng.random::<f32>().powi(2) * self.cracks.len() as f32) as usize;
            let Some(crack) = self.cracks.get(self.cracks.len() - 1 - back.min(self.cracks.len() - 1)) else {
                return;
            };
            if crack.seed != number {
                continue;
            }
            let side = if rng.random::<bool>() { 1.0 } else { -1.0 };
            let along = (crack.to - crack.from).normalize_or(Vec2::X);
            let way = Vec2::from_angle(side * rng.random_range(1.0..1.9)).rotate(along);
            let tip = Tip { at: crack.from, way, line: self.next_line, rank: crack.rank.saturating_add(1) };
            self.next_line = self.next_line.wrapping_add(1);
            if let Some(front) = self.seeds.get_mut(seed).and_then(|seed| seed.fronts.get_mut(front)) {
                let _ = front.tips.try_push(tip);
            }
            return;
        }
    }

    fn widen(&mut self, piece: u64, energy_j: f32) {
        let index = piece.checked_sub(self.healed).and_then(|index| usize::try_from(index).ok());
        if let Some(crack) = index.and_then(|index| self.cracks.get_mut(index)) {
            crack.energy_j += energy_j;
        }
    }

    fn drop_oldest(&mut self) {
        let Some(oldest) = self.cracks.pop_front() else { return };
        self.healed += 1;
        self.revision += 1;
        if let Some(seed) = self.seeds.iter_mut().find(|seed| seed.number == oldest.seed) {
            seed.cracks = seed.cracks.saturating_sub(1);
        }
    }
}

#[cfg(test)]
mod tests;
