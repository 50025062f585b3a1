//! Rectangles as layouts write them.

use std::fmt;
use std::ops::Range;

use glam::Vec2;

use super::fields::Fields;
use super::node::Node;
use super::number::plain;
use super::units::Units;
use crate::floor::{Geometry, Rect, TileBlock};
use underfoot_format::Codec;
use underfoot_format::describe::{FieldDescription, FieldType};
use underfoot_format::text::Text;

/// Tolerance within which edges count as touching, in tiles: far below any foot, far above rounding errors.
const TOUCH: f64 = 1e-6;

/// A rectangle as layouts write it: in their [`Units`], from the floor's south-west corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WrittenArea {
    min: [f64; 2],
    max: [f64; 2],
}

impl WrittenArea {
    /// Reads the area from the fields `at` and `size`.
    pub(super) fn read(fields: &mut Fields<'_>, units: Units) -> Option<Self> {
        let (least, most) = (units.shortest(), units.furthest());
        let at = fields.read("at", None, |node| node.pair(-most..=most));
        let size = fields.read("size", None, |node| node.pair(least..=most));
        Some(Self::new(at?, size?))
    }

    pub(super) fn new(at: [f64; 2], size: [f64; 2]) -> Self {
        Self { min: at, max: [at[0] + size[0], at[1] + size[1]] }
    }

    /// The whole floor.
    pub(super) fn of_floor(geometry: &Geometry, units: Units) -> Self {
        Self::of_tiles(&geometry.block(), geometry, units)
    }

    /// The cells of `block`.
    pub(super) fn of_tiles(block: &TileBlock, geometry: &Geometry, units: Units) -> Self {
        // Sides of a cell; exactly 1 in tiles, without rounding.
        let [width, depth] = match units {
            Units::Tiles => [1.0; 2],
            Units::Metres => Units::Tiles.metres(geometry),
        };
        let first = block.first;
        Self::new(
            [f64::from(first.column) * width, f64::from(first.row) * depth],
            [f64::from(block.columns) * width, f64::from(block.rows) * depth],
        )
    }

    pub(super) fn min(&self) -> [f64; 2] {
        self.min
    }

    pub(super) fn max(&self) -> [f64; 2] {
        self.max
    }

    /// Returns the smallest rectangle around both.
    pub(super) fn around(&self, other: &Self) -> Self {
        let (mut min, mut max) = (self.min, self.max);
        for axis in 0..2 {
            min[axis] = min[axis].min(other.min[axis]);
            max[axis] = max[axis].max(other.max[axis]);
        }
        Self { min, max }
    }

    /// Returns the area moved east and north.
    pub(super) fn moved_by(&self, by: [f64; 2]) -> Self {
        let move_corner = |corner: [f64; 2]| [corner[0] + by[0], corner[1] + by[1]];
        Self { min: move_corner(self.min), max: move_corner(self.max) }
    }

    pub(super) fn size(&self) -> [f64; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    pub(super) fn middle(&self) -> [f64; 2] {
        [0.5 * (self.min[0] + self.max[0]), 0.5 * (self.min[1] + self.max[1])]
    }

    /// Whether `point` lies inside; west and south edges count, east and north ones do not.
    pub(super) fn contains(&self, point: [f64; 2]) -> bool {
        (0..2).all(|axis| self.min[axis] <= point[axis] && point[axis] < self.max[axis])
    }

    /// Whether all of this lies in `outer`; edges may touch.
    pub(super) fn within(&self, outer: &Self) -> bool {
        (0..2).all(|axis| {
            outer.min[axis] <= self.min[axis] + TOUCH && self.max[axis] <= outer.max[axis] + TOUCH
        })
    }

    /// Returns width and depth of the intersection; `None` if the areas only touch or lie apart.
    pub(super) fn shared(&self, other: &Self) -> Option<[f64; 2]> {
        let along = |axis: usize| self.max[axis].min(other.max[axis]) - self.min[axis].max(other.min[axis]);
        let shared = [along(0), along(1)];
        shared.iter().all(|length| *length > TOUCH).then_some(shared)
    }

    /// Describes the shortest move that separates this from `other` and keeps it on `floor`.
    pub(super) fn way_off(&self, other: &Self, floor: &Self) -> Option<String> {
        let moves = [
            (other.max[0] - self.min[0], 0, 1.0, "east"),
            (self.max[0] - other.min[0], 0, -1.0, "west"),
            (other.max[1] - self.min[1], 1, 1.0, "north"),
            (self.max[1] - other.min[1], 1, -1.0, "south"),
        ];
        moves
            .into_iter()
            .filter(|&(distance, axis, sign, _)| self.moved(axis, sign * distance).within(floor))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(distance, _, _, direction)| format!("move it {direction} by {}", plain(distance)))
    }

    fn moved(mut self, axis: usize, distance: f64) -> Self {
        self.min[axis] += distance;
        self.max[axis] += distance;
        self
    }

    /// Returns the same rectangle in floor metres.
    pub(super) fn in_metres(&self, geometry: &Geometry, units: Units) -> Rect {
        let [east, north] = units.metres(geometry);
        let metres = |[x, y]: [f64; 2]| Vec2::new((x * east) as f32, (y * north) as f32);
        Rect::new(metres(self.min), metres(self.max))
    }
}

impl fmt::Display for WrittenArea {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [west, south] = self.min.map(plain);
        let [east, north] = self.max.map(plain);
        write!(f, "({west}, {south}) to ({east}, {north})")
    }
}

/// An area, and the place of its `at` in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placed {
    pub(super) area: WrittenArea,
    pub(super) at: Range<usize>,
}

impl Placed {
    pub(super) fn read(fields: &mut Fields<'_>, units: Units) -> Option<Self> {
        let area = WrittenArea::read(fields, units)?;
        Some(Self { area, at: fields.span("at") })
    }
}

/// Reads an area from `at` and `size` among the fields; `None` if it could not be read.
pub(super) struct Place;

impl Codec<Option<Placed>> for Place {
    type Context = Units;

    fn read(&self, _: Node<'_>, base: Option<&Option<Placed>>, _: &Units) -> Option<Option<Placed>> {
        base.cloned()
    }

    fn write(&self, _: &Option<Placed>) -> Text {
        Text::List(Vec::new())
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("(east, north), in the layout's `units`")
    }

    fn stand_in(&self) -> Option<Placed> {
        None
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        _: Option<&Option<Placed>>,
        _: Option<Option<Placed>>,
        units: &Units,
    ) -> Option<Placed> {
        let place = Placed::read(fields, *units);
        if place.is_none() {
            fields.fail(name);
        }
        place
    }

    fn describe_field(
        &self,
        _: &'static str,
        _: &[&str],
        _: Option<Option<Placed>>,
        fields: &mut Vec<FieldDescription>,
    ) {
        for (name, about) in [("at", "Its south-west corner."), ("size", "Its width and depth.")] {
            let shape = Codec::<Option<Placed>>::shape(self);
            fields.push(FieldDescription { name, about: about.to_owned(), shape, default: None });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_that_meet_touch_in_spite_of_rounding() {
        // In floating point, 0.1 + 0.2 is slightly more than 0.3.
        let west = WrittenArea::new([0.1, 0.0], [0.2, 1.0]);
        let east = WrittenArea::new([0.3, 0.0], [0.3, 1.0]);
        assert_eq!(west.shared(&east), None);
        assert!(WrittenArea::new([5.3, 0.0], [0.7, 1.0]).within(&WrittenArea::new([0.0, 0.0], [6.0, 6.0])));
    }

    #[test]
    fn the_shortest_way_off_stays_on_the_floor() {
        let floor = WrittenArea::new([0.0, 0.0], [6.0, 6.0]);
        let below = WrittenArea::new([1.0, 1.0], [1.0, 1.0]);
        let over = WrittenArea::new([1.75, 1.25], [1.0, 1.0]);
        assert_eq!(over.shared(&below).unwrap(), [0.25, 0.75]);
        assert_eq!(over.way_off(&below, &floor).as_deref(), Some("move it east by 0.25"));
        let edge = WrittenArea::new([4.5, 1.0], [1.0, 1.0]);
        let outer = WrittenArea::new([5.0, 1.0], [1.0, 1.0]);
        assert_eq!(outer.way_off(&edge, &floor).as_deref(), Some("move it north by 1"));
    }

    #[test]
    fn tiles_become_metres_by_the_pitch() {
        let geometry = Geometry::default();
        let rect = WrittenArea::new([2.0, 1.0], [1.0, 0.5]).in_metres(&geometry, Units::Tiles);
        assert!((rect.min - Vec2::new(0.608, 0.304)).length() < 1e-6);
        assert!((rect.size() - Vec2::new(0.304, 0.152)).length() < 1e-6);
        let metres = WrittenArea::new([0.5, 1.0], [0.25, 0.5]).in_metres(&geometry, Units::Metres);
        assert_eq!(metres, Rect::new(Vec2::new(0.5, 1.0), Vec2::new(0.75, 1.5)));
    }
}
