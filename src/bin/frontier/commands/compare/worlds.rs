//! The worlds of a comparison, with their starts checked before the first run.

use super::starts::Table;
use super::unique;
use crate::simulation::NamedWorld;
use anyhow::Context;
use frontier_explorer::config::RobotConfig;
use frontier_explorer::io::load_world;
use frontier_explorer::report::{ComparedWorld, WorldPicture};

/// A world that runs can share, and what reports say of it.
pub struct LoadedWorld {
    /// The world.
    pub named: NamedWorld,
    /// Its starts and its picture.
    pub compared: ComparedWorld,
}

/// Loads the worlds and checks that the robot can start where it is to.
pub fn load(names_or_files: &[String], starts: &Table, robot: &RobotConfig) -> anyhow::Result<Vec<LoadedWorld>> {
    let load_one = |name_or_file: &String| {
        let (truth, name) = load_world(name_or_file)?;
        let named = NamedWorld::new(name.clone(), &truth)?;
        let starts = starts.starts(&name, &named.world)?;
        for start in &starts {
            named.world.check_start(start, &robot.footprint).with_context(|| format!("world {name}"))?;
        }
        let picture = WorldPicture::of(&truth)?;
        Ok(LoadedWorld { named, compared: ComparedWorld { name, starts, picture } })
    };
    let worlds: Vec<LoadedWorld> = names_or_files.iter().map(load_one).collect::<anyhow::Result<_>>()?;
    unique("world", worlds.iter().map(|world| world.named.name.as_str()))?;
    Ok(worlds)
}
