//! Every edit that design tools have is one step, and undo returns the bytes.

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::splice::comments;
use super::tests::{open, random_layout, shipped};
use super::*;

/// A random edit of two records; `None` if it does not apply to them.
fn random_change(rng: &mut Pcg32, document: &Document) -> Option<Vec<Edit>> {
    let items = document.items();
    let controls: Vec<&Item> =
        items.iter().filter(|item| item.record.list() == Some(RecordList::Widgets)).collect();
    let (one, other) = (
        *controls.get(rng.random_range(0..controls.len().max(1)))?,
        *controls.get(rng.random_range(0..controls.len().max(1)))?,
    );
    let by = Vec2::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
    let records = [one.record.clone(), other.record.clone()];
    let facet = if rng.random_bool(0.5) { Facet::Appearance } else { Facet::Feel };
    match rng.random_range(0..5) {
        0 => Some(document.duplicating(&records[..1 + usize::from(one != other)], by).ok()?.0),
        1 => facet_edits(document, facet, &document.copy(&records[..1]), &[other]).ok(),
        2 => {
            let number = PlaceNumber::ALL[rng.random_range(0..4)];
            let change = TypedChange::By(rng.random_range(-0.1..0.1));
            changing(document, &[one, other], number, change).ok()
        }
        3 => {
            let id = document.free_id("renamed", &[]);
            document.id_of(&one.record)?;
            Some(vec![Edit::Rename { record: one.record.clone(), id }])
        }
        _ => {
            let finding = document.findings().into_iter().next()?;
            Some(mend(document, &finding, &items)?.edits)
        }
    }
}

#[test]
fn every_change_is_undone_to_the_byte_and_keeps_the_comments() {
    let mut rng = Pcg32::seed_from_u64(41);
    let texts: Vec<String> = shipped()
        .map(|document| document.file_text())
        .chain((0..400).map(|seed| random_layout(&mut Pcg32::seed_from_u64(seed))))
        .collect();
    let mut done = 0;
    for text in &texts {
        let mut document = open("it.ron", text);
        for _ in 0..4 {
            let before = document.text().to_owned();
            let Some(edits) = random_change(&mut rng, &document) else { continue };
            if document.edit(&edits).is_err() {
                assert_eq!(document.text(), before, "refused is not changed");
                continue;
            }
            let after = document.text().to_owned();
            let is_removed = edits.iter().any(|edit| matches!(edit, Edit::Unset { .. }));
            assert!(is_removed || comments(&after).len() >= comments(&before).len(), "{edits:?}\n{before}");
            if after == before {
                continue;
            }
            assert!(document.undo().unwrap());
            assert_eq!(document.text(), before, "{edits:?}");
            assert!(document.redo().unwrap());
            assert_eq!(document.text(), after, "{edits:?}");
            done += 1;
        }
        while document.undo().unwrap() {}
        assert_eq!(document.file_text(), *text);
    }
    assert!(done > 300, "{done}");
}

#[test]
fn a_control_beside_its_neighbour_is_copied_to_a_place_of_its_own_and_with_it_beside_the_copy() {
    let text = "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
        (id: \"a\", kind: \"button\", at: (1, 1), size: (0.6, 0.6)), // a
        (id: \"b\", kind: \"button\", right_of: \"a\", gap: 0.2),
    ])";
    let mut document = open("it", text);
    let records = [0, 1].map(|index| Address::of(RecordList::Widgets, index));
    let by = Vec2::new(0.0, 0.608);
    let (edits, _) = document.duplicating(&records[1..], by).unwrap();
    document.edit(&edits).unwrap();
    let alone = "(id: \"b_2\", kind: \"button\", at: (1.8, 3), size: (0.6, 0.6)),";
    assert!(document.text().contains(alone), "{}", document.text());
    document.undo().unwrap();
    let (edits, _) = document.duplicating(&records, by).unwrap();
    document.edit(&edits).unwrap();
    assert!(document.text().contains("(id: \"b_2\", kind: \"button\", right_of: \"a_2\", gap: 0.2),"));
    document.undo().unwrap();
    assert_eq!(document.text(), text);
}

#[test]
fn the_cells_of_a_renamed_grid_are_followed_where_they_are_neighbours() {
    let text = "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
        (id: \"key_{n}\", kind: \"button\", at: (1, 1), size: (0.5, 0.5), repeat: (columns: 3, gap: 0.2)), // keys
        (id: \"b\", kind: \"button\", above: \"key_3\", gap: 0.2), /* above */
    ])";
    let mut document = open("it", text);
    let record = Address::of(RecordList::Widgets, 0);
    document.edit(&[Edit::Rename { record, id: "digit_{n}".into() }]).unwrap();
    assert_eq!(document.text(), text.replace("key_", "digit_"));
    document.undo().unwrap();
    assert_eq!(document.text(), text);
}
