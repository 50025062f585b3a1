//! Records in a list, each with a subject of its own.

use std::collections::HashMap;
use std::ops::Range;

use super::{Codec, Rec};
use crate::describe::FieldType;
use crate::fields::Fields;
use crate::node::Node;
use crate::problem::Problem;
use crate::record::Record;
use crate::text::RonText;

/// Records in square brackets, no two of which may have the same subject.
///
/// The codec also finds conflicts between the readable records when others cannot be read.
pub struct Distinct<T> {
    /// Name of one record in messages.
    pub entry: &'static str,
    /// Maximum number of records.
    pub most: usize,
    /// Checks the subject of one record; the first argument is its index in the list.
    pub about: fn(usize, &T, &Fields<'_>, &mut Seen),
}

/// Places where subjects are first written.
#[derive(Default)]
pub struct Seen(HashMap<String, Range<usize>>);

impl Seen {
    /// Reports that `thing`, as messages name it, has been written before.
    pub fn check(&mut self, fields: &Fields<'_>, thing: String, span: Range<usize>) {
        match self.0.get(&thing) {
            Some(first) => {
                let problem = Problem::error(span, format!("{thing} comes twice"));
                let first = format!("the first is on line {}", fields.reader().line(first));
                fields.report(problem.expected(first));
            }
            None => drop(self.0.insert(thing, span)),
        }
    }
}

impl<T: Record> Distinct<T> {
    /// Reads the records of the field `name`, each by `read`, with stand-ins for those that cannot be read; `None` if
    /// the field is not written.
    pub fn read_by(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        read: impl FnMut(&mut Fields<'_>) -> T,
    ) -> Option<Vec<T>> {
        let (all, good) = self.read_all(fields.take(name)?, read);
        if !good {
            fields.fail(name);
        }
        Some(all)
    }

    /// Reads all records, with stand-ins for those that cannot be read. The flag says whether all could be read.
    fn read_all(&self, node: Node<'_>, mut read: impl FnMut(&mut Fields<'_>) -> T) -> (Vec<T>, bool) {
        let Some(nodes) = node.list(self.entry, self.most) else { return (Vec::new(), false) };
        let (mut seen, mut good) = (Seen::default(), true);
        let mut read_one = |(number, node): (usize, Node<'_>)| {
            let fields = node.fields(T::NAME);
            good &= fields.is_some();
            let mut fields = fields?;
            let one = read(&mut fields);
            (self.about)(number, &one, &fields, &mut seen);
            good &= fields.are_read();
            fields.finish();
            Some(one)
        };
        (nodes.into_iter().enumerate().filter_map(&mut read_one).collect(), good)
    }
}

impl<T: Record> Codec<Vec<T>> for Distinct<T> {
    type Context = T::Context;

    fn read(&self, node: Node<'_>, _: Option<&Vec<T>>, context: &T::Context) -> Option<Vec<T>> {
        let (all, good) = self.read_all(node, |fields| T::read_fields(fields, None, context));
        good.then_some(all)
    }

    fn write(&self, values: &Vec<T>) -> RonText {
        RonText::List(values.iter().map(|value| Rec.write(value)).collect())
    }

    fn shape(&self) -> FieldType {
        FieldType::List { count: (0, self.most), each: Box::new(FieldType::Record(T::describe)) }
    }

    fn stand_in(&self) -> Vec<T> {
        Vec::new()
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        _: Option<&Vec<T>>,
        default: Option<Vec<T>>,
        context: &T::Context,
    ) -> Vec<T> {
        let read = self.read_by(fields, name, |fields| T::read_fields(fields, None, context));
        read.or(default).unwrap_or_default()
    }
}
