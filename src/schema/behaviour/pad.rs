use glam::Vec2;

use super::super::fields::Fields;
use super::super::node::Node;
use super::super::number::plain;
use super::super::problem::Problem;
use super::scale::VALUES;
use crate::widget::{PadSpec, Scale, Thresholds};

/// A pad's settings: pairs of numbers, eastwards and northwards.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&PadSpec>,
) -> Option<PadSpec> {
    let known = |of: fn(&Scale) -> f32| base.map(|base| [of(&base.x), of(&base.y)]);
    let none = [0.0; 2];
    let min = fields.read("min", known(|scale| scale.min), |node| pair(node, VALUES));
    let max = fields.read("max", known(|scale| scale.max), |node| pair(node, VALUES));
    let step =
        fields.read("step", Some(known(|scale| scale.step).unwrap_or(none)), |node| pair(node, 0.0..=1e6));
    let detent = fields
        .read("detent", Some(known(|scale| scale.detent).unwrap_or(none)), |node| pair(node, 0.0..=1e6));
    let written = fields.read("initial", Some(None), |node| pair(node, VALUES).map(Some));
    let (min, max, step, detent) = (min?, max?, step?, detent?);
    let axis = |of: usize| Scale { min: min[of], max: max[of], step: step[of], detent: detent[of] };
    let (x, y) = (axis(0), axis(1));
    let shown = |value: f32| plain(value.into());
    for (name, scale) in [("east", x), ("north", y)] {
        if scale.min >= scale.max {
            let span = fields.written_span("max").unwrap_or_else(|| fields.span("min"));
            let problem = Problem::error(span, "`max` must be greater than `min`");
            let found = format!("{name}wards min is {}, max is {}", shown(scale.min), shown(scale.max));
            fields.report(problem.expected(found));
            return None;
        }
        for (field, width) in [("step", scale.step), ("detent", scale.detent)] {
            if width > scale.range() {
                let problem =
                    Problem::error(fields.span(field), format!("`{field}` is wider than the range"));
                let found = format!("{name}wards the range is only {} wide", shown(scale.range()));
                fields.report(problem.expected(found));
            }
        }
    }
    // A kind's initial values follow a widget that narrows the range.
    let known = base.map_or(Vec2::new(x.min, y.min), |base| base.initial);
    let initial = match written? {
        Some([east, north]) => Vec2::new(east, north),
        None => known.clamp(Vec2::new(x.min, y.min), Vec2::new(x.max, y.max)),
    };
    let inside = (x.min..=x.max).contains(&initial.x) && (y.min..=y.max).contains(&initial.y);
    if !inside {
        let problem = Problem::error(fields.span("initial"), "`initial` lies outside of the range");
        let range = |scale: Scale| format!("{} to {}", shown(scale.min), shown(scale.max));
        fields.report(problem.expected(format!("expected ({}, {})", range(x), range(y))));
    }
    Some(PadSpec { thresholds: at?, x, y, initial })
}

fn pair(node: Node<'_>, range: std::ops::RangeInclusive<f64>) -> Option<[f32; 2]> {
    node.pair(range).map(|pair| pair.map(|value| value as f32))
}
