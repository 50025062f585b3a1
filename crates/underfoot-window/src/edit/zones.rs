//! Repairs of stance zones that reach into regions.

use glam::Vec2;

use super::room::{SLACK_M, is_inside};
use underfoot::floor::Rect;
use underfoot::layout::Layout;

/// A narrower part of a region holds no control for feet (rule U101), in metres.
const NARROW_M: f32 = 0.12;

/// The new area of a zone, with its index in its list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ZoneRepair {
    /// A stance zone moves beside the regions.
    Stance(usize, Rect),
    /// A region ends beside the stance zone.
    Region(usize, Rect),
}

impl ZoneRepair {
    /// Its effect, in a few words that begin with a verb.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Stance(..) => "Move it beside the region",
            Self::Region(..) => "End the region beside it",
        }
    }

    /// Changes the zone in `layout`.
    pub(super) fn apply(self, layout: &mut Layout) {
        let (zone, area) = match self {
            Self::Stance(at, area) => (layout.stances.get_mut(at).map(|stance| &mut stance.area), area),
            Self::Region(at, area) => (layout.regions.get_mut(at).map(|region| &mut region.area), area),
        };
        if let Some(zone) = zone {
            *zone = area;
        }
    }
}

/// Whether the stance zone with this index reaches into a region.
pub(super) fn is_in_region(layout: &Layout, stance: usize) -> bool {
    let area = layout.stances.get(stance).map(|stance| stance.area);
    area.is_some_and(|area| layout.regions.iter().any(|region| region.area.overlaps(area.grown(-SLACK_M))))
}

/// The nearest place within `floor` for the stance zone with this index beside all regions and other stance zones.
pub(super) fn stance_beside(layout: &Layout, floor: Rect, stance: usize) -> Option<ZoneRepair> {
    let area = layout.stances.get(stance)?.area;
    let size = area.size();
    let beside = |region: Rect| {
        [
            Vec2::new(region.min.x - size.x, area.min.y),
            Vec2::new(region.max.x, area.min.y),
            Vec2::new(area.min.x, region.min.y - size.y),
            Vec2::new(area.min.x, region.max.y),
        ]
    };
    let others = layout.stances.iter().enumerate().filter(|(at, _)| *at != stance).map(|(_, it)| it.area);
    let taken: Vec<Rect> = layout.regions.iter().map(|region| region.area).chain(others).collect();
    let places = layout.regions.iter().flat_map(|region| beside(region.area));
    let free = places.map(|at| Rect::from_min_size(at, size)).filter(|place| {
        is_inside(*place, floor) && !taken.iter().any(|taken| taken.overlaps(place.grown(-SLACK_M)))
    });
    let nearest = free.min_by(|a, b| a.min.distance(area.min).total_cmp(&b.min.distance(area.min)))?;
    Some(ZoneRepair::Stance(stance, nearest))
}

/// The largest rest of the first region into which the stance zone with this index reaches, cut off at the zone. With
/// `keeps_controls`, the rest holds all controls of the region.
pub(super) fn region_beside(layout: &Layout, stance: usize, keeps_controls: bool) -> Option<ZoneRepair> {
    let zone = layout.stances.get(stance)?.area;
    let (index, region) =
        layout.regions.iter().map(|region| region.area).enumerate().find(|(_, area)| area.overlaps(zone))?;
    let holds_all = |rest: Rect| {
        let own = layout.widgets.iter().filter(|widget| widget.region == index);
        own.into_iter().all(|widget| is_inside(widget.area, rest))
    };
    let cuts = [
        Rect::new(Vec2::new(zone.max.x, region.min.y), region.max),
        Rect::new(region.min, Vec2::new(zone.min.x, region.max.y)),
        Rect::new(Vec2::new(region.min.x, zone.max.y), region.max),
        Rect::new(region.min, Vec2::new(region.max.x, zone.min.y)),
    ];
    let rests = cuts.into_iter().filter(|rest| rest.size().min_element() > NARROW_M);
    let rests = rests.filter(|rest| !keeps_controls || holds_all(*rest));
    let extent = |rest: &Rect| rest.size().element_product();
    let rest = rests.max_by(|a, b| extent(a).total_cmp(&extent(b)))?;
    Some(ZoneRepair::Region(index, rest))
}
