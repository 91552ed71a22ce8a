//! One exploration: what it begins with, its run, and what is told at its end.

use super::areas::AreaInputs;
use super::attended::{Attended, Recall};
use super::connect::Connected;
use super::live_params::LiveParams;
use super::operator::Operator;
use super::outputs::Outputs;
use super::session::{Activity, Session, SessionKeeper};
use super::settings::{ExploreNodeError, Settings};
use super::watcher::NodeWatcher;
use crate::config::Drive;
use crate::explore::{End, EndReason, Explorer, run as explore};
use crate::geometry::Pose;
use crate::planning::GlobalPlanner;
use crate::ros::display::status_sentence;
use crate::ros::move_base::AskingPlanner;
use crate::ros::{Node, RosRobot};
use std::sync::Arc;

/// One exploration, from the first map to its end, and to the way back.
pub struct Exploration<'a> {
    /// Decides.
    pub explorer: Explorer,
    /// Shows what happens.
    pub watcher: NodeWatcher<'a>,
}

/// What an exploration begins with.
pub struct Beginning<'a> {
    /// The node.
    pub node: &'a Node,
    /// Its parameters.
    pub settings: &'a Settings,
    /// What it shares with the robot.
    pub connected: &'a Connected,
    /// What it shows.
    pub outputs: &'a Outputs,
    /// Where the robot may be.
    pub inputs: &'a AreaInputs,
    /// What may have changed since.
    pub live: &'a LiveParams,
}

impl<'a> Beginning<'a> {
    /// A new exploration, as the operator wants it now.
    ///
    /// # Errors
    /// [`ExploreNodeError`] when the settings contradict each other.
    pub fn explore(
        self,
        robot: &RosRobot,
        operator: &Operator,
        home: Option<Pose>,
        earlier: Option<&Session>,
    ) -> Result<Exploration<'a>, ExploreNodeError> {
        let Self { node, settings, connected, outputs, inputs, live } = self;
        let Settings { preset, robot: body, .. } = settings;
        let wanted = operator.wanted(&live.now().preset.explorer);
        let mut explorer = Explorer::new(wanted, &body.traits())?;
        let areas = operator.areas(inputs.current());
        robot.set_areas(&areas);
        let mut watcher = NodeWatcher::new(node, outputs, inputs, &areas, preset.explorer.thresholds);
        explorer.set_areas(areas);
        if let Some(home) = home {
            explorer.set_start_pose(home);
        }
        if let Some(session) = earlier {
            explorer.recall(&session.memory);
            watcher.go_on_from(session);
        }
        if let Some(planner) = asking_planner(node, settings, connected) {
            explorer.set_planner(planner);
        }
        Ok(Exploration { explorer, watcher })
    }
}

impl Exploration<'_> {
    /// Explores, or goes on with it.
    pub fn run(
        &mut self,
        node: &Node,
        robot: &mut RosRobot,
        operator: &mut Operator,
        keeper: &mut SessionKeeper,
        recall: &mut Recall,
        live: &LiveParams,
    ) -> End {
        let Self { explorer, watcher } = self;
        watcher.begin(explorer);
        let end = explore(robot, explorer, &mut Attended { operator, watcher, keeper, recall, live });
        robot.stop();
        // Whoever waits for the end is told before the disk is waited for.
        let status = watcher.finish(robot, explorer, &end);
        node.log().info(format_args!("{}: {} ({})", end.reason.name(), end.message, status_sentence(&status)));
        let activity = match end.reason {
            // A signal ends the process, and not what it was about.
            EndReason::Interrupted if node.is_ok() => Activity::Stopped,
            EndReason::Interrupted => Activity::Exploring,
            _ => Activity::Ended,
        };
        keeper.keep_now(watcher.session(explorer, activity));
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
