//! The worlds of a comparison, with their starts checked before the first run.

use super::starts::Table;
use super::unique;
use crate::inputs;
use crate::simulation::NamedWorld;
use anyhow::Context;
use frontier_explorer::config::RobotConfig;
use frontier_explorer::grid::OccupancyGrid;
use frontier_explorer::io::map_from_bytes;
use frontier_explorer::report::{ComparedWorld, WorldPicture};
use std::path::Path;

/// The worlds in the binary: name, YAML, image.
macro_rules! built_in {
    ($($name:literal),*) => {
        /// Their names.
        pub const BUILT_IN_NAMES: [&str; [$($name),*].len()] = [$($name),*];

        const BUILT_IN: [(&str, &str, &[u8]); BUILT_IN_NAMES.len()] = [$((
            $name,
            include_str!(concat!("../../../../../maps/", $name, ".yaml")),
            include_bytes!(concat!("../../../../../maps/", $name, ".pgm")),
        )),*];
    };
}

built_in!("office", "museum", "maze", "warehouse");

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
        let (truth, name) = truth(name_or_file)?;
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

/// The ground truth of a built-in world by its name, or of a file.
fn truth(name_or_file: &str) -> anyhow::Result<(OccupancyGrid, String)> {
    match BUILT_IN.iter().find(|(name, ..)| *name == name_or_file) {
        Some((name, yaml, image)) => Ok((map_from_bytes(name, yaml, image)?.grid, (*name).to_owned())),
        None => inputs::world(Path::new(name_or_file)),
    }
}
