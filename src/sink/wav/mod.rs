//! Samples in WAV files, written by a thread of their own.

mod files;

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant as WallInstant};

pub(super) use self::files::file_error;
use self::files::{FILE_BYTES, Files};
use super::lockstep::Lockstep;
use super::{ActuatorSink, HandedOn, LatencyProbe, SinkError};
use crate::feel::Renderer;
use crate::units::Instant;

/// Maximum number of blocks that wait for the disk: two seconds of them at one block per millisecond.
const WAITING: usize = 2000;

/// Interval between two writes of samples and file header: the maximum loss of a killed process.
const FLUSH: Duration = Duration::from_millis(100);

/// Sample format of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WavFormat {
    /// 24-bit integers, as in the paper's converters.
    #[default]
    Pcm24,
    /// 32-bit floating point.
    Float32,
}

/// Behaviour when the disk is slower than the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WhenFull {
    /// Drop samples and write silence in their place, so that sensing never waits: for a live floor.
    #[default]
    LeaveOut,
    /// Wait for the disk: for work faster than real time.
    Wait,
}

/// Options of a [`WavSink`].
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct WavOptions {
    /// Time of the first sample, on the floor's sample clock.
    pub start: Instant,
    /// Sample format.
    pub format: WavFormat,
    /// Behaviour when the disk is too slow.
    pub when_full: WhenFull,
    /// Measures the latency of the cues, if present.
    pub latency: Option<LatencyProbe>,
    /// Counts the frames that the disk did not accept.
    pub lost: Arc<AtomicU64>,
}

impl WavOptions {
    /// Sets the time of the first sample on the floor's sample clock.
    #[must_use]
    pub fn with_start(self, start: Instant) -> Self {
        Self { start, ..self }
    }

    /// Sets the sample format.
    #[must_use]
    pub fn with_format(self, format: WavFormat) -> Self {
        Self { format, ..self }
    }

    /// Sets the behaviour when the disk is too slow.
    #[must_use]
    pub fn with_when_full(self, when_full: WhenFull) -> Self {
        Self { when_full, ..self }
    }

    /// Counts in `lost` the frames that the disk did not accept, including those found missing at the very end.
    #[must_use]
    pub fn with_lost(self, lost: Arc<AtomicU64>) -> Self {
        Self { lost, ..self }
    }

    /// Measures the latency of the cues with `latency`.
    #[must_use]
    pub fn with_latency(self, latency: LatencyProbe) -> Self {
        Self { latency: Some(latency), ..self }
    }
}

/// Summary of a finished recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WavSummary {
    /// The files, in order: more than one if the samples passed 4 GB.
    pub files: Vec<PathBuf>,
    /// Total number of frames.
    pub frames: u64,
    /// Number of silent frames in place of samples that the disk was too slow for.
    pub left_out: u64,
}

/// Records the actuator channels in a WAV file, written by a thread of its own.
///
/// The file is readable up to the last tenth of a second even if the process is killed. When the disk is full, the
/// written part stays readable, further frames are counted as lost, and every second the sink tries to continue in
/// another file. A recording of more than 4 GB continues in `NAME-2.wav`, `NAME-3.wav` and so on.
#[derive(Debug)]
pub struct WavSink {
    lockstep: Lockstep,
    path: PathBuf,
    when_full: WhenFull,
    probe: Option<LatencyProbe>,
    pieces: Option<SyncSender<Piece>>,
    writer: Option<JoinHandle<Result<WavSummary, SinkError>>>,
    /// Number of frames dropped since the last piece that was passed on.
    gap: u64,
    left_out: u64,
}

/// Input of the writer.
enum Piece {
    /// Interleaved samples.
    Samples(Vec<f32>),
    /// A number of frames of silence.
    Gap(u64),
}

impl WavSink {
    /// Begins a recording at `path` and replaces an existing file.
    ///
    /// # Errors
    /// [`SinkError::File`] if the file cannot be created, or a WAV file cannot have that many channels (or none).
    pub fn create(
        path: impl Into<PathBuf>,
        renderer: Renderer,
        options: WavOptions,
    ) -> Result<Self, SinkError> {
        let path = path.into();
        let files = Files::create(path.clone(), &renderer, options.format, FILE_BYTES, options.lost)?;
        let (sender, receiver) = sync_channel(WAITING);
        let writer = thread::Builder::new()
            .name("wav".into())
            .spawn(move || write_all(files, &receiver))
            .map_err(|source| SinkError::File { path: path.clone(), source })?;
        Ok(Self {
            lockstep: Lockstep::new(renderer, options.start),
            path,
            when_full: options.when_full,
            probe: options.latency,
            pieces: Some(sender),
            writer: Some(writer),
            gap: 0,
            left_out: 0,
        })
    }

    /// Ends the recording and returns its summary.
    ///
    /// # Errors
    /// [`SinkError::File`] if the disk did not accept all of it: the first failure.
    pub fn finish(mut self) -> Result<WavSummary, SinkError> {
        self.close()
    }

    /// Returns the renderer, for its rate and counters.
    #[must_use]
    pub fn renderer(&self) -> &Renderer {
        self.lockstep.renderer()
    }

    /// Returns the number of frames dropped so far because the disk was too slow.
    #[must_use]
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    fn close(&mut self) -> Result<WavSummary, SinkError> {
        if let Some(pieces) = self.pieces.take()
            && self.gap > 0
        {
            // If this fails, the writer has failed too, and its result gives the reason.
            let _ = pieces.send(Piece::Gap(self.gap));
        }
        let broken = || SinkError::File {
            path: self.path.clone(),
            source: io::Error::other("the recording has ended already"),
        };
        let writer = self.writer.take().ok_or_else(broken)?;
        let mut summary = writer.join().map_err(|_| broken())??;
        summary.left_out = self.left_out;
        Ok(summary)
    }
}

impl ActuatorSink for WavSink {
    fn advance(&mut self, now: Instant) -> Result<(), SinkError> {
        let Self { lockstep, when_full, probe, pieces, gap, left_out, .. } = self;
        let width = lockstep.renderer().channels().max(1);
        let passed_on = lockstep.advance(now, |block, onsets| {
            let pieces = pieces.as_ref().ok_or(())?;
            if let Some(probe) = probe {
                probe.handed_on(onsets, HandedOn::default());
            }
            let frames = (block.len() / width) as u64;
            if !pass_on(pieces, *when_full, gap, block)? {
                *gap += frames;
                *left_out += frames;
            }
            Ok::<(), ()>(())
        });
        match passed_on {
            Ok(()) => Ok(()),
            // The writer has stopped: its result gives the reason.
            Err(()) => Err(match self.close() {
                Err(error) => error,
                Ok(_) => SinkError::File {
                    path: self.path.clone(),
                    source: io::Error::other("the recording ended early"),
                },
            }),
        }
    }
}

/// Passes a block to the writer, after the gap before it, if any; returns whether there was room.
fn pass_on(
    pieces: &SyncSender<Piece>,
    when_full: WhenFull,
    gap: &mut u64,
    block: &[f32],
) -> Result<bool, ()> {
    if when_full == WhenFull::Wait {
        return pieces.send(Piece::Samples(block.to_vec())).map(|()| true).map_err(|_| ());
    }
    if *gap > 0 {
        match pieces.try_send(Piece::Gap(*gap)) {
            Ok(()) => *gap = 0,
            Err(TrySendError::Full(_)) => return Ok(false),
            Err(TrySendError::Disconnected(_)) => return Err(()),
        }
    }
    match pieces.try_send(Piece::Samples(block.to_vec())) {
        Ok(()) => Ok(true),
        Err(TrySendError::Full(_)) => Ok(false),
        Err(TrySendError::Disconnected(_)) => Err(()),
    }
}

impl Drop for WavSink {
    fn drop(&mut self) {
        if self.writer.is_some()
            && let Err(error) = self.close()
        {
            tracing::error!("{error}");
        }
    }
}

/// Runs the writer: receives pieces until the sink closes the channel.
fn write_all(mut files: Files, pieces: &Receiver<Piece>) -> Result<WavSummary, SinkError> {
    let mut flushed = WallInstant::now();
    loop {
        match pieces.recv_timeout(FLUSH) {
            Ok(Piece::Samples(samples)) => files.write(&samples),
            Ok(Piece::Gap(frames)) => files.write_silence(frames),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return files.finish(),
        }
        if flushed.elapsed() >= FLUSH {
            files.flush();
            flushed = WallInstant::now();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::{RendererConfig, renderer};
    use crate::floor::Floor;

    #[test]
    fn a_slow_disk_costs_samples_but_not_their_time() {
        let (sender, receiver) = sync_channel(2);
        let mut gap = 0;
        assert_eq!(pass_on(&sender, WhenFull::LeaveOut, &mut gap, &[0.1]), Ok(true));
        assert_eq!(pass_on(&sender, WhenFull::LeaveOut, &mut gap, &[0.2]), Ok(true));
        assert_eq!(pass_on(&sender, WhenFull::LeaveOut, &mut gap, &[0.3]), Ok(false));
        gap += 1;
        receiver.recv().unwrap();
        receiver.recv().unwrap();
        assert_eq!(pass_on(&sender, WhenFull::LeaveOut, &mut gap, &[0.4]), Ok(true));
        assert!(matches!(receiver.recv(), Ok(Piece::Gap(1))));
        assert!(matches!(receiver.recv(), Ok(Piece::Samples(samples)) if samples == [0.4]));
        drop(receiver);
        assert_eq!(pass_on(&sender, WhenFull::LeaveOut, &mut gap, &[0.5]), Err(()));
    }

    #[test]
    fn a_floor_without_actuators_cannot_be_recorded() {
        let mut floor = Floor::default();
        floor.actuators.fill(None);
        let renderer = renderer(RendererConfig::of(&floor, 48_000)).1;
        let folder = tempfile::tempdir().unwrap();
        let error =
            WavSink::create(folder.path().join("a.wav"), renderer, WavOptions::default()).unwrap_err();
        assert!(error.to_string().contains("0 channels"), "{error}");
    }
}
