//! The answers to apps' requests, and their other recipients.

use super::*;

// P12
#[test]
fn what_cannot_be_done_is_answered_with_a_reason_and_counted() {
    let mut desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    let string = |text: &str| vec![OscType::String(text.into())];
    let range = |least, greatest| vec![OscType::Float(least), OscType::Float(greatest)];
    let cases: [(&str, Vec<OscType>, &str); 22] = [
        // Wrong types: refused by the decoder.
        ("widget/slider/set", string("full"), "takes one finite number"),
        ("widget/slider/set", vec![OscType::Float(f32::NAN)], "takes one finite number"),
        ("widget/slider/set", vec![], "takes one finite number"),
        ("widget/slider/enable", vec![OscType::Int(2)], "takes no argument, 0 or 1"),
        ("widget/slider/label", vec![OscType::Int(1)], "takes one string"),
        ("widget/slider/indicator", string("purple"), "takes off, on, busy or attention"),
        ("widget/slider/range/set", range(0.0, f32::NAN), "takes two numbers"),
        ("mute/set", vec![OscType::Int(2)], "takes 0 or 1"),
        ("mute/tile", vec![OscType::Int(1), OscType::Int(1)], "takes three numbers"),
        (
            "sensor/set",
            vec![OscType::Int(1), OscType::Int(1), OscType::Int(4), OscType::Int(0)],
            "column and row",
        ),
        ("sensor/channel", vec![OscType::Int(1), OscType::Int(1)], "takes three numbers"),
        // Valid but impossible: refused by the engine.
        ("widget/nowhere/enable", vec![], r#"there is no control "nowhere""#),
        ("widget/slidr/get", vec![], r#"there is no control "slidr"; did you mean "slider"?"#),
        ("widget/button/set", vec![OscType::Int(1)], "does not hold that type of value"),
        ("widget/slider/set", vec![OscType::Bool(true)], "does not hold that type of value"),
        ("widget/run/set", vec![OscType::Int(1)], "only a foot"),
        ("widget/slider/range/set", range(4.0, 2.0), "can't have such a range"),
        ("widget/selector/range/set", range(0.0, 1.0), "does not hold that type of value"),
        ("widget/selector/set", vec![OscType::Int(7)], "no such option"),
        ("page/set", string("nowhere"), r#"there is no page "nowhere": the layout has "first" and "second""#),
        ("mute/tile", vec![OscType::Int(0), OscType::Int(6), OscType::Int(1)], "the floor has no such tile"),
        (
            "sensor/channel",
            [7, 0, 0].map(OscType::Int).into(),
            "the floor has no sensor on channel 0 of board 7",
        ),
    ];
    for (path, args, reason) in cases {
        let address = format!("/underfoot/{path}");
        desk.send(&address, args);
        let answer = desk.answer();
        let [OscType::String(asked), OscType::String(why)] = &answer["/underfoot/error"][..] else {
            panic!("{answer:?}")
        };
        assert_eq!(*asked, address);
        assert!(why.contains(reason), "{address}: {why}");
    }
    let counters = desk.server.counters();
    assert_eq!((counters.wrong_shape, counters.denied), (11, 11));

    for address in ["/underfoot/widget/slider/explode", "/underfoot/page/hide", "/underfoot/widget/no*"] {
        desk.send(address, vec![]);
        let unknown = format!("nothing here has the address {address:?}");
        assert_eq!(
            desk.answer()["/underfoot/error"],
            [address, &unknown].map(|text| OscType::String(text.into()))
        );
    }
    // Addresses that floors themselves send are counted and not answered: an answer to an answer could loop for ever.
    for address in [
        "/underfoot/error",
        "/underfoot/contacts",
        "/underfoot/widget/slider/value",
        "/underfoot/widget/slider/changed",
        "/elsewhere",
    ] {
        desk.send(address, vec![OscType::Float(1.0)]);
    }
    assert_eq!(desk.server.counters().unknown_address, 3 + 5);
    assert!(desk.is_silent());
}

#[test]
fn what_one_app_changes_or_asks_is_told_to_all() {
    let listener = UdpSocket::bind("127.0.0.1:0").unwrap();
    listener.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let told = underfoot::sink::OscSink::new(listener.local_addr().unwrap()).unwrap();
    let mut desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    desk.server = desk.server.with_events(Box::new(told));
    let widget = |what: &str| format!("/underfoot/widget/slider/{what}");
    let hear = |desk: &mut Desk, verb: &str, args: Vec<OscType>| {
        desk.send(&widget(verb), args);
        loop {
            let mut buffer = [0; 2048];
            let length = listener.recv(&mut buffer).unwrap();
            // Besides, there are reports of an empty floor.
            let packet = rosc::decoder::decode_udp(&buffer[..length]).unwrap().1;
            let OscPacket::Bundle(bundle) = packet else { continue };
            let messages = bundle.content.into_iter().filter_map(|packet| match packet {
                OscPacket::Message(message) => Some((message.addr, message.args)),
                OscPacket::Bundle(_) => None,
            });
            let messages: BTreeMap<String, Vec<OscType>> = messages.collect();
            if let Some(state) = messages.get(&widget("state")) {
                return (messages[&widget("value")].clone(), state.clone());
            }
        }
    };
    let state = |enabled, locked, label: &str| {
        let texts = ["off", label].map(|text| OscType::String(text.into()));
        [&[enabled, locked, 0, 0].map(OscType::Int)[..], &texts].concat()
    };
    let number = |number| vec![OscType::Float(number)];
    let page = desk.server.engine().layout();
    let label = page.widgets[page.widget_index("slider").unwrap()].label.clone();
    assert_eq!(hear(&mut desk, "set", number(3.0)), (number(3.0), state(1, 0, &label)));
    assert_eq!(hear(&mut desk, "lock", vec![]), (number(3.0), state(1, 1, &label)));
    assert_eq!(hear(&mut desk, "enable", vec![OscType::Int(0)]), (number(3.0), state(0, 1, &label)));
    let text = vec![OscType::String("Zoom".into())];
    assert_eq!(hear(&mut desk, "label", text), (number(3.0), state(0, 1, "Zoom")));
    assert!(desk.is_silent(), "whoever changes it knows");
    assert_eq!(hear(&mut desk, "get", vec![]), (number(3.0), state(0, 1, "Zoom")));
    assert_eq!(desk.answer()[&widget("state")], state(0, 1, "Zoom"));
}

// P11
#[test]
fn a_pattern_asks_every_control_that_it_means() {
    let mut desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    let locked = |desk: &Desk| {
        let engine = desk.server.engine();
        let ids = engine.layout().widgets.iter().map(|widget| widget.id.as_str());
        ids.filter(|id| engine.control(id).unwrap().is_locked()).map(str::to_owned).collect::<Vec<_>>()
    };
    desk.send("/underfoot/widget/s*er/lock", vec![]);
    assert_eq!(locked(&desk), ["slider", "stepper"]);
    desk.send("/underfoot/widget/{slider,pad}/lock", vec![OscType::Int(0)]);
    desk.send("/*/widget/pa?/lock", vec![OscType::Bool(true)]);
    assert_eq!(locked(&desk), ["pad", "stepper"]);
    desk.send("/underfoot/widget/[ps]*/unloc[a-k]", vec![]);
    assert!(locked(&desk).is_empty());
    // Each control that cannot do it answers separately.
    desk.send("/underfoot/widget/s[wu]*/set", vec![OscType::Int(1)]);
    let answer = desk.answer();
    assert_eq!(answer["/underfoot/error"][0], OscType::String("/underfoot/widget/sure/set".into()));
    assert!(desk.is_silent());
    assert_eq!(desk.server.engine().value("switch"), Some(Value::Switch(true)));
    desk.send("/underfoot/widget/x*/lock", vec![]);
    assert_eq!(desk.answer()["/underfoot/error"][0], OscType::String("/underfoot/widget/x*/lock".into()));
}

// P10
#[test]
fn a_bundle_with_a_time_tag_waits_until_then_or_is_refused() {
    let mut desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    let bundle = |ahead: Duration| {
        let timetag = rosc::OscTime::try_from(std::time::SystemTime::now() + ahead).unwrap();
        let message = OscMessage { addr: "/underfoot/widget/slider/lock".into(), args: vec![] };
        let content = vec![OscPacket::Message(message)];
        rosc::encoder::encode(&OscPacket::Bundle(rosc::OscBundle { timetag, content })).unwrap()
    };
    let is_locked = |desk: &Desk| desk.server.engine().control("slider").unwrap().is_locked();
    let begun = std::time::Instant::now();
    desk.app.send(&bundle(Duration::from_millis(300))).unwrap();
    while !is_locked(&desk) {
        desk.server.turn().unwrap();
        assert!(begun.elapsed() < Duration::from_secs(20), "never met");
    }
    assert!(begun.elapsed() >= Duration::from_millis(299), "met after {:?}", begun.elapsed());
    desk.app.send(&bundle(Duration::from_secs(60))).unwrap();
    while desk.server.counters().denied == 0 {
        desk.server.turn().unwrap();
    }
    let [_, OscType::String(why)] = &desk.answer()["/underfoot/error"][..] else { panic!("no reason") };
    assert!(why.contains("wait for 1 s at most"), "{why}");
}

#[test]
fn apps_over_the_channel_are_refused_like_others_and_labels_outlive_a_new_layout() {
    let (commands, received) = wait_free_shared(8);
    let desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    let mut server = desk.server.with_commands(received);
    let id = WidgetId::new("button");
    let label = underfoot::wire::ControlMessage::Label { id: id.clone(), text: "Start".into() };
    commands.send(underfoot::serve::FloorCommand::Control(label)).unwrap();
    commands.send(underfoot::serve::FloorCommand::SetLayout(Box::new(layout(EVERYTHING)))).unwrap();
    commands
        .send(underfoot::serve::FloorCommand::Control(underfoot::wire::ControlMessage::Get {
            id: WidgetId::new("no"),
        }))
        .unwrap();
    server.turn().unwrap();
    let button = &server.engine().layout().widgets[0];
    assert_eq!((button.id.clone(), button.label.as_str()), (id, "Start"));
    assert_eq!(server.counters().denied, 1);
    let mut snapshot = underfoot::engine::Snapshot::default();
    server.snapshot(&mut snapshot);
    assert_eq!(snapshot.labels, [(0, "Start".into())]);
}

#[test]
fn a_label_loses_what_no_label_may_hold_whoever_sends_it() {
    let mut desk = Desk::new(layout(EVERYTHING), &Prefix::default());
    let tricks = [
        ("Al\u{202e}arm\u{1b}[31m \u{2067}o\u{200f}ff\n\u{7}", "Alarm[31m off"),
        ("st\u{200b}op\u{2028}", "stop"),
        ("st\u{200d}op", "stop"),
    ];
    let fine = ["הגדל", "نمی\u{200c}خواهم", "👩\u{200d}⚕\u{fe0f}"].map(|label| (label, label));
    for (sent, shown) in tricks.into_iter().chain(fine) {
        desk.send("/underfoot/widget/button/label", vec![OscType::String(sent.into())]);
        assert_eq!(desk.server.engine().control_state("button").unwrap().label, shown);
    }
    assert_eq!(desk.server.counters().cleaned, tricks.len() as u64);
}
