//! Pads behind pseudo terminals, from their bytes to presses.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod pad;

use std::net::UdpSocket;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket, OscType, encoder};
use underfoot::floor::Floor;
use underfoot::runtime::Session;
use underfoot::schema::{Kinds, parse_floor, parse_floor_with_ports, parse_layout};
use underfoot::source::UdpSource;
use underfoot::wire::LinkState;
use underfoot_io::serial::{IfAbsent, SerialError, SerialPorts, absent, wires};

use self::pad::{Firmware, Foot, Pad};

/// Time-out for an event that must happen, on a busy machine.
const AT_LAST: Duration = Duration::from_secs(30);

/// Load of a foot, in counts of ten bits a sensor.
const STANDING: f32 = 560.0;

fn floor(columns: u16, ports: &str) -> Floor {
    let boards = ["Board(tiles: [(0, 0)]), ", "Board(tiles: [(1, 0)])"];
    let boards: String = boards.into_iter().take(columns.into()).collect();
    let text = format!("Floor(columns: {columns}, rows: 1, boards: [{boards}], serial: [{ports}])");
    parse_floor(&text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
}

/// A session with a button on each tile; boards of the network send to its address.
fn session(floor: &Floor, if_absent: IfAbsent) -> Session {
    let page = |columns: u16| {
        let button = |column| {
            format!("(id: \"b{column}\", kind: \"button\", at: ({column}.1, 0.1), size: (0.8, 0.8))")
        };
        let buttons: Vec<String> = (0..columns).map(button).collect();
        let all = format!("regions: [(id: \"r\", at: (0, 0), size: ({columns}, 1))]");
        format!("Layout(version: 1, {all}, widgets: [{}])", buttons.join(", "))
    };
    let page = page(floor.geometry.columns());
    let loaded = parse_layout(&page, "page.ron", &Kinds::builtin(), &floor.geometry);
    let layout = loaded.unwrap_or_else(|problems| panic!("{problems}")).layout;
    let network = UdpSource::bind(([127, 0, 0, 1], 0).into(), floor).unwrap();
    let clock = network.clock();
    let ports = SerialPorts::open(&wires(floor, &[]).unwrap(), floor, clock.clone(), if_absent).unwrap();
    let input = ports.beside(network.into());
    Session::source(input, clock).floor(floor.clone()).layout(layout).start().unwrap()
}

fn is_live(session: &Session) -> bool {
    session.snapshot().floor.link == LinkState::Live
}

fn wait(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < AT_LAST, "never {what}");
        sleep(Duration::from_millis(1));
    }
}

/// Waits for the next press or end of a press, and compares it.
fn expect(session: &Session, id: &str, name: &str) {
    let ends = ["pressed", "released", "cancelled"];
    let begun = Instant::now();
    while begun.elapsed() < AT_LAST {
        let Some(event) = session.next_event_timeout(Duration::from_millis(100)) else { continue };
        if ends.contains(&event.kind.name()) {
            assert_eq!((event.id(), event.kind.name()), (id, name));
            return;
        }
    }
    panic!("{id} is never {name}: {:?}", session.snapshot().floor);
}

/// Events of feet that wait at present.
fn presses(session: &Session) -> usize {
    let names = ["pressed", "released", "clicked", "cancelled"];
    std::iter::from_fn(|| session.next_event()).filter(|event| names.contains(&event.kind.name())).count()
}

/// The floor is empty for as long as its tare takes.
fn tare(session: &Session) {
    wait("live", || is_live(session));
    sleep(Duration::from_millis(1500));
}

// N16
#[test]
fn a_foot_presses_through_each_firmware_and_a_pulled_cable_cancels_its_hold() {
    for firmware in [Firmware::Lines, Firmware::Asked, Firmware::Slip] {
        let folder = tempfile::tempdir().unwrap();
        let (path, foot) = (folder.path().join("pad"), Foot::default());
        let pad = Pad::plug(&path, firmware, &foot);
        let session = session(&floor(1, &firmware.port(&path, 0)), IfAbsent::Refuse);
        tare(&session);
        foot.moves_to(STANDING);
        expect(&session, "b0", "pressed");
        foot.moves_to(0.0);
        expect(&session, "b0", "released");
        foot.moves_to(STANDING);
        expect(&session, "b0", "pressed");

        drop(pad);
        let pulled = Instant::now();
        expect(&session, "b0", "cancelled");
        let cancelled = pulled.elapsed();
        wait("lost", || session.snapshot().floor.link == LinkState::Lost);
        // The foot lifts meanwhile; another pad of the same kind is plugged in.
        foot.moves_to(0.0);
        sleep(Duration::from_millis(300));
        assert_eq!(presses(&session), 0, "{firmware:?}: something acted while unplugged");
        let plugged = Instant::now();
        let pad = Pad::plug(&path, firmware, &foot);
        wait("live again", || is_live(&session));
        eprintln!(
            "{firmware:?}: cancelled {cancelled:?} after the pull, live {:?} after the plug",
            plugged.elapsed()
        );
        sleep(Duration::from_millis(1500));
        assert_eq!(presses(&session), 0, "{firmware:?}: something acted by itself");
        foot.moves_to(STANDING);
        expect(&session, "b0", "pressed");
        drop(pad);
    }
}

// N17
#[test]
fn garbage_is_counted_and_named_and_presses_nothing() {
    for firmware in [Firmware::Noise, Firmware::HalfLines] {
        let folder = tempfile::tempdir().unwrap();
        let (path, foot) = (folder.path().join("pad"), Foot::default());
        let ports = firmware.port(&path, 0);
        let good = Pad::plug(&path, Firmware::Lines, &foot);
        let session = session(&floor(1, &ports), IfAbsent::Refuse);
        tare(&session);
        drop(good);
        foot.moves_to(STANDING);
        let bad = Pad::plug(&path, firmware, &foot);
        sleep(Duration::from_secs(2));
        let floor = session.snapshot().floor;
        assert!(floor.counters.refused() > 100, "{firmware:?}: {:?}", floor.counters);
        assert_eq!(presses(&session), 0, "{firmware:?}");
        if firmware == Firmware::Noise {
            wait("named", || {
                let cause = session.snapshot().floor.link_cause;
                cause
                    .is_some_and(|cause| cause.name() == "port_garbled" && cause.to_string().contains("/pad"))
            });
        }
        drop(bad);
    }
}

// N17
#[test]
fn text_on_a_port_of_osc_and_osc_on_a_port_of_text_are_told_apart() {
    for (says, sends, hint) in [
        (Firmware::Slip, Firmware::Lines, "looks like lines of text"),
        (Firmware::Lines, Firmware::Slip, "looks like OSC in SLIP frames"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (path, foot) = (folder.path().join("pad"), Foot::default());
        let _pad = Pad::plug(&path, sends, &foot);
        let session = session(&floor(1, &says.port(&path, 0)), IfAbsent::Refuse);
        wait("told", || {
            let cause = session.snapshot().floor.link_cause;
            cause.is_some_and(|cause| cause.to_string().contains(hint))
        });
    }
}

/// A board of the network that sends each millisecond until `stop`.
fn network_board(to: std::net::SocketAddr, foot: Foot, stop: Arc<AtomicBool>) {
    spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let begun = Instant::now();
        for sample in 0_u32.. {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            let counts = foot.counts(sample).map(|count| OscType::Int((count * 64.0) as i32));
            let args = std::iter::once(OscType::Int(sample.cast_signed())).chain(counts).collect();
            let message = OscPacket::Message(OscMessage { addr: "/underfoot/board/0".into(), args });
            drop(socket.send_to(&encoder::encode(&message).unwrap(), to));
            sleep(Duration::from_millis(sample.into()).saturating_sub(begun.elapsed()));
        }
    });
}

#[test]
fn boards_of_the_network_and_of_a_port_are_one_floor() {
    let folder = tempfile::tempdir().unwrap();
    let (path, east, west) = (folder.path().join("pad"), Foot::default(), Foot::default());
    let pad = Pad::plug(&path, Firmware::Lines, &east);
    let session = session(&floor(2, &Firmware::Lines.port(&path, 1)), IfAbsent::Refuse);
    let stop = Arc::<AtomicBool>::default();
    network_board(session.local_addr().unwrap(), west.clone(), Arc::clone(&stop));
    tare(&session);
    for (foot, id) in [(&west, "b0"), (&east, "b1")] {
        foot.moves_to(STANDING);
        expect(&session, id, "pressed");
        foot.moves_to(0.0);
        expect(&session, id, "released");
    }
    // One lost port leaves the other boards at work.
    drop(pad);
    wait("partial", || session.snapshot().floor.link == LinkState::Partial);
    west.moves_to(STANDING);
    expect(&session, "b0", "pressed");
    stop.store(true, Ordering::Relaxed);
}

// N18
#[test]
fn a_port_that_is_not_there_is_refused_with_its_place_or_awaited() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pad");
    let text =
        format!("Floor(\n    columns: 1, rows: 1,\n    serial: [{}],\n)", Firmware::Lines.port(&path, 0));
    let problems = parse_floor_with_ports(&text, "floor.ron", &absent).unwrap_err().to_string();
    assert!(problems.contains("there is no serial port") && problems.contains("floor.ron:3:"), "{problems}");
    let floor = parse_floor(&text, "floor.ron").unwrap();
    let open = |if_absent| SerialPorts::open(&floor.serial, &floor, Arc::new(underfoot_now), if_absent);
    assert!(matches!(open(IfAbsent::Refuse), Err(SerialError::Absent { .. })));
    assert!(open(IfAbsent::Wait).is_ok());

    let foot = Foot::default();
    let session = session(&floor, IfAbsent::Wait);
    sleep(Duration::from_millis(200));
    let _pad = Pad::plug(Path::new(&path), Firmware::Lines, &foot);
    tare(&session);
    foot.moves_to(STANDING);
    expect(&session, "b0", "pressed");
}

/// A clock that stands still.
fn underfoot_now() -> underfoot::units::Instant {
    underfoot::units::Instant::START
}
