//! Reads a syntax tree and collects problems instead of stopping at the first.
//!
//! Every reading gives `None` after it has reported why. Callers read on with
//! what they have, and only build something if nothing was `None`.

use std::cell::RefCell;
use std::ops::{Range, RangeInclusive};

use ron2::ast::{Expr, StructBody};

use super::diagnostic::{Diagnostic, Diagnostics, Severity};
use super::fields::Fields;
use super::number::{NotANumber, Number, parse_number, plain};
use super::pairs::Limits;
use super::problem::Problem;
use super::source::Source;
use super::suggest::{listed, nearest};
use super::syntax::{self, Syntax};
use super::words::unit;

/// One file being read, and everything found wrong with it so far.
pub(super) struct Reader<'t> {
    source: &'t Source<'t>,
    syntax: Syntax<'t>,
    problems: RefCell<Vec<Problem>>,
}

impl<'t> Reader<'t> {
    /// Parses a file that is expected to hold one `kind` of thing, such as a `Layout`.
    pub(super) fn new(source: &'t Source<'t>, kind: &str, limits: Limits) -> Self {
        let mut syntax = syntax::parse(source.text(), kind, limits);
        let problems = RefCell::new(std::mem::take(&mut syntax.problems));
        Self { source, syntax, problems }
    }

    /// What the file holds.
    pub(super) fn root(&self, what: &'static str) -> Option<Node<'_>> {
        self.syntax.root.as_ref().map(|expr| Node { reader: self, expr, what })
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

    /// `value` with the warnings, if there is one and nothing was wrong; otherwise everything that was.
    pub(super) fn conclude<T>(self, value: Option<T>) -> Result<(T, Diagnostics), Diagnostics> {
        let sound = self.is_sound();
        let mut problems = self.problems.into_inner();
        problems.sort_by_key(|problem| (problem.span.start, problem.severity));
        let omitted = problems.len().saturating_sub(Diagnostics::LIMIT);
        problems.truncate(Diagnostics::LIMIT);
        let list =
            problems.into_iter().map(|problem| diagnose(self.source, self.syntax.root.as_ref(), problem));
        let diagnostics = Diagnostics::new(list.collect(), omitted);
        match value {
            Some(value) if sound => Ok((value, diagnostics)),
            _ => Err(diagnostics),
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

/// One value of the file, and the name by which messages speak of it.
#[derive(Clone, Copy)]
pub(super) struct Node<'r> {
    pub(super) reader: &'r Reader<'r>,
    pub(super) expr: &'r Expr<'r>,
    /// The field it is the value of, or what the entries of its list are.
    pub(super) what: &'static str,
}

impl<'r> Node<'r> {
    /// Where it stands.
    pub(super) fn span(&self) -> Range<usize> {
        bytes(self.expr.span())
    }

    /// Notes a problem.
    pub(super) fn report(&self, problem: Problem) {
        self.reader.report(problem);
    }

    /// Whether it is `None`.
    pub(super) fn is_none(&self) -> bool {
        matches!(self.expr, Expr::Option(option) if option.value.is_none())
    }

    /// What is inside of any `Some(...)` around it.
    pub(super) fn inside(mut self) -> Self {
        while let Expr::Option(option) = self.expr
            && let Some(some) = &option.value
        {
            self.expr = &some.expr;
        }
        self
    }

    /// The value of the field `name` if this is a `Kind(...)` that has one; nothing is reported.
    pub(super) fn peek(&self, kind: &'static str, name: &'static str) -> Option<Node<'r>> {
        let fields = match self.expr {
            Expr::AnonStruct(node) => &node.fields,
            Expr::Struct(node) if node.name.name == kind => match &node.body {
                Some(StructBody::Fields(body)) => &body.fields,
                _ => return None,
            },
            _ => return None,
        };
        let field = fields.iter().find(|field| field.name.name == name)?;
        Some(Node { expr: &field.value, what: name, ..*self }.inside())
    }

    /// Its value if it is a number; nothing is reported.
    pub(super) fn peek_number(&self) -> Option<f64> {
        let Expr::Number(number) = self.expr else { return None };
        parse_number(&number.raw).ok().map(|number| number.value)
    }

    /// Reports that this is not the `expected` thing, and gives `None`.
    pub(super) fn mismatch<T>(&self, expected: &str) -> Option<T> {
        // The parser has said already why an error node is none.
        if !matches!(self.expr, Expr::Error(_)) {
            let message = format!("`{}` must be {expected}", self.what);
            let found = format!("expected {expected}, found {}", describe(self.expr));
            self.report(
                Problem::error(self.span(), message).expected(found).help_if(remedy(self.expr, expected)),
            );
        }
        None
    }

    /// A finite number within `range`.
    pub(super) fn number(&self, range: RangeInclusive<f64>) -> Option<Number> {
        let Expr::Number(number) = self.expr else { return self.mismatch("a number") };
        let (what, raw) = (self.what, &number.raw);
        let (message, found) = match parse_number(raw) {
            Ok(number) if range.contains(&number.value) => return Some(number),
            Ok(number) => {
                (format!("`{what}` is out of range"), format!("{}{}", plain(number.value), unit(what)))
            }
            Err(NotANumber::TooLarge) => (format!("`{what}` is out of range"), raw.to_string()),
            Err(NotANumber::NotFinite) => (format!("`{what}` must be an ordinary number"), raw.to_string()),
            Err(NotANumber::Malformed) => (format!("`{what}` must be a number"), raw.to_string()),
        };
        let (least, most) = (plain(*range.start()), plain(*range.end()));
        let bounds = if least == most { least } else { format!("{least} to {most}{}", unit(what)) };
        self.report(
            Problem::error(self.span(), message).expected(format!("expected {bounds}, found {found}")),
        );
        None
    }

    /// A whole number within `range`.
    pub(super) fn whole(&self, range: RangeInclusive<u32>) -> Option<u32> {
        let number = self.number(f64::from(*range.start())..=f64::from(*range.end()))?;
        if number.whole {
            return Some(number.value as u32);
        }
        let message = format!("`{}` must be a whole number", self.what);
        self.report(Problem::error(self.span(), message).expected("expected digits only"));
        None
    }

    /// `true` or `false`.
    pub(super) fn flag(&self) -> Option<bool> {
        let Expr::Bool(flag) = self.expr else { return self.mismatch("true or false") };
        Some(flag.value)
    }

    /// Text of at most `longest` characters.
    pub(super) fn text(&self, longest: usize) -> Option<&'r str> {
        let Expr::String(text) = self.expr else { return self.mismatch("text") };
        let length = text.value.chars().count();
        if length > longest {
            let message = format!("`{}` is too long", self.what);
            let expected = format!("expected at most {longest} characters, found {length}");
            self.report(Problem::error(self.span(), message).expected(expected));
            return None;
        }
        Some(&text.value)
    }

    /// A name that can be part of an OSC address: `a` to `z`, `0` to `9` and `_`, at most 64 of them.
    pub(super) fn id(&self) -> Option<&'r str> {
        let text = self.text(64)?;
        let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if !text.is_empty() && text.chars().all(legal) {
            return Some(text);
        }
        let mended: String = text.to_lowercase().chars().map(|c| if legal(c) { c } else { '_' }).collect();
        let help = (mended.len() == text.len() && !mended.is_empty()).then(|| format!("write \"{mended}\""));
        let message = format!("`{}` can't be part of an address", self.what);
        let expected = "expected 1 to 64 of the characters a-z, 0-9 and _";
        self.report(Problem::error(self.span(), message).expected(expected).help_if(help));
        None
    }

    /// One of the names in `choices`, and what it stands for.
    pub(super) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let expected = listed(&names, "or");
        let Expr::Struct(variant) = self.expr else { return self.mismatch(&expected) };
        let written = &*variant.name.name;
        if let (Some((_, choice)), None) = (choices.iter().find(|(name, _)| *name == written), &variant.body)
        {
            return Some(*choice);
        }
        let problem = Problem::error(self.span(), format!("there is no `{}` called {written}", self.what));
        let help = nearest(written, names).map(|name| format!("did you mean {name}?"));
        self.report(problem.expected(format!("expected {expected}")).help_if(help));
        None
    }

    /// The entries of a list of at most `most`; messages call each of them `entry`.
    pub(super) fn list(&self, entry: &'static str, most: usize) -> Option<Vec<Node<'r>>> {
        let Expr::Seq(list) = self.expr else { return self.mismatch("a list") };
        if list.items.len() > most {
            let message = format!("`{}` has too many entries", self.what);
            let expected = format!("expected at most {most}, found {}", list.items.len());
            self.report(Problem::error(bytes(&list.open_bracket), message).expected(expected));
            return None;
        }
        Some(list.items.iter().map(|item| Node { expr: &item.expr, what: entry, ..*self }.inside()).collect())
    }

    /// The values of a tuple of `N`, shown as `pattern` if it is none.
    pub(super) fn tuple<const N: usize>(&self, pattern: &str) -> Option<[Node<'r>; N]> {
        let elements = match self.expr {
            Expr::Tuple(tuple) => &tuple.elements,
            _ => return self.mismatch(pattern),
        };
        let nodes: Vec<_> =
            elements.iter().map(|element| Node { expr: &element.expr, ..*self }.inside()).collect();
        nodes.try_into().ok().or_else(|| self.mismatch(pattern))
    }

    /// Two numbers within `range`: east and north.
    pub(super) fn pair(&self, range: RangeInclusive<f64>) -> Option<[f64; 2]> {
        let [east, north] =
            self.tuple(if self.what == "size" { "(width, depth)" } else { "(east, north)" })?;
        let (east, north) = (east.number(range.clone()), north.number(range));
        Some([east?.value, north?.value])
    }

    /// The named fields of a `Name(...)`, the name being optional.
    pub(super) fn fields(&self, name: &'static str) -> Option<Fields<'r>> {
        let (written, open, fields) = match self.expr {
            Expr::AnonStruct(node) => (None, bytes(&node.open_paren), node.fields.as_slice()),
            Expr::Unit(node) => (None, bytes(&node.span), [].as_slice()),
            Expr::Struct(node) => match &node.body {
                Some(StructBody::Fields(body)) => {
                    (Some(&node.name), bytes(&node.name.span), body.fields.as_slice())
                }
                Some(StructBody::Tuple(body)) if body.elements.is_empty() => {
                    (Some(&node.name), bytes(&node.name.span), [].as_slice())
                }
                _ => return self.mismatch(NAMED_FIELDS),
            },
            _ => return self.mismatch(NAMED_FIELDS),
        };
        if let Some(written) = written.filter(|written| written.name != name) {
            let message = format!("this is a {}, not a {name}", written.name);
            self.report(Problem::error(open, message).expected(format!("expected {name}(...)")));
            return None;
        }
        Some(Fields::new(*self, name, open, fields))
    }
}

/// What is expected where a `Name(field: value, ...)` should stand.
const NAMED_FIELDS: &str = "named fields in round brackets";

fn describe(expr: &Expr<'_>) -> String {
    match expr {
        Expr::Unit(_) => "empty brackets".into(),
        Expr::Bool(flag) => flag.value.to_string(),
        Expr::Number(_) => "a number".into(),
        Expr::String(_) => "text".into(),
        Expr::Char(_) | Expr::Byte(_) | Expr::Bytes(_) => "something else in quotes".into(),
        Expr::Option(_) => "None".into(),
        Expr::Seq(_) => "a list".into(),
        Expr::Map(_) => "curly brackets".into(),
        Expr::Tuple(tuple) if tuple.elements.len() == 1 => "one value in round brackets".into(),
        Expr::Tuple(tuple) => format!("{} values in round brackets", tuple.elements.len()),
        Expr::AnonStruct(_) => "fields in round brackets".into(),
        Expr::Struct(node) if node.body.is_none() => format!("the name {}", node.name.name),
        Expr::Struct(node) => format!("{}(...)", node.name.name),
        Expr::Error(_) => "an error".into(),
    }
}

/// How to turn what was written into what was expected, where that is plain.
fn remedy(found: &Expr<'_>, expected: &str) -> Option<String> {
    match found {
        Expr::String(text) if expected == "a number" && parse_number(&text.value).is_ok() => {
            Some(format!("numbers stand without quotes: {}", text.value))
        }
        Expr::String(text) if expected == "true or false" => truth(&text.value),
        Expr::Struct(node) if expected == "true or false" => truth(&node.name.name),
        Expr::Number(number) if expected == "true or false" => truth(&number.raw),
        Expr::String(text) if expected.contains(" or ") => {
            Some(format!("names stand without quotes: {}", text.value))
        }
        Expr::Struct(node) if expected == "text" && node.body.is_none() => {
            Some(format!("text stands in quotes: \"{}\"", node.name.name))
        }
        Expr::Number(number) if expected == "text" => {
            Some(format!("text stands in quotes: \"{}\"", number.raw))
        }
        Expr::AnonStruct(_) | Expr::Tuple(_) | Expr::Unit(_) if expected == "a list" => {
            Some("lists stand in square brackets: [ ... ]".into())
        }
        Expr::Seq(list) if expected.starts_with('(') && list.items.len() == 2 => {
            Some("places and sizes stand in round brackets: (2, 3)".into())
        }
        Expr::AnonStruct(_) if expected.starts_with('(') => Some("leave out the names: (2, 3)".into()),
        Expr::Number(number) if expected.starts_with('(') => {
            Some(format!("write both: ({0}, {0})", number.raw))
        }
        Expr::Tuple(_) if expected == NAMED_FIELDS => {
            Some("each value needs its name: (id: \"home\", at: (1, 2))".into())
        }
        _ => None,
    }
}

/// Which of the two a word for it means.
fn truth(word: &str) -> Option<String> {
    match word.to_lowercase().as_str() {
        "true" | "on" | "yes" | "1" => Some("write true".into()),
        "false" | "off" | "no" | "0" => Some("write false".into()),
        _ => None,
    }
}
