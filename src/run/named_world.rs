//! A world with its name, which several runs can share.

use super::PlanError;
use crate::grid::OccupancyGrid;
use crate::sim::{SimConfig, World};
use std::sync::Arc;

/// A world that runs can share.
#[derive(Clone)]
pub struct NamedWorld {
    /// What reports call it.
    pub name: String,
    /// The world.
    pub world: Arc<World>,
}

impl NamedWorld {
    /// A world from its ground truth. That is read as map_server reads it, whatever a preset
    /// makes of the map that comes of it: presets that are compared drive in the same world.
    ///
    /// # Errors
    /// [`PlanError::World`] for a map that is no world.
    pub fn new(name: String, truth: &OccupancyGrid) -> Result<Self, PlanError> {
        match World::new(truth, &SimConfig::default().thresholds) {
            Ok(world) => Ok(Self { name, world: Arc::new(world) }),
            Err(source) => Err(PlanError::World { name, source }),
        }
    }
}
