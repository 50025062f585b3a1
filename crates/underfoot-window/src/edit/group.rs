//! Moves records into a group and out of it; their areas on the floor stay.

use glam::DVec2;

use super::address::{Address, RecordList, list_of};
use super::change::{Edit, quoted};
use super::document::Document;
use super::item::Item;
use super::place::{RELATIVE, pair};
use super::refusal::EditRefusal;
use super::splice::{LayoutLines, RecordText, comments, spliced};
use underfoot_format::outline::Outline;

/// The edits that make one group of `items`, and its address: it replaces the first of them, and its place is
/// their south-west corner.
///
/// # Errors
/// [`EditRefusal::Apart`] for records of several lists, or that are not controls; [`EditRefusal::PlacedByGroup`] as
/// [`Document::placing`].
pub fn grouping(document: &Document, items: &[&Item]) -> Result<(Vec<Edit>, Address), EditRefusal> {
    let mut items: Vec<&Item> = items.to_vec();
    items.sort_by(|a, b| a.record.cmp(&b.record));
    let home = items.first().and_then(|item| item.record.split()).ok_or(EditRefusal::Apart)?;
    let is_here = |item: &&Item| item.record.split().is_some_and(|it| (&it.0, it.1) == (&home.0, home.1));
    if home.1 != RecordList::Widgets || !items.iter().all(is_here) {
        return Err(EditRefusal::Apart);
    }
    let places: Vec<DVec2> = items.iter().map(|item| place_of(document, item)).collect::<Result<_, _>>()?;
    let corner = places.iter().copied().reduce(DVec2::min).unwrap_or_default();
    let mut text = format!(
        "Group(id: {}, at: {}, widgets: [\n",
        quoted(&document.free_id("group_1", &[])),
        pair(corner).inline()
    );
    for (item, place) in items.iter().zip(&places) {
        text.push_str(&placed_piece(document, item, *place - corner)?.listed("    "));
    }
    text.push_str("])");
    let records: Vec<Address> = items.iter().map(|item| item.record.clone()).collect();
    let mut edits = document.taking(&records);
    let at = home.0.entry(home.1, home.2);
    edits.push(Edit::Insert { at: at.clone(), text });
    Ok((edits, at))
}

/// The edits that dissolve the group, and the addresses of its records, which replace it.
///
/// # Errors
/// [`EditRefusal::Apart`] for a record that is not a group; [`EditRefusal::PlacedByGroup`] as [`Document::placing`].
pub fn ungrouping(
    document: &Document,
    items: &[Item],
    group: &Item,
) -> Result<(Vec<Edit>, Vec<Address>), EditRefusal> {
    let (parent, list, index) = group.record.split().ok_or(EditRefusal::Apart)?;
    let corner = place_of(document, group)?;
    let inner = items.iter().filter(|item| {
        item.record.split().is_some_and(|(of, list, _)| of == group.record && list == RecordList::Widgets)
    });
    let mut edits = vec![Edit::Take { record: group.record.clone() }];
    let mut places = Vec::new();
    let pieces = inner.map(|item| placed_piece(document, item, place_of(document, item)? + corner));
    let mut pieces = pieces.collect::<Result<Vec<RecordText>, _>>()?;
    let left = comments_beside(document, &group.record, &pieces);
    if let Some(first) = pieces.first_mut() {
        first.above.splice(0..0, left);
    }
    for piece in pieces {
        let at = parent.entry(list, index + places.len());
        edits.push(Edit::Insert { at: at.clone(), text: piece.listed("") });
        places.push(at);
    }
    if places.is_empty() { Err(EditRefusal::Apart) } else { Ok((edits, places)) }
}

/// The comments of a group that do not belong to any of `pieces`, line by line.
fn comments_beside(document: &Document, group: &Address, pieces: &[RecordText]) -> Vec<String> {
    let piece = group.split().and_then(|(parent, list, index)| {
        LayoutLines(document.text()).piece(list_of(parent.find(document.root())?, list)?, index)
    });
    let Some(whole) = piece.map(|piece| piece.listed("")) else { return Vec::new() };
    let mut all: Vec<&str> = comments(&whole);
    let inner: Vec<String> = pieces.iter().map(|piece| piece.listed("")).collect();
    for taken in inner.iter().flat_map(|piece| comments(piece)) {
        // Moving may have turned it into a block comment and changed its indentation.
        let words = |comment: &str| {
            let words = comment.split(|letter: char| letter.is_whitespace() || "/*".contains(letter));
            words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
        };
        if let Some(at) = all.iter().position(|comment| words(comment) == words(taken)) {
            all.remove(at);
        }
    }
    all.into_iter().flat_map(|comment| comment.lines().map(|line| line.trim().to_owned())).collect()
}

/// Its written place in its list, or the place that it would have if it were written.
pub(super) fn place_of(document: &Document, item: &Item) -> Result<DVec2, EditRefusal> {
    match document.pair(&item.record, "at") {
        Some(written) => Ok(written),
        None if item.is_group => Err(EditRefusal::PlacedByGroup(item.record.clone())),
        None => Ok(item.area.min.as_dvec2() / document.unit_m() - document.origin(&item.record)?),
    }
}

/// The text of a record with the place `at` of its own.
pub(super) fn placed_piece(document: &Document, item: &Item, at: DVec2) -> Result<RecordText, EditRefusal> {
    let missing = || EditRefusal::Missing(item.record.clone());
    let (parent, list, index) = item.record.split().ok_or_else(missing)?;
    let list = parent.find(document.root()).and_then(|parent| list_of(parent, list)).ok_or_else(missing)?;
    let mut piece = LayoutLines(document.text()).piece(list, index).ok_or_else(missing)?;
    let had_at = document.written(&item.record, "at").is_some();
    for field in RELATIVE.iter().filter(|_| !had_at) {
        let root = Outline::parse(&piece.text).ok_or_else(missing)?;
        piece.text = spliced(&piece.text, LayoutLines(&piece.text).unset(&root, &[field]));
    }
    // The cells of a grid have one size.
    let first = item.widgets.clone().next().and_then(|at| document.layout().widgets.get(at));
    let size = first.map_or(item.area, |widget| widget.area).size().as_dvec2() / document.unit_m();
    let needs_size = !had_at && !item.is_group && document.written(&item.record, "size").is_none();
    let size = needs_size.then(|| ("size", pair(size)));
    for (field, value) in [("at", pair(at))].into_iter().chain(size) {
        let root = Outline::parse(&piece.text).ok_or_else(missing)?;
        piece.text = spliced(&piece.text, LayoutLines(&piece.text).set(&root, &[field], &value.inline()));
    }
    Ok(piece)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use underfoot::floor::Floor;
    use underfoot::schema::{Kinds, builtin_layout};

    fn open(text: &str) -> Document {
        Document::read("it", text, &Arc::new(Kinds::builtin()), &Arc::new(Floor::default())).unwrap()
    }

    #[test]
    fn a_group_leaves_everything_where_it_is_and_comes_apart_again() {
        let mut document = open(builtin_layout("map").unwrap());
        let sorted = |document: &Document| {
            let mut all = document.layout().widgets.clone();
            all.sort_by(|a, b| a.id.as_str().cmp(b.id.as_str()));
            all.into_iter().map(|widget| (widget.id, widget.area, widget.label)).collect::<Vec<_>>()
        };
        let before = sorted(&document);
        let items = document.items();
        let pans: Vec<&Item> = items.iter().filter(|item| item.name.starts_with("pan_")).collect();
        let (edits, group) = grouping(&document, &pans).unwrap();
        document.edit(&edits).unwrap();
        let close = |now: Vec<(underfoot::widget::WidgetId, underfoot::floor::Rect, String)>| {
            before.iter().zip(&now).all(|(a, b)| {
                a.0 == b.0
                    && a.2 == b.2
                    && a.1.min.distance(b.1.min) < 1e-4
                    && a.1.max.distance(b.1.max) < 1e-4
            })
        };
        assert!(close(sorted(&document)), "{}", document.text());
        assert!(document.text().contains("Group(id: \"group_1\", at: (1.1, 2.2), widgets: ["));
        assert!(document.text().contains("// Panning: four buttons"), "comments stay");
        let items = document.items();
        let group = items.iter().find(|item| item.record == group).unwrap();
        assert!(group.is_group && group.widgets.len() == 4);
        let (edits, places) = ungrouping(&document, &items, group).unwrap();
        document.edit(&edits).unwrap();
        assert_eq!(places.len(), 4);
        assert!(close(sorted(&document)) && !document.text().contains("Group"), "{}", document.text());
    }

    #[test]
    fn what_stands_beside_a_neighbour_gets_a_place_of_its_own_and_regions_are_in_no_group() {
        let mut document = open(
            "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
        (id: \"a\", kind: \"button\", at: (1, 1), size: (0.6, 0.6)), // a
        (id: \"b\", kind: \"button\", right_of: \"a\", gap: 0.2),
    ])",
        );
        let items = document.items();
        let all: Vec<&Item> = items.iter().collect();
        assert_eq!(grouping(&document, &all), Err(EditRefusal::Apart));
        let (edits, _) = grouping(&document, &all[1..]).unwrap();
        document.edit(&edits).unwrap();
        let inner = "(id: \"a\", kind: \"button\", at: (0, 0), size: (0.6, 0.6)), // a";
        assert!(document.text().contains(inner), "{}", document.text());
        assert!(document.text().contains("(id: \"b\", kind: \"button\", at: (0.8, 0), size: (0.6, 0.6)),"));
    }
}
