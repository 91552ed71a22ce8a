//! Why the simulator cannot run.

use super::params::SimParamsError;
use crate::io::{MapError, SettingsFileError};
use crate::ros::NodeError;
use crate::run::PlanError;
use crate::sim::MapperError;

/// What keeps `sim_node` from its work.
#[derive(Debug, thiserror::Error)]
pub enum SimNodeError {
    /// ROS refuses.
    #[error(transparent)]
    Node(#[from] NodeError),
    /// A parameter is wrong.
    #[error(transparent)]
    Params(#[from] SimParamsError),
    /// A robot or a preset cannot be had.
    #[error(transparent)]
    Settings(#[from] SettingsFileError),
    /// The world cannot be read.
    #[error("parameter ~world: {0}")]
    World(#[from] MapError),
    /// The simulation cannot begin.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The map cannot grow any more.
    #[error(transparent)]
    Mapper(#[from] MapperError),
}
