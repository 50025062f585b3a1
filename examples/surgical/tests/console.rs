//! A person walks over the simulated floor, and the viewer follows their feet.
#![allow(clippy::panic, clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};

fn viewer(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_underfoot-surgical")).args(arguments).output().unwrap()
}

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The viewer's state each time it came to rest during a shipped scenario, played in real time.
fn rests(scenario: &str) -> Vec<Value> {
    let scenario = shipped(scenario);
    let output = viewer(&["--no-window", "--print-state", "--scenario", scenario.to_str().unwrap()]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

#[test]
fn a_reading_turns_slices_zooms_windows_pans_measures_and_takes_another_series() {
    let rests = rests("reading.ron");
    let [start, turned, zoomed, windowed, panned, measured, .., other] = rests.as_slice() else {
        panic!("{rests:#?}")
    };
    assert_eq!((&start["frames"], &start["range"]), (&json!(40), &json!([1.0, 40.0])));
    // With 40 slices on 56 cm, a centimetre is less than one.
    assert!((number(&turned["slice"]) - 32.0).abs() <= 2.0, "{turned}");
    assert!((number(&zoomed["zoom"]) - 2.0).abs() <= 0.3, "{zoomed}");
    assert!(number(&windowed["width"]) > 500.0 && windowed["slice"] == turned["slice"], "{windowed}");
    // The foot moves over half of the free floor, and so the picture over half of its window: 454 of 908 points; a
    // millimetre takes 5.47 of them at a zoom of 2.
    let way = number(&panned["middle"][0]) - number(&start["middle"][0]);
    let expected = 0.5 * 908.0 / (766.0 / 280.0 * number(&zoomed["zoom"]));
    assert!((way - expected).abs() < 0.15 * expected, "{way} is not {expected}: {panned}");
    let length = number(&measured["measures"][0]);
    assert!((length - way).abs() < 2.0, "{length} is not {way}");
    assert_eq!((&other["series"], &other["range"]), (&json!("XA Phantom, X-rayed"), &json!([1.0, 24.0])));
    assert_eq!(other["measures"], json!([]), "each series has its own");
}

#[test]
fn the_beam_ends_by_lifting_by_time_and_with_the_floor_and_clearing_is_confirmed() {
    let rests = rests("imaging.ron");
    let beam = |rest: &Value| {
        let [on, warned, lost] = ["beam", "warned", "lost"].map(|name| rest[name].as_bool().unwrap());
        (on, warned, lost, rest["ended"].as_str().unwrap_or("").to_owned(), number(&rest["shots"]) as u32)
    };
    let mut seen: Vec<_> = rests.iter().map(beam).collect();
    seen.dedup();
    let state = |on, warned, lost, ended: &str, shots| (on, warned, lost, ended.to_owned(), shots);
    let expected = [
        state(false, false, false, "", 0),
        state(true, false, false, "", 1),
        state(false, false, false, "lifted", 1),
        state(true, false, false, "", 2),
        state(true, true, false, "", 2),
        state(false, false, false, "time", 2),
        state(true, false, false, "", 3),
        state(false, false, true, "floor_lost", 3),
        state(false, false, false, "floor_lost", 3),
    ];
    assert_eq!(seen, expected);
    let measures: Vec<usize> = rests.iter().map(|rest| rest["measures"].as_array().unwrap().len()).collect();
    let (one, none) = (measures.iter().position(|count| *count == 1), measures.last());
    assert!(one.is_some() && none == Some(&0), "{measures:?}");
}

#[test]
fn what_can_t_be_shown_is_told_with_its_name_and_nothing_starts() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("letter.txt"), "Dear colleague").unwrap();
    let told = viewer(&["--no-window", folder.path().to_str().unwrap()]);
    let words = String::from_utf8_lossy(&told.stderr).into_owned();
    assert!(!told.status.success());
    assert!(words.contains("letter.txt is not a DICOM file"), "{words}");
    assert!(words.contains("no picture that can be shown"), "{words}");
    let told = viewer(&["--no-window", "/nowhere/at/all"]);
    assert!(String::from_utf8_lossy(&told.stderr).contains("/nowhere/at/all"));
}

/// A DICOM file of two grey pixels, 7 and 9.
fn two_pixels() -> Vec<u8> {
    let element = |tag: [u8; 4], kind: &[u8; 2], value: &[u8]| {
        let length = (value.len() as u16).to_le_bytes();
        [tag.as_slice(), kind, &length, value].concat()
    };
    let number = |element_of: u8, number: u8| element([0x28, 0, element_of, 0], b"US", &[number, 0]);
    let bits =
        [0x00, 0x01, 0x02].map(|part| element([0x28, 0, part, 1], b"US", &[8 - u8::from(part == 2), 0]));
    [
        vec![0; 128],
        b"DICM".to_vec(),
        element([2, 0, 0x10, 0], b"UI", b"1.2.840.10008.1.2.1\0"),
        element([8, 0, 0x60, 0], b"CS", b"OT"),
        number(0x02, 1),
        number(0x10, 1),
        number(0x11, 2),
        bits.concat(),
        vec![0xe0, 0x7f, 0x10, 0, b'O', b'B', 0, 0, 2, 0, 0, 0, 7, 9],
    ]
    .concat()
}

#[test]
fn files_are_checked_without_a_window() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (picture, letter) = (at("picture.dcm"), at("letter.txt"));
    std::fs::write(&picture, two_pixels()).unwrap();
    std::fs::write(&letter, "Dear colleague").unwrap();
    let values = folder.path().to_str().unwrap();
    let checked = viewer(&["check", "--values", values, &letter, &picture]);
    assert_eq!(checked.status.code(), Some(1), "one is not shown");
    let text = String::from_utf8(checked.stdout).unwrap();
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [no, yes] = lines.as_slice() else { panic!("{text}") };
    assert_eq!((&no["shown"], &no["file"]), (&json!(false), &json!(letter)));
    assert_eq!(no["why"], "is not a DICOM file: it does not begin as one");
    assert_eq!((&yes["shown"], &yes["size"], &yes["frames"]), (&json!(true), &json!([2, 1]), &json!(1)));
    let written = std::fs::read(folder.path().join("1.f32")).unwrap();
    assert_eq!(written, [7.0_f32.to_le_bytes(), 9.0_f32.to_le_bytes()].concat());
    assert!(viewer(&["check", &picture]).status.success());
}

#[cfg(unix)]
#[test]
fn a_pipe_that_nobody_writes_to_does_not_hold_the_viewer_up() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.dcm");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for arguments in [["check", pipe.to_str().unwrap()], ["--no-window", folder.path().to_str().unwrap()]] {
        let told = viewer(&arguments);
        assert!(!told.status.success());
        let words = [told.stdout, told.stderr].concat();
        let words = String::from_utf8_lossy(&words);
        assert!(
            words.contains("a pipe, a device") || words.contains("neither a file nor a folder"),
            "{words}"
        );
    }
}
