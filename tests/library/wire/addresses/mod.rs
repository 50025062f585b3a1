//! The reference of addresses is correct: each address in it works, and the floor sends no address that it does not
//! list.

mod requests;

use std::collections::{BTreeMap, BTreeSet};
use std::net::UdpSocket;
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rosc::{OscMessage, OscPacket, OscType};
use underfoot::engine::Snapshot;
use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::outgoing::write_event;
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};
use underfoot::sense::Method;
use underfoot::serve::{AddressEntry, Argument, MessageDirection, Reference, Server};
use underfoot::sink::{SilentSink, wait_free_shared};
use underfoot::source::UdpSource;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{Control, Indicator, Input, Value, WidgetEvent, WidgetId};
use underfoot::wire::Prefix;

/// A control of every behaviour, guard and gesture, on two pages.
const EVERYTHING: &str = r##"Layout(
    version: 1,
    regions: [(id: "all", at: (0, 0), size: (6, 6))],
    kinds: [
        (name: "hold", behaviour: Hold, press_n: 60, release_n: 40, dwell_ms: 250),
        (name: "selector", behaviour: Selector, press_n: 60, release_n: 40, options: ["Left", "Middle", "Right"]),
        (name: "pedal", behaviour: Pedal, press_n: 60, release_n: 40, full_n: 200, min: 0, max: 1),
        (name: "pad", behaviour: Pad, press_n: 60, release_n: 40, min: (0, 0), max: (1, 1)),
        (name: "dial", behaviour: Dial, press_n: 60, release_n: 40, min: 0, max: 10),
        (name: "stepper", behaviour: Stepper, press_n: 60, release_n: 40, min: 0, max: 10, step: 1),
        (name: "lean", behaviour: Lean, press_n: 60, release_n: 40),
    ],
    widgets: [
        (id: "button", kind: "button", at: (0, 0), size: (0.9, 0.9)),
        (id: "sure", kind: "button", at: (1, 0), size: (0.9, 0.9), guard: Confirm),
        (id: "hold", kind: "hold", at: (2, 0), size: (0.9, 0.9)),
        (id: "run", kind: "hold", at: (3, 0), size: (0.9, 0.9), guard: HoldToRun(max_s: 2, warn_s: 1)),
        (id: "tapped", kind: "button", at: (4, 0), size: (0.9, 0.9), double_tap_ms: 400, long_press_ms: 700, swipe_m: 0.1),
        (id: "staged", kind: "button", at: (5, 0), size: (0.9, 0.9), hard_n: 200),
        (id: "switch", kind: "switch", at: (0, 1), size: (0.9, 0.9)),
        (id: "slider", kind: "slider", at: (1, 1), size: (0.9, 0.9), min: 2, max: 4, step: 0.5),
        (id: "selector", kind: "selector", at: (2, 1), size: (0.9, 0.9)),
        (id: "pedal", kind: "pedal", at: (3, 1), size: (0.9, 0.9)),
        (id: "pad", kind: "pad", at: (4, 1), size: (0.9, 0.9)),
        (id: "dial", kind: "dial", at: (5, 1), size: (0.9, 0.9)),
        (id: "stepper", kind: "stepper", at: (0, 2), size: (0.9, 0.9)),
        (id: "lean", kind: "lean", at: (1, 2), size: (0.9, 0.9)),
    ],
    pages: [
        (id: "first", widgets: [(id: "more", kind: "button", at: (5, 5), size: (0.9, 0.9), goto: "second")]),
        (id: "second", widgets: [(id: "less", kind: "button", at: (5, 5), size: (0.9, 0.9), goto: "first")]),
    ],
)"##;

fn layout(text: &str) -> Layout {
    let loaded = parse_layout(text, "page.ron", &Kinds::builtin(), &Floor::default().geometry);
    loaded.unwrap_or_else(|problems| panic!("{problems}")).layout
}

/// A server that listens on loopback, in this thread, and an app.
struct Desk {
    server: Server,
    app: UdpSocket,
}

impl Desk {
    fn new(layout: Layout, prefix: &Prefix) -> Self {
        let floor = Floor::default();
        let source =
            UdpSource::bind("127.0.0.1:0".parse().unwrap(), &floor).unwrap().with_prefix(prefix.clone());
        let app = UdpSocket::bind("127.0.0.1:0").unwrap();
        app.connect(source.local_addr().unwrap()).unwrap();
        app.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        let (feel, renderer) = renderer(RendererConfig::of(&floor, 8000));
        let played = SilentSink::new(renderer, source.now(), None);
        let server = Server::new(&floor, layout, Method::default(), source)
            .with_feel(feel, Box::new(played))
            .with_prefix(prefix.clone());
        Self { server, app }
    }

    /// Sends a message and waits until the server has received it.
    fn send(&mut self, address: &str, args: Vec<OscType>) {
        let message = OscPacket::Message(OscMessage { addr: address.into(), args });
        let taken = |server: &Server| server.counters().datagrams;
        let before = taken(&self.server);
        self.app.send(&rosc::encoder::encode(&message).unwrap()).unwrap();
        while taken(&self.server) == before {
            self.server.turn().unwrap();
        }
        // Requests received in one turn are processed in the next.
        self.server.turn().unwrap();
    }

    /// The messages of the next answer, by address.
    fn answer(&self) -> BTreeMap<String, Vec<OscType>> {
        let mut buffer = [0; 2048];
        let length = self.app.recv(&mut buffer).unwrap();
        let content = match rosc::decoder::decode_udp(&buffer[..length]).unwrap().1 {
            OscPacket::Bundle(bundle) => bundle.content,
            message => vec![message],
        };
        let message = |packet| match packet {
            OscPacket::Message(message) => (message.addr, message.args),
            OscPacket::Bundle(_) => panic!("a bundle in a bundle"),
        };
        content.into_iter().map(message).collect()
    }

    fn is_silent(&self) -> bool {
        self.app.set_nonblocking(true).unwrap();
        let silent = self.app.recv(&mut [0; 16]).is_err();
        self.app.set_nonblocking(false).unwrap();
        silent
    }
}

/// The first and the last value in an argument's range.
fn examples(argument: &Argument) -> [OscType; 2] {
    match (argument.tag, argument.name.as_str()) {
        ("i|f|T|F", _) => [OscType::Int(0), OscType::Bool(true)],
        ("f|i", "least") => [OscType::Int(2), OscType::Float(1.0)],
        ("f|i", "greatest") => [OscType::Float(4.0), OscType::Int(9)],
        ("f|i", "choice") => [OscType::Int(0), OscType::Float(1.0)],
        ("f|i", _) => {
            let words: Vec<&str> = argument.range.split([' ', ',']).collect();
            let [least, "to", most, ..] = words[..] else { panic!("{}", argument.range) };
            [OscType::Float(least.parse().unwrap()), OscType::Float(most.parse().unwrap())]
        }
        ("i", "column" | "row" | "board" | "channel") => {
            let (least, most) = argument.range.split_once(" to ").unwrap();
            [OscType::Int(least.parse().unwrap()), OscType::Int(most.parse().unwrap())]
        }
        ("s|i", "sensor") => [OscType::String("ne".into()), OscType::Int(0)],
        ("s|i", "indicator") => [OscType::String("busy".into()), OscType::Int(1)],
        ("s", "label") => [OscType::String("Größe".into()), OscType::String("L".repeat(64))],
        ("s", "page") => {
            let ids: Vec<&str> = argument.range.split(", ").collect();
            [OscType::String(ids[0].into()), OscType::String(ids[ids.len() - 1].into())]
        }
        other => panic!("what is {other:?}?"),
    }
}

fn number(value: &OscType) -> f32 {
    match *value {
        OscType::Int(number) => number as f32,
        OscType::Float(number) => number,
        OscType::Bool(on) => f32::from(u8::from(on)),
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn every_address_in_is_understood_and_does_what_it_says() {
    let prefix: Prefix = "/lab/floor_2".parse().unwrap();
    let mut desk = Desk::new(layout(EVERYTHING), &prefix);
    let reference = Reference::of(desk.server.engine().layout(), &Floor::default(), &prefix);
    let mut tried = BTreeMap::new();
    let commands = |entry: &&AddressEntry| {
        entry.direction == MessageDirection::In && prefix.path(&entry.address).is_some()
    };
    for entry in reference.entries.iter().filter(commands) {
        for which in 0..2 {
            let args: Vec<OscType> =
                entry.arguments.iter().map(|argument| examples(argument)[which].clone()).collect();
            desk.send(&entry.address, args.clone());
            let path = prefix.path(&entry.address).unwrap();
            let verb = if path.ends_with("/range/set") { "range" } else { path.rsplit('/').next().unwrap() };
            *tried.entry(verb.to_owned()).or_insert(0) += 1;
            check(&mut desk, &prefix, path, verb, &args, &entry.address);
        }
    }
    let counters = desk.server.counters();
    assert_eq!((counters.refused(), counters.denied), (0, 0));
    // 16 controls, of which the 6 buttons and those that only a foot holds cannot be set; each twice.
    let expected = [
        ("cancel", 2),
        ("channel", 2),
        ("disable", 32),
        ("enable", 32),
        ("get", 38),
        ("indicator", 32),
        ("label", 32),
        ("lock", 32),
        ("range", 6),
        ("set", 18),
        ("tile", 4),
        ("unlock", 32),
    ];
    assert_eq!(tried, expected.map(|(verb, count)| (verb.to_owned(), count)).into());
}

/// Checks in the engine and the answers that a command took effect.
fn check(desk: &mut Desk, prefix: &Prefix, path: &str, verb: &str, args: &[OscType], address: &str) {
    if path.starts_with("mute/") {
        if verb != "get" {
            desk.send(&prefix.address("mute/get"), vec![]);
        }
        let muted: Vec<f32> = desk.answer()[&prefix.address("mute")].iter().map(number).collect();
        match verb {
            "set" => assert_eq!(muted[0], number(&args[0]), "{address}"),
            "tile" => assert_eq!(muted.ends_with(&[5.0, 5.0]), number(&args[2]) == 1.0, "{address}"),
            _ => {}
        }
        return;
    }
    if path.starts_with("sensor/") {
        assert!(desk.is_silent(), "{address}");
        let mut snapshot = Snapshot::default();
        desk.server.snapshot(&mut snapshot);
        let is_on = args.last().map(number) == Some(1.0);
        let expected = match verb {
            _ if is_on => 0,
            "tile" => 4,
            _ => 1,
        };
        assert_eq!(snapshot.health.troubles.len(), expected, "{address} {args:?}");
        // The last value of the range is another sensor: the first one comes back as well.
        if !is_on {
            let on = args.iter().take(args.len() - 1).cloned().chain([OscType::Int(1)]);
            desk.send(address, on.collect());
        }
        return;
    }
    if path == "cancel" {
        // There is no hold here; the tests of holds cover its end.
        assert!(desk.is_silent());
        return;
    }
    if path == "get" {
        let (mut said, engine) = (BTreeMap::new(), desk.server.engine());
        // A datagram per control, then the page and the muted set.
        for _ in 0..engine.layout().widgets.len() + 2 {
            said.extend(desk.answer());
        }
        for widget in &engine.layout().widgets {
            let of = |what: &str| said.contains_key(&prefix.address(&format!("widget/{}/{what}", widget.id)));
            assert!(of("state") && of("page"));
            assert_eq!(of("value"), engine.value(widget.id.as_str()).is_some());
        }
        assert!(said.contains_key(&prefix.address("page")) && said.contains_key(&prefix.address("mute")));
        assert!(desk.is_silent());
        return;
    }
    let Some(id) = path.strip_prefix("widget/").and_then(|path| path.split('/').next()) else {
        // The answer to a request for the page.
        if verb == "set" {
            assert_eq!(desk.server.engine().page().unwrap(), args[0].clone().string().unwrap());
            desk.send(&prefix.address("page/get"), vec![]);
        }
        assert_eq!(desk.answer().get(&prefix.address("page")).unwrap().len(), 1);
        return;
    };
    let engine = desk.server.engine();
    let control = engine.control(id).unwrap();
    match verb {
        "set" => match control.value().unwrap() {
            Value::Switch(on) => assert_eq!(f32::from(u8::from(on)), number(&args[0]), "{address}"),
            Value::Number(value) => assert_eq!(value, number(&args[0]), "{address}"),
            Value::Choice(choice) => assert_eq!(f32::from(choice), number(&args[0]), "{address}"),
            Value::Pair(pair) => assert_eq!(pair, Vec2::new(number(&args[0]), number(&args[1])), "{address}"),
        },
        "range" => {
            let widget = engine.layout().widget_index(id).unwrap();
            let scale = engine.layout().widgets[widget].behaviour.scale().unwrap();
            assert_eq!([scale.min, scale.max], [&args[0], &args[1]].map(number), "{address}");
            let Some(Value::Number(value)) = control.value() else { panic!("{address}") };
            assert!((scale.min..=scale.max).contains(&value), "{address}");
        }
        "enable" | "disable" => {
            assert_eq!(control.is_disabled(), (verb == "disable") == (number(&args[0]) == 1.0), "{address}");
        }
        "lock" | "unlock" => {
            assert_eq!(control.is_locked(), (verb == "lock") == (number(&args[0]) == 1.0), "{address}");
        }
        "label" => {
            let widget = engine.layout().widget_index(id).unwrap();
            assert_eq!(engine.layout().widgets[widget].label, args[0].clone().string().unwrap());
        }
        "indicator" => {
            let expected = if args[0] == OscType::Int(1) { Indicator::On } else { Indicator::Busy };
            assert_eq!(control.indicator(), expected, "{address}");
        }
        "get" => {
            let value = control.value();
            let answer = desk.answer();
            let state = &answer[&prefix.address(&format!("widget/{id}/state"))];
            assert_eq!(state.len(), 6);
            assert_eq!(answer[&prefix.address(&format!("widget/{id}/off"))].len(), 2);
            assert_eq!(answer.contains_key(&prefix.address(&format!("widget/{id}/value"))), value.is_some());
            return;
        }
        other => panic!("nobody checks {other}"),
    }
    assert!(desk.is_silent(), "{address} was answered");
}

#[test]
fn reading_back_gives_what_was_set() {
    let mut desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    let widget = |id: &str, what: &str| format!("/underfoot/widget/{id}/{what}");
    desk.send(&widget("slider", "set"), vec![OscType::Double(3.6)]);
    desk.send(&widget("slider", "label"), vec![OscType::String("Zoom".into())]);
    desk.send(&widget("slider", "indicator"), vec![OscType::String("attention".into())]);
    desk.send(&widget("slider", "lock"), vec![]);
    desk.send(&widget("slider", "disable"), vec![]);
    desk.send(&widget("slider", "get"), vec![]);
    let answer = desk.answer();
    // Rounded to its steps of a half.
    assert_eq!(answer[&widget("slider", "value")], [OscType::Float(3.5)]);
    let text = |text: &str| OscType::String(text.into());
    let texts = ["attention", "Zoom"].map(text);
    assert_eq!(answer[&widget("slider", "state")], [&[0, 1, 0, 0].map(OscType::Int)[..], &texts].concat());

    assert_eq!(answer[&widget("slider", "off")], ["disabled", "an app has switched it off"].map(text));
    assert_eq!(answer[&widget("slider", "range")], [2.0, 4.0, 0.5].map(OscType::Float));
    assert_eq!(answer[&widget("slider", "page")], [OscType::String(String::new())]);
    desk.send(&widget("selector", "get"), vec![]);
    let names = ["Left", "Middle", "Right"].map(|name| OscType::String(name.into()));
    assert_eq!(desk.answer()[&widget("selector", "range")], names);
    desk.send(&widget("less", "get"), vec![]);
    assert_eq!(desk.answer()[&widget("less", "page")], [OscType::String("second".into())]);

    desk.send(&widget("pad", "set"), vec![OscType::Float(0.25), OscType::Float(0.75)]);
    desk.send(&widget("pad", "get"), vec![]);
    assert_eq!(desk.answer()[&widget("pad", "value")], [0.25, 0.75].map(OscType::Float));
    desk.send("/underfoot/page/get", vec![]);
    assert_eq!(desk.answer()["/underfoot/page"], [OscType::String("first".into())]);
}

/// The tags of a message's arguments.
fn tags(args: &[OscType]) -> Vec<&'static str> {
    let tag = |arg: &OscType| match arg {
        OscType::Int(_) => "i",
        OscType::Float(_) => "f",
        OscType::String(_) => "s",
        other => panic!("{other:?}"),
    };
    args.iter().map(tag).collect()
}

/// Feet with random actions on every control: the reference lists every event, and every listed event occurs.
#[test]
fn every_event_is_listed_and_every_listed_event_comes() {
    let page = layout(EVERYTHING);
    let prefix = Prefix::default();
    let reference = Reference::of(&page, &Floor::default(), &prefix);
    let listed: BTreeMap<&str, Vec<&str>> = reference
        .entries
        .iter()
        .filter(|entry| entry.direction == MessageDirection::Out && entry.address.contains("/widget/"))
        // A repeated state, not an event.
        .filter(|entry| !entry.address.ends_with("/held"))
        // A foot that the engine keeps from the control, which is alone here.
        .filter(|entry| !entry.address.ends_with("/ignored"))
        .map(|entry| (entry.address.as_str(), entry.arguments.iter().map(|argument| argument.tag).collect()))
        .collect();
    let mut received = BTreeSet::new();
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let mut bytes = Vec::new();
    for widget in &page.widgets {
        let mut control = Control::new(&widget.behaviour, widget.area.size());
        let mut now = Instant::START;
        let mut place = Vec2::splat(0.5);
        let mut force = 0.0_f32;
        // Minutes of a foot that presses, slides, lingers and leaves.
        for _ in 0..20_000 {
            if rng.random_bool(0.02) {
                force = [0.0, 0.0, 100.0, 300.0][rng.random_range(0..4)];
            }
            if rng.random_bool(0.01) {
                place = Vec2::new(rng.random(), rng.random());
            }
            if rng.random_bool(0.001) {
                control.set_locked(!control.is_locked());
            }
            let input = if rng.random_bool(0.003) {
                Input::Lost
            } else if force > 0.0 {
                Input::Foot { force: Newtons(force), trusted: true, place, weight: None }
            } else {
                Input::Clear
            };
            now = now + Duration::from_millis(10);
            for kind in control.step(now, input) {
                let event = WidgetEvent {
                    at: now,
                    id: widget.id.clone(),
                    kind,
                    contact: None,
                    force: Newtons(force),
                    position: place,
                };
                write_event(&prefix, &event, &mut bytes);
                let OscPacket::Message(message) = rosc::decoder::decode_udp(&bytes).unwrap().1 else {
                    panic!("no message")
                };
                let expected = listed.get(message.addr.as_str());
                assert_eq!(expected, Some(&tags(&message.args)), "{}", message.addr);
                received.insert(message.addr);
            }
        }
    }
    let silent: Vec<_> = listed.keys().filter(|address| !received.contains(**address)).collect();
    assert!(silent.is_empty(), "never received: {silent:?}");
}

#[test]
fn the_shipped_layouts_have_references_without_an_address_twice() {
    for name in builtin_layouts() {
        let page = layout(builtin_layout(name).unwrap());
        let reference = Reference::of(&page, &Floor::default(), &Prefix::default());
        let mut seen = BTreeSet::new();
        // Messages to programs of others have no address here.
        for entry in reference.entries.iter().filter(|entry| entry.direction != MessageDirection::Target) {
            assert!(
                seen.insert((entry.address.as_str(), entry.direction as u8)),
                "{name}: {}",
                entry.address
            );
            assert!(
                !entry.says.is_empty() && entry.address.starts_with("/underfoot/"),
                "{name}: {}",
                entry.address
            );
        }
        for widget in &page.widgets {
            assert!(seen.contains(&(
                format!("/underfoot/widget/{}/get", widget.id).as_str(),
                MessageDirection::In as u8
            )));
        }
    }
}
