//! The structs of `underfoot.h`, byte for byte.

use std::ffi::c_char;

use underfoot::runtime::{Event, Kind};
use underfoot::sense::Contact;
use underfoot::widget::{Direction, EventKind, Value};

/// Bytes of an id with the closing 0: `UF_ID_SIZE`.
pub(crate) const ID_SIZE: usize = 128;
/// `UF_NAME_SIZE`.
const NAME_SIZE: usize = 24;
/// `UF_TEXT_SIZE`.
const TEXT_SIZE: usize = 256;

/// `uf_options`.
#[repr(C)]
#[derive(Debug)]
pub struct UfOptions {
    pub(crate) size: u32,
    pub(crate) every_change: u32,
    pub(crate) floor_path: *const c_char,
}

/// `uf_event`.
#[repr(C)]
#[derive(Debug)]
pub struct UfEvent {
    pub(crate) size: u32,
    kind: u32,
    t_s: f64,
    id: [c_char; ID_SIZE],
    name: [c_char; NAME_SIZE],
    text: [c_char; TEXT_SIZE],
    value_type: u32,
    value: [f32; 2],
    force_n: f32,
    x_m: f32,
    y_m: f32,
    contact: i64,
}

/// `uf_value`.
#[repr(C)]
#[derive(Debug)]
pub struct UfValue {
    pub(crate) size: u32,
    kind: u32,
    value: [f32; 2],
}

/// `uf_contact`.
#[repr(C)]
#[derive(Debug)]
pub struct UfContact {
    size: u32,
    id: u32,
    x_m: f32,
    y_m: f32,
    force_n: f32,
    x_velocity_m_s: f32,
    y_velocity_m_s: f32,
}

/// Whether a struct of the declared `size` in bytes has room for this version of `T`: a program compiled for a later
/// version may use this library, which leaves its newer fields unchanged.
pub(crate) const fn sized<T>(size: u32) -> bool {
    size as usize >= size_of::<T>() && size <= 1 << 16
}

/// Writes `text` with a closing 0, cut at a character if there is no room.
pub(crate) fn put(place: &mut [c_char], text: &str) {
    let Some(room) = place.len().checked_sub(1) else { return };
    // C ignores the part behind a 0.
    let text = text.split('\0').next().unwrap_or_default();
    let text = &text[..text.floor_char_boundary(room)];
    place.iter_mut().zip(text.bytes().chain([0])).for_each(|(place, byte)| *place = byte as c_char);
}

impl UfEvent {
    pub(crate) fn of(event: &Event, size: u32) -> Self {
        let (kind, text, (value_type, value)) = match event.kind {
            Kind::Control(kind) => (1, String::new(), happened(kind)),
            Kind::State => (2, String::new(), NOTHING),
            Kind::Page => (3, String::new(), NOTHING),
            Kind::Link(state) => (4, state.name().to_owned(), NOTHING),
            Kind::Health => (5, String::new(), NOTHING),
            Kind::Device => (6, String::new(), NOTHING),
            Kind::Muted => (7, String::new(), NOTHING),
            Kind::Crack { .. } => (8, String::new(), NOTHING),
            Kind::LinkCause => (10, event.message().to_owned(), NOTHING),
            Kind::Ignored(why) => (11, format!("{}: {}", why.name(), event.message()), NOTHING),
            Kind::Message => (12, event.message().to_owned(), NOTHING),
            Kind::Ended(reason) if event.message().is_empty() => (9, reason.name().to_owned(), NOTHING),
            Kind::Ended(reason) => (9, format!("{}: {}", reason.name(), event.message()), NOTHING),
            _ => (100, String::new(), NOTHING),
        };
        let mut made = Self {
            size,
            kind,
            t_s: event.at.micros() as f64 / 1e6,
            id: [0; ID_SIZE],
            name: [0; NAME_SIZE],
            text: [0; TEXT_SIZE],
            value_type,
            value,
            force_n: event.force.0,
            x_m: event.position.x,
            y_m: event.position.y,
            contact: event.contact.map_or(-1, |contact| i64::from(contact.0)),
        };
        put(&mut made.id, event.id());
        put(&mut made.name, event.kind.name());
        put(&mut made.text, &text);
        made
    }
}

impl UfValue {
    pub(crate) fn of(value: Option<Value>, size: u32) -> Self {
        let (kind, value) = value.map_or(NOTHING, numbers);
        Self { size, kind, value }
    }
}

impl UfContact {
    pub(crate) fn of(foot: &Contact, size: u32) -> Self {
        Self {
            size,
            id: foot.id.0,
            x_m: foot.centroid.x,
            y_m: foot.centroid.y,
            force_n: foot.force.0,
            x_velocity_m_s: foot.velocity.x,
            y_velocity_m_s: foot.velocity.y,
        }
    }
}

const NOTHING: (u32, [f32; 2]) = (0, [0.0; 2]);

/// The value in an event of a control.
fn happened(kind: EventKind) -> (u32, [f32; 2]) {
    match kind {
        EventKind::Changed(value) => numbers(value),
        EventKind::Swiped(direction) => {
            let way = match direction {
                Direction::North => 0.0,
                Direction::East => 1.0,
                Direction::South => 2.0,
                Direction::West => 3.0,
            };
            (5, [way, 0.0])
        }
        _ => NOTHING,
    }
}

fn numbers(value: Value) -> (u32, [f32; 2]) {
    match value {
        Value::Switch(on) => (1, [f32::from(u8::from(on)), 0.0]),
        Value::Number(number) => (2, [number, 0.0]),
        Value::Choice(choice) => (3, [f32::from(choice), 0.0]),
        Value::Pair(pair) => (4, pair.to_array()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_too_long_is_cut_at_a_character_and_closed() {
        let mut place = [1; 5];
        put(&mut place, "zoöö");
        assert_eq!(place.map(|byte| byte as u8), [b'z', b'o', 0xc3, 0xb6, 0]);
    }
}
