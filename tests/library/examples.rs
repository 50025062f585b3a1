//! The examples run, and do what they say.

use std::net::UdpSocket;
use std::time::Duration;

use underfoot::sense::ContactId;
use underfoot::sink::{EventSink, OscSink};
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
    events.events(&[
        event("zoom", EventKind::Changed(Value::Number(0.5))),
        event("satellite", EventKind::Changed(Value::Switch(true))),
        event("home", EventKind::Clicked),
    ]);
    let answer_to = floor.local_addr().unwrap().to_string();
    let mut received = Vec::new();
    while received.len() < 3 {
        received.extend(osc_listener::listen(&app, &answer_to).unwrap());
    }
    assert_eq!(received, ["zoom/changed to 0.50", "satellite/changed to on", "home/clicked"]);
    let mut answer = [0; 256];
    let length = floor.recv(&mut answer).unwrap();
    let text = String::from_utf8_lossy(&answer[..length]);
    assert!(text.starts_with("/underfoot/widget/zoom/set"), "{text}");
}
