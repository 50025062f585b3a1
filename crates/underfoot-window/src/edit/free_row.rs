//! Free places for new controls: a row where feet reach it, with room for shoes.

use glam::Vec2;

use super::document::Document;
use super::room::{has_room, is_inside};
use super::snap::round_step_m;
use underfoot::floor::Rect;
use underfoot::layout::Layout;

/// Gap between controls, in metres: half a shoe and a little more (rule U102).
const GAP_M: f32 = 0.06;

/// Steps of round numbers from one place to the next that is tried.
const STRIDE: f32 = 5.0;

/// Places for `count` new controls of this `size`, in metres, on the page with index `page`: from west to east in as few
/// rows as possible, at an end of a row of controls, otherwise before the first stance zone, nearest to it; each keeps all
/// rules of room and reach. `None` if the first region has no such places.
#[must_use]
pub fn free_row(document: &Document, page: usize, size: Vec2, count: usize) -> Option<Vec<Rect>> {
    let (layout, floor) = (document.layout(), document.floor());
    let region = layout.regions.first()?.area;
    let middle = layout.stances.first().map_or(region.centre().x, |stance| stance.area.centre().x);
    let step = round_step_m(document.unit_m(), &floor.geometry);
    let up = |lengths: Vec2| (lengths / step - 1e-3).ceil() * step;
    let gap = up(Vec2::splat(GAP_M));
    let pitch = size + gap;
    let tries = |room: Vec2| (room / (STRIDE * step)).clamp(Vec2::ZERO, Vec2::splat(1e3)).floor();
    for rows in 1..=count {
        let columns = count.div_ceil(rows);
        let block = pitch * Vec2::new(columns as f32, rows as f32) - gap;
        let room = region.size() - block;
        if room.y < 0.0 {
            break;
        }
        if room.x < 0.0 {
            continue;
        }
        // The cast from integer is exact for the few controls that a floor holds.
        let cell = |at: Vec2, index: usize| {
            let (column, row) = (index % columns, rows - 1 - index / columns);
            Rect::from_min_size(at + pitch * Vec2::new(column as f32, row as f32), size)
        };
        let is_free = |at: &Vec2| {
            is_inside(Rect::from_min_size(*at, block), region)
                && (0..count).all(|index| has_room(layout, floor, page, cell(*at, index)))
        };
        let Vec2 { x: west, y: south } =
            up(Vec2::new(middle - 0.5 * block.x, region.min.y)) + Vec2::new(0.0, 2.0 * step.y);
        // The casts from float saturate at the range of the integer.
        let at_end = ends_of_rows(layout, page, gap, block, middle).into_iter().find(&is_free);
        let found = at_end.or_else(|| {
            (0..=tries(room).y as u16).find_map(|north| {
                let beside = (0..=2 * tries(region.size()).x as u16).map(|turn| {
                    // To and fro about the middle.
                    let far = f32::from(turn.div_ceil(2)) * STRIDE * step.x;
                    if turn % 2 == 0 { west - far } else { west + far }
                });
                let y = south + f32::from(north) * STRIDE * step.y;
                beside.map(|x| Vec2::new(x, y)).find(&is_free)
            })
        });
        if let Some(at) = found {
            return Some((0..count).map(|index| cell(at, index)).collect());
        }
    }
    None
}

/// The places beside the controls of a page, level with them, at which a block of this size continues their row; the
/// nearest to `middle` first.
fn ends_of_rows(layout: &Layout, page: usize, gap: Vec2, block: Vec2, middle: f32) -> Vec<Vec2> {
    let there = layout.widgets.iter().filter(|widget| widget.is_on(page)).map(|widget| widget.area);
    let ends =
        |area: Rect| [area.max.x + gap.x, area.min.x - gap.x - block.x].map(|x| Vec2::new(x, area.min.y));
    let mut all: Vec<Vec2> = there.flat_map(ends).collect();
    let far = |at: &Vec2| (at.x + 0.5 * block.x - middle).abs();
    all.sort_by(|one, other| far(one).total_cmp(&far(other)));
    all
}

#[cfg(test)]
mod tests {
    use super::super::tests::open;
    use super::super::{Template, mends_together};
    use super::*;
    use underfoot::floor::Floor;

    #[test]
    fn new_controls_stand_in_rows_that_no_rule_complains_about() {
        let text = Template::Empty.text(&Floor::default().geometry);
        for (size, count) in [(0.6, 1), (0.6, 6), (0.6, 8), (1.2, 4)] {
            let mut document = open("new", &text);
            let size = Vec2::new(size, 0.55) * document.floor().geometry.pitch_m();
            let places = free_row(&document, 0, size, count).unwrap_or_else(|| panic!("{count}"));
            assert_eq!(places.len(), count);
            for (number, area) in places.iter().enumerate() {
                let label = format!("Room {number}");
                let text = document.new_control("button", *area, Some(&label));
                let at = super::super::Address::of(super::super::RecordList::Widgets, usize::MAX);
                document.edit(&[super::super::Edit::Insert { at, text }]).unwrap();
            }
            assert!(!document.findings().iter().any(mends_together), "{}", document.text());
            assert!(document.warnings().is_empty(), "{}", document.warnings());
            assert!(document.layout().widget_index("room_0").is_some(), "{}", document.text());
            // Those that follow find places beside them.
            let next = free_row(&document, 0, size, 1).unwrap()[0];
            assert!(places.iter().all(|place| !place.overlaps(next)));
            let is_level = places.iter().any(|place| (place.min.y - next.min.y).abs() < 1e-4);
            assert!(is_level || count > 1, "{next:?} continues the row");
        }
        let full = open("new", &text);
        assert_eq!(free_row(&full, 0, Vec2::splat(0.3), 400), None);
    }
}
