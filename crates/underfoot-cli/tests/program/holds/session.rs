//! An app's own session ends each hold in time, with any fault while a dead man's pedal is held.

use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant as HostInstant};

use underfoot::runtime::{EndReason, Event, Held, Kind, Session, SessionBuilder};
use underfoot::source::{FloorInput, SensorSource, SourceError, UdpSource};
use underfoot::units::Instant;
use underfoot::wire::{LinkCounters, LinkState, SensorPacket};

use super::site::{BoardFault, Boards, Site};
use super::{SOON, TRIES};
use crate::end_to_end::underfoot;
use crate::ports::free_port;
use crate::sender::ANY_PORT;

/// A source that can panic or hang in place of its next packet.
struct Faulty {
    source: Box<dyn SensorSource>,
    panic: Arc<AtomicBool>,
    stand_still: Arc<AtomicBool>,
}

impl SensorSource for Faulty {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        assert!(!self.panic.swap(false, Ordering::Relaxed), "as planned");
        while self.stand_still.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(1));
        }
        self.source.next(patience)
    }

    fn now(&self) -> Instant {
        self.source.now()
    }

    fn counters(&self) -> LinkCounters {
        self.source.counters()
    }
}

/// The fault.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// The process that sends the packets is killed.
    SourceKilled,
    /// The boards fall silent.
    SenderStops,
    /// The wake callback panics.
    WakePanics,
    /// The last handle is dropped.
    HandleDropped,
    /// The sensing thread panics.
    SensingPanics,
    /// The sensing thread hangs.
    SensingHangs,
}

const FAULTS: [Fault; 6] = [
    Fault::SourceKilled,
    Fault::SenderStops,
    Fault::WakePanics,
    Fault::HandleDropped,
    Fault::SensingPanics,
    Fault::SensingHangs,
];

/// A person who steps on the pedal and stays there for longer than any test.
const HOLDS: &str = r#"Scenario(
    title: "Holds the pedal",
    person: (mass_kg: 70, foot_m: 0.26),
    steps: [Stand(at: (1.5, 1.5), facing: South), Wait(ms: 1200), Press(widget: "drive", force_n: 130, hold_ms: 60000)],
)"#;

/// The sender of packets, until dropped.
enum Sender {
    Process(Child),
    Thread(Boards),
}

impl Drop for Sender {
    fn drop(&mut self) {
        if let Self::Process(child) = self {
            child.kill().unwrap();
            child.wait().unwrap();
        }
    }
}

fn simulate(site: &Site, port: u16) -> Child {
    std::fs::write(site.folder.path().join("holds.ron"), HOLDS).unwrap();
    let mut command: Command = underfoot();
    command
        .current_dir(site.folder.path())
        .args(["simulate", "page.ron", "--floor", "floor.ron", "--quality", "paper", "--seed", "7"])
        .args(["--scenario", "holds.ron", "--send", &format!("127.0.0.1:{port}")])
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = HostInstant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(20), "never: {what}");
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// All events up to the end.
fn rest(session: &Session) -> Vec<Event> {
    std::iter::from_fn(|| session.next_event_timeout(Duration::from_secs(5))).collect()
}

/// Causes `fault` while the pedal is held; returns the time for which the app kept the hold.
fn believed_for(site: &Site, fault: Fault) -> Duration {
    let floor_file = site.folder.path().join("floor.ron");
    let set_up = |builder: SessionBuilder| {
        let builder = builder.floor_file(&floor_file).unwrap();
        builder.layout_file(site.folder.path().join("page.ron")).unwrap()
    };
    let [panic, stand_still, wake_panics] = [(); 3].map(|()| Arc::new(AtomicBool::new(false)));
    let (session, sender) = if fault == Fault::SourceKilled {
        let port = free_port();
        let session = set_up(Session::listen(format!("127.0.0.1:{port}"))).start().unwrap();
        (session, Sender::Process(simulate(site, port)))
    } else {
        let source = UdpSource::bind(ANY_PORT, &site.floor).unwrap();
        let (address, clock) = (source.local_addr().unwrap(), source.clock());
        let mut input = FloorInput::from(source);
        let (panic, stand_still) = (Arc::clone(&panic), Arc::clone(&stand_still));
        input.source = Box::new(Faulty { source: input.source, panic, stand_still });
        let mut builder = set_up(Session::source(input, clock));
        if fault == Fault::WakePanics {
            let panics = Arc::clone(&wake_panics);
            builder = builder.wake(move || assert!(!panics.load(Ordering::Relaxed), "as planned"));
        }
        (builder.start().unwrap(), Sender::Thread(Boards::start(site, address)))
    };
    let drive: Held = session.held("drive").unwrap();
    wait_until("the pedal is held", || drive.is_fresh());
    let mut sender = Some(sender);
    let mut session = Some(session);
    let begun = HostInstant::now();
    match (fault, &sender) {
        (Fault::SourceKilled, _) => sender = None,
        (Fault::SenderStops, Some(Sender::Thread(boards))) => boards.suffer(BoardFault::Silent),
        (Fault::WakePanics, _) => {
            wake_panics.store(true, Ordering::Relaxed);
            // This also causes an event for the app, which wakes it.
            let session = session.as_ref().unwrap();
            session.control("zoom").unwrap().set(0.7).unwrap();
        }
        (Fault::HandleDropped, _) => session = None,
        (Fault::SensingPanics, _) => panic.store(true, Ordering::Relaxed),
        (Fault::SensingHangs, _) => stand_still.store(true, Ordering::Relaxed),
        _ => unreachable!(),
    }
    wait_until("the pedal is no longer held", || !drive.is_fresh());
    let took = begun.elapsed();
    stand_still.store(false, Ordering::Relaxed);
    if let Some(session) = session {
        // After a short interruption the floor continues as before: the foot is still there.
        if !matches!(fault, Fault::SensingPanics | Fault::SensingHangs) {
            wait_until("it is cancelled", || !session.snapshot().control("drive").unwrap().pressed);
        }
        if fault != Fault::SensingPanics {
            session.stop();
        }
        let events = rest(&session);
        let is = |kind: &str| {
            events.iter().any(|event| {
                event.id() == "drive" && matches!(event.kind, Kind::Control(what) if what.name() == kind)
            })
        };
        assert!(is("pressed") && is("cancelled") && !is("released"), "{fault:?}: {events:?}");
        if matches!(fault, Fault::SourceKilled | Fault::SenderStops) {
            assert!(events.iter().any(|event| event.kind == Kind::Link(LinkState::Lost)), "{fault:?}");
        }
        let reason = match fault {
            Fault::SensingPanics => (Kind::Ended(EndReason::Panicked), "as planned"),
            _ => (Kind::Ended(EndReason::Stopped), ""),
        };
        assert_eq!(events.last().map(|event| (event.kind, event.message())), Some(reason));
        assert!(session.has_ended() && session.next_event().is_none());
    }
    drop(sender);
    assert!(!drive.is_fresh(), "never again");
    took
}

#[test]
fn whatever_fails_a_hold_is_not_believed_for_longer_than_it_may() {
    let site = Site::new();
    for fault in FAULTS {
        let mut times = Vec::new();
        // A busy machine gets another attempt.
        while times.last().is_none_or(|took| *took > SOON) {
            assert!(times.len() < TRIES, "{fault:?}: never within {SOON:?}: {times:?}");
            times.push(believed_for(&site, fault));
        }
    }
}

/// `cargo nextest run --run-ignored all longest_of_20 --no-capture`
#[test]
#[ignore = "a measurement: takes minutes"]
fn the_longest_of_20_rounds_of_each() {
    let site = Site::new();
    for fault in FAULTS {
        let mut times: Vec<Duration> = (0..20).map(|_| believed_for(&site, fault)).collect();
        times.sort();
        println!("{fault:?}: median {:?}, longest {:?}", times[10], times[19]);
        assert!(times[19] <= SOON, "{fault:?}: {times:?}");
    }
}
