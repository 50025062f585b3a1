//! `underfoot session`: people of a scenario on a simulated floor, in the floor's own time.

use std::path::Path;

use serde_json::Value;

use crate::end_to_end::{said, underfoot};

/// The reports of controls and floor while a scenario is played on a page, with these additional options.
pub fn session(page: &str, scenario: &str, more: &[&str]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("page.ron"), page).unwrap();
    std::fs::write(folder.path().join("visit.ron"), scenario).unwrap();
    play(folder.path(), more);
    let lines = std::fs::read_to_string(folder.path().join("out/events.jsonl")).unwrap();
    lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Plays `visit.ron` on `page.ron`, both in `folder`, into its folder `out`, with these additional options.
pub fn play(folder: &Path, more: &[&str]) {
    let output = underfoot()
        .current_dir(folder)
        .args([
            "session",
            "page.ron",
            "--scenario",
            "visit.ron",
            "--quality",
            "paper",
            "--calibrate",
            "--out",
            "out",
            "--rate",
            "8000",
        ])
        .args(more)
        .output()
        .unwrap();
    assert!(output.status.success(), "{more:?}: {}", said(&output));
}
