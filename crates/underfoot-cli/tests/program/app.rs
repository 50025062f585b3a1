//! The example of an app, driven by the program in a process of its own.

use std::process::Stdio;
use std::sync::mpsc;
use std::thread;

use super::end_to_end::underfoot;
use crate::ports::free_port;

#[allow(dead_code)]
#[path = "../../../../examples/runtime.rs"]
mod runtime;

const VISIT: &str = include_str!("visit.ron");

#[test]
fn a_floor_in_another_process_drives_an_app_of_25_lines() {
    let address = format!("127.0.0.1:{}", free_port());
    let (tell, told) = mpsc::channel();
    // The example is run from the root and opens its layout there.
    std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).unwrap();
    let app = thread::spawn({
        let address = address.clone();
        move || runtime::follow(&address, |line| tell.send(line).unwrap()).map_err(|error| error.to_string())
    });
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("visit.ron"), VISIT).unwrap();
    let sent = underfoot()
        .current_dir(folder.path())
        .args(["simulate", "--quality", "paper", "--scenario", "visit.ron", "--send", &address])
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert!(sent.success());
    app.join().unwrap().unwrap();
    let lines: Vec<String> = told.try_iter().collect();
    let heard = |line: &str| lines.iter().any(|other| other == line);
    assert!(heard("home pressed") && heard("home released") && heard("zoom pressed"), "{lines:?}");
    let zooms: Vec<f32> = lines.iter().filter_map(|line| line.strip_prefix("zoom ")?.parse().ok()).collect();
    assert!(zooms.last().is_some_and(|zoom| (0.65..0.85).contains(zoom)), "{lines:?}");
    assert_eq!(lines.last().unwrap(), "the floor is gone: stopped");
}

#[test]
fn the_example_has_25_lines_of_code_at_most() {
    let text = include_str!("../../../../examples/runtime.rs");
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
    assert!(text.lines().filter(is_code).count() <= 25);
    assert!(
        text.lines()
            .all(|line| !line.starts_with("use ") || line.contains("std::") || line.contains("underfoot::"))
    );
}
