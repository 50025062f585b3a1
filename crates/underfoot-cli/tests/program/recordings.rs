//! Floors recorded and replayed.

use std::path::Path;
use std::process::Output;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::floor::Floor;
use underfoot::mirror::TextMirror;
use underfoot::recording::{Recording, Speed};
use underfoot::runtime::{Kind, Session};
use underfoot::schema::{Kinds, builtin_layout, parse_layout};
use underfoot::widget::EventKind;

use super::end_to_end::{said, underfoot};
#[cfg(unix)]
use crate::ports::free_port;

/// Records the built-in session, or a scenario on one of the example apps' floors: layout and scenario.
fn record(folder: &Path, app: Option<[&str; 2]>) -> (Vec<u8>, String) {
    let file = folder.join("visit.mcap");
    let mut session = underfoot();
    session.current_dir(folder).args(["session", "--out", "visit", "--record", "visit.mcap"]);
    if let Some([layout, scenario]) = app {
        let examples = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("examples");
        session.arg(examples.join(layout)).arg("--scenario").arg(examples.join(scenario));
    }
    let output = session.output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let events = std::fs::read_to_string(folder.join("visit/events.jsonl")).unwrap();
    (std::fs::read(file).unwrap(), events)
}

fn replay(file: &Path) -> Output {
    let arguments = ["--speed", "max", "--no-osc", "--json"];
    underfoot().arg("replay").arg(file).args(arguments).output().unwrap()
}

#[test]
fn a_recorded_session_gives_the_same_events_to_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    let apps = [
        None,
        Some(["map/atlas.ron", "map/tour.ron"]),
        Some(["surgical/console.ron", "surgical/reading.ron"]),
        // In this one the floor falls silent and comes back.
        Some(["surgical/console.ron", "surgical/imaging.ron"]),
    ];
    for app in apps {
        let (_, events) = record(folder.path(), app);
        let output = replay(&folder.path().join("visit.mcap"));
        assert!(output.status.success(), "{app:?}: {}", said(&output));
        assert!(events.contains("\"clicked\""), "{app:?}");
        assert_eq!(String::from_utf8(output.stdout).unwrap(), events, "{app:?}");
    }
}

#[test]
fn lines_show_a_window_the_feet_and_the_controls_of_the_floor() {
    let folder = tempfile::tempdir().unwrap();
    record(folder.path(), None);
    let told = underfoot()
        .arg("replay")
        .arg(folder.path().join("visit.mcap"))
        .args(["--speed", "max", "--no-osc", "--json", "--json-contacts"])
        .output()
        .unwrap();
    let floor = Floor::default();
    let map =
        parse_layout(builtin_layout("map").unwrap(), "map", &Kinds::builtin(), &floor.geometry).unwrap();
    let mut mirror = TextMirror::new(&floor, map.layout.clone());
    let (mut most, mut zoom) = (0, None);
    for line in std::str::from_utf8(&told.stdout).unwrap().lines() {
        let event = mirror.take(line).unwrap();
        assert_eq!(event.is_some(), line.contains(r#""id":""#) && !line.contains(r#""state""#), "{line}");
        if let Some(EventKind::Changed(value)) =
            event.filter(|event| event.id == "zoom").map(|event| event.kind)
        {
            zoom = Some(value);
        }
        most = most.max(mirror.snapshot().contacts.len());
    }
    assert_eq!(most, 2, "both feet");
    let index = map.layout.widget_index("zoom").unwrap();
    assert_ne!(zoom, None);
    assert_eq!(mirror.snapshot().widgets[index].value, zoom);
    // The visitor has left.
    assert!(mirror.snapshot().contacts.is_empty() && mirror.snapshot().held.is_empty());
    assert!(mirror.snapshot().widgets.iter().all(|widget| !widget.pressed && widget.press_share == 0.0));
}

#[test]
fn a_file_cut_anywhere_replays_up_to_there() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, events) = record(folder.path(), None);
    let whole_lines: Vec<&str> = events.lines().collect();
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let cut_file = folder.path().join("cut.mcap");
    let mut longest = 0;
    for _ in 0..100 {
        let cut = rng.random_range(0..whole.len());
        std::fs::write(&cut_file, &whole[..cut]).unwrap();
        let output = replay(&cut_file);
        let said = said(&output);
        assert!(!said.contains("panicked"), "cut at {cut}: {said}");
        let lines = String::from_utf8(output.stdout).unwrap();
        let lines: Vec<&str> = lines.lines().collect();
        let same = lines.iter().zip(&whole_lines).take_while(|(one, other)| one == other).count();
        // Holds at the end of the recording are cancelled and their values restored; then nothing is held.
        for line in &lines[same..] {
            let ends = ["\"cancelled\"", "\"changed\"", "\"held\":[]", "\"released\"", "\"disarmed\""];
            assert!(ends.iter().any(|end| line.contains(end)), "cut at {cut}: {line}");
        }
        longest = longest.max(same);
    }
    assert!(longest > whole_lines.len() / 2, "{longest} of {}", whole_lines.len());
}

/// Number of lines of a replay that agree with the whole recording, from its beginning.
fn common(replayed: &Output, whole: &str) -> usize {
    let lines = String::from_utf8_lossy(&replayed.stdout);
    lines.lines().zip(whole.lines()).take_while(|(one, other)| one == other).count()
}

/// A limit of 2 MB for a file of some 5, which the system reports like a full disk.
// F4
#[cfg(unix)]
#[test]
fn a_disk_that_fills_while_a_session_is_recorded_leaves_what_it_took() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, events) = record(folder.path(), None);
    let script = "trap '' XFSZ; ulimit -f 4096; exec \"$0\" \"$@\"";
    let output = std::process::Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_underfoot")])
        .args(["session", "--out", "again", "--record", "full.mcap"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("the recording ends here, the floor works on"), "{}", said(&output));
    assert!(said(&output).contains("the recording is not whole"), "{}", said(&output));
    let again = std::fs::read_to_string(folder.path().join("again/events.jsonl")).unwrap();
    assert_eq!(again, events, "the floor has worked on");
    let full = folder.path().join("full.mcap");
    let share = std::fs::metadata(&full).unwrap().len() as f64 / whole.len() as f64;
    let lines = common(&replay(&full), &events);
    // A third of the bytes has 29 lines: most events come later.
    assert!(share > 0.25 && lines > 20, "{share} {lines}");
}

/// The file of a killed process.
// F5
#[test]
fn a_killed_recording_replays_up_to_its_last_moments() {
    let folder = tempfile::tempdir().unwrap();
    let (_, events) = record(folder.path(), None);
    let path = folder.path().join("killed.mcap");
    let mut session = underfoot()
        .current_dir(folder.path())
        .args(["session", "--out", "again", "--record", "killed.mcap"])
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while std::fs::metadata(&path).map_or(0, |file| file.len()) < 1_800_000 {
        assert!(session.try_wait().unwrap().is_none(), "it ended before it was killed");
        std::thread::yield_now();
    }
    session.kill().unwrap();
    session.wait().unwrap();
    let output = replay(&path);
    assert!(!said(&output).contains("panicked"), "{}", said(&output));
    let lines = common(&output, &events);
    assert!(lines > 20, "{lines} of {}", events.lines().count());
}

#[test]
fn a_file_that_is_no_recording_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("no.mcap");
    std::fs::write(&file, "not a recording").unwrap();
    let output = replay(&file);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("no recording of a floor begins there"), "{}", said(&output));
}

/// A recording of 84a7726, and copies rewritten by the MCAP library for Python: with zstd, and with lz4 in small
/// chunks with the attachments behind the messages.
#[test]
fn recordings_of_the_first_version_replay_unchanged_whichever_tool_wrote_them_anew() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("tests/recordings");
    let recorded = std::fs::read_to_string(folder.join("events.jsonl")).unwrap();
    for name in ["first.mcap", "zstd.mcap", "lz4_attachments_last.mcap"] {
        let output = replay(&folder.join(name));
        assert!(output.status.success(), "{name}: {}", said(&output));
        assert!(said(&output).contains("Replayed 2.0 s"), "{name}: {}", said(&output));
        let replayed = String::from_utf8_lossy(&output.stdout);
        let of_controls = |lines: &str| -> Vec<String> {
            lines.lines().filter(|line| line.contains("\"id\":")).map(str::to_owned).collect()
        };
        assert_eq!(of_controls(&recorded).len(), 3);
        assert_eq!(of_controls(&replayed), of_controls(&recorded), "{name}");
    }
}

#[test]
fn a_damaged_recording_is_named_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let (mut whole, events) = record(folder.path(), None);
    let place = whole.len() / 2;
    whole[place] ^= 4;
    let damaged = folder.path().join("damaged.mcap");
    std::fs::write(&damaged, whole).unwrap();
    let output = replay(&damaged);
    assert_eq!(output.status.code(), Some(1));
    // Damage shows while the chunk is unpacked, by its length or by its checksum; each names the chunk.
    for words in ["is damaged after", "the chunk at byte", "is damaged: "] {
        assert!(said(&output).contains(words), "{words}: {}", said(&output));
    }
    let lines = common(&output, &events);
    assert!(lines > 20 && lines < events.lines().count(), "{lines}");
    let export =
        underfoot().current_dir(folder.path()).args(["export", "damaged.mcap", "--out", "t"]).output();
    assert_eq!(export.unwrap().status.code(), Some(1));
}

/// Service managers send SIGTERM, terminals SIGINT and SIGHUP.
#[cfg(unix)]
const ENDS: [&str; 3] = ["TERM", "INT", "HUP"];

#[cfg(unix)]
fn send(signal: &str, process: &std::process::Child) {
    let kill = std::process::Command::new("kill").args(["-s", signal, &process.id().to_string()]).status();
    assert!(kill.unwrap().success());
}

/// Waits until the recording at `path` has `bytes` bytes.
#[cfg(unix)]
fn await_bytes(path: &Path, bytes: u64, process: &mut std::process::Child) {
    while std::fs::metadata(path).map_or(0, |file| file.len()) < bytes {
        assert!(process.try_wait().unwrap().is_none(), "it ended before it was asked to");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_a_recorded_session_whole() {
    let folder = tempfile::tempdir().unwrap();
    for signal in ENDS {
        let path = folder.path().join("ended.mcap");
        let mut session = underfoot()
            .current_dir(folder.path())
            .args(["session", "--out", "ended", "--record", "ended.mcap"])
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        await_bytes(&path, 800_000, &mut session);
        send(signal, &session);
        assert_eq!(session.wait().unwrap().code(), Some(1), "{signal}: not all was played");
        let output = replay(&path);
        assert!(output.status.success(), "{signal}: {}", said(&output));
        let events = std::fs::read_to_string(folder.path().join("ended/events.jsonl")).unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), events, "{signal}");
        std::fs::remove_file(path).unwrap();
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_the_recording_of_a_served_floor_whole() {
    let folder = tempfile::tempdir().unwrap();
    for signal in ENDS {
        let path = folder.path().join(signal).with_extension("mcap");
        let address = format!("127.0.0.1:{}", free_port());
        let quiet = || std::process::Stdio::null();
        let mut server = underfoot()
            .args(["run", "map", "--listen", &address, "--no-osc", "--record"])
            .arg(&path)
            .stderr(quiet())
            .spawn()
            .unwrap();
        let mut boards =
            underfoot().args(["simulate", "--send", &address, "--loop"]).stderr(quiet()).spawn().unwrap();
        await_bytes(&path, 120_000, &mut server);
        send(signal, &server);
        assert!(server.wait().unwrap().success(), "{signal}");
        send("TERM", &boards);
        boards.wait().unwrap();
        let output = replay(&path);
        assert!(output.status.success(), "{signal}: {}", said(&output));
    }
}

/// A viewer of a recording pauses, resumes and skips; its events stay the same.
#[test]
fn a_replay_that_is_led_to_and_fro_gives_the_same_events() {
    let folder = tempfile::tempdir().unwrap();
    record(folder.path(), None);
    let file = folder.path().join("visit.mcap");
    let events = |led: bool| {
        let recording = Recording::open(&file).unwrap();
        let (floor, layout) = (recording.floor().clone(), recording.layout().clone());
        let source = recording.source(if led { Speed::Times(8.0) } else { Speed::Max });
        let (transport, progress, clock) = (source.transport(), source.progress(), source.clock());
        let session = Session::source(source, clock).floor(floor).layout(layout);
        let session = session.every_change().start().unwrap();
        let leader = std::thread::spawn(move || {
            let mut rng = Pcg64Mcg::seed_from_u64(2);
            while led && !progress.is_over() {
                let pause = Duration::from_millis(rng.random_range(0..40));
                transport.set_paused(rng.random());
                std::thread::sleep(pause);
                // A second ahead at most, so that parts are also played at normal speed.
                let ahead = Duration::from_millis(rng.random_range(0..1000));
                transport.hurry_to(progress.now() + ahead);
            }
            transport.set_paused(false);
        });
        let all: Vec<String> = std::iter::from_fn(|| session.next_event_timeout(Duration::from_secs(60)))
            .filter(|event| matches!(event.kind, Kind::Control(_)))
            .map(|event| format!("{event:?}"))
            .collect();
        leader.join().unwrap();
        assert_eq!(session.dropped(), 0);
        all
    };
    let (plain, led) = (events(false), events(true));
    assert!(plain.len() > 20, "{}", plain.len());
    assert_eq!(led, plain);
}

/// A trimmed recording reports the same lines within its part, whatever came before.
#[test]
fn any_part_of_a_recording_replays_with_the_same_events() {
    let folder = tempfile::tempdir().unwrap();
    let (_, events) = record(folder.path(), None);
    let at_s = |line: &str| -> f64 {
        serde_json::from_str::<serde_json::Value>(line).unwrap()["t_s"].as_f64().unwrap()
    };
    let of_controls = |lines: &str, from: f64, to: f64| -> Vec<String> {
        let within = |line: &&str| line.contains("\"id\":") && (from..to).contains(&at_s(line));
        lines.lines().filter(within).map(str::to_owned).collect()
    };
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut compared = 0;
    for _ in 0..12 {
        let from = rng.random_range(0.0..17.0_f64);
        let to = from + rng.random_range(0.5..6.0_f64);
        let [from_s, to_s] = [from, to].map(|at_s| format!("{at_s:.3}"));
        let export = underfoot()
            .current_dir(folder.path())
            .args(["export", "visit.mcap", "--mcap", "part.mcap", "--from", &from_s, "--to", &to_s])
            .output()
            .unwrap();
        assert!(export.status.success(), "{}", said(&export));
        let part = Recording::open(&folder.path().join("part.mcap")).unwrap();
        let begins = part.begins().unwrap().secs();
        let output = replay(&folder.path().join("part.mcap"));
        assert!(output.status.success(), "{}", said(&output));
        let lines = String::from_utf8(output.stdout).unwrap();
        // The end of the part cancels what is held.
        let end = begins + to - from - 0.01;
        let (given, wanted) = (of_controls(&lines, 0.0, end), of_controls(&events, begins, end));
        assert_eq!(given, wanted, "from {from_s} to {to_s}");
        compared += wanted.len();
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn a_part_is_an_animated_picture_and_tables_of_that_time() {
    let folder = tempfile::tempdir().unwrap();
    record(folder.path(), None);
    let export = underfoot()
        .current_dir(folder.path())
        .args(["export", "visit.mcap", "--gif", "part.gif", "--width", "320", "--out", "t"])
        .args(["--from", "4", "--to", "6"])
        .output()
        .unwrap();
    assert!(export.status.success(), "{}", said(&export));
    let gif = std::fs::read(folder.path().join("part.gif")).unwrap();
    assert!(gif.starts_with(b"GIF89a\x40\x01") && gif.ends_with(b";"));
    let contacts = std::fs::read_to_string(folder.path().join("t/contacts.csv")).unwrap();
    let times: Vec<f64> =
        contacts.lines().skip(1).map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    let (first, last) = (times[0], times[times.len() - 1]);
    assert!(times.len() > 1000 && last - first <= 2.0 && last - first > 1.5, "{first} to {last}");
    let nothing = underfoot()
        .current_dir(folder.path())
        .args(["export", "visit.mcap", "--gif", "x.gif", "--from", "60"])
        .output()
        .unwrap();
    assert_eq!(nothing.status.code(), Some(1));
    assert!(said(&nothing).contains("nothing lies between"), "{}", said(&nothing));
}
