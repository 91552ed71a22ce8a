//! `explore_node`: the papers' exploration node in a move_base-era stack.

mod connect;
mod controls;
mod outputs;
mod watcher;

use super::display::status_sentence;
use super::node::{Node, NodeError};
use super::program::run_program;
use super::robot::RosRobot;
use crate::config::{NodeParams, NodeParamsError, Preset, RobotConfig};
use crate::explore::{End, Explorer, SettingsError, run as explore};
use crate::geometry::Polygon;
use crate::io::{MapError, SaveOptions, SettingsFileError, load_preset, load_robot, save_map};
use connect::connect;
use controls::{Controls, Request};
use outputs::Outputs;
use std::path::Path;
use std::time::Duration;
use watcher::NodeWatcher;

/// Why the node cannot do its work.
#[derive(Debug, thiserror::Error)]
pub enum ExploreNodeError {
    /// ROS refuses.
    #[error(transparent)]
    Node(#[from] NodeError),
    /// A parameter is wrong.
    #[error(transparent)]
    Params(#[from] NodeParamsError),
    /// A preset or a robot that a parameter names cannot be had.
    #[error("parameter ~{parameter}: {source}")]
    File {
        /// Which parameter.
        parameter: &'static str,
        /// What is wrong.
        source: SettingsFileError,
    },
    /// The settings contradict each other.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

/// Everything that the parameters say, checked.
pub(super) struct Settings {
    params: NodeParams,
    preset: Preset,
    robot: RobotConfig,
}

/// Runs the node until it is told to stop, or, with `~exit_when_done`, until the
/// exploration has ended. Returns the exit code: 0 done, 1 failed, 3 ended without
/// having explored everything.
#[must_use]
pub fn explore_node() -> u8 {
    run_program("explore", explore_with)
}

fn read_settings(node: &Node) -> Result<Settings, ExploreNodeError> {
    let mut params = NodeParams::from_tree(node.private_params()?)?;
    let file = |parameter, source| ExploreNodeError::File { parameter, source };
    let base = load_preset(params.base_preset()).map_err(|e| file("config", e))?;
    let robot = load_robot(&params.robot).map_err(|e| file("robot", e))?;
    let preset = params.apply_to(base)?;
    if let (Some(prefix), false) = (node.searched_param("tf_prefix"), params.base_frame.starts_with('/')) {
        let prefix = prefix.trim_matches('/');
        if !prefix.is_empty() {
            params.base_frame = format!("{prefix}/{}", params.base_frame);
        }
    }
    Ok(Settings { params, preset, robot })
}

/// Explores with a node that has begun, as [`explore_node`] does; returns the exit code.
///
/// # Errors
/// [`ExploreNodeError`] when its parameters or ROS do not let it.
pub fn explore_with(node: &Node) -> Result<u8, ExploreNodeError> {
    let settings = read_settings(node)?;
    let (mut robot, connected) = connect(node, &settings)?;
    let outputs = Outputs::offer(node, &settings, connected.maps.clone(), &connected.paused)?;
    let controls = Controls::listen(node, &settings, &connected)?;
    let Settings { params, preset, .. } = &settings;
    node.log().info(format_args!(
        "{}: preset {}, robot {}, map on {}, goals to {}",
        node.name(),
        preset.preset,
        settings.robot.name,
        params.map_topic,
        if connected.drives_itself { "our own controller" } else { &params.move_base }
    ));
    let mut region = preset.explorer.region.clone();
    loop {
        let (end, last_region) = run_once(node, &settings, &mut robot, &outputs, &controls, region)?;
        region = last_region;
        let code = u8::from(!end.reason.is_success()) * 3;
        let told_to_stop = !node.is_ok();
        if node.has_failed() {
            return Ok(1);
        }
        if told_to_stop {
            return Ok(0);
        }
        if params.exit_when_done {
            return Ok(code);
        }
        match controls.wait_for_another_run(node) {
            Some(Request::Region(new)) => region = new,
            Some(Request::Resume) => {}
            None => return Ok(0),
        }
    }
}

/// One exploration, from the first map to the saved one.
fn run_once(
    node: &Node,
    settings: &Settings,
    robot: &mut RosRobot,
    outputs: &Outputs,
    controls: &Controls,
    region: Option<Polygon>,
) -> Result<(End, Option<Polygon>), ExploreNodeError> {
    let Settings { params, preset, robot: body } = settings;
    let mut explorer = Explorer::new(preset.explorer.clone(), &body.traits())?;
    explorer.set_region(region);
    if let Some(planner) = controls.asking_planner(node, settings) {
        explorer.set_planner(planner);
    }
    let mut watcher = NodeWatcher::new(node, outputs, controls);
    let end = explore(robot, &mut explorer, &mut watcher);
    robot.stop();
    let status = watcher.finish(&explorer, &end);
    node.log().info(format_args!("{}: {} ({})", end.reason.name(), end.message, status_sentence(&status)));
    tell_latency(node, robot.latencies_ms());
    save(node, robot, &params.map_file);
    Ok((end, explorer.region().cloned()))
}

/// Says how long it took from maps to the goals that they led to.
fn tell_latency(node: &Node, latencies_ms: &[f64]) {
    let mut sorted = latencies_ms.to_vec();
    sorted.sort_by(f64::total_cmp);
    if let (Some(median_ms), Some(worst_ms)) = (sorted.get(sorted.len() / 2), sorted.last()) {
        let count = sorted.len();
        node.log().info(format_args!(
            "from a map to the goal that it led to: median {median_ms:.1} ms, worst {worst_ms:.1} ms, {count} goals"
        ));
    }
}

/// Saves the map where the parameters want it; what cannot be saved is said.
fn save(node: &Node, robot: &RosRobot, map_file: &str) {
    if map_file.is_empty() {
        return;
    }
    let Some(map) = robot.received_map() else {
        node.log().warn(format_args!("no map has come that could be saved as {map_file}"));
        return;
    };
    match save_as(map_file, map) {
        Ok(paths) => node.log().info(format_args!("saved {} and {}", paths.yaml.display(), paths.image.display())),
        Err(error) => node.log().error(error),
    }
}

/// Waits for one map of a topic and returns it: `frontier map save`.
///
/// # Errors
/// A sentence when none comes in time, or the node is told to stop.
pub fn receive_map(node: &Node, topic: &str, limit: Duration) -> Result<super::ReceivedMap, String> {
    let bell = std::sync::Arc::default();
    let feed = super::map_feed::MapFeed::listen(node, topic, "", &bell);
    let reader = feed.reader();
    node.wait_until(limit, || reader.newest().is_some());
    reader.newest().ok_or_else(|| format!("no map came on {topic} for {} s", limit.as_secs()))
}

/// Saves a map in map_server's format, as the node and the command line do.
///
/// # Errors
/// [`MapError`] with the file.
pub(super) fn save_as(path: &str, map: &super::ReceivedMap) -> Result<crate::io::SavedPaths, MapError> {
    save_map(Path::new(path), &map.grid, &SaveOptions::default())
}
