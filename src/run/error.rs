//! Why a simulated run cannot begin.

use crate::explore::SettingsError;
use crate::sim::{SimError, WorldError};

/// A plan that cannot be carried out.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The map is no world.
    #[error("world {name}: {source}")]
    World {
        /// The world's name.
        name: String,
        /// What is wrong with it.
        source: WorldError,
    },
    /// The robot cannot begin there, or a setting of the simulation cannot be.
    #[error("world {world}: {source}")]
    Sim {
        /// The world's name.
        world: String,
        /// What is wrong.
        source: SimError,
    },
    /// The explorer's settings contradict each other.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}
