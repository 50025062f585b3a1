//! A pad of four sensors behind a pseudo terminal, with firmware that can be pulled out and plugged in.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscPacket, OscType, encoder};
use serialport::{SerialPort, TTYPort};
use underfoot::wire::write_slip;

/// Firmware of a pad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Firmware {
    /// Sends a line a millisecond.
    Lines,
    /// Sends a line for each `v` and line feed that it gets.
    Asked,
    /// Sends OSC in SLIP frames.
    Slip,
    /// Sends bytes as a board at another baud rate.
    Noise,
    /// Sends lines that break off, and pieces of others.
    HalfLines,
}

impl Firmware {
    /// The port of this firmware in a floor file, with the name `port`.
    pub(crate) fn port(self, port: &Path, board: u16) -> String {
        let port = port.display();
        let lines = match self {
            Self::Slip => return format!("Serial(port: \"{port}\")"),
            Self::Asked => "request: \"v\", request_end: Lf, columns: [2, 3, 4, 5], ",
            Self::Lines | Self::Noise | Self::HalfLines => "",
        };
        format!("Serial(port: \"{port}\", lines: Lines(board: {board}, {lines}full_scale: 1023))")
    }

    fn message(self, sequence: u32, counts: [f32; 4]) -> Vec<u8> {
        let text = counts.map(|count| format!("{count:.1}")).join(" ");
        match self {
            Self::Lines => format!("{text}\r\n").into_bytes(),
            Self::Asked => format!("v {text}\n").into_bytes(),
            Self::Slip => {
                let counts = counts.map(|count| OscType::Int((count * 64.0) as i32));
                let args = std::iter::once(OscType::Int(sequence.cast_signed())).chain(counts).collect();
                let message = OscMessage { addr: "/underfoot/board/0".into(), args };
                let mut framed = Vec::new();
                write_slip(&encoder::encode(&OscPacket::Message(message)).unwrap(), &mut framed);
                framed
            }
            Self::Noise => (0..16).map(|byte| hash(sequence, byte) as u8).collect(),
            Self::HalfLines => {
                let line = format!("{text}\n").into_bytes();
                let (from, to) = (hash(sequence, 1) as usize % 20, hash(sequence, 2) as usize % 20);
                line.into_iter().skip(from).take(to).collect()
            }
        }
    }
}

/// Multiplicative hash, for noise.
fn hash(sequence: u32, salt: u32) -> u32 {
    (sequence.wrapping_mul(2_654_435_761) ^ salt.wrapping_mul(0x9E37_79B9)).wrapping_mul(0x85EB_CA6B) >> 16
}

/// The foot on the pad: its load as bits of an f32, in counts of ten bits a sensor.
#[derive(Clone, Default)]
pub(crate) struct Foot(Arc<AtomicU32>);

impl Foot {
    /// Comes down or lifts within a tenth of a second, as legs do.
    pub(crate) fn moves_to(&self, counts: f32) {
        let from = f32::from_bits(self.0.load(Ordering::Relaxed));
        for step in 1..=12_u8 {
            let load = from + (counts - from) * f32::from(step) / 12.0;
            self.0.store(load.to_bits(), Ordering::Relaxed);
            sleep(Duration::from_millis(10));
        }
    }

    /// The counts of the four sensors in this sample, with noise.
    pub(crate) fn counts(&self, sample: u32) -> [f32; 4] {
        let load = f32::from_bits(self.0.load(Ordering::Relaxed));
        [3, 5, 7, 11].map(|salt| 120.0 + load + (hash(sample, salt) & 0xFF) as f32 / 256.0 - 0.5)
    }
}

/// A pad that is plugged in; it is unplugged when it is dropped.
pub(crate) struct Pad {
    path: PathBuf,
    stop: Arc<AtomicBool>,
    firmware: Option<JoinHandle<()>>,
}

impl Pad {
    /// Plugs a pad in at `path`, under `foot`.
    pub(crate) fn plug(path: &Path, firmware: Firmware, foot: &Foot) -> Self {
        let (mut master, slave) = TTYPort::pair().unwrap();
        master.set_timeout(Duration::from_millis(1)).unwrap();
        // The driver of a device waits for its reader; a pseudo terminal without one fails.
        std::os::unix::fs::symlink(slave.name().unwrap(), path).unwrap();
        let stop = Arc::<AtomicBool>::default();
        let (told, foot) = (Arc::clone(&stop), foot.clone());
        let firmware = spawn(move || {
            let begun = Instant::now();
            // The open end keeps the terminal while nobody reads it.
            let _slave = slave;
            for sample in 0.. {
                if told.load(Ordering::Relaxed) {
                    return;
                }
                if firmware == Firmware::Asked {
                    let mut request = [0; 2];
                    while master.read_exact(&mut request).is_err() && !told.load(Ordering::Relaxed) {}
                } else {
                    sleep(Duration::from_millis(sample).saturating_sub(begun.elapsed()));
                }
                let sample = u32::try_from(sample).unwrap();
                // Without a reader, the bytes are lost.
                drop(master.write_all(&firmware.message(sample, foot.counts(sample))));
            }
        });
        Self { path: path.to_owned(), stop, firmware: Some(firmware) }
    }
}

impl Drop for Pad {
    fn drop(&mut self) {
        drop(std::fs::remove_file(&self.path));
        self.stop.store(true, Ordering::Relaxed);
        if let Some(firmware) = self.firmware.take() {
            firmware.join().unwrap();
        }
    }
}
