//! The parameters of `explore_node` with all that they name: preset and robot, checked.

use crate::config::{LiveError, NodeParams, NodeParamsError, Preset, RobotConfig};
use crate::explore::SettingsError;
use crate::io::{SettingsFileError, load_preset, load_robot};
use crate::ros::rivals::RivalError;
use crate::ros::{Node, NodeError};

/// Why the node cannot do its work.
#[derive(Debug, thiserror::Error)]
pub enum ExploreNodeError {
    /// ROS refuses.
    #[error(transparent)]
    Node(#[from] NodeError),
    /// A parameter is wrong.
    #[error(transparent)]
    Params(#[from] NodeParamsError),
    /// A parameter that nobody knows.
    #[error("{source}; remove it with `{removal}`: it stays on the parameter server until then")]
    UnknownParam {
        /// Which one, and those that there are.
        source: NodeParamsError,
        /// The command that removes it.
        removal: String,
    },
    /// A preset or a robot that a parameter names cannot be had.
    #[error("parameter ~{parameter}: {source}")]
    File {
        /// Which parameter.
        parameter: &'static str,
        /// What is wrong.
        source: SettingsFileError,
    },
    /// A session that cannot be gone on with.
    #[error("parameter ~resume_from: {file}: {why}")]
    Session {
        /// The file.
        file: String,
        /// What is wrong with it.
        why: String,
    },
    /// Another explorer drives the robot.
    #[error(transparent)]
    Rival(#[from] RivalError),
    /// The parameters that may change while it runs cannot be told.
    #[error(transparent)]
    Live(#[from] LiveError),
    /// The settings contradict each other.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

/// Everything that the parameters say, checked.
pub struct Settings {
    /// The parameters.
    pub params: NodeParams,
    /// How to explore.
    pub preset: Preset,
    /// What explores.
    pub robot: RobotConfig,
}

impl Settings {
    /// Reads the private parameters of a node.
    ///
    /// # Errors
    /// [`ExploreNodeError`] with the parameter that is wrong.
    pub fn read(node: &Node) -> Result<Self, ExploreNodeError> {
        let wrong = |source: NodeParamsError| match source.removal(node.name()) {
            Some(removal) => ExploreNodeError::UnknownParam { source, removal },
            None => source.into(),
        };
        let mut params = NodeParams::from_tree(node.private_params()?).map_err(wrong)?;
        let file = |parameter, source| ExploreNodeError::File { parameter, source };
        let base = load_preset(params.base_preset()).map_err(|e| file("config", e))?;
        let robot = load_robot(&params.robot).map_err(|e| file("robot", e))?;
        let preset = params.apply_to(base).map_err(wrong)?;
        if let (Some(prefix), false) = (node.searched_param("tf_prefix"), params.base_frame.starts_with('/')) {
            let prefix = prefix.trim_matches('/');
            if !prefix.is_empty() {
                params.base_frame = format!("{prefix}/{}", params.base_frame);
            }
        }
        Ok(Self { params, preset, robot })
    }
}
