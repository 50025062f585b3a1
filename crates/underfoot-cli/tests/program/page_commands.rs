//! The commands of README.md and of the pages under docs/ run, and those named in their sentences exist.

use std::path::Path;
use std::process::Command;

use super::end_to_end::{said, underfoot};
use crate::pages::pages;

/// The files that the commands of some pages leave in their folder.
const MADE: [(&str, &[&str]); 5] = [
    ("docs/first-floor.md", &["map.png"]),
    ("docs/effects.md", &["rubber.wav", "rubber.png", "double_click.ahap", "double_click.ron"]),
    ("docs/osc-and-tuio.md", &["out.wav"]),
    ("docs/sensors-and-calibration.md", &["floor.ron"]),
    ("docs/simulator.md", &["visit/floor.png", "visit/events.jsonl", "figures/figure8.png"]),
];

/// The commands of one page run in sequence, in a folder of their own with the shipped layouts in it.
#[test]
fn every_command_runs() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let program = Path::new(env!("CARGO_BIN_EXE_underfoot"));
    let path = std::env::join_paths(
        [program.parent().unwrap().to_path_buf()]
            .into_iter()
            .chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    )
    .unwrap();
    let mut made = 0;
    for page in pages() {
        let folder = tempfile::tempdir().unwrap();
        let layouts = folder.path().join("layouts");
        std::fs::create_dir(&layouts).unwrap();
        for file in std::fs::read_dir(root.join("layouts")).unwrap() {
            let file = file.unwrap();
            std::fs::copy(file.path(), layouts.join(file.file_name())).unwrap();
        }
        for block in page.blocks("sh") {
            let output = Command::new("sh")
                .args(["-ec", &block])
                .current_dir(folder.path())
                .env("PATH", &path)
                .env_remove("DISPLAY")
                .env_remove("WAYLAND_DISPLAY")
                .output()
                .unwrap();
            assert!(output.status.success(), "{}:\n{block}\n{}", page.name, said(&output));
        }
        for file in MADE.iter().filter(|(name, _)| *name == page.name).flat_map(|(_, files)| *files) {
            assert!(folder.path().join(file).exists(), "{} leaves no {file}", page.name);
            made += 1;
        }
    }
    assert_eq!(made, MADE.iter().map(|(_, files)| files.len()).sum::<usize>());
}

/// `underfoot this --that` in a sentence: the command exists, and its help lists the option.
#[test]
fn every_command_in_a_sentence_exists() {
    let mut count = 0;
    for page in pages() {
        for span in page.code() {
            let Some(words) = span.strip_prefix("underfoot ").filter(|words| !words.starts_with('=')) else {
                continue;
            };
            let words: Vec<&str> = words.split_whitespace().collect();
            if !cfg!(feature = "preview") && words[0] == "preview" {
                continue;
            }
            let is_name = |word: &&&str| word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            let names = words.iter().take_while(is_name);
            let options = words.iter().filter(|word| word.starts_with("--"));
            let output = underfoot().args(names).arg("--help").output().unwrap();
            let help = String::from_utf8_lossy(&output.stdout).into_owned();
            assert!(output.status.success(), "{}: `{span}`\n{}", page.name, said(&output));
            for option in options {
                assert!(help.contains(option), "{}: `{span}` has no {option}", page.name);
            }
            count += 1;
        }
    }
    assert!(count >= 15, "{count}");
}
