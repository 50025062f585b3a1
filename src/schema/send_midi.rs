//! MIDI messages of a control: `Note("synth", "C4")`, `Cc("synth", (number: 7))`.

use super::node::Node;
use super::problem::Problem;
use super::send::Fill;
use crate::messages::{
    BendSettings, ControllerSettings, MIDI_MAX, MidiNote, NoteSettings, Payload, PressureSettings,
    ProgramSettings,
};
use underfoot_format::call::Call;
use underfoot_format::describe::Description;
use underfoot_format::ron2::ast::Expr;
use underfoot_format::text::RonText;
use underfoot_format::{Codec, Rec, Record};

/// The names of MIDI messages.
pub(super) const NAMES: [&str; 5] = ["Note", "Cc", "Program", "Bend", "Pressure"];

const NOTE: &str = "Note(\"synth\", \"C4\", (channel: 1))";
const CC: &str = "Cc(\"synth\", (number: 7))";
const PROGRAM: &str = "Program(\"synth\", 5, (channel: 1))";
const BEND: &str = "Bend(\"synth\", (channel: 1))";
const PRESSURE: &str = "Pressure(\"synth\", (channel: 1))";

/// Reads the content of the MIDI message `call`, and the node of its target; texts go through `fill`.
pub(super) fn read<'r>(call: &Call<'r>, fill: &Fill<'_>) -> Option<(Node<'r>, Payload)> {
    match call.name {
        "Note" => {
            let ([to, key], settings) = call.values(NOTE)?;
            let (key, settings) = (self::key(Node { name: "key", ..key }, fill), record(settings));
            Some((to, Payload::Note(key?, settings?)))
        }
        "Cc" => {
            // The number has no default.
            let ([to, settings], extra) = call.values(CC)?;
            let settings = settings.record::<ControllerSettings>(None, &())?;
            call.without(extra, CC, (to, Payload::Controller(settings)))
        }
        "Program" => {
            let ([to, number], settings) = call.values(PROGRAM)?;
            let number = whole(Node { name: "program", ..number });
            let settings = record(settings);
            Some((to, Payload::Program(number?, settings?)))
        }
        "Bend" => {
            let ([to], settings) = call.values(BEND)?;
            Some((to, Payload::Bend(record(settings)?)))
        }
        _ => {
            let ([to], settings) = call.values(PRESSURE)?;
            Some((to, Payload::Pressure(record(settings)?)))
        }
    }
}

/// Reads the settings at `node`; those of none are the usual ones.
fn record<T: Record<Context = ()> + Usual>(node: Option<Node<'_>>) -> Option<T> {
    node.map_or(Some(T::USUAL), |node| node.record(None, &()))
}

/// Settings that need not be written.
trait Usual {
    /// The settings where none are written.
    const USUAL: Self;
}

impl Usual for NoteSettings {
    const USUAL: Self = Self::USUAL;
}

impl Usual for ProgramSettings {
    const USUAL: Self = Self { channel: 1 };
}

impl Usual for BendSettings {
    const USUAL: Self = Self { channel: 1, from: -8192, to: 8191 };
}

impl Usual for PressureSettings {
    const USUAL: Self = Self { channel: 1, key: None, from: 0, to: 127 };
}

/// A key: its number, or its name as a text.
fn key(node: Node<'_>, fill: &Fill<'_>) -> Option<u8> {
    let Expr::String(_) = node.expr else { return whole(node) };
    let text = fill(node, node.text(64)?)?;
    let key = MidiNote::key_called(&text);
    if key.is_none() {
        let problem = Problem::error(node.span(), format!("there is no note called \"{text}\""));
        let help = "notes are 0 to 127, or letter, # or b, and octave: C4 is 60";
        node.report(problem.expected("expected a note such as \"C4\" or \"F#3\"").help(help));
    }
    key
}

/// A whole number of seven bits.
fn whole(node: Node<'_>) -> Option<u8> {
    let number = node.number(0.0..=f64::from(MIDI_MAX))?;
    if !number.whole {
        node.report_fraction();
    }
    number.whole.then_some(number.value as u8)
}

/// Returns the text of a MIDI message to `target`; `None` for another one.
pub(super) fn write(payload: &Payload, target: RonText) -> Option<RonText> {
    let number = |number: u8| RonText::Whole(number.into());
    Some(match payload {
        Payload::Note(key, settings) => with("Note", vec![target, number(*key)], settings),
        Payload::Controller(settings) => RonText::Call("Cc", vec![target, Rec.write(settings)]),
        Payload::Program(program, settings) => with("Program", vec![target, number(*program)], settings),
        Payload::Bend(settings) => with("Bend", vec![target], settings),
        Payload::Pressure(settings) => with("Pressure", vec![target], settings),
        _ => return None,
    })
}

/// A message with its settings, if they are not the usual ones.
fn with<T: Record>(name: &'static str, mut values: Vec<RonText>, settings: &T) -> RonText {
    let mut entries = Vec::new();
    settings.write_fields(&mut entries);
    if !entries.is_empty() {
        values.push(RonText::Record(T::NAME, entries));
    }
    RonText::Call(name, values)
}

/// Describes the forms of MIDI messages for the reference.
pub(super) fn describe() -> Vec<Description> {
    let with = |name, about: &str, of: Description| Description::new(name, &[about], of.fields);
    vec![
        with(
            "Note",
            "`Note(target, key, (channel: 1))`: a MIDI note, its key as a number or as a name such as `\"C4\"` (60).",
            NoteSettings::describe(),
        ),
        with(
            "Cc",
            "`Cc(target, (number: 7))`: a MIDI controller. An event sends `to`; a hold sends `to`, and `from` at its end.",
            ControllerSettings::describe(),
        ),
        with(
            "Program",
            "`Program(target, number, (channel: 1))`: a MIDI program, from 0.",
            ProgramSettings::describe(),
        ),
        with(
            "Bend",
            "`Bend(target, (channel: 1))`: MIDI pitch bend, with a value.",
            BendSettings::describe(),
        ),
        with(
            "Pressure",
            "`Pressure(target, (channel: 1))`: MIDI pressure of a channel or a key, with a value.",
            PressureSettings::describe(),
        ),
    ]
}
