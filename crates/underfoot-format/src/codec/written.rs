//! Values that keep the place where they are written, and values written as texts.

use std::fmt::Display;
use std::ops::Range;

use super::Codec;
use crate::describe::FieldType;
use crate::node::Node;
use crate::problem::Problem;
use crate::text::RonText;

/// A value, and the bytes where it is written. The place does not count in comparisons.
#[derive(Clone, Debug, Default)]
pub struct Written<T> {
    /// The value.
    pub value: T,
    /// Empty if it is not written.
    pub at: Range<usize>,
}

impl<T: PartialEq> PartialEq for Written<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T> From<T> for Written<T> {
    fn from(value: T) -> Self {
        Self { value, at: 0..0 }
    }
}

/// Reads a value together with its place.
pub struct At<C>(pub C);

impl<T, C: Codec<T>> Codec<Written<T>> for At<C> {
    type Context = C::Context;

    fn read(&self, node: Node<'_>, base: Option<&Written<T>>, context: &C::Context) -> Option<Written<T>> {
        let value = self.0.read(node, base.map(|base| &base.value), context)?;
        Some(Written { value, at: node.span() })
    }

    fn write(&self, written: &Written<T>) -> RonText {
        self.0.write(&written.value)
    }

    fn shape(&self) -> FieldType {
        self.0.shape()
    }

    fn stand_in(&self) -> Written<T> {
        self.0.stand_in().into()
    }
}

/// A value read by a function in a context.
pub struct By<T, C = ()> {
    /// Describes the written form.
    pub shape: fn() -> FieldType,
    /// Reads the value; reports why it cannot be used.
    pub read: fn(Node<'_>, &C) -> Option<T>,
    /// Returns the text that files hold.
    pub write: fn(&T) -> RonText,
    /// Any value.
    pub stand_in: fn() -> T,
}

impl<T, C> Codec<T> for By<T, C> {
    type Context = C;

    fn read(&self, node: Node<'_>, _: Option<&T>, context: &C) -> Option<T> {
        (self.read)(node, context)
    }

    fn write(&self, value: &T) -> RonText {
        (self.write)(value)
    }

    fn shape(&self) -> FieldType {
        (self.shape)()
    }

    fn stand_in(&self) -> T {
        (self.stand_in)()
    }
}

/// A value written as a text in quotes.
pub struct Spelled<T> {
    /// Description of the valid texts, for people.
    pub about: &'static str,
    /// Reads the text; `None` if it is invalid.
    pub parse: fn(&str) -> Option<T>,
    /// Makes the message from the field's name and its invalid text.
    pub wrong: fn(&str, &str) -> String,
    /// The expected form, shown beside the carets.
    pub expected: &'static str,
    /// Makes the advice for an invalid text.
    pub help: fn(&str) -> Option<String>,
    /// Any value.
    pub stand_in: T,
}

/// Maximum length of a text that stands for a value, in characters.
const LONGEST: usize = 255;

impl<T: Clone + Display> Codec<T> for Spelled<T> {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&T>, (): &()) -> Option<T> {
        let text = node.text(LONGEST)?;
        let value = (self.parse)(text);
        if value.is_none() {
            let problem = Problem::error(node.span(), (self.wrong)(node.name, text));
            node.report(problem.expected(self.expected).help_if((self.help)(text)));
        }
        value
    }

    fn write(&self, value: &T) -> RonText {
        RonText::quoted(value.to_string())
    }

    fn shape(&self) -> FieldType {
        FieldType::Text(self.about.to_owned())
    }

    fn stand_in(&self) -> T {
        self.stand_in.clone()
    }
}
