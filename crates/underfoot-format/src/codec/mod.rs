//! Codecs: each reads and writes the value of one field.

mod distinct;
mod list;
mod nested;
mod num;
mod unwritten;
mod written;

pub use self::distinct::{Distinct, Seen};
pub use self::list::{List, list};
pub use self::nested::{Beside, Flat, OneOf, Rec};
pub use self::num::{Num, Scalar, num};
pub use self::unwritten::{Follow, Own};
pub use self::written::{At, By, Spelled, Written};
use super::describe::{FieldDescription, FieldType, first_paragraph};
use super::fields::Fields;
use super::hand::Hand;
use super::node::Node;
use super::text::{Entry, RonText};

/// Reads and writes a `T`.
pub trait Codec<T> {
    /// The values that a reading refers to; `()` if it needs none.
    type Context;

    /// Reads `node` over `base`; `None` after it has reported why the value cannot be used.
    fn read(&self, node: Node<'_>, base: Option<&T>, context: &Self::Context) -> Option<T>;

    /// Returns the text that files hold for `value`.
    fn write(&self, value: &T) -> RonText;

    /// Describes the written form for people.
    fn shape(&self) -> FieldType;

    /// Any value of its type.
    fn stand_in(&self) -> T;

    /// Passes its numbers to a tuner.
    fn turn(&self, _value: &mut T, _name: &'static str, _hand: &mut Hand<'_>) {}

    /// Reads the field `name`; without it, returns `base` or else `default`.
    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        base: Option<&T>,
        default: Option<T>,
        context: &Self::Context,
    ) -> T
    where
        T: Clone,
    {
        let base = base.or(default.as_ref());
        let read = match fields.take(name) {
            Some(node) => self.read(node, base, context),
            None => {
                if base.is_none() {
                    fields.lack(name);
                }
                base.cloned()
            }
        };
        read.unwrap_or_else(|| {
            fields.fail(name);
            base.cloned().unwrap_or_else(|| self.stand_in())
        })
    }

    /// Appends the field `name`, unless it equals its `default`.
    fn write_field(&self, value: &T, name: &'static str, default: Option<T>, entries: &mut Vec<Entry>)
    where
        T: PartialEq,
    {
        if default.as_ref() != Some(value) {
            entries.push((name, self.write(value)));
        }
    }

    /// Appends the description of the field `name`.
    fn describe_field(
        &self,
        name: &'static str,
        about: &[&str],
        default: Option<T>,
        fields: &mut Vec<FieldDescription>,
    ) {
        let default = default.map(|default| self.write(&default).inline());
        fields.push(FieldDescription { name, about: first_paragraph(about), shape: self.shape(), default });
    }
}

/// `true` or `false`.
pub struct Flag;

impl Codec<bool> for Flag {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&bool>, (): &()) -> Option<bool> {
        node.flag()
    }

    fn write(&self, value: &bool) -> RonText {
        RonText::Flag(*value)
    }

    fn shape(&self) -> FieldType {
        FieldType::Flag
    }

    fn stand_in(&self) -> bool {
        false
    }
}

/// Text of at most so many characters.
pub struct Text(pub usize);

impl<T: for<'a> From<&'a str> + AsRef<str>> Codec<T> for Text {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&T>, (): &()) -> Option<T> {
        node.text(self.0).map(T::from)
    }

    fn write(&self, value: &T) -> RonText {
        RonText::quoted(value.as_ref())
    }

    fn shape(&self) -> FieldType {
        FieldType::Text(format!("text of at most {} characters", self.0))
    }

    fn stand_in(&self) -> T {
        T::from("")
    }
}

/// A name that can be part of an OSC address.
pub struct Id;

impl<T: for<'a> From<&'a str> + AsRef<str>> Codec<T> for Id {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&T>, (): &()) -> Option<T> {
        node.id().map(T::from)
    }

    fn write(&self, value: &T) -> RonText {
        Text(64).write(value)
    }

    fn shape(&self) -> FieldType {
        FieldType::Text("1 to 64 of the characters a-z, 0-9 and _, in quotes".to_owned())
    }

    fn stand_in(&self) -> T {
        T::from("")
    }
}

/// Something that files write as one of a few names.
pub trait Named: Copy + PartialEq + 'static {
    /// Each with its name.
    const ALL: &'static [(&'static str, Self)];
}

/// One of a few names.
pub struct Name;

impl<T: Named> Codec<T> for Name {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&T>, (): &()) -> Option<T> {
        node.choice(T::ALL)
    }

    fn write(&self, value: &T) -> RonText {
        // `ALL` holds every value.
        T::ALL.iter().find(|(_, one)| one == value).map_or(RonText::Nothing, |&(name, _)| RonText::Name(name))
    }

    fn shape(&self) -> FieldType {
        FieldType::Names(T::ALL.iter().map(|(name, _)| *name).collect())
    }

    fn stand_in(&self) -> T {
        T::ALL[0].1
    }
}

/// An optional value: `None`, or the value itself.
pub struct Opt<C>(pub C);

impl<T, C: Codec<T>> Codec<Option<T>> for Opt<C> {
    type Context = C::Context;

    fn read(&self, node: Node<'_>, base: Option<&Option<T>>, context: &C::Context) -> Option<Option<T>> {
        if node.is_none() {
            return Some(None);
        }
        self.0.read(node, base.and_then(Option::as_ref), context).map(Some)
    }

    fn write(&self, value: &Option<T>) -> RonText {
        value.as_ref().map_or(RonText::Nothing, |value| self.0.write(value))
    }

    fn shape(&self) -> FieldType {
        FieldType::Optional(Box::new(self.0.shape()))
    }

    fn stand_in(&self) -> Option<T> {
        None
    }

    fn turn(&self, value: &mut Option<T>, name: &'static str, hand: &mut Hand<'_>) {
        if let Some(value) = value {
            self.0.turn(value, name, hand);
        }
    }
}

/// Two numbers in round brackets; messages show `pattern`.
pub struct Pair {
    /// Range and unit of both numbers.
    pub each: Num,
    /// The expected form, such as `(low end, high end)`.
    pub pattern: &'static str,
    /// Names of the two numbers in a tuner.
    pub parts: [&'static str; 2],
}

impl<T: Copy + From<[f32; 2]> + Into<[f32; 2]>> Codec<T> for Pair {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&T>, context: &()) -> Option<T> {
        let nodes: [Node<'_>; 2] = node.tuple(self.pattern)?;
        let [first, second] = nodes.map(|node| Codec::<f32>::read(&self.each, node, None, context));
        Some([first?, second?].into())
    }

    fn write(&self, value: &T) -> RonText {
        RonText::Tuple((*value).into().map(|value| value.to_ron(self.each.scale)).into())
    }

    fn shape(&self) -> FieldType {
        FieldType::Pair(self.pattern, Box::new(Codec::<f32>::shape(&self.each)))
    }

    fn stand_in(&self) -> T {
        [Codec::<f32>::stand_in(&self.each); 2].into()
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        let mut values: [f32; 2] = (*value).into();
        for (part, value) in self.parts.into_iter().zip(&mut values) {
            hand.part(part, |hand| self.each.turn(value, name, hand));
        }
        *value = values.into();
    }
}
