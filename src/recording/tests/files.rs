//! Recordings: intact, rewritten by other tools, truncated and damaged.

use mcap::records::op;
use proptest::prelude::*;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::super::PACKETS;
use super::super::reader::Recording;
use super::super::records::LONGEST_CHUNK;
use super::build::{
    OURS, Taken, Tool, attachment, channel, chunk, entries, message, opening, plain, read, record,
};

/// The ways in which tools write files.
fn tools() -> Vec<Tool> {
    let mut tools = vec![
        OURS,
        Tool { attachments_last: true, ..OURS },
        Tool { summary: false, indexes: false, ..OURS },
        Tool { repeats_channels: true, first_channel: 300, ..OURS },
        Tool { strangers: true, first_channel: 5, ..OURS },
        // One message per chunk, and all in one chunk.
        Tool { chunk_of: 1, ..OURS },
        Tool { chunk_of: usize::MAX, ..OURS },
        // Without chunks and checksums.
        Tool { chunks: None, ..OURS },
        Tool { chunks: None, attachments_last: true, strangers: true, ..OURS },
        Tool { chunk_checksums: false, data_checksum: false, ..OURS },
    ];
    for compression in ["zstd", "lz4"] {
        let packed = Tool { chunks: Some(compression), ..OURS };
        tools.extend([
            packed,
            Tool { attachments_last: true, data_checksum: false, ..packed },
            Tool { strangers: true, repeats_channels: true, chunk_of: 7, ..packed },
            Tool { chunk_of: usize::MAX, chunk_checksums: false, summary: false, ..packed },
        ]);
    }
    tools
}

#[test]
fn whichever_tool_wrote_the_file_its_entries_are_the_same() {
    let taken = entries(300);
    for tool in tools() {
        let given = read(tool.write(&taken)).unwrap_or_else(|error| panic!("{tool:?}: {error}"));
        assert_eq!(given.broken, None, "{tool:?}");
        assert_eq!(given.entries, plain(&taken), "{tool:?}");
        assert!(given.events > 0);
        assert_eq!(given.foreign > 0, tool.strangers, "{tool:?}");
    }
}

/// A tool that sorts by time may put entries with the same time in any order.
#[test]
fn entries_of_one_moment_are_put_in_order_again() {
    let taken = entries(300);
    let mut shuffled: Taken = taken.clone();
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    shuffled.shuffle(&mut rng);
    shuffled.sort_by_key(|(at, ..)| *at);
    let numbers = |taken: &Taken| taken.iter().map(|(_, number, _)| *number).collect::<Vec<_>>();
    assert_ne!(numbers(&shuffled), numbers(&taken));
    for chunk_of in [1, 2, 40, 1000] {
        let given = read(Tool { chunk_of, ..OURS }.write(&shuffled)).unwrap();
        assert_eq!((given.broken, given.entries), (None, plain(&taken)));
    }
}

#[test]
fn numbers_may_wrap_and_old_files_have_none() {
    let mut taken = entries(300);
    for (index, (_, number, _)) in (0_u32..).zip(&mut taken) {
        *number = index.wrapping_sub(150);
    }
    assert_eq!(read(OURS.write(&taken)).unwrap().entries, plain(&taken));
    taken.iter_mut().for_each(|(_, number, _)| *number = 0);
    assert_eq!(read(OURS.write(&taken)).unwrap().entries, plain(&taken));
}

#[test]
fn a_file_out_of_order_is_named_and_not_played_on() {
    let taken = entries(100);
    let mut swapped = taken.clone();
    swapped.swap(50, 90);
    let given = read(OURS.write(&swapped)).unwrap();
    let why = given.broken.unwrap();
    assert!(why.contains("not in the order of time") && why.contains("mcap sort"), "{why}");
    assert!(given.entries.len() < 100);
}

/// The entries of a truncated or damaged file are a prefix of the original ones.
fn check_beginning(given: &[(crate::units::Instant, super::LogEntry)], taken: &Taken, case: &str) {
    let whole = plain(taken);
    assert!(given.len() <= whole.len() && *given == whole[..given.len()], "{case}: other entries");
}

#[test]
fn a_file_that_is_cut_anywhere_gives_its_beginning() {
    let taken = entries(120);
    for tool in tools() {
        let file = tool.write(&taken);
        let data_end = file.len() - OURS.write(&Vec::new()).len().min(file.len());
        let mut most = 0;
        for cut in (0..file.len()).step_by(37) {
            // Some tools write the floor last: a truncated file then has none.
            let Ok(given) = read(file[..cut].to_vec()) else { continue };
            let case = format!("{tool:?} cut at {cut} of {}", file.len());
            check_beginning(&given.entries, &taken, &case);
            if given.broken.is_none() {
                assert_eq!(given.entries.len(), taken.len(), "{case}");
            }
            most = most.max(given.entries.len());
        }
        assert!(tool.attachments_last || most + 10 > taken.len(), "{tool:?}: {most} of {data_end}");
    }
}

/// Of a truncated chunk, the messages before the cut are read.
#[test]
fn the_last_chunk_is_read_up_to_where_it_is_cut() {
    let taken = entries(2000);
    for compression in ["", "zstd", "lz4"] {
        let file = Tool { chunks: Some(compression), chunk_of: usize::MAX, ..OURS }.write(&taken);
        let given = read(file[..file.len() * 9 / 10].to_vec()).unwrap();
        let why = given.broken.unwrap();
        assert!(why.contains("it ends at byte"), "{compression}: {why}");
        // A compressed chunk is read block by block, of up to 128 kB.
        let least = if compression.is_empty() { taken.len() / 2 } else { 0 };
        assert!(given.entries.len() >= least, "{compression}: {} entries", given.entries.len());
        check_beginning(&given.entries, &taken, compression);
    }
}

/// Flips one bit of a file: the entries must stay the same, or the reader must report a damage.
fn flip(file: &[u8], bit: usize, taken: &Taken, is_checked: bool, case: &str) {
    let mut damaged = file.to_vec();
    damaged[bit / 8] ^= 1 << (bit % 8);
    let Ok(given) = read(damaged) else { return };
    if is_checked && given.broken.is_none() {
        assert_eq!(given.entries, plain(taken), "{case}, bit {bit}: differs, and nothing is said");
    }
}

#[test]
fn no_bit_of_a_checked_file_changes_entries_without_a_word() {
    // Only a few entries, since every bit is flipped.
    let taken = entries(12);
    for compression in ["", "zstd"] {
        let file = Tool { chunks: Some(compression), chunk_of: 5, ..OURS }.write(&taken);
        // The file is a complete recording.
        assert!(
            Recording::read(Box::new(std::io::Cursor::new(file.clone())), std::path::Path::new("x")).is_ok()
        );
        for bit in 0..file.len() * 8 {
            flip(&file, bit, &taken, true, compression);
        }
    }
}

#[test]
fn bits_of_any_file_may_differ_without_a_panic() {
    let taken = entries(60);
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    for tool in tools() {
        let file = tool.write(&taken);
        let is_checked = tool.data_checksum;
        for _ in 0..300 {
            flip(&file, rng.random_range(0..file.len() * 8), &taken, is_checked, &format!("{tool:?}"));
        }
    }
}

#[test]
fn damage_is_named_with_its_place() {
    let taken = entries(300);
    let file = OURS.write(&taken);
    // In the middle of the data, where the chunks are.
    let place = file.len() / 2;
    let mut damaged = file.clone();
    damaged[place] ^= 1;
    let why = read(damaged).unwrap().broken.unwrap();
    assert!(why.contains("the chunk at byte") && why.contains("does not fit its checksum"), "{why}");
    let at: usize = why.split("at byte ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!(at < place && place < at + 4000, "{why}: damaged at {place}");
    // Between two chunks.
    let index = file.windows(15).rposition(|bytes| bytes == record(op::MESSAGE_INDEX, &[0; 6])).unwrap();
    let mut damaged = file;
    damaged[index + 10] ^= 1;
    let why = read(damaged).unwrap().broken.unwrap();
    assert!(why.contains("what lies between chunks is damaged"), "{why}");
}

/// A file with these records after its floor and layout.
fn with(records: &[u8]) -> Vec<u8> {
    let head = record(op::HEADER, &[0; 8]);
    let end = [record(op::DATA_END, &[0; 4]), record(op::FOOTER, &[0; 20]), mcap::MAGIC.to_vec()].concat();
    [mcap::MAGIC, &head, &opening(), records, &end].concat()
}

fn complaint(records: &[u8]) -> String {
    read(with(records)).unwrap().broken.expect("a named damage")
}

#[test]
fn what_makes_no_sense_is_named() {
    let packets = channel(1, PACKETS);
    for (records, expected) in [
        (message(1, 0, 0, 0, b"x"), "a message of channel 1, which is not defined"),
        ([packets.clone(), message(1, 0, 0, 0, b"x")].concat(), "that makes no sense"),
        ([packets.clone(), channel(1, "/other")].concat(), "a second channel 1, of another topic"),
        (record(op::CHANNEL, b"x"), "a channel that makes no sense"),
        (record(op::MESSAGE, b"x"), "a message that is too short"),
        (record(op::CHUNK, b"x"), "its head makes no sense"),
        (record(op::ATTACHMENT, b""), "an attachment that makes no sense"),
        (attachment("floor.ron", b"Floor(columns: 2, rows: 2)"), "two recordings in it"),
        (chunk("brotli", true, &packets), "is compressed by \"brotli\""),
        (chunk("", true, b"\x05\xff\xff\xff\xff\xff\xff\xff\xff"), "longer than the chunk"),
    ] {
        let why = complaint(&records);
        assert!(why.contains(expected) && why.contains("byte"), "{expected}: {why}");
    }
}

#[test]
fn no_claim_of_a_length_takes_memory() {
    for compression in ["", "zstd", "lz4"] {
        for claim in [10_u64 << 30, LONGEST_CHUNK + 1, u64::MAX] {
            // As the decompressed size, as the compressed size, and as the length of the record.
            for place in [9 + 16, 9 + 28 + 4 + compression.len(), 1] {
                let mut file = chunk(compression, true, &channel(1, PACKETS));
                file[place..place + 8].copy_from_slice(&claim.to_le_bytes());
                let why = complaint(&file);
                assert!(why.contains("claims") || why.contains("it ends"), "{why}");
            }
        }
    }
    // A message, and an attachment of another program.
    for opcode in [op::MESSAGE, op::ATTACHMENT, op::METADATA, 0x91] {
        let claim = [&[opcode][..], &u64::MAX.to_le_bytes(), b"abc"].concat();
        assert!(complaint(&claim).contains("it ends in the middle of the record"), "{opcode}");
    }
    // A decompression bomb: 20 MB of zeros in some kB that claim to be less.
    for compression in ["zstd", "lz4"] {
        let mut bomb = chunk(compression, true, &vec![0; 20 << 20]);
        assert!(bomb.len() < 1 << 20);
        bomb[9 + 16..9 + 24].copy_from_slice(&1000_u64.to_le_bytes());
        assert!(complaint(&bomb).contains("holds 1001 bytes, not the 1000 that it claims"), "{compression}");
    }
}

#[test]
fn topics_of_others_take_no_memory_and_are_counted() {
    let long = "/t".repeat(1 << 19);
    let mut records = Vec::new();
    for number in 100..110 {
        records.extend(channel(number, &long));
        records.extend(message(number, 0, 0, 0, &[1; 100]));
    }
    let given = read(with(&records)).unwrap();
    assert_eq!((given.foreign, given.broken, given.entries.len()), (10, None, 0));
}

#[test]
fn a_file_without_a_floor_says_what_it_lacks() {
    let head = record(op::HEADER, &[0; 8]);
    let end = [record(op::DATA_END, &[0; 4]), record(op::FOOTER, &[0; 20]), mcap::MAGIC.to_vec()].concat();
    let stranger = [mcap::MAGIC, &head, &channel(1, "/camera"), &end].concat();
    let why = read(stranger).unwrap_err().to_string();
    assert!(why.contains("floor.ron, layout.ron") && why.contains("a tool may have left"), "{why}");
    for file in [Vec::new(), b"not a recording".to_vec(), mcap::MAGIC.to_vec()] {
        let why = read(file).unwrap_err().to_string();
        assert!(why.contains("no recording of a floor begins there"), "{why}");
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_without_waiting() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.mcap");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert!(!Recording::is_at(&pipe));
    let why = Recording::open(&pipe).unwrap_err().to_string();
    assert!(why.contains("it is not an ordinary file"), "{why}");
    assert!(Recording::open(std::path::Path::new("/dev/zero")).is_err());
    assert!(Recording::open(folder.path()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_bytes_make_the_reader_panic(
        bytes in proptest::collection::vec(any::<u8>(), 0..200),
        opcode in 0_u8..20,
        compression in "|zstd|lz4|x",
    ) {
        let _ = read(bytes.clone());
        let _ = read(with(&bytes));
        let _ = read(with(&record(opcode, &bytes)));
        let _ = read(with(&chunk(&compression, false, &bytes)));
    }
}
