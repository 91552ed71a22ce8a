//! Presets and robots by name or by file.

use frontier_explorer::config::{BUILTIN_ROBOTS, Preset, RobotConfig};
use frontier_explorer::io::{load_preset, load_robot};

/// A preset from a YAML file, or a built-in one by its name.
pub fn preset(name_or_file: &str) -> anyhow::Result<Preset> {
    Ok(load_preset(name_or_file)?)
}

/// A robot from a YAML file, or a built-in one by its name.
pub fn robot(name_or_file: &str) -> anyhow::Result<RobotConfig> {
    Ok(load_robot(name_or_file)?)
}

/// The names of the built-in robots, for help.
pub fn robot_names() -> String {
    BUILTIN_ROBOTS.map(|(name, _)| name).join(", ")
}

/// Help for an argument that takes a preset.
pub fn preset_help() -> String {
    let names: Vec<&str> = Preset::names().collect();
    format!("How to explore: a YAML file, or one of the built-in presets: {}", names.join(", "))
}
