//! Events and contacts as another program receives them, over loopback.

use std::borrow::Cow;
use std::net::UdpSocket;
use std::time::Duration;

use rosc::{OscPacket, OscType};
use underfoot::floor::TileId;
use underfoot::glam::Vec2;
use underfoot::sense::{Contact, ContactId, Covariance, Quality, SensorHealth, TileLoad};
use underfoot::sink::{EventSink, OscSink, Report};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, WidgetEvent, WidgetId};
use underfoot::wire::LinkState;

fn listen() -> (UdpSocket, OscSink) {
    let listener = UdpSocket::bind("127.0.0.1:0").unwrap();
    listener.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let sink = OscSink::new(listener.local_addr().unwrap()).unwrap();
    (listener, sink)
}

/// The messages of the next datagram, by address and first argument.
fn hear(listener: &UdpSocket) -> Vec<(String, Option<OscType>)> {
    let mut buffer = [0; 2048];
    let length = listener.recv(&mut buffer).unwrap();
    let content = match rosc::decoder::decode_udp(&buffer[..length]).unwrap().1 {
        OscPacket::Bundle(bundle) => bundle.content,
        message => vec![message],
    };
    let received = content.into_iter().map(|element| match element {
        OscPacket::Message(message) => (message.addr, message.args.first().cloned()),
        OscPacket::Bundle(_) => panic!("a bundle in a bundle"),
    });
    received.collect()
}

fn foot(x: f32) -> Contact {
    let centroid = Vec2::new(x, 0.5);
    let load = TileLoad { tile: TileId::new(0, 0), index: 0, force: Newtons(350.0), centroid };
    Contact {
        id: ContactId(1),
        centroid,
        force: Newtons(350.0),
        velocity: Vec2::ZERO,
        tiles: [load].into_iter().collect(),
        covariance: Covariance::isotropic(0.003),
        ambiguous: false,
        split: false,
        quality: Quality::Live,
        difference: None,
    }
}

#[test]
fn events_arrive_in_order_up_to_the_last() {
    let (listener, mut sink) = listen();
    let event = |number: u32| WidgetEvent {
        at: Instant::START,
        id: WidgetId::new(&format!("button_{number}")),
        kind: EventKind::Clicked,
        contact: None,
        force: Newtons::ZERO,
        position: Vec2::ZERO,
    };
    sink.report(&Report::Link(Instant::START, LinkState::Live));
    let health = SensorHealth { counts: [143, 0, 0, 1], ..SensorHealth::default() };
    sink.report(&Report::Health(Instant::START, Cow::Owned(health)));
    for number in 0..100 {
        sink.report(&Report::Event(Cow::Borrowed(&event(number))));
    }
    drop(sink);
    // Changes of the link and changes of the sensors both report both.
    for _ in 0..2 {
        assert_eq!(hear(&listener), [("/underfoot/health".into(), Some(OscType::String("live".into())))]);
    }
    for number in 0..100 {
        assert_eq!(hear(&listener)[0].0, format!("/underfoot/widget/button_{number}/clicked"));
    }
}

#[test]
fn contacts_arrive_at_100_hz_and_end_with_none() {
    let (listener, mut sink) = listen();
    let nobody = [("/underfoot/contacts".to_owned(), Some(OscType::Int(0)))];
    // An empty floor, then a foot for 100 ms from 5 ms on, then an empty floor.
    let mut reports = 0;
    for ms in 0..300 {
        let here = (5..105).contains(&ms);
        let contacts = if here { vec![foot(ms as f32)] } else { vec![] };
        sink.report(&Report::Contacts(Instant::from_millis(ms), Cow::Borrowed(&contacts)));
        if ms == 0 {
            assert_eq!(hear(&listener), nobody, "who waits learns that the floor is there");
        }
        // The report falls due at 5, 15, ... 105: the first at once, the last without a foot.
        if (5..=105).contains(&ms) && ms % 10 == 5 {
            reports += 1;
            let received = hear(&listener);
            assert_eq!(received[0], ("/underfoot/contacts".into(), Some(OscType::Int(here.into()))));
            assert_eq!(received.len(), 1 + usize::from(here));
        }
    }
    assert_eq!(reports, 11);
    listener.set_nonblocking(true).unwrap();
    assert!(listener.recv(&mut [0; 16]).is_err(), "quiet while nobody is there");
    assert_eq!(sink.dropped(), 0);
}

#[test]
fn that_nobody_is_there_is_said_every_second_on_an_empty_and_on_a_lost_floor() {
    let (listener, mut sink) = listen();
    let nobody = [("/underfoot/contacts".to_owned(), Some(OscType::Int(0)))];
    let health = |state: &str| [("/underfoot/health".to_owned(), Some(OscType::String(state.into())))];
    sink.report(&Report::Link(Instant::START, LinkState::Live));
    assert_eq!(hear(&listener), health("live"));
    for ms in 0..2500 {
        let now = Instant::from_millis(ms);
        sink.report(&Report::Contacts(now, Cow::Borrowed(&[])));
        sink.poll(now);
        if ms % 1000 == 0 {
            assert_eq!(hear(&listener), nobody);
        }
    }
    sink.report(&Report::Contacts(Instant::from_millis(2500), Cow::Borrowed(&[foot(0.5)])));
    assert_eq!(hear(&listener).len(), 2);
    sink.report(&Report::Link(Instant::from_millis(2600), LinkState::Lost));
    assert_eq!(hear(&listener), health("lost"));
    assert_eq!(hear(&listener), nobody, "at once");
    // No frames come: only the clock advances.
    for ms in 2601..4700 {
        sink.poll(Instant::from_millis(ms));
        if ms == 3600 || ms == 4600 {
            assert_eq!(hear(&listener), nobody);
        }
    }
    listener.set_nonblocking(true).unwrap();
    assert!(listener.recv(&mut [0; 16]).is_err(), "not more often");
}

#[test]
fn a_sink_that_ends_under_a_foot_says_that_nobody_is_there() {
    let (listener, mut sink) = listen();
    sink.report(&Report::Contacts(Instant::START, Cow::Borrowed(&[foot(0.5)])));
    assert_eq!(hear(&listener).len(), 2);
    drop(sink);
    assert_eq!(hear(&listener), [("/underfoot/contacts".into(), Some(OscType::Int(0)))]);
}
