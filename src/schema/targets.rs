//! The targets of a layout's messages: `(name: "desk", to: Osc("127.0.0.1:53000"))`.

use super::node::Node;
use super::problem::Problem;
use super::target_devices;
use crate::messages::{
    Destination, KeyboardTarget, MAX_TARGETS, MidiTarget, OscTarget, OscTransport, SendTarget,
};
use underfoot_format::codec::{At, By, Distinct, Written};
use underfoot_format::describe::{Description, FieldType};
use underfoot_format::text::Text;
use underfoot_format::{Codec, Id, Name, Opt, Rec, Record, record};

record! {
    /// A program or device that messages go to.
    pub(super) struct TargetRecord = "Target";
    /// Its name in messages, unique in the layout.
    pub(super) name: Written<String> = "name", At(Id);
    /// The receiver: keyboard and pointer of the desktop, a program that receives OSC, a port of MIDI, a universe of DMX by
    /// Art-Net or sACN, a broker of MQTT, or a program that messages start.
    to: Destination = "to", DESTINATION;
}

record! {
    /// How OSC reaches a target.
    struct OverRecord = "Osc", Copy, Eq;
    /// The protocol below OSC; SLIP frames the messages on TCP.
    over: OscTransport = "over", Name => OscTransport::Udp;
}

record! {
    /// The ports that a port of MIDI connects to.
    struct IntoRecord = "Midi";
    /// Part of the name of a port that it connects to by itself.
    into: Option<String> = "into", Opt(underfoot_format::Text(64)) => None;
}

/// The targets of a layout.
pub(super) const TARGETS: Distinct<TargetRecord> = Distinct {
    entry: "target",
    most: MAX_TARGETS,
    about: |_, target, fields, seen| {
        if !target.name.at.is_empty() {
            seen.check(fields, format!("the target \"{}\"", target.name.value), target.name.at.clone());
        }
    },
};

const DESTINATION: By<Destination> = By {
    shape: || {
        FieldType::Words(
            "Keyboard | Keyboard((window: \"part of a title\")) | Osc(\"host:port\") | Osc(\"host:port\", (over: Tcp)) | Midi(\"port\") | Midi(\"port\", (into: \"part of a name\")) | ArtNet(\"address\", (universe: 0)) | Sacn | Sacn((universe: 1, to: \"address\", via: \"address\", priority: 100)) | Mqtt(\"host:port\", (base: \"floor\", discovery: true, user: \"name\")) | Run(\"program\")",
        )
    },
    read: |node, ()| destination(node),
    write: |to| match to {
        Destination::Keyboard(keyboard) if *keyboard == ANY_WINDOW => Text::Name("Keyboard"),
        Destination::Keyboard(keyboard) => Text::Call("Keyboard", vec![Rec.write(keyboard)]),
        Destination::Osc(OscTarget { address, over }) => {
            let address = Text::quoted(&**address);
            Text::Call(
                "Osc",
                match over {
                    OscTransport::Udp => vec![address],
                    OscTransport::Tcp => vec![address, Rec.write(&OverRecord { over: *over })],
                },
            )
        }
        Destination::Midi(MidiTarget { port, into }) => {
            let settings = into.is_some().then(|| Rec.write(&IntoRecord { into: into.clone() }));
            Text::Call("Midi", [Text::quoted(&**port)].into_iter().chain(settings).collect())
        }
        device => target_devices::write(device).unwrap_or(Text::Name("")),
    },
    stand_in: || Destination::Keyboard(ANY_WINDOW),
};

/// A keyboard for any window of the usual display.
const ANY_WINDOW: KeyboardTarget = KeyboardTarget { window: None, display: None };

const OSC: &str = "Osc(\"127.0.0.1:53000\")";
const MIDI: &str = "Midi(\"underfoot\")";

fn destination(node: Node<'_>) -> Option<Destination> {
    let call = node.call(&[&["Keyboard", "Osc", "Midi"][..], &target_devices::NAMES].concat())?;
    if target_devices::NAMES.contains(&call.name) {
        return target_devices::read(&call);
    }
    if call.name == "Midi" {
        let ([port], settings) = call.values(MIDI)?;
        let into = settings
            .map_or(Some(None), |node| node.record::<IntoRecord>(None, &()).map(|record| record.into));
        let port = port_name(Node { name: "port", ..port })?;
        return Some(Destination::Midi(MidiTarget { port, into: into? }));
    }
    if call.name == "Keyboard" {
        let ([], settings) = call.values("Keyboard")?;
        return settings.map_or(Some(ANY_WINDOW), |node| node.record(None, &())).map(Destination::Keyboard);
    }
    let ([address], settings) = call.values(OSC)?;
    let over = settings.map_or(Some(OscTransport::Udp), |node| {
        node.record::<OverRecord>(None, &()).map(|record| record.over)
    });
    let address = Node { name: "address", ..address };
    let text = address.text(255)?;
    if !OscTarget::is_address(text) {
        let problem = Problem::error(address.span(), "this is no address of a program");
        let help = "write a host and a port, such as \"127.0.0.1:53000\"";
        address.report(problem.expected("expected host:port").help(help));
        return None;
    }
    Some(Destination::Osc(OscTarget { address: text.to_owned(), over: over? }))
}

/// A name that every system allows for a port: JACK separates a port from its program by a colon.
fn port_name(node: Node<'_>) -> Option<String> {
    let text = node.text(48)?;
    if MidiTarget::is_port(text) {
        return Some(text.to_owned());
    }
    let problem = Problem::error(node.span(), "this can't be the name of a port");
    node.report(problem.expected("expected 1 to 48 characters, without a colon"));
    None
}

impl TargetRecord {
    /// Makes the target for the layout.
    pub(super) fn checked(&self) -> SendTarget {
        SendTarget { name: self.name.value.clone(), to: self.to.clone() }
    }

    /// The receiver.
    pub(super) const fn to(&self) -> &Destination {
        &self.to
    }
}

/// Writes the targets of a layout.
pub(super) fn write_all(targets: &[SendTarget]) -> Text {
    let write = |target: &SendTarget| {
        let entries = vec![("name", Text::quoted(&*target.name)), ("to", DESTINATION.write(&target.to))];
        Text::Record(TargetRecord::NAME, entries)
    };
    Text::List(targets.iter().map(write).collect())
}

/// Describes the forms of targets for the reference.
pub(super) fn describe() -> Vec<Description> {
    let with = |name, about: &str, of: Description| Description::new(name, &[about], of.fields);
    let mut all = vec![
        with(
            "Keyboard",
            "`Keyboard` or `Keyboard((window: \"part of a title\"))`: keys and pointer of the desktop.",
            KeyboardTarget::describe(),
        ),
        with(
            "Osc",
            "`Osc(\"127.0.0.1:53000\", (over: Udp))`: a program that receives OSC.",
            OverRecord::describe(),
        ),
        with(
            "Midi",
            "`Midi(\"underfoot\", (into: \"part of a name\"))`: a port of MIDI that the program opens.",
            IntoRecord::describe(),
        ),
    ];
    all.extend(target_devices::describe());
    all
}
