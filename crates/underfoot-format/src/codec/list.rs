//! Lists of values.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::Codec;
use crate::describe::FieldType;
use crate::hand::Hand;
use crate::node::Node;
use crate::problem::Problem;
use crate::text::RonText;

/// Values in square brackets.
pub struct List<C> {
    /// Name of one value in messages.
    entry: &'static str,
    most: usize,
    each: C,
    /// Minimum number of values, the message for fewer, and the advice that goes with it.
    few: Option<(usize, &'static str, Option<&'static str>)>,
    /// Whether a tuner may change the values.
    turns: bool,
}

/// At most `most` values in square brackets; messages call each of them `entry`.
pub const fn list<C>(entry: &'static str, most: usize, each: C) -> List<C> {
    List { entry, most, each, few: None, turns: true }
}

impl<C> List<C> {
    /// Edited as a list instead of number by number, since its values depend on each other.
    pub const fn still(mut self) -> Self {
        self.turns = false;
        self
    }

    /// Requires at least `least` values; `message` reports fewer.
    pub const fn at_least(mut self, least: usize, message: &'static str) -> Self {
        self.few = Some((least, message, None));
        self
    }

    /// Adds the advice shown for too few values.
    pub const fn help(mut self, help: &'static str) -> Self {
        if let Some((_, _, told)) = &mut self.few {
            *told = Some(help);
        }
        self
    }

    /// Reads all values; `None` if one of them cannot be read.
    fn read_all<T>(&self, node: Node<'_>, context: &C::Context) -> Option<Vec<T>>
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
        // All entries are read before the first failure ends the list, so that each failure is reported.
        let read: Vec<Option<T>> =
            nodes.into_iter().map(|node| self.each.read(node, None, context)).collect();
        read.into_iter().collect()
    }
}

/// A container of the values of a list.
pub trait Listed {
    /// Type of one value.
    type Each;

    /// Makes the container from `values`.
    fn of(values: Vec<Self::Each>) -> Self;

    /// Returns all values.
    fn all(&self) -> &[Self::Each];

    /// Returns all values for changing; none where they are shared.
    fn all_mut(&mut self) -> &mut [Self::Each] {
        &mut []
    }
}

impl<T> Listed for Vec<T> {
    type Each = T;

    fn of(values: Self) -> Self {
        values
    }

    fn all(&self) -> &[T] {
        self
    }
}

impl<T, const N: usize> Listed for ArrayVec<T, N> {
    type Each = T;

    fn of(values: Vec<T>) -> Self {
        values.into_iter().take(N).collect()
    }

    fn all(&self) -> &[T] {
        self
    }

    fn all_mut(&mut self) -> &mut [T] {
        self
    }
}

impl<T> Listed for Arc<[T]> {
    type Each = T;

    fn of(values: Vec<T>) -> Self {
        Self::from(values)
    }

    fn all(&self) -> &[T] {
        self
    }
}

impl<L: Listed, C: Codec<L::Each>> Codec<L> for List<C> {
    type Context = C::Context;

    fn read(&self, node: Node<'_>, _: Option<&L>, context: &C::Context) -> Option<L> {
        self.read_all(node, context).map(L::of)
    }

    fn write(&self, values: &L) -> RonText {
        RonText::List(values.all().iter().map(|value| self.each.write(value)).collect())
    }

    fn shape(&self) -> FieldType {
        let least = self.few.map_or(0, |(least, ..)| least);
        FieldType::List { count: (least, self.most), each: Box::new(self.each.shape()) }
    }

    fn stand_in(&self) -> L {
        L::of(Vec::new())
    }

    fn turn(&self, values: &mut L, _: &'static str, hand: &mut Hand<'_>) {
        for (index, value) in values.all_mut().iter_mut().enumerate().filter(|_| self.turns) {
            hand.part(&format!("{} {}", self.entry, index + 1), |hand| {
                self.each.turn(value, "", hand);
            });
        }
    }
}
