use std::sync::Arc;

use super::super::fields::Fields;
use super::super::node::Node;
use super::super::problem::Problem;
use super::slider::axis;
use crate::widget::{SelectorSpec, Thresholds};

/// Most options: more are too narrow for a foot on any control within reach.
const MOST: usize = 12;

/// A selector's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&SelectorSpec>,
) -> Option<SelectorSpec> {
    let axis = axis(fields, base.map(|base| base.axis));
    let options = fields.read("options", base.map(|base| base.options.clone()), options);
    let written = fields.read("initial", Some(None), |node| node.whole(0..=MOST as u32 - 1).map(Some));
    let (options, written) = (options?, written?);
    let count = options.len() as u32;
    let initial = written.unwrap_or_else(|| base.map_or(0, |base| base.initial.into()).min(count - 1));
    if initial >= count {
        let problem = Problem::error(fields.span("initial"), "`initial` is no option");
        fields.report(problem.expected(format!("expected 0 to {}", count - 1)));
    }
    Some(SelectorSpec { thresholds: at?, axis: axis?, options, initial: initial as u16 })
}

fn options(node: Node<'_>) -> Option<Arc<[Arc<str>]>> {
    let nodes = node.list("option", MOST)?;
    if nodes.len() < 2 {
        let problem = Problem::error(node.span(), "a selector needs options to choose from");
        node.report(problem.expected(format!("expected 2 to {MOST} texts")));
        return None;
    }
    // All are read before the first that failed ends it, so that each is reported.
    let texts: Vec<Option<Arc<str>>> = nodes.into_iter().map(|node| node.text(32).map(Arc::from)).collect();
    texts.into_iter().collect()
}
