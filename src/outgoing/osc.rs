//! OSC messages for events, contacts and states.

use rosc::{OscBundle, OscPacket, OscTime};

use crate::engine::{ControlState, IgnoredPress, ValueRange};
use crate::feel::{DeviceStatus, Muted};
use crate::sense::{Contact, SensorHealth};
use crate::widget::{WidgetEvent, WidgetId};
use crate::wire::sent::{self, Sent};
use crate::wire::{LinkCause, LinkState, Prefix, write};

/// Maximum number of contacts in one datagram: it stays below 1500 bytes, the size that every network carries
/// unfragmented.
const CONTACTS_PER_DATAGRAM: usize = 20;

/// Writes one event as an OSC message into `bytes`, replacing their contents.
///
/// The address is `/underfoot/widget/<id>/<kind>`, with `prefix` at its beginning. For `changed` the value comes
/// first: a float for a number, two floats for a pair, the index of a choice (int), or 0 or 1 (int) for off or on,
/// since some receivers cannot read OSC's true and false; for `swiped` the direction (string). Then always force
/// (newtons), x and y (floor metres), as floats. Characters of the id that are invalid in OSC addresses are written
/// as `_`.
pub fn write_event(prefix: &Prefix, event: &WidgetEvent, bytes: &mut Vec<u8>) {
    let place = sent::Place { force: event.force.0, x: event.position.x, y: event.position.y };
    write(&sent::event_packet(prefix, &event.id, event.kind, place), bytes);
}

/// Writes a press that a control ignored as the OSC message `/underfoot/widget/<id>/ignored`.
///
/// The reason as a word ([`crate::engine::Ignored::name`]) and as a sentence (strings), then the greatest force
/// (newtons, float) and the number of the contact (int; the greatest one for a larger number).
pub fn write_ignored(prefix: &Prefix, press: &IgnoredPress, bytes: &mut Vec<u8>) {
    let message = sent::Ignored {
        reason: press.why.name().into(),
        text: press.why.to_string(),
        force: press.force.0,
        contact: i32::try_from(press.contact.0).unwrap_or(i32::MAX),
    };
    write(&message.packet_of(prefix, &press.id), bytes);
}

/// Writes the contacts of one instant as OSC bundles and passes each datagram to `send`.
///
/// Each datagram starts with `/underfoot/contacts <count>`, the number of all contacts, followed by one
/// `/underfoot/contact` per contact: id (int), then x, y (floor metres), force (newtons), and velocity x, y (metres
/// per second) as floats. A receiver drops contacts that are no longer reported, at the latest when the count is 0.
/// More than 20 contacts take several datagrams.
pub fn write_contacts(
    prefix: &Prefix,
    contacts: &[Contact],
    bytes: &mut Vec<u8>,
    mut send: impl FnMut(&[u8]),
) {
    let count = i32::try_from(contacts.len()).unwrap_or(i32::MAX);
    let mut rest = contacts;
    loop {
        let (now, later) = rest.split_at(rest.len().min(CONTACTS_PER_DATAGRAM));
        let mut content = vec![sent::Contacts { count }.packet(prefix)];
        content.extend(now.iter().map(|each| contact(prefix, each)));
        write(&at_once(content), bytes);
        send(bytes);
        rest = later;
        if rest.is_empty() {
            return;
        }
    }
}

/// Maximum number of sensors in one message.
const NAMED_SENSORS: usize = 8;

/// Maximum number of tiles in one message: it stays below 1500 bytes.
const NAMED_TILES: usize = 100;

/// Writes the health of the floor as the OSC message `/underfoot/health`.
///
/// First the state of its link, a string: `waiting`, `live`, `partial` or `lost`. Then four numbers of sensors
/// (ints): degraded, silent, faulty, and uncalibrated. Then, if boards send and no frame is usable, the cause, a
/// string (`link: rate_low: board 0 sends 12 packets a second ...`). Then the sensors in trouble, a string each
/// (`tile (2, 1) sw: stuck`), eight at most.
pub fn write_health(
    prefix: &Prefix,
    state: LinkState,
    cause: Option<&LinkCause>,
    health: &SensorHealth,
    bytes: &mut Vec<u8>,
) {
    let SensorHealth { counts: [_, degraded, stale, faulty], uncalibrated, troubles, .. } = health;
    let mut details: Vec<String> =
        cause.map(|cause| format!("link: {}: {cause}", cause.name())).into_iter().collect();
    let named = troubles.iter().take(NAMED_SENSORS);
    details.extend(named.map(|(sensor, trouble)| format!("{sensor}: {trouble}")));
    let message = sent::Health {
        state: state.name().into(),
        degraded: degraded.cast_signed(),
        silent: stale.cast_signed(),
        faulty: faulty.cast_signed(),
        uncalibrated: uncalibrated.cast_signed(),
        details,
    };
    write(&message.packet(prefix), bytes);
}

/// Writes the state of the device that drives the actuators as the OSC message `/underfoot/device`.
///
/// Its name, its state (`playing`, `lost`, `faulty` or `unfit`) and the reason why it does not play (strings, the
/// last one empty while it plays); then channels, samples per second, frames in a block, underruns so far, and number
/// of reopenings (ints); then its priority: `real-time`, `denied`, or `host` if its host sets it.
pub fn write_device(prefix: &Prefix, status: &DeviceStatus, bytes: &mut Vec<u8>) {
    let int = |count: u64| i32::try_from(count).unwrap_or(i32::MAX);
    let message = sent::Device {
        device: status.name.clone(),
        state: status.state.name().into(),
        why: status.why.clone(),
        channels: int(status.channels.into()),
        sample_rate: int(status.sample_rate.into()),
        block: int(status.block.into()),
        underruns: int(status.underruns),
        reopened: int(status.reopened),
        priority: status.priority.name().into(),
    };
    write(&message.packet(prefix), bytes);
}

/// Writes a crack of the ice as the OSC message `/underfoot/crack`.
///
/// First the seed of the cracks (int), then energy (joules) and x and y (floor metres) as floats, then the number of
/// cracks without a message since the last one (int).
pub fn write_crack(
    prefix: &Prefix,
    seed: u32,
    energy_and_place: [f32; 3],
    skipped: u32,
    bytes: &mut Vec<u8>,
) {
    let int = |number: u32| number.min(i32::MAX as u32).cast_signed();
    let [energy, x, y] = energy_and_place;
    let message = sent::Crack { seed: int(seed), energy, x, y, skipped: int(skipped) };
    write(&message.packet(prefix), bytes);
}

/// Writes the shown page as the OSC message `/underfoot/page` with one string; empty in a layout without pages.
pub fn write_page(prefix: &Prefix, page: &str, bytes: &mut Vec<u8>) {
    write(&sent::Page { page: page.into() }.packet(prefix), bytes);
}

/// Writes the mute state as the OSC message `/underfoot/mute`.
///
/// First whether everything is muted (int, 0 or 1), then column and row of each muted tile (ints), 100 tiles at most.
pub fn write_mute(prefix: &Prefix, muted: &Muted, bytes: &mut Vec<u8>) {
    let places = muted.tiles.iter().take(NAMED_TILES).flat_map(|tile| [tile.column, tile.row]);
    let message = sent::Mute { all: muted.all, tiles: places.map(i32::from).collect() };
    write(&message.packet(prefix), bytes);
}

/// Writes the reason for rejecting a request as the OSC message `/underfoot/error`: the request's address, and a
/// sentence.
pub fn write_error(prefix: &Prefix, address: &str, why: &str, bytes: &mut Vec<u8>) {
    write(&sent::Error { address: address.into(), why: why.into() }.packet(prefix), bytes);
}

/// Writes the state of a control as an OSC bundle.
///
/// `/underfoot/widget/<id>/value` with its value, if any, as in `changed`; `/state` with enabled, locked, pressed,
/// armed (ints, 0 or 1), indicator and label (strings); `/off` with the reason why feet cannot press it, a word
/// ([`crate::widget::OffReason::name`]) and a sentence, both empty if they can; `/range` with minimum, maximum and
/// step of a number, minimum and maximum of both numbers of a pair (floats), or the names of the choices (strings);
/// `/page` with its page, empty if it is on all pages.
pub fn write_control(prefix: &Prefix, state: &ControlState, bytes: &mut Vec<u8>) {
    let ControlState { id, value, range, enabled, off, locked, pressed, armed, indicator, label, page } =
        state;
    let mut content = Vec::new();
    if let Some(value) = *value {
        content.push(sent::ValueOfControl { value }.packet_of(prefix, id));
    }
    let state = sent::State {
        enabled: *enabled,
        locked: *locked,
        pressed: *pressed,
        armed: *armed,
        indicator: indicator.name().into(),
        label: label.clone(),
    };
    content.push(state.packet_of(prefix, id));
    let [reason, text] = off.as_ref().map_or([""; 2], |off| [off.reason.name(), &off.text]).map(String::from);
    content.push(sent::Off { reason, text }.packet_of(prefix, id));
    content.extend(range.as_ref().map(|range| range_packet(prefix, id, range)));
    let page = page.as_ref().map_or("", WidgetId::as_str).into();
    content.push(sent::PageOfControl { page }.packet_of(prefix, id));
    write(&at_once(content), bytes);
}

fn range_packet(prefix: &Prefix, id: &WidgetId, range: &ValueRange) -> OscPacket {
    match range {
        ValueRange::Number(scale) => {
            sent::RangeOfNumber { least: scale.min, greatest: scale.max, step: scale.step }
                .packet_of(prefix, id)
        }
        ValueRange::Pair(x, y) => {
            sent::RangeOfPair { x_least: x.min, x_greatest: x.max, y_least: y.min, y_greatest: y.max }
                .packet_of(prefix, id)
        }
        ValueRange::Choices(choices) => {
            sent::RangeOfChoices { choices: choices.to_vec() }.packet_of(prefix, id)
        }
    }
}

/// Puts these messages into one datagram.
pub(super) fn at_once(content: Vec<OscPacket>) -> OscPacket {
    // This time tag means "at once".
    OscPacket::Bundle(OscBundle { timetag: OscTime { seconds: 0, fractional: 1 }, content })
}

fn contact(prefix: &Prefix, contact: &Contact) -> OscPacket {
    let message = sent::OneContact {
        id: contact.id.0.cast_signed(),
        x: contact.centroid.x,
        y: contact.centroid.y,
        force: contact.force.0,
        x_velocity: contact.velocity.x,
        y_velocity: contact.velocity.y,
    };
    message.packet(prefix)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use rosc::{OscMessage, OscType};

    use super::*;
    use crate::engine::Ignored;
    use crate::floor::{Corner, SensorId, TileId};
    use crate::sense::Trouble;
    use crate::sense::{ContactId, Covariance, Quality, TileLoad};
    use crate::units::{Instant, Newtons};
    use crate::widget::{Direction, EventKind, Value};
    use crate::wire::{DatagramLimits, check};

    fn event(kind: EventKind) -> WidgetEvent {
        WidgetEvent {
            at: Instant::from_millis(12),
            id: WidgetId::new("zoom"),
            kind,
            contact: Some(ContactId(3)),
            force: Newtons(120.0),
            position: Vec2::new(0.5, 1.25),
        }
    }

    fn message(addr: String, args: Vec<OscType>) -> OscPacket {
        OscPacket::Message(OscMessage { addr, args })
    }

    fn decoded(bytes: &[u8]) -> OscPacket {
        assert_eq!(check(bytes, &DatagramLimits::default()), Ok(()));
        rosc::decoder::decode_udp(bytes).unwrap().1
    }

    fn event_message(event: &WidgetEvent) -> (String, Vec<OscType>) {
        let mut bytes = vec![1, 2, 3];
        write_event(&Prefix::default(), event, &mut bytes);
        let OscPacket::Message(message) = decoded(&bytes) else { panic!("not a message") };
        (message.addr, message.args)
    }

    #[test]
    fn events_carry_value_force_and_place() {
        let place = [120.0, 0.5, 1.25].map(OscType::Float);
        let (address, args) = event_message(&event(EventKind::Pressed));
        assert_eq!((address.as_str(), args), ("/underfoot/widget/zoom/pressed", place.to_vec()));
        let (address, args) = event_message(&event(EventKind::Changed(Value::Number(0.25))));
        assert_eq!(address, "/underfoot/widget/zoom/changed");
        assert_eq!(args, [&[OscType::Float(0.25)], &place[..]].concat());
        let (_, args) = event_message(&event(EventKind::Changed(Value::Switch(true))));
        assert_eq!(args[0], OscType::Int(1));
        let (_, args) = event_message(&event(EventKind::Changed(Value::Choice(2))));
        assert_eq!(args[0], OscType::Int(2));
        let pair = Value::Pair(Vec2::new(-0.5, 0.25));
        let (_, args) = event_message(&event(EventKind::Changed(pair)));
        assert_eq!(args, [&[-0.5, 0.25].map(OscType::Float)[..], &place[..]].concat());
        let (address, args) = event_message(&event(EventKind::Swiped(Direction::West)));
        assert_eq!(address, "/underfoot/widget/zoom/swiped");
        assert_eq!(args, [&[OscType::String("west".into())], &place[..]].concat());
    }

    #[test]
    fn an_ignored_press_is_a_word_a_sentence_a_force_and_a_foot() {
        let mut bytes = Vec::new();
        let press = IgnoredPress {
            at: Instant::from_millis(12),
            id: WidgetId::new("zoom"),
            contact: ContactId(7),
            force: Newtons(24.0),
            why: Ignored::TooLight,
        };
        write_ignored(&Prefix::default(), &press, &mut bytes);
        let words = ["too_light", "too light"].map(|text| OscType::String(text.into()));
        let args = [&words[..], &[OscType::Float(24.0), OscType::Int(7)]].concat();
        assert_eq!(decoded(&bytes), message("/underfoot/widget/zoom/ignored".into(), args));
    }

    #[test]
    fn ids_cannot_break_an_address() {
        let id = WidgetId::new("a/b c#ä\0d");
        let (address, _) = event_message(&WidgetEvent { id, ..event(EventKind::Clicked) });
        assert_eq!(address, "/underfoot/widget/a_b_c___d/clicked");
    }

    fn feet(count: u32) -> Vec<Contact> {
        let load = TileLoad { tile: TileId::new(0, 0), index: 0, force: Newtons(1.0), centroid: Vec2::ZERO };
        let foot = |id| Contact {
            id: ContactId(id),
            centroid: Vec2::new(0.1, 0.2),
            force: Newtons(350.0),
            velocity: Vec2::new(0.0, -1.0),
            tiles: [load].into_iter().collect(),
            covariance: Covariance::isotropic(0.003),
            ambiguous: false,
            split: false,
            quality: Quality::Live,
            difference: None,
        };
        (0..count).map(foot).collect()
    }

    #[test]
    fn contacts_travel_with_their_number_in_datagrams_below_1500_bytes() {
        for count in [0, 1, 20, 21, 100] {
            let mut ids = Vec::new();
            let mut datagrams = 0;
            write_contacts(&Prefix::default(), &feet(count), &mut Vec::new(), |bytes| {
                datagrams += 1;
                assert!(bytes.len() < 1400, "{}", bytes.len());
                let OscPacket::Bundle(bundle) = decoded(bytes) else { panic!("not a bundle") };
                for (place, element) in bundle.content.into_iter().enumerate() {
                    let OscPacket::Message(message) = element else { panic!("not a message") };
                    if place == 0 {
                        assert_eq!(message.addr, "/underfoot/contacts");
                        assert_eq!(message.args, [OscType::Int(count as i32)]);
                    } else {
                        assert_eq!(message.addr, "/underfoot/contact");
                        assert_eq!(message.args[1..], [0.1, 0.2, 350.0, 0.0, -1.0].map(OscType::Float));
                        ids.push(message.args[0].clone());
                    }
                }
            });
            assert_eq!(ids, (0..count as i32).map(OscType::Int).collect::<Vec<_>>());
            assert_eq!(datagrams, count.div_ceil(20).max(1));
        }
    }

    #[test]
    fn health_is_the_links_state_four_numbers_and_a_few_sensors() {
        let mut bytes = Vec::new();
        let sensor = |column| SensorId { tile: TileId::new(column, 1), corner: Corner::SouthWest };
        let troubles = (0..20).map(|column| (sensor(column), Trouble::Stuck)).collect();
        let health =
            SensorHealth { counts: [120, 3, 1, 20], uncalibrated: 2, troubles, ..SensorHealth::default() };
        write_health(&Prefix::default(), LinkState::Partial, None, &health, &mut bytes);
        let mut args = vec![OscType::String("partial".into())];
        args.extend([3, 1, 20, 2].map(OscType::Int));
        args.extend((0..8).map(|column| OscType::String(format!("tile ({column}, 1) sw: stuck"))));
        assert_eq!(decoded(&bytes), message("/underfoot/health".into(), args.clone()));
        let cause = LinkCause::SequenceFalls { board: 2 };
        write_health(&Prefix::default(), LinkState::Partial, Some(&cause), &health, &mut bytes);
        args.insert(5, OscType::String(format!("link: sequence_falls: {cause}")));
        assert_eq!(decoded(&bytes), message("/underfoot/health".into(), args));
    }

    #[test]
    fn what_is_muted_is_a_flag_and_tiles_by_column_and_row() {
        let mut bytes = Vec::new();
        let mut muted = Muted { all: false, tiles: vec![TileId::new(2, 1), TileId::new(5, 5)] };
        write_mute(&Prefix::default(), &muted, &mut bytes);
        let args = [0, 2, 1, 5, 5].map(OscType::Int);
        assert_eq!(decoded(&bytes), message("/underfoot/mute".into(), args.into()));
        // All tiles of a floor of 32 x 32 tiles.
        muted.tiles = (0..1024).map(|n| TileId::new(n % 32, n / 32)).collect();
        write_mute(&Prefix::default(), &muted, &mut bytes);
        assert!(bytes.len() < 1400, "{}", bytes.len());
    }

    #[test]
    fn a_device_is_its_name_its_state_and_five_numbers() {
        use crate::feel::{DeviceState, Priority};
        let mut bytes = Vec::new();
        let status = DeviceStatus {
            name: "Card".into(),
            state: DeviceState::Lost,
            why: "unplugged".into(),
            channels: 36,
            sample_rate: 96_000,
            block: 64,
            underruns: u64::MAX,
            priority: Priority::Denied,
            ..DeviceStatus::default()
        };
        write_device(&Prefix::default(), &status, &mut bytes);
        let mut args: Vec<_> = ["Card", "lost", "unplugged"].map(|text| OscType::String(text.into())).into();
        args.extend([36, 96_000, 64, i32::MAX, 0].map(OscType::Int));
        args.push(OscType::String("denied".into()));
        assert_eq!(decoded(&bytes), message("/underfoot/device".into(), args));
    }
}
