//! Lines as a program reads them, also one that stops reading.

use std::sync::mpsc::{Sender, channel};

use glam::Vec2;

use super::*;
use crate::engine::ControlState;
use crate::feel::{DeviceStatus, Muted};
use crate::floor::SensorId;
use crate::sense::{Contact, ContactId, SensorHealth, Trouble};
use crate::sink::HeldReport;
use crate::units::Newtons;
use crate::widget::{Direction, Value, WidgetEvent, WidgetId};

/// A writer that sends the flushed text to its other end.
struct Pipe {
    pending: Vec<u8>,
    flushed: Sender<String>,
}

impl Write for Pipe {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.pending.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let text = String::from_utf8(std::mem::take(&mut self.pending)).unwrap();
        self.flushed.send(text).map_err(|_| io::ErrorKind::BrokenPipe.into())
    }
}

fn event(kind: EventKind, contact: Option<ContactId>) -> WidgetEvent {
    WidgetEvent {
        at: Instant::from_micros(1_234_001),
        id: WidgetId::new("say \"hi\""),
        kind,
        contact,
        force: Newtons(120.5),
        position: Vec2::new(0.61, 1.2),
    }
}

fn tell(sink: &mut JsonSink, events: &[WidgetEvent]) {
    events.iter().for_each(|event| sink.report(&Report::Event(Cow::Borrowed(event))));
}

#[test]
fn what_is_held_is_a_line_with_a_number_and_so_is_that_nothing_is() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    let (at, drive) = (Instant::from_millis(9900), WidgetId::new("drive"));
    let held = HeldReport { at, held: vec![drive.clone()], sequence: 4, ..HeldReport::default() };
    let ended = HeldReport { at, ended: vec![drive], sequence: 5, ..HeldReport::default() };
    [held, ended].into_iter().for_each(|report| sink.report(&Report::Held(Cow::Owned(report))));
    drop(sink);
    let text: String = lines.iter().collect();
    let expected = [r#"{"t_s":9.9,"held":["drive"],"sequence":4}"#, r#"{"t_s":9.9,"held":[],"sequence":5}"#];
    assert_eq!(text.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn each_event_is_a_line_of_its_own_written_before_the_end() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    let changed = |value| event(EventKind::Changed(value), Some(ContactId(3)));
    tell(&mut sink, &[changed(Value::Number(0.5)), changed(Value::Switch(true))]);
    let swiped = EventKind::Swiped(Direction::North);
    tell(&mut sink, &[changed(Value::Pair(Vec2::new(0.5, -1.0))), event(swiped, Some(ContactId(3)))]);
    tell(&mut sink, &[event(EventKind::Cancelled, None)]);
    // Contacts are off by default.
    sink.report(&Report::Contacts(Instant::START, Cow::Borrowed(&[Contact::default()])));
    sink.report(&Report::Link(Instant::from_millis(9876), LinkState::Lost));
    let sensor = SensorId { tile: crate::floor::TileId::new(2, 1), corner: crate::floor::Corner::SouthWest };
    let troubles = vec![(sensor, Trouble::Stuck)];
    let sick = SensorHealth { counts: [143, 0, 0, 1], troubles, ..SensorHealth::default() };
    sink.report(&Report::Health(Instant::from_millis(9900), Cow::Borrowed(&sick)));
    drop(sink);
    let text: String = lines.iter().collect();
    let rest = r#""force_n":120.5,"x_m":0.61,"y_m":1.2,"contact""#;
    let expected = [
        format!(r#"{{"t_s":1.234001,"event":"changed","id":"say \"hi\"","value":0.5,{rest}:3}}"#),
        format!(r#"{{"t_s":1.234001,"event":"changed","id":"say \"hi\"","value":true,{rest}:3}}"#),
        format!(r#"{{"t_s":1.234001,"event":"changed","id":"say \"hi\"","value":[0.5,-1.0],{rest}:3}}"#),
        format!(r#"{{"t_s":1.234001,"event":"swiped","id":"say \"hi\"","value":"north",{rest}:3}}"#),
        format!(r#"{{"t_s":1.234001,"event":"cancelled","id":"say \"hi\"","value":null,{rest}:null}}"#),
        r#"{"t_s":9.876,"event":"link","state":"lost"}"#.into(),
        r#"{"t_s":9.9,"event":"health","live":143,"degraded":0,"stale":0,"faulty":1,"uncalibrated":0,"foreign":false,"troubles":[{"col":2,"row":1,"corner":"sw","trouble":"stuck"}]}"#.into(),
    ];
    assert_eq!(text.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn lines_are_flushed_without_waiting_for_more() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    tell(&mut sink, &[event(EventKind::Pressed, None)]);
    let line = lines.recv_timeout(std::time::Duration::from_secs(5)).unwrap();
    assert!(line.contains("pressed") && line.ends_with('\n'));
    drop(sink);
}

#[test]
fn a_reader_that_went_away_is_counted_and_harms_nobody() {
    let (flushed, lines) = channel();
    drop(lines);
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    while sink.dropped() == 0 {
        tell(&mut sink, &[event(EventKind::Pressed, None)]);
        std::thread::yield_now();
    }
}

#[test]
fn what_is_muted_is_told_by_column_and_row() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    let muted = Muted { all: true, tiles: vec![crate::floor::TileId::new(2, 1)] };
    sink.report(&Report::Muted(Instant::from_millis(9900), Cow::Borrowed(&muted)));
    drop(sink);
    let line: String = lines.iter().collect();
    assert_eq!(line.trim_end(), r#"{"t_s":9.9,"event":"mute","all":true,"tiles":[[2,1]]}"#);
}

#[test]
fn a_device_that_is_lost_says_why() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    let state = crate::feel::DeviceState::Lost;
    let why = "unplugged".into();
    let status = DeviceStatus { name: "Card".into(), state, why, channels: 36, ..DeviceStatus::default() };
    sink.report(&Report::Device(Instant::from_millis(9900), Cow::Borrowed(&status)));
    drop(sink);
    let line: String = lines.iter().collect();
    let start =
        r#"{"t_s":9.9,"event":"device","device":"Card","state":"lost","why":"unplugged","channels":36,"#;
    assert!(line.starts_with(start), "{line}");
}

/// A writer that blocks until it is released.
struct Stalled {
    go: std::sync::mpsc::Receiver<()>,
    pipe: Pipe,
}

impl Write for Stalled {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // Once released, it never blocks again: the sender is gone.
        let _ = self.go.recv();
        self.pipe.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.pipe.flush()
    }
}

#[test]
fn a_reader_that_stalls_misses_values_but_no_end_and_is_told_where() {
    let (flushed, lines) = channel();
    let (go, stall) = channel::<()>();
    let mut sink = JsonSink::new(Stalled { go: stall, pipe: Pipe { pending: Vec::new(), flushed } }).unwrap();
    let happened = |ms: u64, kind| WidgetEvent { at: Instant::from_millis(ms), ..event(kind, None) };
    // 27 presses of a second each, with 480 values in each: far more than fit into the backlog.
    for press in 0..27 {
        tell(&mut sink, &[happened(1000 * press, EventKind::Pressed)]);
        for value in 1..=480 {
            let kind = EventKind::Changed(Value::Number(value as f32));
            tell(&mut sink, &[happened(1000 * press + 2 * value, kind)]);
        }
        tell(&mut sink, &[happened(1000 * press + 970, EventKind::Released)]);
    }
    assert!(sink.dropped() > 10_000, "{}", sink.dropped());
    let dropped = sink.dropped();
    drop(go);
    drop(sink);
    let text: String = lines.iter().collect();
    let count = |what: &str| text.lines().filter(|line| line.contains(what)).count();
    assert_eq!((count("\"pressed\""), count("\"released\"")), (27, 27));
    let parsed: Vec<serde_json::Value> =
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let missing: u64 = parsed.iter().filter_map(|line| line["dropped"].as_u64()).sum();
    assert_eq!((missing, parsed.len() as u64), (dropped, 27 * 482 - dropped + count("gap") as u64));
    // In order, gaps included, and the last value is there.
    let times: Vec<f64> = parsed.iter().map(|line| line["t_s"].as_f64().unwrap()).collect();
    assert!(times.is_sorted(), "{times:?}");
    let last = parsed.iter().rfind(|line| line["event"] == "changed").unwrap();
    assert_eq!(last["t_s"], 26.96);
}

#[test]
fn contacts_are_written_on_request_100_times_a_second() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap().with_contacts();
    let foot = Contact { id: ContactId(3), force: Newtons(350.0), ..Contact::default() };
    for ms in 0..25 {
        sink.report(&Report::Contacts(Instant::from_millis(ms), Cow::Borrowed(std::slice::from_ref(&foot))));
    }
    sink.report(&Report::Link(Instant::from_millis(30), LinkState::Lost));
    for ms in 31..1200 {
        sink.poll(Instant::from_millis(ms));
    }
    drop(sink);
    let text: String = lines.iter().collect();
    let told: Vec<&str> = text.lines().filter(|line| line.contains("contacts")).collect();
    assert_eq!(
        told.len(),
        3 + 2,
        "at 0, 10 and 20 ms, then that nobody is there, at once and a second later"
    );
    let first = r#"{"t_s":0.0,"event":"contacts","contacts":[{"id":3,"x_m":0.0,"y_m":0.0,"force_n":350.0,"x_velocity_m_s":0.0,"y_velocity_m_s":0.0}]}"#;
    assert_eq!(told[0], first);
    assert!(told[3].starts_with(r#"{"t_s":0.031,"#) && told[4].ends_with(r#""contacts":[]}"#), "{told:?}");
}

#[test]
fn a_control_that_an_app_changed_is_a_line_of_its_own() {
    let (flushed, lines) = channel();
    let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
    let state = ControlState {
        id: WidgetId::new("zoom"),
        value: Some(Value::Number(0.5)),
        range: Some(crate::engine::ValueRange::Number(crate::widget::Scale::new(0.0, 1.0))),
        enabled: true,
        off: None,
        locked: false,
        pressed: false,
        armed: false,
        indicator: crate::widget::Indicator::Off,
        label: "Zoom".into(),
        page: None,
    };
    sink.report(&Report::Control(Instant::from_millis(9900), Cow::Borrowed(&state)));
    drop(sink);
    let line: String = lines.iter().collect();
    let expected = r#"{"t_s":9.9,"event":"state","id":"zoom","value":0.5,"range":[0.0,1.0],"step":null,"options":null,"enabled":true,"off":null,"off_text":null,"locked":false,"pressed":false,"armed":false,"indicator":"off","label":"Zoom","page":null}"#;
    assert_eq!(line.trim_end(), expected);
}
