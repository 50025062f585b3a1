//! Wrappers of inputs: requests of apps get through each of them, and a recording contains them.

use std::net::UdpSocket;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket, OscType, encoder};

use crate::sender::ANY_PORT;
use crate::support::layout;
use underfoot::floor::Floor;
use underfoot::mirror::MirrorFeed;
use underfoot::recording::{Recorder, Recording, Speed, WhenBehind};
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::source::{FaultInjector, FloorInput, Incoming, LinkFaults, TappedPackets, UdpSource};
use underfoot::wire::{ControlMessage, Request};

type Wrap = Box<dyn Fn(FloorInput) -> FloorInput>;

/// Every wrapper of the library, by name; the recording is `file`.
fn wrappers(file: &Path) -> Vec<(&'static str, Wrap)> {
    let geometry = Floor::default().geometry;
    let (tap, packets) = TappedPackets::new();
    packets.want(true);
    let feed = MirrorFeed::start(Arc::new(AtomicUsize::new(1)), drop).unwrap();
    let file = file.to_owned();
    vec![
        ("nothing", Box::new(|input| input)),
        (
            "faults",
            Box::new(|mut input| {
                let faults = LinkFaults { loss: 1.0, ..LinkFaults::default() };
                input.source = Box::new(FaultInjector::new(input.source, faults, 1));
                input
            }),
        ),
        (
            "copied packets",
            Box::new(move |input| {
                packets.take(|_| {});
                tap.wrap(input)
            }),
        ),
        ("joined windows", Box::new(move |input| feed.wrap(input, geometry))),
        ("a recording", Box::new(move |input| recorded(&file, input))),
    ]
}

fn recorded(file: &Path, input: FloorInput) -> FloorInput {
    let (floor, method, behind) = (Floor::default(), Method::default(), WhenBehind::Wait);
    Recorder::around(Some(file), input, floor, layout("map"), method, behind).unwrap().input
}

/// Whether an app that sets a control and asks for it gets an answer, on a floor whose input is wrapped.
fn is_answered(wrap: impl Fn(FloorInput) -> FloorInput) -> bool {
    let floor = Floor::default();
    let source = UdpSource::bind(ANY_PORT, &floor).unwrap();
    let app = UdpSocket::bind(ANY_PORT).unwrap();
    app.connect(source.local_addr().unwrap()).unwrap();
    app.set_nonblocking(true).unwrap();
    let mut server = Server::new(&floor, layout("map"), Method::default(), wrap(source.into()));
    for (path, args) in [("set", vec![OscType::Float(90.0)]), ("get", vec![])] {
        let message = OscMessage { addr: format!("/underfoot/widget/zoom/{path}"), args };
        app.send(&encoder::encode(&OscPacket::Message(message)).unwrap()).unwrap();
    }
    let end = Instant::now() + Duration::from_secs(10);
    while Instant::now() < end {
        server.turn().unwrap();
        if app.recv(&mut [0; 2048]).is_ok() {
            return true;
        }
    }
    false
}

#[test]
fn requests_get_through_every_wrapper_and_through_all_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let wrappers = wrappers(&folder.path().join("visit.mcap"));
    for (name, wrap) in &wrappers {
        assert!(is_answered(wrap), "{name}");
    }
    assert!(is_answered(|input| wrappers.iter().fold(input, |input, (_, wrap)| wrap(input))));
}

#[test]
fn a_recording_repeats_the_requests_of_apps_without_their_senders() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("visit.mcap");
    assert!(is_answered(|input| recorded(&file, input)));
    let mut input = FloorInput::from(Recording::open(&file).unwrap().source(Speed::Max));
    let mut replay = input.replay.take().unwrap();
    let mut requests = Vec::new();
    loop {
        while let Some(incoming) = replay.take() {
            let Incoming::Request(request) = incoming else { panic!("{incoming:?}") };
            requests.push(request);
        }
        if input.source.next(Duration::ZERO).is_err() {
            break;
        }
    }
    let [Request { message: ControlMessage::Set { .. }, sender: None }, get] = &requests[..] else {
        panic!("{requests:?}")
    };
    assert!(matches!(get, Request { message: ControlMessage::Get { .. }, sender: None }), "{get:?}");
}
