//! Arranges several areas: alignment and equal distances.

use glam::Vec2;

use underfoot::floor::Rect;

/// The reference line of an alignment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Western edges, on the westernmost one.
    West,
    /// Middles from west to east, on the middle of all.
    Centre,
    /// Eastern edges, on the easternmost one.
    East,
    /// Southern edges, on the southernmost one.
    South,
    /// Middles from south to north, on the middle of all.
    Middle,
    /// Northern edges, on the northernmost one.
    North,
}

impl Align {
    /// All variants.
    pub const ALL: [Self; 6] = [Self::West, Self::Centre, Self::East, Self::South, Self::Middle, Self::North];
}

/// Aligns `areas`; sizes stay.
#[must_use]
pub fn align(areas: &[Rect], how: Align) -> Vec<Rect> {
    let Some(all) = super::item::around(areas.iter().copied()) else { return Vec::new() };
    let moved = |area: &Rect| {
        let by = match how {
            Align::West => Vec2::new(all.min.x - area.min.x, 0.0),
            Align::Centre => Vec2::new(all.centre().x - area.centre().x, 0.0),
            Align::East => Vec2::new(all.max.x - area.max.x, 0.0),
            Align::South => Vec2::new(0.0, all.min.y - area.min.y),
            Align::Middle => Vec2::new(0.0, all.centre().y - area.centre().y),
            Align::North => Vec2::new(0.0, all.max.y - area.max.y),
        };
        Rect::new(area.min + by, area.max + by)
    };
    areas.iter().map(moved).collect()
}

/// Distributes `areas` with equal gaps, from west to east (`axis` 0) or from south to north (1); the two outermost
/// ones stay. Fewer than three areas stay unchanged.
#[must_use]
pub fn distribute(areas: &[Rect], axis: usize) -> Vec<Rect> {
    let axis = axis.min(1);
    let mut order: Vec<usize> = (0..areas.len()).collect();
    order.sort_by(|&a, &b| areas[a].min[axis].total_cmp(&areas[b].min[axis]));
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else { return Vec::new() };
    if areas.len() < 3 {
        return areas.to_vec();
    }
    let length: f32 = areas.iter().map(|area| area.size()[axis]).sum();
    let gap = (areas[last].max[axis] - areas[first].min[axis] - length) / (areas.len() - 1) as f32;
    let mut placed = areas.to_vec();
    let mut next = areas[first].min[axis];
    for index in order {
        let mut by = Vec2::ZERO;
        by[axis] = next - areas[index].min[axis];
        placed[index] = Rect::new(areas[index].min + by, areas[index].max + by);
        next += areas[index].size()[axis] + gap;
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn areas() -> Vec<Rect> {
        let area = |x, y, w, h| Rect::from_min_size(Vec2::new(x, y), Vec2::new(w, h));
        vec![area(1.0, 0.2, 0.1, 0.2), area(0.0, 0.0, 0.2, 0.1), area(0.3, 0.5, 0.3, 0.1)]
    }

    #[test]
    fn edges_and_middles_come_in_line_and_sizes_stay() {
        for how in Align::ALL {
            let aligned = align(&areas(), how);
            let of = |area: &Rect| match how {
                Align::West => area.min.x,
                Align::Centre => area.centre().x,
                Align::East => area.max.x,
                Align::South => area.min.y,
                Align::Middle => area.centre().y,
                Align::North => area.max.y,
            };
            assert!(aligned.iter().all(|area| (of(area) - of(&aligned[0])).abs() < 1e-6), "{how:?}");
            for (before, after) in areas().iter().zip(&aligned) {
                assert!((before.size() - after.size()).length() < 1e-6);
            }
        }
        assert_eq!(align(&areas(), Align::East)[0], areas()[0], "the easternmost one stays");
        assert!(align(&[], Align::West).is_empty());
    }

    #[test]
    fn gaps_become_equal_and_the_outermost_stay() {
        let placed = distribute(&areas(), 0);
        assert_eq!((placed[0], placed[1]), (areas()[0], areas()[1]));
        // 1.1 m minus 0.6 m of controls leaves two gaps of 25 cm.
        assert!((placed[2].min.x - 0.45).abs() < 1e-6, "{placed:?}");
        assert_eq!(placed[2].min.y, areas()[2].min.y);
        assert_eq!(distribute(&areas()[..2], 1), areas()[..2]);
    }
}
