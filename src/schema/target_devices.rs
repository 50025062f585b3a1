//! Lights, brokers and programs as targets: `ArtNet("10.0.0.20", (universe: 1))`, `Sacn((universe: 1))`,
//! `Mqtt("127.0.0.1:1883")`, `Run("notify-send")`.

use super::node::Node;
use super::problem::Problem;
use crate::messages::{ArtNetTarget, Destination, MqttTarget, OscTarget, ProgramTarget, SacnTarget};
use underfoot_format::call::Call;
use underfoot_format::describe::Description;
use underfoot_format::text::Text;
use underfoot_format::{Codec, Flag, Opt, Rec, Record, num, record};

record! {
    /// The universe of a node of Art-Net.
    struct UniverseRecord = "ArtNet", Copy, Eq;
    /// The number of the universe: the *port address* of Art-Net.
    universe: u16 = "universe", num(0.0..=32_767.0) => 0;
}

record! {
    /// How a broker knows the floor.
    struct BrokerRecord = "Mqtt", Eq => |it, faults| {
        if it.base.as_deref().is_some_and(|base| !MqttTarget::is_topic(base)) {
            faults.error(&["base"], "this is no topic", "expected a text without + and #, such as \"floor\"");
        }
    };
    /// The first part of the topic of the floor itself, and its name at the broker: `underfoot` where none is written.
    base: Option<String> = "base", Opt(underfoot_format::Text(64)) => None;
    /// Whether Home Assistant finds the controls by itself.
    discovery: bool = "discovery", Flag => false;
    /// The user; the environment variable `UNDERFOOT_MQTT_PASSWORD` has the password.
    user: Option<String> = "user", Opt(underfoot_format::Text(200)) => None;
}

/// The names of these targets.
pub(super) const NAMES: [&str; 4] = ["ArtNet", "Sacn", "Mqtt", "Run"];

const ART_NET: &str = "ArtNet(\"10.0.0.20\", (universe: 0))";
const SACN: &str = "Sacn((universe: 1))";
const MQTT: &str = "Mqtt(\"127.0.0.1:1883\")";
const RUN: &str = "Run(\"notify-send\")";

const PLAIN: BrokerRecord = BrokerRecord { base: None, discovery: false, user: None };

/// Reads the target `call`.
pub(super) fn read(call: &Call<'_>) -> Option<Destination> {
    match call.name {
        "ArtNet" => {
            let ([address], settings) = call.values(ART_NET)?;
            let universe = settings.map_or(Some(0), |node| {
                node.record::<UniverseRecord>(None, &()).map(|record| record.universe)
            });
            let help = "write an IPv4 address, such as \"10.0.0.20\", or \"255.255.255.255\" for all nodes";
            let address = checked(address, ArtNetTarget::is_address, ("this is no IPv4 address", help))?;
            Some(Destination::ArtNet(ArtNetTarget { address, universe: universe? }))
        }
        "Sacn" => {
            let ([], settings) = call.values(SACN)?;
            settings.map_or(Some(SacnTarget::USUAL), |node| node.record(None, &())).map(Destination::Sacn)
        }
        "Mqtt" => {
            let ([address], settings) = call.values(MQTT)?;
            let settings = settings.map_or(Some(PLAIN), |node| node.record::<BrokerRecord>(None, &()));
            let help = "write a host and a port, such as \"127.0.0.1:1883\"";
            let address = checked(address, OscTarget::is_address, ("this is no address of a broker", help))?;
            let BrokerRecord { base, discovery, user } = settings?;
            Some(Destination::Mqtt(MqttTarget { address, base, discovery, user }))
        }
        _ => {
            let ([program], extra) = call.values(RUN)?;
            let help =
                "write a name or a path; arguments stand in the messages, Run(\"notify\", [\"Ready\"])";
            let is_program = |text: &str| !text.trim().is_empty() && !text.contains('\0');
            let program = checked(program, is_program, ("this is no program", help))?;
            call.without(extra, RUN, Destination::Run(ProgramTarget { program, is_allowed: false }))
        }
    }
}

/// The text at `node` if it `is` one of its kind; otherwise reports the problem.
fn checked(node: Node<'_>, is: fn(&str) -> bool, (message, help): (&str, &str)) -> Option<String> {
    let node = Node { name: "address", ..node };
    let text = node.text(255)?;
    if is(text) {
        return Some(text.to_owned());
    }
    node.report(Problem::error(node.span(), message).expected("expected another text").help(help));
    None
}

/// Returns the text of such a target; `None` for another one.
pub(super) fn write(to: &Destination) -> Option<Text> {
    Some(match to {
        Destination::ArtNet(ArtNetTarget { address, universe }) => {
            let settings = (*universe != 0).then(|| Rec.write(&UniverseRecord { universe: *universe }));
            Text::Call("ArtNet", [Text::quoted(&**address)].into_iter().chain(settings).collect())
        }
        Destination::Sacn(settings) if *settings == SacnTarget::USUAL => Text::Name("Sacn"),
        Destination::Sacn(settings) => Text::Call("Sacn", vec![Rec.write(settings)]),
        Destination::Mqtt(MqttTarget { address, base, discovery, user }) => {
            let settings = BrokerRecord { base: base.clone(), discovery: *discovery, user: user.clone() };
            let settings = (settings != PLAIN).then(|| Rec.write(&settings));
            Text::Call("Mqtt", [Text::quoted(&**address)].into_iter().chain(settings).collect())
        }
        Destination::Run(ProgramTarget { program, .. }) => Text::Call("Run", vec![Text::quoted(&**program)]),
        _ => return None,
    })
}

/// Describes the forms of these targets for the reference.
pub(super) fn describe() -> Vec<Description> {
    let with = |name, about: &str, of: Description| Description::new(name, &[about], of.fields);
    vec![
        with(
            "ArtNet",
            "`ArtNet(\"10.0.0.20\", (universe: 0))`: a universe of DMX behind a node of Art-Net, or behind all nodes of a network \
             by its address for broadcasts. A port other than 6454 stands behind the address.",
            UniverseRecord::describe(),
        ),
        with(
            "Sacn",
            "`Sacn` or `Sacn((universe: 1))`: a universe of DMX by sACN (E1.31).",
            SacnTarget::describe(),
        ),
        with(
            "Mqtt",
            "`Mqtt(\"127.0.0.1:1883\")`: a broker of MQTT 3.1.1, without TLS.",
            BrokerRecord::describe(),
        ),
        Description::new(
            "Run",
            &[
                "`Run(\"notify-send\")`: a program that messages start, by its path or its name in the folders of `PATH`, without \
               a shell.",
            ],
            Vec::new(),
        ),
    ]
}
