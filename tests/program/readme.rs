//! What the README shows is true: its files are good and its commands run.

use std::path::Path;
use std::process::Command;

use underfoot::floor::Floor;
use underfoot::schema::{self, Kinds};

const README: &str = include_str!("../../README.md");

/// The fenced blocks in `language`, in order.
fn blocks(language: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut block: Option<String> = None;
    for line in README.lines() {
        match (&mut block, line.strip_prefix("```")) {
            (None, Some(found)) => block = (found == language).then(String::new).or(Some("\0".into())),
            (Some(_), Some(_)) => blocks.extend(block.take().filter(|text| !text.starts_with('\0'))),
            (Some(text), None) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    blocks
}

#[test]
fn every_ron_block_is_good() {
    let geometry = Floor::default().geometry;
    let mut kinds = Kinds::builtin();
    let blocks = blocks("ron");
    assert!(blocks.len() >= 3);
    for block in blocks {
        let wrong = match block.split('(').next() {
            Some("Kind") => kinds.add(&block, "README.md").err(),
            Some("Layout") => schema::parse_layout(&block, "README.md", &kinds, &geometry).err(),
            Some("Floor") => schema::parse_floor(&block, "README.md").err(),
            other => panic!("what is {other:?}?"),
        };
        assert!(wrong.is_none(), "{}", wrong.unwrap());
    }
}

#[test]
fn every_command_runs() {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let layouts = folder.path().join("layouts");
    std::fs::create_dir(&layouts).unwrap();
    for file in std::fs::read_dir(root.join("layouts")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), layouts.join(file.file_name())).unwrap();
    }
    let program = Path::new(env!("CARGO_BIN_EXE_underfoot"));
    let path = std::env::join_paths(
        [program.parent().unwrap().to_path_buf()]
            .into_iter()
            .chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    )
    .unwrap();
    let blocks = blocks("sh");
    assert!(blocks.len() >= 3);
    for block in blocks {
        let output = Command::new("sh")
            .args(["-ec", &block])
            .current_dir(folder.path())
            .env("PATH", &path)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{block}\n{said}");
    }
    for made in ["map.png", "out.wav", "floor.ron"] {
        assert!(folder.path().join(made).exists(), "{made}");
    }
}
