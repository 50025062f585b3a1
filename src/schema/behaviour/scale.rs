use super::super::fields::Fields;
use super::super::node::Node;
use super::super::number::plain;
use super::super::problem::Problem;
use super::single;
use crate::widget::Scale;

/// Values of controls: as far as `f32` still resolves a tenth.
pub(super) const VALUES: std::ops::RangeInclusive<f64> = -1e6..=1e6;

/// The values that a control's number may take.
pub(super) fn read(fields: &mut Fields<'_>, base: Option<Scale>) -> Option<Scale> {
    let value = |node: Node<'_>| single(node, VALUES);
    let min = fields.read("min", base.map(|base| base.min), value);
    let max = fields.read("max", base.map(|base| base.max), value);
    let step = fields.read("step", Some(base.map_or(0.0, |base| base.step)), |node| single(node, 0.0..=1e6));
    let detent =
        fields.read("detent", Some(base.map_or(0.0, |base| base.detent)), |node| single(node, 0.0..=1e6));
    let scale = Scale { min: min?, max: max?, step: step?, detent: detent? };
    check(fields, scale).then_some(scale)
}

/// Reports what is wrong with `scale`; whether it can be used to look at the rest.
fn check(fields: &Fields<'_>, scale: Scale) -> bool {
    let Scale { min, max, step, .. } = scale;
    let shown = |value: f32| plain(value.into());
    if min >= max {
        let span = fields.written_span("max").unwrap_or_else(|| fields.span("min"));
        let found = format!("min is {}, max is {}", shown(min), shown(max));
        fields.report(Problem::error(span, "`max` must be greater than `min`").expected(found));
        return false;
    }
    let steps = (max - min) / step;
    if step > max - min {
        let found = format!("the range is only {} wide", shown(max - min));
        fields.report(Problem::error(fields.span("step"), "`step` is wider than the range").expected(found));
    } else if step > 0.0 && (steps - steps.round()).abs() > 1e-3 {
        let found = format!("{} to {} is {} steps", shown(min), shown(max), shown(steps));
        let problem = Problem::warning(fields.span("step"), "`max` is no whole number of steps from `min`");
        fields.report(problem.expected(found));
    }
    if scale.detent > max - min {
        let found = format!("the range is only {} wide", shown(max - min));
        let problem = Problem::error(fields.span("detent"), "`detent` is wider than the range");
        fields.report(problem.expected(found));
    } else if scale.detent > 0.0 && step > 0.0 {
        let problem = Problem::warning(fields.span("detent"), "steps are detents already");
        fields.report(problem.expected("`step` and `detent` are both given"));
    }
    true
}

/// The field `initial`: a value of `scale`. That of a kind follows a widget that narrows the range.
pub(super) fn initial(fields: &mut Fields<'_>, scale: Option<Scale>, base: Option<f32>) -> Option<f32> {
    let written = fields.read("initial", Some(None), |node| single(node, VALUES).map(Some));
    let Scale { min, max, .. } = scale?;
    let initial = written?.unwrap_or_else(|| base.unwrap_or(min).clamp(min, max));
    if !(min..=max).contains(&initial) {
        let range = format!("expected {} to {}", plain(min.into()), plain(max.into()));
        fields.report(
            Problem::error(fields.span("initial"), "`initial` lies outside of the range").expected(range),
        );
    }
    Some(initial)
}
