//! Places of controls with room for shoes, in reach, and apart from those who stand there.

use glam::Vec2;

use super::change::Edit;
use super::document::Document;
use super::item::Item;
use super::snap::round_step_m;
use underfoot::floor::Rect;
use underfoot::layout::Widget;
use underfoot_scene::ergonomics::{REACH_M, free_tiles, gap_between_m, needed_gap_m, reach_m};

/// Tolerance for rounding errors, in metres.
pub(super) const SLACK_M: f32 = 1e-4;

/// The rule that a control breaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlaceRule {
    Gap,
    Reach,
    Row,
}

/// How far a place of an item is from keeping each rule: by its gap and its reach in metres, and by free rows of tiles;
/// not above 0 where it keeps the rule.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PlaceCost {
    gap: f32,
    reach: f32,
    rows: i32,
}

impl PlaceCost {
    /// For the controls of `item`, moved by `by`.
    fn of(document: &Document, item: &Item, by: Vec2) -> Self {
        let layout = document.layout();
        let own = layout.widgets.get(item.widgets.clone()).unwrap_or_default();
        let mut cost = Self { gap: 0.0, reach: 0.0, rows: 0 };
        let others = layout.widgets.iter().enumerate().filter(|(at, _)| !item.widgets.contains(at));
        let others: Vec<&Widget> = others.map(|(_, widget)| widget).collect();
        for widget in own {
            let area = Rect::new(widget.area.min + by, widget.area.max + by);
            for other in others.iter().filter(|other| shares_page(widget, other)) {
                let needed = needed_gap_m(widget).max(needed_gap_m(other));
                cost.gap = cost.gap.max(needed - gap_between_m(area, other.area) - SLACK_M);
            }
            let far = reach_m(&layout.stances, area.centre()).unwrap_or_default();
            cost.reach = cost.reach.max(far - REACH_M);
            for stance in &layout.stances {
                let free = free_tiles(&document.floor().geometry, area, stance.area);
                cost.rows = cost.rows.max(1 - free);
            }
        }
        cost
    }

    /// Whether the place keeps `rule` and is by the others no worse than `before`.
    fn keeps(self, rule: PlaceRule, before: Self) -> bool {
        let is_kept = |is_it: bool, cost: f32, before: f32| cost <= if is_it { 0.0 } else { before.max(0.0) };
        is_kept(rule == PlaceRule::Gap, self.gap, before.gap)
            && is_kept(rule == PlaceRule::Reach, self.reach, before.reach)
            && is_kept(rule == PlaceRule::Row, self.rows as f32, before.rows as f32)
    }
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
    let before = PlaceCost::of(document, item, Vec2::ZERO);
    // The nearest places first, in squares around the present one.
    for far in 1..=FARTHEST {
        if f32::from(far) * step.max_element() > region.size().max_element() {
            break;
        }
        let ring = (-far..=far).flat_map(|along| {
            let (far, along) = (f32::from(far), f32::from(along));
            [Vec2::new(along, far), Vec2::new(along, -far), Vec2::new(far, along), Vec2::new(-far, along)]
        });
        let fits = ring.map(|by| by * step).filter(|by| {
            let area = Rect::new(item.area.min + *by, item.area.max + *by);
            is_inside(area, region) && PlaceCost::of(document, item, *by).keeps(rule, before)
        });
        // A straight move is shorter, and leaves rows and columns in line.
        if let Some(by) = fits.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared())) {
            let area = Rect::new(item.area.min + by, item.area.max + by);
            return document.placing(&[(item, area)]).ok();
        }
    }
    None
}

pub(super) fn is_inside(area: Rect, outer: Rect) -> bool {
    let outer = outer.grown(SLACK_M);
    area.min.cmpge(outer.min).all() && area.max.cmple(outer.max).all()
}
