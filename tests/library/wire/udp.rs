//! Real datagrams over loopback, to ports the system chooses.

use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::time::Duration;

use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};
use underfoot::floor::{Floor, Geometry};
use underfoot::sense::Assembler;
use underfoot::source::{Port, SourceError, UdpSource};
use underfoot::units::Instant;
use underfoot::wire::{ControlMessage, LinkCause, Readings, SensorEncoder, SensorFormat, SensorPacket};

const ANY_PORT: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

/// Long enough for a loaded machine; tests that pass do not wait for it.
const SOON: Duration = Duration::from_secs(5);

fn floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(6, 2).unwrap())
}

/// A source and a socket connected to it.
fn link() -> (UdpSource, UdpSocket) {
    let source = UdpSource::bind(ANY_PORT, &floor()).unwrap();
    let sender = UdpSocket::bind(ANY_PORT).unwrap();
    sender.connect(source.local_addr().unwrap()).unwrap();
    (source, sender)
}

fn packet(board: u16, sequence: u32) -> SensorPacket {
    let readings = Readings::Counts([Some(1234); 24].into_iter().collect());
    SensorPacket { board, sequence, received: Instant::START, readings }
}

fn datagram(packet: &SensorPacket) -> Vec<u8> {
    SensorEncoder::new(&floor(), SensorFormat::Blob).encode(packet).unwrap().to_vec()
}

fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.into(), args })
}

#[test]
fn packets_arrive_as_sent_and_become_frames() {
    let (mut source, sender) = link();
    let mut assembler = Assembler::new(&floor());
    for sequence in 0..20 {
        for board in 0..2 {
            sender.send(&datagram(&packet(board, sequence))).unwrap();
            let before = source.now();
            let came = source.next(SOON).unwrap().unwrap();
            assert!(came.received <= source.now() && came.received >= before.before(SOON));
            assert_eq!(SensorPacket { received: Instant::START, ..came.clone() }, packet(board, sequence));
            assembler.take(&came);
        }
    }
    let mut frames = 0;
    while assembler.ready().is_some() {
        frames += 1;
    }
    assert!(frames > 0);
    assert_eq!(source.counters().datagrams, 40);
    assert_eq!(source.counters().refused(), 0);
}

#[test]
fn a_bundle_of_all_boards_gives_its_packets_one_by_one() {
    let (mut source, sender) = link();
    let element = |board| {
        let (_, message) = rosc::decoder::decode_udp(&datagram(&packet(board, 5))).unwrap();
        message
    };
    let timetag = OscTime { seconds: 0, fractional: 1 };
    let bundle = OscPacket::Bundle(OscBundle { timetag, content: vec![element(0), element(1)] });
    sender.send(&encoder::encode(&bundle).unwrap()).unwrap();
    assert_eq!(source.next(SOON).unwrap().unwrap().board, 0);
    assert_eq!(source.next(Duration::ZERO).unwrap().unwrap().board, 1);
    assert!(source.next(Duration::ZERO).unwrap().is_none());
    assert!(source.next(Duration::from_millis(1)).unwrap().is_none());
}

// P3, P5, P8, P11
#[test]
fn rubbish_is_counted_by_kind_and_stops_nothing() {
    let (mut source, sender) = link();
    sender.send(b"rubbish").unwrap();
    sender.send(&[]).unwrap();
    sender.send(&vec![0; 65_507]).unwrap();
    sender.send(&encoder::encode(&message("/underfoot/board/9", vec![OscType::Int(1)])).unwrap()).unwrap();
    sender.send(&encoder::encode(&message("/underfoot/board/1", vec![OscType::Int(1)])).unwrap()).unwrap();
    sender.send(&datagram(&packet(1, 7))).unwrap();
    assert_eq!(source.next(SOON).unwrap().unwrap().sequence, 7);
    let counters = source.counters();
    assert_eq!((counters.datagrams, counters.malformed), (6, 3));
    assert_eq!((counters.unknown_address, counters.wrong_shape), (1, 1));
}

#[test]
fn apps_messages_wait_to_be_taken() {
    let (mut source, sender) = link();
    sender.send(&encoder::encode(&message("/underfoot/widget/zoom/enable", vec![])).unwrap()).unwrap();
    let set = message("/underfoot/widget/zoom/set", vec![OscType::Float(0.25)]);
    sender.send(&encoder::encode(&set).unwrap()).unwrap();
    sender.send(&datagram(&packet(0, 1))).unwrap();
    assert!(source.next(SOON).unwrap().is_some());
    let controls = asked(&mut source);
    assert!(
        matches!(&controls[..], [ControlMessage::Enable { .. }, ControlMessage::Set { .. }]),
        "{controls:?}"
    );
    assert_eq!(asked(&mut source), []);
}

#[test]
fn messages_nobody_takes_are_kept_up_to_a_thousand_and_counted_beyond() {
    let (mut source, sender) = link();
    let enable = encoder::encode(&message("/underfoot/widget/zoom/enable", vec![])).unwrap();
    for sequence in 0..30 {
        for _ in 0..40 {
            sender.send(&enable).unwrap();
        }
        sender.send(&datagram(&packet(0, sequence))).unwrap();
        assert!(source.next(SOON).unwrap().is_some());
    }
    assert_eq!(source.counters().overflowed, 1200 - 1024);
    assert_eq!(asked(&mut source).len(), 1024);
}

// P8
#[test]
fn senders_not_on_the_list_are_counted_and_not_heard() {
    let elsewhere = IpAddr::V4(Ipv4Addr::new(127, 0, 0, 9));
    for (allowed, accepted) in [(elsewhere, false), (ANY_PORT.ip(), true)] {
        let mut source = UdpSource::bind(ANY_PORT, &floor()).unwrap().allowing([allowed.into()]);
        let sender = UdpSocket::bind(ANY_PORT).unwrap();
        sender.send_to(&datagram(&packet(0, 1)), source.local_addr().unwrap()).unwrap();
        let patience = if accepted { SOON } else { Duration::from_millis(50) };
        assert_eq!(source.next(patience).unwrap().is_some(), accepted);
        assert_eq!(source.counters().foreign, u64::from(!accepted));
    }
}

#[test]
fn a_bundle_is_used_but_for_what_others_are_meant_to_read() {
    let (mut source, sender) = link();
    let (_, readings) = rosc::decoder::decode_udp(&datagram(&packet(0, 5))).unwrap();
    let timetag = OscTime { seconds: 0, fractional: 1 };
    let battery = message("/battery", vec![OscType::Float(3.7)]);
    let content = vec![battery.clone(), readings, message("/underfoot/widget/zoom/get", vec![])];
    let bundle = OscPacket::Bundle(OscBundle { timetag, content });
    for count in 1..=3 {
        sender.send(&encoder::encode(&bundle).unwrap()).unwrap();
        assert_eq!(source.next(SOON).unwrap().unwrap().sequence, 5);
        assert_eq!(asked(&mut source).len(), 1);
        let counters = source.counters();
        assert_eq!((counters.skipped, counters.refused()), (count, 0));
    }
    // Alone it is refused.
    sender.send(&encoder::encode(&battery).unwrap()).unwrap();
    let only_battery = OscPacket::Bundle(OscBundle { timetag, content: vec![battery] });
    sender.send(&encoder::encode(&only_battery).unwrap()).unwrap();
    assert!(source.next(Duration::from_millis(50)).unwrap().is_none());
    assert_eq!((source.counters().skipped, source.counters().unknown_address), (3, 2));
}

#[test]
fn readings_are_taken_from_a_bundle_whose_requests_are_not() {
    let (source, sender) = link();
    let commands = UdpSocket::bind(ANY_PORT).unwrap().local_addr().unwrap();
    let mut source = source.with_commands(commands, [ANY_PORT.ip().into()]).unwrap();
    let (_, readings) = rosc::decoder::decode_udp(&datagram(&packet(0, 5))).unwrap();
    let content = vec![message("/underfoot/widget/zoom/get", vec![]), readings];
    // In 1900 and in 2036, from a board with an unset clock.
    for seconds in [1, u32::MAX] {
        let timetag = OscTime { seconds, fractional: 0 };
        let bundle = OscPacket::Bundle(OscBundle { timetag, content: content.clone() });
        sender.send(&encoder::encode(&bundle).unwrap()).unwrap();
        assert_eq!(source.next(SOON).unwrap().unwrap().sequence, 5);
        assert_eq!(asked(&mut source), []);
    }
    assert_eq!((source.counters().foreign, source.counters().denied), (1, 1));
}

#[test]
fn the_last_refusal_of_something_from_boards_is_kept_beside_those_of_requests() {
    let (mut source, sender) = link();
    let doubles = vec![OscType::Int(1), OscType::Double(2.0), OscType::Double(3.0)];
    sender.send(&encoder::encode(&message("/underfoot/board/1", doubles)).unwrap()).unwrap();
    sender.send(&encoder::encode(&message("/underfoot/widget/zoom/fly", vec![])).unwrap()).unwrap();
    while source.counters().refused() < 2 {
        source.next(Duration::from_millis(50)).unwrap();
    }
    let expected = LinkCause::WrongReadings { board: 1, channels: 24, found: "idd".into() };
    assert_eq!(source.last_refused(), Some(expected));
    for (sent, expected) in [
        (&b"0.1,0.2,0.3,0.4\n"[..], "they look like text"),
        (&b"\xC0/underfoot/board/0\0\0,i\0\0\0\0\0\x01\xC0"[..], "SLIP"),
        (&b"\0\0\0\x08/a\0\0,\0\0\0"[..], "they begin with their length"),
    ] {
        let before = source.counters().malformed;
        sender.send(sent).unwrap();
        while source.counters().malformed == before {
            source.next(Duration::from_millis(50)).unwrap();
        }
        let said = source.last_refused().unwrap().to_string();
        assert!(said.contains(expected), "{said}");
    }
}

// P6
#[test]
fn a_flood_of_one_sender_takes_nothing_from_another() {
    let (mut source, board) = link();
    let loud = UdpSocket::bind(ANY_PORT).unwrap();
    let mut packets = 0;
    for sequence in 0..200 {
        for _ in 0..250 {
            loud.send_to(b"rubbish", source.local_addr().unwrap()).unwrap();
        }
        board.send(&datagram(&packet(0, sequence))).unwrap();
        packets += u32::from(source.next(SOON).unwrap().is_some());
    }
    assert_eq!(packets, 200);
    let counters = source.counters();
    assert!(counters.limited > 0, "{counters:?}");
    assert_eq!(counters.limited + counters.malformed, 50_000);
}

// N14
#[test]
fn a_port_in_use_is_reported_with_what_to_do() {
    let taken = UdpSocket::bind(ANY_PORT).unwrap();
    let address = taken.local_addr().unwrap();
    let Err(error) = UdpSource::bind(address, &floor()) else { panic!("bound twice") };
    let SourceError::Socket { message, .. } = &error else { panic!("{error:?}") };
    assert!(message.contains(&format!("UDP port {}", address.port())), "{message}");
    assert!(message.contains("listen on ") && !message.contains("--"), "{message}");
    if cfg!(target_os = "linux") {
        assert!(message.contains(&format!("process {}", std::process::id())), "{message}");
    }
}

#[test]
fn an_address_of_another_machine_is_reported_with_what_to_do() {
    // 192.0.2.0/24 is reserved for documentation and never belongs to a machine.
    let Err(error) = UdpSource::bind("192.0.2.1:9000".parse().unwrap(), &floor()) else { panic!("bound") };
    assert!(error.to_string().contains(": 0.0.0.0:9000 takes packets on all of them"), "{error}");
}

// P6
#[test]
fn a_flood_of_rubbish_holds_no_call_for_long_and_lets_packets_through() {
    let (mut source, sender) = link();
    let flood = std::thread::spawn(move || {
        for sequence in 0..2000 {
            for _ in 0..10 {
                // A full receive buffer makes the kernel drop packets, which is not a failure of the sender.
                let _ = sender.send(&[0xFF; 400]);
            }
            let _ = sender.send(&datagram(&packet(0, sequence)));
        }
    });
    let mut packets = 0;
    while let Some(packet) = source.next(Duration::from_millis(500)).unwrap() {
        packets += 1;
        if packet.sequence == 1999 {
            break;
        }
    }
    flood.join().unwrap();
    let counters = source.counters();
    assert!(packets > 100, "{packets}");
    assert!(counters.malformed >= packets, "{counters:?}");
}

// N13
#[cfg(target_os = "linux")]
// N13
#[test]
fn what_the_kernel_drops_while_nobody_reads_is_counted() {
    let (mut source, sender) = link();
    // Far more than the granted buffer holds; each datagram takes at least its own bytes there.
    let datagram = [0; 1024];
    let sent = 2 * source.granted_buffer() / datagram.len() + 10;
    for _ in 0..sent {
        let _ = sender.send(&datagram);
    }
    // The program queries the kernel once a second.
    let mut patience = 50;
    while source.counters().overflowed == 0 && patience > 0 {
        source.next(Duration::from_millis(100)).unwrap();
        patience -= 1;
    }
    while source.next(Duration::from_millis(1)).unwrap().is_some() {}
    let counters = source.counters();
    assert!(counters.overflowed > 0);
    assert_eq!(counters.datagrams + counters.overflowed, sent as u64);
}

#[test]
fn the_granted_buffer_is_told() {
    let (source, _sender) = link();
    assert!(source.granted_buffer() > 0);
}

/// The requests of apps, oldest first.
fn asked(source: &mut UdpSource) -> Vec<ControlMessage> {
    std::iter::from_fn(|| source.take_request()).map(|request| request.message).collect()
}
