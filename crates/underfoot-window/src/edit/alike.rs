//! Controls that become alike: in size, thresholds, appearance and feel.

use super::address::Address;
use super::change::Edit;
use super::document::Document;
use super::facets::{Facet, facet_edits};
use super::item::Item;
use super::refusal::EditRefusal;
use underfoot::floor::Rect;
use underfoot_format::text::RonText;

/// The edits that make `others` as `model` is: its size, its thresholds, its appearance and its feel. Their ids, labels,
/// icons, ranges and messages stay, and so do their places: the south-west corner, or the middle where a neighbour
/// leaves no other room.
///
/// # Errors
/// [`EditRefusal::NotAControl`] if one of them is none; [`EditRefusal::NoSize`] for a grid; as [`Document::trial`] where
/// there is no room.
pub fn alike_edits(document: &Document, model: &Item, others: &[&Item]) -> Result<Vec<Edit>, EditRefusal> {
    let is_grid = |item: &&&Item| item.is_group || item.widgets.len() != 1;
    if let Some(grid) = [model].iter().chain(others).find(is_grid) {
        return Err(match grid.widgets.len() {
            0 => EditRefusal::NotAControl,
            _ => EditRefusal::NoSize(grid.record.clone()),
        });
    }
    let text = document.copy(std::slice::from_ref(&model.record));
    let mut edits = facet_edits(document, Facet::Appearance, &text, others)?;
    edits.extend(facet_edits(document, Facet::Feel, &text, others)?);
    edits.extend(others.iter().flat_map(|other| thresholds(document, model, other)));
    let size = model.area.size();
    let corner = |item: &Item| Rect::from_min_size(item.area.min, size);
    let middle = |item: &Item| Rect::from_centre_size(item.area.centre(), size);
    let sized = |place: &dyn Fn(&Item) -> Rect| -> Result<Vec<Edit>, EditRefusal> {
        let areas: Vec<(&Item, Rect)> = others.iter().map(|item| (*item, place(item))).collect();
        let all = [edits.clone(), document.placing(&areas)?].concat();
        document.trial(&all).map(|_| all)
    };
    sized(&corner).or_else(|refusal| sized(&middle).map_err(|_| refusal))
}

/// The edits that give `other` the thresholds of `model`; those of its kind are left out.
fn thresholds(document: &Document, model: &Item, other: &Item) -> Vec<Edit> {
    let widget = |item: &Item| document.layout().widgets.get(item.widgets.start);
    let (Some(wanted), Some(own)) = (widget(model), widget(other)) else { return Vec::new() };
    let (wanted, now) = (wanted.behaviour.thresholds(), own.behaviour.thresholds());
    let kind = document.all_kinds().get(&own.kind).map(|kind| kind.behaviour.thresholds());
    let edit = |record: &Address, field: &str, wanted: f32, kind: Option<f32>| match kind {
        Some(kind) if kind == wanted => Edit::unset(record, field),
        _ => Edit::set(record, field, RonText::rounded(f64::from(wanted)).inline()),
    };
    [
        ("press_n", wanted.press.0, now.press.0, kind.map(|kind| kind.press.0)),
        ("release_n", wanted.release.0, now.release.0, kind.map(|kind| kind.release.0)),
    ]
    .into_iter()
    .filter(|(_, wanted, now, _)| wanted != now)
    .map(|(field, wanted, _, kind)| edit(&other.record, field, wanted, kind))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::open;
    use super::*;

    const TEXT: &str = "Layout(version: 1, regions: [(id: \"r\", at: (0, 1), size: (6, 5))], widgets: [
        (id: \"a\", kind: \"slider\", at: (0.5, 2), size: (1.2, 0.6), press_n: 70, release_n: 50, \
            look: (face: \"#203040\")), // the model
        (id: \"b\", kind: \"slider\", at: (2.5, 2.1), size: (1, 0.5), label: \"B\", max: 7), // b
        (id: \"c\", kind: \"fader\", at: (2.5, 3), size: (0.5, 1.5), press_n: 99), // c
        (id: \"d\", kind: \"switch\", at: (3.6, 2.1), size: (0.4, 0.5)),
    ])";

    fn items(document: &Document, ids: &[&str]) -> Vec<Item> {
        let all = document.items();
        ids.iter().filter_map(|id| all.iter().find(|item| item.name == *id).cloned()).collect()
    }

    #[test]
    fn a_foot_finds_and_feels_them_alike_and_reads_their_own_labels() {
        let mut document = open("alike", TEXT);
        let all = items(&document, &["a", "b", "c"]);
        let edits = alike_edits(&document, &all[0], &[&all[1], &all[2]]).unwrap();
        document.edit(&edits).unwrap();
        let layout = document.layout();
        let widget = |id: &str| &layout.widgets[layout.widget_index(id).unwrap()];
        let model = widget("a");
        for id in ["b", "c"] {
            let other = widget(id);
            assert!((other.area.size() - model.area.size()).length() < 1e-4, "{id}");
            let thresholds = |widget: &underfoot::layout::Widget| {
                (widget.behaviour.thresholds().press, widget.behaviour.thresholds().release)
            };
            assert_eq!(thresholds(other), thresholds(model), "{id}\n{}", document.text());
            assert_eq!((&other.look.face, &other.feel), (&model.look.face, &model.feel), "{id}");
        }
        assert_eq!((&*widget("b").label, widget("b").kind.as_str()), ("B", "slider"));
        assert!(document.text().contains("max: 7") && document.text().contains("// b\n"));
        document.undo().unwrap();
        assert_eq!(document.text(), TEXT, "one step");
    }

    #[test]
    fn what_has_no_size_of_its_own_or_no_room_is_refused() {
        let document = open("alike", TEXT);
        let all = items(&document, &["a", "b", "r", "d"]);
        assert_eq!(alike_edits(&document, &all[0], &[&all[2]]), Err(EditRefusal::NotAControl));
        assert!(alike_edits(&document, &all[0], &[]).is_err());
        let refused = alike_edits(&document, &all[0], &[&all[3], &all[1]]);
        assert!(matches!(refused, Err(EditRefusal::Unreadable(_))), "{refused:?}");
    }
}
