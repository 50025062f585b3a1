//! The language of layouts beyond one place per control: grids, groups, neighbours, measures, custom kinds.

use std::fs;

use underfoot::feel::EffectKind;
use underfoot::floor::{Geometry, Rect};
use underfoot::glam::Vec2;
use underfoot::layout::{Colour, Icon, Layout};
use underfoot::schema::{Diagnostics, Kinds, parse_layout};
use underfoot::units::Newtons;
use underfoot::widget::Behaviour;

/// A layout with one region, the whole floor, and these fields.
fn read(fields: &str) -> Result<Layout, Diagnostics> {
    let text = format!("Layout(version: 1, regions: [(id: \"all\", at: (0, 0), size: (6, 6))], {fields})");
    parse_layout(&text, "page.ron", &Kinds::builtin(), &Geometry::default()).map(|loaded| loaded.layout)
}

fn page(widgets: &str) -> Layout {
    read(&format!("widgets: [{widgets}]")).unwrap_or_else(|problems| panic!("{problems}"))
}

/// South-west corner and size in tiles, without rounding errors.
fn tiles(layout: &Layout, id: &str) -> [f32; 4] {
    let area = layout.widgets[layout.widget_index(id).unwrap_or_else(|| panic!("no {id}"))].area;
    [area.min.x, area.min.y, area.size().x, area.size().y].map(|metres| (metres / 0.304 * 1e3).round() / 1e3)
}

#[test]
fn a_keypad_is_three_lines() {
    let layout = page(
        r#"(id: "key_{label}", kind: "button", at: (1, 2), size: (0.5, 0.4),
            repeat: (columns: 3, rows: 4, gap: (0.25, 0.2),
                labels: ["1", "2", "3", "4", "5", "6", "7", "8", "9", "Clear", "0", "OK"])),"#,
    );
    let ids: Vec<&str> = layout.widgets.iter().map(|widget| widget.id.as_str()).collect();
    let expected = ["key_1", "key_2", "key_3", "key_4", "key_5", "key_6", "key_7", "key_8", "key_9"];
    assert_eq!(ids[..9], expected);
    assert_eq!(ids[9..], ["key_clear", "key_0", "key_ok"]);
    assert_eq!(layout.widgets[9].label, "Clear");
    // As on a telephone: 1 in the north-west, 0 in the middle of the southern row.
    assert_eq!(tiles(&layout, "key_1"), [1.0, 3.8, 0.5, 0.4]);
    assert_eq!(tiles(&layout, "key_3"), [2.5, 3.8, 0.5, 0.4]);
    assert_eq!(tiles(&layout, "key_0"), [1.75, 2.0, 0.5, 0.4]);
}

#[test]
fn patterns_number_what_has_no_names() {
    let layout = page(
        r#"(id: "cell_{row}_{column}", label: "{n}", kind: "button", at: (0, 0), size: (0.5, 0.5),
            repeat: (columns: 2, rows: 2, gap: 0.5)),
           (kind: "switch", at: (4, 0), size: (0.5, 0.5),
            repeat: (rows: 3, gap: 0.5, ids: ["red", None, "blue"])),"#,
    );
    let written: Vec<_> =
        layout.widgets.iter().map(|widget| (widget.id.as_str(), widget.label.as_str())).collect();
    let expected = [
        ("cell_1_1", "1"),
        ("cell_1_2", "2"),
        ("cell_2_1", "3"),
        ("cell_2_2", "4"),
        ("red", ""),
        ("blue", ""),
    ];
    assert_eq!(written, expected);
    // `None` leaves its place empty: two steps of a tile lie between them.
    assert_eq!(tiles(&layout, "red")[1] - tiles(&layout, "blue")[1], 2.0);
}

#[test]
fn neighbours_stand_beside_each_other_in_whatever_order_they_are_written() {
    let layout = page(
        r#"(id: "next", kind: "button", right_of: "home", gap: 0.1),
           (id: "home", kind: "button", at: (2, 2), size: (0.6, 0.8)),
           (id: "low", kind: "button", below: "home", gap: 0.2, size: (1, 0.5)),
           (id: "high", kind: "button", above: "home", align: Start, size: (1, 0.5)),
           (id: "west", kind: "button", left_of: "home", align: End, gap: 0.5, size: (0.5, 0.5)),"#,
    );
    // Without a size it has its neighbour's.
    assert_eq!(tiles(&layout, "next"), [2.7, 2.0, 0.6, 0.8]);
    assert_eq!(tiles(&layout, "low"), [1.8, 1.3, 1.0, 0.5]);
    assert_eq!(tiles(&layout, "high"), [2.0, 2.8, 1.0, 0.5]);
    assert_eq!(tiles(&layout, "west"), [1.0, 2.3, 0.5, 0.5]);
}

#[test]
fn groups_have_an_origin_of_their_own_and_stand_beside_others_as_a_whole() {
    let layout = page(
        r#"Group(id: "left", at: (1, 2), widgets: [
                (id: "a", kind: "button", at: (0, 0), size: (0.5, 0.5)),
                (id: "b", kind: "button", right_of: "a", gap: 0.5),
           ]),
           Group(right_of: "left", gap: 0.5, align: Start, widgets: [
                // Its origin is nowhere, only what it covers counts.
                (id: "c", kind: "button", at: (7, 7), size: (0.5, 0.5)),
                Group(at: (7, 8), widgets: [(id: "d", kind: "button", at: (0.25, 0), size: (0.5, 0.5))]),
           ]),"#,
    );
    assert_eq!(tiles(&layout, "a"), [1.0, 2.0, 0.5, 0.5]);
    assert_eq!(tiles(&layout, "b"), [2.0, 2.0, 0.5, 0.5]);
    assert_eq!(tiles(&layout, "c"), [3.0, 2.0, 0.5, 0.5]);
    assert_eq!(tiles(&layout, "d"), [3.25, 3.0, 0.5, 0.5]);
}

#[test]
fn metres_are_metres_on_any_floor() {
    let text = r#"Layout(version: 1, units: Metres,
        regions: [(id: "all", at: (0, 0.5), size: (1.8, 1.2))],
        widgets: [(id: "a", kind: "button", at: (0.5, 0.75), size: (0.25, 0.125)),
                  (id: "b", kind: "button", right_of: "a", gap: 0.25)])"#;
    for pitch in [0.304, 0.5] {
        let geometry = Geometry::new(6, 6, pitch, pitch, 0.02).unwrap();
        let layout = parse_layout(text, "page.ron", &Kinds::builtin(), &geometry).unwrap().layout;
        let area = Rect::from_min_size(Vec2::new(0.5, 0.75), Vec2::new(0.25, 0.125));
        assert_eq!(layout.widgets[0].area, area);
        assert_eq!(layout.widgets[1].area.min, Vec2::new(1.0, 0.75));
    }
}

fn press(kinds: &Kinds, name: &str) -> Newtons {
    kinds.get(name).unwrap().behaviour.thresholds().press
}

#[test]
fn a_kind_is_made_from_another_and_says_only_what_differs() {
    let mut kinds = Kinds::builtin();
    let parent = kinds.get("button").unwrap().clone();
    let text =
        r##"Kind(name: "big_button", from: "button", press_n: 80, look: (icon: Home, face: "#ffffff"))"##;
    kinds.add(text, "big_button.ron").unwrap_or_else(|problems| panic!("{problems}"));
    let kind = kinds.get("big_button").unwrap();
    assert_eq!(kind.behaviour.thresholds().press, Newtons(80.0));
    assert_eq!(kind.behaviour.thresholds().release, parent.behaviour.thresholds().release);
    assert_eq!((kind.look.icon, kind.look.face), (Some(Icon::Home), Colour::rgb(255, 255, 255)));
    assert_eq!((kind.look.lit, &kind.feel), (parent.look.lit, &parent.feel));

    // A kind of the same name replaces the one from which it is made.
    kinds.add("Kind(name: \"button\", from: \"button\", press_n: 90)", "button.ron").unwrap();
    assert_eq!(press(&kinds, "button"), Newtons(90.0));
    // Kinds made before keep their old values.
    assert_eq!(press(&kinds, "big_button"), Newtons(80.0));
}

#[test]
fn kinds_of_a_folder_are_made_from_each_other_in_any_order_of_their_files() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("a.ron", "Kind(name: \"a\", from: \"c\", release_n: 30)");
    write("b.ron", "Kind(name: \"button\", from: \"button\", press_n: 100)");
    write("c.ron", "Kind(name: \"c\", from: \"button\", dwell_ms: 55)");
    let mut kinds = Kinds::builtin();
    kinds.read_folder(folder.path()).unwrap_or_else(|problems| panic!("{problems}"));
    // `c` comes from the folder's button, and not from the one that it replaces.
    assert_eq!((press(&kinds, "a"), press(&kinds, "c")), (Newtons(100.0), Newtons(100.0)));

    // A cycle through three files is reported once, in one of them; the valid files are then not loaded either.
    write("b.ron", "Kind(name: \"button\", from: \"a\", press_n: 100)");
    let mut kinds = Kinds::builtin();
    let problems = kinds.read_folder(folder.path()).unwrap_err();
    assert_eq!((problems.len(), &kinds), (1, &Kinds::builtin()));
    let circle = problems.iter().next().unwrap();
    assert!(circle.path.ends_with("a.ron") && circle.field == "from", "{problems}");
    assert_eq!(circle.expected, "from \"c\", from \"button\", from \"a\"");

    // A parent with an error is reported in its own file, once.
    write("b.ron", "Kind(name: \"button\", from: \"button\", pres_n: 100)");
    let problems = kinds.read_folder(folder.path()).unwrap_err();
    assert_eq!(problems.len(), 1);
    assert!(problems.iter().next().unwrap().path.ends_with("b.ron"), "{problems}");
}

#[test]
fn a_layout_has_kinds_of_its_own_that_nobody_else_sees() {
    let layout = read(
        r#"kinds: [
            (name: "key", from: "big", look: (icon: Plus)),
            (name: "big", from: "heavy_button", press_n: 150),
            (name: "switch", from: "switch", initial: true),
        ],
        widgets: [
            (id: "a", kind: "key", at: (1, 1), size: (1, 1)),
            (id: "b", kind: "switch", at: (3, 1), size: (1, 1)),
        ]"#,
    )
    .unwrap_or_else(|problems| panic!("{problems}"));
    let [a, b] = layout.widgets.as_slice() else { panic!("two") };
    assert_eq!((a.kind.as_str(), a.behaviour.thresholds().press), ("key", Newtons(150.0)));
    assert_eq!(a.look.icon, Some(Icon::Plus));
    assert!(matches!(b.behaviour, Behaviour::Switch(switch) if switch.initial));
}

#[test]
fn as_many_controls_as_there_may_be_and_not_one_more() {
    let grid = |id: &str, columns: u32, rows: u32| {
        format!(
            "(id: \"{id}_{{n}}\", kind: \"button\", at: (0, 0), size: (0.05, 0.05), repeat: (columns: {columns}, rows: {rows}, gap: 0.01)),"
        )
    };
    assert_eq!(page(&grid("a", 64, 64)).widgets.len(), 4096);
    let problems = read(&format!("widgets: [{}{}]", grid("a", 64, 64), grid("b", 2, 1))).unwrap_err();
    let problem = problems.iter().next().unwrap();
    assert_eq!(
        (problem.message.as_str(), problem.field.as_str()),
        ("too many controls", "widgets[1].repeat")
    );

    // A chain of four thousand neighbours does not overflow the stack.
    let mut chain = "(id: \"w4095\", kind: \"button\", at: (0, 0), size: (0.05, 0.05)),".to_owned();
    for index in 0..4095 {
        chain.push_str(&format!("(id: \"w{index}\", kind: \"button\", above: \"w{}\"),", index + 1));
    }
    let problems = read(&format!("widgets: [{chain}]")).unwrap_err();
    assert!(
        problems.iter().all(|problem| problem.message.ends_with("reaches beyond the floor")),
        "{problems}"
    );
}

#[test]
fn controls_of_groups_and_of_all_pages_share_one_limit() {
    let grid = |id: &str, columns: u32, rows: u32| {
        format!(
            "(id: \"{id}_{{n}}\", kind: \"button\", at: (0, 0), size: (0.05, 0.05), repeat: (columns: {columns}, rows: {rows}, gap: 0.01)),"
        )
    };
    let with_last = |count: u32| {
        let (common, group, last) = (grid("a", 10, 4), grid("b", 63, 64), grid("c", count, 1));
        // Controls of different pages may lie on each other, those of every page may not.
        read(&format!(
            "widgets: [Group(at: (4, 4), widgets: [{common}])], pages: [
                (id: \"one\", widgets: [Group(at: (0, 0), widgets: [{group}])]), (id: \"two\", widgets: [{last}])]"
        ))
    };
    let layout = with_last(24).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(layout.widgets.len(), 4096);
    let problems = with_last(25).unwrap_err();
    let problem = problems.iter().next().unwrap();
    assert_eq!(
        (problem.message.as_str(), problem.field.as_str(), problem.expected.as_str()),
        ("too many controls", "pages[1].widgets[0].repeat", "25 more, with room for 24 of 4096")
    );
}

#[test]
fn own_effects_and_kinds_and_the_unit_hold_wherever_they_are_written() {
    let own = |pages: &str, kinds: &str| {
        let text = format!(
            "Layout(version: 1, regions: [(id: \"all\", at: (0, 0), size: (1.8, 1.8))], pages: [(id: \"one\", widgets: [Group(at: (0, 0), widgets: [{pages}])])], kinds: [{kinds}],
            effects: [(name: \"knock\", plays: Click(from: \"soft_click\", level_n: 7)),
                (name: \"thud\", plays: Click(from: \"knock\", duck_db: 3))], units: Metres)"
        );
        parse_layout(&text, "page.ron", &Kinds::builtin(), &Geometry::default()).map(|loaded| loaded.layout)
    };
    let kind = "Kind(name: \"key\", from: \"button\", feel: (press: \"thud\"))";
    let key = |fields: &str| format!("(id: \"a\", kind: \"key\", at: (1, 0.5), {fields}),");
    let layout = own(&key("size: (0.2, 0.3), feel: (release: \"knock\")"), kind);
    let layout = layout.unwrap_or_else(|problems| panic!("{problems}"));
    let [button] = layout.widgets.as_slice() else { panic!("one") };
    assert_eq!(button.area, Rect::new(Vec2::new(1.0, 0.5), Vec2::new(1.2, 0.8)));
    let levels = [&button.feel.press, &button.feel.release].map(|effect| {
        let effect = effect.as_ref().unwrap();
        let EffectKind::Click(clicks) = &effect.kind else { panic!("a click") };
        clicks.press.level
    });
    assert_eq!(levels, [Newtons(7.0); 2]);

    let problems = own(&key("size: (0.001, 0.3)"), kind).unwrap_err().to_string();
    assert!(problems.contains("0.01 to 1000 m, found 0.001 m"), "{problems}");
    let problems = own(&key("size: (0.2, 0.3)"), "").unwrap_err().to_string();
    assert!(problems.contains("unknown kind \"key\""), "{problems}");
}
