//! A light that a foot holds goes back to its rest whatever dies, and programs of others receive its levels.

use std::collections::HashMap;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use crate::holds::client::Client;
use crate::holds::site::{Boards, Site};
use crate::targets::{NO_DESK, Observer, comes_up_soon, guardian, kill, page, twenty_rounds, until};

/// The level of the light at rest.
const REST: u8 = 20;

/// The message of the pedal.
const HOLD: &str = r#"While(pressed, Dmx("lights", (channel: 12, from: 20)))"#;

/// A light on channel 12 behind a node of Art-Net.
struct ArtNetLight {
    socket: UdpSocket,
    is_down: bool,
}

impl ArtNetLight {
    fn new() -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_nonblocking(true).unwrap();
        Self { socket, is_down: false }
    }

    /// A floor whose pedal holds the light.
    fn site(&self) -> Site {
        let target = format!("(name: \"lights\", to: ArtNet(\"{}\"))", self.socket.local_addr().unwrap());
        let site = Site::new();
        let text = page(&format!("{target}, {NO_DESK}"), HOLD);
        std::fs::write(site.folder().join("page.ron"), text).unwrap();
        site
    }
}

impl Observer for ArtNetLight {
    fn is_down(&mut self) -> bool {
        let mut packet = [0; 1024];
        while let Ok(length) = self.socket.recv(&mut packet) {
            assert!(length == 530 && packet.starts_with(b"Art-Net\0\0\x50"), "{:?}", &packet[..18]);
            // The levels follow a head of 18 bytes.
            self.is_down = match packet[18 + 11] {
                255 => true,
                REST => false,
                other => panic!("a level that nobody asked for: {other}"),
            };
        }
        self.is_down
    }
}

#[test]
fn a_light_that_is_held_rests_whatever_dies() {
    if !cfg!(feature = "dmx") {
        println!("not run: the program is built without the feature dmx");
        return;
    }
    let mut light = ArtNetLight::new();
    let site = light.site();
    comes_up_soon(&site, &mut light);
}

/// Twenty rounds of each end, the median and the longest time: for an idle machine, in a release build.
#[test]
#[ignore = "takes ten minutes; figures of a machine that is busy say nothing"]
fn twenty_rounds_of_each_end_of_a_light() {
    let mut light = ArtNetLight::new();
    let site = light.site();
    twenty_rounds(&site, &mut light);
}

/// Receivers of Art-Net and sACN, written by others.
struct OtherReceivers {
    child: Child,
    said: Receiver<String>,
    levels: HashMap<(String, u32), u8>,
    /// The levels of channel 1 in their order.
    slid: Vec<u8>,
    ports: [u16; 2],
}

impl OtherReceivers {
    /// Starts them; `None`, with the reason printed, where they are missing.
    fn start() -> Option<Self> {
        let free = || UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let ports = [free(), free()];
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/lights.py");
        let spawned = Command::new("python3")
            .arg(script)
            .args(ports.map(|port| port.to_string()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = spawned.map_err(|error| println!("not run: there is no python3: {error}")).ok()?;
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map_while(Result::ok);
        if lines.next().as_deref() != Some("ready") {
            println!("not run: a library for Python is missing: {:?}", child.wait());
            return None;
        }
        let (tell, said) = channel();
        thread::spawn(move || lines.map(|line| tell.send(line)).take_while(Result::is_ok).for_each(drop));
        Some(Self { child, said, levels: HashMap::new(), slid: Vec::new(), ports })
    }

    /// Waits until both have this level in this channel.
    fn until(&mut self, what: &str, channel: u32, is: impl Fn(u8) -> bool) {
        until(what, || {
            for line in self.said.try_iter() {
                let [protocol, channel, level] = line.split(' ').collect::<Vec<_>>()[..] else {
                    panic!("{line}")
                };
                let (channel, level) = (channel.parse().unwrap(), level.parse().unwrap());
                self.slid.extend((channel == 1).then_some(level));
                self.levels.insert((protocol.to_owned(), channel), level);
            }
            let has =
                |protocol: &str| self.levels.get(&(protocol.to_owned(), channel)).copied().is_some_and(&is);
            has("art-net") && has("sacn")
        });
    }
}

impl Drop for OtherReceivers {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// `./dev test` prints beforehand whether this test will run: `pip install sacn stupidArtnet`.
#[test]
fn receivers_of_others_see_a_foot_hold_a_light_and_slide_another() {
    if !cfg!(feature = "dmx") {
        println!("not run: the program is built without the feature dmx");
        return;
    }
    let Some(mut others) = OtherReceivers::start() else { return };
    let [art_net, sacn] = others.ports;
    let text = format!(
        r#"Layout(
    version: 4,
    targets: [
        (name: "stage", to: ArtNet("127.0.0.1:{art_net}", (universe: 1))),
        (name: "hall", to: Sacn((universe: 1, to: "127.0.0.1:{sacn}"))),
    ],
    regions: [(id: "left", at: (0, 0), size: (1, 2)), (id: "right", at: (1, 0), size: (2, 2))],
    widgets: [
        (id: "drive", kind: "dead_man", at: (0, 0), size: (0.9, 0.9),
         send: [While(pressed, Dmx("stage", (channel: 12, from: 20))), While(pressed, Dmx("hall", (channel: 12, from: 20)))]),
        (id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9), press_n: 60, release_n: 40,
         send: [Value(Dmx("stage", (channel: 1))), Value(Dmx("hall", (channel: 1)))]),
    ],
)"#
    );
    let site = Site::new();
    std::fs::write(site.folder().join("page.ron"), text).unwrap();
    let client = Client::new();
    let run = site.run(&client, &[]);
    others.until("both rest", 12, |level| level == REST);
    let boards = Boards::start(&site, run.address);
    others.until("both are held", 12, |level| level == 255);
    others.until("both follow the slider", 1, |level| level > 100);
    others.slid.clear();
    kill(guardian(&run), "KILL");
    others.until("both rest again", 12, |level| level == REST);
    // The next guardian has the slider's level too: no light flickers.
    thread::sleep(Duration::from_millis(1500));
    others.until("both still follow the slider", 1, |level| level > 100);
    assert!(others.slid.iter().all(|level| *level > 100), "{:?}", others.slid);
    drop(boards);
    drop(run);
}
