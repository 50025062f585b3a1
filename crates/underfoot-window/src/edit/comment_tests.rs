//! All edits that move a record keep its comments.

use std::sync::Arc;

use glam::Vec2;
use proptest::prelude::*;

use super::splice::comments;
use super::{Address, Document, Edit, Item, RecordList, grouping, ungrouping};
use underfoot::floor::Floor;
use underfoot::schema::Kinds;

/// A control and the comments around it in the text.
#[derive(Clone, Debug)]
struct Written {
    above: Vec<String>,
    has_gap: bool,
    owns_line: bool,
    before_comma: bool,
    behind: bool,
}

fn written() -> impl Strategy<Value = Written> {
    let comment = prop_oneof!["// [a-z]{3}", "/\\* [a-z]{3} \\*/", "/\\* [a-z]{3}\n         [a-z]{3} \\*/"];
    (prop::collection::vec(comment, 0..3), any::<[bool; 4]>()).prop_map(|(above, flags)| {
        let [has_gap, owns_line, before_comma, behind] = flags;
        Written { above, has_gap, owns_line, before_comma, behind }
    })
}

/// A layout of such controls, side by side.
fn layout(controls: &[Written]) -> String {
    let mut text = String::from(
        "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [ // all\n",
    );
    for (number, one) in controls.iter().enumerate() {
        for line in &one.above {
            text.push_str(&format!("    {line}\n"));
        }
        if one.has_gap {
            text.push('\n');
        }
        let east = number % 5;
        let north = number / 5;
        text.push_str(&format!("    (id: \"c{number}\", kind: \"button\", at: ({east}, {north}), size: (0.6, 0.6), /* in */ label: \"C\")"));
        text.push_str(if one.before_comma { " /* close */," } else { "," });
        text.push_str(if one.behind { " /* behind */" } else { "" });
        text.push_str(if one.owns_line { " // end\n" } else { "" });
    }
    text.push_str("\n    // last\n])\n");
    text
}

fn open(text: &str) -> Document {
    Document::read("it", text, &Arc::new(Kinds::builtin()), &Arc::new(Floor::default())).unwrap()
}

/// The words of all comments, in alphabetical order.
fn words(document: &Document) -> Vec<String> {
    let all = comments(document.text()).join(" ");
    let words = all.split(|letter: char| letter.is_whitespace() || "/*".contains(letter));
    let mut words: Vec<String> = words.filter(|word| !word.is_empty()).map(str::to_owned).collect();
    words.sort_unstable();
    words
}

/// The areas on the floor, by id.
fn placed(document: &Document) -> Vec<(String, [i32; 4])> {
    let round = |at: Vec2| [at.x, at.y].map(|part| (1000.0 * part).round() as i32);
    let widgets = document.layout().widgets.iter();
    let mut all: Vec<_> = widgets
        .map(|one| {
            let ([west, south], [east, north]) = (round(one.area.min), round(one.area.max));
            (one.id.to_string(), [west, south, east, north])
        })
        .collect();
    all.sort();
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn grouping_reordering_and_cutting_keep_every_comment(
        controls in prop::collection::vec(written(), 2..6),
        chosen in any::<[bool; 6]>(),
        to in 0..6_usize,
    ) {
        let mut document = open(&layout(&controls));
        let (said, shown) = (words(&document), placed(&document));
        let is_chosen = |index: usize| chosen[index % 6];
        let records: Vec<Address> =
            (0..controls.len()).filter(|index| is_chosen(*index)).map(|index| Address::of(RecordList::Widgets, index)).collect();
        prop_assume!(!records.is_empty());

        let items = document.items();
        let members: Vec<&Item> = items.iter().filter(|item| records.contains(&item.record)).collect();
        let (edits, group) = grouping(&document, &members).unwrap();
        document.edit(&edits).unwrap();
        prop_assert_eq!(words(&document), said.clone(), "grouped: {}", document.text());
        prop_assert_eq!(placed(&document), shown.clone());

        let items = document.items();
        let group = items.iter().find(|item| item.record == group).unwrap();
        let (edits, _) = ungrouping(&document, &items, group).unwrap();
        document.edit(&edits).unwrap();
        prop_assert_eq!(words(&document), said.clone(), "apart again: {}", document.text());
        prop_assert_eq!(placed(&document), shown.clone());

        document.edit(&[Edit::Reorder { record: Address::of(RecordList::Widgets, 0), to }]).unwrap();
        prop_assert_eq!(words(&document), said.clone(), "in another order: {}", document.text());

        let copied = document.copy(&records);
        let edits = document.taking(&records);
        // A layout must have at least one control.
        if document.edit(&edits).is_ok() {
            let (edits, _) = document.pasting_on(&copied, 0, Vec2::ZERO).unwrap();
            document.edit(&edits).unwrap();
            prop_assert_eq!(words(&document), said, "cut and pasted: {}", document.text());
            prop_assert_eq!(placed(&document), shown);
        }
    }
}

#[test]
fn comments_directly_above_go_with_their_control_into_a_group_and_others_stay() {
    let mut document = open(
        "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
    // About all of this.

    // Home brings the map back.
    // It is pressed seldom.
    (id: \"a\", kind: \"button\", at: (1, 1), size: (0.6, 0.6)), // a
    (id: \"b\", kind: \"button\", at: (2, 1), size: (0.6, 0.6)),
    /* Zoom
       is a slider elsewhere. */
    (id: \"c\", kind: \"button\", at: (3, 1), size: (0.6, 0.6)),
])",
    );
    let items = document.items();
    let chosen: Vec<&Item> = items.iter().filter(|item| ["a", "c"].contains(&item.name.as_str())).collect();
    let (edits, _) = grouping(&document, &chosen).unwrap();
    document.edit(&edits).unwrap();
    let wanted = "widgets: [
    // About all of this.

    Group(id: \"group_1\", at: (1, 1), widgets: [
        // Home brings the map back.
        // It is pressed seldom.
        (id: \"a\", kind: \"button\", at: (0, 0), size: (0.6, 0.6)), // a
        /* Zoom
           is a slider elsewhere. */
        (id: \"c\", kind: \"button\", at: (2, 0), size: (0.6, 0.6)),
    ]),
    (id: \"b\", kind: \"button\", at: (2, 1), size: (0.6, 0.6)),
])";
    assert!(document.text().ends_with(wanted), "{}", document.text());
}

#[test]
fn comments_of_a_group_are_kept_when_it_comes_apart() {
    let mut document = open(
        "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
    // The pair.
    Group(
        id: \"g\", // its name
        at: (1, 1),
        widgets: [
            // left
            (id: \"a\", kind: \"button\", at: (0, 0), size: (0.6, 0.6)), // a

            // nobody's
        ],
    ), // end
])",
    );
    let items = document.items();
    let group = items.iter().find(|item| item.is_group).unwrap();
    let (edits, _) = ungrouping(&document, &items, group).unwrap();
    document.edit(&edits).unwrap();
    for comment in ["// The pair.", "its name", "// left", "// a", "nobody's", "end"] {
        assert_eq!(document.text().matches(comment).count(), 1, "{comment}: {}", document.text());
    }
}
