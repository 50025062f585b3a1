//! Files that come into the window as texts, as a browser gives them: broken ones change nothing.

use super::*;
use crate::preview::design::arrivals::{take_layout, take_parts};

const KIND: &str = r#"Kind(name: "huge", from: "button", feel: (press: "thud"))"#;
const EFFECT: &str =
    r#"Effect(name: "thud", about: "A low one", plays: Click(level_n: 9, modes: [(hz: 90, decay_ms: 30)]))"#;

fn at(folder: &TempDir, name: &str) -> PathBuf {
    folder.path().join(name)
}

fn kept(folder: &TempDir, name: &str) -> Option<String> {
    std::fs::read_to_string(at(folder, name)).ok()
}

#[test]
fn a_broken_kind_or_effect_that_comes_alone_is_told_with_its_place_and_not_kept() {
    let (desk, folder) = (Desk::map(), tempfile::tempdir().unwrap());
    let take =
        |name: &str, text: &str| take_parts(desk.designer(), vec![(at(&folder, name), text.to_owned())]);
    // The bracket of the second line has no end.
    let broken = take("widgets/huge.ron", "Kind(name: \"huge\",\n    from: \"button\", look: (");
    assert_eq!((broken.kept, broken.refused.len()), (0, 1));
    assert!(broken.refused[0].contains("widgets/huge.ron:2:"), "{}", broken.refused[0]);
    assert_eq!(kept(&folder, "widgets/huge.ron"), None);
    // Alone, the kind lacks its effect; with it, both are kept.
    let alone = take("widgets/huge.ron", KIND);
    assert!(alone.kept == 0 && alone.refused[0].contains("thud"), "{alone:?}");
    let both = [("widgets/huge.ron", KIND), ("effects/thud.ron", EFFECT)];
    let both = both.map(|(name, text)| (at(&folder, name), text.to_owned()));
    let taken = take_parts(desk.designer(), both.to_vec());
    assert_eq!((taken.kept, taken.refused.len()), (2, 0), "{taken:?}");
    // The last good text of a file outlasts broken ones of the same name.
    for (name, good) in [("widgets/huge.ron", KIND), ("effects/thud.ron", EFFECT)] {
        let taken = take(name, &good[..good.len() / 2]);
        assert_eq!((taken.kept, taken.refused.len()), (0, 1), "{name}: {taken:?}");
        assert_eq!(kept(&folder, name).as_deref(), Some(good));
    }
    assert_eq!(take("widgets/other.ron", &KIND.replace("huge", "other")).kept, 1, "nothing broken is left");
}

#[test]
fn of_a_folder_the_readable_kinds_are_kept_and_each_broken_one_is_told() {
    let (desk, folder) = (Desk::map(), tempfile::tempdir().unwrap());
    let names: Vec<String> = (1..=5).map(|number| format!("kind_{number}")).collect();
    let part = |(number, name): (usize, &String)| {
        let text = format!("Kind(name: \"{name}\", from: \"button\"{}", if number < 2 { ")" } else { "" });
        (at(&folder, &format!("widgets/{name}.ron")), text)
    };
    let taken = take_parts(desk.designer(), names.iter().enumerate().map(part).collect());
    assert_eq!((taken.kept, taken.refused.len()), (2, 3), "{taken:?}");
    for (name, told) in names[2..].iter().zip(&taken.refused) {
        assert!(told.contains(&format!("{name}.ron:1:")), "{told}");
    }
    assert_eq!(std::fs::read_dir(at(&folder, "widgets")).unwrap().count(), 2);
}

#[test]
fn a_broken_layout_leaves_the_open_one_and_the_file_before() {
    let (mut desk, folder) = (Desk::map(), tempfile::tempdir().unwrap());
    let path = at(&folder, "mine.ron");
    let text = builtin_layout("map").unwrap().replace("\"Home\"", "\"Start\"");
    assert!(take_layout(desk.designer_mut(), &path, &text));
    assert!(desk.text().contains("\"Start\""));
    let half = &text[..text.len() / 2];
    assert!(!take_layout(desk.designer_mut(), &path, half));
    desk.window.run_steps(2);
    assert!(desk.says("mine.ron:"), "the place of the problem");
    assert_eq!((kept(&folder, "mine.ron"), desk.text()), (Some(text.clone()), text));
}
