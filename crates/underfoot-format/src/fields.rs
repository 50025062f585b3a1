//! The fields of one record, each read once.

use std::ops::Range;

use ron2::ast::StructField;

use super::fault::{Fault, Faults};
use super::node::{Node, Within};
use super::problem::Problem;
use super::reader::{Reader, bytes};
use super::suggest::{did_you_mean, listed, nearest};
use super::words::example;

/// The named fields of one `Name(...)`, each to be read once.
///
/// Each field that the reader asks for is valid; [`Fields::finish`] then reports the others.
#[must_use = "unknown and missing fields are only reported by finish()"]
pub struct Fields<'r> {
    /// The whole record.
    record: Node<'r>,
    /// Name of the record in messages.
    noun: String,
    /// Place that messages about missing fields point at.
    open: Range<usize>,
    /// The name, if nothing else is written.
    bare: Option<&'static str>,
    written: Vec<FieldUse<'r>>,
    known: Vec<&'static str>,
    missing: Vec<&'static str>,
    /// Fields that are missing or cannot be read.
    failed: Vec<&'static str>,
    /// Fields that follow from others.
    follow: Vec<&'static str>,
    /// Whether the set of valid fields is unknown.
    allows_unknown: bool,
}

struct FieldUse<'r> {
    field: &'r StructField<'r>,
    taken: bool,
}

impl<'r> Fields<'r> {
    /// Reads the `fields` of `node`, a `Name(...)` that begins at `open`.
    pub fn new(node: Node<'r>, name: &str, open: Range<usize>, fields: &'r [StructField<'r>]) -> Self {
        let written = fields.iter().map(|field| FieldUse { field, taken: false }).collect();
        Self {
            record: node,
            noun: name.to_lowercase(),
            open,
            bare: None,
            written,
            known: Vec::new(),
            missing: Vec::new(),
            failed: Vec::new(),
            follow: Vec::new(),
            allows_unknown: false,
        }
    }

    /// A `name` that stands alone, without fields.
    pub fn bare(node: Node<'r>, name: &'static str) -> Self {
        Self { bare: Some(name), ..Self::new(node, name, node.span(), &[]) }
    }

    /// Sets the name of the record in messages.
    pub fn set_noun(&mut self, noun: String) {
        self.noun = noun;
    }

    /// Limits the bounded numbers of the fields that are read from now on.
    pub fn keep_within(&mut self, within: Within) {
        self.record.within = Some(within);
    }

    /// Sets the unit in which messages show places and sizes of the fields that are read from now on.
    pub fn show_lengths_in(&mut self, unit: &'static str) {
        self.record.length_unit = unit;
    }

    /// Reads the field `name` with `read`; returns `otherwise` if it is not written.
    ///
    /// Without an `otherwise`, the field is reported as missing.
    pub fn read<T>(
        &mut self,
        name: &'static str,
        otherwise: Option<T>,
        read: impl FnOnce(Node<'r>) -> Option<T>,
    ) -> Option<T> {
        match self.take(name) {
            Some(node) => read(node),
            None => {
                if otherwise.is_none() {
                    self.lack(name);
                }
                otherwise
            }
        }
    }

    /// Returns the value of the field `name` if it is written.
    pub fn take(&mut self, name: &'static str) -> Option<Node<'r>> {
        self.known.push(name);
        let mut found: Option<&'r StructField<'r>> = None;
        for written in self.written.iter_mut().filter(|written| written.field.name.name == name) {
            written.taken = true;
            match found {
                None => found = Some(written.field),
                Some(first) => {
                    let line = self.record.reader.line(&bytes(&first.name.span));
                    let message = format!("`{name}` is given twice");
                    let problem = Problem::error(bytes(&written.field.name.span), message);
                    self.record.report(problem.expected(format!("the first is on line {line}")));
                }
            }
        }
        found.map(|field| Node { expr: &field.value, name, ..self.record }.inside())
    }

    /// Treats the field `name` as not written, after its problem has been reported.
    pub fn refuse(&mut self, name: &str) {
        self.written.retain(|written| written.field.name.name != name);
    }

    /// Marks the field `name` as missing.
    pub fn lack(&mut self, name: &'static str) {
        self.missing.push(name);
    }

    /// Marks the field `name` as unreadable.
    pub fn fail(&mut self, name: &'static str) {
        self.failed.push(name);
    }

    /// Marks the field `name` as unwritten and derived from other fields; rules ignore it.
    pub fn follow(&mut self, name: &'static str) {
        self.follow.push(name);
    }

    /// Whether one of these fields cannot be read.
    pub fn have_failed(&self, names: &[&str]) -> bool {
        self.failed.iter().any(|failed| names.contains(failed))
    }

    /// Marks the set of valid fields as unknown.
    pub fn allow_unknown(&mut self) {
        self.allows_unknown = true;
    }

    /// Whether all fields could be read.
    pub fn are_read(&self) -> bool {
        self.failed.is_empty()
    }

    /// Reports conflicts between fields if all fields concerned could be read.
    ///
    /// With `is_based`, it ignores conflicts between unwritten fields: the reading of the base has reported them.
    pub fn judge(&mut self, faults: Faults, is_based: bool) {
        for Fault { severity, fields, message, expected, help } in faults.0 {
            if fields.iter().any(|field| self.failed.contains(field) || self.follow.contains(field)) {
                continue;
            }
            let written = fields.iter().find_map(|field| self.value_span(field));
            if written.is_none() && is_based {
                continue;
            }
            let problem = Problem::error(written.unwrap_or_else(|| self.start()), message);
            self.report(Problem { severity, ..problem.expected(expected).help_if(help) });
        }
    }

    /// Returns the reader of the file.
    pub fn reader(&self) -> &'r Reader<'r> {
        self.record.reader
    }

    /// Returns the place where the fields begin.
    pub fn start(&self) -> Range<usize> {
        self.open.clone()
    }

    /// Returns the place of the value of `name`, or the start of the fields if it is not written.
    pub fn span(&self, name: &str) -> Range<usize> {
        self.value_span(name).unwrap_or_else(|| self.start())
    }

    /// Returns the place of the value of `name`, if it is written.
    pub fn value_span(&self, name: &str) -> Option<Range<usize>> {
        let written = self.written.iter().find(|written| written.field.name.name == name)?;
        Some(bytes(written.field.value.span()))
    }

    /// Whether the text has a syntax error among the fields.
    pub fn are_broken(&self) -> bool {
        self.record.reader.is_broken(&self.record.span())
    }

    /// Reports a problem.
    pub fn report(&self, problem: Problem) {
        self.record.report(problem);
    }

    /// Reports unknown fields, and requested fields that are missing.
    ///
    /// If the set of valid fields is unknown, it reports only unknown fields whose name resembles a missing one.
    pub fn finish(mut self) {
        let unknown: Vec<&FieldUse<'r>> = self.written.iter().filter(|written| !written.taken).collect();
        for written in unknown {
            let name = &*written.field.name.name;
            let known = if self.allows_unknown { &self.missing } else { &self.known };
            let meant = nearest(name, known.iter().copied());
            // A misspelt field does not also count as missing.
            self.missing.retain(|missing| Some(*missing) != meant);
            if !self.allows_unknown {
                self.report_unknown(written, did_you_mean(name, &self.known, '`'));
            } else if let Some(meant) = meant {
                self.report_unknown(written, Some(format!("did you mean `{meant}`?")));
            }
        }
        self.report_missing();
    }

    fn report_unknown(&self, written: &FieldUse<'_>, help: Option<String>) {
        let name = &written.field.name;
        let problem = Problem::error(bytes(&name.span), format!("unknown field `{}`", name.name));
        let article = if self.noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        self.record
            .report(problem.expected(format!("{article} {} has no such field", self.noun)).help_if(help));
    }

    fn report_missing(&mut self) {
        let Some(&first) = self.missing.first() else { return };
        // In a broken text the missing field itself may be the syntax error.
        if self.are_broken() {
            return;
        }
        let names: Vec<String> = self.missing.iter().map(|name| format!("`{name}`")).collect();
        let all = listed(&names, "and");
        let (message, expected) = match (self.bare, names.len()) {
            (Some(name), 1) => (format!("{name} needs {all}"), format!("{all} is missing")),
            (Some(name), _) => (format!("{name} needs {all}"), format!("{all} are missing")),
            (None, 1) => (format!("this {} lacks {all}", self.noun), "a field is missing".to_owned()),
            (None, _) => (format!("this {} lacks {all}", self.noun), "some fields are missing".to_owned()),
        };
        let help = match (self.missing.as_slice(), self.bare) {
            ([only], None) => example(only).map(|example| format!("add {example}")),
            // The meaning of the field follows the brackets.
            ([only], Some(name)) => example(only).map(|example| match example.split_once(", the ") {
                Some((example, about)) => format!("write {name}({example}), the {about}"),
                None => format!("write {name}({example})"),
            }),
            _ => None,
        };
        let problem = Problem::error(self.open.clone(), message).expected(expected).help_if(help);
        self.record.report(Problem { missing: Some(first), ..problem });
    }
}
