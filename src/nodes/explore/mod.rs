//! `explore_node`: the papers' exploration node in a move_base-era stack.

mod action;
mod areas;
mod attended;
mod connect;
mod controls;
mod desk;
mod explain;
mod exploration;
mod live_params;
mod operator;
mod outputs;
mod resources;
mod rules;
mod saving;
mod session;
mod settings;
mod watcher;

pub use session::{Activity, Session};
pub use settings::ExploreNodeError;

use crate::config::{BUILTIN_ROBOTS, Preset};
use crate::ros::program::{has_helped, run_program};
use crate::ros::rivals::Rivals;
use crate::ros::{Node, stop};
use action::ExploreAction;
use areas::AreaInputs;
use attended::Recall;
use connect::connect;
use controls::Controls;
use desk::Desk;
use exploration::{Beginning, Exploration};
use live_params::LiveParams;
use operator::{Matter, Next, Operator};
use outputs::Outputs;
use rules::Stage;
use saving::MapSaver;
use session::{Resumed, SessionKeeper};
use settings::Settings;
use std::sync::Arc;
use std::sync::atomic::Ordering;
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
    let Settings { params, preset, .. } = &settings;
    let (session, earlier_map) = match Resumed::read(node, &params.resume_from, preset.explorer.thresholds)? {
        Some(resumed) => (Some(resumed.session), resumed.map),
        None => (None, None),
    };
    let (mut robot, mut connected) = connect(node, &settings, earlier_map)?;
    let saver = Arc::new(MapSaver::new(&params.map_file, connected.maps.clone(), node.log(), &connected.troubles));
    saver.check();
    let live = LiveParams::offer(node, &settings, &connected)?;
    let outputs = Outputs::offer(node, &settings, &connected, &saver)?;
    let desk = Desk::new(&connected.bell);
    let action = ExploreAction::offer(node, &desk, &connected, Box::new(outputs.teller()))?;
    let _controls = Controls::listen(node, &settings, &connected, &desk)?;
    let areas = AreaInputs::listen(node, &settings, &connected)?;
    let mut operator = Operator::new(node, desk, &connected, action);
    let mut keeper = SessionKeeper::new(params, connected.maps.clone(), node.log(), &connected.troubles);
    let mut recall = Recall::new(connected.maps.clone(), node.log().clone(), preset.explorer.areas());
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
    let activity = session.as_ref().map(|session| session.activity);
    if let Some(session) = session.as_ref().filter(|session| !session.areas.are_everywhere()) {
        areas.exchange(session.areas.clone());
    }
    if activity == Some(Activity::Stopped) {
        outputs.show_idle();
        node.log().warn("the session was stopped by its user: call ~start to go on");
    } else if params.autostart {
        operator.begin();
        if activity == Some(Activity::Paused) {
            connected.paused.store(true, Ordering::Relaxed);
            node.log().warn("the session was paused: call ~resume to go on");
        }
    } else {
        outputs.show_idle();
        node.log().info("waiting to be started: call ~start, or send a goal to the action ~explore");
    }
    let mut session = session;
    let mut last: Option<Exploration<'_>> = None;
    loop {
        let Some(next) = wait_for_work(node, &mut operator, last.as_mut(), &outputs, &areas, &live) else {
            let code = u8::from(saver.save().is_err() || node.has_failed());
            settle(code);
            return Ok(code);
        };
        let exploration = match (next, last.take()) {
            (Next::GoHome, Some(mut earlier)) => {
                robot.go_on();
                let now_s = earlier.watcher.now_s();
                earlier.explorer.return_home(now_s, "sent home by the user");
                earlier
            }
            (_, earlier) => {
                let home = earlier.and_then(|earlier| earlier.explorer.start_pose());
                let (connected, outputs, inputs, live) = (&connected, &outputs, &areas, &live);
                let begin = Beginning { node, settings: &settings, connected, outputs, inputs, live };
                begin.explore(&robot, &operator, home, session.take().as_ref())?
            }
        };
        let exploration = last.insert(exploration);
        let end = exploration.run(node, &mut robot, &mut operator, &mut keeper, &mut recall, &live);
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
        if live.now().node.exit_when_done && !operator.has_work() || !node.is_ok() {
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
    live: &LiveParams,
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
        let mut explorer = explorer;
        live.apply_news(operator, explorer.as_deref_mut(), outputs, areas);
        let explain = || watcher.map_or_else(|| outputs.status().message, NodeWatcher::explanation);
        let now_s = watcher.map_or(0.0, NodeWatcher::now_s);
        operator.serve(&mut Matter { stage, explorer, now_s, explain: &explain });
    })
}

/// Refuses to drive a robot that another explorer drives; returns who was there.
fn refuse_rivals<'a>(node: &'a Node, settings: &Settings) -> Result<Rivals<'a>, ExploreNodeError> {
    let rivals = Rivals::of(node, &format!("{}/goal", settings.params.move_base));
    rivals.refuse_all()?;
    Ok(rivals)
}
