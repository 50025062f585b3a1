//! Describes records: their fields with the present values and the origin of each.

use super::address::{Address, RecordList};
use super::document::Document;
use super::item::Item;
use underfoot::layout::Widget;
use underfoot::schema::Diagnostic;
use underfoot_format::describe::{FieldDescription, FieldType};
use underfoot_format::text::Entry;
use underfoot_format::{Record, Variants};
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

impl Document {
    /// All fields of `record`.
    #[must_use]
    pub fn properties(&self, record: &Address, item: Option<&Item>) -> Vec<FieldSection> {
        let text = |what: &str| FieldType::Text(what.into());
        let place = || FieldType::Words("two numbers in round brackets, in the layout's units");
        let id = ("id", "Its name for apps and addresses.", text("1 to 64 of a-z, 0-9 and _"));
        let at = ("at", "Its south-west corner.", place());
        let size = ("size", "Its width and depth.", place());
        let cursor = FieldType::Names(vec!["Largest", "Working", "Each"]);
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
            let field = FieldDescription { name, about: about.into(), shape, default: None };
            self.property(record, name.to_owned(), &field, None, &[])
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
                described.iter().map(|field| self.property(record, field.name.to_owned(), field, None, &[]));
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
        let behaviour = &widget.behaviour;
        let described = underfoot::widget::Behaviour::describe();
        let described = described.into_iter().find(|record| record.name == behaviour.variant());
        let entries = |write: &dyn Fn(&mut Vec<Entry>)| {
            let mut entries = Vec::new();
            write(&mut entries);
            entries
        };
        let section = |title: &str, prefix: &str, fields: Vec<FieldDescription>, entries: Vec<Entry>| {
            let properties = fields.iter().map(|field| {
                self.property(record, format!("{prefix}{}", field.name), field, Some(&widget.kind), &entries)
            });
            FieldSection { title: title.into(), properties: properties.collect() }
        };
        vec![
            section(
                behaviour.name(),
                "",
                described.map(|record| record.fields).unwrap_or_default(),
                entries(&|entries| Variants::write_fields(behaviour, entries)),
            ),
            section(
                "Look",
                "look.",
                underfoot::layout::Look::describe().fields,
                entries(&|entries| Record::write_fields(&widget.look, entries)),
            ),
            section(
                "Feel",
                "feel.",
                underfoot::feel::Feel::describe().fields,
                entries(&|entries| Record::write_fields(&widget.feel, entries)),
            ),
        ]
    }

    /// One field; `entries` are the values of the resolved control, from its record or from its kind.
    fn property(
        &self,
        record: &Address,
        name: String,
        field: &FieldDescription,
        kind: Option<&str>,
        entries: &[Entry],
    ) -> Property {
        let entry = entries.iter().find(|(entry, _)| *entry == field.name);
        let (value, origin) = match (self.written(record, &name), entry, kind) {
            (Some(written), ..) => (written.to_owned(), FieldOrigin::Written),
            (None, Some((_, text)), Some(kind)) => (text.inline(), FieldOrigin::Kind(kind.to_owned())),
            _ => (field.default.clone().unwrap_or_default(), FieldOrigin::Default),
        };
        let told = field.shape.told(field.name);
        Property { name, about: field.about.clone(), told, shape: field.shape.clone(), value, origin }
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
