//! Reads a syntax tree and collects problems instead of stopping at the first.
//!
//! A read returns `None` after it has reported the reason. Callers read on with the values they have, and build a
//! result only if nothing was `None`.

use std::cell::RefCell;
use std::ops::Range;

use ron2::ast::{Expr, StructBody};

use super::diagnostic::{Diagnostic, Diagnostics, Severity};
use super::node::Node;
use super::pairs::Limits;
use super::problem::Problem;
use super::source::Source;
use super::syntax::{self, Syntax};

/// One file being read, and all problems found in it so far.
pub struct Reader<'t> {
    source: &'t Source<'t>,
    syntax: Syntax<'t>,
    problems: RefCell<Vec<Problem>>,
}

impl<'t> Reader<'t> {
    /// Parses a file that is expected to hold one `kind` of thing, such as a `Layout`.
    pub fn new(source: &'t Source<'t>, kind: &str, limits: Limits) -> Self {
        let mut syntax = syntax::parse(source.text(), kind, limits);
        let problems = RefCell::new(std::mem::take(&mut syntax.problems));
        Self { source, syntax, problems }
    }

    /// The text of the file.
    pub fn text(&self) -> &'t str {
        self.source.text()
    }

    /// Returns the root value of the file.
    pub fn root(&self, name: &'static str) -> Option<Node<'_>> {
        let root = |expr| Node { reader: self, expr, name, within: None, length_unit: "" };
        self.syntax.root.as_ref().map(root)
    }

    /// Returns the name of the file in diagnostics.
    pub fn name(&self) -> &'t str {
        self.source.name()
    }

    /// Reports a problem, unless it lies within a syntax error.
    pub fn report(&self, problem: Problem) {
        if !self.is_broken(&problem.span) {
            self.problems.borrow_mut().push(problem);
        }
    }

    /// Whether `span` holds a syntax error, so that a field that seems missing there may have been written.
    pub fn is_broken(&self, span: &Range<usize>) -> bool {
        self.syntax.holes.iter().any(|hole| hole.start < span.end && span.start < hole.end)
    }

    /// Whether everything read so far is usable.
    pub fn is_sound(&self) -> bool {
        self.problems.borrow().iter().all(|problem| problem.severity == Severity::Warning)
    }

    /// Returns the line of a place, for messages that point to a second place.
    pub fn line(&self, span: &Range<usize>) -> usize {
        self.source.line(span.start)
    }

    /// Returns this problem alone and drops all others.
    pub fn only(&self, problem: Problem) -> Diagnostics {
        diagnose(self.source, self.syntax.root.as_ref(), problem).into()
    }

    /// Returns all problems found so far.
    pub fn into_diagnostics(self) -> Diagnostics {
        let mut problems = self.problems.take();
        problems.sort_by_key(|problem| (problem.span.start, problem.severity));
        let omitted = problems.split_off(problems.len().min(Diagnostics::LIMIT));
        let omitted = omitted.into_iter().map(|problem| problem.severity);
        let list =
            problems.into_iter().map(|problem| diagnose(self.source, self.syntax.root.as_ref(), problem));
        Diagnostics::new(list.collect(), omitted)
    }

    /// Returns `value` with the warnings if it exists and there are no errors; otherwise all problems.
    ///
    /// # Errors
    /// All problems, if there is no value or one of them is an error.
    pub fn conclude<T>(self, value: Option<T>) -> Result<(T, Diagnostics), Diagnostics> {
        match value {
            Some(value) if self.is_sound() => Ok((value, self.into_diagnostics())),
            // Every rejection has a reason.
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

/// Returns the path of fields from `expr` down to the byte at `offset`.
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

/// Returns the bytes of a place that the parser gives.
pub fn bytes(span: &ron2::Span) -> Range<usize> {
    span.start_offset..span.end_offset
}
