//! `underfoot calibrate` and `measure` with real files and packets.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::{SocketAddr, UdpSocket};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::sender::{ANY_PORT, Sender, simulated, small_floor, standing};
use underfoot::floor::{Calibration, Floor, TileId};
use underfoot::schema::{load_floor, save_floor};
use underfoot::units::Newtons;
use underfoot_sim as sim;

fn underfoot(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_underfoot")).args(args).current_dir(folder).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn site() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let floor = small_floor();
    save_floor(&floor, &folder.path().join("floor.ron")).unwrap();
    let table = sim::load_table(&simulated(&floor), 1);
    fs::write(folder.path().join("loads.csv"), &table).unwrap();
    (folder, table)
}

#[test]
fn curves_are_kept_with_date_and_residual_and_the_older_file_beside_it() {
    let (folder, _) = site();
    let args = ["calibrate", "curves", "loads.csv", "--floor", "floor.ron", "--plot", "curves.svg", "--json"];
    let output = underfoot(folder.path(), &args);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["sensors"].as_array().unwrap().len(), 24);
    assert_eq!(answer["sensors"][5]["verdict"], "good");
    let kept = load_floor(&folder.path().join("floor.ron")).unwrap();
    let record = kept.calibration_records[5][3].unwrap();
    assert!((0.02..0.08).contains(&record.residual), "{record:?}");
    assert_eq!(load_floor(&folder.path().join("floor.ron.bak")).unwrap(), small_floor());
    let plot = fs::read_to_string(folder.path().join("curves.svg")).unwrap();
    assert!(plot.contains("tile (2, 1)") && plot.matches("<path").count() > 24);
}

#[test]
fn a_part_beyond_repair_gives_status_one_its_name_and_nominal_values() {
    let (folder, table) = site();
    let open: Vec<String> = table
        .lines()
        .map(|line| match line.strip_prefix("2,0,se,") {
            Some(rest) => format!("2,0,se,0.01,{}", rest.split_once(',').unwrap().1),
            None => line.to_owned(),
        })
        .collect();
    fs::write(folder.path().join("loads.csv"), open.join("\n")).unwrap();
    let output = underfoot(
        folder.path(),
        &["calibrate", "curves", "loads.csv", "--floor", "floor.ron", "--out", "new.ron"],
    );
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("tile (2, 0) se"), "{}", said(&output));
    let summary = String::from_utf8_lossy(&output.stdout);
    assert!(summary.contains(" good, ") && summary.contains("1 to replace"), "{summary}");
    let kept = load_floor(&folder.path().join("new.ron")).unwrap();
    assert_eq!(kept.calibration[2][1], Calibration::NOMINAL);
    assert_ne!(kept.calibration[2][0], Calibration::NOMINAL);
    assert_eq!(load_floor(&folder.path().join("floor.ron")).unwrap(), small_floor());
}

#[test]
fn a_bad_table_gives_all_its_problems_and_changes_nothing() {
    let (folder, _) = site();
    fs::write(folder.path().join("loads.csv"), "col,row,corner,volts,newtons\n9,0,sw,1,1\n0,0,up,9,x\n")
        .unwrap();
    let output = underfoot(folder.path(), &["calibrate", "curves", "loads.csv", "--floor", "floor.ron"]);
    assert_eq!(output.status.code(), Some(1));
    for place in
        ["line 2, column col", "line 3, column corner", "line 3, column volts", "line 3, column newtons"]
    {
        assert!(said(&output).contains(place), "{}", said(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn maps_are_kept_and_taken_away_when_the_curves_change() {
    let (folder, _) = site();
    let nominal = small_floor();
    let sim = simulated(&nominal);
    let calibrated = sim::calibrated(&nominal, &sim, 1).unwrap();
    save_floor(&calibrated, &folder.path().join("floor.ron")).unwrap();
    fs::write(folder.path().join("presses.csv"), sim::press_table(&calibrated, &sim, 1)).unwrap();
    let output = underfoot(
        folder.path(),
        &["calibrate", "map", "presses.csv", "--floor", "floor.ron", "--out", "mapped.ron", "--json"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let mapped = load_floor(&folder.path().join("mapped.ron")).unwrap();
    assert!(mapped.position_maps.iter().all(Option::is_some));
    assert!(mapped.map_records.iter().flatten().all(|record| record.residual_m < 0.007));
    assert_eq!(mapped.calibration, calibrated.calibration);

    let output = underfoot(folder.path(), &["calibrate", "curves", "loads.csv", "--floor", "mapped.ron"]);
    assert!(said(&output).contains("6 position maps"), "{}", said(&output));
    let kept = load_floor(&folder.path().join("mapped.ron")).unwrap();
    assert!(kept.position_maps.iter().all(Option::is_none));
}

/// Fault F3: no room for the new file.
#[cfg(unix)]
#[test]
fn f3_a_full_disk_leaves_the_old_floor_and_says_so() {
    let (folder, _) = site();
    // Files of this process may have 512 bytes, as on a disk without more room.
    let limited = "ulimit -f 1; trap '' XFSZ; exec \"$0\" calibrate curves loads.csv --floor floor.ron";
    let output = Command::new("sh")
        .args(["-c", limited, env!("CARGO_BIN_EXE_underfoot")])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("what it held before is untouched"), "{}", said(&output));
    assert_eq!(load_floor(&folder.path().join("floor.ron")).unwrap(), small_floor());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no half of a file is left");
}

/// Fault F2: a power failure at any system call of the save. Skipped without strace.
#[cfg(target_os = "linux")]
#[test]
fn f2_a_save_that_is_killed_leaves_the_old_floor_or_the_new_one() {
    let strace = |folder: &Path, call: &str, number: usize| {
        let inject = format!("inject={call}:signal=SIGKILL:when={number}");
        let program = env!("CARGO_BIN_EXE_underfoot");
        let trace = format!("trace={call}");
        Command::new("strace")
            .args(["-f", "-qq", "-o", "/dev/null", "-e", &trace, "-e", &inject, program])
            .args(["calibrate", "curves", "loads.csv", "--floor", "floor.ron"])
            .current_dir(folder)
            .output()
    };
    let (folder, _) = site();
    match strace(folder.path(), "getppid", 1000) {
        Ok(output) if output.status.success() => {}
        _ => {
            eprintln!("not run: strace can't be used here");
            return;
        }
    }
    let new = load_floor(&folder.path().join("floor.ron")).unwrap();
    let (mut kills, mut old_ones, mut new_ones) = (0, 0, 0);
    for call in ["openat", "write", "fchmod", "fsync", "linkat", "rename"] {
        for number in 1..40 {
            let (folder, _) = site();
            if strace(folder.path(), call, number).unwrap().status.success() {
                break;
            }
            kills += 1;
            let kept = load_floor(&folder.path().join("floor.ron")).unwrap();
            if kept == small_floor() {
                old_ones += 1;
            } else {
                assert_eq!(kept, new, "{call} {number}");
                assert_eq!(load_floor(&folder.path().join("floor.ron.bak")).unwrap(), small_floor());
                new_ones += 1;
            }
        }
    }
    assert!(old_ones >= 5 && new_ones >= 1, "{kills} kills: {old_ones} old, {new_ones} new");
}

/// A port that was free just before.
fn free_port() -> SocketAddr {
    UdpSocket::bind(ANY_PORT).unwrap().local_addr().unwrap()
}

#[test]
fn tare_and_measure_take_packets_from_a_floor() {
    let (folder, _) = site();
    let nominal = small_floor();
    let sim = simulated(&nominal);
    let calibrated = sim::calibrated(&nominal, &sim, 1).unwrap();
    let untared = Floor { tare: nominal.tare.clone(), ..calibrated.clone() };
    save_floor(&untared, &folder.path().join("floor.ron")).unwrap();
    let port = free_port();
    let listen = port.to_string();
    let sender = Sender::start(&nominal, sim.clone(), port, |sim, _| {
        sim.step(&[]);
    });
    let args = ["calibrate", "tare", "--floor", "floor.ron", "--listen", &listen, "--seconds", "10"];
    let output = underfoot(folder.path(), &args);
    drop(sender);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let kept = load_floor(&folder.path().join("floor.ron")).unwrap();
    assert!(kept.tared.is_some());
    assert!((kept.tare[4][2] - calibrated.tare[4][2]).abs() < Newtons(0.1));

    let place = nominal.geometry.centre(TileId::new(1, 0));
    let _sender = Sender::start(&nominal, sim, port, move |sim, _| {
        sim.step(&[standing(place)]);
    });
    let args = ["calibrate", "tare", "--floor", "floor.ron", "--listen", &listen, "--seconds", "1"];
    let output = underfoot(folder.path(), &args);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("tile ("), "{}", said(&output));
    assert_eq!(load_floor(&folder.path().join("floor.ron")).unwrap(), kept);

    let args = ["measure", "--floor", "floor.ron", "--listen", &listen, "--seconds", "1", "--json"];
    let output = underfoot(folder.path(), &args);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(answer["tiles"][1]["force"]["median_n"].as_f64().unwrap() > 150.0, "{answer}");
    assert!(answer["tiles"][3]["sensors"]["nw"]["greatest_n"].as_f64().unwrap() < 1.0, "{answer}");
}

/// A user saves the floor file in an editor while `underfoot` waits for packets to measure the tare.
// F8
#[test]
fn a_floor_file_that_another_program_changed_meanwhile_is_left_to_it() {
    let (folder, _) = site();
    let path = folder.path().join("floor.ron");
    let floor = small_floor();
    let port = free_port();
    let listen = port.to_string();
    let mut tare = Command::new(env!("CARGO_BIN_EXE_underfoot"))
        .args(["calibrate", "tare", "--floor", "floor.ron", "--listen", &listen, "--seconds", "20"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(tare.stderr.take().unwrap());
    let mut lines = String::new();
    said.read_line(&mut lines).unwrap();
    assert!(lines.starts_with("Listening on"), "{lines}");
    let others = format!("// Written by somebody else.\n{}", std::fs::read_to_string(&path).unwrap());
    std::fs::write(&path, &others).unwrap();
    let _sender = Sender::start(&floor, simulated(&floor), port, |sim, _| {
        sim.step(&[]);
    });
    said.read_to_string(&mut lines).unwrap();
    assert_eq!(tare.wait().unwrap().code(), Some(1), "{lines}");
    assert!(lines.contains("floor.ron was changed by another program meanwhile"), "{lines}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), others);
}

#[test]
fn parts_of_other_laws_are_named_kept_and_told_in_words() {
    let (folder, _) = site();
    let laws: [(&str, &dyn Fn(f32) -> f32); 4] = [
        ("sw", &|v| 0.5 * (1.34 * v).exp()),
        ("se", &|v| 0.3 * v.powf(4.2)),
        ("nw", &|v| 35.0 * v / (5.0 - v)),
        ("ne", &|v| 82.0 * (v - 0.3)),
    ];
    let mut table = String::from("col,row,corner,volts,newtons\n");
    for (corner, law) in laws {
        for step in 1..=20_u16 {
            let volts = 0.4 + 0.22 * f32::from(step);
            // Two percent up and down in an order that no curve follows.
            let noise = 1.0 + 0.02 * if step * step % 7 > 2 { 1.0 } else { -1.0 };
            table += &format!("0,0,{corner},{volts:.4},{:.3}\n", law(volts) * noise);
        }
    }
    fs::write(folder.path().join("laws.csv"), table).unwrap();
    let output =
        underfoot(folder.path(), &["calibrate", "curves", "laws.csv", "--floor", "floor.ron", "--laws"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let told = String::from_utf8(output.stdout).unwrap();
    let rows: Vec<&str> = told.lines().filter(|line| line.starts_with("(0, 0)")).collect();
    for (row, law) in rows.iter().zip(["exponential", "power", "divider", "linear"]) {
        assert!(row.contains(law) && row.contains("good"), "{told}");
        let words = format!("follows a {law} law; exponential would be off by");
        assert_eq!(row.contains(&words), law != "exponential", "{told}");
    }
    assert_eq!(told.matches("criterion +0.0").count(), 4, "{told}");
    let kept = load_floor(&folder.path().join("floor.ron")).unwrap();
    let kinds = kept.calibration[0].map(|law| law.kind().name());
    assert_eq!(kinds, ["exponential", "power", "divider", "linear"]);
    assert!((kept.calibration[0][3].numbers()[1] - 0.3).abs() < 0.05, "{:?}", kept.calibration[0][3]);
}
