//! Values that keep the place where they are written, and values written as texts.

use std::fmt::Display;
use std::ops::Range;

use super::Codec;
use crate::format::describe::FieldType;
use crate::format::node::Node;
use crate::format::problem::Problem;
use crate::format::text::Text as RonText;

/// A value, and the bytes where it is written. The place does not count in comparisons.
#[derive(Clone, Debug, Default)]
pub(crate) struct Written<T> {
    pub(crate) value: T,
    /// Empty if it is not written.
    pub(crate) at: Range<usize>,
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
pub(crate) struct At<C>(pub(crate) C);

impl<T, C: Codec<T>> Codec<Written<T>> for At<C> {
    fn read(&self, node: Node<'_>, base: Option<&Written<T>>) -> Option<Written<T>> {
        let value = self.0.read(node, base.map(|base| &base.value))?;
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

/// A value read by a function.
pub(crate) struct By<T> {
    pub(crate) shape: fn() -> FieldType,
    pub(crate) read: fn(Node<'_>) -> Option<T>,
    pub(crate) write: fn(&T) -> RonText,
    /// Any value.
    pub(crate) stand_in: fn() -> T,
}

impl<T> Codec<T> for By<T> {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        (self.read)(node)
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
pub(crate) struct Spelled<T> {
    /// Description of the valid texts, for people.
    pub(crate) about: &'static str,
    pub(crate) parse: fn(&str) -> Option<T>,
    /// Makes the message from the field's name and its invalid text.
    pub(crate) wrong: fn(&str, &str) -> String,
    pub(crate) expected: &'static str,
    /// Makes the advice for an invalid text.
    pub(crate) help: fn(&str) -> Option<String>,
    /// Any value.
    pub(crate) stand_in: T,
}

/// Maximum length of a text that stands for a value, in characters.
const LONGEST: usize = 255;

impl<T: Clone + Display> Codec<T> for Spelled<T> {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        let text = node.text(LONGEST)?;
        let value = (self.parse)(text);
        if value.is_none() {
            let problem = Problem::error(node.span(), (self.wrong)(node.name, text));
            node.report(problem.expected(self.expected).help_if((self.help)(text)));
        }
        value
    }

    fn write(&self, value: &T) -> RonText {
        RonText::Plain(format!("{:?}", value.to_string()))
    }

    fn shape(&self) -> FieldType {
        FieldType::Text(self.about.to_owned())
    }

    fn stand_in(&self) -> T {
        self.stand_in.clone()
    }
}
