//! `explore_node`: the papers' exploration node in a move_base-era stack.

mod areas;
mod connect;
mod controls;
mod outputs;
mod saving;
mod settings;
mod watcher;

pub use settings::ExploreNodeError;

use crate::config::{BUILTIN_ROBOTS, Preset};
use crate::explore::{End, Explorer, run as explore};
use crate::ros::display::status_sentence;
use crate::ros::program::{has_helped, run_program};
use crate::ros::{Node, RosRobot, stop};
use areas::AreaInputs;
use connect::connect;
use controls::{Controls, Request};
use outputs::Outputs;
use saving::MapSaver;
use settings::Settings;
use std::sync::Arc;
use watcher::NodeWatcher;

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
         \x20 _config:=tour                a preset or a YAML file: {presets}\n\
         \x20 _robot:=turtlebot2           a robot or a YAML file: {robots}\n\
         \x20 _base_frame:=base_link       the robot's frame\n\
         \x20 _move_base:=move_base        the action server\n\
         \x20 _map_file:=FILE              save the map there at the end\n\
         \x20 _exit_when_done:=true        leave at the end: 0 done, 1 failed, 3 frontiers were left\n\
         \x20 _region:=[[X, Y], ...]       explore and keep inside a polygon, metres in the map's frame\n\
         \x20 _no_go:=[[[X, Y], ...], ...] keep out of polygons\n\
         \x20 _explorer:={{...}}             any setting of `frontier explore --print-config`\n\n\
         docs/ros.md has all of them, the topics, and what happens when a part of the stack goes away.\n"
    )
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
    let settings = Settings::read(node)?;
    let (mut robot, mut connected) = connect(node, &settings)?;
    let Settings { params, preset, .. } = &settings;
    let saver = Arc::new(MapSaver::new(&params.map_file, connected.maps.clone(), node.log(), &connected.troubles));
    saver.check();
    let outputs = Outputs::offer(node, &settings, &connected, &saver)?;
    let controls = Controls::listen(node, &settings, &connected)?;
    let areas = AreaInputs::listen(node, &settings, &connected)?;
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
    loop {
        let end = run_once(node, &settings, &mut robot, &outputs, &controls, &areas)?;
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
        match controls.wait_for_another_run(node, &areas) {
            Some(Request::Areas | Request::Resume) => {}
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
    areas: &AreaInputs,
) -> Result<End, ExploreNodeError> {
    let Settings { preset, robot: body, .. } = settings;
    let mut explorer = Explorer::new(preset.explorer.clone(), &body.traits())?;
    explorer.set_areas(areas.current());
    robot.set_areas(&areas.current());
    if let Some(planner) = controls.asking_planner(node, settings) {
        explorer.set_planner(planner);
    }
    let mut watcher = NodeWatcher::new(node, outputs, controls, areas, settings.preset.explorer.thresholds);
    let end = explore(robot, &mut explorer, &mut watcher);
    robot.stop();
    let status = watcher.finish(robot, &explorer, &end);
    node.log().info(format_args!("{}: {} ({})", end.reason.name(), end.message, status_sentence(&status)));
    tell_latency(node, robot.latencies_ms());
    Ok(end)
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
