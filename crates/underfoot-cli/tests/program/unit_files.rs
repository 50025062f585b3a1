//! The units for systemd: their settings, systemd's verdict on them, and whether their command serves a floor.
#![cfg(unix)]

use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use super::end_to_end::{Served, said, underfoot};
use super::output::ended;
use crate::ports::free_port;
use crate::units::{Unit, folder};

/// The highest allowed exposure level of `systemd-analyze security`, in tenths.
const MOST_EXPOSED: u32 = 30;

/// `systemd-analyze`, or `None`, with a printed message, without it.
fn analyze(arguments: &[&str], file: &Path) -> Option<Output> {
    let output = Command::new("systemd-analyze").args(arguments).arg(file).output();
    if output.is_err() {
        println!("not run: there is no systemd-analyze (Debian: apt-get install systemd)");
    }
    output.ok()
}

#[test]
fn a_unit_never_gives_up_and_watches_its_program() {
    for unit in Unit::all() {
        for (key, value) in [
            ("StartLimitIntervalSec", "0"),
            ("Restart", "always"),
            ("RestartSec", "1"),
            ("Type", "notify"),
            ("WatchdogSec", "2s"),
            ("WantedBy", "multi-user.target"),
        ] {
            assert_eq!(unit.value(key), value, "{}: {key}", unit.name);
        }
    }
}

/// Except for sound and settings of one program, all units have the same restrictions.
#[test]
fn all_units_have_the_same_sandbox() {
    const OF_ONE: [&str; 3] = ["PrivateDevices", "DeviceAllow", "SupplementaryGroups"];
    let sandbox = |unit: &Unit| -> Vec<String> {
        let settings = unit.settings();
        let from = settings.iter().position(|setting| setting.1 == "ProtectSystem").unwrap();
        let shared = settings[from..].iter().filter(|setting| !OF_ONE.contains(&setting.1));
        shared.map(|(section, key, value)| format!("[{section}] {key}={value}")).collect()
    };
    let units = Unit::all();
    assert_eq!(units.len(), 3);
    for unit in &units[1..] {
        assert_eq!(sandbox(unit), sandbox(&units[0]), "{}", unit.name);
    }
    for unit in &units {
        assert_eq!(unit.value("DynamicUser"), "yes", "{}", unit.name);
        let plays = unit.text.contains("DeviceAllow=char-alsa rw\n");
        assert_eq!(plays, unit.text.contains("SupplementaryGroups=audio\n"), "{}", unit.name);
        assert_ne!(plays, unit.text.contains("PrivateDevices=yes\n"), "{}", unit.name);
    }
}

/// systemd reads a copy with the command of an existing program; it names every unknown line.
#[test]
fn systemd_knows_every_line_of_the_units() {
    let copies = tempfile::tempdir().unwrap();
    for unit in Unit::all() {
        let copy = copies.path().join(unit.name.replace("@.", "@west."));
        let program = format!("ExecStart={} ", env!("CARGO_BIN_EXE_underfoot"));
        let (_, after) = unit.value("ExecStart").split_once(' ').unwrap();
        let text = unit.text.replace(&format!("ExecStart={}", unit.value("ExecStart")), &(program + after));
        std::fs::write(&copy, &text).unwrap();
        let Some(output) = analyze(&["verify", "--man=no"], &copy) else { return };
        assert!(output.status.success() && said(&output).is_empty(), "{}: {}", unit.name, said(&output));
        // A misspelt line would be reported.
        std::fs::write(&copy, text.replace("NoNewPrivileges", "NoNewPrivilege")).unwrap();
        let misspelt = said(&analyze(&["verify", "--man=no"], &copy).unwrap());
        assert!(misspelt.contains("NoNewPrivilege"), "{misspelt}");
    }
}

#[test]
fn the_units_are_locked_up_well() {
    for unit in Unit::all() {
        let threshold = format!("--threshold={MOST_EXPOSED}");
        let arguments = ["security", "--offline=true", &threshold, "--no-pager"];
        let Some(output) = analyze(&arguments, &folder().join(&unit.name)) else { return };
        let said = said(&output);
        let level = said.lines().find(|line| line.contains("Overall exposure level"));
        assert!(output.status.success() && level.is_some(), "{}: {said}", unit.name);
        println!("{}", level.unwrap());
    }
}

/// The unit's own command, with its files elsewhere: it serves the floor and notifies the manager.
#[test]
fn the_command_of_the_unit_serves_a_floor() {
    let site = tempfile::tempdir().unwrap();
    let files = site.path().join("underfoot");
    std::fs::create_dir(&files).unwrap();
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
    std::fs::copy(layout, files.join("layout.ron")).unwrap();
    std::fs::write(files.join("floor.ron"), "Floor(version: 1, columns: 6, rows: 6)").unwrap();
    let notify = site.path().join("notify");
    let manager = UnixDatagram::bind(&notify).unwrap();
    manager.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let listen = format!("127.0.0.1:{}", free_port());
    let command =
        Unit::named("underfoot.service").command(site.path(), "", &["--listen", &listen, "--no-osc"]);
    assert_eq!(command[0], "underfoot");
    let served = underfoot()
        .args(&command[1..])
        .env("NOTIFY_SOCKET", &notify)
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let mut sign = [0; 64];
    let length = manager.recv(&mut sign).unwrap();
    assert_eq!(&sign[..length], b"READY=1");
    assert_eq!(ended(served), Some(0));
}

/// The options in a unit's command, and those in its comment, are options of its program.
#[test]
fn the_options_in_the_unit_exist() {
    let unit = Unit::named("underfoot.service");
    let help = said(&underfoot().args(["run", "--help"]).output().unwrap());
    let options = unit.text.split_whitespace().map(|word| word.rsplit('=').next().unwrap());
    let mut count = 0;
    for option in options.filter(|word| word.starts_with("--")) {
        assert!(help.contains(option.trim_end_matches('"')), "{option}");
        count += 1;
    }
    assert!(count >= 5, "{count}");
}

/// The page for operators on site links to the units, names their files and repeats none of them.
#[test]
fn the_page_says_where_the_unit_keeps_its_files() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/on-site.md")).unwrap();
    for unit in Unit::all() {
        assert!(page.contains(&format!("(../packaging/systemd/{})", unit.name)), "{}", unit.name);
    }
    assert!(!page.contains("[Service]"));
    let unit = Unit::named("underfoot.service");
    let memory = unit.value("MemoryMax").replace('M', " MB");
    let files = unit.value("EnvironmentFile").replace("-%E", "/etc");
    for part in [format!("/var/lib/{}", unit.value("StateDirectory")), files, memory] {
        assert!(page.contains(&part), "{part}");
    }
}
