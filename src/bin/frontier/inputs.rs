//! Help for arguments that take a preset or a robot.

use frontier_explorer::config::{BUILTIN_ROBOTS, Preset};

/// Help for an argument that takes a robot.
pub fn robot_help() -> String {
    let names = BUILTIN_ROBOTS.map(|(name, _)| name).join(", ");
    format!("The robot: a YAML file, or one of the built-in robots: {names}")
}

/// Help for an argument that takes a preset.
pub fn preset_help() -> String {
    let names: Vec<&str> = Preset::names().collect();
    format!("How to explore: a YAML file, or one of the built-in presets: {}", names.join(", "))
}
