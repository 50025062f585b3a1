//! OSC over real sockets, and a guardian after its server has fallen silent or ended.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::io::{BufReader, Read};
use std::net::{TcpListener, UdpSocket};
use std::os::unix::net::UnixStream;
use std::thread;
use std::time::{Duration, Instant};

use rosc::{OscPacket, OscType, decoder};
use underfoot::messages::{
    Act, Destination, Holdable, KeyboardTarget, OscTarget, OscTransport, OscValue, SendTarget,
};

use super::link::{FromGuardian, ToGuardian, next, put};
use super::outlets::Outlets;
use super::{PATIENCE, guard, redirect};

fn desk(address: String, over: OscTransport) -> SendTarget {
    SendTarget { name: "desk".into(), to: Destination::Osc(OscTarget { address, over }) }
}

fn read(packet: &[u8]) -> String {
    let (_, packet) = decoder::decode_udp(packet).unwrap();
    let OscPacket::Message(message) = packet else { panic!("a bundle") };
    let arguments = message.args.iter().map(|argument| match argument {
        OscType::Int(number) => number.to_string(),
        OscType::Float(number) => format!("{number:?}"),
        OscType::String(text) => format!("{text:?}"),
        other => panic!("{other:?}"),
    });
    [message.addr.clone()].into_iter().chain(arguments).collect::<Vec<_>>().join(" ")
}

fn pan() -> Act {
    Act::Osc("/pan".into(), vec![OscValue::Int(3), OscValue::Float(0.5), OscValue::Text("go".into())])
}

#[test]
fn osc_arrives_over_udp_with_its_types() {
    let receiver = UdpSocket::bind("127.0.0.1:0").unwrap();
    receiver.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    let address = receiver.local_addr().unwrap().to_string();
    let mut outlets = Outlets::new(vec![desk(address, OscTransport::Udp)]);
    let mut notices = Vec::new();
    assert!(outlets.carry_out(0, &pan(), &mut |text| notices.push(text)), "{notices:?}");
    let mut bytes = [0; 256];
    let length = receiver.recv(&mut bytes).unwrap();
    assert_eq!(read(&bytes[..length]), "/pan 3 0.5 \"go\"");
    // It has no keys, and says so once.
    let key = Act::Stroke(Holdable::Key("a".parse().unwrap()));
    for _ in 0..3 {
        assert!(!outlets.carry_out(0, &key, &mut |text| notices.push(text)));
    }
    assert_eq!(notices, ["target desk: a receiver of OSC has neither keys nor a pointer"]);
}

#[test]
fn osc_arrives_over_tcp_in_slip_frames_and_nothing_waits_for_a_receiver_that_is_gone() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let mut outlets = Outlets::new(vec![desk(address, OscTransport::Tcp)]);
    let mut notices = Vec::new();
    // While the connection is made, messages are lost and counted.
    let begun = Instant::now();
    while !outlets.carry_out(0, &pan(), &mut |text| notices.push(text)) {
        assert!(begun.elapsed() < Duration::from_secs(10), "{notices:?}");
        thread::sleep(Duration::from_millis(5));
    }
    let (mut stream, _) = listener.accept().unwrap();
    let mut frame = [0; 256];
    let length = stream.read(&mut frame).unwrap();
    let packet = frame[..length].strip_prefix(&[0xc0]).and_then(|rest| rest.strip_suffix(&[0xc0]));
    assert_eq!(read(packet.unwrap()), "/pan 3 0.5 \"go\"", "one frame: the earlier ones did not wait");
    drop((stream, listener));
    let begun = Instant::now();
    while outlets.carry_out(0, &pan(), &mut |text| notices.push(text)) {
        assert!(begun.elapsed() < Duration::from_secs(10), "it notices that the receiver is gone");
        thread::sleep(Duration::from_millis(5));
    }
}

/// A server's end of a link to a guardian, and the receiver of its messages.
struct GuardedServer {
    input: UnixStream,
    answers: BufReader<UnixStream>,
    receiver: UdpSocket,
    guardian: Option<thread::JoinHandle<()>>,
}

impl GuardedServer {
    fn start() -> Self {
        let receiver = UdpSocket::bind("127.0.0.1:0").unwrap();
        receiver.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let (input, from) = UnixStream::pair().unwrap();
        let (to, answers) = UnixStream::pair().unwrap();
        let guardian = thread::spawn(move || guard(BufReader::new(from), to).unwrap());
        let mut server = Self { input, answers: BufReader::new(answers), receiver, guardian: Some(guardian) };
        let address = server.receiver.local_addr().unwrap().to_string();
        let drive = (0, Holdable::Osc("/drive".into()));
        server.say(&ToGuardian::Setup(vec![desk(address, OscTransport::Udp)], vec![drive], vec![]));
        assert_eq!(server.heard(), "/drive 0", "before the first message all is released");
        server.beat(1);
        server
    }

    fn say(&mut self, message: &ToGuardian) {
        put(&mut self.input, message).unwrap();
    }

    fn beat(&mut self, number: u64) {
        self.say(&ToGuardian::Beat(number));
        let answer = next::<FromGuardian>(&mut self.answers);
        assert!(matches!(answer, Some(FromGuardian::Beat(answered)) if answered == number), "{answer:?}");
    }

    fn heard(&self) -> String {
        let mut bytes = [0; 256];
        let length = self.receiver.recv(&mut bytes).unwrap();
        read(&bytes[..length])
    }

    fn press(&mut self) {
        self.say(&ToGuardian::Act(0, Act::Down(Holdable::Osc("/drive".into()), 127)));
        assert_eq!(self.heard(), "/drive 1");
    }
}

#[test]
fn a_hold_lasts_while_its_server_is_heard_and_no_longer() {
    let mut server = GuardedServer::start();
    server.press();
    for number in 2..30 {
        thread::sleep(Duration::from_millis(10));
        server.beat(number);
    }
    server.receiver.set_nonblocking(true).unwrap();
    assert!(server.receiver.recv(&mut [0; 64]).is_err(), "still down after 280 ms");
    server.receiver.set_nonblocking(false).unwrap();
    let silent = Instant::now();
    assert_eq!(server.heard(), "/drive 0");
    assert!(silent.elapsed() >= PATIENCE / 2, "{:?}", silent.elapsed());
    // A press from a server that was silent is old.
    server.say(&ToGuardian::Act(0, Act::Down(Holdable::Osc("/drive".into()), 127)));
    server.beat(30);
    assert!(matches!(next(&mut server.answers), Some(FromGuardian::Undone(1))));
    server.press();
}

#[test]
fn a_server_that_ends_lets_everything_come_up_and_the_guardian_ends() {
    let mut server = GuardedServer::start();
    server.press();
    server.input.shutdown(std::net::Shutdown::Both).unwrap();
    assert_eq!(server.heard(), "/drive 0");
    server.guardian.take().unwrap().join().unwrap();
}

#[test]
fn the_command_line_moves_a_target_to_where_it_fits() {
    let keyboard = Destination::Keyboard(KeyboardTarget { window: None, display: None });
    let viewer = SendTarget { name: "viewer".into(), to: keyboard };
    let mut targets = vec![desk("127.0.0.1:1".into(), OscTransport::Udp), viewer];
    redirect(&mut targets, "desk", "tcp:10.0.0.5:53000").unwrap();
    redirect(&mut targets, "viewer", ":1").unwrap();
    assert_eq!(targets[0], desk("10.0.0.5:53000".into(), OscTransport::Tcp));
    assert!(matches!(&targets[1].to, Destination::Keyboard(it) if it.display.as_deref() == Some(":1")));
    for (name, place) in [("desk", "nowhere"), ("viewer", "10.0.0.5"), ("desc", "10.0.0.5:53000")] {
        assert!(redirect(&mut targets, name, place).is_err(), "{name}={place}");
    }
}
