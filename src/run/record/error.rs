//! Why the results of a run cannot be kept.

use crate::io::MapError;
use crate::report::ReportError;
use std::io;
use std::path::{Path, PathBuf};

/// Results that cannot be made or written.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The folder for the results cannot be made.
    #[error("cannot make the folder {}: {source}", .path.display())]
    Folder {
        /// Which folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", .path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The map cannot be saved.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A picture, the page or `run.json` cannot be made.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// Our decisions beside the recording's cannot be written as JSON.
    #[error("cannot write the comparison as JSON: {0}")]
    Comparison(#[from] serde_json::Error),
}

impl RecordError {
    /// A file that could not be written.
    pub(super) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Write { path: path.to_owned(), source }
    }
}
