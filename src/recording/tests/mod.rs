//! Entries survive writing and reading, and arbitrary bytes do not make the reader panic.

mod build;
mod files;
mod packed;

use arrayvec::ArrayVec;

use crate::floor::TileId;
use crate::source::log::{LogEntry, decoder};
use crate::units::Instant;
use crate::widget::{Indicator, Value, WidgetId};
use crate::wire::{ControlMessage, Readings, Request, SensorPacket};

fn again(entry: &LogEntry) -> Option<LogEntry> {
    let mut bytes = Vec::new();
    entry.write(&mut bytes);
    let read = |bytes: &[u8]| LogEntry::read(entry.topic(), bytes, Instant::from_micros(7), &decoder());
    let mut split = Vec::new();
    entry.write_split(&mut split);
    assert_eq!(read(&split), read(&bytes), "both forms");
    read(&bytes)
}

#[test]
fn a_reading_that_is_missing_is_not_one_that_is_saturated() {
    let counts: ArrayVec<_, 64> = [None, Some(u16::MAX), Some(0), None].into_iter().collect();
    let full: ArrayVec<_, 64> = (0..64).map(|n| (n % 3 > 0).then_some(n)).collect();
    let newtons: ArrayVec<_, 64> = [1.5, -0.0, f32::INFINITY].into_iter().collect();
    for readings in [Readings::Counts(counts), Readings::Counts(full), Readings::Newtons(newtons)] {
        let packet =
            SensorPacket { board: 3, sequence: u32::MAX, received: Instant::from_micros(7), readings };
        assert_eq!(again(&LogEntry::Packet(packet.clone())), Some(LogEntry::Packet(packet)));
    }
}

#[test]
fn every_request_is_read_as_it_was_asked() {
    let id = WidgetId::new("zoom");
    let sender = Some("127.0.0.1:9000".parse().unwrap());
    for message in [
        ControlMessage::Set { id: id.clone(), value: Value::Number(0.1) },
        ControlMessage::Set { id: id.clone(), value: Value::Switch(true) },
        ControlMessage::Set { id: id.clone(), value: Value::Pair(glam::Vec2::new(0.1, -2.0)) },
        ControlMessage::Set { id: WidgetId::new("z*"), value: Value::Number(1.0) },
        ControlMessage::Enable { id: id.clone() },
        ControlMessage::Disable { id: id.clone() },
        ControlMessage::Lock { id: id.clone() },
        ControlMessage::Unlock { id: id.clone() },
        ControlMessage::Label { id: id.clone(), text: "Größe".into() },
        ControlMessage::Indicate { id: id.clone(), indicator: Indicator::Busy },
        ControlMessage::SetRange { id: id.clone(), least: -1.0, greatest: 7.5 },
        ControlMessage::Get { id: id.clone() },
        ControlMessage::GetAll,
        ControlMessage::CancelAll,
        ControlMessage::ShowPage { page: id },
        ControlMessage::GetPage,
        ControlMessage::Mute { on: true },
        ControlMessage::MuteTile { tile: TileId { column: 2, row: 1 }, on: false },
        ControlMessage::GetMute,
    ] {
        for sender in [sender, None] {
            let entry = LogEntry::Request(Request { message: message.clone(), sender });
            assert_eq!(again(&entry), Some(entry));
        }
    }
}

#[test]
fn the_rest_of_what_a_source_gives_comes_again_too() {
    for entry in [LogEntry::Silence, LogEntry::End, LogEntry::Gap(17), LogEntry::Layout("Layout()".into())] {
        assert_eq!(again(&entry), Some(entry));
    }
}

proptest::proptest! {
    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(0_u8.., 0..200)) {
        for topic in [super::PACKETS, super::REQUESTS, super::LAYOUTS, super::GAPS] {
            let _ = LogEntry::read(topic, &bytes, Instant::START, &decoder());
        }
    }
}
