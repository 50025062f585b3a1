//! Causes of a floor without packets, and their words.

use std::collections::BTreeSet;

use super::*;

/// Returns one cause of each kind.
fn every() -> Vec<LinkCause> {
    let board = 3;
    vec![
        LinkCause::RateLow { board, hz: 99.7 },
        LinkCause::RateHigh { board, hz: 5000.2 },
        LinkCause::RateOther { board, hz: 49.8, written: 100.0 },
        LinkCause::SequenceStands { board, number: 0 },
        LinkCause::SequenceStep { board, step: 10 },
        LinkCause::SequenceFalls { board },
        LinkCause::SequenceRestarts { board, after: 255 },
        LinkCause::SequenceMixed { board },
        LinkCause::SequenceJumps { board },
        LinkCause::OtherAddress { found: "/board/0".into(), expected: "/underfoot/board/0".into() },
        LinkCause::WrongReadings { board, channels: 4, found: "idddd".into() },
        LinkCause::NotOsc { why: "they look like text".into() },
        LinkCause::PortGarbled { port: "/dev/ttyACM0".into(), why: "it is not text".into() },
        LinkCause::SenderRefused { why: "10.0.0.1".into() },
        LinkCause::CountsBeyond { board, greatest: Some(8_388_607), full_scale: 65_535 },
        LinkCause::NotNumbers { board },
        LinkCause::ReadingsStand { board },
        LinkCause::CountsNarrow { board, least: 90, greatest: 700, full_scale: 65_535 },
        LinkCause::NewtonsSmall { board, greatest: 0.9 },
        LinkCause::NewtonsLarge { board, greatest: 40_000.0 },
        LinkCause::ReadingsFall { board },
        LinkCause::NoLoad { board },
        LinkCause::BoardsSwapped { board, reads: 4 },
        LinkCause::BoardsMissing { board, address: "/underfoot/board/3".into(), missing: 2, boards: 6 },
        LinkCause::Unknown { last_refused: String::new() },
    ]
}

#[test]
fn the_page_for_people_explains_each_name() {
    let page = include_str!("../../../docs/troubleshooting.md");
    let (_, part) = page.split_once("### Boards that send").unwrap();
    let (part, _) = part.split_once("\n## ").unwrap();
    let rows = part.lines().filter_map(|line| line.strip_prefix("| `")?.split_once(" |"));
    let explained: BTreeSet<&str> =
        rows.flat_map(|(names, _)| names.split(", ")).map(|name| name.trim_matches('`')).collect();
    let every = every();
    let names: BTreeSet<&str> = every.iter().map(LinkCause::name).collect();
    assert_eq!(names, explained);
    assert_eq!(names.len(), every.len());
}

#[test]
fn each_sentence_names_its_board() {
    for cause in every() {
        let said = cause.to_string();
        assert!(said.len() > 30, "{said}");
        assert_eq!(cause.board().is_some(), said.contains("board 3"), "{said}");
    }
}

#[test]
fn wrong_readings_are_told_with_what_would_be_right() {
    for (found, hint) in [
        ("idddd", "doubles (d) must be sent as floats"),
        ("ihhhh", "64-bit integers (h) must be sent as int32"),
        ("issss", "numbers must not be sent as text"),
        ("fffff", "the first argument must be the sequence number"),
        ("ib (a blob of 32 bytes)", "one blob (b) of 8 bytes"),
        ("no type tags", "the first argument must be the sequence number"),
    ] {
        let said = LinkCause::WrongReadings { board: 0, channels: 4, found: found.into() }.to_string();
        assert!(said.contains(found) && said.contains(hint), "{said}");
    }
}
