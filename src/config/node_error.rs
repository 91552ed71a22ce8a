//! What is wrong with the node's parameters, and how to take a wrong one away.

use super::names::unknown;
use super::params::ParamError;
use super::preset::PresetError;
use crate::range::OutOfRange;

/// Parameters that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NodeParamsError {
    /// A name that is not known, or a value of the wrong kind.
    #[error("parameter ~{0}")]
    Wrong(#[from] ParamError),
    /// A number out of its range.
    #[error("parameter ~{0}")]
    OutOfRange(#[from] OutOfRange),
    /// A region that is none.
    #[error("parameter ~region: {0}")]
    Region(String),
    /// A no-go area that is none.
    #[error("parameter ~no_go: area {index}: {why}")]
    NoGo {
        /// Which one, from 0.
        index: usize,
        /// What is wrong.
        why: String,
    },
    /// The settings that come out are no preset.
    #[error("parameter ~{0}")]
    Preset(#[from] PresetError),
}

impl NodeParamsError {
    /// The name that nobody knows, with slashes between its levels, where that is what is wrong.
    #[must_use]
    pub fn unknown_name(&self) -> Option<String> {
        let Self::Wrong(ParamError { path, message }) = self else { return None };
        let (wanted, _) = message.starts_with("unknown field").then(|| unknown(message))??;
        let mut levels: Vec<&str> = path.split('.').filter(|level| !matches!(*level, "" | "?")).collect();
        // Below settings of several kinds, serde names the table alone.
        if levels.last() != Some(&wanted) {
            levels.push(wanted);
        }
        Some(levels.join("/"))
    }

    /// The command that takes a parameter that nobody knows away from a node: it stays on the
    /// parameter server however often the node starts.
    #[must_use]
    pub fn removal(&self, node: &str) -> Option<String> {
        Some(format!("rosparam delete {node}/{}", self.unknown_name()?))
    }
}
