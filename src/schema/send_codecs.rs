//! The settings of messages, in brackets behind their target.

use super::node::Node;
use super::problem::Problem;
use super::{send_contacts, send_devices, send_midi};
use crate::messages::{MAX_ARGUMENTS, OscArgument, OscSettings};
use underfoot_format::codec::{By, List};
use underfoot_format::describe::{Description, FieldType};
use underfoot_format::ron2::ast::Expr;
use underfoot_format::text::Text;
use underfoot_format::{Num, Opt, Record, list, num, record};

/// Ends of a range of OSC numbers.
const ENDS: Num = num(-1e6..=1e6);

record! {
    /// Steps of the mouse wheel.
    pub(super) struct WheelRecord = "Wheel", Copy, Eq;
    /// Steps away from the user, negative ones towards: at each event, or over the whole range of a value.
    pub(super) steps: i32 = "steps", STEPS => 1;
}

record! {
    /// The pointer, moved by a pad or by leaning.
    pub(super) struct PointerRecord = "Pointer", Copy;
    /// Speed at full deflection.
    pub(super) speed_px_s: f32 = "speed_px_s", num(1.0..=20_000.0) => 800.0;
}

record! {
    /// The arguments of an OSC message.
    pub(super) struct OscSettingsRecord = "Osc" => |it, faults| {
        if it.from.is_some() != it.to.is_some() {
            let expected = "`from` and `to` belong together";
            faults.error(&["from", "to"], "this range has one end", expected);
        }
    };
    /// The number for the least value of the control; without it the value goes out as it is.
    from: Option<f32> = "from", Opt(ENDS) => None;
    /// The number for the greatest value of the control.
    to: Option<f32> = "to", Opt(ENDS) => None;
    /// The arguments: numbers, texts, and `value`, `force`, `x` and `y`, or `foot` for feet of a region; the value
    /// alone where nothing is written.
    args: Option<Vec<OscArgument>> = "args", Opt(ARGUMENTS) => None;
}

impl WheelRecord {
    /// One step.
    pub(super) const ONE: Self = Self { steps: 1 };
    /// Ten steps over the whole range of a value (our choice: a page of most lists).
    pub(super) const OVER_A_RANGE: Self = Self { steps: 10 };
}

impl PointerRecord {
    /// The speed where none is written: a screen of 1920 pixels in 2.4 s.
    pub(super) const USUAL: Self = Self { speed_px_s: 800.0 };
}

impl OscSettingsRecord {
    /// No settings.
    pub(super) const PLAIN: Self = Self { from: None, to: None, args: None };

    /// The settings as the messenger uses them.
    pub(super) fn settings(self) -> OscSettings {
        let range = self.from.zip(self.to).map(|(from, to)| [from, to]);
        OscSettings { range, arguments: self.args }
    }
}

/// Returns the text of the settings of an OSC message, if it has any.
pub(super) fn write_osc(settings: &OscSettings) -> Option<Text> {
    let record = OscSettingsRecord {
        from: settings.range.map(|[from, _]| from),
        to: settings.range.map(|[_, to]| to),
        args: settings.arguments.clone(),
    };
    let mut entries = Vec::new();
    record.write_fields(&mut entries);
    (!entries.is_empty()).then_some(Text::Record(OscSettingsRecord::NAME, entries))
}

/// Steps of a wheel: a whole number.
const STEPS: By<i32> = By {
    shape: || FieldType::Words("a whole number from -1000 to 1000"),
    read: |node, ()| {
        let number = node.number(-1000.0..=1000.0)?;
        if !number.whole {
            node.report_fraction();
        }
        number.whole.then_some(number.value as i32)
    },
    write: |steps| Text::Whole((*steps).into()),
    stand_in: || 1,
};

const ARGUMENTS: List<By<OscArgument>> = list("argument", MAX_ARGUMENTS, ARGUMENT);

const ARGUMENT: By<OscArgument> = By {
    shape: || FieldType::Words("a number, a text, value, force, x, y or foot"),
    read: |node, ()| argument(node),
    write: |argument| match argument {
        OscArgument::Int(number) => Text::Whole((*number).into()),
        OscArgument::Float(number) => Text::Single(*number),
        OscArgument::Text(text) => Text::quoted(&**text),
        OscArgument::Value => Text::Name("value"),
        OscArgument::Force => Text::Name("force"),
        OscArgument::X => Text::Name("x"),
        OscArgument::Y => Text::Name("y"),
        OscArgument::Foot => Text::Name("foot"),
    },
    stand_in: || OscArgument::Value,
};

/// Arguments that the foot or the control gives.
#[derive(Clone, Copy)]
enum ArgumentSource {
    Value,
    Force,
    X,
    Y,
    Foot,
}

impl ArgumentSource {
    fn argument(self) -> OscArgument {
        match self {
            Self::Value => OscArgument::Value,
            Self::Force => OscArgument::Force,
            Self::X => OscArgument::X,
            Self::Y => OscArgument::Y,
            Self::Foot => OscArgument::Foot,
        }
    }
}

const FROM_THE_FOOT: &[(&str, ArgumentSource)] = &[
    ("value", ArgumentSource::Value),
    ("force", ArgumentSource::Force),
    ("x", ArgumentSource::X),
    ("y", ArgumentSource::Y),
    ("foot", ArgumentSource::Foot),
];

/// A number without a point is an integer, one with a point is not: receivers distinguish them.
fn argument(node: Node<'_>) -> Option<OscArgument> {
    match node.expr {
        Expr::String(_) => node.text(200).map(|text| OscArgument::Text(text.to_owned())),
        Expr::Number(written) => {
            let has_point = written.raw.contains(['.', 'e', 'E']);
            let range = if has_point { -1e9..=1e9 } else { f64::from(i32::MIN)..=f64::from(i32::MAX) };
            let number = node.number(range)?;
            Some(if has_point {
                OscArgument::Float(number.single)
            } else {
                OscArgument::Int(number.value as i32)
            })
        }
        Expr::Struct(_) => node.choice(FROM_THE_FOOT).map(|which| which.argument()),
        _ => {
            let problem = Problem::error(node.span(), "this can't be an argument of OSC");
            node.report(problem.expected("expected a number, a text, value, force, x, y or foot"));
            None
        }
    }
}

/// Describes the forms of messages for the reference.
pub(super) fn describe() -> Vec<Description> {
    let form = |name, about: &str| Description::new(name, &[about], Vec::new());
    let with = |name, about: &str, of: Description| Description::new(name, &[about], of.fields);
    let mut all = vec![
        form("On", "`On(event, message)`: the message goes out at once at each such event of the control."),
        form(
            "While",
            "`While(pressed, message)`: a key, a button, an address or a channel goes down when a foot presses the control and comes up \
             when the hold ends. The control must have the guard `HoldToRun`.",
        ),
        form(
            "Value",
            "`Value(message)`: the message follows the value of the control, at most 100 times a second.",
        ),
        form(
            "Key",
            "`Key(target, key)`: a key by its character or its name in X11, with modifiers: `\"Control+Shift+z\"`.",
        ),
        form("Button", "`Button(target, left | middle | right)`: a button of the mouse."),
        with("Wheel", "`Wheel(target, (steps: 1))`: steps of the mouse wheel.", WheelRecord::describe()),
        with(
            "Pointer",
            "`Pointer(target, (speed_px_s: 800))`: moves the pointer.",
            PointerRecord::describe(),
        ),
        with(
            "Osc",
            "`Osc(target, address, (from: 0, to: 1))`: an OSC message.",
            OscSettingsRecord::describe(),
        ),
    ];
    all.extend(send_midi::describe());
    all.extend(send_devices::describe());
    all.extend(send_contacts::describe());
    all
}
