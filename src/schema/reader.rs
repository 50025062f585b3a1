//! Reads a syntax tree and collects problems instead of stopping at the first.
//!
//! Every reading gives `None` after it has reported why. Callers read on with
//! what they have, and only build something if nothing was `None`.

use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::sync::Arc;

use ron2::ast::{Expr, StructBody};

use super::diagnostic::{Diagnostic, Diagnostics, Severity};
use super::effect::Effects;
use super::node::Node;
use super::pairs::Limits;
use super::problem::Problem;
use super::source::Source;
use super::syntax::{self, Syntax};
use super::units::Units;

/// One file being read, and everything found wrong with it so far.
pub(super) struct Reader<'t> {
    source: &'t Source<'t>,
    syntax: Syntax<'t>,
    problems: RefCell<Vec<Problem>>,
    /// What lengths of the file count in.
    units: Cell<Units>,
    /// The effects that may be named.
    effects: RefCell<Arc<Effects>>,
}

impl<'t> Reader<'t> {
    /// Parses a file that is expected to hold one `kind` of thing, such as a `Layout`.
    pub(super) fn new(source: &'t Source<'t>, kind: &str, limits: Limits) -> Self {
        let mut syntax = syntax::parse(source.text(), kind, limits);
        let problems = RefCell::new(std::mem::take(&mut syntax.problems));
        Self { source, syntax, problems, units: Cell::default(), effects: RefCell::default() }
    }

    /// What the file holds.
    pub(super) fn root(&self, what: &'static str) -> Option<Node<'_>> {
        self.syntax.root.as_ref().map(|expr| Node { reader: self, expr, what })
    }

    /// What places and sizes count in.
    pub(super) fn units(&self) -> Units {
        self.units.get()
    }

    /// From now on places and sizes count in these.
    pub(super) fn count_in(&self, units: Units) {
        self.units.set(units);
    }

    /// The effects that the file may name.
    pub(super) fn effects(&self) -> Arc<Effects> {
        Arc::clone(&self.effects.borrow())
    }

    /// From now on the file may name these.
    pub(super) fn know(&self, effects: Arc<Effects>) {
        self.effects.replace(effects);
    }

    /// What diagnostics call the file.
    pub(super) fn name(&self) -> &'t str {
        self.source.name()
    }

    /// Notes a problem, unless it lies where the text is broken anyway.
    pub(super) fn report(&self, problem: Problem) {
        if !self.is_broken(&problem.span) {
            self.problems.borrow_mut().push(problem);
        }
    }

    /// Whether the text is broken somewhere in `span`, so that nothing can be said of what is missing there.
    pub(super) fn is_broken(&self, span: &Range<usize>) -> bool {
        self.syntax.holes.iter().any(|hole| hole.start < span.end && span.start < hole.end)
    }

    /// Whether everything so far can be used.
    pub(super) fn is_sound(&self) -> bool {
        self.problems.borrow().iter().all(|problem| problem.severity == Severity::Warning)
    }

    /// The line of a place, for messages that point elsewhere.
    pub(super) fn line(&self, span: &Range<usize>) -> usize {
        self.source.line(span.start)
    }

    /// This one problem, whatever else there may be.
    pub(super) fn only(&self, problem: Problem) -> Diagnostics {
        diagnose(self.source, self.syntax.root.as_ref(), problem).into()
    }

    /// Everything noted so far.
    pub(super) fn into_diagnostics(self) -> Diagnostics {
        let mut problems = self.problems.take();
        problems.sort_by_key(|problem| (problem.span.start, problem.severity));
        let omitted = problems.split_off(problems.len().min(Diagnostics::LIMIT));
        let omitted = omitted.into_iter().map(|problem| problem.severity);
        let list =
            problems.into_iter().map(|problem| diagnose(self.source, self.syntax.root.as_ref(), problem));
        Diagnostics::new(list.collect(), omitted)
    }

    /// `value` with the warnings, if there is one and nothing was wrong; otherwise everything that was.
    pub(super) fn conclude<T>(self, value: Option<T>) -> Result<(T, Diagnostics), Diagnostics> {
        match value {
            Some(value) if self.is_sound() => Ok((value, self.into_diagnostics())),
            // Nobody is told "no" without a reason.
            None if self.is_sound() => Err(self.only(Problem::error(0..0, "this file makes no sense"))),
            _ => Err(self.into_diagnostics()),
        }
    }
}

fn diagnose(source: &Source<'_>, root: Option<&Expr<'_>>, problem: Problem) -> Diagnostic {
    let mut field = root.map(|root| path_to(root, problem.span.start)).unwrap_or_default();
    if let Some(missing) = problem.missing {
        let dot = if field.is_empty() { "" } else { "." };
        field = format!("{field}{dot}{missing}");
    }
    Diagnostic {
        field,
        expected: problem.expected,
        help: problem.help,
        ..source.diagnostic(problem.severity, &problem.span, problem.message)
    }
}

/// The path of fields from `expr` down to the byte at `offset`.
fn path_to(expr: &Expr<'_>, offset: usize) -> String {
    let fields = match expr {
        Expr::AnonStruct(node) => node.fields.as_slice(),
        Expr::Struct(node) => match &node.body {
            Some(StructBody::Fields(body)) => body.fields.as_slice(),
            _ => &[],
        },
        Expr::Option(node) => {
            return node.value.as_ref().map(|some| path_to(&some.expr, offset)).unwrap_or_default();
        }
        Expr::Seq(node) => {
            let found = node.items.iter().position(|item| bytes(item.expr.span()).contains(&offset));
            return found
                .map(|at| format!("[{at}]{}", dotted(&path_to(&node.items[at].expr, offset))))
                .unwrap_or_default();
        }
        _ => &[],
    };
    let found = fields.iter().find(|field| {
        (field.name.span.start_offset..field.value.span().end_offset.max(field.name.span.end_offset))
            .contains(&offset)
    });
    found
        .map(|field| format!("{}{}", field.name.name, dotted(&path_to(&field.value, offset))))
        .unwrap_or_default()
}

fn dotted(path: &str) -> String {
    if path.is_empty() || path.starts_with('[') { path.to_owned() } else { format!(".{path}") }
}

pub(super) fn bytes(span: &ron2::Span) -> Range<usize> {
    span.start_offset..span.end_offset
}
