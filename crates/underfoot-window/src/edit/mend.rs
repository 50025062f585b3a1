//! Repairs of findings: sizes, thresholds, and places that keep the rules for room and reach.

use super::address::{Address, RecordList};
use super::change::Edit;
use super::document::Document;
use super::grid_room::{GridRoom, good_size, is_crowded};
use super::item::Item;
use super::room::{PlaceRule, SLACK_M, is_inside, moved};
use super::snap::Edges;
use super::zones::{ZoneRepair, region_beside, stance_beside};
use underfoot::floor::Rect;
use underfoot::schema::Diagnostic;
use underfoot_scene::ergonomics::{Finding, Part, gap_between_m, needed_gap_m};

/// A repair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mend {
    /// Its effect, in a few words that begin with a verb.
    pub name: String,
    /// The edits.
    pub edits: Vec<Edit>,
}

impl Mend {
    fn new(name: &str, edits: Vec<Edit>) -> Self {
        Self { name: name.to_owned(), edits }
    }
}

/// The repair of a finding; `None` where only the user can decide, or where there is no place that keeps all rules.
///
/// A control with parts that are too small becomes larger, until each is 12 cm wide and deep; a threshold returns to the
/// value of its kind; a control that is too close to another one, out of reach or beside a stance zone goes to the
/// nearest place of its region where it is none of these. The control moves by steps of round numbers and keeps its
/// size.
#[must_use]
pub fn mend(document: &Document, finding: &Finding, items: &[Item]) -> Option<Mend> {
    let record = document.record_of(finding.widget)?;
    let item = items.iter().find(|item| item.record == record)?;
    let is_single = item.widgets.len() == 1;
    match (finding.rule.code, finding.part) {
        ("U101", Part::Size) if is_single => {
            let widget = document.layout().widgets.get(finding.widget)?;
            let area = Rect::from_centre_size(item.area.centre(), good_size(widget));
            Some(Mend::new("Make it 12 cm", document.placing(&[(item, area)]).ok()?))
        }
        ("U101", Part::Size) => grid(document, item, "Make it 12 cm"),
        (_, Part::Press) if is_single && document.written(&record, "press_n").is_some() => {
            let fields = ["press_n", "release_n"];
            let written = fields.iter().filter(|field| document.written(&record, field).is_some());
            Some(Mend::new("Press as its kind", written.map(|field| Edit::unset(&record, field)).collect()))
        }
        ("U102", _) if !item.is_group && is_crowded(document.layout().widgets.get(item.widgets.clone())?) => {
            grid(document, item, "Move them apart")
        }
        ("U102", _) => {
            // Where it has no other place, a neighbour may have one.
            let own = moved(document, item, PlaceRule::Gap);
            let edits = own.or_else(|| {
                let crowding = crowding(document, item, items);
                crowding.into_iter().find_map(|other| moved(document, other, PlaceRule::Gap))
            });
            Some(Mend::new("Move them apart", edits?))
        }
        ("U103", _) => Some(Mend::new("Move it nearer", moved(document, item, PlaceRule::Reach)?)),
        ("U104", _) => Some(Mend::new("Leave one free row", moved(document, item, PlaceRule::Row)?)),
        ("U107", _) => working_cursor(document, finding),
        _ => None,
    }
}

/// The repair of a warning of the reader about a place: a control that sticks out of its region, or a stance zone that
/// reaches into a region. `None` for all other warnings.
#[must_use]
pub fn mend_warning(document: &Document, problem: &Diagnostic, items: &[Item]) -> Option<Mend> {
    let record = document.told_of(problem)?;
    let item = items.iter().find(|item| item.record == record)?;
    match record.list()? {
        RecordList::Widgets if !item.is_group => into_region(document, item),
        RecordList::Stances => out_of_regions(document, item),
        _ => None,
    }
}

/// The items that are too close to `item`.
fn crowding<'i>(document: &Document, item: &Item, items: &'i [Item]) -> Vec<&'i Item> {
    let layout = document.layout();
    let widgets = |item: &Item| layout.widgets.get(item.widgets.clone()).unwrap_or_default();
    let is_close = |other: &&Item| {
        let mut pairs = widgets(item).iter().flat_map(|one| widgets(other).iter().map(move |two| (one, two)));
        !other.is_group
            && other.record != item.record
            && pairs.any(|(one, two)| {
                let needed = needed_gap_m(one).max(needed_gap_m(two));
                gap_between_m(one.area, two.area) < needed - SLACK_M
            })
    };
    items.iter().filter(is_close).collect()
}

/// Gives the cells of a grid the room that they need.
fn grid(document: &Document, item: &Item, name: &str) -> Option<Mend> {
    let edits = GridRoom::needed(document, item)?.edits(document, item);
    document.trial(&edits).ok().map(|_| Mend::new(name, edits))
}

/// Lets the foot on a control be the cursor of the region, instead of the heaviest one.
fn working_cursor(document: &Document, finding: &Finding) -> Option<Mend> {
    let region = document.layout().widgets.get(finding.widget)?.region;
    let edits = vec![Edit::set(&Address::of(RecordList::Regions, region), "cursor", "Working")];
    document.trial(&edits).ok().map(|_| Mend::new("Follow the working foot", edits))
}

/// Moves a control into its region.
fn into_region(document: &Document, item: &Item) -> Option<Mend> {
    let layout = document.layout();
    let region =
        layout.widgets.get(item.widgets.start).and_then(|first| layout.regions.get(first.region))?.area;
    let (area, stopped) = Edges::ALL.stopped(item.area, region);
    let edits =
        document.placing(&[(item, area)]).ok().filter(|_| stopped.is_any() && is_inside(area, region))?;
    document.trial(&edits).ok().map(|_| Mend::new("Move it into its region", edits))
}

/// Moves a stance zone beside the regions that it reaches into, or cuts such a region off at its edge.
fn out_of_regions(document: &Document, item: &Item) -> Option<Mend> {
    let (layout, floor) = (document.layout(), document.floor().geometry.bounds());
    let stance = item.record.split().map(|(.., index)| index)?;
    let repair = stance_beside(layout, floor, stance).or_else(|| region_beside(layout, stance, true))?;
    let items = document.items();
    let (list, index, area) = match repair {
        ZoneRepair::Stance(index, area) => (RecordList::Stances, index, area),
        ZoneRepair::Region(index, area) => (RecordList::Regions, index, area),
    };
    let zone = items.iter().find(|item| item.record == Address::of(list, index))?;
    let edits = document.placing(&[(zone, area)]).ok()?;
    document.trial(&edits).ok().map(|_| Mend::new(repair.name(), edits))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use underfoot::floor::Floor;
    use underfoot::schema::Kinds;

    const HEAD: &str = "Layout(version: 1, regions: [(id: \"r\", at: (0, 2), size: (6, 4))], \
                        stances: [(at: (2, 0), size: (2, 1), label: \"Stand\")], widgets: [\n";

    fn open(widgets: &str) -> Document {
        read(&format!("{HEAD}{widgets}])"))
    }

    fn read(text: &str) -> Document {
        let floor = Arc::new(Floor::default());
        Document::read("it", text, &Arc::new(Kinds::builtin()), &floor)
            .unwrap_or_else(|problems| panic!("{text}\n{problems}"))
    }

    fn codes(document: &Document) -> Vec<&'static str> {
        document.findings().iter().map(|finding| finding.rule.code).collect()
    }

    /// Mends each finding once; checks that it is gone and that undo returns the bytes.
    fn mended(document: &mut Document, code: &str, name: &str) {
        let (before, count) = (document.text().to_owned(), codes(document).len());
        assert!(codes(document).contains(&code), "{before}\n{:?}", codes(document));
        let finding = document.findings().into_iter().find(|finding| finding.rule.code == code).unwrap();
        let mend = mend(document, &finding, &document.items()).unwrap_or_else(|| panic!("{code}\n{before}"));
        assert_eq!(mend.name, name);
        document.edit(&mend.edits).unwrap();
        assert!(codes(document).len() < count, "{:?}\n{}", codes(document), document.text());
        let after = document.text().to_owned();
        document.undo().unwrap();
        assert_eq!(document.text(), before);
        document.redo().unwrap();
        assert_eq!(document.text(), after);
    }

    #[test]
    fn a_foot_on_one_control_no_longer_reaches_the_other() {
        let mut document = open(
            "(id: \"a\", kind: \"button\", at: (2, 2.5), size: (0.6, 0.6), label: \"A\"), // a\n\
             (id: \"b\", kind: \"button\", at: (2.65, 2.5), size: (0.6, 0.6), label: \"B\"), // b\n",
        );
        mended(&mut document, "U102", "Move them apart");
        assert!(document.text().contains("// a\n") && document.text().contains("// b\n"));
        assert!(document.text().contains("at: (2.8, 2.5)"), "a round number: {}", document.text());
    }

    #[test]
    fn the_cells_of_a_grid_move_apart_together() {
        let mut document = open(
            "(id: \"k_{n}\", kind: \"button\", at: (1, 2.5), size: (0.6, 0.6), label: \"K\", \
             repeat: (columns: 3, gap: 0.05)),",
        );
        mended(&mut document, "U102", "Move them apart");
        assert!(codes(&document).is_empty(), "{}", document.text());
    }

    #[test]
    fn what_no_foot_reaches_comes_nearer_and_what_is_underfoot_goes_a_row_away() {
        let far = "(id: \"a\", kind: \"button\", at: (0.2, 5.2), size: (0.6, 0.6), label: \"A\"),";
        mended(&mut open(far), "U103", "Move it nearer");
        let mut near = read(
            "Layout(version: 1, regions: [(id: \"r\", at: (0, 1), size: (6, 5))], \
             stances: [(at: (2, 0), size: (2, 1))], widgets: [\
             (id: \"a\", kind: \"button\", at: (2.2, 1.2), size: (0.6, 0.6), label: \"A\")])",
        );
        mended(&mut near, "U104", "Leave one free row");
    }

    #[test]
    fn a_foot_that_stands_beside_the_region_is_no_longer_its_cursor() {
        let page = |rule: &str, y: &str| {
            format!(
                "Layout(version: 1, regions: [(id: \"r\", at: (0, 1.3), size: (6, 4.7){rule})], \
                 stances: [(at: (2, {y}), size: (2, 0.7))], widgets: [\
                 (id: \"a\", kind: \"button\", at: (2.2, 2.2), size: (0.6, 0.6), label: \"A\"),\
                 (id: \"b\", kind: \"button\", at: (3.2, 2.2), size: (0.6, 0.6), label: \"B\")])"
            )
        };
        let mut near = read(&page("", "0.3"));
        assert_eq!(codes(&near), ["U107"], "once for the region");
        mended(&mut near, "U107", "Follow the working foot");
        assert!(near.text().contains("cursor: Working"), "{}", near.text());
        let mut written = read(&page(", cursor: Largest /* rule */", "0.3"));
        mended(&mut written, "U107", "Follow the working foot");
        assert!(written.text().contains("cursor: Working /* rule */"), "{}", written.text());
        for (rule, y) in [(", cursor: Each", "0.3"), (", cursor: Working", "0.3"), ("", "0")] {
            assert!(codes(&read(&page(rule, y))).is_empty(), "{rule} {y}");
        }
    }

    #[test]
    fn where_there_is_no_room_the_user_decides() {
        let document = read(
            "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (1.3, 0.6))], widgets: [\
             (id: \"a\", kind: \"button\", at: (0, 0), size: (0.6, 0.6), label: \"A\"),\
             (id: \"b\", kind: \"button\", at: (0.65, 0), size: (0.6, 0.6), label: \"B\")])",
        );
        let finding = document.findings().into_iter().find(|finding| finding.rule.code == "U102").unwrap();
        assert_eq!(mend(&document, &finding, &document.items()), None);
    }

    #[test]
    fn a_neighbour_moves_where_a_control_has_no_other_place() {
        // Only the east end of the region is free: `a` cannot get there past `b`.
        let mut document = read(
            "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (1.7, 0.6))], widgets: [\
             (id: \"a\", kind: \"button\", at: (0, 0), size: (0.6, 0.6), label: \"A\"),\
             (id: \"b\", kind: \"button\", at: (0.65, 0), size: (0.6, 0.6), label: \"B\")])",
        );
        mended(&mut document, "U102", "Move them apart");
        assert_eq!(document.layout().widgets[0].area.min.x, 0.0, "{}", document.text());
    }

    #[test]
    fn controls_and_stances_get_along_with_regions() {
        for (text, name) in [
            (
                "Layout(version: 1, regions: [(id: \"r\", at: (0, 2), size: (4, 4))], widgets: [\
                 (id: \"a\", kind: \"button\", at: (3.6, 3), size: (0.6, 0.6), label: \"A\")])",
                "Move it into its region",
            ),
            (
                "Layout(version: 1, regions: [(id: \"r\", at: (0, 2), size: (6, 4))], \
                 stances: [(at: (2, 1.5), size: (2, 1))], widgets: [\
                 (id: \"a\", kind: \"button\", at: (2, 4), size: (0.6, 0.6), label: \"A\")])",
                "Move it beside the region",
            ),
            (
                "Layout(version: 1, regions: [(id: \"r\", at: (0, 0.5), size: (6, 5.5))], \
                 stances: [(at: (2, 0), size: (2, 1))], widgets: [\
                 (id: \"a\", kind: \"button\", at: (2, 3), size: (0.6, 0.6), label: \"A\")])",
                "End the region beside it",
            ),
        ] {
            let mut document = read(text);
            let problem = document.warnings().iter().next().cloned().unwrap();
            let mend =
                mend_warning(&document, &problem, &document.items()).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(mend.name, name);
            document.edit(&mend.edits).unwrap();
            assert!(document.warnings().is_empty(), "{}\n{}", document.warnings(), document.text());
            document.undo().unwrap();
            assert_eq!(document.text(), text);
        }
    }
}
