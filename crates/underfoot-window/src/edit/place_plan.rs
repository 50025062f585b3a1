//! A plan of places for all controls of a layout together.
//!
//! Single moves do not mend a crowd: the place that one control needs is free only after another one has moved. The
//! plan therefore takes controls off the floor and puts them back one after the other, each where all rules are kept
//! beside those that already stand.

use std::ops::Range;

use glam::Vec2;

use super::address::RecordList;
use super::change::Edit;
use super::document::Document;
use super::grid_room::{GridRoom, good_size};
use super::item::{Item, around};
use super::refusal::EditRefusal;
use super::room::{PlaceCost, PlaceRule, is_inside, nearest};
use super::snap::{Edges, round_step_m};
use super::zones::{is_in_region, region_beside, stance_beside};
use underfoot::floor::Rect;
use underfoot::layout::Layout;
use underfoot_scene::ergonomics::{predicted_error_m, smallest_part};

/// The order in which controls get their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlanOrder {
    /// As they stand in the file.
    File,
    FromWest,
    FromEast,
    FromSouth,
    FromNorth,
    LargeFirst,
    /// Mixed; each number gives another order.
    Mixed(u32),
}

/// The way in which a plan is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PlanWay {
    pub(super) order: PlanOrder,
    /// Whether all controls may move, or only those that break a rule.
    pub(super) moves_all: bool,
    /// The corner of the region, by its east and north side, from which the places fill; `None` for the nearest places.
    pub(super) corner: Option<[bool; 2]>,
    /// Whether only room is asked for: reach and free rows then only get no worse.
    pub(super) for_room: bool,
}

/// The planned layout.
#[derive(Clone)]
pub(super) struct PlacePlan<'d> {
    document: &'d Document,
    /// All records of the document.
    items: &'d [Item],
    layout: Layout,
    /// Grids whose cells become larger or move apart.
    grids: Vec<(&'d Item, GridRoom)>,
}

impl<'d> PlacePlan<'d> {
    /// The layout with zones and sizes mended; controls may overlap in it. Stance zones in a region move out of it, or
    /// with `cuts_regions` the region ends beside them, where both are possible.
    pub(super) fn begin(document: &'d Document, items: &'d [Item], cuts_regions: bool) -> Self {
        let mut plan = Self { document, items, layout: document.layout().clone(), grids: Vec::new() };
        plan.free_zones(cuts_regions);
        let small: Vec<usize> = document
            .findings()
            .iter()
            .filter(|finding| finding.rule.code == "U101")
            .map(|finding| finding.widget)
            .collect();
        for item in items.iter().filter(|item| !item.is_group) {
            if !item.widgets.clone().any(|at| small.contains(&at)) && item.widgets.len() < 2 {
                continue;
            }
            if item.widgets.len() == 1 {
                if let Some(widget) = plan.layout.widgets.get_mut(item.widgets.start) {
                    widget.area = Rect::from_centre_size(widget.area.centre(), good_size(widget));
                }
            } else if let Some(room) = GridRoom::needed(document, item) {
                room.spread(&mut plan.layout, item);
                plan.grids.push((item, room));
            }
        }
        plan
    }

    /// Moves stance zones out of regions, or ends regions beside them.
    fn free_zones(&mut self, cuts_regions: bool) {
        let floor = self.document.floor().geometry.bounds();
        for stance in 0..self.layout.stances.len() {
            // One zone may reach into several regions.
            for _ in 0..self.layout.regions.len() {
                if !is_in_region(&self.layout, stance) {
                    break;
                }
                let moved = stance_beside(&self.layout, floor, stance);
                let cut = region_beside(&self.layout, stance, true)
                    .or_else(|| region_beside(&self.layout, stance, false));
                let repair = if cuts_regions { cut.or(moved) } else { moved.or(cut) };
                let Some(repair) = repair else { break };
                repair.apply(&mut self.layout);
            }
        }
    }

    /// Whether a stance zone or a region changes.
    pub(super) fn changes_zones(&self) -> bool {
        let before = self.document.layout();
        self.layout.stances != before.stances || self.layout.regions != before.regions
    }

    /// The plan with places for the controls; `None` if one of them finds none.
    pub(super) fn placed(&self, way: PlanWay) -> Option<Self> {
        let mut plan = self.clone();
        let mut moved: Vec<&Item> = self
            .items
            .iter()
            .filter(|item| self.can_move(item) && (way.moves_all || self.is_broken(item)))
            .collect();
        let mut is_there = vec![true; self.layout.widgets.len()];
        let note = |is_there: &mut Vec<bool>, item: &Item, is_it: bool| {
            is_there.get_mut(item.widgets.clone()).into_iter().flatten().for_each(|there| *there = is_it);
        };
        moved.iter().for_each(|item| note(&mut is_there, item, false));
        moved.sort_by(|a, b| way.order.key(a).total_cmp(&way.order.key(b)));
        for item in moved {
            plan.put(item, &is_there, way)?;
            note(&mut is_there, item, true);
        }
        Some(plan)
    }

    /// Whether the control or grid can be moved alone.
    fn can_move(&self, item: &Item) -> bool {
        let aside = Rect::new(item.area.min + Vec2::splat(0.01), item.area.max + Vec2::splat(0.01));
        let is_control = item.record.list() == Some(RecordList::Widgets) && !item.is_group;
        is_control && self.document.placing(&[(item, aside)]).is_ok()
    }

    fn is_broken(&self, item: &Item) -> bool {
        let (floor, pitch_m) =
            (self.document.floor(), self.document.floor().geometry.pitch_m().max_element());
        let cost = PlaceCost::of(&self.layout, floor, &item.widgets, Vec2::ZERO, |_| true);
        let is_out =
            !self.region(item).zip(self.area(item)).is_some_and(|(region, area)| is_inside(area, region));
        cost.missing_m(pitch_m) > 0.0 || is_out
    }

    fn region(&self, item: &Item) -> Option<Rect> {
        let region = self.layout.widgets.get(item.widgets.start)?.region;
        self.layout.regions.get(region).map(|region| region.area)
    }

    /// The area of a control, or around the cells of a grid, in the plan.
    fn area(&self, item: &Item) -> Option<Rect> {
        around(self.layout.widgets.get(item.widgets.clone())?.iter().map(|widget| widget.area))
    }

    /// Gives the controls of `item` a place beside those that are there.
    fn put(&mut self, item: &Item, is_there: &[bool], way: PlanWay) -> Option<()> {
        let (document, region) = (self.document, self.region(item)?);
        let (area, _) = Edges::ALL.stopped(self.area(item)?, region);
        let into = area.min - self.area(item)?.min;
        let floor = document.floor();
        let there = |at: usize| is_there.get(at).copied().unwrap_or_default();
        let before = PlaceCost::of(document.layout(), floor, &item.widgets, Vec2::ZERO, |_| false);
        let limits = error_limits(document, &self.layout, &item.widgets);
        let fits = |by: Vec2| {
            let cost = PlaceCost::of(&self.layout, floor, &item.widgets, into + by, there);
            let is_kept = match way.for_room {
                true => cost.keeps(PlaceRule::Gap, before),
                false => cost.keeps(PlaceRule::Gap, PlaceCost::default()),
            };
            is_kept && is_found(document, &self.layout, &limits, into + by)
        };
        let step = round_step_m(document.unit_m(), &floor.geometry);
        let by = match way.corner {
            _ if !is_inside(area, region) => None,
            Some(corner) => filled(area, region, step, corner, fits),
            None if fits(Vec2::ZERO) => Some(Vec2::ZERO),
            None => nearest(area, region, step, fits),
        }?;
        for widget in self.layout.widgets.get_mut(item.widgets.clone())? {
            widget.area = Rect::new(widget.area.min + into + by, widget.area.max + into + by);
        }
        Some(())
    }

    /// How far controls and zones move in all, in metres.
    pub(super) fn travel_m(&self) -> f32 {
        let before = self.document.layout();
        let widgets = self.layout.widgets.iter().zip(&before.widgets);
        let controls: f32 = widgets.map(|(one, other)| one.area.min.distance(other.area.min)).sum();
        let stances = self.layout.stances.iter().zip(&before.stances);
        let zones: f32 = stances.map(|(one, other)| one.area.min.distance(other.area.min)).sum();
        controls + zones
    }

    /// The document with the planned places; `None` if its reader refuses them.
    pub(super) fn written(&self) -> Option<Document> {
        let is_met = |document: &Document| {
            let pairs = document.layout().widgets.iter().zip(&self.layout.widgets);
            let mut far = pairs.map(|(one, other)| one.area.min.distance(other.area.min));
            far.all(|far| far < 1e-3)
        };
        // Where a neighbour of a control moves, the control gets a place of its own.
        [false, true].into_iter().find_map(|is_alone| {
            let mut mended = self.document.clone();
            mended.edit(&self.edits(is_alone).ok()?).ok()?;
            is_met(&mended).then_some(mended)
        })
    }

    fn edits(&self, is_alone: bool) -> Result<Vec<Edit>, EditRefusal> {
        let mut edits = Vec::new();
        for item in self.items.iter().filter(|item| !item.is_group) {
            let index = item.record.split().map_or(0, |(.., index)| index);
            let planned = match item.record.list() {
                Some(RecordList::Regions) => self.layout.regions.get(index).map(|region| region.area),
                Some(RecordList::Stances) => self.layout.stances.get(index).map(|stance| stance.area),
                Some(RecordList::Widgets) => self.area(item),
                _ => None,
            };
            let Some(area) = planned else { continue };
            let is_same = area.min.distance(item.area.min) + area.max.distance(item.area.max) < 1e-5;
            if is_alone && self.can_move(item) {
                edits.extend(self.document.placing_alone(&[(item, area)])?);
            } else if !is_same {
                edits.extend(self.document.placing(&[(item, area)])?);
            }
        }
        edits.extend(self.grids.iter().flat_map(|(item, room)| room.edits(self.document, item)));
        Ok(edits)
    }
}

impl PlanOrder {
    fn key(self, item: &Item) -> f32 {
        let (middle, size) = (item.area.centre(), item.area.size());
        match self {
            Self::File => 0.0,
            Self::FromWest => middle.x,
            Self::FromEast => -middle.x,
            Self::FromSouth => middle.y,
            Self::FromNorth => -middle.y,
            Self::LargeFirst => -size.element_product(),
            Self::Mixed(number) => {
                let at = u32::try_from(item.widgets.start).unwrap_or_default();
                (at.wrapping_mul(2_654_435_761) ^ number.wrapping_mul(40_503).wrapping_mul(at | 1)) as f32
            }
        }
    }
}

/// For each control, its index, and how far off a foot may be found there, in metres (rule U105).
fn error_limits(document: &Document, planned: &Layout, own: &Range<usize>) -> Vec<(usize, f32)> {
    let limit = |at: usize| {
        let (before, now) = (document.layout().widgets.get(at)?, planned.widgets.get(at)?);
        let press = before.behaviour.thresholds().press;
        let today = predicted_error_m(document.floor(), before.area, press);
        Some((at, today.max(0.25 * smallest_part(now).0.min_element())))
    };
    own.clone().filter_map(limit).collect()
}

/// Whether feet are found well enough on the controls, moved by `by`.
fn is_found(document: &Document, layout: &Layout, limits: &[(usize, f32)], by: Vec2) -> bool {
    limits.iter().all(|(at, limit)| {
        layout.widgets.get(*at).is_none_or(|widget| {
            let area = Rect::new(widget.area.min + by, widget.area.max + by);
            predicted_error_m(document.floor(), area, widget.behaviour.thresholds().press) <= limit + 1e-4
        })
    })
}

/// The move of `area` to the first place within `outer` that `fits`, row by row from its corner at the given east and
/// north side.
fn filled(
    area: Rect,
    outer: Rect,
    step: Vec2,
    [east, north]: [bool; 2],
    fits: impl Fn(Vec2) -> bool,
) -> Option<Vec2> {
    let room = outer.size() - area.size();
    let count = (room / step + 1e-3).max(Vec2::ZERO).floor();
    let along = |is_far: bool, number: u16, room: f32, step: f32| {
        if is_far { room - f32::from(number) * step } else { f32::from(number) * step }
    };
    // The cast from float saturates at the range of the integer.
    let rows = 0..=(count.y as u16);
    let mut places = rows.flat_map(|row| (0..=(count.x as u16)).map(move |column| (column, row)));
    places.find_map(|(column, row)| {
        let at =
            outer.min + Vec2::new(along(east, column, room.x, step.x), along(north, row, room.y, step.y));
        Some(at - area.min).filter(|by| fits(*by))
    })
}
