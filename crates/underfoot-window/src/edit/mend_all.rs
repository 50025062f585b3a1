//! Mends the whole layout at once.

use glam::Vec2;

use super::document::Document;
use super::mend::{mend, mend_warning};
use super::place_plan::{PlacePlan, PlanOrder, PlanWay};
use super::room::PlaceCost;
use underfoot_scene::ergonomics::Finding;

/// The codes of the rules about sizes and places.
const PLACE_RULES: [&str; 4] = ["U101", "U102", "U103", "U104"];

/// The orders in which a plan gives controls their places.
const ORDERS: [PlanOrder; 6] = [
    PlanOrder::File,
    PlanOrder::FromWest,
    PlanOrder::FromEast,
    PlanOrder::FromSouth,
    PlanOrder::FromNorth,
    PlanOrder::LargeFirst,
];

/// Number of further orders for a crowd.
const MIXED: u32 = 8;

/// The text of the layout with as many repairs as possible, and the number of problems that are gone; `None` if none
/// can be mended.
///
/// Controls move together where single moves do not help. Of several ways, the one counts that leaves the fewest
/// problems, and of these the one with the shortest moves.
#[must_use]
pub fn mend_all(document: &Document) -> Option<(String, usize)> {
    let before = ProblemCount::of(document);
    let mut best = planned(document, before).unwrap_or_else(|| document.clone());
    while let Some(better) = mended_once(&best) {
        best = better;
    }
    let left = ProblemCount::of(&best);
    (left.all < before.all).then(|| (best.text().to_owned(), before.all - left.all))
}

/// Whether [`mend_all`] looks for a repair of `finding` even if a single move is none.
#[must_use]
pub fn mends_together(finding: &Finding) -> bool {
    PLACE_RULES.contains(&finding.rule.code)
}

/// The number of problems, of which some concern sizes and places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct ProblemCount {
    of_places: usize,
    all: usize,
}

impl ProblemCount {
    fn of(document: &Document) -> Self {
        let (findings, warnings) = (document.findings(), document.warnings().iter().count());
        let of_places = findings.iter().filter(|finding| mends_together(finding)).count();
        Self { of_places: of_places + warnings, all: findings.len() + warnings }
    }
}

/// The document with places from the best plan; `None` if no plan leaves fewer problems.
fn planned(document: &Document, before: ProblemCount) -> Option<Document> {
    if before.of_places == 0 {
        return None;
    }
    let items = document.items();
    let mut best: Option<(ProblemCount, f32, Document)> = None;
    for round in rounds() {
        for cuts_regions in [false, true] {
            let begun = PlacePlan::begin(document, &items, cuts_regions);
            if cuts_regions && !begun.changes_zones() {
                continue;
            }
            for plan in round.iter().filter_map(|way| begun.placed(*way)) {
                let Some(mended) = plan.written() else { continue };
                let (count, far) = (ProblemCount::of(&mended), plan.travel_m());
                if best.as_ref().is_none_or(|(least, nearest, _)| (count, far) < (*least, *nearest)) {
                    best = Some((count, far, mended));
                }
            }
        }
        if best.as_ref().is_some_and(|(count, ..)| count.of_places == 0) {
            break;
        }
    }
    best.filter(|(count, ..)| count.all < before.all).map(|(.., mended)| mended)
}

/// The ways to try: each round only if those before leave a problem.
fn rounds() -> Vec<Vec<PlanWay>> {
    let nearest = |order, moves_all, for_room| PlanWay { order, moves_all, corner: None, for_room };
    let corners = [[false, false], [true, false], [false, true], [true, true]];
    let filled = |for_room: bool| {
        corners.map(|corner| PlanWay {
            order: PlanOrder::LargeFirst,
            moves_all: true,
            corner: Some(corner),
            for_room,
        })
    };
    let round = |moves_all: bool, for_room: bool| -> Vec<PlanWay> {
        ORDERS.map(|order| nearest(order, moves_all, for_room)).into()
    };
    let last = |for_room: bool| -> Vec<PlanWay> {
        let mixed = (1..=MIXED).map(|number| nearest(PlanOrder::Mixed(number), true, for_room));
        filled(for_room).into_iter().chain(mixed).collect()
    };
    // Where reach or free rows are not to be had, room alone still helps.
    vec![round(false, false), round(true, false), last(false), round(false, true), last(true)]
}

/// The document with one repair that leaves fewer problems, or as many with more room.
fn mended_once(document: &Document) -> Option<Document> {
    let items = document.items();
    let measure = |document: &Document| (ProblemCount::of(document).all, missing_m(document));
    let (count, missing) = measure(document);
    let findings = document.findings();
    let repairs = findings.iter().filter_map(|finding| mend(document, finding, &items));
    let warnings = document.warnings().iter().filter_map(|problem| mend_warning(document, problem, &items));
    repairs.chain(warnings).find_map(|mend| {
        let mut tried = document.clone();
        tried.edit(&mend.edits).ok()?;
        let (left, still_missing) = measure(&tried);
        (left < count || (left == count && still_missing < missing - 0.01)).then_some(tried)
    })
}

/// The sum of the missing room, reach and free rows, in metres.
fn missing_m(document: &Document) -> f32 {
    let (layout, floor) = (document.layout(), document.floor());
    let items = document.items();
    let controls = items.iter().filter(|item| !item.is_group && !item.widgets.is_empty());
    let costs = controls.map(|item| PlaceCost::of(layout, floor, &item.widgets, Vec2::ZERO, |_| true));
    costs.map(|cost| cost.missing_m(floor.geometry.pitch_m().max_element())).sum()
}
