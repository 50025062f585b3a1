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
