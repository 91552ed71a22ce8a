//! `explore_node`: the papers' exploration node in a move_base-era stack.

mod connect;
mod controls;
mod outputs;
mod saving;
mod watcher;

use super::display::status_sentence;
use super::node::{Node, NodeError};
use super::program::{has_helped, run_program};
use super::robot::RosRobot;
use super::stop;
use crate::config::{BUILTIN_ROBOTS, NodeParams, NodeParamsError, Preset, RobotConfig};
use crate::explore::{End, Explorer, SettingsError, run as explore};
use crate::geometry::Polygon;
use crate::io::{SettingsFileError, load_preset, load_robot};
use connect::connect;
use controls::{Controls, Request};
use outputs::Outputs;
use saving::MapSaver;
use std::sync::Arc;
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
/// exploration has ended. Returns the exit code: 0 done, 1 failed or the map was not saved,
/// 3 ended without having explored everything.
#[must_use]
pub fn explore_node() -> u8 {
    if has_helped(help) {
        return 0;
    }
    // What is registered is given back after that, which a master that hangs may keep for ever.
    run_program("explore", |node| explore_until(node, stop::leave_in_time))
}

fn help() -> String {
    let presets = Preset::names().collect::<Vec<_>>().join(", ");
    let robots = BUILTIN_ROBOTS.map(|(name, _)| name).join(", ");
    format!(
        "explore_node: frontier exploration of a robot with a map, transforms and move_base\n\n\
         Usage: explore_node [_PARAMETER:=VALUE]... [TOPIC:=OTHER]... [__name:=NAME] [__ns:=NAMESPACE]\n\n\
         \x20 _config:=liang               a preset or a YAML file: {presets}\n\
         \x20 _robot:=turtlebot2           a robot or a YAML file: {robots}\n\
         \x20 _base_frame:=base_link       the robot's frame\n\
         \x20 _move_base:=move_base        the action server\n\
         \x20 _map_file:=FILE              save the map there at the end\n\
         \x20 _exit_when_done:=true        leave at the end: 0 done, 1 failed, 3 frontiers were left\n\
         \x20 _region:=[[X, Y], ...]       explore inside a polygon alone, metres in the map's frame\n\
         \x20 _explorer:={{...}}             any setting of `frontier explore --print-config`\n\n\
         docs/ros.md has all of them, the topics, and what happens when a part of the stack goes away.\n"
    )
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
    explore_until(node, stop::settle)
}

/// Explores, and tells the exit code when all is done but to give back what is registered.
fn explore_until(node: &Node, settle: impl Fn(u8)) -> Result<u8, ExploreNodeError> {
    let settings = read_settings(node)?;
    let (mut robot, mut connected) = connect(node, &settings)?;
    let Settings { params, preset, .. } = &settings;
    let saver = Arc::new(MapSaver::new(&params.map_file, connected.maps.clone(), node.log(), &connected.troubles));
    saver.check();
    let outputs = Outputs::offer(node, &settings, &connected, &saver)?;
    let controls = Controls::listen(node, &settings, &connected)?;
    let (cancel, last_saver) = (std::mem::replace(&mut connected.cancel, Box::new(|| ())), Arc::clone(&saver));
    stop::set_will(move || {
        cancel();
        u8::from(!last_saver.save())
    });
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
        let is_saved = saver.save();
        if !is_saved {
            outputs.tell_status();
        }
        let code = match () {
            () if node.has_failed() || !is_saved => 1,
            () if !node.is_ok() || end.reason.is_success() => 0,
            () => 3,
        };
        if params.exit_when_done || !node.is_ok() {
            settle(code);
            return Ok(code);
        }
        match controls.wait_for_another_run(node) {
            Some(Request::Region(new)) => region = new,
            Some(Request::Resume) => {}
            None => {
                let code = u8::from(!saver.save() || node.has_failed());
                settle(code);
                return Ok(code);
            }
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
    let Settings { preset, robot: body, .. } = settings;
    let mut explorer = Explorer::new(preset.explorer.clone(), &body.traits())?;
    explorer.set_region(region);
    if let Some(planner) = controls.asking_planner(node, settings) {
        explorer.set_planner(planner);
    }
    let mut watcher = NodeWatcher::new(node, outputs, controls, settings.preset.explorer.thresholds);
    let end = explore(robot, &mut explorer, &mut watcher);
    robot.stop();
    let status = watcher.finish(robot, &explorer, &end);
    node.log().info(format_args!("{}: {} ({})", end.reason.name(), end.message, status_sentence(&status)));
    tell_latency(node, robot.latencies_ms());
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
