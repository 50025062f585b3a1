//! F6, F7, F9 and F10: files that are wrong, odd, newer than this program, or saved under a foot.

use std::path::Path;
use std::process::Output;
use std::time::Duration;

use serde_json::Value;
use underfoot::glam::Vec2;

use super::live::Live;
use super::tape::{BUTTON, PEDAL};
use crate::end_to_end::{said, underfoot};

fn check(path: &Path, more: &[&str]) -> Output {
    underfoot().arg("check").args(more).arg(path).output().unwrap()
}

/// A file with this text.
fn file(folder: &Path, name: &str, text: impl AsRef<[u8]>) -> std::path::PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn f6_a_layout_with_nonsense_is_refused_with_every_place() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"Layout(version: 1, regions: [(id: "r", at: (0, 0), size: (6, 6))], widgets: [
    (id: "nan", kind: "button", at: (NaN, 1), size: (1, 1)),
    (id: "small", kind: "button", at: (2, 1), size: (-1, 1)),
    (id: "odd", kind: "no_such_kind", at: (4, 1), size: (1, 1)),
    (id: "twice", kind: "button", at: (1, 3), size: (1, 1)),
    (id: "twice", kind: "button", at: (3, 3), size: (1, 1)),
    (id: "below", kind: "button", at: (3.2, 3.2), size: (1, 1)),
])"#;
    let path = file(folder.path(), "bad.ron", text);
    let output = check(&path, &["--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let problems: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let lines: Vec<u64> = problems.iter().filter_map(|problem| problem["line"].as_u64()).collect();
    assert!([2, 3, 4, 6].iter().all(|line| lines.contains(line)), "{}", said(&output));
    let run = underfoot().args(["run", "--seconds", "1"]).arg(&path).output().unwrap();
    assert_eq!(run.status.code(), Some(1), "{}", said(&run));
}

#[test]
fn f6_a_layout_with_too_much_is_refused_before_it_takes_memory() {
    let folder = tempfile::tempdir().unwrap();
    let page = |widgets: &str| {
        format!("Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [{widgets}])")
    };
    for (text, why) in [
        (page(&"(),".repeat(5000)), "more than 4096 entries"),
        (page(&"(".repeat(100_000)), "brackets nest deeper than 64"),
        (" ".repeat((4 << 20) + 1), "larger than 4 MB"),
    ] {
        let path = file(folder.path(), "big.ron", text);
        for output in [check(&path, &[]), underfoot().arg("run").arg(&path).output().unwrap()] {
            assert_eq!(output.status.code(), Some(1), "{why}");
            assert!(said(&output).contains(why), "{why}: {:.500}", said(&output));
        }
    }
}

#[test]
fn f7_odd_files_are_taken_or_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron")).unwrap();
    // As Windows writes it, with its byte order mark.
    let utf16: Vec<u8> = format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let good = [
        ("mark.ron", format!("\u{feff}{text}").into_bytes()),
        ("windows.ron", text.replace('\n', "\r\n").into_bytes()),
    ];
    for (name, bytes) in good {
        let output = check(&file(folder.path(), name, bytes), &[]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", said(&output));
    }
    for (name, bytes) in [("utf16.ron", utf16), ("latin.ron", b"// \xe9\nLayout()".to_vec())] {
        let output = check(&file(folder.path(), name, bytes), &[]);
        assert_eq!(output.status.code(), Some(1), "{name}");
        assert!(said(&output).contains("UTF-8"), "{name}: {}", said(&output));
    }
    #[cfg(unix)]
    {
        let link = folder.path().join("link.ron");
        std::os::unix::fs::symlink(folder.path().join("windows.ron"), &link).unwrap();
        assert_eq!(check(&link, &[]).status.code(), Some(0));
        let gone = folder.path().join("gone.ron");
        std::os::unix::fs::symlink(folder.path().join("nothing.ron"), &gone).unwrap();
        let output = check(&gone, &[]);
        assert!(output.status.code() == Some(1) && said(&output).contains("gone.ron"), "{}", said(&output));
    }
}

#[test]
fn f9_files_of_a_newer_version_are_refused_with_both_versions() {
    let folder = tempfile::tempdir().unwrap();
    let layout = file(folder.path(), "page.ron", BUTTON.replace("version: 1", "version: 97"));
    let floor = file(folder.path(), "floor.ron", "Floor(version: 98, columns: 2, rows: 2)");
    let floored = underfoot().args(["run", "map", "--seconds", "1", "--floor"]).arg(&floor).output().unwrap();
    for (output, version) in [(check(&layout, &[]), "97"), (floored, "98")] {
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        assert!(said(&output).contains(version) && said(&output).contains("version"), "{}", said(&output));
        assert!(said(&output).contains('1'), "and its own: {}", said(&output));
    }
}

/// Two controls, of which one is new or elsewhere.
fn with_another(first: &str) -> String {
    format!(
        "Layout(version: 1, regions: [(id: \"all\", at: (0, 0), size: (2, 2))], widgets: [{first} \
         (id: \"other\", kind: \"button\", at: (1, 1), size: (1, 1))])"
    )
}

/// The middle of that other control, which is a tile's.
const OTHER: Vec2 = Vec2::new(0.456, 0.456);

/// The layout is saved while a foot holds a control of it: the new one waits until the foot is off.
#[test]
fn f10_a_layout_saved_under_a_foot_waits_for_it() {
    let live = Live::start(PEDAL, &["-v"]);
    live.press_until_it_is_held();
    let before = live.ends();
    let page = with_another("(id: \"it\", kind: \"dead_man\", at: (0, 0), size: (0.9, 0.9)),");
    std::fs::write(live.folder.path().join("page.ron"), page).unwrap();
    live.wait_until("it is read", |live| live.has_said("the changed layout is on the floor"));
    std::thread::sleep(Duration::from_millis(500));
    assert!(live.ends() == before || live.was_lost(), "{:?}", live.lines());
    live.press(0.0);
    live.wait_until("it is let go of", |live| live.ends() > before);
    live.wait_until("the new one is there", |live| {
        live.press_at(OTHER, 150.0);
        std::thread::sleep(Duration::from_millis(300));
        live.press_at(OTHER, 0.0);
        std::thread::sleep(Duration::from_millis(300));
        live.count("other clicked") > 0
    });
    assert_eq!(live.end().0, Some(0));
}

#[test]
fn f10_a_control_that_a_saved_layout_lacks_is_cancelled() {
    let live = Live::start(PEDAL, &["-v"]);
    live.press_until_it_is_held();
    std::fs::write(live.folder.path().join("page.ron"), with_another("")).unwrap();
    live.wait_until("it is cancelled", |live| live.count("it cancelled") > 0);
    assert_eq!(live.end().0, Some(0));
}
