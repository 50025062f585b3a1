//! Records and their descriptions.

use super::describe::Description;
use super::fault::Faults;
use super::fields::Fields;
use super::hand::Hand;
use super::node::Node;
use super::text::Entry;

/// A type that files write as named fields in round brackets. [`record!`](crate::record!) implements it.
pub trait Record: Clone + PartialEq + 'static {
    /// Its name in files.
    const NAME: &'static str;

    /// The values that a reading refers to; `()` if it needs none.
    type Context;

    /// Reads the record from `fields`; fields that are not written come from `base`.
    ///
    /// An unreadable field is noted in `fields` ([`Fields::are_read`]) and replaced by a stand-in, so that conflicts
    /// between the other fields are found too.
    fn read_fields(fields: &mut Fields<'_>, base: Option<&Self>, context: &Self::Context) -> Self;

    /// Appends the fields that differ from their defaults.
    fn write_fields(&self, entries: &mut Vec<Entry>);

    /// Passes each of its numbers to a tuner, which may change it.
    fn turn_fields(&mut self, hand: &mut Hand<'_>);

    /// Describes the record and its fields.
    fn describe() -> Description;

    /// Returns any value of the type, as a stand-in for one that cannot be read.
    fn stand_in() -> Self;
}

/// One of several records, distinguished by name. [`choices!`](crate::choices!) implements it.
pub trait Variants: Clone + PartialEq + 'static {
    /// The names of all variants.
    const NAMES: &'static [&'static str];

    /// As [`Record::Context`].
    type Context;

    /// The name of this variant.
    fn variant(&self) -> &'static str;

    /// Reads the variant called `name` from `fields`; fields that are not written come from `base` if it has the same
    /// name.
    ///
    /// `None` if there is no variant of this name.
    fn read_fields(
        name: &str,
        fields: &mut Fields<'_>,
        base: Option<&Self>,
        context: &Self::Context,
    ) -> Option<Self>;

    /// As [`Record::write_fields`].
    fn write_fields(&self, entries: &mut Vec<Entry>);

    /// As [`Record::turn_fields`].
    fn turn_fields(&mut self, hand: &mut Hand<'_>);

    /// Describes all variants, in the order of [`Variants::NAMES`].
    fn describe() -> Vec<Description>;

    /// Returns any value of the type, as a stand-in for one that cannot be read.
    fn stand_in() -> Self;
}

impl Node<'_> {
    /// Reads the record at this node over `base`.
    pub fn record<T: Record>(self, base: Option<&T>, context: &T::Context) -> Option<T> {
        let mut fields = self.fields(T::NAME)?;
        let read = T::read_fields(&mut fields, base, context);
        let all = fields.are_read();
        fields.finish();
        all.then_some(read)
    }
}

/// A rule of a record: finds conflicts between its fields and computes derived ones.
pub type Rules<T> = fn(&mut T, &mut Faults);

/// Defines a struct and describes it as a record of files.
///
/// Each field is one entry `field: Type = "name in files", codec => default;` below its documentation. The codec
/// defines the written form (see [`codec`](crate::codec)); the codec and the end of the name give the range and unit of a
/// number. A field without a default must be written, unless there is a base. `with Context` names the type of
/// [`Record::Context`], which includes the contexts of all codecs.
#[macro_export]
macro_rules! record {
    (
        $(#[doc = $doc:expr])*
        $vis:vis struct $Type:ident = $ron:literal $(, $derive:ident)* $(with $Context:ty)? $(=> $rules:expr)? ;
        $(
            $(#[doc = $about:expr])*
            $fvis:vis $field:ident: $ty:ty = $name:literal, $codec:expr $(=> $default:expr)?;
        )*
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, PartialEq, $($derive),*)]
        $vis struct $Type {
            $($(#[doc = $about])* $fvis $field: $ty,)*
        }

        impl $crate::Record for $Type {
            const NAME: &'static str = $ron;

            type Context = $crate::__context!($($Context)?);

            #[allow(unused_mut)]
            fn read_fields(
                fields: &mut $crate::fields::Fields<'_>,
                base: Option<&Self>,
                context: &Self::Context,
            ) -> Self {
                let mut it = Self {
                    $($field: $crate::Codec::<$ty>::read_field(
                        &$codec,
                        fields,
                        $name,
                        base.map(|base| &base.$field),
                        $crate::__default!($($default)?),
                        $crate::Includes::included(context),
                    ),)*
                };
                $(
                    let mut faults = $crate::Faults::default();
                    let rules: $crate::record::Rules<Self> = $rules;
                    rules(&mut it, &mut faults);
                    fields.judge(faults, base.is_some());
                )?
                it
            }

            fn write_fields(&self, entries: &mut Vec<$crate::text::Entry>) {
                $($crate::Codec::<$ty>::write_field(
                    &$codec,
                    &self.$field,
                    $name,
                    $crate::__default!($($default)?),
                    entries,
                );)*
            }

            fn turn_fields(&mut self, hand: &mut $crate::hand::Hand<'_>) {
                $($crate::Codec::<$ty>::turn(&$codec, &mut self.$field, $name, hand);)*
            }

            fn describe() -> $crate::describe::Description {
                let mut fields = Vec::new();
                $($crate::Codec::<$ty>::describe_field(
                    &$codec,
                    $name,
                    &[$($about),*],
                    $crate::__default!($($default)?),
                    &mut fields,
                );)*
                $crate::describe::Description::new($ron, &[$($doc),*], fields)
            }

            fn stand_in() -> Self {
                Self { $($field: $crate::Codec::<$ty>::stand_in(&$codec),)* }
            }
        }
    };
}

/// Defines an enum. Each variant holds the record that is written under its name, or nothing.
///
/// `with` names a context as in [`record!`](crate::record!); `=` gives the default variant, if there is one.
#[macro_export]
macro_rules! choices {
    (
        $(#[doc = $doc:expr])*
        $vis:vis enum $Type:ident $(: $($derive:ident),*)? $(with $Context:ty)? $(= $default:ident)? ;
        $(
            $(#[doc = $about:expr])*
            $variant:ident $(($record:ident))?,
        )*
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, PartialEq, $($($derive),*)?)]
        $vis enum $Type {
            $($(#[doc = $about])* $variant $(($record))?,)*
        }

        $(impl Default for $Type {
            fn default() -> Self {
                Self::$default
            }
        })?

        impl $crate::Variants for $Type {
            const NAMES: &'static [&'static str] = &[$(stringify!($variant)),*];

            type Context = $crate::__context!($($Context)?);

            fn variant(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => stringify!($variant),)*
                }
            }

            #[allow(unused_variables)]
            fn read_fields(
                name: &str,
                fields: &mut $crate::fields::Fields<'_>,
                base: Option<&Self>,
                context: &Self::Context,
            ) -> Option<Self> {
                match name {
                    $(stringify!($variant) => Some(Self::$variant $(({
                        let base = match base {
                            Some(Self::$variant(base)) => Some(base),
                            _ => None,
                        };
                        let context = $crate::Includes::included(context);
                        <$record as $crate::Record>::read_fields(fields, base, context)
                    }))?),)*
                    _ => None,
                }
            }

            fn write_fields(&self, entries: &mut Vec<$crate::text::Entry>) {
                $($(if let Self::$variant(record) = self {
                    <$record as $crate::Record>::write_fields(record, entries);
                })?)*
            }

            fn turn_fields(&mut self, hand: &mut $crate::hand::Hand<'_>) {
                $($(if let Self::$variant(record) = self {
                    <$record as $crate::Record>::turn_fields(record, hand);
                })?)*
            }

            fn describe() -> Vec<$crate::describe::Description> {
                vec![$($crate::describe::Description::new(
                    stringify!($variant),
                    &[$($about),*],
                    $crate::__fields_of!($($record)?),
                )),*]
            }

            fn stand_in() -> Self {
                let all: &[fn() -> Self] = &[$(|| Self::$variant $((
                    <$record as $crate::Record>::stand_in()
                ))?),*];
                all[0]()
            }
        }
    };
}

/// The descriptions of a record's fields; empty without a record.
#[doc(hidden)]
#[macro_export]
macro_rules! __fields_of {
    () => {
        Vec::new()
    };
    ($record:ident) => {
        <$record as $crate::Record>::describe().fields
    };
}

/// The context of a record; the empty one if it names none.
#[doc(hidden)]
#[macro_export]
macro_rules! __context {
    () => {
        ()
    };
    ($Context:ty) => {
        $Context
    };
}

/// The default of a field, if it has one.
#[doc(hidden)]
#[macro_export]
macro_rules! __default {
    () => {
        None
    };
    ($default:expr) => {
        Some($default)
    };
}
