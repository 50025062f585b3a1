//! Messages of controls: read from layouts and kinds, and written again.

use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::messages::{
    Destination, KeyboardTarget, MouseButton, OscArgument, OscTarget, OscTransport, Payload, Trigger, When,
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

/// Files of version 1 have no messages, and stay as they are.
#[test]
fn older_layouts_send_nothing() {
    let texts = builtin_layouts().map(|name| (name, builtin_layout(name).unwrap()));
    for (name, text) in texts.filter(|(_, text)| text.contains("version: 1,")) {
        let layout = read(text);
        assert!(layout.targets.is_empty() && layout.plan().is_empty(), "{name}");
    }
}
