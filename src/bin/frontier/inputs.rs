//! Presets, robots and worlds by name or by file.

use anyhow::{Context, bail};
use frontier_explorer::config::{BUILTIN_ROBOTS, Preset, RobotConfig, builtin_robot};
use frontier_explorer::grid::OccupancyGrid;
use frontier_explorer::io::{load_map, map_from_bytes};
use std::path::Path;

/// A preset from a YAML file, or a built-in one by its name.
pub fn preset(name_or_file: &str) -> anyhow::Result<Preset> {
    match read_if_file(name_or_file)? {
        Some(text) => Preset::from_yaml(&text, &stem(name_or_file)).with_context(|| name_or_file.to_owned()),
        None => Ok(Preset::built_in(name_or_file)?),
    }
}

/// A robot from a YAML file, or a built-in one by its name.
pub fn robot(name_or_file: &str) -> anyhow::Result<RobotConfig> {
    match read_if_file(name_or_file)? {
        Some(text) => RobotConfig::from_yaml(&text).with_context(|| name_or_file.to_owned()),
        None => Ok(builtin_robot(name_or_file)?),
    }
}

/// The names of the built-in robots, for help.
pub fn robot_names() -> String {
    BUILTIN_ROBOTS.map(|(name, _)| name).join(", ")
}

/// A map_server map that is to be explored, and its name.
pub fn world(file: &Path) -> anyhow::Result<(OccupancyGrid, String)> {
    Ok((load_map(file)?.grid, stem(&file.to_string_lossy())))
}

/// The text of a file, if the argument looks like one: it exists, or it is written
/// like a path.
fn read_if_file(name_or_file: &str) -> anyhow::Result<Option<String>> {
    let path = Path::new(name_or_file);
    let is_path = path.extension().is_some() || path.components().count() > 1;
    if !is_path {
        return Ok(None);
    }
    if path.is_dir() {
        bail!("{name_or_file} is a directory: must be a YAML file or a built-in name");
    }
    std::fs::read_to_string(path).map(Some).with_context(|| format!("cannot read {name_or_file}"))
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().map_or_else(|| path.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// The world that is explored when none is named: the office of `maps/`.
pub fn default_world() -> anyhow::Result<(OccupancyGrid, String)> {
    let (yaml, image) = (include_str!("../../../maps/office.yaml"), include_bytes!("../../../maps/office.pgm"));
    Ok((map_from_bytes("office", yaml, image)?.grid, "office".to_owned()))
}
