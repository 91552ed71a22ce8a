//! Every control in every state of the node, as a table: what is answered, and what follows.

use crate::controls::{Statuses, ask, goal, stays};
use crate::rig::Heard;
use crate::{SOON, Test, World};
use frontier_explorer::ros::msg::actionlib_msgs::{GoalID, GoalStatus};
use frontier_explorer::ros::msg::frontier_explorer::{
    ExplorationStatus, ExploreActionGoal, ExploreActionResult, ExploreGoal,
};
use std::time::Duration;

pub const TESTS: &[Test] = &[("every_control_in_every_state", every_control)];

/// What is asked for, whether that is so afterwards, what is said, and the phase that follows where
/// it is another one.
type Step = (&'static str, bool, &'static str, Option<u8>);

const IDLE: Option<u8> = Some(ExplorationStatus::IDLE);
const PAUSED: Option<u8> = Some(ExplorationStatus::PAUSED);
const DRIVING: Option<u8> = Some(ExplorationStatus::DRIVING);
const RETURNING: Option<u8> = Some(ExplorationStatus::RETURNING);
const ENDED: Option<u8> = Some(ExplorationStatus::ENDED);

/// Every control in every state, those first that change nothing.
const STEPS: &[Step] = &[
    // Not started.
    ("pause", false, "nothing to pause: the exploration has not been started", IDLE),
    ("stop", false, "nothing to stop: the exploration has not been started", None),
    ("return_home", false, "no start is known", None),
    ("clear_blacklist", true, "nothing is left alone", None),
    ("explain", true, "not started", None),
    ("save_map", true, "map.yaml", None),
    ("resume", true, "the exploration begins", DRIVING),
    // Exploring.
    ("start", true, "it is exploring already", None),
    ("resume", true, "it is exploring already", None),
    ("clear_blacklist", true, "may be tried again", None),
    ("explain", true, "last decision: ", None),
    ("save_map", true, "map.yaml", None),
    ("pause", true, "paused: the robot stands", PAUSED),
    // Paused.
    ("pause", true, "it is paused already", None),
    ("clear_blacklist", true, "may be tried again", None),
    ("explain", true, "last decision: ", None),
    ("save_map", true, "map.yaml", None),
    ("start", true, "going on", DRIVING),
    ("pause", true, "paused", PAUSED),
    ("resume", true, "going on", DRIVING),
    ("pause", true, "paused", PAUSED),
    ("stop", true, "stopped by the user", ENDED),
    // Ended.
    ("pause", false, "nothing to pause: the exploration has ended", None),
    ("stop", false, "nothing to stop: the exploration has ended", None),
    ("clear_blacklist", true, "nothing is left alone", None),
    ("explain", true, "last decision: ", None),
    ("save_map", true, "map.yaml", None),
    ("start", true, "another exploration begins", DRIVING),
    ("stop", true, "stopped by the user", ENDED),
    ("resume", true, "another exploration begins", DRIVING),
    ("return_home", true, "the exploration ends, and the robot drives back", RETURNING),
    // On the way back.
    ("return_home", true, "on the way back to the start already", None),
    ("resume", true, "on the way back to the start already", None),
    ("clear_blacklist", true, "may be tried again", None),
    ("explain", true, "last decision: ", None),
    ("save_map", true, "map.yaml", None),
    ("pause", true, "paused", PAUSED),
    ("pause", true, "it is paused already", None),
    ("return_home", true, "going on with the way back", RETURNING),
    ("pause", true, "paused", PAUSED),
    ("resume", true, "going on", RETURNING),
    ("start", true, "the way back is left: another exploration begins", DRIVING),
    ("return_home", true, "the robot drives back", RETURNING),
    ("stop", true, "the way back was left: stopped by the user", ENDED),
    ("return_home", true, "the robot drives back to the start at (", RETURNING),
    ("stop", true, "the way back was left", ENDED),
];

fn every_control(world: &World) {
    let status = Statuses::of(world);
    // A move_base that never finishes holds each state until it is left.
    let _sim = world.simulate_kindly(&["_fault:=hang"]);
    let patient = "_explorer:={patience: {failing_s: 10000, no_news_s: 10000, goal_timeout_s: 10000, stall_s: 10000, \
                   begin_s: 10000, progress_timeout_s: 10000}}";
    let explore = stays(world, &["_autostart:=false", "_config:=liang", patient]);
    for &(control, success, says, then) in STEPS {
        if then == IDLE {
            status.until(ExplorationStatus::IDLE, "idle");
        }
        ask(world, control, success, says);
        if let Some(phase) = then.filter(|_| then != IDLE) {
            status.until(phase, control);
        }
    }
    // The action, from each of these states.
    let results = Heard::<ExploreActionResult>::on(&world.probe, "/explore/explore/result");
    let goals = world.probe.publish::<ExploreActionGoal>("/explore/explore/goal", 5).unwrap();
    let cancels = world.probe.publish::<GoalID>("/explore/explore/cancel", 5).unwrap();
    std::thread::sleep(Duration::from_secs(1));
    for (name, before) in [
        ("ended", &[][..]),
        ("exploring", &["start"]),
        ("paused", &["start", "pause"]),
        ("returning", &["start", "return_home"]),
    ] {
        for control in before {
            ask(world, control, true, "");
        }
        goals.send(goal(name, ExploreGoal::default())).unwrap();
        explore.expect_log(&format!("the goal {name} of the action is taken up"), SOON);
        status.until(ExplorationStatus::DRIVING, name);
        cancels.send(GoalID { id: name.to_owned(), ..GoalID::default() }).unwrap();
        let end = results.expect(SOON, name, |m| m.status.goal_id.id == name);
        assert_eq!(end.status.status, GoalStatus::PREEMPTED, "{end:?}");
        status.until(ExplorationStatus::ENDED, name);
    }
}
