//! Crowded floors, mended at once.

use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::tests::open;
use super::{Document, mend_all, mends_together};
use underfoot::floor::Rect;

/// A region, a place to stand, and controls of random sizes at random places, as `(at, size)` in tiles.
struct CrowdedFloor {
    region: Rect,
    /// Empty for a floor that people use from beside it.
    stance: Option<Rect>,
    controls: Vec<Rect>,
}

impl CrowdedFloor {
    /// As many of `count` controls as find a place without overlap, with sides up to `widest` tiles.
    fn random(rng: &mut Pcg32, count: usize, widest: f32, stance: Option<Rect>) -> Self {
        let region = Rect::new(Vec2::new(0.0, 2.0), Vec2::new(6.0, 6.0));
        let mut controls: Vec<Rect> = Vec::new();
        for _ in 0..40 * count {
            let size = Vec2::new(rng.random_range(0.2..widest), rng.random_range(0.2..widest));
            let round = |at: Vec2| (at * 20.0).round() / 20.0;
            // Some stick out of the region.
            let at = Vec2::new(rng.random_range(0.0..5.3), rng.random_range(1.95..5.3));
            let area = Rect::from_min_size(round(at), round(size).max(Vec2::splat(0.2)));
            let is_free = controls.iter().all(|other| !other.overlaps(area));
            let is_read = region.contains(area.centre()) && area.max.max_element() <= 6.0;
            if is_free && is_read && controls.len() < count {
                controls.push(area);
            }
        }
        Self { region, stance, controls }
    }

    fn text(&self) -> String {
        let place = |area: Rect| {
            let (at, size) = (area.min, area.size());
            format!("at: ({:.2}, {:.2}), size: ({:.2}, {:.2})", at.x, at.y, size.x, size.y)
        };
        let stances: String = self.stance.iter().map(|area| format!("({})", place(*area))).collect();
        let controls = self.controls.iter().enumerate();
        let controls: String = controls
            .map(|(n, area)| {
                let kind = ["button", "switch", "round_button"][n % 3];
                format!("    (id: \"c{n}\", kind: \"{kind}\", {}), // number {n}\n", place(*area))
            })
            .collect();
        format!(
            "Layout(version: 1, regions: [(id: \"r\", {})], stances: [{stances}], widgets: [\n{controls}])",
            place(self.region)
        )
    }
}

/// The problems of sizes, places and zones.
fn problems(document: &Document) -> Vec<String> {
    let findings = document.findings();
    let findings = findings.iter().filter(|finding| mends_together(finding));
    let findings = findings.map(|finding| format!("{} {}", finding.rule.code, finding.message));
    findings.chain(document.warnings().iter().map(|warning| warning.message.clone())).collect()
}

/// Mends it all; checks what must hold of any layout. Returns the problems that are left.
fn mended(text: &str) -> Vec<String> {
    let mut document = open("crowd", text);
    let count = document.findings().len() + document.warnings().iter().count();
    let Some((mended, gone)) = mend_all(&document) else { return problems(&document) };
    document.write(&mended, None).unwrap();
    let left = document.findings().len() + document.warnings().iter().count();
    assert_eq!((left, left < count), (count - gone, true), "{text}\n{mended}");
    assert!(!mended.contains("// number 0\n") || text.contains("// number 0\n"));
    let comments = |text: &str| text.matches("// number").count();
    assert_eq!(comments(text), comments(&mended), "comments stay");
    let after = problems(&document);
    document.undo().unwrap();
    assert_eq!(document.text(), text, "one step");
    after
}

#[test]
fn a_crowd_in_reach_of_those_who_stand_is_mended_whole() {
    let mut rng = Pcg32::seed_from_u64(41);
    let mut found = 0;
    for number in 0..40 {
        // Every third stance zone reaches into the region.
        let south = if number % 3 == 0 { 1.4 } else { 0.0 };
        let stance = Rect::from_min_size(Vec2::new(2.0, south), Vec2::new(2.0, 1.0));
        let text = CrowdedFloor::random(&mut rng, 6, 0.5, Some(stance)).text();
        found += problems(&open("crowd", &text)).len();
        assert_eq!(mended(&text), Vec::<String>::new(), "{number}: {text}");
    }
    assert!(found > 200, "the floors were crowded: {found}");
}

#[test]
fn a_dense_crowd_is_mended_whole_wherever_there_is_room() {
    let mut rng = Pcg32::seed_from_u64(14);
    for number in 0..30 {
        let count = rng.random_range(8..=14);
        let text = CrowdedFloor::random(&mut rng, count, 0.7, None).text();
        assert_eq!(mended(&text), Vec::<String>::new(), "{number}: {text}");
    }
}

#[test]
fn a_crowd_without_enough_room_loses_problems_and_gains_none() {
    let mut rng = Pcg32::seed_from_u64(5);
    for _ in 0..6 {
        let mut crowd = CrowdedFloor::random(&mut rng, 30, 0.9, None);
        // The most that fits into this region with gaps is less than that.
        crowd.controls.truncate(24);
        mended(&crowd.text());
    }
}

#[test]
fn six_controls_close_together_move_apart_in_one_step() {
    let rows: String = (0..6)
        .map(|n| {
            let (east, north) = (1.0 + 0.62 * f64::from(n % 3), 2.2 + 0.62 * f64::from(n / 3));
            let place = format!("at: ({east:.2}, {north:.2}), size: (0.6, 0.6)");
            format!("(id: \"c{n}\", kind: \"button\", {place}), // number {n}\n")
        })
        .collect();
    let text = format!(
        "Layout(version: 1, regions: [(id: \"r\", at: (0, 2), size: (6, 4))], \
         stances: [(at: (2, 0), size: (2, 1), label: \"Stand\")], widgets: [\n{rows}])"
    );
    assert!(problems(&open("crowd", &text)).len() >= 4);
    assert_eq!(mended(&text), Vec::<String>::new());
}

#[test]
fn cells_neighbours_groups_and_zones_are_mended_together() {
    let text = "Layout(version: 1,
        regions: [(id: \"r\", at: (0, 1.5), size: (6, 4.5))],
        stances: [(at: (2, 1), size: (2, 1))],
        widgets: [
            (id: \"k_{n}\", kind: \"button\", at: (1.9, 2.2), size: (0.3, 0.3), repeat: (columns: 3, gap: 0.05)),
            (id: \"a\", kind: \"button\", at: (1.2, 2.1), size: (0.6, 0.6)), // number 1
            (id: \"b\", kind: \"button\", above: \"a\", gap: 0.05, size: (0.6, 0.6)), // number 2
            Group(id: \"g\", at: (3.4, 2.2), widgets: [
                (id: \"c\", kind: \"button\", at: (0, 0), size: (0.5, 0.5)),
                (id: \"d\", kind: \"button\", at: (0.55, 0), size: (0.5, 0.5)),
            ]),
            (id: \"far\", kind: \"button\", at: (0.1, 5.2), size: (0.6, 0.6)),
        ],
    )";
    let found = problems(&open("crowd", text));
    assert!(found.len() >= 8, "{found:?}");
    assert_eq!(mended(text), Vec::<String>::new());
}
