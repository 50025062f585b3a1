//! Messages of floors in OSC. The encoder, the reference and the decoder share one table.
//!
//! A message of the table is a struct: its fields are the arguments of the message, in order. The encoder can only
//! send the struct, and the reference lists its fields.

mod messages;
mod values;

use rosc::{OscMessage, OscPacket, OscType};

use self::messages::PATHS;
pub(crate) use self::messages::{
    Alive, Area, Contacts, Crack, Device, Error, Health, Held, Ignored, Mute, Off, OneContact, Page,
    PageOfControl, RangeOfChoices, RangeOfNumber, RangeOfPair, State, ValueOfControl,
};
pub(crate) use self::values::{Place, arguments_of_detail, arguments_of_value};
use super::prefix::Prefix;
use crate::widget::{Direction, EventKind, Value, WidgetId};

/// The placeholder of a control's id in an address.
const ID: &str = "<id>";

/// One argument of a message.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    pub(crate) name: &'static str,
    /// Its OSC type tag.
    pub(crate) tag: &'static str,
    pub(crate) range: FieldRange,
}

/// The unit, range or choices of an argument.
#[derive(Clone, Copy, Debug)]
pub(crate) enum FieldRange {
    /// This sentence; may be empty.
    Text(&'static str),
    /// A unit, and more about it, which may be empty.
    Measure(&'static str, &'static str),
    /// 0 or 1.
    Flag,
    /// One of these words.
    Words(&'static [&'static str]),
    /// Those of the control's value.
    OfValue,
    /// The states of a lamp.
    Indicators,
    /// The reasons why a control is off.
    OffReasons,
    /// The reasons why a control ignored a press.
    IgnoredReasons,
    /// The pages of the layout.
    Pages,
}

/// Arguments in a fixed order.
pub(crate) trait Arguments {
    /// Their names, tags and ranges, in order.
    const FIELDS: &'static [Field];

    /// Appends them to `args`, in the same order.
    fn append(self, args: &mut Vec<OscType>);
}

/// A message that floors send.
pub(crate) trait Sent: Arguments + Sized {
    /// The address behind the prefix; `<id>` stands for a control's id.
    const PATH: &'static str;
    /// Its meaning as a report to all listeners; empty if it only answers.
    const REPORT: &'static str;
    /// Its meaning as an answer to a request; empty if it answers none.
    const ANSWER: &'static str;

    /// The message about the whole floor.
    fn packet(self, prefix: &Prefix) -> OscPacket {
        message(prefix.address(Self::PATH), self)
    }

    /// The message about the control with this `id`.
    fn packet_of(self, prefix: &Prefix, id: &WidgetId) -> OscPacket {
        message(prefix.address(&path_of::<Self>(&address_part(id))), self)
    }
}

/// Returns the address, behind the prefix, of this message about the control `id`.
pub(crate) fn path_of<T: Sent>(id: &str) -> String {
    T::PATH.replace(ID, id)
}

/// The message about an event of this `kind`: the value or direction of the event, then force and place.
pub(crate) fn event_packet(prefix: &Prefix, id: &WidgetId, kind: EventKind, place: Place) -> OscPacket {
    let mut args = Vec::with_capacity(5);
    if let Some(detail) = kind.detail() {
        arguments_of_detail(detail, &mut args);
    }
    place.append(&mut args);
    let addr = prefix.address(&event_path(&address_part(id), kind));
    OscPacket::Message(OscMessage { addr, args })
}

/// Returns the address, behind the prefix, of an event of this `kind` at the control `id`.
pub(crate) fn event_path(id: &str, kind: EventKind) -> String {
    format!("widget/{id}/{}", kind.name())
}

fn message(addr: String, content: impl Arguments) -> OscPacket {
    let mut args = Vec::new();
    content.append(&mut args);
    OscPacket::Message(OscMessage { addr, args })
}

/// Returns the id with `_` in the place of characters that are invalid in OSC addresses.
fn address_part(id: &WidgetId) -> String {
    let fits = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '+' | ':');
    id.as_str().chars().map(|c| if fits(c) { c } else { '_' }).collect()
}

/// Whether a floor itself sends this address, behind its prefix: an answer to it could cause an endless exchange.
pub(super) fn is_sent_by_floors(path: &str) -> bool {
    let mut paths = PATHS.iter().copied();
    let Some((first, rest)) = path.split_once('/') else { return paths.any(|sent| sent == path) };
    let last = rest.rsplit('/').next().unwrap_or(rest);
    let details = [EventKind::Changed(Value::Switch(false)), EventKind::Swiped(Direction::North)];
    let mut events = EventKind::PLAIN.into_iter().chain(details).map(EventKind::name);
    first == "widget"
        && (events.any(|event| event == last)
            || paths.any(|sent| sent.strip_prefix("widget/<id>/").is_some_and(|sent| sent == last)))
}

/// A part of the arguments of a message.
trait Append {
    fn append(self, args: &mut Vec<OscType>);
}

/// One argument, or several of one type.
trait Argument: Append {
    /// Its OSC type tag.
    const TAG: &'static str;
}

impl Argument for i32 {
    const TAG: &'static str = "i";
}

impl Append for i32 {
    fn append(self, args: &mut Vec<OscType>) {
        args.push(OscType::Int(self));
    }
}

impl Argument for bool {
    const TAG: &'static str = i32::TAG;
}

/// As 0 or 1: some receivers cannot read OSC's true and false.
impl Append for bool {
    fn append(self, args: &mut Vec<OscType>) {
        i32::from(self).append(args);
    }
}

impl Argument for f32 {
    const TAG: &'static str = "f";
}

impl Append for f32 {
    fn append(self, args: &mut Vec<OscType>) {
        args.push(OscType::Float(self));
    }
}

impl Argument for String {
    const TAG: &'static str = "s";
}

impl Append for String {
    fn append(self, args: &mut Vec<OscType>) {
        args.push(OscType::String(self));
    }
}

impl<T: Argument> Argument for Vec<T> {
    const TAG: &'static str = T::TAG;
}

impl<T: Append> Append for Vec<T> {
    fn append(self, args: &mut Vec<OscType>) {
        self.into_iter().for_each(|each| each.append(args));
    }
}

/// Makes structs of arguments: `Name { name: type = range, ... }`. A last field `..name: type` appends arguments that
/// vary, and is not among the listed ones.
macro_rules! arguments {
    ($($(#[$meta:meta])* $name:ident {
        $($field:ident: $type:ty = $range:expr,)*
        $(..$rest:ident: $rest_type:ty)?
    })+) => { $(
        $(#[$meta])*
        pub(crate) struct $name {
            $(pub(crate) $field: $type,)*
            $(pub(crate) $rest: $rest_type,)?
        }

        impl $crate::wire::sent::Arguments for $name {
            const FIELDS: &'static [$crate::wire::sent::Field] = &[$($crate::wire::sent::Field {
                name: stringify!($field),
                tag: <$type as $crate::wire::sent::Argument>::TAG,
                range: $range,
            },)*];

            fn append(self, args: &mut Vec<rosc::OscType>) {
                $($crate::wire::sent::Append::append(self.$field, args);)*
                $($crate::wire::sent::Append::append(self.$rest, args);)?
            }
        }
    )+ };
}
use arguments;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors_send_their_reports_and_the_events_of_controls() {
        for sent in [
            "alive",
            "mute",
            "widget/zoom/pressed",
            "widget/zoom/swiped",
            "widget/zoom/held",
            "widget/zoom/off",
            "area",
        ] {
            assert!(is_sent_by_floors(sent), "{sent}");
        }
        for other in ["get", "widget", "widget/zoom/set", "mute/set", "layout/zoom/pressed"] {
            assert!(!is_sent_by_floors(other), "{other}");
        }
    }
}
