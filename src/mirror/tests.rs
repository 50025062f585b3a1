//! Tests of frames, the source, greetings and the follower.

use std::time::Duration;

use arrayvec::ArrayVec;
use proptest::prelude::*;
use serde_json::{Value, json};

use super::frame::{self, BadFrame};
use super::{Follower, Greeting, MirrorError, MirrorSource, PolledMirror};
use crate::engine::{Engine, Snapshot};
use crate::floor::Floor;
use crate::layout::Layout;
use crate::outgoing::json::{Head, Line, Message};
use crate::schema::{Kinds, builtin_layout, parse_layout};
use crate::sense::Method;
use crate::source::log::{Entries, LogEntry, decoder};
use crate::source::{FloorInput, Incoming, Replay};
use crate::units::{Instant, Newtons};
use crate::wire::{ControlMessage, Readings, Request, SensorPacket, read_json};

fn layout(name: &str) -> Layout {
    let text = builtin_layout(name).unwrap();
    parse_layout(text, name, &Kinds::builtin(), &Floor::default().geometry).unwrap().layout
}

fn engine(layout: &Layout) -> Engine {
    Engine::new(Floor::default().geometry, layout.clone(), Method::Tracker)
}

fn seen(engine: &Engine) -> Snapshot {
    let mut snapshot = Snapshot::default();
    engine.snapshot(&mut snapshot);
    snapshot
}

fn greeting_of(engine: &Engine, layout: &Layout) -> Greeting {
    let line = Greeting::line(&Floor::default(), layout, &seen(engine), Method::Tracker, true);
    Greeting::read(&line).unwrap()
}

fn packet(board: u16, sequence: u32, received_us: u64) -> SensorPacket {
    let counts: ArrayVec<_, 64> = (0..24).map(|n| (n % 5 > 0).then_some(n * 1000)).collect();
    let received = Instant::from_micros(received_us);
    SensorPacket { board, sequence, received, readings: Readings::Counts(counts) }
}

fn everything() -> Entries {
    let at = Instant::from_micros;
    let request = read_json("widget/zoom/set", &[json!(0.5)]).unwrap();
    vec![
        (at(9_000_100), LogEntry::Packet(packet(2, u32::MAX, 9_000_040))),
        (at(9_000_100), LogEntry::Request(Request { message: request, sender: None })),
        (at(9_002_000), LogEntry::Silence),
        (at(9_002_500), LogEntry::Layout("Layout()".into())),
        (at(9_003_000), LogEntry::Gap(7)),
        // The system's stamp is later than the time at which the server took it.
        (at(9_003_500), LogEntry::Packet(packet(0, 0, 9_003_600))),
        (at(9_004_000), LogEntry::End),
    ]
}

fn framed(entries: &Entries) -> Vec<u8> {
    let mut bytes = Vec::new();
    frame::write(entries, &mut bytes);
    bytes
}

#[test]
fn a_frame_gives_the_same_entries_with_the_same_times() {
    assert_eq!(frame::read(&framed(&everything()), &decoder()), Ok(everything()));
    assert_eq!(frame::read(&framed(&Entries::new()), &decoder()), Ok(Entries::new()));
}

#[test]
fn frames_that_are_cut_or_of_another_version_are_refused_whole() {
    let whole = framed(&everything());
    let one = framed(&everything()[..1].to_vec()).len();
    for length in 0..whole.len() {
        // A cut between two entries is not detectable.
        let is_between = frame::read(&whole[..length], &decoder()).is_ok_and(|read| read.len() < 7);
        assert!(is_between || frame::read(&whole[..length], &decoder()) == Err(BadFrame), "{length}");
        assert!(!(10..one).contains(&length) || !is_between, "{length}");
    }
    let mut other = whole;
    other[0] += 1;
    assert_eq!(frame::read(&other, &decoder()), Err(BadFrame));
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic_and_what_makes_no_sense_is_counted(
        bytes in prop::collection::vec(0_u8.., 0..300),
        flips in prop::collection::vec((0_usize..600, 1_u8..), 0..4),
        cut in 0_usize..600,
    ) {
        let engine = engine(&layout("map"));
        let (input, source) = MirrorSource::new(&greeting_of(&engine, &layout("map")));
        let mut damaged = framed(&everything());
        for (at, bits) in flips {
            let length = damaged.len();
            damaged[at % length] ^= bits;
        }
        damaged.truncate(cut);
        let refused = [bytes, damaged].iter().filter(|frame| input.put(frame).is_err()).count();
        prop_assert_eq!(source.counters().malformed, refused as u64);
    }
}

#[test]
fn the_source_gives_what_the_server_took_in_its_order() {
    let layout = layout("map");
    let (input, mut source) = MirrorSource::new(&greeting_of(&engine(&layout), &layout));
    let left_out = source.left_out();
    input.put(&framed(&everything())).unwrap();
    let patience = Duration::from_millis(1);
    assert_eq!(source.next(patience), Some(packet(2, u32::MAX, 9_000_040)));
    assert_eq!(source.now(), Instant::from_micros(9_000_100));
    let Some(Incoming::Request(request)) = source.take() else { panic!("first comes a request") };
    assert!(matches!(request.message, ControlMessage::Set { .. }));
    assert_eq!(source.next(patience), None, "silence");
    assert!(source.take().is_none(), "the layout can't be read");
    assert_eq!(source.next(patience), Some(packet(0, 0, 9_003_600)));
    assert_eq!((left_out(), source.now()), (7, Instant::from_micros(9_003_500)));
    assert_eq!(source.next(patience), None, "the end there is silence here: a server may come back");
}

#[test]
fn a_frame_that_is_a_little_late_does_not_let_time_pass_and_silence_does() {
    let layout = layout("map");
    let (input, mut source) = MirrorSource::new(&greeting_of(&engine(&layout), &layout));
    input.put(&framed(&vec![(Instant::from_millis(5000), LogEntry::Silence)])).unwrap();
    assert_eq!(source.next(Duration::ZERO), None);
    assert_eq!(source.next(Duration::ZERO), None);
    // Time starts to advance only after the frame is late, on a machine of any speed.
    let begun = std::time::Instant::now();
    while source.now() == Instant::from_millis(5000) {
        assert_eq!(source.next(Duration::from_millis(1)), None);
        assert!(begun.elapsed() < Duration::from_secs(60));
    }
    assert!(source.now() > Instant::from_millis(5040), "{:?}", source.now());
    let before = source.now();
    input.put(&framed(&vec![(Instant::from_millis(5004), LogEntry::Silence)])).unwrap();
    assert_eq!(source.next(Duration::from_millis(1)), None);
    assert!(source.now() >= before, "it never goes back");
}

#[test]
fn a_layout_is_taken_once_however_often_the_server_says_it() {
    let (map, other) = (layout("map"), layout("surgical"));
    let greeting = greeting_of(&engine(&map), &map);
    let (input, mut source) = MirrorSource::new(&greeting);
    let taken = |text: &str, source: &mut MirrorSource| {
        input.put_layout(text.into());
        let _ = source.next(Duration::from_millis(1));
        match source.take()? {
            Incoming::Layout(layout) => Some(layout.title),
            Incoming::Request(request) => panic!("{request:?}"),
        }
    };
    assert_eq!(taken(&greeting.layout_text, &mut source), None);
    let text = crate::schema::write_layout(&other);
    assert_eq!(taken(&text, &mut source), Some(other.title));
    assert_eq!(taken(&text, &mut source), None);
    assert_eq!(taken(&greeting.layout_text, &mut source), Some(map.title));
}

#[test]
fn a_greeting_says_the_floor_as_it_is_and_how_its_controls_are() {
    let layout = layout("map");
    let mut engine = engine(&layout);
    engine.set_enabled("home", false).unwrap();
    let mut floor = Floor::default();
    floor.tare[7][2] = Newtons(3.5);
    let line = Greeting::line(&floor, &layout, &seen(&engine), Method::Eq4, false);
    let is_greeting = |text: &str| Greeting::is_in(&Head::read(text.as_bytes()).unwrap());
    assert!(is_greeting(&line) && !is_greeting(r#"{"event": "floor"}"#));
    let read = Greeting::read(&line).unwrap();
    assert_eq!((read.floor, read.method, read.takes_layouts), (floor, Method::Eq4, false));
    assert_eq!(read.layout.widgets.len(), layout.widgets.len());
    let home = read.controls.iter().find(|control| control.id == "home").unwrap();
    assert_eq!(home.enabled, Some(false));

    let with = |field: &str, value: Value| {
        let mut other: Value = serde_json::from_str(&line).unwrap();
        other[field] = value;
        Greeting::read(&other.to_string())
    };
    assert!(matches!(with("version", json!(2)), Err(MirrorError::Version(2))));
    assert!(matches!(with("layout", json!("Layout(")), Err(MirrorError::Diagnostics(_))));
    assert!(matches!(Greeting::read(r#"{"event": "mirror"}"#), Err(MirrorError::Greeting(_))));
}

fn said(line: &str) -> Message {
    Line::read(line.as_bytes()).unwrap().message
}

#[test]
fn nothing_is_kept_of_controls_and_pages_that_the_layout_lacks() {
    let layout = layout("map");
    let mut follower = Follower::default();
    follower.begin(&greeting_of(&engine(&layout), &layout), Duration::ZERO);
    for number in 0..1000 {
        let line = format!(r#"{{"event":"state","id":"c{number}","value":1,"page":"p{number}"}}"#);
        follower.hear(&said(&line), Duration::ZERO);
        follower.hear(&said(&format!(r#"{{"event":"page","page":"p{number}"}}"#)), Duration::ZERO);
    }
    assert!(follower.kept() <= layout.widgets.len(), "{}", follower.kept());
}

#[test]
fn a_frame_of_more_entries_than_boards_send_is_refused() {
    let silence = (Instant::from_millis(1), LogEntry::Silence);
    let frame = |count: usize| frame::read(&framed(&vec![silence.clone(); count]), &decoder());
    assert!(frame(8192).is_ok());
    assert_eq!(frame(8193), Err(BadFrame));
}

/// The bytes of waiting frames are limited; a sender with more blocks until there is room or the source is gone.
#[test]
fn frames_beyond_what_may_wait_are_held_up() {
    let layout = layout("map");
    let (input, mut source) = MirrorSource::new(&greeting_of(&engine(&layout), &layout));
    let text = "x".repeat(8 << 20);
    let large = framed(&vec![(Instant::from_millis(1), LogEntry::Layout(text))]);
    let taken = std::sync::Arc::new(std::sync::atomic::AtomicUsize::new(0));
    let count = std::sync::Arc::clone(&taken);
    let sender = std::thread::spawn(move || {
        for _ in 0..20 {
            input.put(&large).unwrap();
            count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        }
    });
    let waiting = || taken.load(std::sync::atomic::Ordering::Relaxed);
    let end = std::time::Instant::now() + Duration::from_secs(20);
    while waiting() < 7 {
        assert!(std::time::Instant::now() < end, "{} were taken", waiting());
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(100));
    assert!(waiting() <= 8, "64 MiB may wait, not {} times 8", waiting());
    source.next(Duration::from_millis(1));
    while waiting() < 8 {
        assert!(std::time::Instant::now() < end, "{} were taken", waiting());
        std::thread::sleep(Duration::from_millis(5));
    }
    drop(source);
    sender.join().unwrap();
}

/// Executes the requests of `follower`, as a server does.
fn follow(follower: &mut Follower, engine: &mut Engine, layout: &Layout, now_ms: u64) -> usize {
    let asked = follower.corrections(layout, &seen(engine), Duration::from_millis(now_ms));
    for message in &asked {
        match message {
            ControlMessage::Set { id, value } => engine.set_value(id.as_str(), *value).unwrap(),
            ControlMessage::Enable { id } => engine.set_enabled(id.as_str(), true).unwrap(),
            ControlMessage::Disable { id } => engine.set_enabled(id.as_str(), false).unwrap(),
            ControlMessage::Label { id, text } => engine.set_label(id.as_str(), text).unwrap(),
            ControlMessage::SetRange { id, least, greatest } => {
                engine.set_range(id.as_str(), *least, *greatest).unwrap();
            }
            other => panic!("{other:?}"),
        }
    }
    asked.len()
}

#[test]
fn controls_become_what_the_server_says_and_then_nothing_more_is_asked() {
    let layout = layout("map");
    let mut there = engine(&layout);
    there.set_range("zoom", 0.0, 2.0).unwrap();
    there.set_value("zoom", crate::widget::Value::Number(1.75)).unwrap();
    there.set_value("satellite", crate::widget::Value::Switch(true)).unwrap();
    there.set_enabled("home", false).unwrap();
    there.set_label("home", "Away").unwrap();
    let mut here = engine(&layout);
    let mut follower = Follower::default();
    follower.begin(&greeting_of(&there, &layout), Duration::ZERO);
    assert_eq!(follow(&mut follower, &mut here, &layout, 1), 5);
    for id in ["zoom", "satellite", "home"] {
        assert_eq!(here.control_state(id), there.control_state(id));
    }
    assert_eq!(follow(&mut follower, &mut here, &layout, 1000), 0);

    // The follower requests a change that this side has not sensed after a delay, and never one that both sides
    // sense.
    let changed = said(r#"{"event": "changed", "id": "zoom", "value": 0.5}"#);
    follower.hear(&changed, Duration::from_millis(2000));
    assert_eq!(follow(&mut follower, &mut here, &layout, 2100), 0);
    assert_eq!(follow(&mut follower, &mut here, &layout, 2300), 1);
    assert_eq!(here.value("zoom"), Some(crate::widget::Value::Number(0.5)));
}

#[test]
fn what_is_refused_is_not_asked_for_ever() {
    let layout = layout("map");
    let mut follower = Follower::default();
    follower.begin(&greeting_of(&engine(&layout), &layout), Duration::ZERO);
    follower.hear(&said(r#"{"event": "changed", "id": "zoom", "value": 99.0}"#), Duration::ZERO);
    let here = seen(&engine(&layout));
    let asked = (0..100).map(|tenth| Duration::from_millis(100 * tenth));
    let count: usize = asked.map(|now| follower.corrections(&layout, &here, now).len()).sum();
    assert_eq!(count, 3);
}

#[test]
fn a_page_takes_the_same_entries_and_notices_silence_by_its_own_clock() {
    let layout = layout("map");
    let ms = Duration::from_millis;
    let greeting = greeting_of(&engine(&layout), &layout);
    let (mirror, mut input) = PolledMirror::new(&greeting, ms(100));
    assert!(!mirror.has_more());
    mirror.put(&framed(&everything()), ms(110)).unwrap();
    assert_eq!(mirror.put(b"\x01 nonsense", ms(110)), Err(BadFrame));
    let next = |input: &mut FloorInput| input.source.next(ms(5)).unwrap();
    assert_eq!(next(&mut input), Some(packet(2, u32::MAX, 9_000_040)));
    assert_eq!(next(&mut input), None, "a request comes first");
    let Some(Incoming::Request(_)) = input.replay.as_mut().unwrap().take() else { panic!("a request") };
    assert_eq!(next(&mut input), None, "silence");
    assert!(input.replay.as_mut().unwrap().take().is_none(), "the layout can't be read");
    assert_eq!(next(&mut input), Some(packet(0, 0, 9_003_600)));
    assert!(mirror.has_more(), "the end");
    assert_eq!((next(&mut input), mirror.has_more(), mirror.left_out()), (None, false, 7));
    assert_eq!(input.source.counters().malformed, 1);

    let end = Instant::from_millis(9004);
    assert_eq!((mirror.arrived(), input.source.now()), (end, end));
    mirror.pass(ms(150));
    assert_eq!(mirror.now(), end, "a frame may be a little late");
    mirror.pass(ms(250));
    assert_eq!(mirror.now(), end + ms(140));
    mirror.end(ms(250));
    assert_eq!(mirror.now(), end + ms(1000), "all boards are lost at once");
    mirror.put(&framed(&vec![(end + ms(4), LogEntry::Silence)]), ms(260)).unwrap();
    assert_eq!(next(&mut input), None);
    assert_eq!(mirror.now(), end + ms(1000), "it never goes back");
}
