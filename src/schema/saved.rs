//! Results of saving.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::Diagnostics;

/// Result of saving.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saved {
    /// The file did not exist.
    New,
    /// The file already had the same content and was not changed.
    Unchanged,
    /// The file was replaced; a backup holds its previous content.
    Replaced {
        /// The backup of the previous content.
        backup: PathBuf,
    },
}

/// Reason for which a file could not be saved. The previous content is unchanged.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The floor has numbers that floor files may not hold, or is too large for one.
    #[error("this floor can't be kept in a file:\n{0}")]
    Unreadable(Diagnostics),
    /// The system reported an error.
    #[error("{} could not be saved while {doing}: {source}; what it held before is untouched", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The step that failed.
        doing: &'static str,
        /// The error of the system.
        #[source]
        source: io::Error,
    },
}
