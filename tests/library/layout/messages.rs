//! Messages of controls: read from layouts and kinds, and written again.

use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::messages::{
    Act, ArtNetTarget, BendSettings, Destination, DmxSettings, KeyboardTarget, MidiTarget, MouseButton,
    OscArgument, OscTarget, OscTransport, Payload, SacnTarget, Trigger, When,
};
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout, write_layout};

fn read(text: &str) -> Layout {
    let loaded = parse_layout(text, "it", &Kinds::builtin(), &Floor::default().geometry);
    loaded.unwrap_or_else(|problems| panic!("{text}\n{problems}")).layout
}

const PAGE: &str = r##"Layout(
    version: 2,
    targets: [
        (name: "viewer", to: Keyboard((window: "Weasis"))),
        (name: "desk", to: Osc("127.0.0.1:53000", (over: Tcp))),
    ],
    regions: [(id: "all", at: (0, 2), size: (6, 4))],
    kinds: [
        (name: "cue", from: "button", send: [On(clicked, Osc("desk", "/cue/{n}/start"))]),
    ],
    widgets: [
        (id: "next", kind: "button", at: (0, 2), size: (0.8, 0.8),
         send: [On(clicked, Key("viewer", "Control+Right")), On(pressed, Wheel("viewer", (steps: -1)))]),
        (id: "drag", kind: "dead_man", at: (1, 2), size: (0.9, 0.9),
         send: [While(pressed, Button("viewer", middle)), While(pressed, Osc("desk", "/drag"))]),
        (id: "pan", kind: "pad", at: (2, 2), size: (0.9, 0.9),
         send: [Value(Pointer("viewer", (speed_px_s: 500))),
                Value(Osc("desk", "/pan", (from: 0, to: 1, args: ["a", 1, 0.5, value, force, x, y])))]),
        (id: "cue_{n}", kind: "cue", at: (0, 3), size: (0.7, 0.7), repeat: (columns: 3, gap: 0.2)),
        (id: "loud", kind: "cue", at: (3, 3), size: (0.7, 0.7), send: []),
    ],
)"##;

#[test]
fn a_layout_says_what_its_controls_send() {
    let layout = read(PAGE);
    let [viewer, desk] = layout.targets.as_slice() else { panic!("{:?}", layout.targets) };
    let keyboard = KeyboardTarget { window: Some("Weasis".into()), display: None };
    assert_eq!(viewer.to, Destination::Keyboard(keyboard));
    let osc = OscTarget { address: "127.0.0.1:53000".into(), over: OscTransport::Tcp };
    assert_eq!(desk.to, Destination::Osc(osc));
    let of = |id: &str| layout.widgets[layout.widget_index(id).unwrap()].send.as_slice();
    let [key, wheel] = of("next") else { panic!() };
    assert_eq!((key.when, &*key.target), (When::On(Trigger::CLICKED), "viewer"));
    assert_eq!(key.payload, Payload::Key("Control+Right".parse().unwrap()));
    assert_eq!((wheel.when, &wheel.payload), (When::On(Trigger::PRESSED), &Payload::Wheel(-1)));
    let [button, address] = of("drag") else { panic!() };
    assert_eq!((button.when, &button.payload), (When::While, &Payload::Button(MouseButton::Middle)));
    assert!(matches!(&address.payload, Payload::Osc(address, _) if address == "/drag"));
    let [pointer, pan] = of("pan") else { panic!() };
    assert_eq!(pointer.payload, Payload::Pointer(500.0));
    let Payload::Osc(_, settings) = &pan.payload else { panic!() };
    assert_eq!(settings.range, Some([0.0, 1.0]));
    let arguments = settings.arguments.as_deref().unwrap();
    assert_eq!(arguments.len(), 7);
    assert_eq!(arguments[1..3], [OscArgument::Int(1), OscArgument::Float(0.5)]);
}

#[test]
fn a_grid_fills_its_numbers_into_the_messages_of_its_kind() {
    let layout = read(PAGE);
    let addresses: Vec<&str> = layout
        .widgets
        .iter()
        .filter(|widget| widget.kind == "cue")
        .flat_map(|widget| &widget.send)
        .map(|sending| match &sending.payload {
            Payload::Osc(address, _) => address.as_str(),
            other => panic!("{other:?}"),
        })
        .collect();
    // "loud" replaces the message of its kind by none.
    assert_eq!(addresses, ["/cue/1/start", "/cue/2/start", "/cue/3/start"]);
}

#[test]
fn messages_are_written_and_read_again() {
    let layout = read(PAGE);
    let again = read(&write_layout(&layout));
    assert_eq!(again.targets, layout.targets);
    let sent = |layout: &Layout| layout.widgets.iter().map(|widget| widget.send.clone()).collect::<Vec<_>>();
    assert_eq!(sent(&again), sent(&layout));
    assert_eq!(again.plan(), layout.plan());
}

const MUSIC: &str = r##"Layout(
    version: 2,
    targets: [
        (name: "synth", to: Midi("underfoot")),
        (name: "stage", to: Midi("stage", (into: "Surge"))),
        (name: "desk", to: Osc("127.0.0.1:53000")),
        (name: "viewer", to: Keyboard),
    ],
    regions: [
        (id: "all", at: (0, 2), size: (6, 2)),
        (id: "free", at: (0, 4), size: (6, 2),
         send: [Contacts(Mpe("synth", (from: 60, to: 84, feet: 4))), Contacts(Mpe("stage")),
                Contacts(Osc("desk", "/foot", (from: 0, to: 1, args: [foot, x, y, force])), (press_n: 80)),
                Contacts(Pointer("viewer"))]),
    ],
    kinds: [(name: "drum", from: "button", send: [On(clicked, Note("synth", 36, (channel: 10)))])],
    widgets: [
        (id: "hit", kind: "button", at: (0, 2), size: (0.8, 0.8),
         send: [On(clicked, Note("synth", "F#3", (velocity: 90, length_ms: 250))), On(pressed, Program("synth", 5))]),
        (id: "hold", kind: "dead_man", at: (1, 2), size: (0.9, 0.9),
         send: [While(pressed, Note("synth", 48)), While(pressed, Cc("synth", (number: 64)))]),
        (id: "level", kind: "slider", at: (2, 2), size: (2, 0.8),
         send: [Value(Cc("stage", (number: 7, fine: true))), Value(Bend("synth", (from: 0))),
                Value(Pressure("synth", (channel: 2, key: 60)))]),
        (id: "drum_{n}", kind: "drum", at: (0, 3), size: (0.7, 0.7), repeat: (columns: 2, gap: 0.2),
         send: [On(clicked, Note("synth", "C{n}"))]),
        (id: "other", kind: "drum", at: (3, 3), size: (0.7, 0.7)),
    ],
)"##;

#[test]
fn a_layout_says_what_its_controls_and_feet_play() {
    let layout = read(MUSIC);
    let port = |port: &str, into: Option<&str>| {
        Destination::Midi(MidiTarget { port: port.into(), into: into.map(str::to_owned) })
    };
    assert_eq!(layout.targets[0].to, port("underfoot", None));
    assert_eq!(layout.targets[1].to, port("stage", Some("Surge")));
    let of = |id: &str| layout.widgets[layout.widget_index(id).unwrap()].send.as_slice();
    let [note, program] = of("hit") else { panic!() };
    let Payload::Note(54, settings) = &note.payload else { panic!("{note:?}") };
    assert_eq!((settings.channel, settings.velocity, settings.length.as_millis()), (1, Some(90), 250));
    assert_eq!(program.payload.to_string(), "program 5 on channel 1");
    let [fine, bend, pressure] = of("level") else { panic!() };
    let Payload::Controller(fine) = &fine.payload else { panic!("{fine:?}") };
    assert_eq!((fine.number, fine.fine, fine.top()), (7, true, 16_383));
    assert_eq!(bend.payload, Payload::Bend(BendSettings { channel: 1, from: 0, to: 8191 }));
    assert_eq!(pressure.payload.to_string(), "pressure of note C4 on channel 2");
    let drums = ["drum_1", "drum_2", "other"].map(|id| of(id)[0].payload.to_string());
    assert_eq!(drums, ["note C1 on channel 1", "note C2 on channel 1", "note C2 on channel 10"]);
    let [keys, usual, osc, pointer] = layout.regions[1].send.as_slice() else { panic!() };
    assert_eq!(keys.payload.to_string(), "MPE, keys 60 to 84, up to 4 feet");
    assert_eq!(usual.payload.to_string(), "MPE, keys 48 to 72, up to 15 feet");
    assert_eq!((osc.press_n, pointer.press_n), (80.0, 40.0));
    let again = read(&write_layout(&layout));
    assert_eq!((&again.targets, again.plan()), (&layout.targets, layout.plan()));
    assert_eq!(again.regions[1].send, layout.regions[1].send);
}

/// Everything that may sound is released before the first message, and nothing else.
#[test]
fn a_plan_knows_all_that_it_can_hold() {
    let held: Vec<String> = read(MUSIC).plan().holdables().iter().map(|(_, what)| what.to_string()).collect();
    for what in ["note C3 on channel 1", "controller 64 on channel 1", "all notes on channel 5"] {
        assert!(held.contains(&what.to_owned()), "{what}: {held:?}");
    }
    assert!(!held.iter().any(|what| what.contains("controller 7")), "{held:?}");
}

#[test]
fn what_midi_lacks_is_refused_with_its_place() {
    let wrong = [
        (r#"On(clicked, Note("synth", 128))"#, "expected 0 to 127"),
        (r#"On(clicked, Note("synth", "H4"))"#, "there is no note called \"H4\""),
        (r#"On(clicked, Note("synth", 60, (channel: 17)))"#, "expected 1 to 16"),
        (r#"On(clicked, Cc("synth", (number: 120)))"#, "expected 0 to 119"),
        (r#"On(clicked, Cc("synth", (number: 40, fine: true)))"#, "this controller has 7 bits only"),
        (r#"On(clicked, Cc("synth", (number: 7, to: 200)))"#, "more than 7 bits"),
        (r#"On(clicked, Bend("synth"))"#, "it follows a value"),
        (r#"On(clicked, Note("viewer", 60))"#, "\"viewer\" can't receive Note"),
        (r#"On(clicked, Key("synth", "a"))"#, "\"synth\" can't receive Key"),
        (r#"On(clicked, Note("organ", 60))"#, "there is no target \"organ\""),
        (r#"On(clicked, Osc("desk", "/a", (args: [foot])))"#, "only the feet of a region have numbers"),
    ];
    for (message, expected) in wrong {
        let text = MUSIC.replace(r#"On(pressed, Program("synth", 5))"#, message);
        assert_ne!(text, MUSIC);
        let problems = parse_layout(&text, "it", &Kinds::builtin(), &Floor::default().geometry);
        let problems = problems.map(|loaded| loaded.warnings).unwrap_err().to_string();
        assert!(problems.contains(expected), "{message}: {problems}");
    }
    let port = MUSIC.replace("Midi(\"underfoot\")", "Midi(\"under:foot\")");
    let problems = parse_layout(&port, "it", &Kinds::builtin(), &Floor::default().geometry).unwrap_err();
    assert!(problems.to_string().contains("name of a port"), "{problems}");
}

const DEVICES: &str = r##"Layout(
    version: 4,
    targets: [
        (name: "stage", to: ArtNet("10.0.0.20", (universe: 3))),
        (name: "hall", to: Sacn((universe: 7, priority: 90))),
        (name: "usual", to: Sacn),
        (name: "home", to: Mqtt("broker.local:1883", (base: "floor", discovery: true, user: "floor"))),
        (name: "note", to: Run("notify-send")),
    ],
    regions: [(id: "all", at: (0, 2), size: (6, 4))],
    kinds: [(name: "scene", from: "button", send: [On(clicked, Mqtt("home", "scene/{n}", (payload: "{label}"))), On(clicked, Run("note", ["Scene {n}"]))])],
    widgets: [
        (id: "flash", kind: "dead_man", at: (0, 2), size: (0.9, 0.9),
         send: [While(pressed, Dmx("stage", (channel: 12, from: 20))), While(pressed, Mqtt("home", "flash"))]),
        (id: "level", kind: "slider", at: (1, 2), size: (2, 0.8),
         send: [Value(Dmx("hall", (channel: 1, fine: true))), Value(Dmx("usual", (channel: 9, to: 100))),
                Value(Mqtt("home", "level", (from: 0, to: 100)))]),
        (id: "scene_{n}", kind: "scene", at: (0, 3), size: (0.7, 0.7), label: "S{n}", repeat: (columns: 2, gap: 0.2)),
    ],
)"##;

#[test]
fn a_layout_says_what_its_controls_send_to_lights_brokers_and_programs() {
    let layout = read(DEVICES);
    let stage = ArtNetTarget { address: "10.0.0.20".into(), universe: 3 };
    assert_eq!(layout.targets[0].to, Destination::ArtNet(stage));
    let hall = SacnTarget { universe: 7, priority: 90, ..SacnTarget::USUAL };
    assert_eq!(layout.targets[1].to, Destination::Sacn(hall));
    assert_eq!(layout.targets[2].to, Destination::Sacn(SacnTarget::USUAL));
    let of = |id: &str| layout.widgets[layout.widget_index(id).unwrap()].send.as_slice();
    let [light, topic] = of("flash") else { panic!() };
    assert_eq!(light.payload, Payload::Dmx(DmxSettings { from: 20, ..DmxSettings::of(12) }));
    assert!(matches!(&topic.payload, Payload::Mqtt(topic, _) if topic == "flash"));
    let [scene, note] = of("scene_2") else { panic!() };
    let Payload::Mqtt(topic, settings) = &scene.payload else { panic!("{scene:?}") };
    assert_eq!((topic.as_str(), settings.payload.as_deref()), ("scene/2", Some("s2")));
    assert_eq!(note.payload, Payload::Run(vec!["Scene 2".into()]));
    let text = write_layout(&layout);
    assert!(text.contains("version: 4,"), "{text}");
    let again = read(&text);
    assert_eq!((&again.targets, again.plan()), (&layout.targets, layout.plan()));
    // Older programs read a layout without them.
    assert!(write_layout(&read(PAGE)).contains("version: 2,"));
}

/// Lights stand where their controls do from the start on, and so do the states that a broker retains.
#[test]
fn a_plan_knows_the_states_that_last() {
    let plan = read(DEVICES).plan();
    let states: Vec<String> = plan.standing().iter().map(|(_, act)| act.to_string()).collect();
    for state in ["DMX channel 1: 0 of 65535", "DMX channel 9: 0", "level \"0\""] {
        assert!(states.contains(&state.to_owned()), "{state}: {states:#?}");
    }
    let described =
        |act: &&(usize, Act)| matches!(&act.1, Act::Mqtt(it) if it.topic.starts_with("homeassistant/"));
    assert_eq!(plan.standing().iter().filter(described).count(), 4, "{states:#?}");
    let held: Vec<String> = plan.holdables().iter().map(|(_, what)| what.to_string()).collect();
    assert_eq!(held, ["DMX channel 12", "flash"]);
}

#[test]
fn what_lights_brokers_and_programs_lack_is_refused_with_its_place() {
    let wrong = [
        (r#"Dmx("stage", (channel: 0))"#, "expected 1 to 512"),
        (r#"Dmx("stage", (channel: 513))"#, "expected 1 to 512"),
        (r#"Dmx("stage", (channel: 512, fine: true))"#, "this channel has 8 bits only"),
        (r#"Dmx("stage", (channel: 1, to: 256))"#, "more than 8 bits"),
        (r#"Dmx("home", (channel: 1))"#, "\"home\" can't receive Dmx"),
        (r#"Mqtt("home", "floor/#")"#, "no topic of a message"),
        (r#"Mqtt("home", "$SYS/a")"#, "no topic of a message"),
        (r#"Mqtt("home", "a", (from: 1))"#, "this range has one end"),
        (r#"Run("note", ["a"])"#, "a program starts at an event"),
        (r#"Run("home", ["a"])"#, "a program starts at an event"),
    ];
    for (message, expected) in wrong {
        let text = DEVICES.replace(r#"Mqtt("home", "flash")"#, message);
        assert_ne!(text, DEVICES);
        let problems = parse_layout(&text, "it", &Kinds::builtin(), &Floor::default().geometry);
        let problems = problems.map(|loaded| loaded.warnings).unwrap_err().to_string();
        assert!(problems.contains(expected), "{message}: {problems}");
    }
    let targets = [
        (r#"ArtNet("stage.local", (universe: 3))"#, "no IPv4 address"),
        (r#"ArtNet("10.0.0.20", (universe: 40000))"#, "expected 0 to 32767"),
        ("Sacn((universe: 0))", "expected 1 to 63999"),
        (r#"Sacn((to: "hall"))"#, "no IPv4 address"),
        (r#"Sacn((via: "eth0"))"#, "no IPv4 address"),
        (r#"Run("")"#, "no program"),
        (r#"Mqtt("broker.local")"#, "no address of a broker"),
    ];
    for (target, expected) in targets {
        let text = DEVICES.replace(r#"ArtNet("10.0.0.20", (universe: 3))"#, target);
        let problems = parse_layout(&text, "it", &Kinds::builtin(), &Floor::default().geometry).unwrap_err();
        assert!(problems.to_string().contains(expected), "{target}: {problems}");
    }
    let older = DEVICES.replace("version: 4", "version: 3");
    let problems = parse_layout(&older, "it", &Kinds::builtin(), &Floor::default().geometry).unwrap_err();
    assert!(problems.to_string().contains("need version 4 of the format"), "{problems}");
}

/// Files of version 1 have no messages, and stay as they are.
#[test]
fn older_layouts_send_nothing() {
    let texts = builtin_layouts().map(|name| (name, builtin_layout(name).unwrap()));
    for (name, text) in texts.filter(|(_, text)| text.contains("version: 1,")) {
        let layout = read(text);
        assert!(layout.targets.is_empty() && layout.plan().is_empty(), "{name}");
    }
}
