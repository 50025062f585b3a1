//! Gaps between an area and its neighbours, and places at which gaps become equal.

use glam::Vec2;

use underfoot::floor::Rect;

/// Difference of two gaps that count as equal, in metres: what rounding to the file's digits explains.
const EQUAL_M: f32 = 1e-3;

/// Free floor between two areas in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourGap {
    /// Its western or southern end, in floor metres.
    pub from: Vec2,
    /// Its eastern or northern end.
    pub to: Vec2,
    /// Whether another gap of the same row is as wide.
    pub is_equal: bool,
}

impl NeighbourGap {
    /// Its width, in metres.
    #[must_use]
    pub fn length_m(&self) -> f32 {
        self.from.distance(self.to)
    }
}

/// The gaps from `area` to the nearest of `neighbours` in the four directions, and those beyond these neighbours that
/// are as wide. A neighbour counts if a straight line along the floor's sides leads to it.
#[must_use]
pub fn gaps_around(area: Rect, neighbours: &[Rect]) -> Vec<NeighbourGap> {
    let mut gaps = Vec::new();
    for axis in 0..2 {
        let row = row(axis, area, neighbours);
        let (before, after) = (nearest_before(axis, area, &row), nearest_after(axis, area, &row));
        let mut own: Vec<NeighbourGap> = Vec::with_capacity(4);
        own.extend(before.map(|other| between(axis, other, area)));
        own.extend(after.map(|other| between(axis, area, other)));
        let beyond = [
            before.and_then(|one| Some(between(axis, nearest_before(axis, one, &row)?, one))),
            after.and_then(|one| Some(between(axis, one, nearest_after(axis, one, &row)?))),
        ];
        let is_as_wide =
            |one: &NeighbourGap, other: &NeighbourGap| (one.length_m() - other.length_m()).abs() < EQUAL_M;
        let count = own.len();
        own.extend(beyond.into_iter().flatten());
        let equal: Vec<bool> = own
            .iter()
            .enumerate()
            .map(|(at, one)| own.iter().enumerate().any(|(other, gap)| other != at && is_as_wide(one, gap)))
            .collect();
        let shown = own.into_iter().zip(equal).enumerate();
        let shown = shown.filter(|(at, (_, is_equal))| *at < count || *is_equal);
        gaps.extend(shown.map(|(_, (gap, is_equal))| NeighbourGap { is_equal, ..gap }));
    }
    gaps
}

/// The western (`axis` 0) or southern (1) edges at which `area` would have equal gaps: in the middle between two
/// neighbours, or as far from one as that is from the next.
pub(super) fn equal_places(axis: usize, area: Rect, neighbours: &[Rect]) -> Vec<f32> {
    let row = row(axis, area, neighbours);
    let (before, after) = (nearest_before(axis, area, &row), nearest_after(axis, area, &row));
    let width = area.size()[axis];
    let mut places = Vec::with_capacity(3);
    if let (Some(before), Some(after)) = (before, after) {
        places.push(0.5 * (before.max[axis] + after.min[axis] - width));
    }
    if let Some(one) = before
        && let Some(other) = nearest_before(axis, one, &row)
    {
        places.push(2.0 * one.max[axis] - other.max[axis] - one.size()[axis]);
    }
    if let Some(one) = after
        && let Some(other) = nearest_after(axis, one, &row)
    {
        places.push(2.0 * one.min[axis] - other.min[axis] + one.size()[axis] - width);
    }
    places
}

/// The neighbours beside `area` along `axis`.
fn row(axis: usize, area: Rect, neighbours: &[Rect]) -> Vec<Rect> {
    let across = 1 - axis.min(1);
    let is_beside =
        |other: &&Rect| other.min[across] < area.max[across] && area.min[across] < other.max[across];
    neighbours.iter().filter(is_beside).copied().collect()
}

fn nearest_before(axis: usize, area: Rect, row: &[Rect]) -> Option<Rect> {
    let before = row.iter().filter(|other| other.max[axis] < area.min[axis] + EQUAL_M && **other != area);
    before.copied().max_by(|a, b| a.max[axis].total_cmp(&b.max[axis]))
}

fn nearest_after(axis: usize, area: Rect, row: &[Rect]) -> Option<Rect> {
    let after = row.iter().filter(|other| other.min[axis] > area.max[axis] - EQUAL_M && **other != area);
    after.copied().min_by(|a, b| a.min[axis].total_cmp(&b.min[axis]))
}

/// The gap between `low` and `high`, on the middle of the stretch that they share across it.
fn between(axis: usize, low: Rect, high: Rect) -> NeighbourGap {
    let across = 1 - axis.min(1);
    let middle = 0.5 * (low.min[across].max(high.min[across]) + low.max[across].min(high.max[across]));
    let at = |along: f32| if axis == 0 { Vec2::new(along, middle) } else { Vec2::new(middle, along) };
    NeighbourGap { from: at(low.max[axis]), to: at(high.min[axis]), is_equal: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(east: f32, north: f32) -> Rect {
        Rect::from_min_size(Vec2::new(east, north), Vec2::splat(0.2))
    }

    #[test]
    fn gaps_lead_to_the_nearest_in_each_direction_and_not_to_those_aside() {
        let gaps = gaps_around(at(1.0, 1.0), &[at(0.5, 1.1), at(0.1, 1.0), at(1.4, 1.5), at(1.1, 1.3)]);
        let lengths: Vec<f32> = gaps.iter().map(NeighbourGap::length_m).collect();
        assert_eq!(gaps.len(), 2, "{gaps:?}");
        assert!((lengths[0] - 0.3).abs() < 1e-5 && (lengths[1] - 0.1).abs() < 1e-5, "{lengths:?}");
        assert!(gaps.iter().all(|gap| !gap.is_equal));
        assert!((gaps[0].from.y - 1.15).abs() < 1e-5, "on the stretch that both share");
    }

    #[test]
    fn equal_gaps_are_marked_those_beyond_the_neighbour_too() {
        let gaps = gaps_around(at(0.6, 0.0), &[at(0.3, 0.0), at(0.0, 0.0), at(1.5, 0.0)]);
        let marked: Vec<f32> = gaps.iter().filter(|gap| gap.is_equal).map(NeighbourGap::length_m).collect();
        assert_eq!((gaps.len(), marked.len()), (3, 2), "{gaps:?}");
        assert!(marked.iter().all(|length| (length - 0.1).abs() < 1e-5));
    }

    #[test]
    fn equal_places_continue_a_row_on_both_sides_and_halve_a_gap() {
        let row = [at(0.0, 0.0), at(0.3, 0.0), at(1.3, 0.0)];
        let places = equal_places(0, at(0.62, 0.05), &row);
        // Between 0.5 and 1.3, and 0.1 behind 0.5.
        assert_eq!(places.len(), 2);
        assert!((places[0] - 0.8).abs() < 1e-5 && (places[1] - 0.6).abs() < 1e-5, "{places:?}");
        let places = equal_places(0, at(-0.35, 0.05), &row);
        assert!((places[0] + 0.3).abs() < 1e-5, "{places:?}");
        for place in places {
            let gaps = gaps_around(at(place, 0.05), &row);
            assert!(gaps.iter().filter(|gap| gap.is_equal).count() >= 2, "{gaps:?}");
        }
        assert!(equal_places(1, at(0.62, 0.05), &row).is_empty());
    }
}
