//! One value in the syntax tree, and typed reading of it.

use std::ops::{Range, RangeInclusive};

use ron2::ast::{Expr, StructBody};

use super::fields::Fields;
use super::number::{NotANumber, Number, parse_number, plain};
use super::problem::Problem;
use super::reader::{Reader, bytes};
use super::remedy::{NAMED_FIELDS, describe, remedy};
use super::suggest::{listed, nearest};
use super::words::unit;
use crate::label::{describe as describe_character, first_unfit};

/// Limits that another field sets for numbers of a record, beyond their own range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within {
    /// Minimum.
    pub low: f64,
    /// Maximum.
    pub high: f64,
    /// Name of the limits in messages.
    pub noun: &'static str,
    /// Advice on how to widen the limits, and the field that sets them.
    pub wider: &'static str,
}

impl Within {
    /// Whether `number` is within the limits; reports it if not.
    fn holds(&self, node: &Node<'_>, number: f64) -> bool {
        let holds = (self.low..=self.high).contains(&number);
        if !holds {
            let message = format!("`{}` is outside of {}", node.name, self.noun);
            let (low, high, unit) = (plain(self.low), plain(self.high), node.unit());
            let expected = format!("expected {low} to {high}{unit}, found {}{unit}", plain(number));
            let wider = (plain(self.low.min(number)), plain(self.high.max(number)));
            let help = format!("or {}: ({}, {})", self.wider, wider.0, wider.1);
            node.report(Problem::error(node.span(), message).expected(expected).help(help));
        }
        holds
    }
}

/// One value of the file, and its name in messages.
#[derive(Clone, Copy)]
pub struct Node<'r> {
    /// The reader of the file.
    pub reader: &'r Reader<'r>,
    /// The value as the parser gives it.
    pub expr: &'r Expr<'r>,
    /// The field that holds the value, or the name for entries of its list.
    pub name: &'static str,
    /// Limits of the numbers that are marked as bounded.
    pub within: Option<Within>,
    /// The unit of places and sizes in messages, with a space before it; may be empty.
    pub length_unit: &'static str,
}

impl<'r> Node<'r> {
    /// Returns its place in the text.
    pub fn span(&self) -> Range<usize> {
        bytes(self.expr.span())
    }

    /// Reports a problem.
    pub fn report(&self, problem: Problem) {
        self.reader.report(problem);
    }

    /// Whether the value is `None`.
    pub fn is_none(&self) -> bool {
        matches!(self.expr, Expr::Option(option) if option.value.is_none())
    }

    /// Returns the value inside any `Some(...)` around it.
    pub fn inside(mut self) -> Self {
        while let Expr::Option(option) = self.expr
            && let Some(some) = &option.value
        {
            self.expr = &some.expr;
        }
        self
    }

    /// Returns the value of the field `name` if this is a `Kind(...)` with that field; reports nothing.
    pub fn peek(&self, kind: &'static str, name: &'static str) -> Option<Node<'r>> {
        let fields = match self.expr {
            Expr::AnonStruct(node) => &node.fields,
            Expr::Struct(node) if node.name.name == kind => match &node.body {
                Some(StructBody::Fields(body)) => &body.fields,
                _ => return None,
            },
            _ => return None,
        };
        let field = fields.iter().find(|field| field.name.name == name)?;
        Some(Node { expr: &field.value, name, ..*self }.inside())
    }

    /// Whether the value is a `Name(...)` with this name, or the name alone.
    pub fn is_called(&self, name: &str) -> bool {
        matches!(self.expr, Expr::Struct(node) if node.name.name == name)
    }

    /// Returns the text if the value is one; reports nothing.
    pub fn peek_text(&self) -> Option<&'r str> {
        let Expr::String(text) = self.expr else { return None };
        Some(&text.value)
    }

    /// Returns the unit of the number, with a space before it; empty if it has none.
    fn unit(&self) -> &'static str {
        match self.name {
            "at" | "size" | "gap" => self.length_unit,
            name => unit(name),
        }
    }

    /// Returns the number if the value is one; reports nothing.
    pub fn peek_number(&self) -> Option<f64> {
        let Expr::Number(number) = self.expr else { return None };
        parse_number(&number.raw).ok().map(|number| number.value)
    }

    /// Reports that this is not the `expected` thing, and returns `None`.
    pub fn mismatch<T>(&self, expected: &str) -> Option<T> {
        // The parser has already reported the cause of an error node.
        if !matches!(self.expr, Expr::Error(_)) {
            let message = format!("`{}` must be {expected}", self.name);
            let found = format!("expected {expected}, found {}", describe(self.expr));
            self.report(
                Problem::error(self.span(), message).expected(found).help_if(remedy(self.expr, expected)),
            );
        }
        None
    }

    /// A finite number within `range`.
    pub fn number(&self, range: RangeInclusive<f64>) -> Option<Number> {
        let Expr::Number(number) = self.expr else { return self.mismatch("a number") };
        let (name, raw) = (self.name, &number.raw);
        let (message, found) = match parse_number(raw) {
            Ok(number) if range.contains(&number.value) => return Some(number),
            Ok(number) => {
                (format!("`{name}` is out of range"), format!("{}{}", plain(number.value), self.unit()))
            }
            Err(NotANumber::TooLarge) => (format!("`{name}` is out of range"), raw.to_string()),
            Err(NotANumber::NotFinite) => (format!("`{name}` must be an ordinary number"), raw.to_string()),
            Err(NotANumber::Malformed) => (format!("`{name}` must be a number"), raw.to_string()),
        };
        let (least, most) = (plain(*range.start()), plain(*range.end()));
        let bounds = if least == most { least } else { format!("{least} to {most}{}", self.unit()) };
        self.report(
            Problem::error(self.span(), message).expected(format!("expected {bounds}, found {found}")),
        );
        None
    }

    /// A whole number within `range`.
    pub fn whole(&self, range: RangeInclusive<u32>) -> Option<u32> {
        let number = self.number(f64::from(*range.start())..=f64::from(*range.end()))?;
        if !number.whole {
            self.report_fraction();
        }
        number.whole.then_some(number.value as u32)
    }

    /// Reports that this is not a whole number.
    pub fn report_fraction(&self) {
        let message = format!("`{}` must be a whole number", self.name);
        self.report(Problem::error(self.span(), message).expected("expected digits only"));
    }

    /// A finite number within `range` and within the limits of the surrounding record.
    pub fn bounded(&self, range: RangeInclusive<f64>) -> Option<Number> {
        let number = self.number(range)?;
        self.within.is_none_or(|within| within.holds(self, f64::from(number.single))).then_some(number)
    }

    /// `true` or `false`.
    pub fn flag(&self) -> Option<bool> {
        let Expr::Bool(flag) = self.expr else { return self.mismatch("true or false") };
        Some(flag.value)
    }

    /// Text of at most `longest` characters, all of them visible.
    pub fn text(&self, longest: usize) -> Option<&'r str> {
        let Expr::String(text) = self.expr else { return self.mismatch("text") };
        let length = text.value.chars().count();
        if length > longest {
            let message = format!("`{}` is too long", self.name);
            let expected = format!("expected at most {longest} characters, found {length}");
            self.report(Problem::error(self.span(), message).expected(expected));
            return None;
        }
        if let Some(unfit) = first_unfit(&text.value) {
            let message = format!("`{}` holds {}", self.name, describe_character(unfit.character));
            let problem = Problem::error(self.place_of(unfit.character), message);
            self.report(problem.expected("expected characters that can be seen"));
            return None;
        }
        Some(&text.value)
    }

    /// Returns the place of `character` in this text, or the whole text if the character is written as an escape.
    fn place_of(&self, character: char) -> Range<usize> {
        let span = self.span();
        let written = self.reader.text().get(span.clone()).unwrap_or_default();
        let at = written.find(character).map(|at| span.start + at);
        at.map_or(span, |at| at..at + character.len_utf8())
    }

    /// A name that can be part of an OSC address: `a` to `z`, `0` to `9` and `_`, at most 64 of them.
    pub fn id(&self) -> Option<&'r str> {
        let text = self.text(64)?;
        if is_id(text) {
            return Some(text);
        }
        let legal = in_id;
        let mended: String = text.to_lowercase().chars().map(|c| if legal(c) { c } else { '_' }).collect();
        let help = if text.contains('{') {
            Some("patterns such as {n} are for widgets with `repeat`".to_owned())
        } else {
            (mended.len() == text.len() && !mended.is_empty()).then(|| format!("write \"{mended}\""))
        };
        let message = format!("`{}` can't be part of an address", self.name);
        let expected = "expected 1 to 64 of the characters a-z, 0-9 and _";
        self.report(Problem::error(self.span(), message).expected(expected).help_if(help));
        None
    }

    /// Reads one of the names in `choices` and returns its value.
    pub fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let all = listed(&names, "or");
        // A list too long to stand beside the carets goes below them.
        let (expected, many) =
            if names.len() <= 8 { (all, None) } else { (format!("one of {} names", names.len()), Some(all)) };
        let Expr::Struct(variant) = self.expr else { return self.mismatch(&expected) };
        let written = &*variant.name.name;
        if let (Some((_, choice)), None) = (choices.iter().find(|(name, _)| *name == written), &variant.body)
        {
            return Some(*choice);
        }
        if names.contains(&written) {
            let problem = Problem::error(self.span(), format!("{written} stands alone"));
            let help = format!("its settings are fields beside `{}`", self.name);
            self.report(problem.expected(format!("expected {written} without brackets")).help(help));
            return None;
        }
        let problem = Problem::error(self.span(), format!("there is no `{}` called {written}", self.name));
        let help = nearest(written, names).map(|name| format!("did you mean {name}?"));
        let help = help.or_else(|| many.map(|all| format!("there is {}", all.replace(" or ", " and "))));
        self.report(problem.expected(format!("expected {expected}")).help_if(help));
        None
    }

    /// Returns the one of `names` that is written, and the fields in the brackets behind it, if any.
    pub fn variant(&self, names: &[&'static str]) -> Option<(&'static str, Fields<'r>)> {
        let expected = listed(names, "or");
        let Expr::Struct(variant) = self.expr else { return self.mismatch(&expected) };
        let written = &*variant.name.name;
        let Some(name) = names.iter().copied().find(|name| *name == written) else {
            let message = format!("there is no `{}` called {written}", self.name);
            let help = nearest(written, names.iter().copied()).map(|name| format!("did you mean {name}?"));
            let problem = Problem::error(self.span(), message).expected(format!("expected {expected}"));
            self.report(problem.help_if(help));
            return None;
        };
        let fields = match &variant.body {
            None => Fields::bare(*self, name),
            Some(_) => self.fields(name)?,
        };
        Some((name, fields))
    }

    /// Returns the entries of a list of at most `most`; messages call each of them `entry`.
    pub fn list(&self, entry: &'static str, most: usize) -> Option<Vec<Node<'r>>> {
        let Expr::Seq(list) = self.expr else { return self.mismatch("a list") };
        if list.items.len() > most {
            let message = format!("`{}` has too many entries", self.name);
            let expected = format!("expected at most {most}, found {}", list.items.len());
            self.report(Problem::error(bytes(&list.open_bracket), message).expected(expected));
            return None;
        }
        Some(list.items.iter().map(|item| Node { expr: &item.expr, name: entry, ..*self }.inside()).collect())
    }

    /// Whether it is a tuple.
    #[must_use]
    pub const fn is_tuple(&self) -> bool {
        matches!(self.expr, Expr::Tuple(_))
    }

    /// Returns the `N` values of a tuple; the error message shows `pattern`.
    pub fn tuple<const N: usize>(&self, pattern: &str) -> Option<[Node<'r>; N]> {
        let elements = match self.expr {
            Expr::Tuple(tuple) => &tuple.elements,
            _ => return self.mismatch(pattern),
        };
        let nodes: Vec<_> =
            elements.iter().map(|element| Node { expr: &element.expr, ..*self }.inside()).collect();
        nodes.try_into().ok().or_else(|| self.mismatch(pattern))
    }

    /// Two numbers within `range`: east and north.
    pub fn pair(&self, range: RangeInclusive<f64>) -> Option<[f64; 2]> {
        let [east, north] =
            self.tuple(if self.name == "size" { "(width, depth)" } else { "(east, north)" })?;
        let (east, north) = (east.number(range.clone()), north.number(range));
        Some([east?.value, north?.value])
    }

    /// One number within `range` for both directions, or one number for each.
    pub fn one_or_two(&self, range: RangeInclusive<f64>) -> Option<[f64; 2]> {
        match self.expr {
            Expr::Tuple(_) => self.pair(range),
            _ => self.number(range).map(|number| [number.value; 2]),
        }
    }

    /// Returns the named fields of a `Name(...)`; the name is optional.
    pub fn fields(&self, name: &'static str) -> Option<Fields<'r>> {
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
            let a = |name: &str| if name.starts_with(['A', 'E', 'I', 'O']) { "an" } else { "a" };
            let (found, wanted) = (&*written.name, name);
            let message = format!("this is {} {found}, not {} {wanted}", a(found), a(wanted));
            self.report(Problem::error(open, message).expected(format!("expected {name}(...)")));
            return None;
        }
        Some(Fields::new(*self, name, open, fields))
    }
}

/// Whether `text` can be part of an OSC address.
pub fn is_id(text: &str) -> bool {
    (1..=64).contains(&text.len()) && text.chars().all(in_id)
}

fn in_id(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'
}
