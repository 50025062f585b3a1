//! Rules for feet: their thresholds, and the agreement of the numbers behind them with measurements.

use underfoot::floor::{Floor, PositionMap, Rect};
use underfoot::glam::Vec2;
use underfoot::schema::{Kinds, Severity, parse_layout};
use underfoot::units::Newtons;
use underfoot_lab::experiment::PlaceTable;
use underfoot_scene::ergonomics::{self, RULES, Zone, predicted_error_m};
use underfoot_sim::FloorQuality;

/// Codes of the findings about the controls of a layout with these fields, errors with an exclamation mark.
fn found(fields: &str) -> Vec<String> {
    found_in("at: (0, 0), size: (1.8, 1.8), cursor: Working", fields)
}

/// The same, with a region of these fields.
fn found_in(region: &str, fields: &str) -> Vec<String> {
    let floor = Floor::default();
    let region = format!("(id: \"r\", {region})");
    let text = format!("Layout(version: 1, regions: [{region}], units: Metres, {fields})");
    let loaded = parse_layout(&text, "page.ron", &Kinds::builtin(), &floor.geometry);
    let layout = loaded.unwrap_or_else(|problems| panic!("{problems}")).layout;
    let findings = ergonomics::review(&layout, &floor);
    findings
        .iter()
        .map(|finding| {
            format!("{}{}", finding.rule.code, if finding.severity == Severity::Error { "!" } else { "" })
        })
        .collect()
}

/// The same for one control with a label.
fn of_one(fields: &str) -> Vec<String> {
    found(&format!("widgets: [(id: \"a\", kind: \"button\", label: \"A\", {fields})]"))
}

#[test]
fn sizes_of_shoes() {
    let side = |metres: f32| of_one(&format!("at: (0.5, 0.9), size: (0.3, {metres}), press_n: 200"));
    assert_eq!(side(0.12), [] as [&str; 0]);
    assert_eq!(side(0.10), [] as [&str; 0]);
    assert_eq!(side(0.09), ["U101"]);
    assert_eq!(side(0.05), ["U101", "U105"]);
    // The error of 1.65 cm is more than half of 3 cm.
    assert_eq!(side(0.03), ["U101!", "U105!"]);
}

#[test]
fn where_maps_leave_nothing_else_a_light_press_is_found_less_exactly() {
    let mut floor = Floor::default();
    let area = Rect::from_centre_size(Vec2::splat(0.36), Vec2::splat(0.02));
    let error = |floor: &Floor, newtons: f32| predicted_error_m(floor, area, Newtons(newtons));
    // Without maps the spread of parts dominates, and it grows with the force.
    assert!(error(&floor, 40.0) > 0.012);
    floor.position_maps.fill(Some(PositionMap::NONE));
    assert!(error(&floor, 40.0) > 1.5 * error(&floor, 120.0));
}

#[test]
fn gaps_grow_with_what_is_at_stake() {
    let holds = "kinds: [(name: \"hold\", behaviour: Hold, press_n: 60, release_n: 40, dwell_ms: 250,
        look: (face: \"#ffffff\", lit: \"#ffffff\", ink: \"#000000\"))]";
    let gap = |first: &str, gap: f32| {
        found(&format!(
            "{holds}, widgets: [(id: \"a\", {first}, label: \"A\", at: (0.5, 0.9), size: (0.2, 0.2)),
                       (id: \"b\", kind: \"button\", label: \"B\", right_of: \"a\", gap: {gap})]"
        ))
    };
    let free = "kind: \"button\"";
    assert_eq!(gap(free, 0.05), [] as [&str; 0]);
    assert_eq!(gap(free, 0.045), ["U102"]);
    let confirm = "kind: \"button\", guard: Confirm";
    assert_eq!(gap(confirm, 0.055), [] as [&str; 0]);
    assert_eq!(gap(confirm, 0.05), ["U102"]);
    let run = "kind: \"hold\", guard: HoldToRun(max_s: 60)";
    assert_eq!(gap(run, 0.1), [] as [&str; 0]);
    assert_eq!(gap(run, 0.06), ["U102"]);
    assert_eq!(gap(run, 0.05), ["U102!"]);
    // Reported once, for the one that needs more room.
    let guarded_last = found(&format!(
        "{holds}, widgets: [(id: \"a\", {free}, label: \"A\", at: (0.5, 0.9), size: (0.2, 0.2)),
                   (id: \"b\", {run}, label: \"B\", right_of: \"a\", gap: 0.05)]"
    ));
    assert_eq!(guarded_last, ["U102!"]);
}

#[test]
fn controls_of_different_pages_are_no_neighbours() {
    let pages = found(
        "widgets: [], pages: [
            (id: \"one\", widgets: [(id: \"a\", kind: \"button\", label: \"A\", at: (0.5, 0.9), size: (0.2, 0.2))]),
            (id: \"two\", widgets: [(id: \"b\", kind: \"button\", label: \"B\", at: (0.51, 0.9), size: (0.2, 0.2))]),
        ]",
    );
    assert_eq!(pages, [] as [&str; 0]);
}

#[test]
fn reach_is_counted_from_where_a_foot_can_stand() {
    let at = |north: f32| {
        found(&format!(
            "stances: [(at: (0.61, 0), size: (0.6, 0.3))],
             widgets: [(id: \"a\", kind: \"button\", label: \"A\", at: (0.8, {north}), size: (0.2, 0.2))]"
        ))
    };
    // A shoe's middle is at most 17 cm north; the control's is 10 cm north of its edge.
    assert_eq!(at(0.86), [] as [&str; 0]);
    assert_eq!(at(0.88), ["U103"]);
    assert_eq!(at(1.3), ["U103!"]);
    assert_eq!(at(0.5), ["U104"]);
    assert_eq!(at(0.35), ["U104", "U203"]);
    assert_eq!(at(0.2), ["U203!"]);
}

#[test]
fn a_foot_that_stands_half_a_shoe_beside_its_zone_is_not_the_cursor() {
    let by = |south: f32, rule: &str| {
        found_in(
            &format!("at: (0, {south}), size: (1.8, 1.2){rule}"),
            "stances: [(at: (0.61, 0), size: (0.6, 0.3))], widgets: [
                (id: \"a\", kind: \"button\", label: \"A\", at: (0.6, 0.75), size: (0.2, 0.2)),
                (id: \"b\", kind: \"button\", label: \"B\", at: (1.0, 0.75), size: (0.2, 0.2))]",
        )
    };
    assert_eq!(by(0.2, ""), ["U107"], "once for the region");
    assert_eq!(by(0.42, ""), ["U107"]);
    assert_eq!(by(0.44, ""), [] as [&str; 0]);
    for rule in [", cursor: Working", ", cursor: Each"] {
        assert_eq!(by(0.2, rule), [] as [&str; 0]);
    }
}

#[test]
fn forces_of_light_people_and_of_feet_at_rest() {
    let press = |fields: &str| of_one(&format!("at: (0.9, 0.9), size: (0.3, 0.3), {fields}"));
    assert_eq!(press("press_n: 220"), [] as [&str; 0]);
    assert_eq!(press("press_n: 230"), ["U201"]);
    assert_eq!(press("press_n: 450"), ["U201!"]);
    assert_eq!(press("press_n: 35, release_n: 20"), [] as [&str; 0]);
    assert_eq!(press("press_n: 34, release_n: 20"), ["U202"]);
}

#[test]
fn eyes() {
    let look = |look: &str| of_one(&format!("at: (0.9, 0.9), size: (0.3, 0.3), look: ({look})"));
    let grey = |face: &str| look(&format!("face: \"{face}\", lit: \"#ffffff\", ink: \"#000000\""));
    // Black on this grey has a contrast of 4.6, on the next one of 4.4, on the last one of 2.9.
    assert_eq!(grey("#757575"), [] as [&str; 0]);
    assert_eq!(grey("#727272"), ["U301"]);
    assert_eq!(grey("#585858"), ["U301!"]);
    let unnamed = found("widgets: [(id: \"a\", kind: \"button\", at: (0.9, 0.9), size: (0.3, 0.3))]");
    assert_eq!(unnamed, ["U303"]);
    let icon =
        found("widgets: [(id: \"a\", kind: \"button\", at: (0.9, 0.9), size: (0.3, 0.3), look: (icon: Up))]");
    assert_eq!(icon, [] as [&str; 0]);
    // Words break if necessary, over as many lines as there is room for: two here.
    let long = "Lungenfunktionsprüfungsprotokoll";
    let label = |width: f32| {
        found(&format!(
            "widgets: [(id: \"a\", kind: \"button\", label: \"{long}\", at: (0.9, 0.9), size: ({width}, 0.1))]"
        ))
    };
    assert_eq!(label(0.12), ["U302"]);
    assert_eq!(label(0.6), [] as [&str; 0]);
}

#[test]
fn every_rule_is_explained_and_has_a_code_of_its_own() {
    for (index, rule) in RULES.iter().enumerate() {
        assert_eq!(ergonomics::rule(&rule.code.to_lowercase()), Some(rule));
        assert!(rule.code.len() == 4 && rule.code.starts_with('U'), "{}", rule.code);
        assert!(RULES[..index].iter().all(|earlier| earlier.code < rule.code), "{}", rule.code);
        for text in [rule.title, rule.limits, rule.source, rule.remedy] {
            assert!(!text.is_empty(), "{}", rule.code);
        }
    }
    assert_eq!(ergonomics::rule("U999"), None);
}

/// The tables in the code come from 60 floors; a few floors come close to them.
#[test]
fn predicted_errors_are_those_of_the_simulated_floor() {
    let mut table = PlaceTable::on(FloorQuality::Paper, 96);
    for seed in 101..=108 {
        table.add_floor(seed).unwrap();
    }
    let mut floor = Floor::default();
    for mapped in [false, true] {
        floor.position_maps.fill(mapped.then_some(PositionMap::NONE));
        for (zone, from_seam) in Zone::ALL.into_iter().zip([0.015, 0.055, 0.15]) {
            // So small that it lies in one zone.
            let place = Vec2::new(0.304 + from_seam, 0.304 + 0.152);
            let area = Rect::from_centre_size(place, Vec2::splat(0.001));
            for force in Zone::FORCES_N.map(Newtons) {
                let predicted = predicted_error_m(&floor, area, force);
                let measured = table.p95_m(zone, force, mapped).unwrap();
                let ratio = predicted / measured;
                // 95th percentiles of some two hundred feet on eight floors scatter by a fifth.
                assert!(
                    (0.65..1.5).contains(&ratio),
                    "{zone:?} {force:?} {mapped}: {predicted} m, {measured} m"
                );
            }
        }
    }
}
