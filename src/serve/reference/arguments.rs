//! The arguments of requests and values.

use std::ops::Range;

use super::Argument;
use crate::floor::Geometry;
use crate::layout::{Layout, Widget};
use crate::widget::{Behaviour, Control, Indicator, Scale, Value};
use crate::wire::sent::{Field, FieldRange, arguments_of_value};
use crate::wire::{ArgumentKind, Command};

/// Returns the argument with this name, OSC type tag and range.
pub(super) fn argument(name: &str, tag: &'static str, range: &str) -> Argument {
    Argument { name: name.into(), tag, range: range.into() }
}

/// Returns the arguments of a command; for a value, those of the control's value.
pub(super) fn taken(
    command: &Command,
    widget: Option<&Widget>,
    layout: &Layout,
    geometry: &Geometry,
) -> Vec<Argument> {
    match command.argument {
        ArgumentKind::Nothing => Vec::new(),
        ArgumentKind::Range => {
            ["least", "greatest"].map(|end| argument(end, "f|i", "-1000000 to 1000000")).into()
        }
        ArgumentKind::Label => vec![argument("label", "s", "64 characters at most")],
        ArgumentKind::Indicator => vec![argument("indicator", "s|i", &format!("{}; 0 or 1", indicators()))],
        ArgumentKind::Page => vec![argument("page", "s", &pages(layout))],
        ArgumentKind::Switch => vec![argument("on", "i|f|T|F", "0 or 1; 1 if left out")],
        ArgumentKind::Flag => vec![argument("on", "i|f|T|F", "0 or 1")],
        ArgumentKind::TileFlag => {
            let block = geometry.block();
            let numbers = |range: Range<u16>| format!("{} to {}", range.start, range.end.saturating_sub(1));
            vec![
                argument("column", "i", &numbers(block.column_range())),
                argument("row", "i", &numbers(block.row_range())),
                argument("on", "i|f|T|F", "0 or 1"),
            ]
        }
        ArgumentKind::Value => {
            let Some(widget) = widget else { return Vec::new() };
            let held = Control::new(&widget.behaviour, widget.area.size()).value();
            let mut arguments = held.map(|value| values(&widget.behaviour, value)).unwrap_or_default();
            for taken in &mut arguments {
                taken.tag = match held {
                    Some(Value::Switch(_)) => "i|f|T|F",
                    _ => "f|i",
                };
            }
            arguments
        }
    }
}

/// Returns the arguments of the value of a control with this behaviour.
pub(super) fn values(behaviour: &Behaviour, held: Value) -> Vec<Argument> {
    let fields = arguments_of_value(held, &mut Vec::new()).iter();
    let argument = |(number, field): (usize, &Field)| {
        let range = match field.range {
            FieldRange::Text(text) => text.into(),
            _ => range_of_value(behaviour, held, number),
        };
        Argument { name: field.name.into(), tag: field.tag, range }
    };
    fields.enumerate().map(argument).collect()
}

/// Returns the range of a number in the value of a control: of the first one (0) or the second (1).
fn range_of_value(behaviour: &Behaviour, held: Value, number: usize) -> String {
    let scale = match (held, behaviour) {
        (Value::Choice(_), Behaviour::Selector(selector)) => {
            let options = selector.options.iter().enumerate();
            let options: Vec<String> =
                options.map(|(number, option)| format!("{number}: {option}")).collect();
            return options.join(", ");
        }
        (Value::Choice(_), _) => return "0 or more".into(),
        (Value::Number(_), Behaviour::Pedal(pedal)) => Some(pedal.scale),
        (Value::Number(_), _) => behaviour.scale().copied(),
        (Value::Pair(_), Behaviour::Pad(pad)) => Some(if number == 0 { pad.x() } else { pad.y() }),
        (Value::Pair(_) | Value::Switch(_), _) => None,
    };
    scale.map_or_else(|| "-1 to 1".to_owned(), |scale| range(&scale))
}

fn range(scale: &Scale) -> String {
    let steps = if scale.step > 0.0 { format!(", steps of {}", scale.step) } else { String::new() };
    format!("{} to {}{steps}", scale.min, scale.max)
}

pub(super) fn indicators() -> String {
    Indicator::ALL.map(Indicator::name).join(", ")
}

pub(super) fn pages(layout: &Layout) -> String {
    let ids: Vec<&str> = layout.pages.iter().map(|page| page.id.as_str()).collect();
    ids.join(", ")
}
