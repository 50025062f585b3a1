//! A person walks over the simulated floor, and the viewer does what their feet say.
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

/// What the viewer was like whenever it came to rest while a shipped scenario was played, in real time.
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
    // Of 40 slices on 56 cm, a centimetre is less than one.
    assert!((number(&turned["slice"]) - 32.0).abs() <= 2.0, "{turned}");
    assert!((number(&zoomed["zoom"]) - 2.0).abs() <= 0.3, "{zoomed}");
    assert!(number(&windowed["width"]) > 500.0 && windowed["slice"] == turned["slice"], "{windowed}");
    // The foot goes over half of the free floor, and so the picture over half of its window: 454 of 908 points, of
    // which 5.47 are a millimetre at a zoom of 2.
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
