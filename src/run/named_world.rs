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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{Cell, GridInfo};

    #[test]
    fn a_world_is_read_as_map_server_reads_it() {
        let info = GridInfo::new(3, 1, 1.0, Pose::default()).unwrap();
        let truth = OccupancyGrid::new(info, vec![64, 65, -1]).unwrap();
        let world = NamedWorld::new("greys".to_owned(), &truth).unwrap().world;
        assert_eq!([0, 1, 2].map(|x| world.is_solid(Cell::new(x, 0))), [false, true, true]);
        let full = OccupancyGrid::new(info, vec![100; 3]).unwrap();
        let error = NamedWorld::new("full".to_owned(), &full).err().unwrap().to_string();
        assert!(error.starts_with("world full: "), "{error}");
    }
}
