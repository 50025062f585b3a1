//! Why a command failed, as it is told on standard error.

use std::fmt;
use std::path::PathBuf;

use underfoot::picture::PictureError;
use underfoot::runtime::StartError;
use underfoot::schema::{Diagnostics, SaveError};
use underfoot::sink::SinkError;
use underfoot::source::SourceError;

/// Why a command failed, in words for the person who gave it.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A file of ours has problems.
    Diagnostics(Diagnostics),
    /// The packets' source failed.
    Source(SourceError),
    /// Samples or events can't be put out.
    Sink(SinkError),
    /// A file can't be written or read.
    File(PathBuf, std::io::Error),
    /// There can be no window.
    #[cfg(feature = "preview")]
    NoWindow(String),
    /// A floor can't be kept.
    Save(SaveError),
    /// A picture can't be made.
    Picture(PictureError),
    /// Anything else, said in full.
    Other(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagnostics(diagnostics) => write!(f, "{diagnostics}"),
            Self::Source(error) => write!(f, "error: {error}"),
            Self::Sink(error) => write!(f, "error: {error}"),
            Self::Save(error) => write!(f, "error: {error}"),
            Self::Picture(error) => write!(f, "error: {error}"),
            Self::File(path, error) => write!(f, "error: {}: {error}", path.display()),
            #[cfg(feature = "preview")]
            Self::NoWindow(reason) => write!(
                f,
                "error: no window can be opened: {reason}; `underfoot session` plays the same without one"
            ),
            Self::Other(message) => write!(f, "error: {message}"),
        }
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Diagnostics(diagnostics)
    }
}

impl From<SourceError> for Failure {
    fn from(error: SourceError) -> Self {
        Self::Source(error)
    }
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

impl From<SinkError> for Failure {
    fn from(error: SinkError) -> Self {
        Self::Sink(error)
    }
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Self {
        Self::Save(error)
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        Self::Picture(error)
    }
}
