//! The OSC addresses of a layout as a tree of OSCQuery nodes.

use std::collections::BTreeMap;

use rosc::OscType;
use serde_json::{Map, Value, json};
use underfoot::layout::Layout;
use underfoot::serve::{AddressEntry, Argument, ArgumentLimits, MessageDirection, Reference};

use super::values::CurrentValues;

/// The attributes of a node that a client may ask for, besides `HOST_INFO`.
const ATTRIBUTES: [&str; 9] =
    ["FULL_PATH", "CONTENTS", "DESCRIPTION", "ACCESS", "TYPE", "VALUE", "RANGE", "UNIT", "TAGS"];

/// The result of a request for one attribute.
#[derive(Debug, PartialEq)]
pub(super) enum Attribute {
    /// No server has an attribute of this name.
    Unknown,
    /// The node has no such attribute now.
    Absent,
    Present(Value),
}

/// One address, or a part of addresses.
#[derive(Debug, Default)]
pub(super) struct QueryNode {
    path: String,
    description: Option<String>,
    /// 1 for addresses that the floor sends, 2 for those that it receives, 3 for both, 0 for a container.
    access: u8,
    arguments: Vec<Argument>,
    contents: BTreeMap<String, Self>,
}

impl QueryNode {
    /// The tree of all addresses of `reference`, except those in `left_out`; controls have the labels of `layout`.
    pub(super) fn tree(reference: &Reference, layout: &Layout, left_out: impl Fn(&str) -> bool) -> Self {
        let mut root = Self { path: "/".into(), ..Self::default() };
        let with_address = |entry: &&AddressEntry| entry.direction != MessageDirection::Target;
        for entry in reference.entries.iter().filter(with_address) {
            if !left_out(&entry.address) {
                root.at(&entry.address).add(entry);
            }
        }
        for widget in &layout.widgets {
            let ending = format!("/widget/{}", widget.id);
            root.each(&mut |node| {
                if node.path.ends_with(&ending) && node.access == 0 {
                    node.description = Some(format!("{} ({})", widget.label, widget.kind));
                }
            });
        }
        root
    }

    /// The node at `path`, which is made if it is missing.
    fn at(&mut self, path: &str) -> &mut Self {
        let mut node = self;
        for part in path.split('/').filter(|part| !part.is_empty()) {
            let path = format!("{}/{part}", node.path.trim_end_matches('/'));
            node = node.contents.entry(part.to_owned()).or_insert_with(|| Self { path, ..Self::default() });
        }
        node
    }

    fn add(&mut self, entry: &AddressEntry) {
        self.access |= if entry.direction == MessageDirection::In { 2 } else { 1 };
        if self.description.is_none() {
            self.description = Some(entry.says.clone());
            self.arguments.clone_from(&entry.arguments);
        }
    }

    fn each(&mut self, see: &mut impl FnMut(&mut Self)) {
        see(self);
        self.contents.values_mut().for_each(|node| node.each(see));
    }

    /// The node at `path`, if there is one.
    pub(super) fn find(&self, path: &str) -> Option<&Self> {
        path.split('/').filter(|part| !part.is_empty()).try_fold(self, |node, part| node.contents.get(part))
    }

    /// Whether the floor sends messages of this address.
    pub(super) fn is_sent(&self) -> bool {
        self.access & 1 != 0
    }

    /// The node with all its contents.
    pub(super) fn json(&self, values: &CurrentValues) -> Value {
        let attributes = ATTRIBUTES.iter().filter_map(|name| match self.attribute(name, values) {
            Attribute::Present(value) => Some(((*name).to_owned(), value)),
            Attribute::Absent | Attribute::Unknown => None,
        });
        Value::Object(attributes.collect())
    }

    /// One attribute of the node.
    pub(super) fn attribute(&self, name: &str, values: &CurrentValues) -> Attribute {
        let value = values.of(&self.path).filter(|_| self.is_sent());
        let found = match name {
            "FULL_PATH" => Some(json!(self.path)),
            "CONTENTS" => (!self.contents.is_empty()).then(|| {
                let contents = self.contents.iter();
                contents.map(|(name, node)| (name.clone(), node.json(values))).collect::<Map<_, _>>().into()
            }),
            "DESCRIPTION" => self.description.as_ref().map(|text| json!(text)),
            "ACCESS" => Some(json!(self.access)),
            "TYPE" => (self.access > 0).then(|| json!(self.types(value))),
            "VALUE" => value.map(|args| args.iter().map(json_of).collect()),
            "RANGE" => self.each_argument(value, range_of),
            "UNIT" => self.each_argument(value, unit_of),
            "TAGS" => (self.access == 0 && self.path.contains("/widget/")).then(|| json!(["control"])),
            _ => return Attribute::Unknown,
        };
        found.map_or(Attribute::Absent, Attribute::Present)
    }

    /// The type tags: those of the value, if there is one.
    fn types(&self, value: Option<&[OscType]>) -> String {
        match value {
            Some(args) => args.iter().map(tag_of).collect(),
            None => self.arguments.iter().filter_map(|argument| argument.tag.chars().next()).collect(),
        }
    }

    /// An attribute with one entry for each type tag, null for one that has none; absent if all are null.
    fn each_argument(
        &self,
        value: Option<&[OscType]>,
        entry: impl Fn(&Argument) -> Option<Value>,
    ) -> Option<Value> {
        let count = value.map_or(self.arguments.len(), <[OscType]>::len);
        let entries: Vec<Value> = (0..count)
            .map(|number| self.arguments.get(number).and_then(&entry).unwrap_or_default())
            .collect();
        entries.iter().any(|entry| !entry.is_null()).then(|| entries.into())
    }
}

fn range_of(argument: &Argument) -> Option<Value> {
    let whole = argument.tag.starts_with('i');
    let number = |number: f64| if whole { json!(number as i64) } else { json!(number) };
    match &argument.limits {
        ArgumentLimits::Open => None,
        ArgumentLimits::Numbers { least, greatest } => {
            Some(json!({"MIN": number(*least), "MAX": number(*greatest)}))
        }
        ArgumentLimits::Words(words) => Some(json!({"VALS": words})),
    }
}

/// The unit, by the proposal's own names where it has one.
fn unit_of(argument: &Argument) -> Option<Value> {
    match argument.unit {
        "" => None,
        "m" => Some(json!("distance.m")),
        "m/s" => Some(json!("speed.m/s")),
        "s" => Some(json!("time.second")),
        other => Some(json!(other)),
    }
}

fn tag_of(arg: &OscType) -> char {
    match arg {
        OscType::Int(_) => 'i',
        OscType::Float(_) => 'f',
        OscType::String(_) => 's',
        // Floors send no others.
        _ => 'N',
    }
}

fn json_of(arg: &OscType) -> Value {
    match arg {
        OscType::Int(number) => json!(number),
        // The number of the text: 0.1 is 0.1, not the nearest single-precision number.
        OscType::Float(number) => {
            number.to_string().parse::<f64>().map_or(Value::Null, |number| json!(number))
        }
        OscType::String(text) => json!(text),
        _ => Value::Null,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use underfoot::engine::{Engine, Snapshot};
    use underfoot::floor::{Floor, Geometry};
    use underfoot::schema::{Kinds, builtin_layout, parse_layout};
    use underfoot::sense::Method;
    use underfoot::wire::Prefix;

    use super::*;

    /// The shipped page of the map, with all values at their start.
    fn map() -> (QueryNode, CurrentValues) {
        let geometry = Geometry::default();
        let text = builtin_layout("map").unwrap();
        let layout = parse_layout(text, "map", &Kinds::builtin(), &geometry).unwrap().layout;
        let (floor, prefix) = (Floor::of(geometry), Prefix::default());
        let reference = Reference::of(&layout, &floor, &prefix);
        let left_out = |address: &str| floor.boards.iter().any(|board| board.address == address);
        let mut snapshot = Snapshot::default();
        Engine::new(geometry, layout.clone(), Method::default()).snapshot(&mut snapshot);
        let values = CurrentValues::of_floor(&layout, &snapshot, &prefix);
        (QueryNode::tree(&reference, &layout, left_out), values)
    }

    fn attribute(path: &str, name: &str) -> Attribute {
        let (root, values) = map();
        root.find(path).unwrap().attribute(name, &values)
    }

    #[test]
    fn a_slider_has_a_value_a_range_and_a_type() {
        let value = "/underfoot/widget/zoom/value";
        assert_eq!(attribute(value, "TYPE"), Attribute::Present(json!("f")));
        assert_eq!(attribute(value, "VALUE"), Attribute::Present(json!([0.3])));
        assert_eq!(attribute(value, "ACCESS"), Attribute::Present(json!(1)));
        assert_eq!(attribute(value, "RANGE"), Attribute::Present(json!([{"MIN": 0.0, "MAX": 1.0}])));
        assert_eq!(attribute("/underfoot/widget/zoom/set", "ACCESS"), Attribute::Present(json!(2)));
    }

    #[test]
    fn an_address_that_only_receives_has_no_value_and_an_unknown_attribute_is_told_apart() {
        assert_eq!(attribute("/underfoot/widget/zoom/set", "VALUE"), Attribute::Absent);
        assert_eq!(attribute("/underfoot/widget/home/clicked", "VALUE"), Attribute::Absent);
        assert_eq!(attribute("/underfoot/widget/zoom/set", "COLOUR"), Attribute::Unknown);
        assert!(map().0.find("/underfoot/widget/nobody").is_none());
    }

    #[test]
    fn the_force_and_the_place_of_an_event_have_units() {
        let units = json!(["N", "distance.m", "distance.m"]);
        assert_eq!(attribute("/underfoot/widget/home/clicked", "UNIT"), Attribute::Present(units));
        assert_eq!(attribute("/underfoot/widget/home/clicked", "TYPE"), Attribute::Present(json!("fff")));
    }

    #[test]
    fn the_lists_of_a_node_are_as_long_as_its_types() {
        let (mut root, values) = map();
        root.each(&mut |node| {
            let Attribute::Present(Value::String(types)) = node.attribute("TYPE", &values) else { return };
            for name in ["VALUE", "RANGE", "UNIT"] {
                if let Attribute::Present(Value::Array(list)) = node.attribute(name, &values) {
                    assert_eq!(list.len(), types.len(), "{} of {}", name, node.path);
                }
            }
        });
    }

    #[test]
    fn boards_are_no_part_of_the_tree() {
        let (mut root, values) = map();
        let mut paths = Vec::new();
        root.each(&mut |node| paths.push(node.path.clone()));
        assert!(paths.iter().all(|path| path == "/" || path.starts_with("/underfoot")), "{paths:?}");
        assert!(paths.iter().all(|path| !path.contains("board")), "{paths:?}");
        assert_eq!(root.json(&values)["FULL_PATH"], "/");
    }
}
