//! The floor's key: its place, and the checks at a start.

use std::fs;
use std::path::Path;

use underfoot_cluster::auth::Key;

use crate::hall::{Hall, Program, STANDS_STILL_MS};
use crate::steady::while_time_is_kept;

const FLOOR: &str = r#"Floor(
    columns: 12,
    rows: 6,
    areas: [
        (id: "west", at: (0, 0), size: (6, 6), listen: "127.0.0.1:9000"),
        (id: "east", at: (6, 0), size: (6, 6)),
    ],
"#;

/// The message of a gateway that refuses to start with this floor file.
fn refusal(folder: &Path, rest: &str, more: &[&str]) -> String {
    fs::write(folder.join("hall.ron"), format!("{FLOOR}{rest})")).unwrap();
    Program::refusal(folder, &[&["gateway", "--floor", "hall.ron", "--seconds", "0.1"], more].concat())
}

#[test]
fn the_program_makes_a_key_that_only_its_owner_can_read() {
    let folder = tempfile::tempdir().unwrap();
    let make = || {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_underfoot-cluster"));
        command.args(["key", "hall.key"]).current_dir(folder.path()).output().unwrap()
    };
    let made = make();
    assert!(made.status.success(), "{made:?}");
    let path = folder.path().join("hall.key");
    let text = fs::read_to_string(&path).unwrap();
    Key::read(&path).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
    }
    let again = make();
    assert_eq!(again.status.code(), Some(1));
    assert!(String::from_utf8(again.stderr).unwrap().contains("exists already"));
    assert_eq!(fs::read_to_string(&path).unwrap(), text);
}

#[test]
fn computers_apart_do_not_start_without_a_key() {
    let folder = tempfile::tempdir().unwrap();
    let advice = "`underfoot-cluster key hall.key` makes one; copy it to all of them, and write `key: \"hall.key\"` into hall.ron";
    let cases = [
        ("gateway: \"192.168.1.5:7447\"", &[][..], "tcp/192.168.1.5:7447"),
        ("", &["--listen", "tcp/0.0.0.0:7447"], "tcp/0.0.0.0:7447"),
        ("", &["--listen", "tcp/hall.local:7447"], "tcp/hall.local:7447"),
    ];
    for (rest, more, far) in cases {
        let said = refusal(folder.path(), rest, more);
        assert!(said.contains(far) && said.contains(advice), "{said}");
    }
    let text = FLOOR.replace("127.0.0.1:9000", "192.168.1.10:9000");
    fs::write(folder.path().join("hall.ron"), format!("{text})")).unwrap();
    let node = ["node", "--floor", "hall.ron", "--area", "west", "--listen", "127.0.0.1:0"];
    let said = Program::refusal(folder.path(), &node);
    assert!(said.contains("192.168.1.10:9000") && said.contains(advice), "{said}");
    assert!(!folder.path().join("hall.key").exists());
}

#[cfg(unix)]
#[test]
fn a_key_that_others_can_read_is_refused() {
    use std::os::unix::fs::PermissionsExt;

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.key");
    Key::make(&path).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o644)).unwrap();
    let said = refusal(folder.path(), "key: \"other.key\"", &[]);
    assert!(said.contains("mode 0644") && said.contains("chmod 600 other.key"), "{said}");
}

#[test]
fn a_key_that_is_named_and_missing_is_not_made() {
    let folder = tempfile::tempdir().unwrap();
    let said = refusal(folder.path(), "key: \"other.key\"", &[]);
    assert!(
        said.contains("other.key can't be read") && said.contains("underfoot-cluster key other.key"),
        "{said}"
    );
    assert!(!folder.path().join("other.key").exists());
    let said = refusal(folder.path(), "", &["--key", "mine.key"]);
    assert!(said.contains("mine.key can't be read"), "{said}");
}

#[test]
fn computers_that_are_one_share_a_key_beside_the_floor_file() {
    while_time_is_kept(STANDS_STILL_MS, || {
        // Namespaces count as several computers.
        if std::env::var_os("UNDERFOOT_NETNS").is_some() {
            return;
        }
        let hall = Hall::with_key(None);
        let key = fs::read_to_string(hall.file("hall.key")).unwrap();
        let _node = hall.bare_node("nw");
        let empty = r#"Scenario(title: "Empty", steps: [Wait(ms: 20000)])"#;
        let _boards = hall.boards(hall.script(empty), &[]);
        hall.await_live("nw", 0);
        assert_eq!(fs::read_to_string(hall.file("hall.key")).unwrap(), key);
        let made = hall.said().iter().filter(|line| line.contains("Made a key")).count();
        assert!(made <= 1, "one program makes it");
    });
}
