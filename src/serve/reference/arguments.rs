//! The arguments of requests and values.

use std::ops::Range;

use super::Argument;
use super::limits::DescribedLimits;
use crate::floor::{Floor, Geometry};
use crate::layout::{Layout, Widget};
use crate::widget::{Behaviour, Control, Value};
use crate::wire::sent::{Field, arguments_of_value};
use crate::wire::{ArgumentKind, Command};

/// Returns the argument with this name, OSC type tag and limits.
pub(super) fn argument(name: &str, tag: &'static str, limits: DescribedLimits) -> Argument {
    let DescribedLimits { text, unit, limits } = limits;
    Argument { name: name.into(), tag, range: text, unit, limits }
}

/// Returns the arguments of a command; for a value, those of the control's value.
pub(super) fn taken(
    command: &Command,
    widget: Option<&Widget>,
    layout: &Layout,
    floor: &Floor,
) -> Vec<Argument> {
    match command.argument {
        ArgumentKind::Nothing => Vec::new(),
        ArgumentKind::Range => {
            let limits = || DescribedLimits::numbers(-1_000_000.0, 1_000_000.0);
            ["least", "greatest"].map(|end| argument(end, "f|i", limits())).into()
        }
        ArgumentKind::Label => {
            vec![argument("label", "s", DescribedLimits::text("64 characters at most"))]
        }
        ArgumentKind::Indicator => {
            let limits = DescribedLimits::indicators();
            let text = format!("{}; 0 or 1", limits.text);
            vec![argument("indicator", "s|i", DescribedLimits { text, ..limits })]
        }
        ArgumentKind::Page => vec![argument("page", "s", pages(layout))],
        ArgumentKind::Switch => {
            let text = "0 or 1; 1 if left out".into();
            vec![argument("on", "i|f|T|F", DescribedLimits { text, ..DescribedLimits::flag() })]
        }
        ArgumentKind::Flag => vec![argument("on", "i|f|T|F", DescribedLimits::flag())],
        ArgumentKind::TileFlag => {
            let [column, row] = tile(&floor.geometry);
            vec![column, row, argument("on", "i|f|T|F", DescribedLimits::flag())]
        }
        ArgumentKind::SensorFlag => {
            let [column, row] = tile(&floor.geometry);
            let sensor = DescribedLimits::text("sw, se, nw or ne, or the sensor's number from 0");
            let on = argument("on", "i|f|T|F", DescribedLimits::flag());
            vec![column, row, argument("sensor", "s|i", sensor), on]
        }
        ArgumentKind::ChannelFlag => {
            let number = |name: &str, count: usize| {
                argument(name, "i", DescribedLimits::numbers(0.0, count.saturating_sub(1) as f64))
            };
            let channels = floor.boards.iter().map(|board| board.channels.len()).max().unwrap_or_default();
            let on = argument("on", "i|f|T|F", DescribedLimits::flag());
            vec![number("board", floor.boards.len()), number("channel", channels), on]
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

/// Returns column and row of a tile.
fn tile(geometry: &Geometry) -> [Argument; 2] {
    let block = geometry.block();
    let numbers =
        |range: Range<u16>| DescribedLimits::numbers(range.start.into(), range.end.saturating_sub(1).into());
    [argument("column", "i", numbers(block.column_range())), argument("row", "i", numbers(block.row_range()))]
}

/// Returns the arguments of the value of a control with this behaviour.
pub(super) fn values(behaviour: &Behaviour, held: Value) -> Vec<Argument> {
    let fields = arguments_of_value(held, &mut Vec::new()).iter();
    let described = |(number, field): (usize, &Field)| {
        let limits = DescribedLimits::of_table(field.range);
        argument(field.name, field.tag, limits.unwrap_or_else(|| limits_of_value(behaviour, held, number)))
    };
    fields.enumerate().map(described).collect()
}

/// Returns the limits of a number in the value of a control: of the first one (0) or the second (1).
fn limits_of_value(behaviour: &Behaviour, held: Value, number: usize) -> DescribedLimits {
    let scale = match (held, behaviour) {
        (Value::Choice(_), Behaviour::Selector(selector)) => {
            let options = selector.options.iter().enumerate();
            let options: Vec<String> =
                options.map(|(number, option)| format!("{number}: {option}")).collect();
            let last = selector.options.len().saturating_sub(1);
            return DescribedLimits::text(options.join(", ")).within(0.0, last as f64);
        }
        (Value::Choice(_), _) => return DescribedLimits::text("0 or more"),
        (Value::Number(_), Behaviour::Pedal(pedal)) => Some(pedal.scale),
        (Value::Number(_), _) => behaviour.scale().copied(),
        (Value::Pair(_), Behaviour::Pad(pad)) => Some(if number == 0 { pad.x() } else { pad.y() }),
        (Value::Pair(_) | Value::Switch(_), _) => None,
    };
    scale.map_or_else(|| DescribedLimits::numbers(-1.0, 1.0), |scale| DescribedLimits::scale(&scale))
}

/// The pages of the layout.
pub(super) fn pages(layout: &Layout) -> DescribedLimits {
    DescribedLimits::words(layout.pages.iter().map(|page| page.id.as_str()))
}
