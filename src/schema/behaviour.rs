//! Behaviour of a control in its widget: the settings are among the widget's fields.

use std::time::Duration;

use super::fields::Fields;
use super::problem::Problem;
use crate::widget::{Behaviour, Guard};
use underfoot_format::Variants;

/// A walking foot is on a control for less than this.
const STEP: Duration = Duration::from_millis(250);

/// Reads the settings over `base`.
pub(super) fn read_over(fields: &mut Fields<'_>, base: &Behaviour) -> Option<Behaviour> {
    let behaviour = Behaviour::read_fields(base.variant(), fields, Some(base), &())?;
    check_guard(fields, &behaviour);
    fields.are_read().then_some(behaviour)
}

/// Reports a guard that does not fit the behaviour.
pub(super) fn check_guard(fields: &Fields<'_>, behaviour: &Behaviour) {
    let at = behaviour.thresholds();
    let Guard::HoldToRun(_) = at.guard else { return };
    if !matches!(behaviour, Behaviour::Hold(_) | Behaviour::Pedal(_) | Behaviour::Lean(_)) {
        let problem =
            Problem::error(fields.span("guard"), "only what acts while it is held can run on a hold");
        let help = "a control that keeps its state can be guarded by Confirm";
        fields.report(problem.expected("HoldToRun is for Hold, Pedal and Lean").help(help));
    } else if let Some(span) = fields.value_span("dwell_ms").or_else(|| fields.value_span("guard"))
        && at.dwell < STEP
    {
        let problem = Problem::warning(span, "a foot that walks across could run this control");
        fields.report(problem.expected("such a foot stays for up to 250 ms").help("write dwell_ms: 250"));
    }
}
