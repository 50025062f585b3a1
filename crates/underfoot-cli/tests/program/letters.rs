//! Labels in other scripts, on computers with and without fonts for them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A layout of controls with these labels.
fn layout(folder: &Path, labels: &[&str]) {
    let widgets: String = labels
        .iter()
        .enumerate()
        .map(|(number, label)| {
            let east = 0.2 + 1.1 * number as f32;
            format!(
                "    (id: \"c{number}\", kind: \"button\", at: ({east:.1}, 3), size: (0.8, 0.8), label: \"{label}\"),\n"
            )
        })
        .collect();
    let text = format!(
        "Layout(version: 1, regions: [(id: \"r\", at: (0, 2), size: (6, 4))], widgets: [\n{widgets}])\n"
    );
    fs::write(folder.join("it.ron"), text).unwrap();
}

/// The program on a computer that has only the fonts in `fonts`.
fn underfoot(folder: &Path, fonts: &Path, arguments: &[&str]) -> Output {
    let config = folder.join("fonts.conf");
    let text = format!("<?xml version=\"1.0\"?>\n<fontconfig><dir>{}</dir></fontconfig>\n", fonts.display());
    fs::write(&config, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_underfoot"));
    command.args(arguments).current_dir(folder).env("FONTCONFIG_FILE", config).output().unwrap()
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A few letters of Hebrew, Arabic and Devanagari.
fn few() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/fonts"))
}

#[test]
fn check_warns_of_letters_that_no_font_of_the_computer_has() {
    let folder = tempfile::tempdir().unwrap();
    let none = folder.path().join("none");
    fs::create_dir(&none).unwrap();
    layout(folder.path(), &["Home 🏠", "Дом", "בית", "首页"]);
    let output = underfoot(folder.path(), &none, &["check", "it.ron"]);
    let said = told(&output);
    assert!(output.status.success(), "a warning: {said}");
    assert_eq!(said.matches("[U304]").count(), 2, "{said}");
    assert!(said.contains("no font has 首 (U+9996) and 页 (U+9875)") && said.contains("it.ron:5:"), "{said}");
    assert!(said.contains("ב (U+05D1)") && said.contains("it.ron:4:"), "{said}");
    assert!(!underfoot(folder.path(), &none, &["check", "--strict", "it.ron"]).status.success());
    // A computer with a Hebrew font draws one of them.
    let said = told(&underfoot(folder.path(), few(), &["check", "it.ron"]));
    assert!(said.matches("[U304]").count() == 1 && said.contains("首"), "{said}");
}

#[test]
fn a_picture_is_drawn_without_fonts_and_says_which_letters_are_boxes() {
    let folder = tempfile::tempdir().unwrap();
    let none = folder.path().join("none");
    fs::create_dir(&none).unwrap();
    layout(folder.path(), &["首页"]);
    for picture in ["it.png", "it.svg"] {
        let output = underfoot(folder.path(), &none, &["render", "it.ron", "--out", picture]);
        assert!(output.status.success() && told(&output).contains("U304"), "{}", told(&output));
        assert!(folder.path().join(picture).exists());
    }
}

#[test]
fn a_picture_in_the_programs_own_letters_is_the_same_on_every_computer() {
    let folder = tempfile::tempdir().unwrap();
    let none = folder.path().join("none");
    fs::create_dir(&none).unwrap();
    layout(folder.path(), &["Größe", "Дом", "Σ → 🏠"]);
    let drawn = |fonts: &Path, name: &str| {
        let output = underfoot(folder.path(), fonts, &["render", "it.ron", "--out", name]);
        assert!(output.status.success() && !told(&output).contains("U304"), "{}", told(&output));
        fs::read(folder.path().join(name)).unwrap()
    };
    for name in ["it.png", "it.svg"] {
        assert!(drawn(&none, name) == drawn(few(), name), "{name}");
    }
    let svg = String::from_utf8(drawn(&none, "it.svg")).unwrap();
    assert!(!svg.contains("<text") && svg.contains("aria-label=\"Größe\""));
}

#[test]
fn hebrew_in_a_picture_is_outlines_of_the_computers_font() {
    let folder = tempfile::tempdir().unwrap();
    layout(folder.path(), &["בית 12"]);
    let output = underfoot(folder.path(), few(), &["render", "it.ron", "--out", "it.svg"]);
    assert!(output.status.success() && told(&output).is_empty(), "{}", told(&output));
    let svg = fs::read_to_string(folder.path().join("it.svg")).unwrap();
    let line = svg.lines().find(|line| line.contains("aria-label=\"בית 12\"")).unwrap();
    // Three letters and two digits; the box of a missing letter would be the same three times.
    assert!(line.matches('M').count() >= 5, "{line}");
}
