//! What a control does, as its kind and its widget write it: the settings of its behaviour among their fields.

use std::time::Duration;

use super::fields::Fields;
use super::node::Node;
use super::problem::Problem;
use crate::format::codec::Beside;
use crate::format::describe::FieldType;
use crate::format::text::{Entry, Text};
use crate::format::{Codec, Variants};
use crate::widget::{Behaviour, Guard};

/// A foot that walks across a control is on it for less than this.
const STEP: Duration = Duration::from_millis(250);

/// `base` with the settings that are written.
pub(super) fn read_over(fields: &mut Fields<'_>, base: &Behaviour) -> Option<Behaviour> {
    let behaviour = Behaviour::read_fields(base.variant(), fields, Some(base))?;
    check_guard(fields, &behaviour);
    fields.are_read().then_some(behaviour)
}

/// What a kind does: the name of its behaviour, or its parent's, with the settings beside it.
pub(super) struct KindBehaviour;

impl Codec<Behaviour> for KindBehaviour {
    fn read(&self, node: Node<'_>, base: Option<&Behaviour>) -> Option<Behaviour> {
        Beside.read(node, base)
    }

    fn write(&self, behaviour: &Behaviour) -> Text {
        Beside.write(behaviour)
    }

    fn shape(&self) -> FieldType {
        Codec::<Behaviour>::shape(&Beside)
    }

    fn stand_in(&self) -> Behaviour {
        Behaviour::stand_in()
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        base: Option<&Behaviour>,
        _: Option<Behaviour>,
    ) -> Behaviour {
        let behaviour = match base {
            Some(base) => {
                // One that is written has been refused.
                fields.take(name);
                Behaviour::read_fields(base.variant(), fields, Some(base)).unwrap_or_else(|| base.clone())
            }
            None => Beside.read_field(fields, name, None, None),
        };
        if !fields.have_failed(&[name]) {
            check_guard(fields, &behaviour);
        }
        behaviour
    }

    fn write_field(
        &self,
        behaviour: &Behaviour,
        name: &'static str,
        default: Option<Behaviour>,
        entries: &mut Vec<Entry>,
    ) {
        Beside.write_field(behaviour, name, default, entries);
    }
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
