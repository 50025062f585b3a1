//! The files on a full disk, or of a killed program.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::end_to_end::{Served, peak, underfoot};
use crate::ports::free_port;

/// The bytes of samples by a WAV file's header, and those in the file.
fn samples(path: &Path) -> Option<(u64, u64)> {
    let bytes = std::fs::read(path).ok()?;
    let data = bytes.windows(4).position(|four| four == b"data")?;
    let told = u32::from_le_bytes(bytes.get(data + 4..data + 8)?.try_into().ok()?);
    Some((told.into(), (bytes.len() - data - 8) as u64))
}

/// Bytes of one second of the built-in floor: 36 channels of 24 bits at 48 kHz.
const SECOND: u64 = 36 * 3 * 48_000;

/// A limit of 4 MB for a file, which the system reports like a full disk: its content is readable, the recording
/// continues in the next file, and the exit status reports the failure.
// F4
#[test]
fn a_recording_on_a_full_disk_is_tried_again_and_fails() {
    let folder = tempfile::tempdir().unwrap();
    // The shell counts 512 bytes; without the trap the signal would end the program.
    let script = "trap '' XFSZ; ulimit -f 8192; exec \"$0\" \"$@\"";
    let address = format!("127.0.0.1:{}", free_port());
    let output = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_underfoot")])
        .args(["run", "map", "--no-osc", "--wav", "full.wav", "--seconds", "5", "--listen", &address])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("cannot write full.wav") && said.contains("goes on in full-2.wav"), "{said}");
    assert!(said.contains("the recording is not whole"), "{said}");
    for name in ["full.wav", "full-2.wav"] {
        let (told, there) = samples(&folder.path().join(name)).unwrap();
        assert_eq!(told, there, "{name}: the header tells of what is there");
        assert!(told > SECOND / 4, "{name}: {told} bytes");
        let (_, channels) = super::end_to_end::channels(&folder.path().join(name));
        assert_eq!(peak(&channels[0]), 0.0);
    }
}

/// The file of a killed process: its header is at most one flush behind.
// F5
#[test]
fn a_killed_recording_is_readable_to_the_last_flush() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("killed.wav");
    let address = format!("127.0.0.1:{}", free_port());
    let mut server = underfoot()
        .args(["run", "map", "--no-osc", "--listen", &address, "--wav"])
        .arg(&path)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let until = Instant::now() + Duration::from_secs(30);
    while samples(&path).is_none_or(|(told, _)| told < 2 * SECOND) {
        assert!(Instant::now() < until, "nothing is recorded");
        std::thread::sleep(Duration::from_millis(20));
    }
    server.0.kill().unwrap();
    server.0.wait().unwrap();
    let (told, there) = samples(&path).unwrap();
    assert!(told <= there && there - told < SECOND / 4, "{told} of {there} bytes");
    assert!(hound::WavReader::open(&path).unwrap().into_samples::<i32>().all(|sample| sample.is_ok()));
}
