//! Every OSC address of a floor with a layout, in and out, made from the decoder's own table.

use std::ops::Range;

use serde::Serialize;

use crate::floor::{Floor, Geometry};
use crate::ground::Material;
use crate::layout::{Layout, Widget};
use crate::widget::{ActsOn, Behaviour, Control, Guard, Indicator, OffReason, Scale, Value};
use crate::wire::{ArgumentKind, COMMANDS, Command, Prefix};

/// Direction of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// To the floor's own port.
    In,
    /// From the floor to its listeners.
    Out,
    /// From the floor to the program that asked.
    Answer,
}

/// One argument.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Argument {
    /// Its name.
    pub name: String,
    /// Its OSC type tag; `|` separates several accepted tags.
    pub tag: &'static str,
    /// Its unit, range or choices; may be empty.
    pub range: String,
}

/// One address.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// Direction of its messages.
    pub direction: Direction,
    /// The address as it stands in messages.
    pub address: String,
    /// Its arguments, in order.
    pub arguments: Vec<Argument>,
    /// Its meaning, in a sentence.
    pub says: String,
}

/// All addresses of one floor, those of the floor first, then control by control.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Reference {
    /// The addresses.
    pub entries: Vec<Entry>,
}

impl Reference {
    /// The addresses of `layout` on `floor`, beginning with `prefix` apart from those of the boards.
    #[must_use]
    pub fn of(layout: &Layout, floor: &Floor, prefix: &Prefix) -> Self {
        let mut maker = Maker { prefix, entries: Vec::new() };
        maker.floor(layout, floor);
        for widget in &layout.widgets {
            maker.control(widget, layout, floor);
        }
        Self { entries: maker.entries }
    }
}

struct Maker<'a> {
    prefix: &'a Prefix,
    entries: Vec<Entry>,
}

impl Maker<'_> {
    fn add(&mut self, direction: Direction, path: &str, arguments: Vec<Argument>, says: &str) {
        let address = self.prefix.address(path);
        self.entries.push(Entry { direction, address, arguments, says: says.into() });
    }

    fn floor(&mut self, layout: &Layout, floor: &Floor) {
        for (number, board) in floor.boards.iter().enumerate() {
            let channels = board.channels.len();
            let arguments = vec![
                argument("sequence", "i", "counts packets, wraps"),
                argument(
                    "readings",
                    "i|f|b",
                    &format!(
                        "{channels} counts 0 to 65535, {channels} newtons, or one blob of 16-bit counts"
                    ),
                ),
            ];
            let says = format!("Readings of board {number}, once a millisecond.");
            let address = board.address.clone();
            self.entries.push(Entry { direction: Direction::In, address, arguments, says });
        }
        for command in COMMANDS.iter().filter(|command| !command.is_of_a_control()) {
            // A layout without pages has none to show.
            if command.argument != ArgumentKind::Page || !layout.pages.is_empty() {
                let arguments = taken(command, None, layout, &floor.geometry);
                self.add(Direction::In, command.path, arguments, command.says);
            }
        }
        let place = || [argument("x", "f", "m, eastwards"), argument("y", "f", "m, northwards")];
        let mut contact = vec![argument("id", "i", "one for as long as it stays down")];
        contact.extend(place());
        contact.push(argument("force", "f", "N"));
        contact.extend([argument("x_velocity", "f", "m/s"), argument("y_velocity", "f", "m/s")]);
        let count = vec![argument("count", "i", "0 or more")];
        self.add(Direction::Out, "contacts", count, "How many contacts follow; 100 times a second at most.");
        self.add(Direction::Out, "contact", contact, "One contact, in the bundle of `contacts`.");
        let count = vec![argument("sequence", "i", "one more each time")];
        self.add(Direction::Out, "alive", count, "The floor is served; 10 times a second.");
        let health = vec![
            argument("state", "s", "waiting, live, partial or lost"),
            argument("degraded", "i", "sensors"),
            argument("silent", "i", "sensors"),
            argument("faulty", "i", "sensors"),
            argument("uncalibrated", "i", "sensors"),
        ];
        self.add(
            Direction::Out,
            "health",
            health,
            "How boards and sensors are doing, when that changes; then up to eight sensors in trouble, a string each.",
        );
        if !floor.areas.is_empty() {
            let area = vec![
                argument("area", "s", ""),
                argument("state", "s", "waiting, live, lost or disputed"),
                argument("why", "s", "empty while it is live"),
                argument("uncertainty", "f", "s, of the times of its events"),
            ];
            self.add(
                Direction::Out,
                "area",
                area,
                "How an area stands, when that changes; told by a gateway.",
            );
        }
        let device = vec![
            argument("device", "s", ""),
            argument("state", "s", "playing, lost, faulty or unfit"),
            argument("why", "s", "empty while it plays"),
            argument("channels", "i", ""),
            argument("sample_rate", "i", "Hz"),
            argument("block", "i", "frames"),
            argument("underruns", "i", ""),
            argument("reopened", "i", ""),
            argument("priority", "s", "real-time, denied or host"),
        ];
        self.add(Direction::Out, "device", device, "The device that moves the actuators, when that changes.");
        if layout.grounds.iter().any(|ground| matches!(ground.spec.material, Material::Ice(_))) {
            let mut crack =
                vec![argument("seed", "i", "where cracks come from"), argument("energy", "f", "J")];
            crack.extend(place());
            crack.push(argument("skipped", "i", "cracks since the last message that were not told"));
            self.add(Direction::Out, "crack", crack, "The ice has cracked; 200 times a second at most.");
        }
        let page = |range: &str| vec![argument("page", "s", range)];
        if !layout.pages.is_empty() {
            self.add(Direction::Out, "page", page(&pages(layout)), "Another page is shown.");
        }
        self.add(Direction::Answer, "page", page("empty without pages"), "The page that is shown.");
        let mute = || {
            let tiles = argument("tiles", "i", "column and row of each single tile, 100 at most");
            vec![argument("all", "i", "0 or 1"), tiles]
        };
        self.add(Direction::Out, "mute", mute(), "Something was muted, or no longer.");
        self.add(Direction::Answer, "mute", mute(), "The actuators that are muted.");
        let error = vec![argument("address", "s", "as it was asked"), argument("why", "s", "")];
        self.add(Direction::Answer, "error", error, "A request was refused.");
    }

    fn control(&mut self, widget: &Widget, layout: &Layout, floor: &Floor) {
        let id = widget.id.as_str();
        let mut control = Control::new(&widget.behaviour, widget.area.size());
        // An app cannot set a value that only a foot can hold.
        let settable = control.value().is_some_and(|value| control.set_value(value).is_ok());
        for command in COMMANDS.iter().filter(|command| command.is_of_a_control()) {
            let suits = match command.argument {
                ArgumentKind::Value => settable,
                ArgumentKind::Range => widget.behaviour.scale().is_some(),
                _ => true,
            };
            if suits {
                let arguments = taken(command, Some(widget), layout, &floor.geometry);
                self.add(Direction::In, &command.path_of(id), arguments, command.says);
            }
        }
        let held = control.value().map(|value| values(&widget.behaviour, value)).unwrap_or_default();
        for (name, what, says) in events(&widget.behaviour) {
            let mut arguments = match what {
                Carries::Nothing => Vec::new(),
                Carries::Value => held.clone(),
                Carries::Direction => vec![argument("direction", "s", "north, east, south or west")],
            };
            arguments.extend([
                argument("force", "f", "N"),
                argument("x", "f", "m, eastwards"),
                argument("y", "f", "m, northwards"),
            ]);
            self.add(Direction::Out, &format!("widget/{id}/{name}"), arguments, says);
        }
        let repeated = vec![argument("held", "i", "0 or 1"), argument("sequence", "i", "one more each time")];
        let says =
            "Whether a foot holds it; 1 comes 50 times a second: not heard for 100 ms, it is released.";
        self.add(Direction::Out, &format!("widget/{id}/held"), repeated, says);
        let flag = |name| argument(name, "i", "0 or 1");
        let state = vec![
            flag("enabled"),
            flag("locked"),
            flag("pressed"),
            flag("armed"),
            argument("indicator", "s", &indicators()),
            argument("label", "s", ""),
        ];
        let text = |name, range: &str| argument(name, "s", range);
        let reasons = OffReason::ALL.map(OffReason::name).join(", ");
        let off = vec![
            text("reason", &format!("{reasons}; empty if a foot can press it")),
            text("text", "the reason in a sentence, with the floor file it is about; may be empty"),
        ];
        let range = match (&widget.behaviour, held.as_slice()) {
            (Behaviour::Selector(_), _) => vec![text("choices", "the name of each")],
            (_, [Argument { tag: "f", .. }]) => {
                ["least", "greatest", "step"].map(|name| argument(name, "f", "")).into()
            }
            (_, [_, _]) => {
                ["x_least", "x_greatest", "y_least", "y_greatest"].map(|name| argument(name, "f", "")).into()
            }
            _ => Vec::new(),
        };
        let told = [
            ("value", held, "Its value; sent to all listeners when an app asks for it or changes it."),
            ("state", state, "How it is; told to all likewise."),
            (
                "off",
                off,
                "Why no foot can press it; told to all likewise, and when a `HoldToRun` control goes off or on.",
            ),
            ("range", range, "The range of its value."),
            ("page", vec![text("page", "empty if it is on all")], "Where it is."),
        ];
        for (name, arguments, says) in told.into_iter().filter(|(_, arguments, _)| !arguments.is_empty()) {
            let path = format!("widget/{id}/{name}");
            self.add(Direction::Answer, &path, arguments, says);
        }
    }
}

fn argument(name: &str, tag: &'static str, range: &str) -> Argument {
    Argument { name: name.into(), tag, range: range.into() }
}

/// Returns the arguments of a command; for a value, those of the control's value.
fn taken(command: &Command, widget: Option<&Widget>, layout: &Layout, geometry: &Geometry) -> Vec<Argument> {
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
fn values(behaviour: &Behaviour, held: Value) -> Vec<Argument> {
    let number = |name: &str, scale: Option<&Scale>| {
        argument(name, "f", &scale.map_or_else(|| "-1 to 1".to_owned(), range))
    };
    match (held, behaviour) {
        (Value::Switch(_), _) => vec![argument("on", "i", "0 or 1")],
        (Value::Choice(_), Behaviour::Selector(selector)) => {
            let options = selector.options.iter().enumerate();
            let options: Vec<String> =
                options.map(|(number, option)| format!("{number}: {option}")).collect();
            vec![argument("choice", "i", &options.join(", "))]
        }
        (Value::Choice(_), _) => vec![argument("choice", "i", "0 or more")],
        (Value::Number(_), Behaviour::Pedal(pedal)) => vec![number("value", Some(&pedal.scale))],
        (Value::Number(_), _) => vec![number("value", behaviour.scale())],
        (Value::Pair(_), Behaviour::Pad(pad)) => {
            vec![number("x_value", Some(&pad.x())), number("y_value", Some(&pad.y()))]
        }
        (Value::Pair(_), _) => vec![number("x_value", None), number("y_value", None)],
    }
}

fn range(scale: &Scale) -> String {
    let steps = if scale.step > 0.0 { format!(", steps of {}", scale.step) } else { String::new() };
    format!("{} to {}{steps}", scale.min, scale.max)
}

fn indicators() -> String {
    Indicator::ALL.map(Indicator::name).join(", ")
}

fn pages(layout: &Layout) -> String {
    let ids: Vec<&str> = layout.pages.iter().map(|page| page.id.as_str()).collect();
    ids.join(", ")
}

/// Content of an event besides force and place.
#[derive(Clone, Copy)]
enum Carries {
    Nothing,
    Value,
    Direction,
}

/// Returns the possible events of a control with this behaviour: name, content and meaning.
fn events(behaviour: &Behaviour) -> Vec<(&'static str, Carries, &'static str)> {
    use Carries::{Direction, Nothing, Value};
    let mut events = vec![
        ("pressed", Nothing, "A foot engaged it."),
        ("released", Nothing, "The foot let go; the press counts."),
        ("cancelled", Nothing, "The press ended without counting."),
        ("refused", Nothing, "A foot pressed it while it is locked."),
    ];
    match behaviour {
        Behaviour::Button(button) => {
            let when = match button.acts_on {
                ActsOn::Press => "It was pressed.",
                ActsOn::Release => "It was pressed and released.",
            };
            events.push(("clicked", Nothing, when));
            let gestures = &button.gestures;
            let mut offer = |offered: bool, event| {
                if offered {
                    events.push(event);
                }
            };
            offer(gestures.double_tap.is_some(), ("double_tapped", Nothing, "It was tapped twice."));
            offer(gestures.long_press.is_some(), ("long_pressed", Nothing, "It has been held for long."));
            offer(gestures.swipe_m.is_some(), ("swiped", Direction, "The foot swiped over it."));
            offer(gestures.hard.is_some(), ("hard_pressed", Nothing, "The press reached the second stage."));
            offer(gestures.hard.is_some(), ("hard_released", Nothing, "It came back from the second stage."));
        }
        Behaviour::Selector(_) => {
            events.push(("ticked", Nothing, "The foot passed to another option; nothing has changed yet."));
            events.push(("changed", Value, "It holds another value."));
        }
        Behaviour::Hold(_)
        | Behaviour::Switch(_)
        | Behaviour::Slider(_)
        | Behaviour::Pedal(_)
        | Behaviour::Pad(_)
        | Behaviour::Dial(_)
        | Behaviour::Stepper(_)
        | Behaviour::Lean(_) => events.push(("changed", Value, "It holds another value.")),
    }
    match behaviour.thresholds().guard {
        Guard::Free => {}
        Guard::Confirm { .. } => {
            events.push(("armed", Nothing, "A first press armed it: the next one acts."));
            events.push(("disarmed", Nothing, "It is armed no longer."));
        }
        Guard::HoldToRun { .. } => events.push(("warned", Nothing, "It will soon stop by itself.")),
    }
    events
}
