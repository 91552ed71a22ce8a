//! Presets and robots as YAML, and trees of ROS parameters.

use super::engine::{Answer, Target, files_in, none};
use super::exploring::{a_while, room};
use frontier_explorer::config::{Live, NodeParams, Preset, RobotConfig, builtin_robot};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::Thresholds;
use frontier_explorer::robot::Robot as _;
use frontier_explorer::sim::{SimConfig, SimRobot, World};
use serde_json::Value;
use std::sync::Arc;

#[test]
fn presets() {
    let target = Target { name: "presets", run: preset, seeds, memory: (128 << 20, 500), least_taken_percent: 5.0 };
    target.fuzz();
}

fn text(input: &[u8]) -> Result<&str, String> {
    std::str::from_utf8(input).map_err(|error| error.to_string())
}

fn preset(input: &[u8]) -> Answer {
    let preset = Preset::from_yaml(text(input)?, "fuzz").map_err(|error| error.to_string())?;
    let robot = builtin_robot("turtlebot2").unwrap();
    let driven = drive(preset.clone(), &robot)?;
    let mut explorer = Explorer::new(preset.explorer, &robot.traits()).map_err(|error| error.to_string())?;
    Ok(driven + &a_while(&mut explorer, room(), Pose::new(1.0, 1.0, 0.3), None))
}

/// So many looks at the simulated robot.
const TICKS: usize = 25;

/// A drive of the simulated robot through a room, with the planner and the controller of a preset.
fn drive(preset: Preset, robot: &RobotConfig) -> Answer {
    let navigator = preset.navigator(&robot.body());
    let mut explorer = Explorer::new(preset.explorer, &robot.traits()).map_err(|error| error.to_string())?;
    let world = Arc::new(World::new(&room(), &Thresholds::default()).unwrap());
    let start = Pose::new(1.0, 1.0, 0.3);
    let mut sim = match SimRobot::new(world, robot, SimConfig::default(), navigator, start) {
        Ok(sim) => sim,
        Err(error) => return Ok(error.to_string()),
    };
    for _ in 0..TICKS {
        let observation = match sim.observe() {
            Ok(observation) => observation,
            Err(error) => return Ok(error.to_string()),
        };
        let decision = explorer.step(&observation);
        sim.command(&decision.command).map_err(|error| error.to_string())?;
        if let Some(end) = decision.end {
            return Ok(format!("{:?}", end.reason));
        }
    }
    Ok(format!("{} goals, {}", explorer.counts().goals_sent, explorer.counts().turns))
}

/// The built-in presets.
fn seeds() -> Vec<(String, Vec<u8>)> {
    files_in("configs").into_iter().filter(|(name, _)| name != "worlds.yaml").collect()
}

#[test]
fn robots() {
    let target = Target {
        name: "robots",
        run: robot,
        seeds: || files_in("configs/robots"),
        memory: (128 << 20, 500),
        least_taken_percent: 5.0,
    };
    target.fuzz();
}

/// A robot that explores, and that the simulator drives.
fn robot(input: &[u8]) -> Answer {
    let robot = RobotConfig::from_yaml(text(input)?).map_err(|error| error.to_string())?;
    // One with a sampling controller and another one that follows its path.
    let preset = Preset::built_in(if input.len().is_multiple_of(2) { "liang" } else { "tour" }).unwrap();
    let driven = drive(preset.clone(), &robot)?;
    let mut explorer = Explorer::new(preset.explorer, &robot.traits()).map_err(|error| error.to_string())?;
    Ok(driven + &a_while(&mut explorer, room(), Pose::new(1.0, 1.0, 0.3), None))
}

#[test]
fn params() {
    Target { name: "params", run: tree, seeds: none, memory: (64 << 20, 500), least_taken_percent: 5.0 }.fuzz();
}

/// A tree of parameters and the changes that dynamic_reconfigure asks for.
fn tree(input: &[u8]) -> Answer {
    let mut tree: Value = serde_json::from_slice(input).map_err(|error| error.to_string())?;
    let changes = tree.as_object_mut().and_then(|table| table.remove("changes")).unwrap_or_default();
    let params = NodeParams::from_tree(tree).map_err(|error| error.to_string())?;
    let base = Preset::built_in(params.base_preset()).map_err(|error| error.to_string())?;
    let preset = params.apply_to(base).map_err(|error| error.to_string())?;
    let mut explorer = Explorer::new(preset.explorer.clone(), &builtin_robot("turtlebot2").unwrap().traits())
        .map_err(|error| error.to_string())?;
    let live = Live { node: params.live_node(), preset };
    live.params().map_err(|error| error.to_string())?;
    let changes: Vec<(String, Value)> = changes.as_object().cloned().unwrap_or_default().into_iter().collect();
    let said = match live.with(&changes) {
        Ok(changed) => explorer.adjust(&changed.preset.explorer).err().map(|error| error.to_string()),
        Err(error) => Some(error.to_string()),
    };
    Ok(said.unwrap_or_default() + &a_while(&mut explorer, room(), Pose::new(1.0, 1.0, 0.3), None))
}
