//! Presets and robots by name or by file.

use super::text_file::read_text;
use crate::config::{Preset, PresetError, RobotConfig, RobotConfigError, builtin_robot};
use std::path::{Path, PathBuf};

/// Settings that cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum SettingsFileError {
    /// The file system refused.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A directory where a file or a name is needed.
    #[error("{} is a directory: must be a YAML file or a built-in name", .0.display())]
    Directory(PathBuf),
    /// What the file says is no preset.
    #[error("{}: {source}", .path.display())]
    Preset {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        source: PresetError,
    },
    /// What the file says is no robot.
    #[error("{}: {source}", .path.display())]
    Robot {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        source: RobotConfigError,
    },
    /// No built-in preset has this name.
    #[error(transparent)]
    PresetName(#[from] PresetError),
    /// No built-in robot has this name.
    #[error(transparent)]
    RobotName(#[from] RobotConfigError),
}

/// A preset from a YAML file, or a built-in one by its name.
///
/// # Errors
/// [`SettingsFileError`] with the file or the valid names.
pub fn load_preset(name_or_file: &str) -> Result<Preset, SettingsFileError> {
    match read_if_file(name_or_file)? {
        Some(text) => Preset::from_yaml(&text, &file_stem(name_or_file))
            .map_err(|source| SettingsFileError::Preset { path: name_or_file.into(), source }),
        None => Ok(Preset::built_in(name_or_file)?),
    }
}

/// A robot from a YAML file, or a built-in one by its name.
///
/// # Errors
/// [`SettingsFileError`] with the file or the valid names.
pub fn load_robot(name_or_file: &str) -> Result<RobotConfig, SettingsFileError> {
    match read_if_file(name_or_file)? {
        Some(text) => RobotConfig::from_yaml(&text)
            .map_err(|source| SettingsFileError::Robot { path: name_or_file.into(), source }),
        None => Ok(builtin_robot(name_or_file)?),
    }
}

/// The name of a file without its folder and ending.
#[must_use]
pub fn file_stem(path: &str) -> String {
    Path::new(path).file_stem().map_or_else(|| path.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Whether a text is written like the path of a file, and not like a name.
pub(super) fn is_like_a_path(text: &str) -> bool {
    let path = Path::new(text);
    path.extension().is_some() || path.components().count() > 1
}

/// The text of a file, if the argument looks like one: it exists, or it is written
/// like a path.
fn read_if_file(name_or_file: &str) -> Result<Option<String>, SettingsFileError> {
    if !is_like_a_path(name_or_file) {
        return Ok(None);
    }
    let path = Path::new(name_or_file);
    if path.is_dir() {
        return Err(SettingsFileError::Directory(path.to_owned()));
    }
    let text = read_text(path);
    text.map(Some).map_err(|source| SettingsFileError::Read { path: path.to_owned(), source })
}
