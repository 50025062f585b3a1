//! Files of our own recorder: small, readable up to any cut, and trimmed.

use std::fs::{self, File};
use std::path::Path;
use std::sync::atomic::AtomicU64;

use super::super::Recording;
use super::super::kept::as_kept;
use super::super::writer::{Job, RecordingFile, RecordingHead};
use super::build::{OURS, PAGE, Taken, entries, floor, plain, read};
use crate::schema::{self, Kinds};
use crate::sense::Method;
use crate::sink::wait_free;
use crate::source::log::LogEntry;
use crate::units::Instant;

/// Line of the event of an entry, which stands a little after it in the file.
fn line(at: Instant) -> Vec<u8> {
    format!("{{\"t_s\":{:.6},\"event\":\"link\",\"state\":\"live\"}}", at.secs()).into_bytes()
}

/// Writes the entries, each with an event, as the recorder does.
fn recorded(taken: &Taken, path: &Path) {
    let floor = floor();
    let layout = schema::parse_layout(PAGE, "page", &Kinds::builtin(), &floor.geometry).unwrap().layout;
    let (layout, _) = as_kept(&layout, &floor.geometry).unwrap();
    let floor = schema::write_floor(&floor);
    let head = RecordingHead { floor: &floor, layout: &layout, method: Method::Tracker, begins: None };
    let file = RecordingFile::begin(File::create(path).unwrap(), path, head).unwrap();
    let (mut jobs, mut queue) = wait_free(2 * taken.len());
    for batch in taken.chunks(20) {
        let entries = batch.iter().map(|(at, _, entry)| (*at, entry.clone())).collect();
        assert!(jobs.try_send(Job::Entries(entries)).is_ok());
        for (at, ..) in batch {
            assert!(jobs.try_send(Job::Event(*at, line(*at))).is_ok());
        }
    }
    drop(jobs);
    let lost = AtomicU64::new(0);
    file.write_all(&mut queue, &lost);
    assert_eq!(lost.into_inner(), 0);
}

#[test]
fn a_recording_is_read_as_it_was_taken_and_takes_less_than_half() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("visit.mcap");
    let taken = entries(20_000);
    recorded(&taken, &path);
    let file = fs::read(&path).unwrap();
    let given = read(file.clone()).unwrap();
    assert_eq!((given.entries, given.broken), (plain(&taken), None));
    assert_eq!(given.events, taken.len());
    let plain = OURS.write(&taken).len();
    assert!(2 * file.len() < plain, "{} of {plain} bytes", file.len());
}

#[test]
fn a_recording_that_is_cut_anywhere_gives_its_beginning() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("visit.mcap");
    // More than one chunk, of several blocks each.
    let taken = entries(30_000);
    recorded(&taken, &path);
    let (file, whole) = (fs::read(&path).unwrap(), plain(&taken));
    let mut longest = 0;
    for cut in (0..file.len()).step_by(file.len() / 97).chain(file.len() - 40..file.len()) {
        let Ok(given) = read(file[..cut].to_vec()) else { continue };
        assert!(given.entries.len() <= whole.len(), "cut at {cut}");
        assert_eq!(given.entries, whole[..given.entries.len()], "cut at {cut}");
        assert!(given.broken.is_some() || given.entries.len() == whole.len(), "cut at {cut}");
        // At most one block of 64 kB, and what is not yet in it, is missing from the end.
        let share = given.entries.len() as f64 / whole.len() as f64;
        assert!(share + 0.1 > cut as f64 / file.len() as f64, "cut at {cut}: {share}");
        longest = longest.max(given.entries.len());
    }
    assert_eq!(longest, whole.len());
}

#[test]
fn a_trimmed_recording_has_all_up_to_its_end_and_says_where_it_begins() {
    let folder = tempfile::tempdir().unwrap();
    let [path, part] = ["visit.mcap", "part.mcap"].map(|name| folder.path().join(name));
    let taken = entries(9_000);
    recorded(&taken, &path);
    let (from, to) = (Instant::from_millis(3_000), Instant::from_millis(6_500));
    let trimmed = Recording::open(&path).unwrap().trim(&part, (from, to), |_| true).unwrap().unwrap();
    assert_eq!(trimmed.broken, None);
    let mut wanted: Vec<_> = plain(&taken).into_iter().filter(|(at, _)| *at <= to).collect();
    wanted.push((trimmed.ends, LogEntry::End));
    let given = read(fs::read(&part).unwrap()).unwrap();
    assert_eq!((given.entries, given.broken, given.events), (wanted.clone(), None, wanted.len() - 1));
    let recording = Recording::open(&part).unwrap();
    assert_eq!(recording.begins(), Some(from));
    recording.read_timeline(|line| {
        assert_eq!(line.span, Some((from, trimmed.ends)));
        true
    });
    // Again, over the file itself: the part never grows beyond the one before.
    let wider = (Instant::from_millis(1_000), Instant::from_millis(5_000));
    Recording::open(&part).unwrap().trim(&part, wider, |_| true).unwrap().unwrap();
    assert_eq!(Recording::open(&part).unwrap().begins(), Some(from));
    let before = fs::read(&part).unwrap();
    let stopped = Recording::open(&part).unwrap().trim(&part, wider, |_| false).unwrap();
    assert_eq!((stopped, fs::read(&part).unwrap()), (None, before), "a stopped trim changes nothing");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn a_broken_recording_is_trimmed_up_to_the_break() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("visit.mcap");
    recorded(&entries(9_000), &path);
    let file = fs::read(&path).unwrap();
    fs::write(&path, &file[..file.len() / 2]).unwrap();
    let part = folder.path().join("part.mcap");
    let all = (Instant::START, Instant::from_millis(1 << 30));
    let trimmed = Recording::open(&path).unwrap().trim(&part, all, |_| true).unwrap().unwrap();
    assert!(trimmed.broken.is_some_and(|why| why.contains("it ends")));
    assert_eq!(read(fs::read(&part).unwrap()).unwrap().broken, None);
}
