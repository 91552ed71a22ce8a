//! `explore_node`: the papers' exploration node in a move_base-era stack.

mod action;
mod areas;
mod connect;
mod controls;
mod desk;
mod explain;
mod operator;
mod outputs;
mod rules;
mod saving;
mod settings;
mod watcher;

pub use settings::ExploreNodeError;

use crate::config::{BUILTIN_ROBOTS, Drive, Preset};
use crate::explore::{End, Explorer, run as explore};
use crate::geometry::Pose;
use crate::planning::GlobalPlanner;
use crate::ros::display::status_sentence;
use crate::ros::move_base::AskingPlanner;
use crate::ros::program::{has_helped, run_program};
use crate::ros::rivals::Rivals;
use crate::ros::{Node, RosRobot, stop};
use action::ExploreAction;
use areas::AreaInputs;
use connect::{Connected, connect};
use controls::Controls;
use desk::Desk;
use operator::{Matter, Next, Operator};
use outputs::Outputs;
use rules::Stage;
use saving::MapSaver;
use settings::Settings;
use std::sync::Arc;
use watcher::{Attended, NodeWatcher};

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
         \x20 _autostart:=false            wait for ~start, or a goal of the action ~explore\n\
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
    let before = refuse_rivals(node, &settings)?;
    let (mut robot, mut connected) = connect(node, &settings)?;
    let Settings { params, preset, .. } = &settings;
    let saver = Arc::new(MapSaver::new(&params.map_file, connected.maps.clone(), node.log(), &connected.troubles));
    saver.check();
    let outputs = Outputs::offer(node, &settings, &connected, &saver)?;
    let desk = Desk::new(&connected.bell);
    let action = ExploreAction::offer(node, &desk, &connected, Box::new(outputs.teller()))?;
    let _controls = Controls::listen(node, &settings, &connected, &desk)?;
    let areas = AreaInputs::listen(node, &settings, &connected)?;
    let mut operator = Operator::new(node, desk, &connected, action);
    let (cancel, last_saver) = (std::mem::replace(&mut connected.cancel, Box::new(|| ())), Arc::clone(&saver));
    stop::set_will(move || {
        cancel();
        u8::from(last_saver.save().is_err())
    });
    before.refuse_those_who_came_since()?;
    node.log().info(format_args!(
        "{}: preset {}, robot {}, map on {}, goals to {}",
        node.name(),
        preset.preset,
        settings.robot.name,
        params.map_topic,
        if connected.drives_itself { "our own controller" } else { &params.move_base }
    ));
    if params.autostart {
        operator.begin();
    } else {
        outputs.show_idle();
        node.log().info("waiting to be started: call ~start, or send a goal to the action ~explore");
    }
    let mut last: Option<Exploration<'_>> = None;
    loop {
        let Some(next) = wait_for_work(node, &mut operator, last.as_mut(), &outputs, &areas) else {
            let code = u8::from(saver.save().is_err() || node.has_failed());
            settle(code);
            return Ok(code);
        };
        let exploration = match (next, last.take()) {
            (Next::GoHome, Some(mut earlier)) => {
                let now_s = earlier.watcher.now_s();
                earlier.explorer.return_home(now_s, "sent home by the user");
                earlier
            }
            (_, earlier) => {
                let home = earlier.and_then(|earlier| earlier.explorer.start_pose());
                let begin =
                    Beginning { node, settings: &settings, connected: &connected, outputs: &outputs, inputs: &areas };
                begin.explore(&robot, &operator, home)?
            }
        };
        let exploration = last.insert(exploration);
        let end = exploration.run(node, &mut robot, &mut operator);
        let saved = match operator.order().filter(|order| !order.map_file.is_empty()) {
            Some(order) => saver.save_elsewhere(&order.map_file).map(Some),
            None => saver.save(),
        };
        let is_saved = saved.is_ok();
        if let Err(why) = &saved {
            node.log().error(why);
            outputs.tell_status();
        }
        operator.ended(&end, &outputs.status(), saved);
        let code = match () {
            () if node.has_failed() || !is_saved => 1,
            () if !node.is_ok() || end.reason.is_success() => 0,
            () => 3,
        };
        if params.exit_when_done && !operator.has_work() || !node.is_ok() {
            settle(code);
            return Ok(code);
        }
        node.log().info("ready to explore again: call ~start, publish true on explore/resume, or draw a region");
    }
}

/// Waits until there is something to do; `None` when the node is told to stop.
fn wait_for_work(
    node: &Node,
    operator: &mut Operator,
    mut last: Option<&mut Exploration<'_>>,
    outputs: &Outputs,
    areas: &AreaInputs,
) -> Option<Next> {
    operator.wait_for_work(node, |operator| {
        if areas.take_new().is_some() && last.is_some() {
            operator.begin();
        }
        let stage = if last.is_some() { Stage::Ended } else { Stage::Idle };
        let (explorer, watcher) = match &mut last {
            Some(Exploration { explorer, watcher }) => (Some(explorer), Some(&*watcher)),
            None => (None, None),
        };
        let explain = || watcher.map_or_else(|| outputs.status().message, NodeWatcher::explanation);
        let now_s = watcher.map_or(0.0, NodeWatcher::now_s);
        operator.serve(&mut Matter { stage, explorer, now_s, explain: &explain });
    })
}

/// One exploration, from the first map to its end, and to the way back.
struct Exploration<'a> {
    explorer: Explorer,
    watcher: NodeWatcher<'a>,
}

/// What an exploration begins with.
struct Beginning<'a> {
    node: &'a Node,
    settings: &'a Settings,
    connected: &'a Connected,
    outputs: &'a Outputs,
    inputs: &'a AreaInputs,
}

impl<'a> Beginning<'a> {
    /// A new exploration, as the operator wants it now.
    fn explore(
        self,
        robot: &RosRobot,
        operator: &Operator,
        home: Option<Pose>,
    ) -> Result<Exploration<'a>, ExploreNodeError> {
        let Self { node, settings, connected, outputs, inputs } = self;
        let Settings { preset, robot: body, .. } = settings;
        let mut wanted = preset.explorer.clone();
        if let Some(order) = operator.order() {
            wanted.patience.time_limit_s = order.time_limit_s.or(wanted.patience.time_limit_s);
            wanted.return_to_start |= order.return_home;
        }
        let mut explorer = Explorer::new(wanted, &body.traits())?;
        let areas = operator.areas(inputs.current());
        robot.set_areas(&areas);
        let watcher = NodeWatcher::new(node, outputs, inputs, &areas, preset.explorer.thresholds);
        explorer.set_areas(areas);
        if let Some(home) = home {
            explorer.set_start_pose(home);
        }
        if let Some(planner) = asking_planner(node, settings, connected) {
            explorer.set_planner(planner);
        }
        Ok(Exploration { explorer, watcher })
    }
}

impl Exploration<'_> {
    /// Explores, or goes on with it.
    fn run(&mut self, node: &Node, robot: &mut RosRobot, operator: &mut Operator) -> End {
        let Self { explorer, watcher } = self;
        watcher.begin(explorer);
        let end = explore(robot, explorer, &mut Attended { operator, watcher });
        robot.stop();
        let status = watcher.finish(robot, explorer, &end);
        node.log().info(format_args!("{}: {} ({})", end.reason.name(), end.message, status_sentence(&status)));
        tell_latency(node, robot.latencies_ms());
        end
    }
}

/// The planner that asks move_base, where the settings want it.
fn asking_planner(node: &Node, settings: &Settings, connected: &Connected) -> Option<Box<dyn GlobalPlanner>> {
    let Settings { params, preset, robot } = settings;
    let wanted = params.check_with_make_plan && preset.navigation.drive == Drive::MoveBase;
    wanted.then(|| {
        let own = preset.explorer.planner.build(&robot.body());
        Box::new(AskingPlanner::new(node, &params.move_base, Arc::clone(&connected.map_frame), own)) as Box<_>
    })
}

/// Refuses to drive a robot that another explorer drives; returns who was there.
fn refuse_rivals<'a>(node: &'a Node, settings: &Settings) -> Result<Rivals<'a>, ExploreNodeError> {
    let rivals = Rivals::of(node, &format!("{}/goal", settings.params.move_base));
    rivals.refuse_all()?;
    Ok(rivals)
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
