//! Places of controls with room for shoes, in reach, and apart from those who stand there.

use std::ops::Range;

use glam::Vec2;

use super::change::Edit;
use super::document::Document;
use super::item::Item;
use super::snap::round_step_m;
use underfoot::floor::{Floor, Rect};
use underfoot::layout::{Layout, Stance, Widget};
use underfoot_scene::ergonomics::{REACH_M, free_tiles, gap_between_m, needed_gap_m, reach_m};

/// Tolerance for rounding errors, in metres.
pub(super) const SLACK_M: f32 = 1e-4;

/// Half the width of a shoe, in metres: the gap of usual controls.
const HALF_SHOE_M: f32 = 0.06;

/// The rule that a control breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlaceRule {
    Gap,
    Reach,
    Row,
}

/// How far a place of controls is from keeping each rule: by its gap and its reach in metres, and by free rows of
/// tiles; not above 0 where it keeps the rule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlaceCost {
    gap: f32,
    reach: f32,
    rows: i32,
}

impl PlaceCost {
    /// For the controls `own` of `layout`, moved by `by`, beside the controls for which `is_there` returns true.
    pub(super) fn of(
        layout: &Layout,
        floor: &Floor,
        own: &Range<usize>,
        by: Vec2,
        is_there: impl Fn(usize) -> bool,
    ) -> Self {
        let mut cost = Self::default();
        let others = layout.widgets.iter().enumerate();
        let others: Vec<&Widget> =
            others.filter(|(at, _)| !own.contains(at) && is_there(*at)).map(|(_, widget)| widget).collect();
        for widget in layout.widgets.get(own.clone()).unwrap_or_default() {
            let area = Rect::new(widget.area.min + by, widget.area.max + by);
            for other in others.iter().filter(|other| shares_page(widget, other)) {
                let needed = needed_gap_m(widget).max(needed_gap_m(other));
                cost.gap = cost.gap.max(needed - gap_between_m(area, other.area) - SLACK_M);
            }
            let far = reach_m(&layout.stances, area.centre()).unwrap_or_default();
            cost.reach = cost.reach.max(far - REACH_M);
            for stance in &layout.stances {
                let free = free_tiles(&floor.geometry, area, stance.area);
                cost.rows = cost.rows.max(1 - free);
            }
        }
        cost
    }

    /// Whether the place keeps `rule` and is by the others no worse than `before`.
    pub(super) fn keeps(self, rule: PlaceRule, before: Self) -> bool {
        let is_kept = |is_it: bool, cost: f32, before: f32| cost <= if is_it { 0.0 } else { before.max(0.0) };
        is_kept(rule == PlaceRule::Gap, self.gap, before.gap)
            && is_kept(rule == PlaceRule::Reach, self.reach, before.reach)
            && is_kept(rule == PlaceRule::Row, self.rows as f32, before.rows as f32)
    }

    /// The sum of all that is missing, in metres, with a row of tiles of `pitch_m` metres.
    pub(super) fn missing_m(self, pitch_m: f32) -> f32 {
        self.gap.max(0.0) + self.reach.max(0.0) + self.rows.max(0) as f32 * pitch_m
    }
}

/// Whether a new control at `area`, on the page with index `page`, has room for shoes, is in reach, and leaves a free row
/// before those who stand there.
pub(super) fn has_room(layout: &Layout, floor: &Floor, page: usize, area: Rect) -> bool {
    let others = layout.widgets.iter().filter(|other| other.page.is_none_or(|own| own == page));
    let is_apart =
        |other: &Widget| gap_between_m(area, other.area) >= needed_gap_m(other).max(HALF_SHOE_M) - SLACK_M;
    let is_reached = reach_m(&layout.stances, area.centre()).is_none_or(|far| far <= REACH_M);
    let is_off = |stance: &Stance| free_tiles(&floor.geometry, area, stance.area) >= 1;
    others.into_iter().all(is_apart) && is_reached && layout.stances.iter().all(is_off)
}

fn shares_page(one: &Widget, other: &Widget) -> bool {
    one.page.is_none() || other.page.is_none() || one.page == other.page
}

/// Maximum number of steps that a control moves in each direction.
const FARTHEST: i16 = 100;

/// The edits that move `item` by the least amount that keeps `rule`, inside its region.
pub(super) fn moved(document: &Document, item: &Item, rule: PlaceRule) -> Option<Vec<Edit>> {
    let layout = document.layout();
    let region =
        layout.widgets.get(item.widgets.start).and_then(|first| layout.regions.get(first.region))?.area;
    let step = round_step_m(document.unit_m(), &document.floor().geometry);
    let cost = |by| PlaceCost::of(layout, document.floor(), &item.widgets, by, |_| true);
    let before = cost(Vec2::ZERO);
    let by = nearest(item.area, region, step, |by| cost(by).keeps(rule, before))?;
    document.placing(&[(item, Rect::new(item.area.min + by, item.area.max + by))]).ok()
}

/// The shortest move of `area` within `outer`, by whole steps of `step` metres along each side, that `fits`; the
/// present place is none.
pub(super) fn nearest(area: Rect, outer: Rect, step: Vec2, fits: impl Fn(Vec2) -> bool) -> Option<Vec2> {
    // The nearest places first, in squares around the present one.
    for far in 1..=FARTHEST {
        if f32::from(far) * step.max_element() > outer.size().max_element() {
            break;
        }
        let ring = (-far..=far).flat_map(|along| {
            let (far, along) = (f32::from(far), f32::from(along));
            [Vec2::new(along, far), Vec2::new(along, -far), Vec2::new(far, along), Vec2::new(-far, along)]
        });
        let fits = ring
            .map(|by| by * step)
            .filter(|by| is_inside(Rect::new(area.min + *by, area.max + *by), outer) && fits(*by));
        // A straight move is shorter, and leaves rows and columns in line.
        let best = fits.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        if best.is_some() {
            return best;
        }
    }
    None
}

pub(super) fn is_inside(area: Rect, outer: Rect) -> bool {
    let outer = outer.grown(SLACK_M);
    area.min.cmpge(outer.min).all() && area.max.cmple(outer.max).all()
}
