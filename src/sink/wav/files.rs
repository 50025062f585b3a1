//! The files of a recording: the current one, the full ones, and recovery from a full disk.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant as WallInstant};

use hound::{SampleFormat, WavSpec, WavWriter};

use super::{WavFormat, WavSummary};
use crate::feel::Renderer;
use crate::sink::{Disk, SinkError};

/// Interval between attempts to continue a failed recording.
const RETRY: Duration = Duration::from_secs(1);

/// Bytes of samples after which another file begins: a WAV file's sizes have 32 bits.
pub(super) const FILE_BYTES: u64 = u32::MAX as u64 - 4096;

/// The current file, and those that are full or failed.
pub(super) struct Files {
    first: PathBuf,
    done: Vec<PathBuf>,
    path: PathBuf,
    spec: WavSpec,
    /// `None` while the disk accepts nothing.
    writer: Option<WavWriter<BufWriter<File>>>,
    disk: Disk,
    /// Bytes before the samples.
    header_bytes: u64,
    frames_per_file: u64,
    frames_in_file: u64,
    frames: u64,
    /// Count of frames that the disk did not accept.
    lost: Arc<AtomicU64>,
    /// Time of the last failed attempt.
    failed: WallInstant,
    /// The first failure.
    failure: Option<SinkError>,
}

impl Files {
    pub(super) fn create(
        path: PathBuf,
        renderer: &Renderer,
        format: WavFormat,
        limit: u64,
        lost: Arc<AtomicU64>,
    ) -> Result<Self, SinkError> {
        let (bits_per_sample, sample_format) = match format {
            WavFormat::Pcm24 => (24, SampleFormat::Int),
            WavFormat::Float32 => (32, SampleFormat::Float),
        };
        // The format has 16 bits for the bytes per frame and 32 for those per second.
        let frame_bytes = renderer.channels() as u64 * u64::from(bits_per_sample / 8);
        let second_bytes = frame_bytes * u64::from(renderer.sample_rate());
        if frame_bytes == 0 || frame_bytes > u64::from(u16::MAX) || second_bytes > u64::from(u32::MAX) {
            let channels = renderer.channels();
            let message = format!("a WAV file can't have {channels} channels at this rate");
            let source = io::Error::new(io::ErrorKind::InvalidInput, message);
            return Err(SinkError::File { path, source });
        }
        let spec = WavSpec {
            channels: renderer.channels() as u16,
            sample_rate: renderer.sample_rate(),
            bits_per_sample,
            sample_format,
        };
        let (writer, file) = open(&path, spec)?;
        let disk = Disk::of(&file, &path).map_err(|error| file_error(&path, error.into()))?;
        let header_bytes = fs::metadata(&path).map_or(0, |metadata| metadata.len());
        Ok(Self {
            first: path.clone(),
            done: Vec::new(),
            path,
            spec,
            writer: Some(writer),
            disk,
            header_bytes,
            frames_per_file: (limit / frame_bytes).max(1),
            frames_in_file: 0,
            frames: 0,
            lost,
            failed: WallInstant::now(),
            failure: None,
        })
    }

    fn frame_bytes(&self) -> u64 {
        u64::from(self.spec.channels) * u64::from(self.spec.bits_per_sample / 8)
    }

    /// Writes interleaved samples; counts frames that the disk does not accept.
    pub(super) fn write(&mut self, samples: &[f32]) {
        for frame in samples.chunks_exact(usize::from(self.spec.channels)) {
            if let Err(error) = self.write_frame(frame) {
                self.fail(error);
            }
            if self.writer.is_none() {
                self.lost.fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    pub(super) fn write_silence(&mut self, frames: u64) {
        let frame = vec![0.0; usize::from(self.spec.channels)];
        (0..frames).for_each(|_| self.write(&frame));
    }

    fn write_frame(&mut self, frame: &[f32]) -> Result<(), SinkError> {
        self.make_room()?;
        let Some(writer) = &mut self.writer else { return Ok(()) };
        for sample in frame {
            match self.spec.sample_format {
                SampleFormat::Float => writer.write_sample(*sample),
                SampleFormat::Int => writer.write_sample((sample * 8_388_607.0).round() as i32),
            }
            .map_err(|error| file_error(&self.path, error))?;
        }
        self.frames_in_file += 1;
        self.frames += 1;
        Ok(())
    }

    /// Begins the next file if the current one is full.
    fn make_room(&mut self) -> Result<(), SinkError> {
        if self.frames_in_file < self.frames_per_file {
            return Ok(());
        }
        let Some(full) = self.writer.take() else { return Ok(()) };
        full.finalize().map_err(|error| file_error(&self.path, error))?;
        self.begin_next()
    }

    fn begin_next(&mut self) -> Result<(), SinkError> {
        let next = numbered(&self.first, self.done.len() + 2);
        let begun = open(&next, self.spec).and_then(|(writer, file)| {
            self.disk.go_on(&file, &next).map_err(|error| file_error(&next, error.into()))?;
            Ok(writer)
        });
        let writer = begun.inspect_err(|_| {
            // An empty file beside the others has no use; the error is the writer's.
            let _ = fs::remove_file(&next);
        })?;
        self.writer = Some(writer);
        self.done.push(std::mem::replace(&mut self.path, next));
        self.frames_in_file = 0;
        Ok(())
    }

    /// Closes the current file after an error, so that the samples on the disk are readable.
    fn fail(&mut self, error: SinkError) {
        self.failed = WallInstant::now();
        // The writer's own attempt to write the rest may fail as well.
        self.writer = None;
        let kept = mend(&self.path, self.header_bytes, self.frame_bytes()).unwrap_or(0);
        let missing = self.frames_in_file.saturating_sub(kept);
        self.frames_in_file -= missing;
        self.frames = self.frames.saturating_sub(missing);
        self.lost.fetch_add(missing, Ordering::Relaxed);
        if self.failure.is_none() {
            tracing::warn!("{error}; the recording is tried again every second");
            self.failure = Some(error);
        }
    }

    /// Writes everything to the disk, with the file's size in its header, so that a killed process leaves a readable
    /// file. Without a current file, tries to continue in another one.
    pub(super) fn flush(&mut self) {
        let flushed = match &mut self.writer {
            Some(writer) => writer
                .flush()
                .and_then(|()| Ok(self.disk.tend()?))
                .map_err(|error| file_error(&self.path, error)),
            None if self.failed.elapsed() < RETRY => Ok(()),
            None => {
                self.failed = WallInstant::now();
                if self.begin_next().is_ok() {
                    tracing::warn!("the recording goes on in {}", self.path.display());
                }
                Ok(())
            }
        };
        if let Err(error) = flushed {
            self.fail(error);
        }
    }

    pub(super) fn finish(mut self) -> Result<WavSummary, SinkError> {
        if let Some(writer) = self.writer.take()
            && let Err(error) = writer.finalize()
        {
            self.fail(file_error(&self.path, error));
        }
        self.done.push(self.path);
        match self.failure {
            Some(error) => Err(error),
            None => Ok(WavSummary { files: self.done, frames: self.frames, left_out: 0 }),
        }
    }
}

/// Begins a WAV file with its header on the disk at once; returns a second handle of the file as well.
fn open(path: &Path, spec: WavSpec) -> Result<(WavWriter<BufWriter<File>>, File), SinkError> {
    let begin = || {
        let file = File::create(path)?;
        let handle = file.try_clone()?;
        let mut writer = WavWriter::new(BufWriter::new(file), spec)?;
        writer.flush()?;
        Ok((writer, handle))
    };
    begin().map_err(|error| file_error(path, error))
}

/// Sets the sizes in a WAV file's header to those of its whole frames on the disk, and returns the number of frames.
///
/// # Source
/// Multimedia Programming Interface 1.0 (IBM, Microsoft, 1991): the RIFF chunk's size stands at byte 4, and that of
/// the data chunk in the last four bytes before the samples.
fn mend(path: &Path, header_bytes: u64, frame_bytes: u64) -> io::Result<u64> {
    let mut file = OpenOptions::new().write(true).open(path)?;
    let samples = file.metadata()?.len().saturating_sub(header_bytes);
    let frames = samples / frame_bytes.max(1);
    let size = |bytes: u64| u32::try_from(bytes).unwrap_or(u32::MAX).to_le_bytes();
    file.set_len(header_bytes + frames * frame_bytes)?;
    file.seek(SeekFrom::Start(4))?;
    file.write_all(&size(header_bytes + frames * frame_bytes - 8))?;
    file.seek(SeekFrom::Start(header_bytes - 4))?;
    file.write_all(&size(frames * frame_bytes))?;
    Ok(frames)
}

/// `floor.wav` becomes `floor-2.wav`.
fn numbered(path: &Path, number: usize) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_os_string();
    name.push(format!("-{number}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

pub(crate) fn file_error(path: &Path, error: hound::Error) -> SinkError {
    let source = match error {
        hound::Error::IoError(source) => source,
        other => io::Error::other(other),
    };
    SinkError::File { path: path.to_path_buf(), source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::{RendererConfig, renderer};
    use crate::floor::{Floor, Geometry};

    fn files(path: PathBuf, limit: u64) -> Files {
        let floor = Floor::of(Geometry::of_paper_tiles(3, 1).unwrap());
        let renderer = renderer(RendererConfig::of(&floor, 48_000)).1;
        Files::create(path, &renderer, WavFormat::Float32, limit, Arc::default()).unwrap()
    }

    fn read(path: &Path) -> Vec<f32> {
        hound::WavReader::open(path).unwrap().samples::<f32>().map(Result::unwrap).collect()
    }

    /// The file that a process leaves if it is killed between two flushes.
    // F5
    #[test]
    fn the_file_is_readable_while_it_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.wav");
        let mut files = files(path.clone(), FILE_BYTES);
        assert!(read(&path).is_empty());
        files.write(&[0.5, -0.25, 0.0]);
        files.flush();
        files.write(&[1.0, 1.0, 1.0]);
        assert_eq!(read(&path), [0.5, -0.25, 0.0]);
        files.finish().unwrap();
        assert_eq!(read(&path).len(), 6);
    }

    #[test]
    fn a_recording_too_long_for_one_file_goes_on_in_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.wav");
        // Room for two frames of three 4-byte samples.
        let mut files = files(path, 30);
        files.write(&[0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.3, 0.3, 0.3]);
        files.write_silence(2);
        let summary = files.finish().unwrap();
        assert_eq!(summary.frames, 5);
        assert_eq!(summary.files, ["floor.wav", "floor-2.wav", "floor-3.wav"].map(|n| folder.path().join(n)));
        assert_eq!(read(&summary.files[1]), [0.3, 0.3, 0.3, 0.0, 0.0, 0.0]);
        assert_eq!(read(&summary.files[2]), [0.0; 3]);
    }

    // F4
    #[test]
    fn what_a_disk_took_before_it_was_full_is_readable_and_the_rest_is_counted() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.wav");
        let mut files = files(path.clone(), FILE_BYTES);
        files.write(&[0.5; 9]);
        files.flush();
        // Half a frame more, as after a failed write on a full disk.
        OpenOptions::new().append(true).open(&path).unwrap().write_all(&[1; 7]).unwrap();
        files.fail(SinkError::File { path: path.clone(), source: io::ErrorKind::StorageFull.into() });
        files.write(&[0.1; 6]);
        assert_eq!(read(&path), [0.5; 9]);
        assert_eq!(files.lost.load(Ordering::Relaxed), 2);
        // There is room again.
        files.failed = WallInstant::now().checked_sub(RETRY).unwrap();
        files.flush();
        files.write(&[0.2; 3]);
        let error = files.finish().unwrap_err();
        assert!(error.to_string().contains("floor.wav"), "{error}");
        assert_eq!(read(&folder.path().join("floor-2.wav")), [0.2; 3]);
    }
}
