//! The reason why a file is not shown, in words for the user.

use thiserror::Error;

/// Largest file that is read, in bytes: larger than the largest series of a day's imaging in one file.
pub const LARGEST_FILE: u64 = 1 << 30;

/// Greatest number of pixels kept at once, of all series: a gibibyte of them.
pub const MOST_PIXELS: usize = 1 << 28;

/// The reason why a file is not shown. Each text continues a sentence that begins with the file's name.
#[derive(Debug, Error)]
pub enum Unfit {
    #[error("can't be read: {0}")]
    Io(#[from] std::io::Error),
    #[error("is larger than {} MiB", LARGEST_FILE >> 20)]
    Huge,
    #[error("is not a DICOM file: {0}")]
    NotDicom(&'static str),
    #[error("is a damaged DICOM file: {0}")]
    Damaged(String),
    /// The kind of the file, by its name in the standard.
    #[error("has no picture: it is a “{0}” without pixels")]
    OtherKind(String),
    #[error("has no picture that can be shown: {0} is missing")]
    Missing(&'static str),
    /// The compression or the format of the pixels.
    #[error("has pixels in a format that is not read: {0}")]
    Format(String),
    #[error("has pixels that can't be read: {0}")]
    Pixels(String),
    #[error("does not fit into memory any more: {} million pixels are shown at most", MOST_PIXELS >> 20)]
    Full,
    #[error("is {} x {} pixels, and its series {} x {}", .is[0], .is[1], .series[0], .series[1])]
    OtherSize { is: [usize; 2], series: [usize; 2] },
}

impl Unfit {
    pub fn damaged(why: impl Into<String>) -> Self {
        Self::Damaged(why.into())
    }

    pub fn pixels(why: impl Into<String>) -> Self {
        Self::Pixels(why.into())
    }
}

/// An error with its causes, each once.
pub fn chain(error: &dyn std::error::Error) -> String {
    let mut words = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let more = error.to_string();
        if !words.contains(&more) {
            words = format!("{words}: {more}");
        }
        cause = error.source();
    }
    words
}
