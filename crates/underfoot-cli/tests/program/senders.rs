//! Permissions of senders to a running floor: loopback has many addresses, so that one machine acts as several.
#![cfg(target_os = "linux")]

use std::net::UdpSocket;
use std::process::Stdio;
use std::time::Duration;

use underfoot::floor::Floor;
use underfoot::wire::{SensorEncoder, SensorFormat, SensorPacket};
use underfoot_sim::{SimConfig, SimFloor};

use super::end_to_end::{Served, terminate, underfoot};
use crate::ports::free_port;

/// A socket of the machine at `ip`.
fn at(ip: &str) -> UdpSocket {
    let socket = UdpSocket::bind((ip, 0)).unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    socket
}

/// An OSC message with one integer, or without arguments.
fn message(address: &str, argument: Option<i32>) -> Vec<u8> {
    let mut bytes = address.as_bytes().to_vec();
    bytes.resize((bytes.len() / 4 + 1) * 4, 0);
    bytes.extend(if argument.is_some() { b",i\0\0" } else { b",\0\0\0" });
    bytes.extend(argument.unwrap_or_default().to_be_bytes().iter().filter(|_| argument.is_some()));
    bytes
}

/// The answer to `socket` from `port`; empty without one.
fn asked(socket: &UdpSocket, port: u16, request: &[u8]) -> Vec<u8> {
    socket.send_to(request, ("127.0.0.1", port)).unwrap();
    let mut answer = [0; 512];
    socket.recv(&mut answer).map(|length| answer[..length].to_vec()).unwrap_or_default()
}

/// A millisecond of every board of an empty floor.
pub(super) fn packets(sequence: u32) -> Vec<Vec<u8>> {
    let floor = Floor::default();
    let sim = SimFloor::new(&floor, SimConfig::default(), 1);
    let mut encoder = SensorEncoder::new(&floor, SensorFormat::Counts);
    let received = underfoot::units::Instant::START;
    let packets = (0..).zip(sim.readings()).map(|(board, readings)| SensorPacket {
        board,
        sequence,
        received,
        readings: readings.clone(),
    });
    packets.map(|packet| encoder.encode(&packet).unwrap().to_vec()).collect()
}

struct Floored {
    served: Served,
    sensors: u16,
    requests: u16,
}

/// A served floor with these options, which has answered from its port for requests.
fn serve(options: &[&str], app: &str, own_port: bool) -> Floored {
    let (sensors, requests) = (free_port(), free_port());
    let mut command = underfoot();
    command.args(["run", "map", "--no-osc", "--wav", "/dev/null"]).args(options);
    command.args(["--listen", &format!("127.0.0.1:{sensors}")]);
    if own_port {
        command.args(["--commands", &format!("127.0.0.1:{requests}")]);
    }
    let served = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().map(Served).unwrap();
    let requests = if own_port { requests } else { sensors };
    let app = at(app);
    let answers = (0..50).any(|_| !asked(&app, requests, &message("/underfoot/mute/get", None)).is_empty());
    assert!(answers, "the floor answers who may ask");
    Floored { served, sensors, requests }
}

impl Floored {
    /// Ends the floor and returns its standard error.
    fn ended(mut self) -> String {
        terminate(&self.served.0);
        assert_eq!(self.served.0.wait().unwrap().code(), Some(0));
        std::io::read_to_string(self.served.0.stderr.take().unwrap()).unwrap()
    }
}

// P8, P12
#[test]
fn a_sender_that_is_not_allowed_has_no_effect_and_is_named() {
    let floor = serve(&["--allow", "127.0.0.2", "--allow-commands", "127.0.0.3/32"], "127.0.0.3", true);
    let mute = message("/underfoot/mute/set", Some(1));
    let get = message("/underfoot/mute/get", None);
    let nothing = Vec::<u8>::new();
    for (sender, port) in [
        ("127.0.0.1", floor.sensors),
        ("127.0.0.1", floor.requests),
        ("127.0.0.2", floor.sensors),
        ("127.0.0.2", floor.requests),
        ("127.0.0.3", floor.sensors),
    ] {
        let socket = at(sender);
        assert_eq!(asked(&socket, port, &mute), nothing, "{sender} to {port}");
        assert_eq!(asked(&socket, port, &get), nothing, "{sender} to {port}");
        // An invalid request has no answer either.
        assert_eq!(asked(&socket, port, &message("/underfoot/mute/set", None)), nothing);
    }
    let answer = asked(&at("127.0.0.3"), floor.requests, &get);
    assert_eq!(answer, message("/underfoot/mute", Some(0)), "nothing was muted");
    let sender = at("127.0.0.1");
    for packet in packets(1) {
        sender.send_to(&packet, ("127.0.0.1", floor.sensors)).unwrap();
        at("127.0.0.3").send_to(&packet, ("127.0.0.1", floor.requests)).unwrap();
    }
    std::thread::sleep(Duration::from_millis(200));
    let said = floor.ended();
    assert!(said.contains("0 packets, 0 frames"), "{said}");
    // 13 requests to either port, and 12 packets; two malformed requests on a port where their sender is allowed.
    let count = said.split("may not send ").nth(1).unwrap().split(',').next().unwrap();
    assert!(count.parse::<u32>().unwrap() >= 25, "{said}");
    for named in ["127.0.0.1", "127.0.0.2", "127.0.0.3"] {
        let is_named = said.lines().any(|line| line.contains("datagram refused") && line.contains(named));
        assert!(is_named, "{named} is not named:\n{said}");
    }
}

// P12
#[test]
fn without_options_this_machine_is_heard_on_one_port() {
    let floor = serve(&[], "127.0.0.1", false);
    let sender = at("127.0.0.1");
    for packet in packets(1) {
        sender.send_to(&packet, ("127.0.0.1", floor.sensors)).unwrap();
    }
    assert_eq!(
        asked(&sender, floor.requests, &message("/underfoot/mute/get", None)),
        message("/underfoot/mute", Some(0))
    );
    let said = floor.ended();
    assert!(said.contains("6 packets") && said.contains("refused 0"), "{said}");
}

#[test]
fn a_pinned_board_is_taken_from_where_it_was_first_heard() {
    let floor = serve(&["--pin"], "127.0.0.1", false);
    let (first, second) = (at("127.0.0.1"), at("127.0.0.2"));
    for (sender, sequence) in [(&first, 1), (&second, 2), (&first, 3)] {
        for packet in packets(sequence) {
            sender.send_to(&packet, ("127.0.0.1", floor.sensors)).unwrap();
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    // This answer comes after all of them.
    assert!(!asked(&first, floor.requests, &message("/underfoot/mute/get", None)).is_empty());
    let said = floor.ended();
    let count = |before: &str, after: &str| -> u32 {
        let rest = said.split(before).nth(1).unwrap();
        rest.split(after).next().unwrap().trim().parse().unwrap()
    };
    let packets = said.lines().find_map(|line| line.split_once(" packets, ")).unwrap().0;
    // On a busy machine packets wait until they are late.
    assert_eq!(packets.parse::<u32>().unwrap() + count("late ", ","), 12, "{said}");
    assert_eq!(count("may not send ", ","), 6, "{said}");
    assert!(said.contains("was first heard from 127.0.0.1"), "{said}");
}

// P6
#[test]
fn one_sender_s_flood_takes_nothing_from_another() {
    let floor = serve(&[], "127.0.0.1", false);
    let (loud, quiet) = (at("127.0.0.1"), at("127.0.0.1"));
    let get = message("/underfoot/widget/nobody/get", None);
    for _ in 0..20_000 {
        // A full receive buffer makes the kernel drop packets.
        let _ = loud.send_to(&get, ("127.0.0.1", floor.requests));
    }
    let mute = message("/underfoot/mute/get", None);
    assert!((0..25).any(|_| !asked(&quiet, floor.requests, &mute).is_empty()));
    let said = floor.ended();
    let count = said.split("sent too much ").nth(1).unwrap().split(')').next().unwrap();
    assert!(count.parse::<u32>().unwrap() > 1000, "{said}");
}
