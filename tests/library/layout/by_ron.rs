//! Values that apps read and write by the crate `ron`: the same as by the library's own reader and writer.

use std::fs;

use ron::ser::{PrettyConfig, to_string_pretty};
use serde::Serialize;
use serde::de::DeserializeOwned;
use underfoot::feel::{Effect, Feel};
use underfoot::floor::{Floor, Geometry};
use underfoot::layout::Look;
use underfoot::schema::{
    ControlKind, Effects, Kinds, NamedEffect, builtin_layout, builtin_layouts, parse_floor, parse_layout,
    write_floor, write_layout,
};

use super::ron_files;

fn by_ron<T: DeserializeOwned>(text: &str) -> T {
    ron::from_str(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Reads what `ron` writes of `value`, in each of its styles.
fn written<T: Serialize>(value: &T) -> [String; 3] {
    let pretty = |style| to_string_pretty(value, style).unwrap();
    [
        ron::to_string(value).unwrap(),
        pretty(PrettyConfig::new()),
        pretty(PrettyConfig::new().struct_names(true).compact_arrays(true)),
    ]
}

fn comes_back<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(value: &T) {
    for text in written(value) {
        assert_eq!(by_ron::<T>(&text), *value, "{text}");
    }
}

#[test]
fn every_effect_is_the_same_by_ron() {
    let effects = Effects::builtin();
    let files = ron_files("effects");
    assert_eq!(files.len(), effects.iter().count());
    for path in files {
        let read: NamedEffect = by_ron(&fs::read_to_string(&path).unwrap());
        assert_eq!(Some(&read), effects.get(&read.name), "{}", path.display());
        comes_back(&read);
        comes_back::<Effect>(&read.effect);
        for text in written(&read) {
            let mut others = Effects::builtin();
            others.add(&text, "written.ron").unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(others, effects, "{text}");
        }
    }
}

#[test]
fn every_kind_is_the_same_by_ron() {
    let kinds = Kinds::builtin();
    let files = ron_files("widgets");
    assert_eq!(files.len(), kinds.iter().count());
    for path in files {
        let read: ControlKind = by_ron(&fs::read_to_string(&path).unwrap());
        assert_eq!(Some(&read), kinds.get(&read.name), "{}", path.display());
        comes_back(&read);
        comes_back::<Feel>(&read.feel);
        comes_back::<Look>(&read.look);
        for text in written(&read) {
            let mut others = Kinds::builtin();
            others.add(&text, "written.ron").unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(others, kinds, "{text}");
        }
    }
}

#[test]
fn every_floor_is_the_same_by_ron() {
    let mut texts: Vec<String> = ron_files("tests/fixtures/84a7726/floors")
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    assert!(texts.len() >= 5);
    texts.push(write_floor(&Floor::default()));
    for page in ["actuators-and-sound", "large-floors", "sensors-and-calibration"] {
        let page = format!("{}/docs/{page}.md", env!("CARGO_MANIFEST_DIR"));
        let page = fs::read_to_string(page).unwrap();
        let blocks = page.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next());
        let floors: Vec<String> =
            blocks.filter(|block| block.contains("Floor(")).map(str::to_owned).collect();
        assert!(!floors.is_empty());
        texts.extend(floors);
    }
    for text in texts {
        let read: Floor = by_ron(&text);
        assert_eq!(read, parse_floor(&text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}")));
        comes_back(&read);
        for text in written(&read) {
            assert_eq!(parse_floor(&text, "written.ron").as_ref(), Ok(&read), "{text}");
        }
    }
}

#[test]
fn a_layout_that_ron_writes_is_the_one_that_the_library_writes() {
    for name in builtin_layouts() {
        let read = |text: &str| {
            let loaded = parse_layout(text, name, &Kinds::builtin(), &Geometry::default());
            loaded.unwrap_or_else(|problems| panic!("{text}\n{problems}")).layout
        };
        let layout = read(builtin_layout(name).unwrap());
        let again = read(&write_layout(&layout));
        for text in written(&layout) {
            assert_eq!(read(&text), again, "{text}");
        }
    }
}

#[test]
fn an_app_s_own_record_may_hold_them() {
    #[derive(serde::Deserialize)]
    struct Settings {
        look: Look,
        kinds: Vec<ControlKind>,
        click: Option<Effect>,
    }
    let text = r##"(
        look: (shape: Round, face: "#102030"), // as on the wall
        kinds: [(name: "bell", behaviour: Switch, press_n: 50, release_n: 30)],
        click: Some(Click(from: "crisp_click", level_n: 3)),
    )"##;
    let settings: Settings = by_ron(text);
    assert_eq!(settings.look.face.to_string(), "#102030");
    assert_eq!(settings.kinds.len(), 1);
    assert!(settings.click.is_some());
    let wrong = text.replace("press_n: 50", "press_n: 5").replace("release_n", "relese_n");
    let problems = ron::from_str::<Settings>(&wrong).err().unwrap().to_string();
    assert!(problems.contains("`press_n` is out of range") && problems.contains("did you mean `release_n`?"));
}
