//! The shipped layouts and kinds, and all possible errors of a file.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use underfoot::feel::{Click, Clicks, Effect, EffectKind, Lasting};
use underfoot::floor::{Floor, Geometry, Rect};
use underfoot::glam::Vec2;
use underfoot::layout::{Colour, Layout, Shape, Widget};
use underfoot::schema::{
    Diagnostics, Effects, Kinds, Loaded, builtin_layout, builtin_layouts, load_layout, parse_floor,
    parse_layout, write_floor, write_layout,
};
use underfoot::units::Newtons;
use underfoot::widget::{Behaviour, SliderTrack};
use underfoot_scene::ergonomics;

use super::ron_files;

fn parse(text: &str, name: &str) -> Result<Loaded, Diagnostics> {
    parse_layout(text, name, &Kinds::builtin(), &Geometry::default())
}

fn shipped(name: &str) -> Layout {
    parse(builtin_layout(name).unwrap(), name).unwrap_or_else(|problems| panic!("{problems}")).layout
}

/// Another program's reader of RON can read shipped and written files.
#[test]
fn files_are_ordinary_ron() {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    let files = ["layouts", "widgets", "effects", "crates/underfoot-sim/src/scenarios"]
        .into_iter()
        .flat_map(ron_files);
    let mut texts: Vec<String> = files.map(|path| fs::read_to_string(path).unwrap()).collect();
    texts.push(write_layout(&shipped("all_controls")));
    texts.push(write_floor(&Floor::default()));
    assert!(texts.len() > 50);
    for text in texts {
        let read: Result<serde::de::IgnoredAny, _> = options.from_str(&text);
        assert!(read.is_ok(), "{text}\n{read:?}");
    }
}

#[test]
fn every_shipped_file_reads_without_a_warning_and_is_compiled_in() {
    let files = ron_files("layouts");
    assert_eq!(files.len(), builtin_layouts().count());
    for path in files {
        let loaded = load_layout(&path, &Kinds::builtin(), &Geometry::default());
        let loaded = loaded.unwrap_or_else(|problems| panic!("{problems}"));
        assert!(loaded.warnings.is_empty(), "{}", loaded.warnings);
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert_eq!(loaded.layout, shipped(name));
    }

    let mut effects = Effects::default();
    let warnings = effects.read_folder(&Path::new(env!("CARGO_MANIFEST_DIR")).join("effects"));
    assert!(warnings.unwrap_or_else(|problems| panic!("{problems}")).is_empty());
    assert_eq!(effects, Effects::builtin());
    assert_eq!(effects.iter().count(), ron_files("effects").len());

    let mut kinds = Kinds::knowing(effects);
    let warnings = kinds.read_folder(&Path::new(env!("CARGO_MANIFEST_DIR")).join("widgets"));
    assert!(warnings.unwrap_or_else(|problems| panic!("{problems}")).is_empty());
    assert_eq!(kinds, Kinds::builtin());
    assert_eq!(kinds.iter().count(), ron_files("widgets").len());
}

#[test]
fn the_map_has_the_controls_that_its_app_listens_to() {
    let map = shipped("map");
    for id in ["home", "zoom", "satellite", "pan_north", "pan_south", "pan_east", "pan_west"] {
        assert!(map.widget_index(id).is_some(), "{id}");
    }
    let middle = |id: &str| map.widgets[map.widget_index(id).unwrap()].area.centre();
    assert!(middle("pan_north").y > middle("pan_south").y && middle("pan_east").x > middle("pan_west").x);
}

/// The measures of a good foot layout: shoes are 10 to 12 cm wide and 30 cm long.
#[test]
fn shipped_layouts_are_made_for_feet() {
    for name in builtin_layouts() {
        let layout = shipped(name);
        assert_eq!(ergonomics::review(&layout, &Floor::default()), [], "{name}");
        // People walk on grounds, from any side.
        if layout.widgets.is_empty() {
            continue;
        }
        let stance = layout.stances.first().unwrap().area;
        // The rows of tiles with the standing foot and with controls: one in between stays empty.
        let row = |y: f32| (y / 0.304 + 1e-4).floor();
        assert_eq!(row(stance.max.y - 1e-3), 0.0, "{name}");
        // Centres of feet that stand within the zone.
        let feet = Rect::new(stance.min + Vec2::new(0.055, 0.13), stance.max - Vec2::new(0.055, 0.13));
        for (index, widget) in layout.widgets.iter().enumerate() {
            let id = &widget.id;
            let size = widget.area.size();
            assert!(size.min_element() >= 0.12, "{name}: {id} is {size} m");
            assert!(row(widget.area.min.y) >= 2.0, "{name}: {id} begins at {}", widget.area.min.y);
            let reach = feet.distance(widget.area.centre());
            assert!((0.35..=0.8).contains(&reach), "{name}: {id} is {reach} m away");
            assert!((1..=12).contains(&widget.label.chars().count()), "{name}: {id}");
            for other in &layout.widgets[..index] {
                let gap = gap(widget.area, other.area);
                assert!(gap >= 0.055, "{name}: {gap} m between {id} and {}", other.id);
            }
        }
    }
}

fn gap(a: Rect, b: Rect) -> f32 {
    (a.min - b.max).max(b.min - a.max).max(Vec2::ZERO).length()
}

#[test]
fn shipped_kinds_feel_different_and_as_soles_feel() {
    let kinds = Kinds::builtin();
    let mut presses = Vec::new();
    for kind in kinds.iter() {
        let press = click(kind.feel.press.as_ref(), false);
        assert!((150.0..=250.0).contains(&press.modes[0].frequency_hz), "{}", kind.name);
        if kind.feel.on.is_none() {
            let release = click(kind.feel.release.as_ref(), true);
            assert!(release.modes[0].frequency_hz > press.modes[0].frequency_hz, "{}", kind.name);
            assert!(release.level.0 < press.level.0, "{}", kind.name);
        }
        if let Some(Lasting::Friction(drag)) = kind.feel.drag.as_ref().and_then(|drag| drag.kind.lasting()) {
            assert!(drag.low_hz >= 60.0 && drag.high_hz <= 350.0, "{}", kind.name);
        }
        assert!(!presses.contains(&press), "{} feels like another kind", kind.name);
        presses.push(press);
    }
}

/// The click of `effect` as an answer to a press or a release.
fn click(effect: Option<&Arc<Effect>>, releases: bool) -> Click {
    let EffectKind::Click(Clicks { press, release }) = &effect.unwrap().kind else { panic!("no click") };
    release.as_ref().filter(|_| releases).unwrap_or(press).clone()
}

/// The messages for each broken file are in the file beside it that ends in `.stderr`.
///
/// After a change of wording run this with `UPDATE_EXPECTED=1` and check the differences.
// F6, F9
#[test]
fn every_broken_file_is_explained() {
    let update = std::env::var_os("UPDATE_EXPECTED").is_some();
    let files = ron_files("tests/broken_layouts");
    assert!(files.len() >= 50, "{} files", files.len());
    let mut differing = Vec::new();
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let problems = problems(&text, name);
        check_places(&text, &problems);
        let found = format!("{problems}\n");
        let expected = path.with_extension("stderr");
        if update {
            fs::write(&expected, &found).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default() != found {
            differing.push(format!("--- {name}\n{found}"));
        }
    }
    assert!(differing.is_empty(), "not as expected:\n{}", differing.join("\n"));
}

/// The errors of a file, which is a kind, a floor or a layout by its name.
fn problems(text: &str, name: &str) -> Diagnostics {
    if name.starts_with("kind_") {
        Kinds::builtin().add(text, name).unwrap_err()
    } else if name.starts_with("floor_") {
        parse_floor(text, name).unwrap_err()
    } else {
        parse(text, name).map_or_else(
            |errors| errors,
            |loaded| {
                let mut problems = loaded.warnings;
                let found = ergonomics::review(&loaded.layout, &Floor::default());
                problems.merge(ergonomics::locate(&loaded.places, &found));
                problems
            },
        )
    }
}

/// Lines and columns agree with the spans, and spans are places in the text.
fn check_places(text: &str, problems: &Diagnostics) {
    for problem in problems.iter().filter(|problem| problem.line > 0) {
        let marked = text.get(problem.span.clone());
        assert!(marked.is_some(), "{problem}");
        let before = &text[..problem.span.start];
        assert_eq!(problem.line, before.matches('\n').count() + 1, "{problem}");
        let line = before.rsplit('\n').next().unwrap().trim_start_matches('\u{feff}');
        assert_eq!(problem.column, line.chars().count() + 1, "{problem}");
    }
}

#[test]
fn spans_and_fields_name_what_is_wrong() {
    let text = "\u{feff}Layout(\r\n    version: 1,\r\n    title: \"Größe\", regions: [(id: \"map\", at: (0, 2), size: (6, 4))],\r\n    \
                widgets: [\r\n        (id: \"a\", kind: \"button\", at: (1, 2), size: (1, 0), feel: (press: Click(modes: [(hz: 5, decay_ms: 9)]))),\r\n        \
                (id: \"b\", kind: \"slider\", at: (3, 3), size: (1, 1), min: 2),\r\n    ],\r\n)\r\n";
    let problems = parse(text, "map.ron").unwrap_err();
    check_places(text, &problems);
    let found: Vec<(&str, &str)> =
        problems.iter().map(|problem| (&text[problem.span.clone()], problem.field.as_str())).collect();
    let expected =
        [("0", "widgets[0].size"), ("5", "widgets[0].feel.press.modes[0].hz"), ("2", "widgets[1].min")];
    assert_eq!(found, expected);
    let json = serde_json::to_value(&problems).unwrap();
    assert_eq!(json[0]["severity"], "error");
    assert_eq!(json[0]["line"], 5);
    assert_eq!(json[0]["path"], "map.ron");
    assert_eq!(json[0]["message"], "`size` is out of range");
    assert_eq!(json[0]["expected"], "expected 0.05 to 256 tiles, found 0 tiles");
}

// F7
#[test]
fn a_byte_order_mark_and_foreign_line_ends_change_nothing() {
    for name in builtin_layouts() {
        let text = builtin_layout(name).unwrap();
        let foreign = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        assert_eq!(parse(&foreign, name).unwrap().layout, shipped(name));
    }
}

/// A file that is read while it is being saved.
// F1
#[test]
fn every_prefix_of_every_shipped_layout_is_an_error_and_never_a_part_of_it() {
    let kinds = Kinds::builtin();
    for name in builtin_layouts() {
        let text = builtin_layout(name).unwrap();
        let end = text.rfind("\n)").unwrap() + 1;
        for cut in (0..=end).filter(|cut| text.is_char_boundary(*cut)) {
            let prefix = &text[..cut];
            let problems = parse_layout(prefix, name, &kinds, &Geometry::default()).unwrap_err();
            assert!(problems.errors() > 0, "{name} cut at {cut}");
            check_places(prefix, &problems);
        }
    }
}

// F6
#[test]
fn limits_hold_before_memory_and_stack_are_used_up() {
    let page = |widgets: &str| {
        format!("Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [{widgets}])")
    };
    let first = |text: &str| {
        let problems = parse(text, "big.ron").unwrap_err();
        problems.iter().next().unwrap().message.clone()
    };
    assert_eq!(
        first(&page(&"(),".repeat(1_000_000))),
        "the file holds more than 500000 words, numbers and marks"
    );
    assert_eq!(first(&page(&"(),".repeat(4097))), "this list has more than 4096 entries");
    assert_eq!(first(&page(&format!("{}()", "(),".repeat(4096)))), "`widgets` has too many entries");
    assert_eq!(first(&page(&"(".repeat(100_000))), "brackets nest deeper than 64");
    assert_eq!(
        first(&page(&format!("{}{}", "[".repeat(65), "]".repeat(65)))),
        "brackets nest deeper than 64"
    );
    assert_eq!(first(&" ".repeat((4 << 20) + 1)), "the file is larger than 4 MB");

    // As many errors as fit into a file: the first 500 are kept, the rest is counted.
    let problems = parse(&page(&"(),".repeat(4096)), "big.ron").unwrap_err();
    assert_eq!((problems.len(), problems.errors()), (Diagnostics::LIMIT, 4096));
    assert!(problems.to_string().ends_with("... and 3596 more problems\nbig.ron: 4096 errors"));
}

#[test]
fn kinds_of_one_s_own_add_to_the_shipped_ones_and_replace_them() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("bell.ron", "Kind(name: \"bell\", behaviour: Button, press_n: 50, release_n: 30)");
    write("button.ron", "Kind(name: \"button\", behaviour: Switch, press_n: 50, release_n: 30)");
    write("notes.txt", "not a kind");
    let mut kinds = Kinds::builtin();
    let shipped = kinds.iter().count();
    kinds.read_folder(folder.path()).unwrap();
    assert_eq!(kinds.iter().count(), shipped + 1);
    assert_ne!(kinds.get("button"), Kinds::builtin().get("button"));

    // With one bad file the folder's other files are not loaded; the message names the kind's own file.
    write("bad.ron", "Kind(name: \"bad\", behaviour: Button, press_n: 5)");
    write("bell_2.ron", "Kind(name: \"bell\", behaviour: Button, press_n: 60, release_n: 30)");
    let mut kinds = Kinds::builtin();
    let problems = kinds.read_folder(folder.path()).unwrap_err();
    assert_eq!(kinds, Kinds::builtin());
    let bad = problems.iter().next().unwrap();
    assert!(bad.path.ends_with("bad.ron"), "{}", bad.path);
    assert!(problems.to_string().contains("there is a kind \"bell\" in"), "{problems}");
    assert!(problems.to_string().ends_with("2 files: 3 errors"), "{problems}");

    assert!(kinds.read_folder(&folder.path().join("none")).is_err());
}

#[test]
fn a_layout_lies_where_the_floor_s_pitch_puts_it() {
    let text = builtin_layout("map").unwrap();
    let wide = Geometry::new(6, 6, 0.5, 0.52, 0.02).unwrap();
    let layout = parse_layout(text, "map", &Kinds::builtin(), &wide).unwrap().layout;
    assert_eq!(layout.regions[0].area, Rect::new(Vec2::new(0.0, 1.04), Vec2::new(3.12, 3.12)));
    let small = Geometry::of_paper_tiles(4, 4).unwrap();
    let problems = parse_layout(text, "map", &Kinds::builtin(), &small).unwrap_err();
    assert!(problems.to_string().contains("\"zoom\" reaches beyond the floor"), "{problems}");
}

#[test]
fn a_widget_overrides_any_field_of_its_kind() {
    let text = r##"(
        version: 1,
        regions: [(id: "r", at: (0, 0), size: (6, 6))],
        widgets: [
            (id: "a", kind: "slider", at: (0, 0), size: (2, 1), min: 10, max: 20,
                press_n: 50, lockout_ms: 0, axis: North, look: (shape: Round, face: "#000000"),
                feel: (press: None, release: (level_n: 1), drag: (high_hz: 300))),
            (id: "b", kind: "slider", at: (3, 0), size: (2, 1)),
        ],
    )"##;
    let layout = parse(text, "map.ron").unwrap_or_else(|problems| panic!("{problems}")).layout;
    let (Behaviour::Slider(a), Behaviour::Slider(b)) =
        (&layout.widgets[0].behaviour, &layout.widgets[1].behaviour)
    else {
        panic!("both are sliders")
    };
    assert_eq!((a.scale.min, a.scale.max, a.track), (10.0, 20.0, SliderTrack::NORTH));
    // The kind's initial value 0 follows the new range.
    assert_eq!(a.initial, 10.0);
    assert_eq!(a.thresholds.press, Newtons(50.0));
    assert_eq!(a.thresholds.release, b.thresholds.release);
    assert_eq!((a.thresholds.lockout, b.thresholds.lockout), (Duration::ZERO, Duration::from_millis(20)));
    let (a, b) = (&layout.widgets[0], &layout.widgets[1]);
    assert_eq!((a.look.shape, a.look.face), (Shape::Round, Colour::rgb(0, 0, 0)));
    assert_eq!((a.look.lit, a.look.ink), (b.look.lit, b.look.ink));
    assert_eq!(a.feel.press, None);
    let (release, kind_release) =
        (click(a.feel.release.as_ref(), true), click(b.feel.release.as_ref(), true));
    assert_eq!((release.level, release.modes), (Newtons(1.0), kind_release.modes));
    let friction = |widget: &Widget| match widget.feel.drag.as_ref().unwrap().kind {
        EffectKind::Friction(friction) => friction,
        _ => panic!("no friction"),
    };
    let (drag, kind_drag) = (friction(a), friction(b));
    assert_eq!((drag.high_hz, drag.low_hz), (300.0, kind_drag.low_hz));
}

#[test]
fn ron_is_read_however_it_is_written() {
    let plain = shipped("map");
    let text = builtin_layout("map").unwrap();
    for (from, to) in [
        ("Layout(", "("),
        ("Layout(", "#![enable(implicit_some, unwrap_newtypes)]\nLayout ("),
        ("version: 1", "version: Some(1)"),
        ("title: \"Map navigation\"", "title: r#\"Map navigation\"#"),
        ("title: \"Map navigation\"", "title: \"Map\\u{20}navigation\""),
        ("(id: \"home\"", "/* a /* nested */ comment */ Widget(id: \"home\""),
        ("(0.6, 0.6)", "(6e-1, 0.6_0)"),
        ("size: (6, 4)", "size: (0x6, 0b100)"),
        ("    ],\n)", "    ]\n)"),
    ] {
        assert!(text.contains(from), "{from}");
        let varied = text.replacen(from, to, 1);
        let loaded = parse(&varied, "map.ron").unwrap_or_else(|problems| panic!("{to}\n{problems}"));
        assert_eq!(loaded.layout, plain, "{to}");
        assert!(loaded.warnings.is_empty(), "{to}\n{}", loaded.warnings);
    }
}

#[cfg(unix)]
#[test]
fn links_and_read_only_files_are_read_like_any_other() {
    let folder = tempfile::tempdir().unwrap();
    let (file, link) = (folder.path().join("map.ron"), folder.path().join("link.ron"));
    fs::write(&file, builtin_layout("map").unwrap()).unwrap();
    let mut permissions = fs::metadata(&file).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&file, permissions).unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    let loaded = load_layout(&link, &Kinds::builtin(), &Geometry::default());
    assert_eq!(loaded.unwrap().layout, shipped("map"));
    // A dangling link is not a file.
    fs::remove_file(&file).unwrap();
    let problems = load_layout(&link, &Kinds::builtin(), &Geometry::default()).unwrap_err();
    assert!(problems.to_string().contains("there is no such file"), "{problems}");
}
