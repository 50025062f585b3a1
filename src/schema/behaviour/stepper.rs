use std::time::Duration;

use super::super::fields::Fields;
use super::super::problem::Problem;
use super::slider::axis;
use super::{millis, optional, scale};
use crate::widget::{Repeat, StepperSpec, Thresholds};

/// How a held stepper repeats unless its kind says otherwise: slow enough to let go in time.
const REPEAT: Repeat = Repeat {
    after: Duration::from_millis(600),
    every: Duration::from_millis(250),
    fastest: Duration::from_millis(60),
};

/// A stepper's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&StepperSpec>,
) -> Option<StepperSpec> {
    let axis = axis(fields, base.map(|base| base.axis));
    let scale = scale::read(fields, base.map(|base| base.scale));
    let initial = scale::initial(fields, scale, base.map(|base| base.initial));
    let known = base.map_or(Some(REPEAT), |base| base.repeat);
    let after = optional(fields, "repeat_after_ms", known.map(|repeat| repeat.after), |node| {
        node.number(50.0..=5000.0).map(|number| Duration::from_micros((number.value * 1e3).round() as u64))
    });
    let known = known.unwrap_or(REPEAT);
    let every = millis(fields, "repeat_every_ms", known.every, 5000.0);
    let fastest = millis(fields, "fastest_ms", known.fastest, 5000.0);
    let (scale, after, every, fastest) = (scale?, after?, every?, fastest?);
    if scale.step <= 0.0 {
        let problem = Problem::error(fields.span("step"), "a stepper needs a `step`");
        fields.report(problem.expected("expected more than 0"));
    }
    if fastest > every || fastest < Duration::from_millis(10) {
        let span = fields.written_span("fastest_ms").or_else(|| fields.written_span("repeat_every_ms"));
        let problem = Problem::error(
            span.unwrap_or_else(|| fields.start()),
            "`fastest_ms` must be 10 or more and at most `repeat_every_ms`",
        );
        let found =
            format!("fastest_ms is {}, repeat_every_ms is {}", fastest.as_millis(), every.as_millis());
        fields.report(problem.expected(found));
    }
    let repeat = after.map(|after| Repeat { after, every, fastest });
    Some(StepperSpec { thresholds: at?, axis: axis?, scale, initial: initial?, repeat })
}
