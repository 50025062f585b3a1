//! The program itself, end to end: processes, sockets, files.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::ports::free_port;
use crate::steady::{note_overload, while_time_is_kept};

pub(super) fn underfoot() -> Command {
    underfoot_at(Path::new(env!("CARGO_BIN_EXE_underfoot")))
}

/// A copy of the program.
pub(super) fn underfoot_at(file: &Path) -> Command {
    let mut command = Command::new(file);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("RUST_LOG");
    command
}

pub(super) fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Events of controls from JSON lines, without ignored feet: time, control, kind and value.
fn events(lines: &str) -> Vec<(f64, String, String, Value)> {
    let parsed = lines.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    parsed
        .filter(|event| event["id"].is_string() && event["event"] != "ignored")
        .map(|event| {
            let text = |field: &str| event[field].as_str().unwrap().to_string();
            (event["t_s"].as_f64().unwrap(), text("id"), text("event"), event["value"].clone())
        })
        .collect()
}

/// The samples of each channel of a WAV file, in full scales.
pub(super) fn channels(path: &Path) -> (u32, Vec<Vec<f32>>) {
    let mut reader = hound::WavReader::open(path).unwrap();
    let spec = reader.spec();
    let scale = 1.0 / (1_i64 << (spec.bits_per_sample - 1)) as f32;
    let mut channels = vec![Vec::new(); spec.channels.into()];
    for (index, sample) in reader.samples::<i32>().enumerate() {
        channels[index % usize::from(spec.channels)].push(sample.unwrap() as f32 * scale);
    }
    (spec.sample_rate, channels)
}

pub(super) fn peak(samples: &[f32]) -> f32 {
    samples.iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
}

#[test]
fn without_a_display_the_program_leaves_a_picture_a_sound_and_a_log() {
    let folder = tempfile::tempdir().unwrap();
    let output = underfoot().current_dir(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let out = folder.path().join("underfoot-session");
    for name in ["floor.png", "actuators.wav", "events.jsonl"] {
        assert!(said(&output).contains(name), "{}", said(&output));
    }
    let picture = std::fs::read(out.join("floor.png")).unwrap();
    assert_eq!(&picture[1..4], b"PNG");
    let log = std::fs::read_to_string(out.join("events.jsonl")).unwrap();
    let kinds: Vec<_> = events(&log)
        .into_iter()
        .filter(|(_, id, kind, _)| (id.as_str(), kind.as_str()) != ("zoom", "changed"))
        .map(|(_, id, kind, _)| format!("{id} {kind}"))
        .collect();
    let expected = [
        "home pressed",
        "home released",
        "home clicked",
        "zoom pressed",
        "zoom released",
        "satellite pressed",
        "satellite released",
        "satellite changed",
    ];
    assert_eq!(kinds, expected);

    let (rate, channels) = channels(&out.join("actuators.wav"));
    assert_eq!(channels.len(), 36);
    let pressed_at = events(&log)[0].0;
    let sample = |seconds: f64| (seconds * f64::from(rate)) as usize;
    // `home` lies on the tile in column 0, row 2.
    let home = &channels[12];
    let click = peak(&home[sample(pressed_at)..sample(pressed_at + 0.02)]);
    let later = peak(&home[sample(pressed_at + 0.15)..sample(pressed_at + 0.25)]);
    assert!(click > 0.05, "the press is felt: {click}");
    assert!(later < 0.01 * click, "and decays: {later}");
    // A foot is a tile long; actuators further away must not move.
    for far in [0, 3, 15, 35] {
        let moved = peak(&channels[far][sample(pressed_at)..sample(pressed_at + 0.25)]);
        assert_eq!(moved, 0.0, "tile {far} is far from the foot");
    }
}

/// A child process that ends with the test in any case.
pub(super) struct Served(pub(super) Child);

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Sends SIGTERM to a process, as `kill` does.
pub(super) fn terminate(child: &Child) {
    let status = Command::new("kill").arg(child.id().to_string()).status().unwrap();
    assert!(status.success());
}

#[test]
fn two_processes_over_udp_give_the_same_events_as_one() {
    // Events may be 20 ms apart.
    while_time_is_kept(15, || {
        let folder = tempfile::tempdir().unwrap();
        let address = format!("127.0.0.1:{}", free_port());
        let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
        let wav = folder.path().join("out.wav");
        let mut server = underfoot()
            .args(["run", layout, "--listen", &address, "--json", "--latency", "--no-osc", "--wav"])
            .arg(&wav)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map(Served)
            .unwrap();
        let mut chatter = BufReader::new(server.0.stderr.take().unwrap());
        let mut line = String::new();
        chatter.read_line(&mut line).unwrap();
        assert!(line.starts_with("Listening on"), "{line}");

        let begun = Instant::now();
        let paper = ["--quality", "paper"];
        let simulated = underfoot().args(["simulate", "--send", &address]).args(paper).output().unwrap();
        assert!(simulated.status.success(), "{}", said(&simulated));
        let took = begun.elapsed();
        assert!(took > Duration::from_secs(10), "the session is played in real time, not in {took:?}");
        terminate(&server.0);
        let lines = std::io::read_to_string(server.0.stdout.take().unwrap()).unwrap();
        assert!(server.0.wait().unwrap().success());
        let report = std::io::read_to_string(chatter).unwrap();
        if report.contains("gave up its real-time priority") {
            note_overload();
        }
        assert!(report.contains("From packet to click"), "{report}");

        let session = underfoot().args(["session", "--out"]).arg(folder.path()).args(paper).output().unwrap();
        assert!(session.status.success(), "{}", said(&session));
        let alone = events(&std::fs::read_to_string(folder.path().join("events.jsonl")).unwrap());
        let apart = events(&lines);
        // On a starved machine packets are delayed and dropped, which may cost the slider a step or two on its way;
        // otherwise the events are equal one by one and 0.01 ms apart.
        let told = |events: Vec<(f64, String, String, Value)>| {
            let mut told: Vec<_> =
                events.into_iter().map(|(t_s, id, kind, _)| (t_s, format!("{id} {kind}"))).collect();
            told.dedup_by(|next, last| next.1 == last.1);
            told
        };
        let (apart, alone) = (told(apart), told(alone));
        let names =
            |events: &[(f64, String)]| events.iter().map(|(_, name)| name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&apart), names(&alone));
        // The server's clock starts with the server, so times count from the first event.
        for (apart_event, alone_event) in apart.iter().zip(&alone) {
            let difference = (apart_event.0 - apart[0].0) - (alone_event.0 - alone[0].0);
            assert!(difference.abs() < 0.02, "{difference} s apart: {apart_event:?}");
        }
        let (_, channels) = channels(&wav);
        assert_eq!(channels.len(), 36);
        assert!(peak(&channels[12]) > 0.05, "the click on `home` was recorded");
    });
}

// N14
#[test]
fn what_cannot_work_is_said_in_one_sentence() {
    let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let output = underfoot().args(["run", "map", "--listen", &address]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("--listen"), "{}", said(&output));

    let output = underfoot().args(["run", "no_such_layout.ron", "--seconds", "1"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("no_such_layout.ron"), "{}", said(&output));

    let output = underfoot().args(["run", "--no-such-flag"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_bad_layout_is_explained_and_exits_with_1() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.ron");
    std::fs::write(&path, "Layout(version: 1, titel: \"Oops\", regions: [], widgets: [(id: \"a\")])")
        .unwrap();
    for command in ["check", "run"] {
        let output = underfoot().arg(command).arg(&path).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{command}");
        let said = said(&output);
        assert!(said.contains("bad.ron:1:") && said.contains("title"), "{said}");
    }
    let output = underfoot().args(["check", "--json"]).arg(&path).output().unwrap();
    let found: BTreeMap<String, Value> =
        serde_json::from_slice::<Vec<_>>(&output.stdout).unwrap().swap_remove(0);
    assert!(found.contains_key("line") && found.contains_key("column"), "{found:?}");
}

// F1
#[test]
fn saving_the_layout_changes_the_floor_and_a_bad_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.ron");
    let page = |x: f32| {
        format!(
            "Layout(version: 1, regions: [(id: \"page\", at: (0, 2), size: (6, 4))], \
             widgets: [(id: \"home\", kind: \"button\", at: ({x}, 3), size: (1, 1))])"
        )
    };
    std::fs::write(&path, page(1.0)).unwrap();
    let address = format!("127.0.0.1:{}", free_port());
    let mut server = underfoot()
        .args(["run", "-v", "--listen", &address, "--no-osc"])
        .arg(&path)
        .stderr(Stdio::piped())
        .spawn()
        .map(Served)
        .unwrap();
    let mut chatter = BufReader::new(server.0.stderr.take().unwrap()).lines();
    let mut until = |text: &str| {
        let found = chatter.by_ref().map_while(Result::ok).any(|line| line.contains(text));
        assert!(found, "never said: {text}");
    };
    until("Listening on");
    std::fs::write(&path, page(2.0)).unwrap();
    until("the changed layout is on the floor");
    std::fs::write(&path, "Layout(").unwrap();
    until("The last good layout stays");
    terminate(&server.0);
    assert!(server.0.wait().unwrap().success());
}

/// A server with its layout at `path`, which `change` replaces; returns its log, beside the layout.
#[cfg(unix)]
fn log_of_a_change(folder: &Path, path: &Path, change: impl FnOnce()) -> String {
    let log = folder.join("log.txt");
    let address = format!("127.0.0.1:{}", free_port());
    let mut server = underfoot()
        .args(["run", "-vv", "--listen", &address, "--no-osc"])
        .arg(path)
        .stderr(std::fs::File::create(&log).unwrap())
        .spawn()
        .map(Served)
        .unwrap();
    let has = |text: &str| std::fs::read_to_string(&log).is_ok_and(|log| log.contains(text));
    let until = |text: &str| {
        let begun = Instant::now();
        while !has(text) {
            assert!(begun.elapsed() < Duration::from_secs(60), "never said: {text}");
            std::thread::sleep(Duration::from_millis(10));
        }
    };
    until("Listening on");
    change();
    until("the changed layout is on the floor");
    terminate(&server.0);
    assert!(server.0.wait().unwrap().success());
    std::fs::read_to_string(log).unwrap()
}

// F7
#[cfg(unix)]
#[test]
fn a_layout_behind_links_is_reloaded_and_the_log_beside_it_is_not_watched() {
    use std::os::unix::fs::symlink;
    let page = |id: &str| {
        format!(
            "Layout(version: 1, regions: [(id: \"page\", at: (0, 2), size: (6, 4))], \
             widgets: [(id: \"{id}\", kind: \"button\", at: (1, 3), size: (1, 1))])"
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for version in ["..one", "..two"] {
        std::fs::create_dir(at(version)).unwrap();
        std::fs::write(at(version).join("page.ron"), page(version.trim_start_matches('.'))).unwrap();
    }
    symlink("..one", at("..data")).unwrap();
    symlink("..data/page.ron", at("page.ron")).unwrap();
    let swap = || {
        symlink("..two", at("..data_tmp")).unwrap();
        std::fs::rename(at("..data_tmp"), at("..data")).unwrap();
    };
    let log = log_of_a_change(folder.path(), &at("page.ron"), swap);
    assert_eq!(log.matches("the changed layout").count(), 1);
    let log = log_of_a_change(folder.path(), &at("page.ron"), || {
        std::fs::write(at("..two/page.ron"), page("three")).unwrap();
    });
    assert!(!log.contains("log.txt") && log.len() < 100_000, "{} bytes", log.len());
}

#[test]
fn a_layout_is_drawn_without_a_display() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["map.png", "map.svg"] {
        let path = folder.path().join(name);
        let output = underfoot().args(["render", "map", "--out"]).arg(&path).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        assert!(std::fs::metadata(&path).unwrap().len() > 2000);
    }
    // In the resting state, not that just after the start of the program.
    let drawn = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    assert!(drawn.contains("Satellite") && !drawn.contains("lift foot"));
}

#[test]
fn completions_know_every_command() {
    let output = underfoot().args(["completions", "bash"]).output().unwrap();
    for command in ["run", "simulate", "session", "check", "render", "sense"] {
        assert!(said(&output).contains(command));
    }
}

#[test]
fn each_command_has_a_page_for_man() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("made/man");
    let output = underfoot().args(["man", "--out"]).arg(&pages).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let page = |name: &str| std::fs::read_to_string(pages.join(name)).unwrap();
    assert!(page("underfoot-run.1").contains("web"));
    // The page of the program leads to those of all commands.
    let whole = page("underfoot.1");
    for command in ["run", "simulate", "session", "check", "render", "sense"] {
        let name = format!("underfoot-{command}.1");
        assert!(
            pages.join(&name).exists()
                && whole.replace('\\', "").contains(&format!("underfoot-{command}(1)"))
        );
    }
    // A command that only the server starts has none.
    assert!(!pages.join("underfoot-guardian.1").exists());
    assert_eq!(said(&underfoot().arg("man").output().unwrap()).trim_end(), whole.trim_end());
}

#[test]
fn sense_goes_by_the_floor_file_s_geometry_and_maps() {
    let folder = tempfile::tempdir().unwrap();
    let (table, floor) = (folder.path().join("table.csv"), folder.path().join("floor.ron"));
    // 100 N in the middle of the second tile.
    std::fs::write(&table, "t_s,col,row,f_sw,f_se,f_nw,f_ne\n0.000,1,0,25,25,25,25\n").unwrap();
    // Tiles of half a metre; the second one's map moves everything east by a tenth of half a pitch.
    let rest = ", 0".repeat(9);
    let map = format!("(tile: (1, 0), bends: [[0.1{rest}], [0{rest}]])");
    let text = format!("Floor(version: 1, columns: 2, rows: 1, tile_m: 0.5, maps: [{map}])");
    std::fs::write(&floor, text).unwrap();
    let sense = |arguments: &[&std::ffi::OsStr]| {
        let output = underfoot().arg("sense").arg(&table).args(arguments).output().unwrap();
        (output.status.code(), said(&output))
    };
    let (status, line) = sense(&["--floor".as_ref(), floor.as_os_str()]);
    assert_eq!(status, Some(0), "{line}");
    let line: Value = serde_json::from_str(&line).unwrap();
    let x_m = line["contacts"][0]["x_m"].as_f64().unwrap();
    assert!((x_m - 0.775).abs() < 1e-4, "{line}");
    let (_, line) = sense(&["--grid".as_ref(), "2x1".as_ref()]);
    let line: Value = serde_json::from_str(&line).unwrap();
    assert!((line["contacts"][0]["x_m"].as_f64().unwrap() - 0.456).abs() < 1e-4, "{line}");
    let (status, told) = sense(&["--floor".as_ref(), table.as_os_str()]);
    assert_eq!(status, Some(1), "{told}");
}
