//! Messages of a control to lights, brokers and programs: `Dmx("lights", (channel: 12))`, `Mqtt("home", "lamp/set")`,
//! `Run("notify", ["Ready"])`.

use super::node::Node;
use super::problem::Problem;
use super::send::Fill;
use crate::messages::{DmxSettings, MAX_ARGUMENTS, MqttSettings, MqttTarget, OscArgument, Payload};
use underfoot_format::call::Call;
use underfoot_format::describe::Description;
use underfoot_format::text::Text;
use underfoot_format::{Codec, Rec, Record};

/// The names of these messages.
pub(super) const NAMES: [&str; 3] = ["Dmx", "Mqtt", "Run"];

const DMX: &str = "Dmx(\"lights\", (channel: 12))";
const MQTT: &str = "Mqtt(\"home\", \"lamp/set\", (payload: \"TOGGLE\"))";
const RUN: &str = "Run(\"notify\", [\"Ready\"])";

/// Maximum number of characters of one argument of a program.
const LONGEST: usize = 200;

/// Reads the content of the message `call`, and the node of its target; texts go through `fill`.
pub(super) fn read<'r>(call: &Call<'r>, fill: &Fill<'_>) -> Option<(Node<'r>, Payload)> {
    match call.name {
        "Dmx" => {
            // The channel has no default.
            let ([to, settings], extra) = call.values(DMX)?;
            let settings = settings.record::<DmxSettings>(None, &())?;
            call.without(extra, DMX, (to, Payload::Dmx(settings)))
        }
        "Mqtt" => {
            let ([to, topic], settings) = call.values(MQTT)?;
            let settings = settings.map_or(Some(MqttSettings::PLAIN), |node| node.record(None, &()));
            let topic = self::topic(Node { name: "topic", ..topic }, fill);
            let mut settings: MqttSettings = settings?;
            for text in [&mut settings.payload, &mut settings.off].into_iter().flatten() {
                *text = fill(to, text)?;
            }
            Some((to, Payload::Mqtt(topic?, settings)))
        }
        _ => {
            let ([to], arguments) = call.values(RUN)?;
            let read = |node: Node<'r>| fill(node, node.text(LONGEST)?);
            let arguments = match arguments {
                Some(list) => {
                    let nodes = Node { name: "arguments", ..list }.list("argument", MAX_ARGUMENTS)?;
                    nodes.into_iter().map(read).collect::<Option<Vec<String>>>()?
                }
                None => Vec::new(),
            };
            Some((to, Payload::Run(arguments)))
        }
    }
}

fn topic(node: Node<'_>, fill: &Fill<'_>) -> Option<String> {
    let text = fill(node, node.text(200)?)?;
    if MqttTarget::is_topic(&text) {
        return Some(text);
    }
    let problem = Problem::error(node.span(), "this is no topic of a message");
    let expected = "expected 1 to 200 characters without + and #, and without $ at the beginning";
    node.report(problem.expected(expected).help("write it like \"stage/lamp/set\""));
    None
}

/// Fills in the texts of the message `payload` of a kind; returns `None` after a pattern that cannot be filled in.
pub(super) fn fill_in(payload: &mut Payload, fill: &dyn Fn(&str) -> Option<String>) -> Option<()> {
    let texts: Vec<&mut String> = match payload {
        Payload::Osc(address, settings) => {
            let arguments = settings.arguments.iter_mut().flatten().filter_map(|argument| match argument {
                OscArgument::Text(text) => Some(text),
                _ => None,
            });
            std::iter::once(address).chain(arguments).collect()
        }
        Payload::Mqtt(topic, settings) => {
            let texts = [&mut settings.payload, &mut settings.off].into_iter().flatten();
            std::iter::once(topic).chain(texts).collect()
        }
        Payload::Run(arguments) => arguments.iter_mut().collect(),
        _ => Vec::new(),
    };
    for text in texts {
        *text = fill(text)?;
    }
    Some(())
}

/// Returns the text of such a message to `target`; `None` for another one.
pub(super) fn write(payload: &Payload, target: Text) -> Option<Text> {
    Some(match payload {
        Payload::Dmx(settings) => Text::Call("Dmx", vec![target, Rec.write(settings)]),
        Payload::Mqtt(topic, settings) => {
            let settings = (*settings != MqttSettings::PLAIN).then(|| Rec.write(settings));
            Text::Call("Mqtt", [target, Text::quoted(&**topic)].into_iter().chain(settings).collect())
        }
        Payload::Run(arguments) => {
            let texts = arguments.iter().map(|argument| Text::quoted(&**argument)).collect();
            let list = (!arguments.is_empty()).then_some(Text::List(texts));
            Text::Call("Run", [target].into_iter().chain(list).collect())
        }
        _ => return None,
    })
}

/// Describes the forms of these messages for the reference.
pub(super) fn describe() -> Vec<Description> {
    let with = |name, about: &str, of: Description| Description::new(name, &[about], of.fields);
    vec![
        with(
            "Dmx",
            "`Dmx(target, (channel: 12))`: the level of a DMX channel. An event sets it to `to`, where it stays; a hold sets \
             it to `to`, and to `from` at its end.",
            DmxSettings::describe(),
        ),
        with(
            "Mqtt",
            "`Mqtt(target, topic, (payload: \"TOGGLE\"))`: an MQTT message. The states of holds and values are retained.",
            MqttSettings::describe(),
        ),
        Description::new(
            "Run",
            &[
                "`Run(target, [\"argument\"])`: starts the program of the target with these arguments, at an event. Needs \
               `--allow-run`.",
            ],
            Vec::new(),
        ),
    ]
}
