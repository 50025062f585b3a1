//! The appearance or the feel of a copied control, given to other controls.

use super::address::Address;
use super::change::Edit;
use super::document::Document;
use super::item::Item;
use super::refusal::EditRefusal;
use underfoot::feel::Feel;
use underfoot::schema::ControlKind;
use underfoot_format::Record;
use underfoot_format::outline::Outline;
use underfoot_format::source::MAX_BYTES;
use underfoot_format::text::Entry;

/// A part of a control that can be pasted alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facet {
    /// Its shape and colours. Its icon tells, as its label does, the purpose of the control, and stays.
    Appearance,
    /// Its effects.
    Feel,
}

impl Facet {
    /// The name for users, in the middle of a sentence.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Appearance => "appearance",
            Self::Feel => "feel",
        }
    }

    const fn field(self) -> &'static str {
        match self {
            Self::Appearance => "look",
            Self::Feel => "feel",
        }
    }

    /// The fields of `kind`, as a file writes them: effects that have a name by their name.
    fn of_kind(self, document: &Document, kind: &ControlKind) -> Vec<(String, String)> {
        let mut entries: Vec<Entry> = Vec::new();
        match self {
            Self::Appearance => kind.look.write_fields(&mut entries),
            Self::Feel => kind.feel.write_fields(&mut entries),
        }
        let named = |text: String| match self {
            Self::Appearance => text,
            Self::Feel => name_of(document, &text).unwrap_or(text),
        };
        let fields = entries.into_iter().filter(|(field, _)| *field != KEPT);
        fields.map(|(field, text)| (field.to_owned(), named(text.inline()))).collect()
    }
}

/// The field of a look that stays.
const KEPT: &str = "icon";

/// The name, in quotes, of the effect that is written out as `text`.
fn name_of(document: &Document, text: &str) -> Option<String> {
    let mut all = document.kinds().effects().iter();
    let is_it = |effect: &std::sync::Arc<underfoot::feel::Effect>| {
        let mut entries = Vec::new();
        Feel { press: Some(effect.clone()), ..Feel::default() }.write_fields(&mut entries);
        entries.iter().any(|(field, value)| *field == "press" && value.inline() == text)
    };
    all.find(|named| is_it(&named.effect)).map(|named| super::change::quoted(&named.name))
}

/// The edits that give `targets`, controls, the appearance or feel of the first control in `pasted`, a text as
/// [`Document::copy`] gives it. A value that equals the one of the target's kind is left out.
///
/// # Errors
/// [`EditRefusal::NotAControl`] if `pasted` is something else or there are no targets; [`EditRefusal::TooLong`].
pub fn facet_edits(
    document: &Document,
    facet: Facet,
    pasted: &str,
    targets: &[&Item],
) -> Result<Vec<Edit>, EditRefusal> {
    if pasted.len() > MAX_BYTES {
        return Err(EditRefusal::TooLong);
    }
    let text = format!("[\n{}\n]", pasted.trim());
    let entries = Outline::parse(&text).ok_or(EditRefusal::NotAControl)?;
    let source = entries.elements.iter().map(|element| &element.value);
    let source = source.into_iter().find(|record| record.field("kind").is_some());
    let source = source.ok_or(EditRefusal::NotAControl)?;
    let kind = source.field("kind").and_then(|field| field.value.says.as_deref()).unwrap_or_default();
    let mut wanted = kind_fields(document, facet, kind);
    for (name, value) in written_in(source, &text, facet) {
        wanted.retain(|(other, _)| *other != name);
        wanted.push((name, value));
    }
    let edits: Vec<Vec<Edit>> =
        targets.iter().filter_map(|item| edits_of(document, facet, &wanted, item)).collect();
    if edits.is_empty() { Err(EditRefusal::NotAControl) } else { Ok(edits.concat()) }
}

/// The fields of the kind called `name`: one of the program, or the layout's own as its controls show it.
fn kind_fields(document: &Document, facet: Facet, name: &str) -> Vec<(String, String)> {
    if let Some(kind) = document.kinds().get(name) {
        return facet.of_kind(document, kind);
    }
    let plain = document.layout().widgets.iter().enumerate().find(|(at, widget)| {
        let is_plain = |record: Address| document.written(&record, facet.field()).is_none();
        widget.kind == name && document.record_of(*at).is_some_and(is_plain)
    });
    let Some((_, widget)) = plain else { return Vec::new() };
    let kind = ControlKind {
        name: name.to_owned(),
        behaviour: widget.behaviour.clone(),
        feel: widget.feel.clone(),
        look: widget.look,
        send: widget.send.clone(),
    };
    facet.of_kind(document, &kind)
}

/// The fields that `record`, a part of `text`, writes itself.
fn written_in(record: &Outline, text: &str, facet: Facet) -> Vec<(String, String)> {
    let fields = record.field(facet.field()).map(|field| &field.value.elements[..]).unwrap_or_default();
    let fields = fields.iter().filter_map(|element| {
        let (name, _) = element.field.as_ref()?;
        Some((name.clone(), text.get(element.value.span.clone())?.to_owned()))
    });
    fields.filter(|(name, _)| name != KEPT).collect()
}

fn edits_of(
    document: &Document,
    facet: Facet,
    wanted: &[(String, String)],
    item: &Item,
) -> Option<Vec<Edit>> {
    let record = &item.record;
    let widget = document.layout().widgets.get(item.widgets.start).filter(|_| !item.widgets.is_empty())?;
    let base = kind_fields(document, facet, &widget.kind);
    let written = written_in(record.find(document.root())?, document.text(), facet);
    let mut names: Vec<&String> = wanted.iter().chain(&written).chain(&base).map(|(name, _)| name).collect();
    names.sort();
    names.dedup();
    let of = |fields: &[(String, String)], name: &String| {
        fields.iter().find(|(other, _)| other == name).map(|(_, value)| value.clone())
    };
    let edits = names.into_iter().filter_map(|name| {
        let field = format!("{}.{name}", facet.field());
        let (want, base, now) = (of(wanted, name), of(&base, name), of(&written, name));
        match want {
            want if want == base => now.map(|_| Edit::unset(record, &field)),
            Some(value) => (now.as_ref() != Some(&value)).then(|| Edit::set(record, &field, value)),
            // The kind has a value that the copied control lacks.
            None if base.as_deref().is_some_and(|base| base != "None") => {
                Some(Edit::set(record, &field, "None"))
            }
            None => now.map(|_| Edit::unset(record, &field)),
        }
    });
    Some(edits.collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use underfoot::floor::Floor;
    use underfoot::layout::Look;
    use underfoot::schema::{Kinds, builtin_layout};

    fn open(name: &str) -> Document {
        let floor = Arc::new(Floor::default());
        Document::read(name, builtin_layout(name).unwrap(), &Arc::new(Kinds::builtin()), &floor).unwrap()
    }

    fn paste(document: &mut Document, facet: Facet, text: &str, id: &str) {
        let items = document.items();
        let target = items.iter().find(|item| item.name == id).unwrap();
        let edits = facet_edits(document, facet, text, &[target]).unwrap();
        document.edit(&edits).unwrap();
    }

    fn widget(document: &Document, id: &str) -> underfoot::layout::Widget {
        document.layout().widgets[document.layout().widget_index(id).unwrap()].clone()
    }

    #[test]
    fn a_foot_sees_the_pasted_colours_and_feels_its_own_control() {
        let mut document = open("surgical");
        let first = document.text().to_owned();
        let capture = document.items().into_iter().find(|item| item.name == "capture").unwrap();
        let text = document.copy(std::slice::from_ref(&capture.record));
        let ids: Vec<String> = document.layout().widgets.iter().map(|widget| widget.id.to_string()).collect();
        for id in ids.iter().filter(|id| *id != "capture") {
            let before = widget(&document, id);
            paste(&mut document, Facet::Appearance, &text, id);
            let (source, after) = (widget(&document, "capture"), widget(&document, id));
            assert_eq!(
                after.look,
                Look { icon: before.look.icon, ..source.look },
                "{id}\n{}",
                document.text()
            );
            assert_eq!((&after.feel, &after.label, after.area), (&before.feel, &before.label, before.area));
            paste(&mut document, Facet::Feel, &text, id);
            assert_eq!(widget(&document, id).feel, source.feel, "{id}\n{}", document.text());
        }
        while document.undo().unwrap() {}
        assert_eq!(document.text(), first);
    }

    #[test]
    fn what_equals_the_kind_is_not_written_and_what_is_no_control_is_refused() {
        let mut document = open("map");
        let first = document.text().to_owned();
        let home = document.items().into_iter().find(|item| item.name == "home").unwrap();
        let own = document.copy(std::slice::from_ref(&home.record));
        paste(&mut document, Facet::Feel, &own, "home");
        paste(&mut document, Facet::Appearance, &own, "home");
        assert_eq!(document.text(), first);
        for text in ["", "5", "(id: \"r\", at: (0, 0), size: (1, 1))", "[(("] {
            let refused = facet_edits(&document, Facet::Feel, text, &[&home]);
            assert_eq!(refused, Err(EditRefusal::NotAControl), "{text}");
        }
        assert_eq!(facet_edits(&document, Facet::Feel, &own, &[]), Err(EditRefusal::NotAControl));
    }
}
