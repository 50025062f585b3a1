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

/// Blocks that may wait for the disk: two seconds of them when time passes in milliseconds.
const WAITING: usize = 2000;

/// How often samples and the file's header go to the disk: what a killed process loses.
const FLUSH: Duration = Duration::from_millis(100);

/// How samples are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WavFormat {
    /// 24-bit integers, as the paper's converters take them.
    #[default]
    Pcm24,
    /// 32-bit floating point.
    Float32,
}

/// What to do when the disk is slower than the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WhenFull {
    /// Leave out samples and write silence in their place, so that sensing is never held up: for a live floor.
    #[default]
    LeaveOut,
    /// Wait for the disk: for work faster than real time.
    Wait,
}

/// How a [`WavSink`] records.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct WavOptions {
    /// When the first sample is, on the floor's sample clock.
    pub start: Instant,
    /// How samples are written.
    pub format: WavFormat,
    /// What to do when the disk is too slow.
    pub when_full: WhenFull,
    /// Measures the latency of the cues, if wanted.
    pub latency: Option<LatencyProbe>,
    /// Counts the frames that the disk did not take.
    pub lost: Arc<AtomicU64>,
}

impl WavOptions {
    /// The first sample is at `start` on the floor's sample clock.
    #[must_use]
    pub fn with_start(self, start: Instant) -> Self {
        Self { start, ..self }
    }

    /// Samples are written in `format`.
    #[must_use]
    pub fn with_format(self, format: WavFormat) -> Self {
        Self { format, ..self }
    }

    /// What is done when the disk is too slow.
    #[must_use]
    pub fn with_when_full(self, when_full: WhenFull) -> Self {
        Self { when_full, ..self }
    }

    /// `lost` counts the frames that the disk did not take, also those that are found missing at the very end.
    #[must_use]
    pub fn with_lost(self, lost: Arc<AtomicU64>) -> Self {
        Self { lost, ..self }
    }

    /// `latency` measures the cues.
    #[must_use]
    pub fn with_latency(self, latency: LatencyProbe) -> Self {
        Self { latency: Some(latency), ..self }
    }
}

/// What a finished recording consists of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WavSummary {
    /// The files, in order: more than one if the samples passed 4 GB.
    pub files: Vec<PathBuf>,
    /// Frames in all of them together.
    pub frames: u64,
    /// Frames of silence that stand for samples the disk was too slow for.
    pub left_out: u64,
}

/// Records the actuator channels in a WAV file, written by a thread of its own.
///
/// The file can be read up to the last tenth of a second whatever becomes of the process. When the disk is full, what
/// it took stays readable, what it doesn't take is counted, and the recording is tried again every second in a file
/// of its own.
/// A recording of more than 4 GB goes on in `NAME-2.wav`, `NAME-3.wav` and so on.
#[derive(Debug)]
pub struct WavSink {
    lockstep: Lockstep,
    path: PathBuf,
    when_full: WhenFull,
    probe: Option<LatencyProbe>,
    pieces: Option<SyncSender<Piece>>,
    writer: Option<JoinHandle<Result<WavSummary, SinkError>>>,
    /// Frames that were left out since the last piece that went through.
    gap: u64,
    left_out: u64,
}

/// What the writer is handed.
enum Piece {
    /// Interleaved samples.
    Samples(Vec<f32>),
    /// So many frames of silence.
    Gap(u64),
}

impl WavSink {
    /// Begins a recording at `path`, replacing what was there.
    ///
    /// # Errors
    /// [`SinkError::File`] if the file can't be made, or a WAV file can't have that many channels (or none).
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

    /// Ends the recording; the answer says what there is to find where.
    ///
    /// # Errors
    /// [`SinkError::File`] if the disk did not take all of it: the first failure.
    pub fn finish(mut self) -> Result<WavSummary, SinkError> {
        self.close()
    }

    /// The renderer inside, for its rate and counters.
    #[must_use]
    pub fn renderer(&self) -> &Renderer {
        self.lockstep.renderer()
    }

    /// The renderer inside, for its scope.
    pub fn renderer_mut(&mut self) -> &mut Renderer {
        self.lockstep.renderer_mut()
    }

    /// Frames left out so far because the disk was too slow.
    #[must_use]
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    fn close(&mut self) -> Result<WavSummary, SinkError> {
        if let Some(pieces) = self.pieces.take()
            && self.gap > 0
        {
            // If this fails, so did the writer, and its answer says why.
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
            // The writer has stopped: its answer says why.
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

/// Hands a block to the writer, after the gap before it, if any; the answer is whether there was room.
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

/// The writer's whole life: pieces come until the sink lets go.
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
