//! What is written for one field, as a value that reads and writes it.

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::time::Duration;

use arrayvec::ArrayVec;

use super::describe::{FieldDescription, FieldType, first_paragraph};
use super::fields::Fields;
use super::hand::Hand;
use super::node::Node;
use super::number::Number;
use super::problem::Problem;
use super::record::{Record, Variants};
use super::text::{Entry, Text as RonText, number};
use crate::units::Newtons;

/// What is written for a `T`.
pub(crate) trait Codec<T> {
    /// What `node` says, over `base`; `None` after it has reported why that can't be used.
    fn read(&self, node: Node<'_>, base: Option<&T>) -> Option<T>;

    /// As it is written.
    fn write(&self, value: &T) -> RonText;

    /// What is written, for people.
    fn shape(&self) -> FieldType;

    /// Any value of its type.
    fn stand_in(&self) -> T;

    /// Shows its numbers to a hand.
    fn turn(&self, _value: &mut T, _name: &'static str, _hand: &mut Hand<'_>) {}

    /// What the field `name` says, or `base`, or `default`.
    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        base: Option<&T>,
        default: Option<T>,
    ) -> T
    where
        T: Clone,
    {
        let base = base.or(default.as_ref());
        let read = match fields.take(name) {
            Some(node) => self.read(node, base),
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

    /// Appends the field `name`, unless it is as its `default`.
    fn write_field(&self, value: &T, name: &'static str, default: Option<T>, entries: &mut Vec<Entry>)
    where
        T: PartialEq,
    {
        if default.as_ref() != Some(value) {
            entries.push((name, self.write(value)));
        }
    }

    /// Appends what is known of the field `name`.
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

/// A number. Its unit follows from the end of its field's name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Num {
    /// Least and greatest that a file may hold.
    range: (f64, f64),
    /// What a hand reaches.
    pub(super) hand: (f64, f64),
    /// What a value is multiplied with to be in the unit of files.
    pub(super) scale: f64,
    /// Whether it keeps to what bounds such numbers ([`super::node::Within`]).
    pub(super) bounded: bool,
}

/// A number within `range`, in the unit of files.
pub(crate) const fn num(range: RangeInclusive<f64>) -> Num {
    let range = (*range.start(), *range.end());
    Num { range, hand: range, scale: 1.0, bounded: false }
}

impl Num {
    /// Turned by hand, only so far.
    pub(crate) const fn hand(self, hand: RangeInclusive<f64>) -> Self {
        Self { hand: (*hand.start(), *hand.end()), ..self }
    }

    /// Milliseconds in files, seconds in values.
    pub(crate) const fn milli(self) -> Self {
        Self { scale: 1000.0, ..self }
    }

    /// Degrees in files, radians in values.
    pub(crate) const fn degrees(self) -> Self {
        Self { scale: 180.0 / std::f64::consts::PI, ..self }
    }

    /// Keeps to what bounds such numbers in the record around it.
    pub(crate) const fn bounded(self) -> Self {
        Self { bounded: true, ..self }
    }
}

/// A type whose values are numbers in files.
pub(crate) trait Scalar: Copy + PartialEq {
    /// Whether only whole numbers are values.
    const WHOLE: bool = false;

    /// The value of a number that is written, `scale` of which are 1.
    fn of(written: Number, scale: f64) -> Self;

    /// The number that reads back as the same value.
    fn to_ron(self, scale: f64) -> String;

    /// The value as a hand sees it.
    fn shown(self) -> f32;

    /// What a hand made of it.
    fn turned(shown: f32) -> Self;
}

impl Scalar for f32 {
    fn of(written: Number, scale: f64) -> Self {
        written.single / scale as Self
    }

    fn to_ron(self, scale: f64) -> String {
        number(self, scale)
    }

    fn shown(self) -> f32 {
        self
    }

    fn turned(shown: f32) -> Self {
        shown
    }
}

impl Scalar for Newtons {
    fn of(written: Number, scale: f64) -> Self {
        Self(f32::of(written, scale))
    }

    fn to_ron(self, scale: f64) -> String {
        self.0.to_ron(scale)
    }

    fn shown(self) -> f32 {
        self.0
    }

    fn turned(shown: f32) -> Self {
        Self(shown)
    }
}

/// To the microsecond.
impl Scalar for Duration {
    fn of(written: Number, scale: f64) -> Self {
        Self::from_micros((written.value / scale * 1e6).round() as u64)
    }

    fn to_ron(self, scale: f64) -> String {
        let text = format!("{:.6}", self.as_secs_f64() * scale);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }

    fn shown(self) -> f32 {
        self.as_secs_f32()
    }

    fn turned(shown: f32) -> Self {
        Self::try_from_secs_f32(shown).unwrap_or_default()
    }
}

/// Whole numbers; their range must fit into the type.
macro_rules! whole {
    ($($type:ty),*) => {
        $(impl Scalar for $type {
            const WHOLE: bool = true;

            fn of(written: Number, _: f64) -> Self {
                written.value as Self
            }

            fn to_ron(self, _: f64) -> String {
                self.to_string()
            }

            fn shown(self) -> f32 {
                self as f32
            }

            fn turned(shown: f32) -> Self {
                shown.round() as Self
            }
        })*
    };
}

whole!(u8, u16, u32, usize);

impl<T: Scalar> Codec<T> for Num {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        let range = self.range.0..=self.range.1;
        let number = if self.bounded { node.bounded(range) } else { node.number(range) }?;
        if T::WHOLE && !number.whole {
            node.report_fraction();
            return None;
        }
        Some(T::of(number, self.scale))
    }

    fn write(&self, value: &T) -> RonText {
        RonText::Plain(value.to_ron(self.scale))
    }

    fn shape(&self) -> FieldType {
        FieldType::Number { range: self.range, whole: T::WHOLE }
    }

    fn stand_in(&self) -> T {
        let least = self.range.0.max(0.0).min(self.range.1);
        T::of(Number { value: least, single: least as f32, whole: true }, self.scale)
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        // Numbers of a list are edited as a list.
        if name.is_empty() {
            return;
        }
        let mut shown = value.shown();
        hand.show(self, T::WHOLE, name, &mut shown);
        if shown != value.shown() {
            *value = T::turned(shown);
        }
    }
}

/// `true` or `false`.
pub(crate) struct Flag;

impl Codec<bool> for Flag {
    fn read(&self, node: Node<'_>, _: Option<&bool>) -> Option<bool> {
        node.flag()
    }

    fn write(&self, value: &bool) -> RonText {
        RonText::Plain(value.to_string())
    }

    fn shape(&self) -> FieldType {
        FieldType::Flag
    }

    fn stand_in(&self) -> bool {
        false
    }
}

/// Text of at most so many characters.
pub(crate) struct Text(pub(crate) usize);

impl<T: for<'a> From<&'a str> + AsRef<str>> Codec<T> for Text {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        node.text(self.0).map(T::from)
    }

    fn write(&self, value: &T) -> RonText {
        RonText::Plain(format!("{:?}", value.as_ref()))
    }

    fn shape(&self) -> FieldType {
        FieldType::Text(format!("text of at most {} characters", self.0))
    }

    fn stand_in(&self) -> T {
        T::from("")
    }
}

/// Something that files write as one of a few names.
pub(crate) trait Named: Copy + PartialEq + 'static {
    /// Each with its name.
    const ALL: &'static [(&'static str, Self)];
}

/// One of a few names.
pub(crate) struct Name;

impl<T: Named> Codec<T> for Name {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        node.choice(T::ALL)
    }

    fn write(&self, value: &T) -> RonText {
        let name = T::ALL.iter().find(|(_, one)| one == value).map_or("", |(name, _)| name);
        RonText::Plain(name.to_owned())
    }

    fn shape(&self) -> FieldType {
        FieldType::Names(T::ALL.iter().map(|(name, _)| *name).collect())
    }

    fn stand_in(&self) -> T {
        T::ALL[0].1
    }
}

/// What may be `None`.
pub(crate) struct Opt<C>(pub(crate) C);

impl<T, C: Codec<T>> Codec<Option<T>> for Opt<C> {
    fn read(&self, node: Node<'_>, base: Option<&Option<T>>) -> Option<Option<T>> {
        if node.is_none() {
            return Some(None);
        }
        self.0.read(node, base.and_then(Option::as_ref)).map(Some)
    }

    fn write(&self, value: &Option<T>) -> RonText {
        value.as_ref().map_or(RonText::Plain("None".to_owned()), |value| self.0.write(value))
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

/// Two numbers in round brackets, shown as such a pattern.
pub(crate) struct Pair {
    pub(crate) each: Num,
    pub(crate) pattern: &'static str,
    /// What a hand sees.
    pub(crate) parts: [&'static str; 2],
}

impl<T: Copy + From<[f32; 2]> + Into<[f32; 2]>> Codec<T> for Pair {
    fn read(&self, node: Node<'_>, _: Option<&T>) -> Option<T> {
        let nodes: [Node<'_>; 2] = node.tuple(self.pattern)?;
        let [first, second] = nodes.map(|node| Codec::<f32>::read(&self.each, node, None));
        Some([first?, second?].into())
    }

    fn write(&self, value: &T) -> RonText {
        let [first, second] = (*value).into().map(|value| value.to_ron(self.each.scale));
        RonText::Plain(format!("({first}, {second})"))
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

/// What follows from other fields where it is not written; the record's rules make it so.
pub(crate) struct Follow<C> {
    pub(crate) explicit: C,
    /// What it is then, for people.
    pub(crate) otherwise: &'static str,
}

impl<T, C: Codec<T>> Codec<T> for Follow<C> {
    fn read(&self, node: Node<'_>, base: Option<&T>) -> Option<T> {
        self.explicit.read(node, base)
    }

    fn write(&self, value: &T) -> RonText {
        self.explicit.write(value)
    }

    fn shape(&self) -> FieldType {
        self.explicit.shape()
    }

    fn stand_in(&self) -> T {
        self.explicit.stand_in()
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        self.explicit.turn(value, name, hand);
    }

    fn read_field(&self, fields: &mut Fields<'_>, name: &'static str, base: Option<&T>, _: Option<T>) -> T
    where
        T: Clone,
    {
        let otherwise = || base.cloned().unwrap_or_else(|| self.stand_in());
        let Some(node) = fields.take(name) else {
            fields.follow(name);
            return otherwise();
        };
        self.read(node, base).unwrap_or_else(|| {
            fields.fail(name);
            otherwise()
        })
    }

    fn describe_field(
        &self,
        name: &'static str,
        about: &[&str],
        _: Option<T>,
        fields: &mut Vec<FieldDescription>,
    ) {
        let default = Some(self.otherwise.to_owned());
        fields.push(FieldDescription { name, about: first_paragraph(about), shape: self.shape(), default });
    }
}

/// Values in square brackets.
pub(crate) struct List<C> {
    /// What messages call one of them.
    entry: &'static str,
    most: usize,
    each: C,
    /// The fewest, what is said of fewer, and what to do then.
    few: Option<(usize, &'static str, Option<&'static str>)>,
    /// Whether a hand may turn what is in it.
    turns: bool,
}

/// At most `most` values in square brackets; messages call each of them `entry`.
pub(crate) const fn list<C>(entry: &'static str, most: usize, each: C) -> List<C> {
    List { entry, most, each, few: None, turns: true }
}

impl<C> List<C> {
    /// Edited as a list, not number by number: its values depend on each other.
    pub(crate) const fn still(mut self) -> Self {
        self.turns = false;
        self
    }

    /// At least so many; `message` is said of fewer.
    pub(crate) const fn at_least(mut self, least: usize, message: &'static str) -> Self {
        self.few = Some((least, message, None));
        self
    }

    /// What to do where there are too few.
    pub(crate) const fn help(mut self, help: &'static str) -> Self {
        if let Some((_, _, told)) = &mut self.few {
            *told = Some(help);
        }
        self
    }

    /// All of the values, if each could be read.
    pub(crate) fn read_all<T>(&self, node: Node<'_>) -> Option<Vec<T>>
    where
        C: Codec<T>,
    {
        let nodes = node.list(self.entry, self.most)?;
        if let Some((least, message, help)) = self.few.filter(|(least, ..)| nodes.len() < *least) {
            let (most, entry) = (self.most, self.entry);
            let or = if most == least + 1 { "or" } else { "to" };
            let problem = Problem::error(node.span(), message);
            let problem = problem.expected(format!("expected {least} {or} {most} {entry}s"));
            node.report(problem.help_if(help.map(str::to_owned)));
            return None;
        }
        // All are read before the first that failed ends it, so that each is reported.
        let read: Vec<Option<T>> = nodes.into_iter().map(|node| self.each.read(node, None)).collect();
        read.into_iter().collect()
    }

    pub(crate) fn write_all<'t, T: 't>(&self, values: impl IntoIterator<Item = &'t T>) -> RonText
    where
        C: Codec<T>,
    {
        RonText::List(values.into_iter().map(|value| self.each.write(value)).collect())
    }

    pub(crate) fn described<T>(&self) -> FieldType
    where
        C: Codec<T>,
    {
        let least = self.few.map_or(0, |(least, ..)| least);
        FieldType::List { count: (least, self.most), each: Box::new(self.each.shape()) }
    }

    pub(crate) fn turn_all<T>(&self, values: &mut [T], hand: &mut Hand<'_>)
    where
        C: Codec<T>,
    {
        for (index, value) in values.iter_mut().enumerate().filter(|_| self.turns) {
            hand.part(&format!("{} {}", self.entry, index + 1), |hand| {
                self.each.turn(value, "", hand);
            });
        }
    }
}

impl<T, C: Codec<T>, const N: usize> Codec<ArrayVec<T, N>> for List<C> {
    fn read(&self, node: Node<'_>, _: Option<&ArrayVec<T, N>>) -> Option<ArrayVec<T, N>> {
        self.read_all(node).map(|read| read.into_iter().take(N).collect())
    }

    fn write(&self, values: &ArrayVec<T, N>) -> RonText {
        self.write_all(values)
    }

    fn shape(&self) -> FieldType {
        self.described()
    }

    fn stand_in(&self) -> ArrayVec<T, N> {
        ArrayVec::new()
    }

    fn turn(&self, values: &mut ArrayVec<T, N>, _: &'static str, hand: &mut Hand<'_>) {
        self.turn_all(values, hand);
    }
}

impl<T, C: Codec<T>> Codec<Arc<[T]>> for List<C> {
    fn read(&self, node: Node<'_>, _: Option<&Arc<[T]>>) -> Option<Arc<[T]>> {
        self.read_all(node).map(Arc::from)
    }

    fn write(&self, values: &Arc<[T]>) -> RonText {
        self.write_all(values.iter())
    }

    fn shape(&self) -> FieldType {
        self.described()
    }

    fn stand_in(&self) -> Arc<[T]> {
        Arc::from([])
    }
}

/// A record of its own.
pub(crate) struct Rec;

impl<T: Record> Codec<T> for Rec {
    fn read(&self, node: Node<'_>, base: Option<&T>) -> Option<T> {
        node.record(base)
    }

    fn write(&self, value: &T) -> RonText {
        let mut entries = Vec::new();
        value.write_fields(&mut entries);
        RonText::Fields("", entries)
    }

    fn shape(&self) -> FieldType {
        FieldType::Record(T::describe)
    }

    fn stand_in(&self) -> T {
        T::stand_in()
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        // An entry of a list has been named by its number.
        if name.is_empty() {
            value.turn_fields(hand);
        } else {
            hand.part(name, |hand| value.turn_fields(hand));
        }
    }
}

/// A record whose fields stand among those of the record around it.
pub(crate) struct Flat;

impl<T: Record> Codec<T> for Flat {
    fn read(&self, node: Node<'_>, base: Option<&T>) -> Option<T> {
        node.record(base)
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

    fn read_field(&self, fields: &mut Fields<'_>, _: &'static str, base: Option<&T>, _: Option<T>) -> T {
        T::read_fields(fields, base)
    }

    fn write_field(&self, value: &T, _: &'static str, _: Option<T>, entries: &mut Vec<Entry>) {
        value.write_fields(entries);
    }

    fn describe_field(&self, _: &'static str, _: &[&str], _: Option<T>, fields: &mut Vec<FieldDescription>) {
        fields.extend(T::describe().fields);
    }
}

/// One of several records, by its name; its name alone says nothing of its fields.
pub(crate) struct OneOf;

impl<T: Variants + Default> Codec<T> for OneOf {
    fn read(&self, node: Node<'_>, base: Option<&T>) -> Option<T> {
        let (name, mut fields) = node.variant(T::NAMES)?;
        let read = T::read_fields(name, &mut fields, base);
        let all = fields.are_read();
        fields.finish();
        read.filter(|_| all)
    }

    fn write(&self, value: &T) -> RonText {
        let mut entries = Vec::new();
        value.write_fields(&mut entries);
        match entries.as_slice() {
            [] => RonText::Plain(value.variant().to_owned()),
            _ => RonText::Fields(value.variant(), entries),
        }
    }

    fn shape(&self) -> FieldType {
        FieldType::Variants(T::describe)
    }

    fn stand_in(&self) -> T {
        T::default()
    }

    fn turn(&self, value: &mut T, name: &'static str, hand: &mut Hand<'_>) {
        hand.part(name, |hand| value.turn_fields(hand));
    }
}

/// What no file says: it is as in the base, or this.
pub(crate) struct Own<T>(pub(crate) T);

impl<T: Clone> Codec<T> for Own<T> {
    fn read(&self, _: Node<'_>, base: Option<&T>) -> Option<T> {
        Some(base.unwrap_or(&self.0).clone())
    }

    fn write(&self, _: &T) -> RonText {
        RonText::Plain(String::new())
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("")
    }

    fn stand_in(&self) -> T {
        self.0.clone()
    }

    fn read_field(&self, _: &mut Fields<'_>, _: &'static str, base: Option<&T>, _: Option<T>) -> T {
        base.unwrap_or(&self.0).clone()
    }

    fn write_field(&self, _: &T, _: &'static str, _: Option<T>, _: &mut Vec<Entry>) {}

    fn describe_field(&self, _: &'static str, _: &[&str], _: Option<T>, _: &mut Vec<FieldDescription>) {}
}
