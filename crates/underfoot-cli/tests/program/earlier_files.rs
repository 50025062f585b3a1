//! Recordings, layouts and floor files of an earlier version replay and load unchanged.

use std::cmp::Ordering;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use serde_json::Value;
use underfoot::floor::Geometry;
use underfoot::recording::Recording;
use underfoot::schema::{Kinds, load_floor, parse_layout, write_floor, write_layout};

use super::end_to_end::{said, underfoot};

/// A folder of files from commit 84a7726.
fn fixtures(folder: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("tests/fixtures/84a7726").join(folder)
}

/// The files of a folder, by name.
fn files(folder: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(fixtures(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{folder}");
    files
}

fn name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// The recording in the compressed file at `path`, unpacked into `folder`.
fn unpack(path: &Path, folder: &Path) -> PathBuf {
    let mut bytes = Vec::new();
    GzDecoder::new(File::open(path).unwrap()).read_to_end(&mut bytes).unwrap();
    let unpacked = folder.join(path.file_stem().unwrap());
    File::create(&unpacked).unwrap().write_all(&bytes).unwrap();
    unpacked
}

/// The data that an app uses: events of controls with their times, values, forces, places and contacts, and the link.
///
/// Later versions may add fields, and lines of other kinds.
fn events(lines: &[String]) -> Vec<Vec<Value>> {
    const FIELDS: [&str; 9] = ["t_s", "event", "id", "value", "force_n", "x_m", "y_m", "contact", "state"];
    let told = |line: &String| {
        let line: Value = serde_json::from_str(line).unwrap();
        let is_told = match line["event"].as_str() {
            Some("link") => true,
            Some("state" | "ignored" | "sent") | None => false,
            Some(_) => line["id"].is_string(),
        };
        is_told.then(|| FIELDS.map(|field| line[field].clone()).to_vec())
    };
    lines.iter().filter_map(told).collect()
}

/// `events` with those around the loss of a link at its time, in the order of their names.
///
/// Since readings that stand still are found plate by plate, a hold may end some milliseconds before the link is lost.
fn settled(mut events: Vec<Vec<Value>>) -> Vec<Vec<Value>> {
    const NEAR_S: f64 = 0.005;
    let seconds = |event: &[Value]| event[0].as_f64().unwrap();
    let lost: Vec<f64> =
        events.iter().filter(|event| event[8] == "lost").map(|event| seconds(event)).collect();
    for event in &mut events {
        if let Some(at) = lost.iter().find(|at| (seconds(event) - **at).abs() < NEAR_S) {
            event[0] = Value::from(*at);
        }
    }
    events.sort_by(|a, b| {
        let in_time = seconds(a).total_cmp(&seconds(b));
        let is_lost = lost.contains(&seconds(a));
        in_time.then_with(|| if is_lost { a[1].as_str().cmp(&b[1].as_str()) } else { Ordering::Equal })
    });
    events
}

/// The controls whose number follows a foot. Since a foot beside one that rests need not be steady first, they answer up
/// to a tenth of a second earlier, and since a foot at rest has a place of its own, with fewer changes.
fn following(events: &[Vec<Value>]) -> Vec<Value> {
    let mut ids: Vec<Value> = Vec::new();
    for event in events {
        if event[1] == "changed" && event[3].is_number() && !ids.contains(&event[2]) {
            ids.push(event[2].clone());
        }
    }
    ids
}

/// Seconds and names of the events of a control but for its changes.
fn holds<'a>(events: &'a [Vec<Value>], id: &Value) -> Vec<(f64, &'a str)> {
    let own = events.iter().filter(|event| event[2] == *id && event[1] != "changed" && event[1] != "ticked");
    own.map(|event| (event[0].as_f64().unwrap(), event[1].as_str().unwrap())).collect()
}

/// Names, numbers and marks.
fn words(text: &str) -> Vec<&str> {
    text.split_inclusive([' ', '(', ')', '[', ']', ',', ':'])
        .flat_map(|word| {
            let (name, mark) =
                word.split_at(word.len() - usize::from(!word.ends_with(char::is_alphanumeric)));
            [name.trim(), mark.trim()]
        })
        .filter(|word| !word.is_empty())
        .collect()
}

#[test]
fn a_recording_of_an_earlier_version_gives_the_events_that_it_gave_then() {
    let folder = tempfile::tempdir().unwrap();
    for packed in files("recordings") {
        let file = unpack(&packed, folder.path());
        let recorded = Recording::open(&file).unwrap().events();
        let recorded: Vec<String> = recorded.map(|line| String::from_utf8(line.unwrap()).unwrap()).collect();
        let output = underfoot()
            .arg("replay")
            .arg(&file)
            .args(["--speed", "max", "--no-osc", "--json"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}: {}", name(&file), said(&output));
        let replayed: Vec<String> =
            String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect();
        let (then, now) = (settled(events(&recorded)), settled(events(&replayed)));
        assert!(then.iter().any(|event| event[1] == "pressed" && event[2] == "drive"), "{}", name(&file));
        let following = following(&then);
        let exact = |events: &[Vec<Value>]| -> Vec<_> {
            events.iter().filter(|event| !following.contains(&event[2])).cloned().collect()
        };
        let (then_exact, now_exact) = (exact(&then), exact(&now));
        for (then, now) in then_exact.iter().zip(&now_exact) {
            assert_eq!(then, now, "{}", name(&file));
        }
        assert_eq!(then_exact.len(), now_exact.len(), "{}: {now:?}", name(&file));
        for id in &following {
            let (then, now) = (holds(&then, id), holds(&now, id));
            assert_eq!(then.len(), now.len(), "{}: {id}: {then:?}, now {now:?}", name(&file));
            for (then, now) in then.iter().zip(&now) {
                assert_eq!(then.1, now.1, "{}: {id}", name(&file));
                assert!(
                    (-0.005..0.12).contains(&(then.0 - now.0)),
                    "{}: {id}: {then:?}, now {now:?}",
                    name(&file)
                );
            }
        }
    }
}

/// The lines of a written floor, except its comments: later versions may word them better.
fn without_comments(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.trim_start().starts_with("//")).collect()
}

#[test]
fn a_floor_file_of_an_earlier_version_is_written_as_it_was() {
    for file in files("floors") {
        let floor = load_floor(&file).unwrap_or_else(|problems| panic!("{problems}"));
        if name(&file) != "newtons.ron" {
            let (then, now) = (fs::read_to_string(&file).unwrap(), write_floor(&floor));
            assert_eq!(without_comments(&now), without_comments(&then), "{}", name(&file));
        }
    }
}

#[test]
fn a_layout_of_an_earlier_version_is_written_as_it_was() {
    for file in files("written_layouts") {
        let text = fs::read_to_string(&file).unwrap();
        let loaded = parse_layout(&text, name(&file), &Kinds::builtin(), &Geometry::default())
            .unwrap_or_else(|problems| panic!("{problems}"));
        let written = write_layout(&loaded.layout);
        let (then, now) = (words(&text), words(&written));
        assert_eq!(then.len(), now.len(), "{}", name(&file));
        for (then, now) in then.into_iter().zip(now) {
            let is_same = match (then.parse::<f32>(), now.parse::<f32>()) {
                // Places are written in metres, and the last digit may vary.
                (Ok(then), Ok(now)) => (then - now).abs() <= 1e-6,
                _ => then == now,
            };
            assert!(is_same, "{}: {then} has become {now}", name(&file));
        }
    }
}

#[test]
fn a_layout_of_an_earlier_version_loads_without_a_warning() {
    for file in files("layouts") {
        let text = fs::read_to_string(&file).unwrap();
        let loaded = parse_layout(&text, name(&file), &Kinds::builtin(), &Geometry::default())
            .unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(loaded.warnings.to_string(), "", "{}", name(&file));
    }
}
