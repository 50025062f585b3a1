//! Place of a control or group: absolute, or relative to a neighbour.

use std::ops::Range;

use super::area::WrittenArea;
use super::fields::Fields;
use super::node::Node;
use super::problem::Problem;
use super::units::Units;

/// Side of the neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    RightOf,
    LeftOf,
    Above,
    Below,
}

const SIDES: [(&str, Side); 4] =
    [("right_of", Side::RightOf), ("left_of", Side::LeftOf), ("above", Side::Above), ("below", Side::Below)];

/// Alignment along the side of the neighbour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Align {
    /// South or west edges in line.
    Start,
    /// Middles in line.
    Middle,
    /// North or east edges in line.
    End,
}

const ALIGNS: [(&str, Align); 3] = [("Start", Align::Start), ("Middle", Align::Middle), ("End", Align::End)];

/// A place next to a neighbour of the same list.
#[derive(Clone, Copy)]
pub(super) struct NeighbourPlace<'r> {
    side: Side,
    align: Align,
    gap: f64,
    /// The neighbour's id.
    pub(super) neighbour: &'r str,
    /// The node of that id.
    pub(super) node: Node<'r>,
}

/// A place as written.
#[derive(Clone, Copy)]
pub(super) enum WrittenSpot<'r> {
    /// The south-west corner of a control, the origin of a group.
    At([f64; 2]),
    /// Known once the neighbour has its place.
    Beside(NeighbourPlace<'r>),
}

/// The fields of a place.
pub(super) struct Placing<'r> {
    /// `None` if it could not be read, which has been reported.
    pub(super) spot: Option<WrittenSpot<'r>>,
    /// Its place in the text.
    pub(super) at: Range<usize>,
    /// Whether it has a neighbour, whose size it may take.
    pub(super) is_relative: bool,
}

impl<'r> Placing<'r> {
    /// Reads the place in `at`, or in one of `right_of`, `left_of`, `above` and `below` with `gap` and `align`.
    pub(super) fn read(fields: &mut Fields<'r>, units: Units) -> Self {
        let mut sides = SIDES
            .into_iter()
            .filter_map(|(name, side)| Some((name, side, fields.take(name)?)))
            .collect::<Vec<_>>();
        sides.sort_by_key(|(_, _, node)| node.span().start);
        let far = units.furthest();
        let gap = fields.read("gap", Some(0.0), |node| node.number(0.0..=far).map(|number| number.value));
        let align = fields.read("align", Some(Align::Middle), |node| node.choice(&ALIGNS));
        let Some(&(name, side, node)) = sides.first() else {
            for (field, span) in ["gap", "align"].map(|field| (field, fields.value_span(field))) {
                let Some(span) = span else { continue };
                let problem = Problem::error(span, format!("`{field}` needs a neighbour"));
                let help = format!("say whose: right_of: \"home\", {field}: ...");
                fields.report(problem.expected("there is no right_of, left_of, above or below").help(help));
            }
            let at = fields.read("at", None, |node| node.pair(-far..=far));
            return Self { spot: at.map(WrittenSpot::At), at: fields.span("at"), is_relative: false };
        };
        let also = fields.take("at").map(|node| ("at", node));
        let second = also.or(sides.get(1).map(|&(name, _, node)| (name, node)));
        if let Some((second, node)) = second {
            let problem = Problem::error(node.span(), "its place is given twice");
            let help = format!("leave out `{second}` or `{name}`");
            fields.report(problem.expected(format!("`{name}` says where it is")).help(help));
        }
        let beside = node
            .text(64)
            .and_then(|neighbour| Some(NeighbourPlace { side, align: align?, gap: gap?, neighbour, node }));
        let spot = beside.filter(|_| second.is_none()).map(WrittenSpot::Beside);
        Self { spot, at: node.span(), is_relative: true }
    }
}

impl NeighbourPlace<'_> {
    /// Returns the south-west corner of an area of this `size` at this place.
    pub(super) fn corner(&self, neighbour: &WrittenArea, size: [f64; 2]) -> [f64; 2] {
        let (min, max) = (neighbour.min(), neighbour.max());
        let along = |axis: usize| match self.align {
            Align::Start => min[axis],
            Align::Middle => 0.5 * (min[axis] + max[axis] - size[axis]),
            Align::End => max[axis] - size[axis],
        };
        match self.side {
            Side::RightOf => [max[0] + self.gap, along(1)],
            Side::LeftOf => [min[0] - self.gap - size[0], along(1)],
            Side::Above => [along(0), max[1] + self.gap],
            Side::Below => [along(0), min[1] - self.gap - size[1]],
        }
    }
}
