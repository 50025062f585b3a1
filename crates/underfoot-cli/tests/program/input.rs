//! Invalid files and numbers as input of the program.

use std::path::Path;
use std::process::{Child, Output, Stdio};
use std::time::{Duration, Instant};

use super::end_to_end::{said, underfoot};

/// Longest time of a command before it counts as hanging.
const PATIENCE: Duration = Duration::from_secs(30);

/// The output and status of a command; panics if it does not end.
fn ended(arguments: &[&str], folder: &Path) -> Output {
    let mut child: Child = underfoot()
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let until = Instant::now() + PATIENCE;
    while child.try_wait().unwrap().is_none() {
        if Instant::now() > until {
            child.kill().unwrap();
            panic!("{arguments:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap()
}

/// Every reader, with `FILE` in place of its file.
const READERS: [&[&str]; 11] = [
    &["check", "FILE"],
    &["run", "FILE", "--seconds", "1"],
    &["run", "map", "--floor", "FILE", "--seconds", "1"],
    &["run", "map", "--effects", "FOLDER", "--seconds", "1"],
    &["run", "map", "--widgets", "FOLDER", "--seconds", "1"],
    &["simulate", "--scenario", "FILE", "--seconds", "1"],
    &["session", "--scenario", "FILE"],
    &["feel", "FILE"],
    &["sense", "FILE"],
    &["calibrate", "curves", "FILE"],
    &["calibrate", "map", "FILE"],
];

/// A window that shows a remote floor has no outputs here, and reports so for every option of an output.
#[cfg(feature = "preview")]
#[test]
fn a_floor_of_elsewhere_is_not_served_here() {
    let folder = tempfile::tempdir().unwrap();
    let options = [
        "--device paced",
        "--rate 48000",
        "--seed 3",
        "--no-osc",
        "--json",
        "--pin",
        "--wav feet.wav",
        "--eq4",
    ];
    for elsewhere in ["--join 127.0.0.1:9", "--follow -"] {
        for option in options {
            let arguments: Vec<&str> =
                ["preview"].into_iter().chain(elsewhere.split(' ')).chain(option.split(' ')).collect();
            let output = ended(&arguments, folder.path());
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
            let name = option.split(' ').next().unwrap();
            assert!(
                said(&output).contains(&format!("cannot be used with '{name}")),
                "{arguments:?}: {}",
                said(&output)
            );
        }
    }
}

/// A device that never ends and a pipe without a writer are refused; neither is read.
#[cfg(unix)]
#[test]
fn devices_and_pipes_are_refused_by_every_reader() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    assert!(std::process::Command::new("mkfifo").arg(at("pipe.ahap")).status().unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", at("zero.ahap")).unwrap();
    for (kind, file) in [("pipes", "pipe.ahap"), ("zeros", "zero.ahap")] {
        std::fs::create_dir(at(kind)).unwrap();
        std::os::unix::fs::symlink(at(file), at(kind).join("a.ron")).unwrap();
        for reader in READERS {
            let named = reader.iter().map(|word| match *word {
                "FILE" => file,
                "FOLDER" => kind,
                word => word,
            });
            let arguments: Vec<&str> = named.collect();
            let output = ended(&arguments, folder.path());
            assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", said(&output));
            assert!(said(&output).contains("not an ordinary file"), "{arguments:?}: {}", said(&output));
        }
    }
}

/// A sparse file of a gigabyte is refused before it is read.
#[test]
fn files_that_are_too_large_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = std::fs::File::create(folder.path().join("large.ahap")).unwrap();
    file.set_len(1 << 30).unwrap();
    for reader in READERS.iter().filter(|reader| reader.contains(&"FILE") && reader[0] != "sense") {
        let arguments: Vec<&str> =
            reader.iter().map(|word| if *word == "FILE" { "large.ahap" } else { word }).collect();
        let output = ended(&arguments, folder.path());
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains("is larger than"), "{arguments:?}: {}", said(&output));
    }
}

/// No option accepts a value that is not a finite number, or one outside the range of floors.
#[test]
fn numbers_are_finite_and_in_range() {
    let folder = tempfile::tempdir().unwrap();
    let mut options: Vec<&[&str]> = vec![
        &["run", "map", "--seconds"],
        &["run", "map", "--delay-ms"],
        &["run", "map", "--rate"],
        &["simulate", "--seconds"],
        &["session", "--rate"],
        &["measure", "--seconds"],
        &["calibrate", "tare", "--floor", "f.ron", "--seconds"],
        &["rack", "walk", "--level-n"],
        &["rack", "walk", "--pace-ms"],
    ];
    if cfg!(feature = "lab") {
        options.extend([
            &["feel", "click", "--seconds"] as &[&str],
            &["feel", "click", "--speed"],
            &["feel", "click", "--force"],
            &["feel", "click", "--full-scale"],
            &["capacity", "--seconds"],
            &["experiment", "spot", "--floors"],
            &["experiment", "feet", "--people"],
        ]);
    }
    for option in options {
        for number in ["nan", "inf", "-inf", "1e300", "-1", "99999999999999999999", "", "ten"] {
            let value = format!("{}={number}", option.last().unwrap());
            let arguments: Vec<&str> =
                option[..option.len() - 1].iter().copied().chain([value.as_str()]).collect();
            let output = ended(&arguments, folder.path());
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        }
    }
}
