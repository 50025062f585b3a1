//! Regions with their cursor rules, stance zones, pages and several people, on an ideal floor.

use std::time::Duration;

use underfoot::engine::{Engine, FootRole, Snapshot};
use underfoot::floor::Geometry;
use underfoot::glam::Vec2;
use underfoot::schema::{Kinds, parse_layout};
use underfoot::sense::{ForceFrame, Method};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, SetError};

/// Feet as point loads in tiles and newtons, one frame a millisecond.
struct Floor {
    engine: Engine,
    geometry: Geometry,
    now: Instant,
    events: Vec<(String, EventKind)>,
    pages: Vec<String>,
}

impl Floor {
    fn with(page: &str) -> Self {
        let geometry = Geometry::default();
        let layout = match parse_layout(page, "test page", &Kinds::builtin(), &geometry) {
            Ok(loaded) => loaded.layout,
            Err(problems) => panic!("{problems}"),
        };
        let engine = Engine::new(geometry, layout, Method::Tracker);
        let mut floor = Self { engine, geometry, now: Instant::START, events: Vec::new(), pages: Vec::new() };
        floor.stand(&[], 50);
        floor
    }

    /// Advances time under these feet; their forces rise within 20 ms of each other's.
    fn stand(&mut self, feet: &[((f32, f32), f32)], millis: u64) {
        for _ in 0..millis {
            self.now = self.now + Duration::from_millis(1);
            let mut frame = ForceFrame::empty(&self.geometry);
            (frame.at, frame.received) = (self.now, self.now);
            for &((x, y), force) in feet {
                frame.add_load(&self.geometry, Vec2::new(x, y) * 0.304, Newtons(force));
            }
            let step = self.engine.step(&frame);
            self.pages.extend(step.page.iter().map(|shown| shown.page.to_string()));
            self.events.extend(step.events.iter().map(|event| (event.id.to_string(), event.kind)));
        }
    }

    fn take(&mut self) -> Vec<(String, EventKind)> {
        std::mem::take(&mut self.events)
    }

    fn clicked(&mut self) -> Vec<String> {
        let clicks = |(id, kind): (String, EventKind)| (kind == EventKind::Clicked).then_some(id);
        self.take().into_iter().filter_map(clicks).collect()
    }

    fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        snapshot
    }
}

/// Two buttons in one region, with this cursor rule.
fn buttons(rule: &str) -> String {
    format!(
        r#"Layout(version: 1, title: "Two", regions: [(id: "all", at: (0, 0), size: (6, 6){rule})], widgets: [
            (id: "west", kind: "button", at: (1, 3), size: (1, 1)),
            (id: "east", kind: "button", at: (4, 3), size: (1, 1)),
        ])"#
    )
}

const WEST: (f32, f32) = (1.5, 3.5);
const EAST: (f32, f32) = (4.5, 3.5);

/// A person of 70 kg who stands in the middle of the region, outside of both buttons.
const STANDING: ((f32, f32), f32) = ((2.8, 1.5), 600.0);

#[test]
fn by_the_paper_s_rule_who_stands_in_the_region_is_the_cursor() {
    for rule in ["", ", cursor: Largest"] {
        let mut floor = Floor::with(&buttons(rule));
        floor.stand(&[STANDING], 500);
        floor.stand(&[STANDING, (WEST, 100.0)], 200);
        floor.stand(&[STANDING], 100);
        assert_eq!(floor.take(), []);
    }
}

#[test]
fn a_working_cursor_is_a_foot_on_a_control_whoever_stands_beside_it() {
    let mut floor = Floor::with(&buttons(", cursor: Working"));
    floor.stand(&[STANDING], 500);
    assert_eq!(floor.snapshot().cursors, [None]);
    for (place, id) in [(WEST, "west"), (EAST, "east")] {
        floor.stand(&[STANDING, (place, 100.0)], 200);
        floor.stand(&[STANDING], 300);
        assert_eq!(floor.clicked(), [id]);
    }
}

#[test]
fn each_foot_is_a_cursor_of_its_own_where_the_region_says_so() {
    let mut floor = Floor::with(&buttons(", cursor: Each"));
    // A seated person with a foot on either button.
    floor.stand(&[(WEST, 90.0)], 200);
    floor.stand(&[(WEST, 90.0), (EAST, 80.0)], 200);
    let snapshot = floor.snapshot();
    assert!(snapshot.widgets.iter().all(|widget| widget.pressed), "both at once");
    let cursors: Vec<f32> = snapshot.cursors.iter().flatten().map(|cursor| cursor.force.0.round()).collect();
    assert_eq!(cursors, [90.0, 80.0], "the region's own first, then the other one");
    floor.stand(&[(EAST, 80.0)], 100);
    floor.stand(&[], 100);
    assert_eq!(floor.clicked(), ["west", "east"]);
}

#[test]
fn a_control_is_held_by_one_foot_and_the_next_one_needs_a_fresh_press() {
    // A button three tiles wide.
    let page = buttons(", cursor: Each").replace("at: (1, 3), size: (1, 1)", "at: (0, 3), size: (3, 1)");
    let mut floor = Floor::with(&page);
    let (first, beside) = (((0.4, 3.5), 90.0), ((2.6, 3.5), 100.0));
    floor.stand(&[first], 200);
    floor.stand(&[first, beside], 500);
    floor.stand(&[beside], 500);
    use EventKind::{Clicked, Pressed, Released};
    let west = |kind| ("west".to_string(), kind);
    let first = [west(Pressed), west(Released), west(Clicked)];
    assert_eq!(floor.take(), first, "the second foot was there before the first let go");
    floor.stand(&[], 100);
    floor.stand(&[beside], 100);
    assert_eq!(floor.take(), [west(Pressed)]);
}

#[test]
fn a_foot_in_a_stance_zone_is_no_cursor_also_where_the_zone_lies_in_the_region() {
    let page = buttons("").replace("widgets:", "stances: [(at: (2, 1), size: (2, 1))], widgets:");
    let mut floor = Floor::with(&page);
    floor.stand(&[STANDING], 500);
    let snapshot = floor.snapshot();
    assert_eq!((snapshot.cursors[0], snapshot.feet[0].role), (None, FootRole::Stance));
    floor.stand(&[STANDING, (WEST, 100.0)], 200);
    floor.stand(&[STANDING], 100);
    assert_eq!(floor.clicked(), ["west"]);
}

#[test]
fn two_people_work_in_two_regions_at_once_and_each_is_weighed() {
    let page = r#"Layout(version: 1, title: "Two desks",
        regions: [(id: "west", at: (0, 2), size: (3, 4)), (id: "east", at: (3, 2), size: (3, 4))],
        stances: [(at: (0, 0), size: (2, 1)), (at: (4, 0), size: (2, 1))],
        widgets: [
            (id: "one", kind: "button", at: (0.5, 2.5), size: (1, 1)),
            (id: "two", kind: "button", at: (4.5, 2.5), size: (1, 1)),
        ])"#;
    let mut floor = Floor::with(page);
    let stand = [((1.0, 0.5), 600.0), ((5.0, 0.5), 800.0)];
    floor.stand(&stand, 3000);
    let from_west = |floor: &Floor| {
        let mut seen = floor.snapshot();
        seen.contacts.sort_by(|a, b| a.centroid.x.total_cmp(&b.centroid.x));
        let state = |id| *seen.feet.iter().find(|foot| foot.contact == id).unwrap();
        seen.contacts.iter().map(|contact| state(contact.id)).collect::<Vec<_>>()
    };
    let weights: Vec<f32> = from_west(&floor).iter().map(|foot| foot.weight.unwrap().0.round()).collect();
    assert_eq!(weights, [600.0, 800.0]);
    // Both press; one releases while the other continues.
    let pressing = [((1.0, 0.5), 500.0), ((5.0, 0.5), 650.0), ((1.0, 3.0), 100.0), ((5.0, 3.0), 150.0)];
    floor.stand(&pressing, 200);
    assert!(floor.snapshot().widgets.iter().all(|widget| widget.pressed));
    let people: Vec<u32> = from_west(&floor).iter().map(|foot| foot.person).collect();
    assert_eq!((people[0], people[2]), (people[1], people[3]), "each one's feet are theirs");
    assert_ne!(people[0], people[2]);
    floor.stand(&[stand[0], pressing[1], pressing[3]], 200);
    floor.stand(&stand, 200);
    assert_eq!(floor.clicked(), ["one", "two"]);
}

const PAGES: &str = r#"Layout(version: 1, title: "Pages", regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [(id: "always", kind: "button", at: (0, 5), size: (1, 1))],
    pages: [
        (id: "front", title: "Front", widgets: [
            (id: "more", kind: "button", at: (1, 3), size: (1, 1), goto: "back"),
            (id: "light", kind: "switch", at: (4, 3), size: (1, 1)),
        ]),
        (id: "back", widgets: [
            (id: "close", kind: "button", at: (1, 3), size: (1, 1), goto: "front"),
            (id: "hello", kind: "button", at: (4, 3), size: (1, 1)),
        ]),
    ])"#;

#[test]
fn a_click_shows_another_page_once_every_foot_has_let_go() {
    let mut floor = Floor::with(PAGES);
    assert_eq!(floor.engine.page(), Some("front"));
    floor.stand(&[(WEST, 100.0)], 200);
    assert_eq!(floor.pages, [""; 0], "a press is no click");
    floor.stand(&[], 100);
    assert_eq!(floor.pages, ["back"]);
    assert_eq!(floor.clicked(), ["more"]);
    // Another control has the same place now, and one that is on both pages is still there.
    for (place, id) in [(EAST, "hello"), ((0.5, 5.5), "always"), (WEST, "close")] {
        floor.stand(&[(place, 100.0)], 200);
        floor.stand(&[], 100);
        assert_eq!(floor.clicked(), [id]);
    }
    assert_eq!(floor.pages, ["back", "front"]);
    let hidden: Vec<bool> = floor.snapshot().widgets.iter().map(|widget| widget.hidden).collect();
    assert_eq!(hidden, [false, false, false, true, true]);
}

#[test]
fn pages_never_swap_under_a_foot_and_what_appears_under_one_needs_a_lift() {
    let mut floor = Floor::with(PAGES);
    floor.stand(&[(EAST, 100.0)], 200);
    assert_eq!(floor.engine.set_page("back"), Ok(()));
    floor.stand(&[(EAST, 100.0)], 500);
    assert_eq!(floor.engine.page(), Some("front"), "light is pressed");
    floor.stand(&[], 100);
    assert_eq!(floor.engine.page(), Some("back"));
    assert_eq!(floor.take().len(), 3, "pressed, released, changed: a page is no reason to lose a press");
    // A foot stands at a place without a control, and a control appears there.
    let stays = PAGES.replace(
        r#"(id: "light", kind: "switch", at: (4, 3)"#,
        r#"(id: "light", kind: "switch", at: (4, 4)"#,
    );
    let mut floor = Floor::with(&stays);
    floor.stand(&[(EAST, 100.0)], 500);
    floor.engine.set_page("back").unwrap();
    floor.stand(&[(EAST, 100.0)], 500);
    assert_eq!(floor.engine.page(), Some("back"));
    assert_eq!(floor.take(), [], "hello came under a loaded foot");
    floor.stand(&[], 100);
    floor.stand(&[(EAST, 100.0)], 100);
    floor.stand(&[], 100);
    assert_eq!(floor.clicked(), ["hello"]);
    assert_eq!(floor.engine.set_page("nowhere"), Err(SetError::Unknown));
}

#[test]
fn a_page_stays_when_its_layout_is_read_again_and_values_stay_when_pages_turn() {
    let mut floor = Floor::with(PAGES);
    floor.stand(&[(EAST, 100.0)], 100);
    floor.stand(&[], 100);
    let on = floor.engine.value("light");
    floor.engine.set_page("back").unwrap();
    floor.stand(&[], 10);
    floor.engine.set_layout(floor.engine.layout().clone());
    assert_eq!(floor.engine.page(), Some("back"));
    floor.engine.set_page("front").unwrap();
    assert_eq!(floor.engine.value("light"), on);
    assert_ne!(on, Floor::with(PAGES).engine.value("light"), "it was switched");
}

#[test]
fn pages_that_are_not_there_are_explained() {
    let broken = PAGES
        .replace(r#"goto: "back""#, r#"goto: "bakc""#)
        .replace(r#"kind: "switch","#, r#"kind: "switch", goto: "back","#);
    let problems = parse_layout(&broken, "broken", &Kinds::builtin(), &Geometry::default()).unwrap_err();
    let text = problems.to_string();
    assert!(text.contains("there is no page \"bakc\"") && text.contains("did you mean \"back\"?"), "{text}");
    assert!(text.contains("only a button's click switches pages"), "{text}");
    let twice = PAGES.replace(r#"id: "back", widgets"#, r#"id: "front", widgets"#);
    let problems = parse_layout(&twice, "twice", &Kinds::builtin(), &Geometry::default()).unwrap_err();
    assert!(problems.to_string().contains("two pages have the id \"front\""));
}
