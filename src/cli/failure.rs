//! Why a command failed, as it is told on standard error.

use std::path::PathBuf;

use thiserror::Error;
use underfoot::parallel::ThreadPoolError;
use underfoot::picture::PictureError;
use underfoot::recording::RecordingError;
use underfoot::runtime::StartError;
use underfoot::schema::{Diagnostics, SaveError};
use underfoot::sink::SinkError;
use underfoot::source::SourceError;

/// Why a command failed, in words for the person who gave it.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// A file of ours has problems.
    #[error("{0}")]
    Diagnostics(#[from] Diagnostics),
    /// The packets' source failed.
    #[error("error: {0}")]
    Source(#[from] SourceError),
    /// Samples or events can't be put out.
    #[error("error: {0}")]
    Sink(#[from] SinkError),
    /// A file can't be written or read.
    #[error("error: {path}: {error}", path = .0.display(), error = .1)]
    File(PathBuf, std::io::Error),
    /// There can be no window.
    #[cfg(feature = "preview")]
    #[error("error: no window can be opened: {0}; `underfoot session` plays the same without one")]
    NoWindow(String),
    /// A floor can't be kept.
    #[error("error: {0}")]
    Save(#[from] SaveError),
    /// A picture can't be made.
    #[error("error: {0}")]
    Picture(#[from] PictureError),
    /// A recording can't be begun.
    #[error("error: {0}")]
    Recording(#[from] RecordingError),
    /// The system gives no threads.
    #[error("error: {0}")]
    ThreadPool(#[from] ThreadPoolError),
    /// Anything else, said in full.
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
