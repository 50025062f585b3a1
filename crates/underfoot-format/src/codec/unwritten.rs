//! Values that files leave to other fields, or never hold.

use super::Codec;
use crate::describe::{FieldDescription, FieldType, first_paragraph};
use crate::fields::Fields;
use crate::hand::Hand;
use crate::node::Node;
use crate::text::{Entry, RonText};

/// A value that follows from other fields where it is not written; the rules of the record compute it.
pub struct Follow<C> {
    /// Codec of the written value.
    pub explicit: C,
    /// Description, for people, of the value that follows.
    pub otherwise: &'static str,
}

impl<T, C: Codec<T>> Codec<T> for Follow<C> {
    type Context = C::Context;

    fn read(&self, node: Node<'_>, base: Option<&T>, context: &C::Context) -> Option<T> {
        self.explicit.read(node, base, context)
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

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        base: Option<&T>,
        _: Option<T>,
        context: &C::Context,
    ) -> T
    where
        T: Clone,
    {
        let otherwise = || base.cloned().unwrap_or_else(|| self.stand_in());
        let Some(node) = fields.take(name) else {
            fields.follow(name);
            return otherwise();
        };
        self.read(node, base, context).unwrap_or_else(|| {
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

/// A value that no file holds: it comes from the base, or is this one.
pub struct Own<T>(pub T);

impl<T: Clone> Codec<T> for Own<T> {
    type Context = ();

    fn read(&self, _: Node<'_>, base: Option<&T>, (): &()) -> Option<T> {
        Some(base.unwrap_or(&self.0).clone())
    }

    fn write(&self, _: &T) -> RonText {
        RonText::Nothing
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("")
    }

    fn stand_in(&self) -> T {
        self.0.clone()
    }

    fn read_field(&self, _: &mut Fields<'_>, _: &'static str, base: Option<&T>, _: Option<T>, (): &()) -> T {
        base.unwrap_or(&self.0).clone()
    }

    fn write_field(&self, _: &T, _: &'static str, _: Option<T>, _: &mut Vec<Entry>) {}

    fn describe_field(&self, _: &'static str, _: &[&str], _: Option<T>, _: &mut Vec<FieldDescription>) {}
}
