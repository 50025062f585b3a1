//! Records within records.

use super::Codec;
use crate::describe::{FieldDescription, FieldType, first_paragraph};
use crate::fields::Fields;
use crate::hand::Hand;
use crate::node::Node;
use crate::record::{Record, Variants};
use crate::text::{Entry, RonText};

/// A record of its own.
pub struct Rec;

impl<T: Record> Codec<T> for Rec {
    type Context = T::Context;

    fn read(&self, node: Node<'_>, base: Option<&T>, context: &T::Context) -> Option<T> {
        node.record(base, context)
    }

    fn write(&self, value: &T) -> RonText {
        let mut entries = Vec::new();
        value.write_fields(&mut entries);
        RonText::Record(T::NAME, entries)
    }

    fn shape(&self) -> FieldType {
        FieldType::Record(T::describe)
    }

    fn stand_in(&self) -> T {
        T::stand_in()
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        // Entries of a list already carry their number as name.
        if name.is_empty() {
            value.turn_fields(hand);
        } else {
            hand.part(name, |hand| value.turn_fields(hand));
        }
    }
}

/// A record whose fields stand among those of the record around it.
pub struct Flat;

impl<T: Record> Codec<T> for Flat {
    type Context = T::Context;

    fn read(&self, node: Node<'_>, base: Option<&T>, context: &T::Context) -> Option<T> {
        node.record(base, context)
    }

    fn write(&self, value: &T) -> RonText {
        Rec.write(value)
    }

    fn shape(&self) -> FieldType {
        Codec::<T>::shape(&Rec)
    }

    fn stand_in(&self) -> T {
        T::stand_in()
    }

    fn turn(&self, value: &mut T, _: &'static str, hand: &mut Hand<'_>) {
        value.turn_fields(hand);
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        _: &'static str,
        base: Option<&T>,
        _: Option<T>,
        context: &T::Context,
    ) -> T {
        T::read_fields(fields, base, context)
    }

    fn write_field(&self, value: &T, _: &'static str, _: Option<T>, entries: &mut Vec<Entry>) {
        value.write_fields(entries);
    }

    fn describe_field(&self, _: &'static str, _: &[&str], _: Option<T>, fields: &mut Vec<FieldDescription>) {
        fields.extend(T::describe().fields);
    }
}

/// One of several records, given by its name, with its fields beside the name.
pub struct Beside;

impl<T: Variants> Codec<T> for Beside {
    type Context = T::Context;

    fn read(&self, node: Node<'_>, base: Option<&T>, context: &T::Context) -> Option<T> {
        OneOf.read(node, base, context)
    }

    fn write(&self, value: &T) -> RonText {
        OneOf.write(value)
    }

    fn shape(&self) -> FieldType {
        FieldType::Beside(T::describe)
    }

    fn stand_in(&self) -> T {
        T::stand_in()
    }

    fn turn(&self, value: &mut T, _: &'static str, hand: &mut Hand<'_>) {
        value.turn_fields(hand);
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        base: Option<&T>,
        default: Option<T>,
        context: &T::Context,
    ) -> T {
        let base = base.or(default.as_ref());
        let all: Vec<_> = T::NAMES.iter().map(|name| (*name, *name)).collect();
        let chosen = match fields.take(name) {
            Some(node) => node.choice(&all),
            None => {
                if base.is_none() {
                    fields.lack(name);
                }
                base.map(T::variant)
            }
        };
        chosen.and_then(|chosen| T::read_fields(chosen, fields, base, context)).unwrap_or_else(|| {
            fields.fail(name);
            // Only the name could tell which other fields are valid.
            fields.allow_unknown();
            base.cloned().unwrap_or_else(T::stand_in)
        })
    }

    fn write_field(&self, value: &T, name: &'static str, default: Option<T>, entries: &mut Vec<Entry>) {
        if default.is_none_or(|default| default.variant() != value.variant()) {
            entries.push((name, RonText::Name(value.variant())));
        }
        value.write_fields(entries);
    }

    fn describe_field(
        &self,
        name: &'static str,
        about: &[&str],
        default: Option<T>,
        fields: &mut Vec<FieldDescription>,
    ) {
        let default = default.map(|default| default.variant().to_owned());
        let shape = Codec::<T>::shape(self);
        fields.push(FieldDescription { name, about: first_paragraph(about), shape, default });
    }
}

/// One of several records, given by its name, with its fields in brackets behind the name.
pub struct OneOf;

impl<T: Variants> Codec<T> for OneOf {
    type Context = T::Context;

    fn read(&self, node: Node<'_>, base: Option<&T>, context: &T::Context) -> Option<T> {
        let (name, mut fields) = node.variant(T::NAMES)?;
        let read = T::read_fields(name, &mut fields, base, context);
        let all = fields.are_read();
        fields.finish();
        read.filter(|_| all)
    }

    fn write(&self, value: &T) -> RonText {
        let mut entries = Vec::new();
        value.write_fields(&mut entries);
        match entries.as_slice() {
            [] => RonText::Name(value.variant()),
            _ => RonText::Variant(value.variant(), entries),
        }
    }

    fn shape(&self) -> FieldType {
        FieldType::Variants(T::describe)
    }

    fn stand_in(&self) -> T {
        T::stand_in()
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        hand.part(name, |hand| value.turn_fields(hand));
    }
}
