//! The messages of a control: `On(clicked, Key("viewer", "Right"))`.
//!
//! Values stand in their order and settings in brackets of their own, `Osc("desk", "/pan", (from: 0, to: 1))`: RON has no
//! named fields beside positional ones.

use super::node::Node;
use super::problem::Problem;
use super::send_codecs::{OscSettingsRecord, PointerRecord, WheelRecord, write_osc};
use super::suggest::nearest;
use super::{send_devices, send_midi};
use crate::messages::{KeyStroke, MAX_MESSAGES, MouseButton, OscArgument, Payload, Sending, Trigger, When};
use underfoot_format::codec::{By, List, Written};
use underfoot_format::describe::FieldType;
use underfoot_format::text::Text;
use underfoot_format::{Codec, Name, Named, list};

/// The messages of a kind of control.
pub(super) const SENDS: List<By<Sending>> = list("message", MAX_MESSAGES, SENDING);

const SENDING: By<Sending> = By {
    shape: || FieldType::Words("On(event, message) | While(pressed, message) | Value(message)"),
    read: |node, ()| read(node, &as_written),
    write: |sending| write(sending),
    stand_in: || Sending {
        when: When::Value,
        target: String::new(),
        payload: Payload::Button(MouseButton::Left),
    },
};

/// Fills in the places of a grid, such as `{n}`, in a text; reports a pattern that it cannot fill.
pub(super) type Fill<'f> = dyn Fn(Node<'_>, &str) -> Option<String> + 'f;

/// Keeps the patterns of a kind, which the controls fill in.
fn as_written(_: Node<'_>, text: &str) -> Option<String> {
    Some(text.to_owned())
}

const ON: &str = "On(clicked, Key(\"viewer\", \"Right\"))";
const WHILE: &str = "While(pressed, Key(\"viewer\", \"space\"))";
const VALUE: &str = "Value(Osc(\"desk\", \"/pan\"))";
const KEY: &str = "Key(\"viewer\", \"Right\")";
const BUTTON: &str = "Button(\"viewer\", left)";
const WHEEL: &str = "Wheel(\"viewer\", (steps: 1))";
const POINTER: &str = "Pointer(\"viewer\", (speed_px_s: 800))";
const OSC: &str = "Osc(\"desk\", \"/cue/1/start\")";

/// Reads the messages at `node`, each with its place; texts go through `fill`.
pub(super) fn read_all(node: Node<'_>, fill: &Fill<'_>) -> Option<Vec<Written<Sending>>> {
    let nodes = node.list("message", MAX_MESSAGES)?;
    // All are read before the first failure ends the list, so that each failure is reported.
    let read: Vec<_> = nodes
        .into_iter()
        .map(|node| read(node, fill).map(|value| Written { value, at: node.span() }))
        .collect();
    read.into_iter().collect()
}

/// Reads one message.
fn read(node: Node<'_>, fill: &Fill<'_>) -> Option<Sending> {
    let call = node.call(&["On", "While", "Value"])?;
    let (when, message) = match call.name {
        "On" => {
            let ([event, message], extra) = call.values(ON)?;
            let event = Node { name: "event", ..event };
            let trigger = event.choice(Trigger::ALL)?;
            (When::On(trigger), call.without(extra, ON, message)?)
        }
        "While" => {
            let ([event, message], extra) = call.values(WHILE)?;
            let event = Node { name: "state", ..event };
            event.choice(&[("pressed", ())])?;
            (When::While, call.without(extra, WHILE, message)?)
        }
        _ => {
            let ([message], extra) = call.values(VALUE)?;
            (When::Value, call.without(extra, VALUE, message)?)
        }
    };
    let message = Node { name: "message", ..message };
    let (target, payload) = payload(message, when, fill)?;
    if !payload.suits(when) {
        let name = payload.name();
        let problem = Problem::error(message.span(), format!("{name} can't go out that way"));
        let help = match payload {
            Payload::Pointer(_) => "the pointer follows a value: Value(Pointer(...))",
            Payload::Wheel(_) => "the wheel has no state: On(..., Wheel(...)) or Value(Wheel(...))",
            Payload::Bend(_) | Payload::Pressure(_) => {
                "it follows a value: Value(Bend(...)), Value(Pressure(...))"
            }
            Payload::Program(..) => "a program is chosen at an event: On(clicked, Program(...))",
            Payload::Run(_) => "a program starts at an event: On(clicked, Run(...))",
            _ => "a key, a button or a note is pressed by On(...) or While(...)",
        };
        message.report(problem.expected("expected another kind of message").help(help));
        return None;
    }
    Some(Sending { when, target, payload })
}

/// Reads the target and the content of a message.
fn payload(node: Node<'_>, when: When, fill: &Fill<'_>) -> Option<(String, Payload)> {
    let others = ["Key", "Button", "Wheel", "Pointer", "Osc"];
    let call = node.call(&[&others[..], &send_midi::NAMES, &send_devices::NAMES].concat())?;
    let target = |node: Node<'_>| Node { name: "target", ..node }.id().map(str::to_owned);
    match call.name {
        "Key" => {
            let ([to, key], extra) = call.values(KEY)?;
            let (to, key) = (target(to), self::key(Node { name: "key", ..key }, fill));
            call.without(extra, KEY, (to?, Payload::Key(key?)))
        }
        "Button" => {
            let ([to, button], extra) = call.values(BUTTON)?;
            let button = Node { name: "button", ..button }.choice(MouseButton::ALL);
            let to = target(to);
            call.without(extra, BUTTON, (to?, Payload::Button(button?)))
        }
        "Wheel" => {
            let ([to], settings) = call.values(WHEEL)?;
            let default = if when == When::Value { WheelRecord::OVER_A_RANGE } else { WheelRecord::ONE };
            let settings = settings.map_or(Some(default), |node| node.record::<WheelRecord>(None, &()));
            Some((target(to)?, Payload::Wheel(settings?.steps)))
        }
        "Pointer" => {
            let ([to], settings) = call.values(POINTER)?;
            let settings =
                settings.map_or(Some(PointerRecord::USUAL), |node| node.record::<PointerRecord>(None, &()));
            Some((target(to)?, Payload::Pointer(settings?.speed_px_s)))
        }
        "Osc" => {
            let ([to, address], settings) = call.values(OSC)?;
            let settings = settings
                .map_or(Some(OscSettingsRecord::PLAIN), |node| node.record::<OscSettingsRecord>(None, &()));
            let (to, address) = (target(to), self::address(Node { name: "address", ..address }, fill));
            let mut settings = settings?.settings();
            if settings.arguments.iter().flatten().any(|argument| *argument == OscArgument::Foot) {
                let problem = Problem::error(node.span(), "only the feet of a region have numbers");
                node.report(problem.expected("expected value, force, x, y, numbers and texts"));
                return None;
            }
            for argument in settings.arguments.iter_mut().flatten() {
                if let OscArgument::Text(text) = argument {
                    *text = fill(node, text)?;
                }
            }
            Some((to?, Payload::Osc(address?, settings)))
        }
        name => {
            let is_midi = send_midi::NAMES.contains(&name);
            let read = if is_midi { send_midi::read(&call, fill) } else { send_devices::read(&call, fill) };
            let (to, payload) = read?;
            Some((target(to)?, payload))
        }
    }
}

fn key(node: Node<'_>, fill: &Fill<'_>) -> Option<KeyStroke> {
    let text = fill(node, node.text(64)?)?;
    match text.parse() {
        Ok(key) => Some(key),
        Err(wrong) => {
            let problem = Problem::error(node.span(), format!("there is no key called \"{wrong}\""));
            let help = nearest(&wrong, KeyStroke::names()).map(|name| format!("did you mean \"{name}\"?"));
            let help = help.unwrap_or_else(|| {
                "keys have the names of X11: Right, space, Return, Page_Down, F5, Control+Shift+z".to_owned()
            });
            node.report(problem.expected("expected a character or the name of a key").help(help));
            None
        }
    }
}

/// Reads an OSC address; it goes through `fill`.
pub(super) fn address(node: Node<'_>, fill: &Fill<'_>) -> Option<String> {
    let text = fill(node, node.text(200)?)?;
    // A kind keeps the patterns that its controls fill in.
    let bare = text.replace(['{', '}'], "");
    let is_legal = |c: char| c.is_ascii_graphic() && !matches!(c, '#' | '*' | ',' | '?' | '[' | ']');
    if bare.len() > 1 && bare.starts_with('/') && bare.chars().all(is_legal) {
        return Some(text);
    }
    let problem = Problem::error(node.span(), "this is no OSC address");
    let expected = "expected / and letters, digits and signs other than # * , ? [ ] { }";
    node.report(problem.expected(expected).help("write it like \"/cue/1/start\""));
    None
}

/// Returns the text of one message.
fn write(sending: &Sending) -> Text {
    let target = Text::quoted(&*sending.target);
    let payload = match &sending.payload {
        Payload::Key(key) => Text::Call("Key", vec![target, Text::quoted(key.to_string())]),
        Payload::Button(button) => Text::Call("Button", vec![target, Name.write(button)]),
        Payload::Wheel(steps) => {
            let settings = Text::Record("Wheel", vec![("steps", Text::Whole((*steps).into()))]);
            Text::Call("Wheel", vec![target, settings])
        }
        Payload::Pointer(speed) => {
            let settings = Text::Record("Pointer", vec![("speed_px_s", Text::single(*speed))]);
            Text::Call("Pointer", vec![target, settings])
        }
        Payload::Osc(address, settings) => {
            let values = [target, Text::quoted(&**address)];
            Text::Call("Osc", values.into_iter().chain(write_osc(settings)).collect())
        }
        other => send_midi::write(other, target.clone())
            .or_else(|| send_devices::write(other, target))
            .unwrap_or(Text::Name("")),
    };
    match sending.when {
        When::On(trigger) => Text::Call("On", vec![Text::Name(trigger.name()), payload]),
        When::While => Text::Call("While", vec![Text::Name("pressed"), payload]),
        When::Value => Text::Call("Value", vec![payload]),
    }
}

/// Returns the messages of a kind for one control; the places of a grid are filled in.
pub(super) fn inherited(kind: &[Sending], at: Node<'_>, fill: &Fill<'_>) -> Option<Vec<Written<Sending>>> {
    let filled = kind.iter().map(|sending| {
        let mut value = sending.clone();
        send_devices::fill_in(&mut value.payload, &|text| fill(at, text))?;
        Some(Written { value, at: at.span() })
    });
    filled.collect()
}

/// Returns the text of a control's field `send`, on one line.
#[must_use]
pub fn written_messages(sendings: &[Sending]) -> String {
    write_all(&sendings.to_vec()).inline()
}

/// Writes the messages of a control.
pub(super) fn write_all(sendings: &Vec<Sending>) -> Text {
    SENDS.write(sendings)
}
