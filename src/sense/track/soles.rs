//! Two feet, moved to where two soles explain their loads.
//!
//! A touchdown is placed beside a foot that stays where it stood ([`touchdown`](super::touchdown)). If that foot turns
//! on its heel meanwhile, or lands in the same moment, no place of the other one explains the loads. Every few
//! milliseconds the loads of such a pair are therefore explained by two soles, without memory: the likeliest of a grid
//! of stances, improved step by step, against the likeliest one with both feet near their present places. Each sole
//! pays for its distance from the rest point of its foot. A stance that stays ahead moves both feet.

use super::params::rivals::{CONTESTED_S, STRAYED_M};
use super::params::soles::{
    AHEAD, APART_M, CLEAR_M, EVERY_S, HEADINGS, LEAST_APART_M, LEAST_SHARE, MISFIT, ON_HEEL, ON_HEEL_HERE,
    ROLLED_M, ROUNDS, SAME_M, SETTLE_M, SHARES, STARTS, STEPS, TIMES,
};
use arrayvec::ArrayVec;
use glam::DVec2;

use super::Cells;
use super::elapsed::Elapsed;
use super::groups::Group;
use super::rivals::may_have_rivals;
use super::sole::{LoadsAround, Sole};
use super::state::Track;
use super::strips::Strips;
use crate::sense::loaded::LoadedTiles;

/// The places of two soles that are ahead, and in how many successive comparisons they were.
#[derive(Clone, Copy, Debug)]
pub(super) struct SolesAhead {
    places: [DVec2; 2],
    times: u8,
}

impl SolesAhead {
    /// The number of successive comparisons including one that has found these places.
    fn times_with(&self, places: [DVec2; 2]) -> u8 {
        let is_same = self.places.iter().zip(places).all(|(before, now)| before.distance(now) < SAME_M);
        if is_same { self.times + 1 } else { 1 }
    }
}

/// Compares the places of two feet with those of two soles, and moves the feet if the soles have been ahead for some
/// time. Returns whether that took time. `is_third` returns whether another foot is near a place.
pub(super) fn compare(
    group: &mut Group<'_>,
    tiles: &LoadedTiles,
    cells: &Cells,
    elapsed: &Elapsed,
    is_third: impl Fn(DVec2) -> bool,
) -> bool {
    let turn = |age: f64| (age / EVERY_S).floor();
    if group.len() != 2 || !may_have_rivals(group) || turn(group[0].age) == turn(group[0].age - elapsed.dt) {
        return false;
    }
    let before = group[0].doubt.soles.take();
    if !group[0].doubt.lead.leaves_to_soles() || group.iter().all(|foot| foot.doubt.misfit <= MISFIT) {
        return false;
    }
    let both = group[0].tiles_with(group[1]);
    let strips = Strips::of(both.iter().map(|&position| &tiles.list()[position as usize]), cells.pitch);
    if is_third(strips.middle) {
        return false;
    }
    let loads = LoadsAround::of(strips.middle, &both, tiles, cells);
    let found =
        FeetInDoubt { loads, middle: strips.middle, force: strips.force, feet: [&*group[0], &*group[1]] }
            .elsewhere();
    let Some(soles) = found else { return true };
    let places = soles.map(|sole| sole.centre);
    let ahead = SolesAhead { places, times: before.map_or(1, |before| before.times_with(places)) };
    if ahead.times >= TIMES {
        for (foot, sole) in group.iter_mut().zip(soles) {
            foot.rest_at(sole.force, sole.centre);
            foot.restart_smoothing();
            (foot.doubt.nis, foot.doubt.misfit) = (0.0, 0.0);
            foot.arrivals.touchdown = None;
        }
        group[0].doubt.lead.pause();
    } else {
        group[0].doubt.soles = Some(ahead);
    }
    group.iter_mut().for_each(|foot| foot.doubt.contested_s = CONTESTED_S);
    true
}

/// Two soles with one heading, and the common centre of pressure between them.
#[derive(Clone, Copy, Debug)]
struct TwoSoles {
    /// Angle of the heading (rad).
    angle: f64,
    /// Share of the load on the heels.
    on_heel: f64,
    /// Distance of the second foot from the first one, to the left of the heading and along it (m).
    aside: f64,
    ahead: f64,
    /// Share of the load on the second foot.
    share: f64,
}

impl TwoSoles {
    /// The stances of the grid.
    fn all() -> impl Iterator<Item = Self> {
        let angles = headings(HEADINGS);
        let heels = angles.flat_map(|angle| ON_HEEL.map(|on_heel| (angle, on_heel)));
        let apart = heels.flat_map(|heels| APART_M.map(|aside| (heels, aside)));
        apart.flat_map(|((angle, on_heel), aside)| {
            SHARES.map(|share| Self { angle, on_heel, aside, ahead: 0.0, share })
        })
    }

    /// The stances with both `feet` where they are.
    fn here([first, second]: [&Track; 2]) -> impl Iterator<Item = Self> {
        let way = second.centre() - first.centre();
        let share = second.force() / (first.force() + second.force());
        let heels = headings(2 * HEADINGS).flat_map(|angle| ON_HEEL_HERE.map(|on_heel| (angle, on_heel)));
        heels.map(move |(angle, on_heel)| {
            let heading = DVec2::from_angle(angle);
            Self { angle, on_heel, aside: way.dot(heading.perp()), ahead: way.dot(heading), share }
        })
    }

    /// The stances one step away.
    fn around(self) -> impl Iterator<Item = Self> {
        let [angle, on_heel, aside, ahead, share] = STEPS;
        let steps = [-1.0, 1.0].into_iter().flat_map(move |way| {
            [
                Self { angle: self.angle + way * angle, ..self },
                Self { on_heel: self.on_heel + way * on_heel, ..self },
                Self { aside: self.aside + way * aside, ..self },
                Self { ahead: self.ahead + way * ahead, ..self },
                Self { share: self.share + way * share, ..self },
            ]
        });
        steps.filter(|next| (0.0..=1.0).contains(&next.on_heel) && (0.0..=1.0).contains(&next.share))
    }
}

/// So many headings, of a whole turn for twice [`HEADINGS`] and of half a turn for once.
fn headings(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(|number| number as f64 * std::f64::consts::PI / HEADINGS as f64)
}

/// Two feet and their loads.
struct FeetInDoubt<'a> {
    loads: LoadsAround,
    /// The common centre of pressure.
    middle: DVec2,
    /// The force of both (N).
    force: f64,
    feet: [&'a Track; 2],
}

impl FeetInDoubt<'_> {
    /// The likeliest two soles, in the order of the feet, if one of them is elsewhere and they are ahead.
    fn elsewhere(&self) -> Option<[Sole; 2]> {
        let (score, stance) = self.likeliest()?;
        let soles = self.in_order(self.soles(stance))?;
        let is_away = |(foot, sole): (&&Track, &Sole)| foot.centre().distance(sole.centre) > STRAYED_M;
        let is_possible = soles.iter().all(|sole| sole.force > LEAST_SHARE * self.force)
            && soles[0].centre.distance(soles[1].centre) > LEAST_APART_M
            && self.feet.iter().zip(&soles).any(is_away);
        (is_possible && score - self.score_here() > AHEAD).then_some(soles)
    }

    /// The likeliest stance and its score: the best of the grid, improved.
    fn likeliest(&self) -> Option<(f64, TwoSoles)> {
        let mut starts = ArrayVec::<(f64, TwoSoles), STARTS>::new();
        for stance in TwoSoles::all() {
            let score = self.score(stance);
            if starts.is_full() && starts.last().is_some_and(|last| score > last.0) {
                starts.pop();
            }
            if !starts.is_full() {
                let at = starts.iter().position(|start| score > start.0).unwrap_or(starts.len());
                starts.insert(at, (score, stance));
            }
        }
        let improved = starts.into_iter().map(|start| self.improved(start, |_| true));
        improved.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(score, _)| score.is_finite())
    }

    /// The score of the likeliest stance with both feet near their places.
    fn score_here(&self) -> f64 {
        let scored = TwoSoles::here(self.feet).map(|stance| (self.score(stance), stance));
        let Some(best) = scored.max_by(|a, b| a.0.total_cmp(&b.0)) else { return f64::NEG_INFINITY };
        let is_near = |stance: TwoSoles| {
            let soles = self.soles(stance);
            self.feet.iter().zip(soles).all(|(foot, sole)| foot.centre().distance(sole.centre) < SETTLE_M)
        };
        self.improved(best, is_near).0
    }

    /// The stance after the steps that raise its score most, among those that `may` be.
    fn improved(
        &self,
        (mut score, mut stance): (f64, TwoSoles),
        may: impl Fn(TwoSoles) -> bool,
    ) -> (f64, TwoSoles) {
        for _ in 0..ROUNDS {
            let next = stance.around().filter(|next| may(*next)).map(|next| (self.score(next), next));
            let Some(best) = next.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0 > score) else {
                break;
            };
            (score, stance) = best;
        }
        (score, stance)
    }

    /// Log likelihood of a stance less the cost of the ways of its soles from the feet's rest points.
    fn score(&self, stance: TwoSoles) -> f64 {
        let soles = self.soles(stance);
        let (straight, crossed) = self.ways(&soles, |way| way * way);
        self.loads.log_likelihood(&soles) - 0.5 * straight.min(crossed) / (ROLLED_M * ROLLED_M)
    }

    fn soles(&self, TwoSoles { angle, on_heel, aside, ahead, share }: TwoSoles) -> [Sole; 2] {
        let heading = DVec2::from_angle(angle);
        let way = heading.perp() * aside + heading * ahead;
        let size = Sole::size_of(self.force);
        let sole = |centre, force| Sole { centre, heading, on_heel, force, size };
        [
            sole(self.middle - way * share, self.force * (1.0 - share)),
            sole(self.middle + way * (1.0 - share), self.force * share),
        ]
    }

    /// The soles in the order of the feet, by their ways from the rest points; `None` if either order is possible.
    fn in_order(&self, [one, other]: [Sole; 2]) -> Option<[Sole; 2]> {
        let (straight, crossed) = self.ways(&[one, other], |way| way);
        match crossed - straight {
            clear if clear > CLEAR_M => Some([one, other]),
            clear if clear < -CLEAR_M => Some([other, one]),
            _ => None,
        }
    }

    /// The sums of `of` the ways of both feet from their rest points to the soles, in this order and in the other one.
    fn ways(&self, soles: &[Sole; 2], of: impl Fn(f64) -> f64) -> (f64, f64) {
        let way =
            |foot: usize, sole: usize| of(self.feet[foot].stillness.rest_point.distance(soles[sole].centre));
        (way(0, 0) + way(1, 1), way(0, 1) + way(1, 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sense::contact::ContactId;

    const PITCH: DVec2 = DVec2::splat(0.304);

    /// Two feet with these rest points where the filter has them, and the loads of soles at `places`.
    fn found(rests: [DVec2; 2], places: [DVec2; 2]) -> Option<[DVec2; 2]> {
        let heading = DVec2::from_angle(0.1);
        let soles = places.map(|centre| Sole { centre, heading, on_heel: 0.7, force: 275.0, size: 0.92 });
        let [first, second] = rests.map(|rest| Track::new(ContactId(1), 275.0, rest, 0.01));
        let middle = 0.5 * (places[0] + places[1]);
        let loads = LoadsAround::pressed_by(&soles, middle, PITCH);
        let feet = FeetInDoubt { loads, middle, force: 550.0, feet: [&first, &second] };
        feet.elsewhere().map(|soles| soles.map(|sole| sole.centre))
    }

    #[test]
    fn a_foot_that_turned_on_its_heel_while_the_other_landed_is_found_with_it() {
        // A simulated heel pivot: the filter takes the standing foot to be where it stood.
        let places = [DVec2::new(0.66, 0.59), DVec2::new(0.63, 0.81)];
        let found = found([DVec2::new(0.72, 0.60), DVec2::new(0.58, 0.79)], places).unwrap();
        let off = found.iter().zip(places).map(|(found, place)| found.distance(place));
        assert!(off.clone().all(|off| off < 0.03), "{:?}", off.collect::<Vec<_>>());
    }

    #[test]
    fn feet_that_are_where_the_filter_has_them_are_not_moved() {
        let places = [DVec2::new(0.66, 0.59), DVec2::new(0.63, 0.81)];
        assert_eq!(found(places, places), None);
        let near = places.map(|place| place + DVec2::new(0.02, -0.01));
        assert_eq!(found(near, places), None);
    }

    #[test]
    fn soles_that_lie_over_each_other_are_one_foot_that_rolls() {
        let places = [DVec2::new(0.66, 0.60), DVec2::new(0.66, 0.72)];
        assert_eq!(found([DVec2::new(0.60, 0.55), DVec2::new(0.60, 0.80)], places), None);
    }
}
