//! Boards with deviations from the protocol: the program's reports about them in the log, as JSON and over OSC.

use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};
use serde_json::Value;

use crate::end_to_end::{Served, underfoot};

/// Time-out for an event that must happen, on a busy machine.
const AT_LAST: Duration = Duration::from_secs(40);

/// One tile, one board, one button on all of it.
const FLOOR: &str = "Floor(columns: 1, rows: 1)\n";
const PAGE: &str = r#"Layout(version: 1, regions: [(id: "r", at: (0, 0), size: (1, 1))],
    widgets: [(id: "b", kind: "button", at: (0.1, 0.1), size: (0.8, 0.8))])"#;

fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.into(), args })
}

/// Four counts on a converter of `unit` counts a unit: an empty tile of 120 units, and 560 more under a foot from
/// second four to second seven. Noise is a third of a unit.
fn counts(ms: u64, unit: f32) -> [i32; 4] {
    counts_at(ms as f32 / 1000.0, ms, unit)
}

/// The counts of packet `n`, which is sent at this second.
fn counts_at(seconds: f32, n: u64, unit: f32) -> [i32; 4] {
    let load = ((seconds - 4.0) / 0.12).min((7.0 - seconds) / 0.12).clamp(0.0, 1.0);
    [3, 5, 7, 11].map(|salt: u64| {
        let mixed = (n << 8 | salt).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ mixed >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let noise = (mixed >> 48) as f32 / 65_536.0 - 0.5;
        (unit * (120.0 + 560.0 * load + noise)) as i32
    })
}

/// A board's message: its sequence number and these arguments.
fn readings(sequence: u64, values: impl IntoIterator<Item = OscType>) -> OscPacket {
    let sequence = OscType::Int(sequence as i32);
    message("/underfoot/board/0", std::iter::once(sequence).chain(values).collect())
}

/// The program on that floor, and its outputs.
struct Run {
    _server: Served,
    out: std::sync::mpsc::Receiver<Value>,
    log: std::sync::mpsc::Receiver<String>,
    osc: UdpSocket,
    board: UdpSocket,
    _folder: tempfile::TempDir,
}

impl Run {
    fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("floor.ron"), FLOOR).unwrap();
        std::fs::write(folder.path().join("page.ron"), PAGE).unwrap();
        let osc = UdpSocket::bind("127.0.0.1:0").unwrap();
        osc.set_nonblocking(true).unwrap();
        let address = format!("127.0.0.1:{}", crate::ports::free_port());
        let mut server = underfoot()
            .current_dir(folder.path())
            .args(["run", "page.ron", "--floor", "floor.ron", "--json", "--listen", &address])
            .args(["--osc", &osc.local_addr().unwrap().to_string(), "--wav", "out.wav"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map(Served)
            .unwrap();
        let log = lines(server.0.stderr.take().unwrap(), Some);
        let out = lines(server.0.stdout.take().unwrap(), |line| serde_json::from_str(&line).ok());
        let board = UdpSocket::bind("127.0.0.1:0").unwrap();
        board.connect(&address).unwrap();
        while !log.recv_timeout(AT_LAST).unwrap().starts_with("Listening on") {}
        Self { _server: server, out, log, osc, board, _folder: folder }
    }

    /// Sends the result of `make` for each packet, `hz` a second, until `fits` holds for a line of JSON.
    fn until(&self, hz: u64, make: impl Fn(u64) -> Vec<u8>, fits: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        for n in 0.. {
            // The receiver may have ended.
            let _ = self.board.send(&make(n));
            while let Ok(line) = self.out.try_recv() {
                if fits(&line) {
                    return line;
                }
            }
            assert!(
                begun.elapsed() < AT_LAST,
                "never told; said: {:?}",
                self.log.try_iter().collect::<Vec<_>>()
            );
            thread::sleep(Duration::from_micros(1_000_000 * (n + 1) / hz).saturating_sub(begun.elapsed()));
        }
        unreachable!("the loop ends with what it waits for")
    }

    /// The reported cause for boards that send these: its line of JSON, after checking that the log and OSC agree.
    fn cause(&self, hz: u64, make: impl Fn(u64) -> Vec<u8>) -> Value {
        let line = self.until(hz, make, |line| line["event"] == "link_cause");
        let (name, why) = (line["cause"].as_str().unwrap(), line["why"].as_str().unwrap());
        let mut said: Vec<String> = self.log.try_iter().collect();
        let end = Instant::now() + Duration::from_secs(5);
        let is_logged = |said: &[String]| said.iter().any(|line| line.contains(why));
        while !is_logged(&said) {
            assert!(Instant::now() < end, "not in the log: {why}: {said:?}");
            said.extend(self.log.recv_timeout(Duration::from_millis(100)));
        }
        let over_osc = format!("link: {name}: {why}");
        while !self.has_heard(&over_osc) {
            assert!(Instant::now() < end, "not over OSC: {over_osc}");
            thread::sleep(Duration::from_millis(5));
        }
        line
    }

    /// Whether `/underfoot/health` has this text among its arguments; reads the received messages.
    fn has_heard(&self, text: &str) -> bool {
        let mut buffer = [0; 4096];
        while let Ok(length) = self.osc.recv(&mut buffer) {
            let Ok((_, OscPacket::Message(message))) = rosc::decoder::decode_udp(&buffer[..length]) else {
                continue;
            };
            if message.addr == "/underfoot/health" && message.args.contains(&OscType::String(text.into())) {
                return true;
            }
        }
        false
    }
}

/// The results of `make` for each line of a pipe, read on a thread of its own.
fn lines<T: Send + 'static>(
    pipe: impl std::io::Read + Send + 'static,
    make: impl Fn(String) -> Option<T> + Send + 'static,
) -> std::sync::mpsc::Receiver<T> {
    let (tell, told) = std::sync::mpsc::channel();
    thread::spawn(move || {
        let lines = BufReader::new(pipe).lines().map_while(Result::ok);
        // The test may have ended.
        lines.filter_map(make).all(|line| tell.send(line).is_ok())
    });
    told
}

fn encoded(packet: &OscPacket) -> Vec<u8> {
    encoder::encode(packet).unwrap()
}

fn ints(values: [i32; 4]) -> [OscType; 4] {
    values.map(OscType::Int)
}

/// The number that packet `n` of a board at `hz` has.
type Numbering = fn(n: u64, hz: u64) -> u64;

/// A board at `hz` under a foot from second four to second seven: pressed and released at these times on the clock of
/// the test, without a word about faults.
fn presses_at(hz: u64, numbering: Numbering, time: &str) {
    let run = Run::start();
    let make = |n: u64| encoded(&readings(numbering(n, hz), ints(counts_at(n as f32 / hz as f32, n, 64.0))));
    let told = std::cell::RefCell::new(Vec::new());
    let begun = Instant::now();
    run.until(hz, make, |line| {
        if ["link_cause", "health", "pressed", "released", "cancelled"]
            .iter()
            .any(|one| line["event"] == *one)
        {
            told.borrow_mut().push((begun.elapsed().as_secs_f64(), line.clone()));
        }
        line["event"] == "released"
    });
    let told = told.into_inner();
    let name = format!("{hz} Hz by {time}: {told:?}");
    let at = |event: &str| told.iter().filter(|(_, line)| line["event"] == event).collect::<Vec<_>>();
    let (presses, releases) = (at("pressed"), at("released"));
    let ([pressed], [released]) = (&presses[..], &releases[..]) else { panic!("{name}") };
    assert!(at("link_cause").is_empty() && at("cancelled").is_empty(), "{name}");
    let health = at("health");
    // The first line is of the time before its first packets.
    let later = || health.iter().filter(|(heard_s, _)| *heard_s > 1.5);
    assert!(later().all(|(_, line)| line["faulty"] == 0 && line["stale"] == 0), "{name}");
    let rate = &health.last().unwrap_or_else(|| panic!("no rate: {name}")).1["rates"][0];
    assert!((rate["hz"].as_f64().unwrap() / hz as f64 - 1.0).abs() < 0.05, "{name}");
    assert_eq!(rate["time"], time, "{name}");
    // A busy machine sends and hears late.
    let most_s = 0.25 + 2.0 / hz as f64;
    for ((heard_s, line), expected_s) in [(pressed, 4.1), (released, 6.93)] {
        assert!((expected_s - 0.1..expected_s + most_s).contains(heard_s), "{name}");
        let floor_s = line["t_s"].as_f64().unwrap() - pressed.1["t_s"].as_f64().unwrap();
        assert!(
            (floor_s - (heard_s - pressed.0)).abs() < 0.2,
            "the floor's time differs from the clock: {name}"
        );
    }
}

#[test]
fn boards_at_20_to_4000_hz_press_by_every_source_of_time() {
    let packets: Numbering = |n, _| n;
    let milliseconds: Numbering = |n, hz| n * 1000 / hz;
    let nothing: Numbering = |_, _| 0;
    let boards = [
        (20, packets, "packets"),
        (50, milliseconds, "milliseconds"),
        (100, nothing, "arrival"),
        (200, packets, "packets"),
        (500, milliseconds, "milliseconds"),
        (2000, nothing, "arrival"),
    ];
    thread::scope(|scope| {
        for (hz, numbering, time) in boards {
            scope.spawn(move || presses_at(hz, numbering, time));
        }
    });
}

#[test]
fn a_ten_bit_converter_is_named_by_its_greatest_count() {
    let run = Run::start();
    let told = run.cause(1000, |n| encoded(&readings(n, ints(counts(n, 1.0)))));
    assert_eq!(told["cause"], "counts_narrow");
    assert!(told["why"].as_str().unwrap().contains("counts never exceed 1023"), "{told}");
}

#[test]
fn doubles_are_named_with_what_would_be_right() {
    let run = Run::start();
    let doubles = |n: u64| counts(n, 64.0).map(|count| OscType::Double(count.into()));
    let told = run.cause(1000, |n| encoded(&readings(n, doubles(n))));
    assert_eq!(told["cause"], "wrong_readings");
    let why = told["why"].as_str().unwrap();
    assert!(why.contains("idddd") && why.contains("must be sent as floats"), "{why}");
}

#[test]
fn another_address_is_named_beside_that_of_the_floor_file() {
    let run = Run::start();
    let make = |n: u64| {
        let mut args = vec![OscType::Int(n as i32)];
        args.extend(ints(counts(n, 64.0)));
        encoded(&message("/board/0", args))
    };
    let told = run.cause(1000, make);
    assert_eq!(told["cause"], "other_address");
    let why = told["why"].as_str().unwrap();
    assert!(why.contains("\"/board/0\"") && why.contains("\"/underfoot/board/0\""), "{why}");
}

#[test]
fn a_program_that_hangs_and_repeats_its_last_packet_is_named() {
    let run = Run::start();
    let told = run.cause(1000, |n| encoded(&readings(n.min(2000), ints(counts(n.min(2000), 64.0)))));
    assert_eq!(told["cause"], "sequence_stands");
}

#[test]
fn a_converter_of_24_bits_is_named_with_its_full_scale() {
    let run = Run::start();
    let told = run.cause(100, |n| encoded(&readings(n, ints(counts(10 * n, 16_384.0)))));
    assert_eq!(told["cause"], "counts_beyond");
    assert!(told["why"].as_str().unwrap().contains("full_scale: 16777215"), "{told}");
}

#[test]
fn a_board_with_its_battery_in_its_bundle_presses() {
    let run = Run::start();
    let make = |n: u64| {
        let content =
            vec![readings(n, ints(counts(n, 64.0))), message("/battery", vec![OscType::Float(3.7)])];
        encoded(&OscPacket::Bundle(OscBundle { timetag: OscTime { seconds: 0, fractional: 1 }, content }))
    };
    let pressed = run.until(1000, make, |line| line["event"] == "pressed");
    assert_eq!(pressed["id"], "b");
}
