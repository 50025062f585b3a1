//! Lists of values.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::Codec;
use crate::format::describe::FieldType;
use crate::format::hand::Hand;
use crate::format::node::Node;
use crate::format::problem::Problem;
use crate::format::text::Text as RonText;

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
    fn read_all<T>(&self, node: Node<'_>) -> Option<Vec<T>>
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
}

/// What holds the values of a list.
pub(crate) trait Listed {
    /// One of them.
    type Each;

    /// The list of these.
    fn of(values: Vec<Self::Each>) -> Self;

    /// All of them.
    fn all(&self) -> &[Self::Each];

    /// All of them, to be turned; none where they are shared.
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
    fn read(&self, node: Node<'_>, _: Option<&L>) -> Option<L> {
        self.read_all(node).map(L::of)
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
