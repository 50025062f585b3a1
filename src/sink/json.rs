//! Events as JSON lines.

use std::io::{self, Write};
use std::sync::mpsc::Receiver;

use serde::Serialize;

use super::crack_rate::{CrackNews, CrackRateLimiter};
use super::worker::Worker;
use super::{EventSink, HeldReport, SinkError};
use crate::engine::PageShown;
use crate::feel::{DeviceStatus, Muted};
use crate::floor::SensorId;
use crate::ground::GroundEvent;
use crate::sense::{Contact, ContactId, SensorHealth, Trouble};
use crate::units::Instant;
use crate::widget::{EventKind, Value, WidgetEvent, WidgetId};
use crate::wire::LinkState;

/// Writes one JSON object per event and line.
///
/// ```json
/// {"t_s":1.234,"event":"changed","id":"zoom","value":0.5,"force_n":120.5,"x_m":0.61,"y_m":1.2,"contact":3}
/// {"t_s":9.876,"event":"link","state":"lost"}
/// {"t_s":9.9,"event":"page","page":"settings"}
/// {"t_s":9.9,"event":"health","live":143,"degraded":0,"stale":0,"faulty":1,"uncalibrated":0,"foreign":false,"troubles":[{"col":2,"row":1,"corner":"sw","trouble":"stuck"}]}
/// {"t_s":9.9,"event":"device","device":"Card","state":"lost","why":"unplugged","channels":36,"sample_rate":96000,"block":64,"underruns":0,"reopened":0,"priority":"real-time"}
/// {"t_s":9.9,"event":"mute","all":false,"tiles":[[2,1]]}
/// {"t_s":9.9,"held":["zoom"],"sequence":12}
/// {"t_s":9.9,"event":"crack","seed":3,"energy_j":0.4,"x_m":0.61,"y_m":1.2,"skipped":0}
/// ```
///
/// `value` is a number (of a choice: which, from 0), true or false, two numbers
/// in a list, the direction of a swipe, or null for events without a value;
/// `contact` is null if no foot did it. A number that JSON cannot express
/// (which the engine never gives) is null. Which controls are held is written 50
/// times a second while any is, and once when none is any longer. Contacts are not written.
#[derive(Debug)]
pub struct JsonSink {
    worker: Worker<Job>,
    cracks: CrackRateLimiter,
}

#[derive(Debug)]
enum Job {
    Event(WidgetEvent),
    Link(Instant, LinkState),
    Page(PageShown),
    Crack(CrackNews),
    Health(Instant, SensorHealth),
    Device(Instant, DeviceStatus),
    Muted(Instant, Muted),
    Held(HeldReport),
}

impl JsonSink {
    /// A sink that writes to `out`, which lives on a thread of its own from
    /// now on. Lines are flushed as soon as no other waits. Once `out` fails,
    /// what follows is dropped and counted.
    ///
    /// # Errors
    /// [`SinkError::Output`] if the system gives no thread.
    pub fn new(out: impl Write + Send + 'static) -> Result<Self, SinkError> {
        let failed = |source| SinkError::Output { message: format!("cannot write events: {source}"), source };
        let worker = Worker::spawn("json out", move |jobs| {
            if let Err(error) = write_all(jobs, out) {
                tracing::warn!("events are no longer written: {error}");
            }
        })
        .map_err(failed)?;
        Ok(Self { worker, cracks: CrackRateLimiter::default() })
    }
}

impl EventSink for JsonSink {
    fn events(&mut self, events: &[WidgetEvent]) {
        for event in events {
            self.worker.offer(Job::Event(event.clone()));
        }
    }

    fn contacts(&mut self, _at: Instant, _contacts: &[Contact]) {}

    fn page(&mut self, page: &PageShown) {
        self.worker.offer(Job::Page(page.clone()));
    }

    fn ground(&mut self, events: &[GroundEvent]) {
        for event in events {
            if let Some(news) = self.cracks.news(event) {
                self.worker.offer(Job::Crack(news));
            }
        }
    }

    fn link(&mut self, at: Instant, state: LinkState) {
        self.worker.offer(Job::Link(at, state));
    }

    fn health(&mut self, at: Instant, health: &SensorHealth) {
        self.worker.offer(Job::Health(at, health.clone()));
    }

    fn device(&mut self, at: Instant, status: &DeviceStatus) {
        self.worker.offer(Job::Device(at, status.clone()));
    }

    fn muted(&mut self, at: Instant, muted: &Muted) {
        self.worker.offer(Job::Muted(at, muted.clone()));
    }

    fn held(&mut self, report: &HeldReport) {
        let job = Job::Held(report.clone());
        // A repetition may be missed; that something has ended may not.
        let _ = if report.ended.is_empty() { self.worker.try_offer(job) } else { self.worker.offer(job) };
    }

    fn dropped(&self) -> u64 {
        self.worker.dropped()
    }
}

fn write_all(jobs: &Receiver<Job>, mut out: impl Write) -> io::Result<()> {
    while let Ok(mut job) = jobs.recv() {
        loop {
            write_line(&job, &mut out)?;
            match jobs.try_recv() {
                Ok(next) => job = next,
                Err(_) => break,
            }
        }
        out.flush()?;
    }
    Ok(())
}

fn write_line(job: &Job, out: &mut impl Write) -> io::Result<()> {
    let mut line = serde_json::to_vec(&Line::of(job))?;
    line.push(b'\n');
    out.write_all(&line)
}

#[derive(Serialize)]
struct Line<'a> {
    t_s: f64,
    #[serde(flatten)]
    body: Body<'a>,
}

#[derive(Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
enum Body<'a> {
    Page {
        page: &'a str,
    },
    Crack {
        seed: u32,
        energy_j: f32,
        x_m: f32,
        y_m: f32,
        skipped: u32,
    },
    Link {
        state: &'static str,
    },
    Mute {
        all: bool,
        tiles: Vec<[u16; 2]>,
    },
    Health {
        live: u32,
        degraded: u32,
        stale: u32,
        faulty: u32,
        uncalibrated: u32,
        foreign: bool,
        troubles: Vec<TroubleEntry>,
    },
    Device {
        device: &'a str,
        state: &'static str,
        why: &'a str,
        channels: u16,
        sample_rate: u32,
        block: u32,
        underruns: u64,
        reopened: u64,
        priority: &'static str,
    },
    /// A state, not an event.
    #[serde(untagged)]
    Held {
        held: Vec<&'a str>,
        sequence: u32,
    },
    /// Its name is that of what happened.
    #[serde(untagged)]
    Control {
        event: &'static str,
        id: &'a str,
        value: Option<JsonValue>,
        force_n: f32,
        x_m: f32,
        y_m: f32,
        contact: Option<ContactId>,
    },
}

#[derive(Serialize)]
struct TroubleEntry {
    col: u16,
    row: u16,
    corner: &'static str,
    trouble: Trouble,
}

impl<'a> Line<'a> {
    fn of(job: &'a Job) -> Self {
        let (at, body) = match job {
            Job::Event(event) => (event.at, Body::control(event)),
            Job::Page(shown) => (shown.at, Body::Page { page: shown.page.as_str() }),
            Job::Crack(CrackNews { at, seed, energy_j, x_m, y_m, skipped }) => {
                let (seed, energy_j, x_m, y_m) = (*seed, *energy_j, *x_m, *y_m);
                (*at, Body::Crack { seed, energy_j, x_m, y_m, skipped: *skipped })
            }
            Job::Link(at, state) => (*at, Body::Link { state: state.name() }),
            Job::Health(at, health) => (*at, Body::health(health)),
            Job::Device(at, status) => (*at, Body::device(status)),
            Job::Muted(at, Muted { all, tiles }) => {
                let tiles = tiles.iter().map(|tile| [tile.column, tile.row]).collect();
                (*at, Body::Mute { all: *all, tiles })
            }
            Job::Held(HeldReport { at, held, sequence, .. }) => {
                let held = held.iter().map(WidgetId::as_str).collect();
                (*at, Body::Held { held, sequence: *sequence })
            }
        };
        // Divided, not multiplied: so the nearest number to the decimal fraction is written, with six places at most.
        Self { t_s: at.micros() as f64 / 1e6, body }
    }
}

impl<'a> Body<'a> {
    fn health(health: &SensorHealth) -> Self {
        let SensorHealth { counts: [live, degraded, stale, faulty], uncalibrated, foreign, ref troubles } =
            *health;
        let entry = |&(SensorId { tile, corner }, trouble): &(SensorId, Trouble)| TroubleEntry {
            col: tile.column,
            row: tile.row,
            corner: corner.name(),
            trouble,
        };
        let troubles = troubles.iter().map(entry).collect();
        Self::Health { live, degraded, stale, faulty, uncalibrated, foreign, troubles }
    }

    fn device(status: &'a DeviceStatus) -> Self {
        Self::Device {
            device: &status.name,
            state: status.state.name(),
            why: &status.why,
            channels: status.channels,
            sample_rate: status.sample_rate,
            block: status.block,
            underruns: status.underruns,
            reopened: status.reopened,
            priority: status.priority.name(),
        }
    }

    fn control(event: &'a WidgetEvent) -> Self {
        let value = match event.kind {
            EventKind::Changed(value) => Some(value.into()),
            EventKind::Swiped(direction) => Some(JsonValue::Word(direction.name())),
            EventKind::Pressed
            | EventKind::Released
            | EventKind::Clicked
            | EventKind::DoubleTapped
            | EventKind::LongPressed
            | EventKind::HardPressed
            | EventKind::HardReleased
            | EventKind::Cancelled
            | EventKind::Ticked
            | EventKind::Armed
            | EventKind::Disarmed
            | EventKind::Warned
            | EventKind::Refused => None,
        };
        Self::Control {
            event: event.kind.name(),
            id: event.id.as_str(),
            value,
            force_n: event.force.0,
            x_m: event.position.x,
            y_m: event.position.y,
            contact: event.contact,
        }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum JsonValue {
    Switch(bool),
    Number(f32),
    Choice(u16),
    Pair([f32; 2]),
    Word(&'static str),
}

impl From<Value> for JsonValue {
    fn from(value: Value) -> Self {
        match value {
            Value::Switch(on) => Self::Switch(on),
            Value::Number(number) => Self::Number(number),
            Value::Choice(choice) => Self::Choice(choice),
            Value::Pair(pair) => Self::Pair(pair.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Sender, channel};

    use glam::Vec2;

    use super::*;
    use crate::units::Newtons;
    use crate::widget::Direction;

    /// A writer whose other end tells what was flushed.
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

    #[test]
    fn each_event_is_a_line_of_its_own_written_before_the_end() {
        let (flushed, lines) = channel();
        let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
        let changed = |value| event(EventKind::Changed(value), Some(ContactId(3)));
        sink.events(&[changed(Value::Number(0.5)), changed(Value::Switch(true))]);
        let swiped = EventKind::Swiped(Direction::North);
        sink.events(&[changed(Value::Pair(Vec2::new(0.5, -1.0))), event(swiped, Some(ContactId(3)))]);
        sink.events(&[event(EventKind::Cancelled, None)]);
        sink.link(Instant::from_millis(9876), LinkState::Lost);
        let sensor =
            SensorId { tile: crate::floor::TileId::new(2, 1), corner: crate::floor::Corner::SouthWest };
        let troubles = vec![(sensor, Trouble::Stuck)];
        let sick = SensorHealth { counts: [143, 0, 0, 1], troubles, ..SensorHealth::default() };
        sink.health(Instant::from_millis(9900), &sick);
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
        sink.events(&[event(EventKind::Pressed, None)]);
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
            sink.events(&[event(EventKind::Pressed, None)]);
            std::thread::yield_now();
        }
    }

    #[test]
    fn what_is_muted_is_told_by_column_and_row() {
        let (flushed, lines) = channel();
        let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
        let muted = Muted { all: true, tiles: vec![crate::floor::TileId::new(2, 1)] };
        sink.muted(Instant::from_millis(9900), &muted);
        drop(sink);
        let line: String = lines.iter().collect();
        assert_eq!(line.trim_end(), r#"{"t_s":9.9,"event":"mute","all":true,"tiles":[[2,1]]}"#);
    }

    #[test]
    fn what_is_held_is_a_line_with_a_number_and_so_is_that_nothing_is() {
        let (flushed, lines) = channel();
        let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
        let (at, drive) = (Instant::from_millis(9900), WidgetId::new("drive"));
        sink.held(&HeldReport { at, held: vec![drive.clone()], sequence: 4, ..HeldReport::default() });
        sink.held(&HeldReport { at, ended: vec![drive], sequence: 5, ..HeldReport::default() });
        drop(sink);
        let text: String = lines.iter().collect();
        let expected =
            [r#"{"t_s":9.9,"held":["drive"],"sequence":4}"#, r#"{"t_s":9.9,"held":[],"sequence":5}"#];
        assert_eq!(text.lines().collect::<Vec<_>>(), expected);
    }

    #[test]
    fn a_device_that_is_lost_says_why() {
        let (flushed, lines) = channel();
        let mut sink = JsonSink::new(Pipe { pending: Vec::new(), flushed }).unwrap();
        let state = crate::feel::DeviceState::Lost;
        let why = "unplugged".into();
        let status =
            DeviceStatus { name: "Card".into(), state, why, channels: 36, ..DeviceStatus::default() };
        sink.device(Instant::from_millis(9900), &status);
        drop(sink);
        let line: String = lines.iter().collect();
        let start =
            r#"{"t_s":9.9,"event":"device","device":"Card","state":"lost","why":"unplugged","channels":36,"#;
        assert!(line.starts_with(start), "{line}");
    }
}
