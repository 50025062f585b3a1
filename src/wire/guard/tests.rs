//! Datagrams that are refused before they are decoded.

use rosc::{OscArray, OscBundle, OscMessage, OscPacket, OscTime, OscType, encoder};

use super::*;

fn message(address: &str, args: Vec<OscType>) -> OscPacket {
    OscPacket::Message(OscMessage { addr: address.into(), args })
}

fn bundle(content: Vec<OscPacket>) -> OscPacket {
    OscPacket::Bundle(OscBundle { timetag: OscTime { seconds: 0, fractional: 1 }, content })
}

fn verdict(packet: &OscPacket) -> Result<(), Malformed> {
    check(&encoder::encode(packet).unwrap(), &DatagramLimits::default())
}

#[test]
fn every_argument_type_of_osc_passes() {
    let every = vec![
        OscType::Int(1),
        OscType::Float(2.0),
        OscType::Double(3.0),
        OscType::Long(4),
        OscType::Time(OscTime { seconds: 5, fractional: 6 }),
        OscType::String("seven".into()),
        OscType::Blob(vec![1, 2, 3, 4, 5]),
        OscType::Char('x'),
        OscType::Bool(true),
        OscType::Nil,
        OscType::Inf,
        OscType::Array(OscArray { content: vec![OscType::Int(1), OscType::Bool(false)] }),
    ];
    assert_eq!(verdict(&message("/a", every.clone())), Ok(()));
    assert_eq!(verdict(&bundle(vec![message("/a", every), bundle(vec![message("/b", vec![])])])), Ok(()));
    assert_eq!(verdict(&bundle(vec![])), Ok(()));
}

#[test]
fn bundles_nest_four_deep_and_no_deeper() {
    let mut packet = message("/a", vec![]);
    for depth in 1..=5 {
        packet = bundle(vec![packet]);
        assert_eq!(verdict(&packet).is_ok(), depth <= 4, "{depth}");
    }
}

#[test]
fn arrays_must_close_and_nest_four_deep_at_most() {
    let tags = |tags: &[u8]| {
        let mut bytes = b"/a\0\0".to_vec();
        bytes.extend(tags);
        bytes.push(0);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        check(&bytes, &DatagramLimits::default())
    };
    assert_eq!(tags(b",[[[[]]]]"), Ok(()));
    assert_eq!(tags(b",[[[[[]]]]]"), Err(Malformed::TooDeep { at: 4 }));
    assert_eq!(tags(b",[[T]"), Err(Malformed::TooDeep { at: 4 }));
    assert_eq!(tags(b",]["), Err(Malformed::Text { at: 4 }));
    assert_eq!(tags(b",Q"), Err(Malformed::Text { at: 4 }));
    assert_eq!(tags(b"T"), Err(Malformed::Text { at: 4 }));
}

// P3
#[test]
fn every_prefix_of_a_good_datagram_is_refused() {
    let whole =
        encoder::encode(&bundle(vec![message("/underfoot/board/0", vec![OscType::Int(1); 25])])).unwrap();
    assert_eq!(check(&whole, &DatagramLimits::default()), Ok(()));
    for length in 0..whole.len() {
        // A bundle header alone, and a header with whole elements, are valid bundles.
        let verdict = check(&whole[..length], &DatagramLimits::default());
        assert_eq!(verdict.is_ok(), length == 16, "{length}: {verdict:?}");
    }
}

#[test]
fn left_over_bytes_are_refused_wherever_they_are() {
    let mut bytes = encoder::encode(&message("/a", vec![OscType::Int(1)])).unwrap();
    let end = bytes.len();
    bytes.extend([0; 4]);
    assert_eq!(check(&bytes, &DatagramLimits::default()), Err(Malformed::LeftOver { at: end }));

    // The same inside a bundle, where rosc alone would not detect it.
    let mut inside = b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec();
    inside.extend((bytes.len() as u32).to_be_bytes());
    inside.extend(&bytes);
    assert_eq!(check(&inside, &DatagramLimits::default()), Err(Malformed::LeftOver { at: 20 + end }));
}

#[test]
fn lengths_that_lie_are_refused() {
    let with_length = |length: u32| {
        let mut bytes = b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec();
        bytes.extend(length.to_be_bytes());
        bytes.extend(b"/a\0\0,\0\0\0");
        check(&bytes, &DatagramLimits::default())
    };
    assert_eq!(with_length(8), Ok(()));
    assert_eq!(with_length(7), Err(Malformed::Length { length: 7, at: 16 }));
    assert_eq!(with_length(12), Err(Malformed::CutShort { at: 16 }));
    assert_eq!(with_length(0xFFFF_FFFC), Err(Malformed::CutShort { at: 16 }));
    assert!(with_length(4).is_err());
    assert!(with_length(0).is_err());
    let blob = |length: u32| {
        let mut bytes = b"/a\0\0,b\0\0".to_vec();
        bytes.extend(length.to_be_bytes());
        bytes.extend([0; 4]);
        check(&bytes, &DatagramLimits::default())
    };
    assert_eq!(blob(4), Ok(()));
    assert_eq!(blob(5), Err(Malformed::CutShort { at: 8 }));
    assert_eq!(blob(u32::MAX), Err(Malformed::CutShort { at: 8 }));
}

// P5
#[test]
fn too_much_of_anything_is_refused() {
    let limits = DatagramLimits::default();
    assert_eq!(check(&[], &limits), Err(Malformed::Empty));
    assert!(matches!(check(&[0; 65_507], &limits), Err(Malformed::TooLarge { bytes: 65_507, .. })));
    assert!(matches!(verdict(&message("/a", vec![OscType::Nil; 257])), Err(Malformed::TooMany { .. })));
    let long = format!("/{}", "a".repeat(200));
    assert!(matches!(verdict(&message(&long, vec![])), Err(Malformed::TooMany { .. })));
    let many = vec![message("/a", vec![]); 257];
    assert!(matches!(verdict(&bundle(many)), Err(Malformed::TooMany { .. })));
}
