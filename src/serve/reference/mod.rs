//! Every OSC address of a floor with a layout, in and out, made from the tables of the decoder and the encoder.

mod arguments;
mod limits;

use serde::Serialize;

use self::arguments::{argument, pages, taken, values};
pub use self::limits::ArgumentLimits;
use self::limits::DescribedLimits;
use crate::engine::Ignored;
use crate::floor::Floor;
use crate::ground::GroundMaterial;
use crate::layout::{Layout, Region, Widget};
use crate::widget::{Behaviour, Control, Detail, OffReason, possible_events};
use crate::wire::sent::{self, Arguments, Field, FieldRange, Sent};
use crate::wire::{ArgumentKind, COMMANDS, Prefix};

/// Direction of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MessageDirection {
    /// To the floor's own port.
    In,
    /// From the floor to its listeners.
    Out,
    /// From the floor to the program that asked.
    Answer,
    /// From a control to a target of its layout.
    Target,
}

/// One argument.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Argument {
    /// Its name.
    pub name: String,
    /// Its OSC type tag; `|` separates several accepted tags.
    pub tag: &'static str,
    /// Its unit, range or choices, for people; may be empty.
    pub range: String,
    /// Its unit; empty without one.
    #[serde(skip)]
    pub unit: &'static str,
    /// Its range or choices, for programs.
    #[serde(skip)]
    pub limits: ArgumentLimits,
}

/// One address.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AddressEntry {
    /// Direction of its messages.
    pub direction: MessageDirection,
    /// The address as it stands in messages.
    pub address: String,
    /// Its arguments, in order.
    pub arguments: Vec<Argument>,
    /// Its meaning, in a sentence.
    pub says: String,
}

/// All addresses of one floor, those of the floor first, then control by control.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Reference {
    /// The addresses.
    pub entries: Vec<AddressEntry>,
}

impl Reference {
    /// The addresses of `layout` on `floor`, beginning with `prefix` apart from those of the boards.
    #[must_use]
    pub fn of(layout: &Layout, floor: &Floor, prefix: &Prefix) -> Self {
        let mut maker = Maker { prefix, layout, floor, entries: Vec::new() };
        maker.boards();
        maker.floor();
        for widget in &layout.widgets {
            maker.control(widget);
        }
        layout.regions.iter().for_each(|region| maker.region(region));
        Self { entries: maker.entries }
    }
}

struct Maker<'a> {
    prefix: &'a Prefix,
    layout: &'a Layout,
    floor: &'a Floor,
    entries: Vec<AddressEntry>,
}

impl Maker<'_> {
    fn add(&mut self, direction: MessageDirection, path: &str, arguments: Vec<Argument>, says: &str) {
        let address = self.prefix.address(path);
        self.entries.push(AddressEntry { direction, address, arguments, says: says.into() });
    }

    /// Adds a message that goes to all listeners.
    fn report<T: Sent>(&mut self) {
        self.add(MessageDirection::Out, T::PATH, self.listed(T::FIELDS, MessageDirection::Out), T::REPORT);
    }

    /// Adds a message that answers a request.
    fn answer<T: Sent>(&mut self) {
        self.add(
            MessageDirection::Answer,
            T::PATH,
            self.listed(T::FIELDS, MessageDirection::Answer),
            T::ANSWER,
        );
    }

    /// Adds a message about the control `id` that answers a request.
    fn answer_of<T: Sent>(&mut self, id: &str) {
        let arguments = self.listed(T::FIELDS, MessageDirection::Answer);
        self.add(MessageDirection::Answer, &sent::path_of::<T>(id), arguments, T::ANSWER);
    }

    fn listed(&self, fields: &[Field], direction: MessageDirection) -> Vec<Argument> {
        let limits = |field: &Field| match field.range {
            FieldRange::OffReasons => {
                let limits = DescribedLimits::words(OffReason::ALL.map(OffReason::name));
                let text = format!("{}; empty if a foot can press it", limits.text);
                DescribedLimits { text, ..limits }
            }
            FieldRange::IgnoredReasons => DescribedLimits::words(Ignored::all().map(Ignored::name)),
            FieldRange::Pages if direction == MessageDirection::Answer => {
                DescribedLimits { text: "empty without pages".into(), ..pages(self.layout) }
            }
            FieldRange::Pages => pages(self.layout),
            table => DescribedLimits::of_table(table).unwrap_or_default(),
        };
        fields.iter().map(|field| argument(field.name, field.tag, limits(field))).collect()
    }

    fn boards(&mut self) {
        for (number, board) in self.floor.boards.iter().enumerate() {
            let channels = board.channels.len();
            let arguments = vec![
                argument("sequence", "i", DescribedLimits::text("counts packets, wraps")),
                argument(
                    "readings",
                    "i|f|b",
                    DescribedLimits::text(format!(
                        "{channels} counts 0 to 65535, {channels} newtons, or one blob of 16-bit counts"
                    )),
                ),
            ];
            let says = format!("Readings of board {number}, once a millisecond.");
            let address = board.address.clone();
            self.entries.push(AddressEntry { direction: MessageDirection::In, address, arguments, says });
        }
    }

    fn floor(&mut self) {
        let (layout, floor) = (self.layout, self.floor);
        for command in COMMANDS.iter().filter(|command| !command.is_of_a_control()) {
            // A layout without pages has none to show.
            if command.argument != ArgumentKind::Page || !layout.pages.is_empty() {
                let arguments = taken(command, None, layout, floor);
                self.add(MessageDirection::In, command.path, arguments, command.says);
            }
        }
        self.report::<sent::Contacts>();
        self.report::<sent::OneContact>();
        self.report::<sent::Alive>();
        self.report::<sent::Health>();
        if !floor.areas.is_empty() {
            self.report::<sent::Area>();
        }
        self.report::<sent::Device>();
        if layout.grounds.iter().any(|ground| matches!(ground.spec.material, GroundMaterial::Ice(_))) {
            self.report::<sent::Crack>();
        }
        if !layout.pages.is_empty() {
            self.report::<sent::Page>();
        }
        self.answer::<sent::Page>();
        self.report::<sent::Mute>();
        self.answer::<sent::Mute>();
        self.answer::<sent::Error>();
    }

    fn region(&mut self, region: &Region) {
        for sending in &region.send {
            self.entries.push(AddressEntry {
                direction: MessageDirection::Target,
                address: format!("{}: {}", sending.target, sending.payload),
                arguments: Vec::new(),
                says: format!(
                    "The feet on free floor of {} send it, from {} N on.",
                    region.id, sending.press_n
                ),
            });
        }
    }

    fn control(&mut self, widget: &Widget) {
        let (layout, floor, id) = (self.layout, self.floor, widget.id.as_str());
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
                let arguments = taken(command, Some(widget), layout, floor);
                self.add(MessageDirection::In, &command.path_of(id), arguments, command.says);
            }
        }
        let held = control.value().map(|value| values(&widget.behaviour, value)).unwrap_or_default();
        for (kind, says) in possible_events(&widget.behaviour, control.value()) {
            let mut arguments = match kind.detail() {
                None => Vec::new(),
                Some(Detail::Value(_)) => held.clone(),
                Some(detail) => {
                    let fields = sent::arguments_of_detail(detail, &mut Vec::new());
                    self.listed(fields, MessageDirection::Out)
                }
            };
            arguments.extend(self.listed(sent::Place::FIELDS, MessageDirection::Out));
            self.add(MessageDirection::Out, &sent::event_path(id, kind), arguments, says);
        }
        let repeated = self.listed(sent::Held::FIELDS, MessageDirection::Out);
        self.add(MessageDirection::Out, &sent::path_of::<sent::Held>(id), repeated, sent::Held::REPORT);
        let ignored = self.listed(sent::Ignored::FIELDS, MessageDirection::Out);
        self.add(MessageDirection::Out, &sent::path_of::<sent::Ignored>(id), ignored, sent::Ignored::REPORT);
        if !held.is_empty() {
            let path = sent::path_of::<sent::ValueOfControl>(id);
            self.add(MessageDirection::Answer, &path, held.clone(), sent::ValueOfControl::ANSWER);
        }
        self.answer_of::<sent::State>(id);
        self.answer_of::<sent::Off>(id);
        match (&widget.behaviour, held.as_slice()) {
            (Behaviour::Selector(_), _) => self.answer_of::<sent::RangeOfChoices>(id),
            (_, [Argument { tag: "f", .. }]) => self.answer_of::<sent::RangeOfNumber>(id),
            (_, [_, _]) => self.answer_of::<sent::RangeOfPair>(id),
            _ => {}
        }
        self.answer_of::<sent::PageOfControl>(id);
        for sending in &widget.send {
            self.entries.push(AddressEntry {
                direction: MessageDirection::Target,
                address: format!("{}: {}", sending.target, sending.payload),
                arguments: Vec::new(),
                says: format!("{id} sends it {}.", sending.when),
            });
        }
    }
}
