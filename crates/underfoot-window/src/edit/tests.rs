//! Random edits of whole layouts: unrelated bytes stay, and steps can be undone and redone.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::*;
use underfoot::floor::{Floor, Rect};
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts};

pub(super) fn open(name: &str, text: &str) -> Document {
    let (kinds, floor) = (Arc::new(Kinds::builtin()), Arc::new(Floor::default()));
    Document::read(name, text, &kinds, &floor).unwrap_or_else(|problems| panic!("{text}\n{problems}"))
}

pub(super) fn shipped() -> impl Iterator<Item = Document> {
    builtin_layouts().map(|name| open(name, builtin_layout(name).unwrap()))
}

const KINDS: [&str; 6] = ["button", "switch", "slider", "hold", "stepper", "round_button"];

/// A valid layout in an unusual style: comments anywhere, any line breaks, groups, grids and pages.
pub(super) fn random_layout(rng: &mut Pcg32) -> String {
    let mut places: Vec<(u32, u32)> = (0..6).flat_map(|x| (0..6).map(move |y| (x, y))).collect();
    let mut next = 0;
    let line_break = if rng.random_bool(0.2) { "\r\n" } else { "\n" };
    let gap = |rng: &mut Pcg32| match rng.random_range(0..7) {
        0 => " /* (a, [b) \"c */ ".to_owned(),
        1 => format!(" // left: (1, \"2]{line_break}  "),
        2 => format!("{line_break}        "),
        3 => format!("{line_break}{line_break}    // Zoom für Füße{line_break}    "),
        _ => " ".to_owned(),
    };
    let mut control = |rng: &mut Pcg32, number: usize| {
        let index = rng.random_range(0..places.len());
        let (x, y) = places.swap_remove(index);
        next += 1;
        let kind = KINDS[rng.random_range(0..KINDS.len())];
        let (east, north) = (f64::from(x) + 0.1, f64::from(y) + 0.15);
        let mut fields = vec![
            format!("id: \"c{number}_{next}\""),
            format!("kind: \"{kind}\""),
            format!("at: ({east:.2},{} {north})", gap(rng)),
            "size: (0.7, 0.6)".to_owned(),
        ];
        if rng.random_bool(0.7) {
            fields.push(format!("label: \"L {next} (x)\""));
        }
        if rng.random_bool(0.3) {
            fields.push(format!("look: (face: \"#102030\",{}ink: \"#ffeedd\")", gap(rng)));
        }
        if rng.random_bool(0.3) {
            fields.push("press_n: 80, release_n: 50".to_owned());
        }
        let joined: String = fields.iter().map(|field| format!("{}{field},", gap(rng))).collect();
        let joined = if rng.random_bool(0.5) { joined.trim_end_matches(',').to_owned() } else { joined };
        format!("({joined}{})", gap(rng))
    };
    let mut entries = |rng: &mut Pcg32, count: usize, number: usize| -> String {
        let mut list = String::from("[");
        for index in 0..count {
            list.push_str(&gap(rng));
            list.push_str(&control(rng, number));
            if index + 1 < count || rng.random_bool(0.5) {
                list.push(',');
            }
        }
        list.push_str(&gap(rng));
        list.push(']');
        list
    };
    let mut text = String::from(if rng.random_bool(0.1) { "\u{feff}" } else { "" });
    text.push_str(&format!("// Made by chance.{line_break}Layout({}version: 1,", gap(rng)));
    text.push_str(&format!("{}regions: [(id: \"all\", at: (0, 0), size: (6, 6))],", gap(rng)));
    let count = rng.random_range(1..7);
    text.push_str(&format!("{}widgets: {},", gap(rng), entries(rng, count, 0)));
    if rng.random_bool(0.3) {
        text.push_str(&format!("{}grounds: [Snow,{}Ice(at: (1, 1), size: (2, 2))],", gap(rng), gap(rng)));
    }
    if rng.random_bool(0.4) {
        text.push_str(&format!(
            "{}pages: [(id: \"one\",{}widgets: {}),",
            gap(rng),
            gap(rng),
            entries(rng, 2, 1)
        ));
        text.push_str(&format!("{}(id: \"two\", widgets: {})]", gap(rng), entries(rng, 1, 2)));
    }
    text.push_str(&format!("{}){line_break}// The end.", gap(rng)));
    text
}

/// The bytes of the lines that `span` touches.
fn lines(text: &str, span: &Range<usize>) -> Range<usize> {
    let start = text[..span.start].rfind('\n').map_or(0, |at| at + 1);
    start..text[span.end..].find('\n').map_or(text.len(), |at| span.end + at + 1)
}

/// Edits of one record, and the bytes of the text that they may change.
fn random_edit(rng: &mut Pcg32, document: &Document) -> Option<(Vec<Edit>, Range<usize>)> {
    let items = document.items();
    let controls: Vec<&Item> = items
        .iter()
        .filter(|item| item.record.list() == Some(RecordList::Widgets) && !item.is_group)
        .collect();
    let item = *controls.get(rng.random_range(0..controls.len().max(1)))?;
    let record = &item.record;
    let own = lines(document.text(), &document.span(record)?);
    let (parent, list, index) = record.split()?;
    let whole = |document: &Document| {
        let siblings = items
            .iter()
            .filter(|other| other.record.split().is_some_and(|it| it.0 == parent && it.1 == list));
        let spans = siblings
            .filter_map(|other| document.span(&other.record))
            .map(|span| lines(document.text(), &span));
        spans.reduce(|all, one| all.start.min(one.start)..all.end.max(one.end))
    };
    let mut by = || Vec2::new(rng.random_range(-0.02..0.02), rng.random_range(-0.02..0.02));
    let (by, grow) = (by(), by());
    let edits = match rng.random_range(0..12) {
        0..3 => document.placing(&[(item, Rect::new(item.area.min + by, item.area.max + by))]).ok()?,
        3 => document.placing(&[(item, Rect::new(item.area.min, item.area.max + grow))]).ok()?,
        4 => vec![Edit::set(record, "label", format!("\"n{}\"", rng.random_range(0..99)))],
        5 => vec![Edit::set(record, "look.ink", "\"#123456\"")],
        6 => vec![Edit::set(record, "press_n", rng.random_range(70..90).to_string())],
        7 => vec![Edit::unset(record, ["label", "look.ink", "look", "press_n"][rng.random_range(0..4)])],
        8 => {
            let id = document.free_id("renamed_1", &[]);
            vec![Edit::Rename { record: record.clone(), id }]
        }
        9 if controls.len() > 1 => document.deleting(std::slice::from_ref(record)),
        10 => {
            let to = rng.random_range(0..=index + 1);
            // The comments above records move with them.
            let parent = document.span(&parent)?;
            return Some((vec![Edit::Reorder { record: record.clone(), to }], parent));
        }
        _ if controls.len() < 40 => {
            let by = Vec2::new(rng.random_range(-1.5..1.5), rng.random_range(-1.5..1.5));
            return Some((document.duplicating(std::slice::from_ref(record), by).ok()?.0, whole(document)?));
        }
        _ => return None,
    };
    Some((edits, own))
}

fn comments(text: &str) -> usize {
    text.matches("//").count() + text.matches("/*").count()
}

#[test]
fn every_layout_keeps_its_bytes_and_one_edit_changes_the_lines_of_its_record_only() {
    let mut rng = Pcg32::seed_from_u64(20);
    let (mut done, mut refused) = (0, 0);
    let texts: Vec<String> = (0..1000).map(|_| random_layout(&mut rng)).collect();
    let shipped: Vec<String> = shipped().map(|document| document.file_text()).collect();
    for text in shipped.iter().chain(&texts) {
        let mut document = open("it.ron", text);
        assert_eq!(document.file_text(), *text);
        let before = document.text().to_owned();
        let Some((edits, own)) = random_edit(&mut rng, &document) else { continue };
        if let Err(refusal) = document.edit(&edits) {
            assert!(matches!(refusal, EditRefusal::Unreadable(_)), "{edits:?}: {refusal}\n{before}");
            assert_eq!(document.text(), before, "refused is not changed");
            refused += 1;
            continue;
        }
        let after = document.text();
        let (head, tail) = (&before[..own.start], &before[own.end..]);
        assert!(
            after.starts_with(head) && after.ends_with(tail),
            "{edits:?}\n--- before\n{before}\n--- after\n{after}"
        );
        let is_deleted = matches!(edits[..], [Edit::Delete { .. }, ..])
            || edits.iter().any(|edit| matches!(edit, Edit::Unset { .. } | Edit::Insert { .. }));
        assert!(is_deleted || comments(after) == comments(&before), "{edits:?}\n{before}\n{after}");
        done += 1;
    }
    assert!(done > 600 && refused < 350, "{done} done, {refused} refused");
}

/// Makes `count` random edits, drags and typed changes, undoes all of them and redoes them.
fn undone_and_redone(count: usize) {
    let mut rng = Pcg32::seed_from_u64(count as u64);
    let mut document = open("map", builtin_layout("map").unwrap());
    let first = document.text().to_owned();
    let (mut done, mut stroke) = (0, 0);
    while done < count {
        match rng.random_range(0..20) {
            0 => drop(document.undo().unwrap()),
            1 => drop(document.redo().unwrap()),
            _ => {
                stroke += u64::from(rng.random_bool(0.6));
                let Some((edits, _)) = random_edit(&mut rng, &document) else { continue };
                if document.edit_in(&edits, Some(stroke)).is_err() {
                    continue;
                }
            }
        }
        done += 1;
    }
    while document.redo().unwrap() {}
    let last = document.text().to_owned();
    let layout = document.layout().clone();
    assert_ne!(first, last);
    let mut steps = 0;
    while document.undo().unwrap() {
        steps += 1;
    }
    assert!(steps > count / 3, "{steps} steps of {count}");
    assert_eq!(document.text(), first);
    while document.redo().unwrap() {}
    assert_eq!(document.text(), last);
    assert_eq!(*document.layout(), layout);
}

#[test]
fn edits_are_taken_back_to_the_first_byte_and_done_again_to_the_last() {
    undone_and_redone(10_000);
}

#[test]
fn a_drag_is_one_step() {
    let mut document = open("map", builtin_layout("map").unwrap());
    let first = document.text().to_owned();
    for _ in 0..30 {
        let items = document.items();
        let home = items.iter().find(|item| item.name == "home").unwrap();
        let by = Vec2::new(0.001, 0.001);
        let edits = document.placing(&[(home, Rect::new(home.area.min + by, home.area.max + by))]).unwrap();
        document.edit_in(&edits, Some(1)).unwrap();
    }
    assert_ne!(document.text(), first);
    assert!(document.undo().unwrap());
    assert_eq!(document.text(), first);
    assert!(!document.can_undo() && document.can_redo());
}

#[test]
fn what_could_not_be_used_is_refused_in_the_readers_words() {
    let mut document = open("map", builtin_layout("map").unwrap());
    let home = document.items().into_iter().find(|item| item.name == "home").unwrap();
    let over = Rect::from_min_size(Vec2::new(0.5, 0.8), home.area.size());
    let refusal = document.placing(&[(&home, over)]).and_then(|edits| document.edit(&edits)).unwrap_err();
    assert!(refusal.short().contains("overlaps"), "{}", refusal.short());
    let refusal = document.edit(&[Edit::set(&home.record, "press_n", "\"hard\"")]).unwrap_err();
    assert_eq!(refusal.short(), "`press_n` must be a number: expected a number, found text");
    assert!(!document.can_undo());
    assert_eq!(
        document.edit(&[Edit::Delete { record: Address::LAYOUT }]),
        Err(EditRefusal::Missing(Address::LAYOUT))
    );
    let text = "5".to_owned();
    let edit = Edit::Insert { at: Address::of(RecordList::Widgets, 0), text };
    assert_eq!(document.edit(&[edit]), Err(EditRefusal::NotARecord));
}

#[test]
fn an_id_is_renamed_where_neighbours_and_buttons_refer_to_it() {
    let text = "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
        (id: \"a\", kind: \"button\", at: (1, 1), size: (0.6, 0.6), goto: \"p\"), // a
        (id: \"b\", kind: \"button\", right_of: \"a\", gap: 0.2),
    ], pages: [(id: \"p\"), (id: \"q\")])";
    let mut document = open("it", text);
    document.edit(&[Edit::Rename { record: Address::of(RecordList::Widgets, 0), id: "z".into() }]).unwrap();
    document.edit(&[Edit::Rename { record: Address::of(RecordList::Pages, 0), id: "front".into() }]).unwrap();
    let expected = text.replace("\"a\"", "\"z\"").replace("\"p\"", "\"front\"");
    assert_eq!(document.text(), expected);

    // After a move it has a place of its own, and keeps the size that it had from its neighbour.
    let items = document.items();
    let b = items.iter().find(|item| item.name == "b").unwrap();
    let by = Vec2::new(0.152, 0.0);
    let edits = document.placing(&[(b, Rect::new(b.area.min + by, b.area.max + by))]).unwrap();
    document.edit(&edits).unwrap();
    let moved = "(id: \"b\", kind: \"button\", at: (2.3, 1), size: (0.6, 0.6)),";
    assert!(document.text().contains(moved), "{}", document.text());
}

#[test]
fn copies_get_ids_of_their_own_and_stand_where_they_are_put() {
    let mut document = open("surgical", builtin_layout("surgical").unwrap());
    let capture = document.items().into_iter().find(|item| item.name == "capture").unwrap();
    let text = document.copy(std::slice::from_ref(&capture.record));
    assert_eq!(
        text,
        "(id: \"capture\", kind: \"heavy_button\", at: (3.15, 2.9), size: (0.85, 0.5), label: \"Capture\",\n    \
         look: (face: \"#efe4d2\", lit: \"#e3a857\", ink: \"#33260f\")),\n"
    );
    let by = Vec2::new(0.304, 0.0);
    let (edits, places) = document.pasting(&text, &Address::LAYOUT, RecordList::Widgets, by).unwrap();
    document.edit(&edits).unwrap();
    assert_eq!(places, [Address::of(RecordList::Widgets, 5)]);
    let written = "        (id: \"capture_2\", kind: \"heavy_button\", at: (4.15, 2.9), size: (0.85, 0.5), \
                   label: \"Capture\",\n            look: (face:";
    assert!(document.text().contains(written), "{}", document.text());
    document.edit(&document.deleting(&places)).unwrap();
    assert_eq!(document.text(), builtin_layout("surgical").unwrap());
    assert_eq!(
        document.pasting("5", &Address::LAYOUT, RecordList::Widgets, by),
        Err(EditRefusal::NotARecord)
    );
}

#[test]
fn a_quarter_turn_makes_a_slider_upright_within_its_region() {
    let mut document = open("map", builtin_layout("map").unwrap());
    let zoom = document.items().into_iter().find(|item| item.name == "zoom").unwrap();
    document.edit(&document.turning(&[&zoom]).unwrap()).unwrap();
    let line = document.text().lines().find(|line| line.contains("zoom")).unwrap().trim();
    assert_eq!(
        line,
        "(id: \"zoom\", kind: \"slider\", at: (4.875, 2), size: (0.6, 1.35), label: \"Zoom\", initial: 0.3, axis: North),"
    );
}

#[test]
fn a_ground_without_a_place_gets_one_when_it_is_resized() {
    let mut document = open("pond", builtin_layout("pond").unwrap());
    let ice = document.items().into_iter().find(|item| item.name == "Ice").unwrap();
    let half = Rect::new(ice.area.min, ice.area.max - Vec2::new(0.912, 0.0));
    document.edit(&document.placing(&[(&ice, half)]).unwrap()).unwrap();
    assert!(
        document.text().contains("            at: (0, 0),\n            size: (3, 6),\n        ),"),
        "{}",
        document.text()
    );
}
