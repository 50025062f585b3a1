//! The examples run and behave as documented.

use std::borrow::Cow;
use std::net::UdpSocket;
use std::time::Duration;

use rosc::{OscMessage, OscType};
use underfoot::sense::ContactId;
use underfoot::sink::{EventSink, OscSink, Report};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, Value, WidgetEvent, WidgetId};

#[allow(dead_code)]
#[path = "../../examples/custom_kind.rs"]
mod custom_kind;
#[allow(dead_code)]
#[path = "../../examples/embed.rs"]
mod embed;
#[allow(dead_code)]
#[path = "../../examples/osc_listener.rs"]
mod osc_listener;

use osc_listener::held::Held;

#[test]
fn embed_runs() {
    embed::main().unwrap();
}

#[test]
fn custom_kind_runs() {
    custom_kind::main().unwrap();
}

#[test]
fn the_osc_listener_hears_controls_and_answers() {
    let app = UdpSocket::bind("127.0.0.1:0").unwrap();
    let floor = UdpSocket::bind("127.0.0.1:0").unwrap();
    for socket in [&app, &floor] {
        socket.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    }
    let mut events = OscSink::new(app.local_addr().unwrap()).unwrap();
    let event = |id: &str, kind| WidgetEvent {
        at: Instant::START,
        id: WidgetId::new(id),
        kind,
        contact: Some(ContactId(1)),
        force: Newtons(120.0),
        position: underfoot::glam::Vec2::ONE,
    };
    for event in [
        event("zoom", EventKind::Changed(Value::Number(0.5))),
        event("satellite", EventKind::Changed(Value::Switch(true))),
        event("home", EventKind::Clicked),
    ] {
        events.report(&Report::Event(Cow::Borrowed(&event)));
    }
    let answer_to = floor.local_addr().unwrap().to_string();
    let (mut received, mut held) = (Vec::new(), Held::default());
    while received.len() < 3 {
        received.extend(osc_listener::listen(&app, &answer_to, &mut held).unwrap());
    }
    assert_eq!(received, ["zoom/changed to 0.50", "satellite/changed to on", "home/clicked"]);
    let mut answer = [0; 256];
    let length = floor.recv(&mut answer).unwrap();
    let text = String::from_utf8_lossy(&answer[..length]);
    assert!(text.starts_with("/underfoot/widget/zoom/set"), "{text}");
}

#[test]
fn an_app_believes_that_a_control_is_held_for_100_ms_and_no_number_twice() {
    let mut held = Held::default();
    let begun = std::time::Instant::now();
    let at = |ms| begun + Duration::from_millis(ms);
    let report = |on: i32, sequence: i32| OscMessage {
        addr: "/lab/widget/drive/held".into(),
        args: vec![OscType::Int(on), OscType::Int(sequence)],
    };
    assert!(held.take(&report(1, i32::MAX), at(0)));
    assert_eq!((held.at(at(99)), held.at(at(100))), (vec!["drive".to_string()], vec![]));
    // The number wraps to below zero; the one before it comes late.
    held.take(&report(0, i32::MIN), at(110));
    held.take(&report(1, i32::MAX), at(120));
    assert_eq!(held.at(at(120)), Vec::<String>::new(), "overtaken");
    // A restarted floor counts from one.
    held.take(&report(1, 1), at(1200));
    assert_eq!(held.at(at(1210)), ["drive"]);
    assert!(!held.take(&OscMessage { addr: "/underfoot/alive".into(), args: vec![] }, at(1210)));
}
