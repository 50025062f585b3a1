use std::time::Duration;

use super::super::fields::Fields;
use super::super::node::Node;
use super::super::problem::Problem;
use super::{Form, seconds, variant};
use crate::widget::Guard;

/// How long a control stays armed unless its kind says otherwise.
const WITHIN: Duration = Duration::from_secs(3);

/// How long before its end a held control warns, unless its kind says otherwise: this, or a quarter of the time.
const WARN: Duration = Duration::from_secs(30);

/// A foot that walks across a control is on it for less than this.
const STEP: Duration = Duration::from_millis(250);

/// What it takes besides force; `dwell` is how long a press must hold before it counts.
pub(super) fn read(
    fields: &mut Fields<'_>,
    form: Form,
    base: Option<Guard>,
    dwell: Option<Duration>,
) -> Option<Guard> {
    let guard = fields.read("guard", Some(base.unwrap_or_default()), |node| written(node, base))?;
    let Guard::HoldToRun { .. } = guard else { return Some(guard) };
    if !form.is_momentary() {
        let problem =
            Problem::error(fields.span("guard"), "only what acts while it is held can run on a hold");
        let help = "a control that keeps its state can be guarded by Confirm";
        fields.report(problem.expected("HoldToRun is for Hold, Pedal and Lean").help(help));
    } else if let Some(span) = fields.written_span("dwell_ms").or_else(|| fields.written_span("guard"))
        && dwell.is_some_and(|dwell| dwell < STEP)
    {
        let problem = Problem::warning(span, "a foot that walks across could run this control");
        fields.report(problem.expected("such a foot stays for up to 250 ms").help("write dwell_ms: 250"));
    }
    Some(guard)
}

fn written(node: Node<'_>, base: Option<Guard>) -> Option<Guard> {
    match variant::read(node, &["Free", "Confirm", "HoldToRun"])? {
        ("Confirm", fields) => {
            let base = match base {
                Some(Guard::Confirm { within }) => within,
                _ => WITHIN,
            };
            let Some(mut fields) = fields else { return Some(Guard::Confirm { within: base }) };
            let within = fields.read("within_s", Some(base), |node| seconds(node, 0.5..=30.0));
            fields.finish();
            Some(Guard::Confirm { within: within? })
        }
        ("HoldToRun", fields) => {
            let Some(mut fields) = fields else {
                let problem = Problem::error(node.span(), "HoldToRun must end some time");
                node.report(problem.expected("`max_s` is missing").help("write HoldToRun(max_s: 60)"));
                return None;
            };
            let (known_max, known_warn) = match base {
                Some(Guard::HoldToRun { max, warn }) => (Some(max), Some(warn)),
                _ => (None, None),
            };
            let max = fields.read("max_s", known_max, |node| seconds(node, 1.0..=3600.0));
            let warn = fields.read("warn_s", Some(known_warn), |node| seconds(node, 0.0..=3600.0).map(Some));
            if let (Some(max), Some(Some(warn))) = (max, warn)
                && warn > max
            {
                let span = fields.written_span("warn_s").unwrap_or_else(|| fields.span("max_s"));
                let problem = Problem::error(span, "`warn_s` is longer than `max_s`");
                fields.report(problem.expected("it counts back from the end"));
            }
            fields.finish();
            let max = max?;
            Some(Guard::HoldToRun { max, warn: warn?.unwrap_or(WARN.min(max / 4)) })
        }
        (_, fields) => {
            if let Some(fields) = fields {
                fields.finish();
            }
            Some(Guard::Free)
        }
    }
}
