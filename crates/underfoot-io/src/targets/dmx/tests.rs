//! Lights by real packets, received as the standards of Art-Net and E1.31 describe them.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)]

use std::io::BufReader;
use std::net::UdpSocket;
use std::os::unix::net::UnixStream;
use std::thread;
use std::time::{Duration, Instant};

use underfoot::messages::{
    Act, ArtNetTarget, Destination, DmxLevel, DmxSettings, Holdable, SacnTarget, SendTarget,
};

use super::super::guard;
use super::super::link::{FromGuardian, ToGuardian, next, put};
use super::super::outlets::Outlets;

/// A fixture that reads one universe.
struct Fixture {
    socket: UdpSocket,
    /// The number of the last packet of each source of sACN.
    last: Option<([u8; 16], u8)>,
}

/// One packet: its universe and its levels; `None` for the end of a stream.
type Received = (u16, Option<Vec<u8>>);

impl Fixture {
    fn new() -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        Self { socket, last: None }
    }

    fn address(&self) -> String {
        self.socket.local_addr().unwrap().to_string()
    }

    fn art_net(&self) -> SendTarget {
        let to = Destination::ArtNet(ArtNetTarget { address: self.address(), universe: 0x0123 });
        SendTarget { name: "lights".into(), to }
    }

    fn sacn(&self) -> SendTarget {
        let sacn = SacnTarget { universe: 258, to: Some(self.address()), via: None, priority: 120 };
        SendTarget { name: "lights".into(), to: Destination::Sacn(sacn) }
    }

    /// The next packet that a receiver does not drop.
    fn next(&mut self) -> Received {
        loop {
            let mut bytes = [0; 1024];
            let length = self.socket.recv(&mut bytes).unwrap();
            let packet = &bytes[..length];
            if packet.starts_with(b"Art-Net\0") {
                return art_dmx(packet);
            }
            let (source, number, received) = data_packet(packet);
            // E1.31, 6.7.2: a step back of less than 20 is an old packet.
            let is_old = self.last.is_some_and(|(of, last)| {
                let step = i16::from(number.wrapping_sub(last).cast_signed());
                of == source && step <= 0 && step > -20
            });
            if is_old {
                continue;
            }
            self.last = Some((source, number));
            return received;
        }
    }

    /// The levels of the next packet that has some.
    fn levels(&mut self) -> Vec<u8> {
        loop {
            if let (_, Some(levels)) = self.next() {
                return levels;
            }
        }
    }

    /// Reads until a channel from 1 on has this level.
    fn until(&mut self, channel: usize, level: u8) {
        let begun = Instant::now();
        while self.levels()[channel - 1] != level {
            assert!(begun.elapsed() < Duration::from_secs(10), "channel {channel} never has {level}");
        }
    }
}

/// Reads an ArtDmx packet by the table of *Art-Net 4*.
fn art_dmx(packet: &[u8]) -> Received {
    assert_eq!(packet[8..10], [0x00, 0x50], "the operation ArtDmx, low byte first");
    assert_eq!(packet[10..12], [0, 14], "the version of the protocol, high byte first");
    assert_eq!(packet[12], 0, "without an order");
    let universe = u16::from_le_bytes([packet[14], packet[15]]);
    let length = u16::from_be_bytes([packet[16], packet[17]]);
    assert_eq!((length, packet.len()), (512, 18 + 512));
    (universe, Some(packet[18..].to_vec()))
}

/// Reads a data packet by the tables 4-1, 6-1 and 7-1 of ANSI E1.31.
fn data_packet(packet: &[u8]) -> ([u8; 16], u8, Received) {
    assert_eq!(packet.len(), 638);
    assert_eq!(packet[..4], [0, 16, 0, 0], "sizes of preamble and postamble");
    assert_eq!(&packet[4..16], b"ASC-E1.17\0\0\0");
    let long = |at: usize| u16::from_be_bytes([packet[at], packet[at + 1]]);
    assert_eq!(
        [long(16), long(38), long(115)],
        [638 - 16, 638 - 38, 638 - 115].map(|length| 0x7000 | length)
    );
    assert_eq!(packet[18..22], [0, 0, 0, 4], "data of E1.31");
    assert_eq!(packet[40..44], [0, 0, 0, 2], "DMX");
    let name: Vec<u8> = packet[44..108].iter().copied().take_while(|byte| *byte != 0).collect();
    assert_eq!(String::from_utf8(name).unwrap(), "underfoot lights");
    assert_eq!((packet[108], long(109)), (120, 0), "priority; no synchronisation");
    assert_eq!(packet[117..123], [0x02, 0xa1, 0, 0, 0, 1], "one byte for each property from 0 on");
    assert_eq!((long(123), packet[125]), (513, 0), "start code and 512 levels");
    let levels = (packet[112] & 0x40 == 0).then(|| packet[126..].to_vec());
    (packet[22..38].try_into().unwrap(), packet[111], (long(113), levels))
}

/// A lamp that rests at 20.
const LAMP: DmxSettings = DmxSettings { channel: 12, fine: false, from: 20, to: None };

fn lamp() -> Holdable {
    Holdable::Dmx(LAMP)
}

/// The end of a server's link to a guardian, which has opened a universe with a fader at 77 and the lamp at rest.
struct GuardedLights {
    input: UnixStream,
    answers: BufReader<UnixStream>,
    guardian: thread::JoinHandle<()>,
}

impl GuardedLights {
    fn start(target: SendTarget) -> Self {
        let (input, from) = UnixStream::pair().unwrap();
        let (to, answers) = UnixStream::pair().unwrap();
        let guardian = thread::spawn(move || guard(BufReader::new(from), to).unwrap());
        let mut lights = Self { input, answers: BufReader::new(answers), guardian };
        let fader = Act::Dmx(DmxLevel { channel: 1, fine: false, level: 77 });
        lights.say(&ToGuardian::Setup(vec![target], vec![(0, lamp())], vec![(0, fader)]));
        lights.beat(1);
        lights
    }

    fn say(&mut self, message: &ToGuardian) {
        put(&mut self.input, message).unwrap();
    }

    /// Beats for 200 ms; returns whether each packet meanwhile has the fader and the lamp as they were.
    fn lives_for_a_while(&mut self, fixture: &mut Fixture) -> bool {
        for number in 2..22 {
            thread::sleep(Duration::from_millis(10));
            self.beat(number);
        }
        fixture.socket.set_nonblocking(true).unwrap();
        let mut bytes = [0; 1024];
        let (mut count, mut stays) = (0, true);
        while let Ok(length) = fixture.socket.recv(&mut bytes) {
            count += 1;
            // The levels are the last 512 bytes in both protocols.
            let levels = &bytes[length - 512..length];
            assert_eq!(levels[0], 77, "each packet has all channels");
            stays &= levels[11] == 255;
            if length == 638 {
                fixture.last = Some((bytes[22..38].try_into().unwrap(), bytes[111]));
            }
        }
        fixture.socket.set_nonblocking(false).unwrap();
        stays && count >= 3
    }

    /// The server ends, and its guardian after it.
    fn end(self) {
        self.input.shutdown(std::net::Shutdown::Both).unwrap();
        self.guardian.join().unwrap();
    }

    fn beat(&mut self, number: u64) {
        self.say(&ToGuardian::Beat(number));
        let answer = next::<FromGuardian>(&mut self.answers);
        assert!(matches!(answer, Some(FromGuardian::Beat(answered)) if answered == number), "{answer:?}");
    }
}

/// Number of attempts on a machine that may be busy: a server that is late ends holds.
const TRIES: usize = 20;

/// A foot holds the lamp of `target` while the server lives; the server falls silent, lives again, and ends.
fn a_lamp_rests_after_its_server(fixture: &mut Fixture, target: &SendTarget, universe: u16) {
    let (of, levels) = {
        let server = GuardedLights::start(target.clone());
        let first = fixture.next();
        server.end();
        first
    };
    let levels = levels.unwrap();
    assert_eq!((of, levels[0], levels[11]), (universe, 77, 20), "all channels are set together");
    let mut server = (0..TRIES)
        .find_map(|_| {
            let mut server = GuardedLights::start(target.clone());
            server.say(&ToGuardian::Act(0, Act::Down(lamp(), 127)));
            fixture.until(12, 255);
            if server.lives_for_a_while(fixture) {
                return Some(server);
            }
            server.end();
            None
        })
        .expect("it stays while the server is heard");
    fixture.until(12, 20);
    // A press after that silence is old; the next one holds again.
    server.say(&ToGuardian::Act(0, Act::Down(lamp(), 127)));
    server.beat(9000);
    server.say(&ToGuardian::Act(0, Act::Down(lamp(), 127)));
    fixture.until(12, 255);
    server.end();
    fixture.until(12, 20);
}

#[test]
fn a_lamp_of_art_net_rests_when_its_server_is_silent_or_ends() {
    let mut fixture = Fixture::new();
    let target = fixture.art_net();
    a_lamp_rests_after_its_server(&mut fixture, &target, 0x0123);
}

#[test]
fn a_lamp_of_sacn_rests_when_its_server_is_silent_or_ends() {
    let mut fixture = Fixture::new();
    let target = fixture.sacn();
    a_lamp_rests_after_its_server(&mut fixture, &target, 258);
    // The stream ends in order: three packets say so.
    let mut ends = 0;
    while ends < 3 {
        ends += usize::from(fixture.next().1.is_none());
    }
}

/// Receivers drop old numbers of a source: one that takes over is heard whatever the number of the last packet was.
#[test]
fn another_process_goes_on_with_a_stream_wherever_it_stood() {
    let mut fixture = Fixture::new();
    let target = fixture.sacn();
    let level = |level| Act::Dmx(DmxLevel { channel: 1, fine: false, level });
    let mut source = None;
    for (round, last) in (0..=255_u8).enumerate().step_by(5) {
        let mut outlets = Outlets::new(vec![target.clone()]);
        let mark = 1 + u16::try_from(round % 200).unwrap();
        assert!(outlets.carry_out(0, &level(mark), &mut |text| panic!("{text}")));
        outlets.work(&mut |text| panic!("{text}"));
        // As if the first process had sent this number last.
        fixture.last = fixture.last.map(|(of, _)| (of, last));
        assert_eq!(u16::from(fixture.levels()[0]), mark, "after {last}");
        let of = fixture.last.map(|(of, _)| of);
        assert!(source.is_none() || source == of, "each process is the same source");
        source = of;
        // The second packet of the two may count as old.
        fixture.socket.set_nonblocking(true).unwrap();
        while fixture.socket.recv(&mut [0; 1024]).is_ok() {}
        fixture.socket.set_nonblocking(false).unwrap();
    }
}

/// Receivers give up a source that is silent for 2.5 s.
#[test]
fn a_source_without_changes_stays_alive_and_repeats_its_levels() {
    let fixture = Fixture::new();
    let mut outlets = Outlets::new(vec![fixture.art_net()]);
    outlets.open();
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_millis(1800) {
        let due = outlets.work(&mut |text| panic!("{text}")).unwrap();
        thread::sleep(due);
    }
    fixture.socket.set_nonblocking(true).unwrap();
    let count = std::iter::from_fn(|| fixture.socket.recv(&mut [0; 1024]).ok()).count();
    // The first one, three that repeat it, and two signs of life.
    assert!((5..=6).contains(&count), "{count}");
}

/// Values go out no faster than a line of DMX carries them, and the last one always does.
#[test]
fn a_slide_sends_44_packets_a_second_and_ends_at_its_last_level() {
    let fixture = Fixture::new();
    let mut outlets = Outlets::new(vec![fixture.art_net()]);
    let begun = Instant::now();
    let mut refused = |text: String| panic!("{text}");
    let mut sent = 0;
    while begun.elapsed() < Duration::from_millis(500) {
        sent += 1;
        let level = DmxLevel { channel: 3, fine: true, level: sent };
        assert!(outlets.carry_out(0, &Act::Dmx(level), &mut refused));
        outlets.work(&mut refused);
        thread::sleep(Duration::from_millis(1));
    }
    while let Some(due) = outlets.work(&mut refused).filter(|due| *due < Duration::from_millis(100)) {
        thread::sleep(due);
    }
    fixture.socket.set_nonblocking(true).unwrap();
    let (mut count, mut last, mut bytes) = (0, 0, [0; 1024]);
    while let Ok(length) = fixture.socket.recv(&mut bytes) {
        let levels = art_dmx(&bytes[..length]).1.unwrap();
        (count, last) = (count + 1, u16::from_be_bytes([levels[2], levels[3]]));
    }
    let seconds = begun.elapsed().as_secs_f32();
    assert!(count as f32 <= 45.0 * seconds + 1.0, "{count} in {seconds} s");
    assert_eq!(last, sent);
}

/// A network that is not there is told once; nothing that was pressed meanwhile is pressed later.
#[test]
fn a_press_without_a_network_is_not_pressed_later() {
    let fixture = Fixture::new();
    let mut target = fixture.sacn();
    let Destination::Sacn(sacn) = &mut target.to else { panic!() };
    // Nothing leads from this computer's own address to that one.
    sacn.to = Some("10.1.2.3:1".into());
    sacn.via = Some("127.0.0.1".into());
    let mut outlets = Outlets::new(vec![target]);
    let mut notices = Vec::new();
    for _ in 0..3 {
        assert!(!outlets.carry_out(0, &Act::Down(lamp(), 127), &mut |text| notices.push(text)));
        outlets.release(0, &lamp(), &mut |_| {});
        outlets.work(&mut |text| notices.push(text));
    }
    assert_eq!(notices.len(), 1, "{notices:?}");
}
