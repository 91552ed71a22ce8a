//! Why a map could not be read or written: one sentence each.

use crate::grid::{GridInfoError, MAX_CELLS, ThresholdError};
use std::path::{Path, PathBuf};

/// What is wrong with a map, and in which file.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The file system refused.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A word that is neither a file nor the name of a built-in world.
    #[error("there is no world {name:?}: must be one of {known}, or a map_server YAML file{hint}")]
    NoSuchWorld {
        /// As given.
        name: String,
        /// The built-in worlds.
        known: String,
        /// The nearest of them, if one is near.
        hint: String,
    },
    /// A directory, pipe or device where a file is needed.
    #[error("{} is {found}: must be {expected}", .path.display())]
    NotAFile {
        /// Which path.
        path: PathBuf,
        /// What it is instead.
        found: &'static str,
        /// What is needed.
        expected: &'static str,
    },
    /// Nothing in the file.
    #[error("{} is empty", .path.display())]
    Empty {
        /// Which file.
        path: PathBuf,
    },
    /// More bytes than are ever needed.
    #[error("{} has {bytes} bytes: {expected} must have at most {max_bytes}", .path.display())]
    TooLarge {
        /// Which file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
        /// The largest size that is read.
        max_bytes: u64,
        /// What it should be.
        expected: &'static str,
    },
    /// Text that is no mapping, or no text: often the image, given for its YAML.
    #[error("{} is not the YAML of a map: {reason}", .path.display())]
    NotYaml {
        /// Which file.
        path: PathBuf,
        /// How one can tell.
        reason: String,
    },
    /// A key that must be there is not.
    #[error("{} has no key '{key}': must be {allowed}", .path.display())]
    MissingKey {
        /// Which file.
        path: PathBuf,
        /// Which key.
        key: &'static str,
        /// What it would say.
        allowed: &'static str,
    },
    /// A key with a value that cannot be.
    #[error("{}: {key} is {value}: must be {allowed}", .path.display())]
    Value {
        /// Which file.
        path: PathBuf,
        /// Which key.
        key: &'static str,
        /// As given.
        value: String,
        /// The range in words.
        allowed: &'static str,
    },
    /// Thresholds that contradict each other.
    #[error("{}: free_thresh {free} and occupied_thresh {occupied}: must satisfy 0 <= free_thresh < occupied_thresh <= 1", .path.display())]
    ThresholdOrder {
        /// Which file.
        path: PathBuf,
        /// As given.
        free: f64,
        /// As given.
        occupied: f64,
    },
    /// An image of a kind that is not read.
    #[error("{} is {found}: must be a PGM (P2 or P5) or PNG image", .path.display())]
    ImageKind {
        /// Which file.
        path: PathBuf,
        /// What it looks like.
        found: &'static str,
    },
    /// An image that does not keep to its format.
    #[error("{} is a damaged image: {reason}", .path.display())]
    Image {
        /// Which file.
        path: PathBuf,
        /// Where and how.
        reason: String,
    },
    /// An image that is too large, or without pixels.
    #[error("{} claims {width} x {height} pixels: must be at least 1 and at most {MAX_CELLS} in all", .path.display())]
    ImageSize {
        /// Which file.
        path: PathBuf,
        /// Columns claimed.
        width: u64,
        /// Rows claimed.
        height: u64,
    },
    /// Fewer pixels than the header promised.
    #[error("{} is truncated: it has data for at most {found} of {width} x {height} pixels", .path.display())]
    Truncated {
        /// Which file.
        path: PathBuf,
        /// Pixels that are there, or that a file of this size can hold.
        found: u64,
        /// Columns claimed.
        width: u64,
        /// Rows claimed.
        height: u64,
    },
    /// Numbers that do not make a grid.
    #[error("{}: {source}", .path.display())]
    Grid {
        /// Which file.
        path: PathBuf,
        /// What is wrong with them.
        source: GridInfoError,
    },
    /// Thresholds for saving that contradict each other.
    #[error(transparent)]
    SaveThresholds(#[from] ThresholdError),
    /// A name that a map cannot be saved under.
    #[error("cannot save a map as {}: must end in a file name in UTF-8", .path.display())]
    SaveName {
        /// As given.
        path: PathBuf,
    },
    /// The image could not be packed.
    #[error("cannot make {}: {reason}", .path.display())]
    Encode {
        /// Which file.
        path: PathBuf,
        /// What the encoder said.
        reason: String,
    },
    /// The file system refused.
    #[error("cannot write {}: {source}", .path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// Reads a regular file of at most `max_bytes`, `expected` being what the user should
/// have given in words.
pub(super) fn read_file(path: &Path, expected: &'static str, max_bytes: u64) -> Result<Vec<u8>, MapError> {
    let refused = |source| MapError::Read { path: path.to_path_buf(), source };
    let metadata = std::fs::metadata(path).map_err(refused)?;
    if !metadata.is_file() {
        let found = if metadata.is_dir() { "a directory" } else { "not a regular file" };
        return Err(MapError::NotAFile { path: path.to_path_buf(), found, expected });
    }
    if metadata.len() > max_bytes {
        return Err(MapError::TooLarge { path: path.to_path_buf(), bytes: metadata.len(), max_bytes, expected });
    }
    let bytes = std::fs::read(path).map_err(refused)?;
    if bytes.is_empty() { Err(MapError::Empty { path: path.to_path_buf() }) } else { Ok(bytes) }
}
