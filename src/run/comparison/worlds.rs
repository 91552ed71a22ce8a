//! The worlds of a comparison, with their starts checked before the first run.

use super::{CompareError, Starts};
use crate::config::RobotConfig;
use crate::io::load_world;
use crate::report::{ComparedWorld, WorldPicture};
use crate::run::{NamedWorld, PlanError};

/// A world that runs can share, and what reports say of it.
pub(super) struct LoadedWorld {
    /// The world.
    pub named: NamedWorld,
    /// Its starts and its picture.
    pub compared: ComparedWorld,
}

/// Loads worlds by name or by file, and checks that the robot can start where it is to.
pub(super) fn load_worlds(
    names_or_files: &[String],
    starts: &Starts,
    robot: &RobotConfig,
) -> Result<Vec<LoadedWorld>, CompareError> {
    let load_one = |name_or_file: &String| {
        let (truth, name) = load_world(name_or_file)?;
        let named = NamedWorld::new(name.clone(), &truth)?;
        let starts = starts.of(&named).map_err(|source| CompareError::Starts { world: name.clone(), source })?;
        for start in &starts {
            let wrong = |source| PlanError::World { name: name.clone(), source };
            named.world.check_start(start, &robot.footprint).map_err(wrong)?;
        }
        let picture = WorldPicture::of(&truth)?;
        Ok(LoadedWorld { named, compared: ComparedWorld { name, starts, picture } })
    };
    names_or_files.iter().map(load_one).collect()
}
