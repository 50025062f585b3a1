//! Failures of commands, as reported on standard error.

use std::path::PathBuf;

use thiserror::Error;
use underfoot::parallel::ThreadPoolError;
use underfoot::recording::RecordingError;
use underfoot::runtime::StartError;
use underfoot::schema::{Diagnostics, SaveError};
use underfoot::sink::SinkError;
use underfoot::source::SourceError;
use underfoot_io::serial::SerialError;
use underfoot_scene::picture::PictureError;

/// The reason why a command failed, in words for its user.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// One of our files has errors.
    #[error("{0}")]
    Diagnostics(#[from] Diagnostics),
    /// The source of packets failed.
    #[error("error: {0}")]
    Source(#[from] SourceError),
    /// A serial port can't be used.
    #[error("error: {0}")]
    Serial(#[from] SerialError),
    /// Samples or events can't be sent.
    #[error("error: {0}")]
    Sink(#[from] SinkError),
    /// A file can't be written or read.
    #[error("error: {path}: {error}", path = .0.display(), error = .1)]
    File(PathBuf, std::io::Error),
    /// No window can be opened.
    #[cfg(feature = "preview")]
    #[error("error: no window can be opened: {0}; `underfoot session` plays the same without one")]
    NoWindow(String),
    /// A floor can't be saved.
    #[error("error: {0}")]
    Save(#[from] SaveError),
    /// A picture can't be drawn.
    #[error("error: {0}")]
    Picture(#[from] PictureError),
    /// A recording can't be opened.
    #[error("error: {0}")]
    Recording(#[from] RecordingError),
    /// The system provides no threads.
    #[error("error: {0}")]
    ThreadPool(#[from] ThreadPoolError),
    /// Anything else, as a complete sentence.
    #[error("error: {0}")]
    Other(String),
}

impl From<StartError> for Failure {
    fn from(error: StartError) -> Self {
        match error {
            StartError::Source(error) => error.into(),
            StartError::Sink(error) => error.into(),
            error => Self::Other(error.to_string()),
        }
    }
}
