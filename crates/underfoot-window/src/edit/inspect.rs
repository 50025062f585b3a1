//! Describes records: their fields with the present values and the origin of each.

use super::address::{Address, RecordList};
use super::document::Document;
use super::item::Item;
use underfoot::feel::Feel;
use underfoot::layout::{CursorRule, Look, Widget};
use underfoot::schema::{Diagnostic, Kind, Kinds};
use underfoot::widget::Behaviour;
use underfoot_format::describe::{FieldDescription, FieldType};
use underfoot_format::text::Entry;
use underfoot_format::{Codec, Name, Record, Variants};
use underfoot_scene::ergonomics::Finding;

/// The origin of a field's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldOrigin {
    /// It is written in the record.
    Written,
    /// The control's kind of this name defines it.
    Kind(String),
    /// It is the format's default, or absent.
    Default,
    /// Several records have different values.
    Several,
}

/// A field of a record, as an inspector shows it.
#[derive(Clone, Debug)]
pub struct Property {
    /// Its name; dotted for a field within a field, such as `look.face`.
    pub name: String,
    /// Its description.
    pub about: String,
    /// The permitted values: type, range and unit in words.
    pub told: String,
    /// The permitted values.
    pub shape: FieldType,
    /// Its present value, as it is or would be written; empty if absent.
    pub value: String,
    /// The origin of the value.
    pub origin: FieldOrigin,
    /// Its value without the one that is written here: that of the kind, or the default; empty if there is none.
    pub inherited: String,
}

impl Property {
    /// Its last name: for a field within a field, without the outer one.
    #[must_use]
    pub fn short(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or_default()
    }

    /// Whether it is a place or a size: two lengths in the layout's unit.
    #[must_use]
    pub fn is_place(&self) -> bool {
        self.name == "at" || self.name == "size"
    }
}

/// Fields that differ between controls.
const OWN: [&str; 4] = ["id", "label", "at", "size"];

impl Property {
    /// Merges the description of another record's field into this one.
    fn meet(&mut self, other: &Self) {
        if self.value != other.value {
            (self.value, self.origin) = (String::new(), FieldOrigin::Several);
        } else if self.origin != other.origin && self.origin != FieldOrigin::Several {
            // A field that is written in one of the records can be removed there.
            let is_written = [&self.origin, &other.origin].contains(&&FieldOrigin::Written);
            self.origin = if is_written { FieldOrigin::Written } else { FieldOrigin::Default };
        }
    }
}

/// A group of related fields.
#[derive(Clone, Debug)]
pub struct FieldSection {
    /// Its subject.
    pub title: String,
    /// The fields.
    pub properties: Vec<Property>,
}

/// The values of a field that a kind defines, as files write them.
struct Inherited<'k> {
    /// The name of the kind.
    kind: &'k str,
    /// The value of the control; `None` for the default.
    own: Option<String>,
    /// The value of the kind; `None` for the default.
    kinds: Option<String>,
}

/// One of the parts of a control that its kind defines.
struct FieldPart {
    title: &'static str,
    /// The beginning of its fields' names.
    prefix: &'static str,
    fields: Vec<FieldDescription>,
    /// The values that differ from their defaults.
    entries: Vec<Entry>,
}

/// The parts of a control: its behaviour, its look and its feel.
fn parts(behaviour: &Behaviour, look: &Look, feel: &Feel) -> [FieldPart; 3] {
    let known = Behaviour::describe().into_iter().find(|record| record.name == behaviour.variant());
    let mut entries = [Vec::new(), Vec::new(), Vec::new()];
    let [own, looks, feels] = &mut entries;
    Variants::write_fields(behaviour, own);
    Record::write_fields(look, looks);
    Record::write_fields(feel, feels);
    let [own, looks, feels] = entries;
    let fields = known.map(|record| record.fields).unwrap_or_default();
    [
        FieldPart { title: behaviour.name(), prefix: "", fields, entries: own },
        FieldPart { title: "Look", prefix: "look.", fields: Look::describe().fields, entries: looks },
        FieldPart { title: "Feel", prefix: "feel.", fields: Feel::describe().fields, entries: feels },
    ]
}

/// A property of this field, without an inherited value.
fn described(name: String, field: &FieldDescription, value: String, origin: FieldOrigin) -> Property {
    let told = field.shape.told(field.name);
    let (about, shape) = (field.about.clone(), field.shape.clone());
    Property { name, about, told, shape, value, origin, inherited: String::new() }
}

impl Document {
    /// All fields of `record`.
    #[must_use]
    pub fn properties(&self, record: &Address, item: Option<&Item>) -> Vec<FieldSection> {
        let text = |what: &str| FieldType::Text(what.into());
        let place = || FieldType::Words("two numbers in round brackets, in the layout's units");
        let id = ("id", "Its name for apps and addresses.", text("1 to 64 of a-z, 0-9 and _"));
        let at = ("at", "Its south-west corner.", place());
        let size = ("size", "Its width and depth.", place());
        let cursor = Codec::<CursorRule>::shape(&Name);
        let usual_cursor = Codec::<CursorRule>::write(&Name, &CursorRule::default()).inline();
        let own: Vec<(&str, &str, FieldType)> = match record.list() {
            None => vec![("title", "Its title, as people read it.", text("at most 200 characters"))],
            Some(RecordList::Regions) => {
                vec![id, at, size, ("cursor", "Which contacts in it operate its controls.", cursor)]
            }
            Some(RecordList::Stances) => {
                vec![("label", "Text written on it.", text("at most 64 characters")), at, size]
            }
            Some(RecordList::Pages) => {
                vec![id, ("title", "Its title, as people read it.", text("at most 200 characters"))]
            }
            Some(RecordList::Grounds) => vec![at, size],
            Some(RecordList::Widgets) if item.is_some_and(|item| item.is_group) => vec![id, at],
            Some(RecordList::Widgets) => vec![
                id,
                ("kind", "Its kind: a built-in one or one of `kinds`.", FieldType::Names(Vec::new())),
                ("label", "Text written on it.", text("at most 64 characters")),
                at,
                size,
                ("goto", "The page that a click on it shows.", text("the id of a page")),
            ],
        };
        let own = own.into_iter().map(|(name, about, shape)| {
            let default = (name == "cursor").then(|| usual_cursor.clone());
            let field = FieldDescription { name, about: about.into(), shape, default };
            self.property(record, name.to_owned(), &field, None)
        });
        let mut sections =
            vec![FieldSection { title: "Identity and place".into(), properties: own.collect() }];
        let widget =
            item.filter(|item| !item.is_group).and_then(|item| self.layout().widgets.get(item.widgets.start));
        if record.list() == Some(RecordList::Widgets)
            && let Some(widget) = widget
        {
            sections.extend(self.control(record, widget));
        }
        if record.list() == Some(RecordList::Grounds) {
            let name = record.find(self.root()).and_then(|record| record.name.clone()).unwrap_or_default();
            let described = underfoot::schema::ground_fields(&name);
            let properties =
                described.iter().map(|field| self.property(record, field.name.to_owned(), field, None));
            sections.push(FieldSection { title: name, properties: properties.collect() });
        }
        sections
    }

    /// The common fields of several controls: the fields that all of them have, except their names and places. A
    /// field with different values has [`FieldOrigin::Several`] and an empty value.
    #[must_use]
    pub fn common(&self, controls: &[&Item]) -> Vec<FieldSection> {
        let mut all = controls.iter().map(|item| self.properties(&item.record, Some(item)));
        let mut common = all.next().unwrap_or_default();
        for part in &mut common {
            part.properties.retain(|property| !OWN.contains(&property.name.as_str()));
        }
        for other in all {
            for part in &mut common {
                let same = other.iter().find(|other| other.title == part.title);
                let same = same.map_or(&[][..], |same| &same.properties);
                part.properties.retain_mut(|property| {
                    let Some(other) = same.iter().find(|other| other.name == property.name) else {
                        return false;
                    };
                    property.meet(other);
                    other.told == property.told
                });
            }
        }
        common.retain(|part| !part.properties.is_empty());
        common
    }

    /// The controls in a group, including those of nested groups; the record itself if it is a control.
    #[must_use]
    pub fn controls_in<'i>(&self, items: &'i [Item], record: &Address) -> Vec<&'i Item> {
        let controls =
            items.iter().filter(|item| item.record.list() == Some(RecordList::Widgets) && !item.is_group);
        controls.filter(|item| item.record.is_within(record)).collect()
    }

    fn control(&self, record: &Address, widget: &Widget) -> Vec<FieldSection> {
        let kind = self.all_kinds().get(&widget.kind);
        let inherited = kind.map(|kind| parts(&kind.behaviour, &kind.look, &kind.feel));
        let own = parts(&widget.behaviour, &widget.look, &widget.feel);
        let sections = own.into_iter().enumerate().map(|(number, part)| {
            let inherited = inherited.as_ref().and_then(|parts| parts.get(number));
            let properties = part.fields.iter().map(|field| {
                let entry = |part: &FieldPart| {
                    part.entries.iter().find(|(name, _)| *name == field.name).map(|(_, text)| text.inline())
                };
                let given =
                    Inherited { kind: &widget.kind, own: entry(&part), kinds: inherited.and_then(entry) };
                self.property(record, format!("{}{}", part.prefix, field.name), field, Some(given))
            });
            FieldSection { title: part.title.into(), properties: properties.collect() }
        });
        sections.collect()
    }

    /// The fields of a kind, which a control of it inherits.
    #[must_use]
    pub fn fields_of_kind(kind: &Kind) -> Vec<FieldSection> {
        let sections = parts(&kind.behaviour, &kind.look, &kind.feel).into_iter().map(|part| {
            let properties = part.fields.iter().map(|field| {
                let entry = part.entries.iter().find(|(name, _)| *name == field.name);
                let value = entry.map(|(_, text)| text.inline());
                let origin = if value.is_some() { FieldOrigin::Written } else { FieldOrigin::Default };
                let value = value.or_else(|| field.default.clone()).unwrap_or_default();
                described(format!("{}{}", part.prefix, field.name), field, value, origin)
            });
            FieldSection { title: part.title.into(), properties: properties.collect() }
        });
        sections.collect()
    }

    /// One field; `given` holds its value in the resolved control, for a field that a kind defines.
    fn property(
        &self,
        record: &Address,
        name: String,
        field: &FieldDescription,
        given: Option<Inherited<'_>>,
    ) -> Property {
        let default = field.default.clone().unwrap_or_default();
        let inherited =
            given.as_ref().and_then(|given| given.kinds.clone()).unwrap_or_else(|| default.clone());
        let (value, origin) = match (self.written(record, &name), given) {
            (Some(written), _) => (written.to_owned(), FieldOrigin::Written),
            (None, Some(Inherited { kind, own: Some(own), .. })) => (own, FieldOrigin::Kind(kind.to_owned())),
            _ => (default, FieldOrigin::Default),
        };
        Property { inherited, ..described(name, field, value, origin) }
    }

    /// The kinds of which its controls can be made and the effects that they can play: the known ones, and those that
    /// the layout itself defines.
    #[must_use]
    pub fn all_kinds(&self) -> &Kinds {
        &self.loaded().kinds
    }

    /// The record to which a finding refers.
    #[must_use]
    pub fn found_in(&self, finding: &Finding) -> Option<Address> {
        self.record_of(finding.widget)
    }

    /// The record to which a message of the reader refers.
    #[must_use]
    pub fn told_of(&self, problem: &Diagnostic) -> Option<Address> {
        // The reader gets the text without a byte-order mark.
        self.record_at(problem.span.start)
    }
}
