//! Pairs of thresholds; the second is derived from the first.

use underfoot_format::describe::{FieldDescription, FieldType, first_paragraph};
use underfoot_format::fields::Fields;
use underfoot_format::node::Node;
use underfoot_format::problem::Problem;
use underfoot_format::text::{Entry, RonText};
use underfoot_format::{Codec, Num};

/// A pair of thresholds in two fields, which may be absent; the second is derived from the first unless it is
/// written.
pub(super) struct Stage {
    pub(super) press: Num,
    pub(super) release: Num,
    /// The names of the fields.
    pub(super) names: [&'static str; 2],
    /// Description of the second one.
    pub(super) about: &'static str,
    /// Default of the second one as a share of the first.
    pub(super) follows: f32,
    /// Error text for the second one without the first.
    pub(super) lonely: &'static str,
}

impl<T: Copy + PartialEq + From<[f32; 2]> + Into<[f32; 2]>> Codec<Option<T>> for Stage {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Option<T>>, context: &()) -> Option<Option<T>> {
        if node.is_none() {
            return Some(None);
        }
        let press: f32 = self.press.read(node, None, context)?;
        Some(Some([press, press * self.follows].into()))
    }

    fn write(&self, value: &Option<T>) -> RonText {
        value.map_or(RonText::Nothing, |value| self.press.write(&value.into()[0]))
    }

    fn shape(&self) -> FieldType {
        FieldType::Optional(Box::new(Codec::<f32>::shape(&self.press)))
    }

    fn stand_in(&self) -> Option<T> {
        None
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        base: Option<&Option<T>>,
        _: Option<Option<T>>,
        context: &(),
    ) -> Option<T> {
        let base: Option<[f32; 2]> = base.copied().flatten().map(T::into);
        let release_name = self.names[1];
        let mut failed = false;
        let mut read = |name, codec: &Num| {
            let node = fields.take(name)?;
            if node.is_none() && name != release_name {
                return Some(None);
            }
            let number: Option<f32> = codec.read(node, None, context);
            if number.is_none() {
                fields.fail(name);
                failed = true;
            }
            Some(number)
        };
        let (press, release) = (read(name, &self.press), read(release_name, &self.release).flatten());
        if failed {
            return base.map(T::from);
        }
        let Some(press) = press.unwrap_or(base.map(|[press, _]| press)) else {
            if let Some(span) = fields.value_span(release_name) {
                let message = format!("`{release_name}` needs `{name}`");
                fields.report(Problem::error(span, message).expected(self.lonely));
            }
            return None;
        };
        // A base's release threshold is scaled with a new press threshold.
        let part = base.map_or(self.follows, |[press, release]| release / press);
        Some([press, release.unwrap_or(press * part)].into())
    }

    fn write_field(
        &self,
        value: &Option<T>,
        name: &'static str,
        _: Option<Option<T>>,
        entries: &mut Vec<Entry>,
    ) {
        if let Some([press, release]) = value.map(T::into) {
            entries.push((name, self.press.write(&press)));
            entries.push((self.names[1], self.release.write(&release)));
        }
    }

    fn describe_field(
        &self,
        name: &'static str,
        about: &[&str],
        _: Option<Option<T>>,
        fields: &mut Vec<FieldDescription>,
    ) {
        let (about, shape) = (first_paragraph(about), Codec::<Option<T>>::shape(self));
        fields.push(FieldDescription { name, about, shape, default: Some("None".to_owned()) });
        fields.push(FieldDescription {
            name: self.names[1],
            about: self.about.to_owned(),
            shape: Codec::<f32>::shape(&self.release),
            default: Some(format!("{} of `{name}`", self.follows)),
        });
    }
}
