//! Calibrating a floor from load-cell tables, pressed points and real packets over loopback.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use underfoot::floor::{Calibration, Corner, Day, Floor, Geometry, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{Assembler, Fit, LoadPoint, LoadTable, PressTable, SensorLoads, Verdict};
use underfoot::serve::{ForceWatch, TareFailure, take_tare};
use underfoot::sim::{self, Foot, Load, PartConfig, Print, SensorFault, SimConfig, SimFloor};
use underfoot::source::{SensorSource, UdpSource};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{SensorEncoder, SensorFormat, SensorPacket};

const ANY_PORT: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

fn floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(3, 2).unwrap())
}

fn simulated(floor: &Floor) -> SimFloor {
    SimFloor::new(floor, SimConfig::default(), 7)
}

/// A simulated floor that sends real datagrams, a millisecond's every millisecond, until dropped.
struct Sender {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Sender {
    /// Sends to `target`; `step` moves the floor by the millisecond given.
    fn start(
        floor: &Floor,
        mut sim: SimFloor,
        target: SocketAddr,
        step: impl Fn(&mut SimFloor, u32) + Send + 'static,
    ) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let mut encoder = SensorEncoder::new(floor, SensorFormat::Counts);
        let socket = UdpSocket::bind(ANY_PORT).unwrap();
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let started = std::time::Instant::now();
            for sequence in 0.. {
                if stopped.load(Ordering::Relaxed) {
                    return;
                }
                step(&mut sim, sequence);
                for (board, readings) in (0..).zip(sim.readings()) {
                    let readings = readings.clone();
                    let packet = SensorPacket { board, sequence, received: Instant::START, readings };
                    // Whoever listened may be gone.
                    let _ = socket.send_to(encoder.encode(&packet).unwrap(), target);
                }
                let due = Duration::from_millis(u64::from(sequence) + 1);
                std::thread::sleep(due.saturating_sub(started.elapsed()));
            }
        });
        Self { stop, thread: Some(thread) }
    }
}

impl Drop for Sender {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

fn standing(at: Vec2) -> Foot {
    Foot { position: at, heading: 0.2, length_m: 0.27, force: Newtons(350.0), roll: 0.5 }
}

#[test]
fn simulated_parts_come_back_within_one_percent_through_two_percent_of_noise() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    let floor = floor();
    let exact = PartConfig { a_spread: 0.25, b_spread: 0.05, ..PartConfig::exact() };
    let config = SimConfig { sensing: sim::Sensing::Counts(exact), ..SimConfig::default() };
    let sim = SimFloor::new(&floor, config, 7);
    let table = LoadTable::parse(&sim::load_table(&sim, 3), &floor.geometry).unwrap();
    assert_eq!(table.sensors.len(), 24);
    let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(5);
    let noise = Normal::new(1.0, 0.02).unwrap();
    for clean in &table.sensors {
        let truth = clean.judge().fit.unwrap().calibration;
        // Eight seconds of a slow press at 1 kHz: each load 200 times, the load cell off by 2 % each time.
        let points = clean.points.iter().flat_map(|point| std::iter::repeat_n(*point, 200));
        let points: Vec<_> =
            points.map(|point| LoadPoint::new(point.volts, point.force * noise.sample(&mut rng))).collect();
        let judgement = SensorLoads { points, ..clean.clone() }.judge();
        let found = judgement.fit.unwrap().calibration;
        let (a, b) = (found.a_n / truth.a_n, found.b_per_volt / truth.b_per_volt);
        assert!((a - 1.0).abs() < 0.01 && (b - 1.0).abs() < 0.01, "{}: a {a}, b {b}", clean.sensor);
        assert_eq!(judgement.verdict, Verdict::Good);
    }
}

#[test]
fn tables_of_a_simulated_floor_calibrate_and_map_it() {
    let nominal = floor();
    let sim = simulated(&nominal);
    // The tare was measured through slightly other curves; it follows the new ones.
    let mut floor = sim::calibrated(&nominal, &sim, 2).unwrap();
    let table = LoadTable::parse(&sim::load_table(&sim, 1), &floor.geometry).unwrap();
    for loads in &table.sensors {
        let judgement = loads.judge();
        assert_eq!(judgement.verdict, Verdict::Good, "{}", loads.sensor);
        floor.recalibrate(loads.sensor, judgement.fit.unwrap().calibration, None);
    }
    let table = PressTable::parse(&sim::press_table(&floor, &sim, 1), &floor).unwrap();
    assert_eq!(table.tiles.len(), 6);
    for points in &table.tiles {
        let fit = points.fit(&floor).unwrap();
        assert!(fit.before.p95_m > 2.0 * fit.after.p95_m, "{}: {:?}", points.tile, fit.before);
        assert!(fit.after.p95_m < 0.01 && fit.after.median_m < 0.004, "{}: {:?}", points.tile, fit.after);
    }
}

#[test]
fn places_alone_teach_the_part_of_the_distortion_that_no_force_changes() {
    // A plate that bends: everything is seen a tenth too far inside, and a little to the east.
    let floor = floor();
    let mut text = String::from("true_x_m,true_y_m,est_x_m,est_y_m\n");
    let centre = floor.geometry.centre(TileId::new(1, 1));
    for step in 0..49_u8 {
        let at = Vec2::new(f32::from(step % 7) - 3.0, f32::from(step / 7) - 3.0) * 0.046;
        let seen = centre + at * 0.9 + Vec2::new(0.004, 0.0);
        text += &format!("{},{},{},{}\n", centre.x + at.x, centre.y + at.y, seen.x, seen.y);
    }
    let table = PressTable::parse(&text, &floor).unwrap();
    let fit = table.tiles[0].fit(&floor).unwrap();
    assert_eq!((table.tiles[0].tile, fit.points), (TileId::new(1, 1), 49));
    assert!(fit.before.worst_m > 0.014 && fit.after.worst_m < 0.002, "{fit:?}");
}

#[test]
fn a_part_beyond_repair_is_named() {
    let floor = floor();
    let text = sim::load_table(&simulated(&floor), 1);
    // Its wires are swapped: volts fall as the load grows.
    let broken: Vec<String> = text
        .lines()
        .map(|line| match line.strip_prefix("1,1,nw,").and_then(|rest| rest.split_once(',')) {
            Some((volts, newtons)) => format!("1,1,nw,{:.5},{newtons}", 5.0 - volts.parse::<f32>().unwrap()),
            None => line.to_owned(),
        })
        .collect();
    let table = LoadTable::parse(&broken.join("\n"), &floor.geometry).unwrap();
    let beyond = table.sensors.iter().filter(|loads| loads.judge().verdict == Verdict::Replace);
    let named: Vec<_> = beyond.map(|loads| loads.sensor).collect();
    assert_eq!(named, [SensorId { tile: TileId::new(1, 1), corner: Corner::NorthWest }]);
}

#[test]
fn an_empty_floor_is_tared_over_real_packets() {
    let floor = floor();
    let sim = simulated(&floor);
    let expected = sim::calibrated(&floor, &sim, 1).unwrap();
    let calibrated = Floor { tare: vec![[Newtons::ZERO; 4]; 6], ..expected.clone() };
    let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let _sender = Sender::start(&floor, sim, source.local_addr().unwrap(), |sim, _| {
        sim.step(&[]);
    });
    let tare = take_tare(&mut source, &calibrated, Duration::from_secs(10), false).unwrap();
    for (found, expected) in tare.iter().flatten().zip(expected.tare.iter().flatten()) {
        assert!((*found - *expected).abs() < Newtons(0.1), "{found:?} for {expected:?}");
    }
}

#[test]
fn somebody_on_the_floor_is_named_by_the_sensor_and_nothing_is_taken() {
    let floor = floor();
    let sim = simulated(&floor);
    let calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let place = floor.geometry.centre(TileId::new(2, 1));
    let _sender = Sender::start(&floor, sim, source.local_addr().unwrap(), move |sim, _| {
        sim.step(&[standing(place)]);
    });
    let refused = take_tare(&mut source, &calibrated, Duration::from_secs(1), true).unwrap_err();
    let TareFailure::NotQuiet { sensor, mean, .. } = &refused else { panic!("{refused}") };
    assert_eq!(sensor.tile, TileId::new(2, 1));
    assert!(mean.0 > 60.0, "{mean:?}");
    assert!(refused.to_string().contains("tile (2, 1)"), "{refused}");
}

#[test]
fn something_light_that_was_not_there_at_the_last_tare_is_noticed() {
    let floor = floor();
    let sim = simulated(&floor);
    let mut calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    calibrated.tared = Some(Day::of_unix_seconds(0));
    // A bag of 4 kg, still and spread over a tile: no sensor carries much.
    let at = floor.geometry.centre(TileId::new(1, 0));
    let bag = Load { print: Print::Point, position: at, heading: 0.0, force: Newtons(40.0) };
    let tare = |accept_change| {
        let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
        let to = source.local_addr().unwrap();
        let _sender = Sender::start(&floor, sim.clone(), to, move |sim, _| {
            sim.step_under([bag]);
        });
        take_tare(&mut source, &calibrated, Duration::from_secs(10), accept_change)
    };
    let refused = tare(false).unwrap_err();
    let TareFailure::Changed { tile, change } = refused else { panic!("{refused}") };
    assert_eq!(tile, TileId::new(1, 0));
    assert!((change.0 - 40.0).abs() < 8.0, "{change:?}");
    assert!(tare(true).is_ok());
}

#[test]
fn boards_that_send_nothing_and_broken_sensors_are_named() {
    let floor = floor();
    let sim = simulated(&floor);
    let calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    // Only the southern row's board is plugged in.
    let southern = Floor { boards: floor.boards[..1].to_vec(), ..floor.clone() };
    let half = SimFloor::new(&southern, SimConfig::default(), 7);
    let sender = Sender::start(&southern, half, source.local_addr().unwrap(), |sim, _| {
        sim.step(&[]);
    });
    let refused = take_tare(&mut source, &calibrated, Duration::from_millis(700), false).unwrap_err();
    drop(sender);
    let TareFailure::Silent { boards } = refused else { panic!("{refused}") };
    assert_eq!(boards, ["/underfoot/board/1"]);

    let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let mut broken = sim;
    let sensor = SensorId { tile: TileId::new(0, 1), corner: Corner::SouthEast };
    broken.set_fault(sensor, Some(SensorFault::Short));
    let _sender = Sender::start(&floor, broken, source.local_addr().unwrap(), |sim, _| {
        sim.step(&[]);
    });
    let refused = take_tare(&mut source, &calibrated, Duration::from_secs(1), false).unwrap_err();
    assert!(matches!(refused, TareFailure::NotQuiet { sensor: named, .. } if named == sensor), "{refused}");
}

#[test]
fn a_press_is_measured_over_real_packets() {
    let floor = floor();
    let sim = simulated(&floor);
    let calibrated = sim::calibrated(&floor, &sim, 1).unwrap();
    let mut source = UdpSource::bind(ANY_PORT, &calibrated).unwrap();
    let at = floor.geometry.centre(TileId::new(1, 1));
    // Half a second empty, then 200 N in the middle of a tile for as long as anybody looks.
    let _sender = Sender::start(&floor, sim, source.local_addr().unwrap(), move |sim, millis| {
        let press = Load { print: Print::Point, position: at, heading: 0.0, force: Newtons(200.0) };
        sim.step_under((millis >= 500).then_some(press));
    });
    let mut assembler = Assembler::new(&calibrated);
    let mut watch = ForceWatch::new(&calibrated);
    while watch.frames() < 2000 {
        match source.next(Duration::from_millis(5)).unwrap() {
            Some(packet) => assembler.take(&packet),
            None => assembler.poll(source.now()),
        }
        while let Some(frame) = assembler.ready() {
            watch.take(frame);
        }
    }
    let ranges: Vec<_> = watch.ranges().collect();
    let pressed = &ranges[floor.geometry.index(TileId::new(1, 1)).unwrap()];
    assert!(pressed.force.least_n.abs() < 1.0, "{pressed:?}");
    assert!((150.0..250.0).contains(&pressed.force.median_n), "{pressed:?}");
    assert!(pressed.force.greatest_n < 260.0, "{pressed:?}");
    assert!(pressed.sensors.iter().all(|sensor| (20.0..90.0).contains(&sensor.greatest_n)), "{pressed:?}");
    assert!(ranges[0].force.greatest_n < 1.0, "{:?}", ranges[0]);
    assert_eq!(watch.heaviest().unwrap().0, TileId::new(1, 1));
}

#[test]
fn a_sensor_at_its_end_is_left_out_of_the_fit() {
    let points = |most: u16| -> String {
        (1..=40_u16)
            .map(|step| {
                let counts = most / 40 * step;
                format!("0,0,sw,{counts},{}\n", Calibration::NOMINAL.force(counts).0)
            })
            .collect()
    };
    let text =
        format!("col,row,corner,counts,newtons\n{}0,0,sw,65535,900\n0,0,sw,65535,1500\n", points(60_000));
    let table = LoadTable::parse(&text, &Geometry::default()).unwrap();
    assert_eq!((table.sensors[0].points.len(), table.sensors[0].saturated), (40, 2));
    let Fit { calibration, residual } = table.sensors[0].judge().fit.unwrap();
    assert!((calibration.a_n - 0.5).abs() < 1e-3 && residual < 1e-3, "{calibration:?}");
}

/// The program itself, with real files.
#[cfg(feature = "program")]
mod program {
    use std::fs;
    use std::path::Path;
    use std::process::{Command, Output};

    use underfoot::schema::{load_floor, save_floor};

    use super::*;

    fn underfoot(folder: &Path, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_underfoot")).args(args).current_dir(folder).output().unwrap()
    }

    fn said(output: &Output) -> String {
        String::from_utf8_lossy(&output.stderr).into_owned()
    }

    fn site() -> (tempfile::TempDir, String) {
        let folder = tempfile::tempdir().unwrap();
        let floor = floor();
        save_floor(&floor, &folder.path().join("floor.ron")).unwrap();
        let table = sim::load_table(&simulated(&floor), 1);
        fs::write(folder.path().join("loads.csv"), &table).unwrap();
        (folder, table)
    }

    #[test]
    fn curves_are_kept_with_date_and_residual_and_the_older_file_beside_it() {
        let (folder, _) = site();
        let args =
            ["calibrate", "curves", "loads.csv", "--floor", "floor.ron", "--plot", "curves.svg", "--json"];
        let output = underfoot(folder.path(), &args);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(answer["sensors"].as_array().unwrap().len(), 24);
        assert_eq!(answer["sensors"][5]["verdict"], "good");
        let kept = load_floor(&folder.path().join("floor.ron")).unwrap();
        let record = kept.calibration_records[5][3].unwrap();
        assert!((0.02..0.08).contains(&record.residual), "{record:?}");
        assert_eq!(load_floor(&folder.path().join("floor.ron.bak")).unwrap(), floor());
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
        let kept = load_floor(&folder.path().join("new.ron")).unwrap();
        assert_eq!(kept.calibration[2][1], Calibration::NOMINAL);
        assert_ne!(kept.calibration[2][0], Calibration::NOMINAL);
        assert_eq!(load_floor(&folder.path().join("floor.ron")).unwrap(), floor());
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
        let nominal = floor();
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
        assert!(mapped.map_records.iter().flatten().all(|record| record.residual_m < 0.006));
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
        // Files of this process may have 512 bytes, as on a disk with no more room.
        let limited = "ulimit -f 1; trap '' XFSZ; exec \"$0\" calibrate curves loads.csv --floor floor.ron";
        let output = Command::new("sh")
            .args(["-c", limited, env!("CARGO_BIN_EXE_underfoot")])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        assert!(said(&output).contains("what it held before is untouched"), "{}", said(&output));
        assert_eq!(load_floor(&folder.path().join("floor.ron")).unwrap(), floor());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no half of a file is left");
    }

    /// Fault F2: the power goes at any system call of the save. Passed over where there is no strace.
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
                if kept == floor() {
                    old_ones += 1;
                } else {
                    assert_eq!(kept, new, "{call} {number}");
                    assert_eq!(load_floor(&folder.path().join("floor.ron.bak")).unwrap(), floor());
                    new_ones += 1;
                }
            }
        }
        assert!(old_ones >= 5 && new_ones >= 1, "{kills} kills: {old_ones} old, {new_ones} new");
    }

    /// A port that was free a moment ago.
    fn free_port() -> SocketAddr {
        UdpSocket::bind(ANY_PORT).unwrap().local_addr().unwrap()
    }

    #[test]
    fn tare_and_measure_take_packets_from_a_floor() {
        let (folder, _) = site();
        let nominal = floor();
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
}
