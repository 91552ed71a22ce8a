//! Trees of ROS parameters as typed values.

use super::names::one_line;
use serde::Deserialize;
use serde_json::Value;

/// A parameter that is not known, or of the wrong kind.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {message}")]
pub struct ParamError {
    /// Where it stands, with dots between the levels.
    pub path: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

/// Reads a tree of parameters.
///
/// # Errors
/// [`ParamError`] with the parameter's name.
pub fn read_params<T: for<'de> Deserialize<'de>>(tree: Value) -> Result<T, ParamError> {
    serde_path_to_error::deserialize(tree).map_err(|error| {
        let path = error.path().to_string();
        ParamError { path, message: one_line(&error.into_inner().to_string()) }
    })
}
