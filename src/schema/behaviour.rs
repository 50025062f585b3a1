//! What a control does, as its kind and its widget write it: the settings of its behaviour among their fields.

use std::time::Duration;

use super::fields::Fields;
use super::node::Node;
use super::problem::Problem;
use crate::format::Variants;
use crate::widget::{Behaviour, Guard};

/// A foot that walks across a control is on it for less than this.
const STEP: Duration = Duration::from_millis(250);

/// The name of the behaviour that `node` says.
pub(super) fn name(node: Node<'_>) -> Option<&'static str> {
    let names: Vec<_> = Behaviour::NAMES.iter().map(|name| (*name, *name)).collect();
    node.choice(&names)
}

/// The behaviour of this name; its settings must all be written, unless there is a base.
pub(super) fn read(fields: &mut Fields<'_>, name: &str, base: Option<&Behaviour>) -> Option<Behaviour> {
    let behaviour = Behaviour::read_fields(name, fields, base)?;
    check_guard(fields, &behaviour);
    fields.are_read().then_some(behaviour)
}

/// `base` with the settings that are written.
pub(super) fn read_over(fields: &mut Fields<'_>, base: &Behaviour) -> Option<Behaviour> {
    read(fields, base.variant(), Some(base))
}

fn check_guard(fields: &Fields<'_>, behaviour: &Behaviour) {
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
