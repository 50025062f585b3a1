//! Datagrams of boards and apps, well-formed and damaged.

use rosc::{OscMessage, encoder};

use super::*;
use crate::floor::Geometry;
use crate::widget::{Value, WidgetId};
use crate::wire::Readings;

const NOW: Instant = Instant::from_millis(7);

/// One tile, one board of four channels.
fn decoder() -> Decoder {
    Decoder::new(&Floor::of(Geometry::of_paper_tiles(1, 1).unwrap()))
}

fn bytes(address: &str, args: Vec<OscType>) -> Vec<u8> {
    encoder::encode(&message(address, args)).unwrap()
}

fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.into(), args })
}

fn ints(values: &[i32]) -> Vec<OscType> {
    values.iter().map(|&value| OscType::Int(value)).collect()
}

fn decode(datagram: &[u8]) -> Result<Batch, WireError> {
    let mut batch = Batch::default();
    decoder().decode(datagram, NOW, &mut batch).map(|()| batch)
}

fn readings(args: Vec<OscType>) -> Result<Readings, WireError> {
    decode(&bytes("/underfoot/board/0", args)).map(|mut batch| batch.packets.remove(0).readings)
}

#[test]
fn counts_come_as_ints_or_as_one_blob() {
    let expected = Readings::Counts([Some(0), Some(1), Some(256), Some(65535)].into_iter().collect());
    assert_eq!(readings(ints(&[9, 0, 1, 256, 65535])), Ok(expected.clone()));
    let blob = OscType::Blob(vec![0, 0, 0, 1, 1, 0, 255, 255]);
    assert_eq!(readings(vec![OscType::Int(9), blob]), Ok(expected));
}

#[test]
fn a_message_without_a_number_has_number_0() {
    let expected = Readings::Counts([Some(1), Some(2), Some(3), Some(4)].into_iter().collect());
    let blob = OscType::Blob(vec![0, 1, 0, 2, 0, 3, 0, 4]);
    for args in [ints(&[1, 2, 3, 4]), vec![blob]] {
        let batch = decode(&bytes("/underfoot/board/0", args)).unwrap();
        assert_eq!((batch.packets[0].sequence, &batch.packets[0].readings), (0, &expected));
    }
    let newtons = decode(&bytes("/underfoot/board/0", vec![OscType::Float(7.5); 4])).unwrap();
    assert_eq!(newtons.packets[0].readings, Readings::Newtons([7.5; 4].into_iter().collect()));
}

#[test]
fn counts_of_other_converters_are_scaled() {
    use crate::floor::CountSign::{OffsetBinary, Signed, Unsigned};
    let read = |full_scale, sign, args| {
        let mut floor = Floor::of(Geometry::of_paper_tiles(1, 1).unwrap());
        floor.boards[0].range = CountRange { full_scale, sign };
        let mut batch = Batch::default();
        Decoder::new(&floor).decode(&bytes("/underfoot/board/0", args), NOW, &mut batch).unwrap();
        batch.packets.remove(0).readings
    };
    let ten_bits = Readings::Counts([Some(0), Some(65_535), None, Some(32_800)].into_iter().collect());
    assert_eq!(read(1023, Unsigned, ints(&[9, 0, 1023, 1024, 512])), ten_bits);
    let near = |readings: Readings, expected: [f32; 4]| {
        let Readings::Scaled(values) = readings else { panic!("{readings:?}") };
        let is_near = |(value, expected): (&f32, f32)| (value - expected).abs() < 0.02;
        assert!(values.iter().zip(expected).all(is_near), "{values:?}");
    };
    let expected = [0.0, -32_767.5, 32_767.5, -0.0078];
    near(read(8_388_607, Signed, ints(&[9, 0, -4_194_304, 4_194_304, -1])), expected);
    // The same words without their signs, and with the zero in the middle.
    near(read(8_388_607, Signed, ints(&[9, 0, 12_582_912, 4_194_304, 16_777_215])), expected);
    near(read(16_777_215, OffsetBinary, ints(&[9, 8_388_608, 4_194_304, 12_582_912, 8_388_607])), expected);
    let words =
        [0_i32, 0x40_0000, 0x80_0000, 0xFF_FFFF].iter().flat_map(|word| word.to_be_bytes()[1..].to_vec());
    let blob = vec![OscType::Int(9), OscType::Blob(words.collect())];
    near(read(16_777_215, Unsigned, blob), [0.0, 16_383.75, 32_767.5, 65_535.0]);
}

#[test]
fn a_finer_converter_than_the_floor_file_s_shows_its_counts() {
    let Ok(Readings::Scaled(values)) = readings(ints(&[9, 8_388_700, 8_388_600, 8_388_650, 3])) else {
        panic!("not scaled")
    };
    assert_eq!(values[0], 8_388_700.0);
}

#[test]
fn the_sequence_has_no_sign() {
    let batch = decode(&bytes("/underfoot/board/0", ints(&[-1, 1, 2, 3, 4]))).unwrap();
    assert_eq!(batch.packets[0].sequence, u32::MAX);
    assert_eq!(batch.packets[0].received, NOW);
}

#[test]
fn a_count_out_of_range_spoils_only_its_own_channel() {
    let counts = Readings::Counts([None, None, Some(3), Some(4)].into_iter().collect());
    assert_eq!(readings(ints(&[9, -1, 65536, 3, 4])), Ok(counts));
}

#[test]
fn newtons_keep_what_is_not_a_number_for_the_assembler_to_judge() {
    let floats = [f32::NAN, f32::INFINITY, -0.0, 1e38].map(OscType::Float);
    let args = std::iter::once(OscType::Int(1)).chain(floats).collect();
    let Ok(Readings::Newtons(forces)) = readings(args) else { panic!("not newtons") };
    assert!(forces[0].is_nan() && forces[1] == f32::INFINITY && forces[3] == 1e38);
}

#[test]
fn other_shapes_are_refused() {
    let too_few = ints(&[9, 1, 2]);
    let too_many = ints(&[9, 1, 2, 3, 4, 5]);
    let far_too_many = ints(&[9; 200]);
    let mixed = vec![OscType::Int(9), OscType::Int(1), OscType::Float(1.0), OscType::Int(1), OscType::Int(1)];
    let no_sequence = vec![OscType::Float(1.0); 5];
    let odd_blob = vec![OscType::Int(9), OscType::Blob(vec![0; 7])];
    let short_blob = vec![OscType::Int(9), OscType::Blob(vec![0; 6])];
    let huge_blob = vec![OscType::Int(9), OscType::Blob(vec![0; 1024])];
    for args in [too_few, too_many, far_too_many, mixed, no_sequence, odd_blob, short_blob, huge_blob, vec![]]
    {
        let verdict = readings(args.clone());
        assert!(matches!(verdict, Err(WireError::WrongReadings { .. })), "{args:?}: {verdict:?}");
    }
}

// P11
#[test]
fn hostile_addresses_match_nothing() {
    for address in ["/*", "//", "/", "/underfoot/board/*", "/underfoot/board/[0-9]", "/underfoot/board/00"] {
        let verdict = decode(&bytes(address, ints(&[9, 1, 2, 3, 4])));
        assert_eq!(verdict, Err(WireError::UnknownAddress { address: address.into(), is_reading: true }));
    }
    // P11: a name of 60 kB is past the size limit, one of 6 kB past that of addresses.
    for length in [60_000, 6000] {
        let name = format!("/{}", "a".repeat(length));
        assert!(matches!(decode(&bytes(&name, vec![])), Err(WireError::Malformed(_))));
    }
}

fn bundle(elements: &[Vec<u8>]) -> Vec<u8> {
    // P10: the time tag may have any value.
    let mut bytes = b"#bundle\0\xFF\xFF\xFF\xFF\0\0\0\0".to_vec();
    for element in elements {
        bytes.extend(u32::try_from(element.len()).unwrap().to_be_bytes());
        bytes.extend(element);
    }
    bytes
}

fn good_readings() -> Vec<u8> {
    bytes("/underfoot/board/0", ints(&[9, 1, 2, 3, 4]))
}

/// Writes a message without the checks of an encoder.
fn raw(address: &str, tags: Option<&str>, arguments: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for text in [Some(address.to_owned()), tags.map(|tags| format!(",{tags}"))].into_iter().flatten() {
        bytes.extend(text.as_bytes());
        bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
    }
    bytes.extend(arguments);
    bytes
}

// P4
#[test]
fn one_malformed_element_spoils_the_whole_datagram() {
    assert_eq!(decode(&bundle(&[good_readings(), good_readings()])).unwrap().packets.len(), 2);
    let cut_short = raw("/battery", Some("f"), &[]);
    let left_over = raw("/battery", Some("i"), &[0; 8]);
    let no_address = b"battery\0,\0\0\0".to_vec();
    let endless_array = raw("/battery", Some("[i"), &[0; 4]);
    for bad in [cut_short, left_over, no_address, endless_array] {
        let mut batch = Batch::default();
        decoder().decode(&bundle(&[good_readings()]), NOW, &mut batch).unwrap();
        let verdict = decoder().decode(&bundle(&[good_readings(), bad.clone()]), NOW, &mut batch);
        assert!(matches!(verdict, Err(WireError::Malformed(_))), "{bad:?}: {verdict:?}");
        assert_eq!(batch, Batch::default());
    }
}

/// Messages of other senders beside a board's readings.
fn foreign_messages() -> Vec<Vec<u8>> {
    vec![
        bytes("/battery", vec![OscType::Float(3.7)]),
        // Older senders omit the type tags, with arguments and without.
        raw("/ping", None, &[]),
        raw("/level", None, &[0, 0, 0, 1]),
        // Type tags that are undefined in OSC, or defined only in some versions.
        raw("/symbol", Some("S"), b"kick"),
        raw("/odd", Some("iQz"), &[1, 2, 3, 4, 5, 6, 7, 8]),
        // More arguments and a longer address than in any message to a floor.
        bytes("/spectrum", vec![OscType::Float(0.5); 300]),
        bytes(&format!("/{}", "a".repeat(200)), vec![]),
        bundle(&[bytes("/cue/1", vec![]), bundle(&[bytes("/cue/2", vec![])])]),
    ]
}

#[test]
fn a_message_for_another_receiver_costs_its_bundle_nothing() {
    for foreign in foreign_messages() {
        for elements in [
            [foreign.clone(), good_readings(), good_readings()],
            [good_readings(), foreign.clone(), good_readings()],
            [good_readings(), good_readings(), foreign.clone()],
        ] {
            let batch = decode(&bundle(&elements)).unwrap();
            assert_eq!(batch.packets.len(), 2, "{foreign:?}");
            assert!(!batch.refused.is_empty(), "{foreign:?}");
            let is_foreign = |error: &WireError| matches!(error, WireError::UnknownAddress { .. });
            assert!(batch.refused.iter().all(is_foreign), "{:?}", batch.refused);
            let nested = decode(&bundle(&[bundle(&elements)])).unwrap();
            assert_eq!(nested.packets.len(), 2, "{foreign:?}");
        }
    }
}

#[test]
fn a_bundle_of_foreign_messages_alone_is_refused_message_by_message() {
    let batch = decode(&bundle(&foreign_messages())).unwrap();
    assert!(!batch.is_used());
    assert_eq!(batch.refused.len(), foreign_messages().len() + 1);
}

#[test]
fn a_message_of_the_wrong_shape_costs_only_itself() {
    let short = bytes("/underfoot/board/0", ints(&[9, 1, 2]));
    let unclear = bytes("/underfoot/widget/zoom/set", vec![OscType::Nil]);
    let get = bytes("/underfoot/widget/zoom/get", vec![]);
    let batch = decode(&bundle(&[short, good_readings(), unclear, get])).unwrap();
    assert_eq!((batch.packets.len(), batch.controls.len()), (1, 1));
    assert!(
        matches!(
            batch.refused[..],
            [WireError::WrongReadings { board: 0, channels: 4, .. }, WireError::WrongShape { .. }]
        ),
        "{:?}",
        batch.refused
    );
}

#[test]
fn a_message_without_type_tags_has_no_arguments() {
    let id = WidgetId::new("zoom");
    for (path, message) in [
        ("get", ControlMessage::GetAll),
        ("page/get", ControlMessage::GetPage),
        ("mute/get", ControlMessage::GetMute),
        ("cancel", ControlMessage::CancelAll),
        ("widget/zoom/get", ControlMessage::Get { id: id.clone() }),
        ("widget/zoom/enable", ControlMessage::Enable { id: id.clone() }),
    ] {
        let bare = raw(&format!("/underfoot/{path}"), None, &[]);
        assert_eq!(decode(&bare).unwrap().controls, std::slice::from_ref(&message), "{path}");
        assert_eq!(decode(&bundle(&[good_readings(), bare])).unwrap().controls, [message], "{path}");
    }
}

#[test]
fn arguments_without_type_tags_are_refused() {
    for (address, arguments) in [
        ("/underfoot/widget/zoom/set", vec![0x3F, 0, 0, 0]),
        ("/underfoot/widget/zoom/set", vec![]),
        // 0 would mean the opposite of no argument.
        ("/underfoot/widget/zoom/enable", vec![0; 4]),
        ("/underfoot/mute/set", vec![0, 0, 0, 1]),
        ("/underfoot/board/0", vec![0; 20]),
        ("/underfoot/board/0", vec![]),
    ] {
        let verdict = decode(&raw(address, None, &arguments));
        let Err(WireError::WrongShape { found, .. } | WireError::WrongReadings { found, .. }) = &verdict
        else {
            panic!("{address}: {verdict:?}")
        };
        let expected = if arguments.is_empty() { "nothing" } else { "no type tags" };
        assert_eq!(found, expected, "{address}");
    }
}

#[test]
fn unknown_type_tags_at_a_known_address_are_refused() {
    for address in ["/underfoot/board/0", "/underfoot/widget/zoom/set", "/underfoot/get"] {
        let verdict = decode(&raw(address, Some("iQ"), &[0; 8]));
        let Err(WireError::WrongShape { found, .. } | WireError::WrongReadings { found, .. }) = verdict
        else {
            panic!("{address}: {verdict:?}")
        };
        assert_eq!(found, "iQ");
    }
}

#[test]
fn apps_set_enable_and_disable_controls() {
    let control =
        |address: &str, args| decode(&bytes(address, args)).map(|mut batch| batch.controls.remove(0));
    let id = WidgetId::new("zoom");
    let set = |value| Ok(ControlMessage::Set { id: id.clone(), value });
    let address = "/underfoot/widget/zoom/set";
    assert_eq!(control(address, vec![OscType::Float(0.5)]), set(Value::Number(0.5)));
    assert_eq!(control(address, vec![OscType::Int(1)]), set(Value::Number(1.0)));
    assert_eq!(control(address, vec![OscType::Bool(true)]), set(Value::Switch(true)));
    let pair = vec![OscType::Float(0.5), OscType::Int(-1)];
    assert_eq!(control(address, pair), set(Value::Pair(glam::Vec2::new(0.5, -1.0))));
    let enable = control("/underfoot/widget/zoom/enable", vec![]);
    assert_eq!(enable, Ok(ControlMessage::Enable { id: id.clone() }));
    let disable = control("/underfoot/widget/zoom/disable", vec![]);
    assert_eq!(disable, Ok(ControlMessage::Disable { id: id.clone() }));

    for args in [vec![], vec![OscType::Float(f32::NAN)], vec![OscType::Double(1e300)], vec![OscType::Nil]] {
        assert!(matches!(control(address, args), Err(WireError::WrongShape { .. })));
    }
    for address in ["/underfoot/widget/zoom", "/underfoot/widget//set", "/underfoot/widget/zoom/explode"] {
        assert!(matches!(control(address, vec![]), Err(WireError::UnknownAddress { .. })));
    }
}

#[test]
fn every_refusal_has_its_counter() {
    let mut counters = LinkCounters::default();
    for datagram in [b"/a".to_vec(), bytes("/nobody", vec![]), bytes("/underfoot/board/0", vec![])] {
        decode(&datagram).unwrap_err().count(&mut counters);
    }
    assert_eq!((counters.malformed, counters.unknown_address, counters.wrong_shape), (1, 1, 1));
    assert_eq!(counters.refused(), 3);
}
