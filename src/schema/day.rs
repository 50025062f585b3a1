//! Days as files write them.

use super::fields::Fields;
use super::node::Node;
use super::problem::Problem;
use crate::floor::Day;

/// A day written as `"2026-11-20"`.
pub(super) fn read(node: Node<'_>) -> Option<Day> {
    let text = node.text(32)?;
    let day = text.parse().ok();
    if day.is_none() {
        let message = format!("`{}` is no day", node.name);
        let problem = Problem::error(node.span(), message).expected("expected year-month-day");
        node.report(problem.help("write \"2026-11-20\""));
    }
    day
}

/// Reports that of two fields that belong together only one is written.
pub(super) fn report_half(
    fields: &Fields<'_>,
    (first, second): (&'static str, &'static str),
    has_first: bool,
) {
    let (here, lacking) = if has_first { (first, second) } else { (second, first) };
    let problem = Problem::error(fields.span(here), format!("`{here}` needs `{lacking}` beside it"));
    fields.report(problem.expected(format!("`{lacking}` is missing")));
}
