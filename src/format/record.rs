//! Records and what is described of them.

use super::describe::Description;
use super::fault::Faults;
use super::fields::Fields;
use super::hand::Hand;
use super::node::Node;
use super::text::Entry;

/// Something that files write as named fields in round brackets. [`record!`] makes one.
pub(crate) trait Record: Clone + PartialEq + 'static {
    /// What files call it.
    const NAME: &'static str;

    /// What `fields` say of it; where they say nothing, it is as in `base`.
    ///
    /// What could not be read is noted in `fields` ([`Fields::are_read`]), and something fills its place, so that
    /// what is wrong between fields is found too.
    fn read_fields(fields: &mut Fields<'_>, base: Option<&Self>) -> Self;

    /// Appends the fields that are not as they would be if nothing were said of them.
    fn write_fields(&self, entries: &mut Vec<Entry>);

    /// Shows each of its numbers to a hand that may turn it.
    fn turn_fields(&mut self, hand: &mut Hand<'_>);

    /// What is known of it and its fields.
    fn describe() -> Description;

    /// Any value of its type, for the place of one that could not be read.
    fn stand_in() -> Self;
}

/// One of several records, told apart by their names. [`choices!`] makes one.
pub(crate) trait Variants: Clone + PartialEq + 'static {
    /// The names of all.
    const NAMES: &'static [&'static str];

    /// The name of this one.
    fn variant(&self) -> &'static str;

    /// What `fields` say of the one called `name`; where they say nothing, it is as in `base`, if that has this name.
    ///
    /// `None` if none has this name.
    fn read_fields(name: &str, fields: &mut Fields<'_>, base: Option<&Self>) -> Option<Self>;

    /// As [`Record::write_fields`].
    fn write_fields(&self, entries: &mut Vec<Entry>);

    /// As [`Record::turn_fields`].
    fn turn_fields(&mut self, hand: &mut Hand<'_>);

    /// All of them, in the order of [`Variants::NAMES`].
    fn describe() -> Vec<Description>;

    /// Any value of its type, for the place of one that could not be read.
    fn stand_in() -> Self;
}

impl Node<'_> {
    /// The record written here, over `base`.
    pub(crate) fn record<T: Record>(self, base: Option<&T>) -> Option<T> {
        let mut fields = self.fields(T::NAME)?;
        let read = T::read_fields(&mut fields, base);
        let all = fields.are_read();
        fields.finish();
        all.then_some(read)
    }
}

/// A rule of a record: what is wrong between its fields, and what follows from them.
pub(crate) type Rules<T> = fn(&mut T, &mut Faults);

/// Defines a struct and describes it as a record of files.
///
/// Each field stands once, as `field: Type = "name in files", codec => default;` behind its documentation. The codec
/// says what is written (see [`super::codec`]); unit and range of a number are in it and in the end of the name.
/// A field without a default must be written, unless there is a base.
macro_rules! record {
    (
        $(#[doc = $doc:expr])*
        $vis:vis struct $Type:ident = $ron:literal $(, $derive:ident)* $(=> $rules:expr)? ;
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

        impl $crate::format::Record for $Type {
            const NAME: &'static str = $ron;

            #[allow(unused_mut)]
            fn read_fields(
                fields: &mut $crate::format::fields::Fields<'_>,
                base: Option<&Self>,
            ) -> Self {
                let mut it = Self {
                    $($field: $crate::format::Codec::<$ty>::read_field(
                        &$codec,
                        fields,
                        $name,
                        base.map(|base| &base.$field),
                        $crate::format::record::default!($($default)?),
                    ),)*
                };
                $(
                    let mut faults = $crate::format::Faults::default();
                    let rules: $crate::format::record::Rules<Self> = $rules;
                    rules(&mut it, &mut faults);
                    fields.judge(faults, base.is_some());
                )?
                it
            }

            fn write_fields(&self, entries: &mut Vec<$crate::format::text::Entry>) {
                $($crate::format::Codec::<$ty>::write_field(
                    &$codec,
                    &self.$field,
                    $name,
                    $crate::format::record::default!($($default)?),
                    entries,
                );)*
            }

            fn turn_fields(&mut self, hand: &mut $crate::format::hand::Hand<'_>) {
                $($crate::format::Codec::<$ty>::turn(&$codec, &mut self.$field, $name, hand);)*
            }

            fn describe() -> $crate::format::describe::Description {
                let mut fields = Vec::new();
                $($crate::format::Codec::<$ty>::describe_field(
                    &$codec,
                    $name,
                    &[$($about),*],
                    $crate::format::record::default!($($default)?),
                    &mut fields,
                );)*
                $crate::format::describe::Description::new($ron, &[$($doc),*], fields)
            }

            fn stand_in() -> Self {
                Self { $($field: $crate::format::Codec::<$ty>::stand_in(&$codec),)* }
            }
        }
    };
}

/// Defines an enum of which each variant holds the record that is written under its name, or nothing.
///
/// Behind `=` stands the variant that is its default, if it has one.
macro_rules! choices {
    (
        $(#[doc = $doc:expr])*
        $vis:vis enum $Type:ident $(: $($derive:ident),*)? $(= $default:ident)? ;
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

        impl $crate::format::Variants for $Type {
            const NAMES: &'static [&'static str] = &[$(stringify!($variant)),*];

            fn variant(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => stringify!($variant),)*
                }
            }

            #[allow(unused_variables)]
            fn read_fields(
                name: &str,
                fields: &mut $crate::format::fields::Fields<'_>,
                base: Option<&Self>,
            ) -> Option<Self> {
                match name {
                    $(stringify!($variant) => Some(Self::$variant $(({
                        let base = match base {
                            Some(Self::$variant(base)) => Some(base),
                            _ => None,
                        };
                        <$record as $crate::format::Record>::read_fields(fields, base)
                    }))?),)*
                    _ => None,
                }
            }

            fn write_fields(&self, entries: &mut Vec<$crate::format::text::Entry>) {
                $($(if let Self::$variant(record) = self {
                    <$record as $crate::format::Record>::write_fields(record, entries);
                })?)*
            }

            fn turn_fields(&mut self, hand: &mut $crate::format::hand::Hand<'_>) {
                $($(if let Self::$variant(record) = self {
                    <$record as $crate::format::Record>::turn_fields(record, hand);
                })?)*
            }

            fn describe() -> Vec<$crate::format::describe::Description> {
                vec![$($crate::format::describe::Description::new(
                    stringify!($variant),
                    &[$($about),*],
                    $crate::format::record::fields_of!($($record)?),
                )),*]
            }

            fn stand_in() -> Self {
                let all: &[fn() -> Self] = &[$(|| Self::$variant $((
                    <$record as $crate::format::Record>::stand_in()
                ))?),*];
                all[0]()
            }
        }
    };
}

/// What is known of the fields of a record; of none without one.
macro_rules! fields_of {
    () => {
        Vec::new()
    };
    ($record:ident) => {
        <$record as $crate::format::Record>::describe().fields
    };
}

/// The default of a field, if it has one.
macro_rules! default {
    () => {
        None
    };
    ($default:expr) => {
        Some($default)
    };
}

pub(crate) use {choices, default, fields_of, record};
