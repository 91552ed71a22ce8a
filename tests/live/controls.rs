//! What an operator may ask for, in every state of the node: what is answered, and that it
//! happened.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{SOON, Test, World};
use frontier_explorer::ros::call;
use frontier_explorer::ros::msg::actionlib_msgs::{GoalID, GoalStatus};
use frontier_explorer::ros::msg::frontier_explorer::{
    ExplorationStatus, ExploreActionFeedback, ExploreActionGoal, ExploreActionResult, ExploreGoal,
};
use frontier_explorer::ros::msg::geometry_msgs::{Point32, PoseStamped, Twist};
use frontier_explorer::ros::msg::std_msgs::Bool;
use frontier_explorer::ros::msg::std_srvs::{Trigger, TriggerReq};
use std::cell::Cell;
use std::time::Duration;

/// Slow enough for an operator to do something on the way.
const SLOWLY: &[&str] = &["_speed:=3"];

pub const TESTS: &[Test] = &[
    ("controls_before_the_start", before_the_start),
    ("controls_while_the_first_map_is_waited_for", while_waiting),
    ("controls_while_exploring_and_after", while_exploring),
    ("controls_on_the_way_back", on_the_way_back),
    ("the_topic_of_explore_lite_starts_again_after_the_end", resume_topic),
    ("an_action_goal_explores_and_tells_its_result", action_goal),
    ("action_goals_are_cancelled_replaced_and_turned_away", action_ends),
    ("a_goal_of_somebody_else_is_left_to_its_end", yields),
    ("two_explorers_on_one_robot_refuse_each_other", rivals),
];

/// Calls a control, and checks its answer.
pub fn ask(world: &World, control: &str, success: bool, says: &str) -> String {
    let service = format!("/explore/{control}");
    let answer = call::<Trigger>(&world.probe, &service, TriggerReq {}, Duration::from_secs(15)).unwrap();
    assert_eq!(answer.success, success, "{control}: {}", answer.message);
    assert!(answer.message.contains(says), "{control}: {:?} does not say {says:?}", answer.message);
    answer.message
}

/// What the node says of itself, read from the beginning on.
pub struct Statuses {
    heard: Heard<ExplorationStatus>,
    read: Cell<usize>,
}

impl Statuses {
    pub fn of(world: &World) -> Self {
        Self { heard: Heard::on(&world.probe, "/explore/status"), read: Cell::new(0) }
    }

    /// Reads on until it is in a phase.
    pub fn until(&self, phase: u8, what: &str) -> ExplorationStatus {
        self.until_it(what, |status| status.phase == phase)
    }

    /// Reads on until it says what is wanted.
    pub fn until_it(&self, what: &str, is_wanted: impl Fn(&ExplorationStatus) -> bool) -> ExplorationStatus {
        let mut found = None;
        let mut reads_on = || {
            let all = self.heard.all();
            found =
                all.iter().enumerate().skip(self.read.get()).find(|(_, m)| is_wanted(m)).map(|(i, m)| (i, m.clone()));
            found.is_some()
        };
        eventually(DEADLINE, &mut reads_on, || format!("{what}; the last was {:?}", self.last()));
        let (index, status) = found.unwrap();
        self.read.set(index + 1);
        status
    }

    fn last(&self) -> Option<ExplorationStatus> {
        self.heard.last()
    }
}

pub fn stays(world: &World, more: &[&str]) -> Process {
    let process = world.explore(&[&["_exit_when_done:=false"], more].concat());
    process.expect_log(if more.contains(&"_autostart:=false") { "waiting to be started" } else { "preset" }, SOON);
    process
}

fn before_the_start(world: &World) {
    let status = Statuses::of(world);
    let _sim = world.simulate_kindly(&[]);
    let _explore = stays(world, &["_autostart:=false"]);
    status.until(ExplorationStatus::IDLE, "idle");
    ask(world, "pause", false, "nothing to pause: the exploration has not been started");
    ask(world, "stop", false, "nothing to stop: the exploration has not been started");
    ask(world, "return_home", false, "no start is known");
    ask(world, "clear_blacklist", true, "nothing is left alone");
    ask(world, "explain", true, "not started");
    std::thread::sleep(Duration::from_secs(2));
    assert_eq!(status.last().unwrap().phase, ExplorationStatus::IDLE, "nothing of it started it");
    ask(world, "start", true, "the exploration begins");
    status.until(ExplorationStatus::DRIVING, "driving");
}

fn while_waiting(world: &World) {
    let status = Statuses::of(world);
    // There is no clock and no map.
    let mut explore = stays(world, &[]);
    status.until(ExplorationStatus::WAITING_FOR_MAP, "waiting");
    ask(world, "start", true, "it is started already");
    ask(world, "save_map", false, "no map has come yet");
    ask(world, "return_home", false, "no start is known");
    ask(world, "clear_blacklist", true, "0 places");
    ask(world, "explain", true, "nothing has been decided so far");
    ask(world, "pause", true, "paused: the robot stands");
    status.until(ExplorationStatus::PAUSED, "paused");
    ask(world, "pause", true, "it is paused already");
    ask(world, "resume", true, "going on");
    status.until(ExplorationStatus::WAITING_FOR_MAP, "waiting again");
    ask(world, "stop", false, "no map has come");
    let end = status.until(ExplorationStatus::ENDED, "the end");
    assert_eq!(end.end_reason, "interrupted");
    ask(world, "stop", false, "nothing to stop: the exploration has ended");
    // The stop after the end is no end of the next run.
    ask(world, "resume", true, "another exploration begins");
    let _sim = world.simulate_kindly(&[]);
    status.until(ExplorationStatus::DRIVING, "driving");
    let end = status.until(ExplorationStatus::ENDED, "the end");
    assert_eq!(end.end_reason, "complete", "{}", explore.log());
    explore.signal("INT");
    explore.expect_code(0, SOON);
}

fn while_exploring(world: &World) {
    let status = Statuses::of(world);
    let twists = Heard::<Twist>::on(&world.probe, "/cmd_vel");
    let _sim = world.simulate_kindly(SLOWLY);
    let explore = stays(world, &["_explorer:={patience: {goal_timeout_s: 20.0}}"]);
    status.until(ExplorationStatus::TURNING, "turning");
    ask(world, "start", true, "it is exploring already");
    ask(world, "pause", true, "paused: the robot stands");
    let rest = status.until(ExplorationStatus::PAUSED, "paused");
    std::thread::sleep(Duration::from_secs(1));
    assert!(twists.last().is_none_or(|twist| twist.angular.z == 0.0), "it turns on: {:?}", twists.last());
    assert_eq!(status.last().unwrap().elapsed_s, rest.elapsed_s, "a rest takes no time");
    ask(world, "start", true, "going on");
    status.until(ExplorationStatus::DRIVING, "driving");
    let why = ask(world, "explain", true, "chosen: frontier");
    assert!(why.contains("preset wfd") && why.contains("last decision: "), "{why}");
    ask(world, "resume", true, "it is exploring already");
    ask(world, "clear_blacklist", true, "places that were left alone may be tried again");
    ask(world, "save_map", true, "map.yaml");
    ask(world, "stop", true, "the map is saved as ");
    let end = status.until(ExplorationStatus::ENDED, "the end");
    assert_eq!((end.end_reason.as_str(), end.goals_failed), ("interrupted", 0));
    assert!(world.map().with_extension("pgm").exists(), "{}", explore.log());
    ask(world, "pause", false, "nothing to pause: the exploration has ended");
    ask(world, "clear_blacklist", true, "nothing is left alone");
    ask(world, "explain", true, "last decision: ");
    // The way back has its own time, however long ago the end was.
    std::thread::sleep(Duration::from_secs(8));
    ask(world, "return_home", true, "the robot drives back to the start at (");
    status.until_it("back", |m| m.phase == ExplorationStatus::ENDED && m.message.contains("back at the start"));
    ask(world, "start", true, "another exploration begins");
    status.until(ExplorationStatus::DRIVING, "driving again");
}

fn on_the_way_back(world: &World) {
    let status = Statuses::of(world);
    let _sim = world.simulate_kindly(SLOWLY);
    let _explore = stays(world, &[]);
    status.until_it("driving", |m| m.phase == ExplorationStatus::DRIVING && m.distance_m > 0.3);
    ask(world, "pause", true, "paused");
    ask(world, "return_home", true, "drives back to the start at (2.0");
    status.until(ExplorationStatus::RETURNING, "on the way back");
    ask(world, "return_home", true, "on the way back to the start already");
    ask(world, "resume", true, "on the way back to the start already");
    ask(world, "pause", true, "paused");
    status.until(ExplorationStatus::PAUSED, "paused");
    ask(world, "resume", true, "going on");
    status.until(ExplorationStatus::RETURNING, "on the way back again");
    ask(world, "start", true, "the way back is left: another exploration begins");
    status.until(ExplorationStatus::DRIVING, "exploring again");
    ask(world, "return_home", true, "the exploration ends, and the robot drives back");
    let end = status.until(ExplorationStatus::ENDED, "the end");
    assert_eq!(end.end_reason, "interrupted");
    assert!(end.message.contains("sent home by the user; back at the start"), "{end:?}");
}

fn resume_topic(world: &World) {
    let status = Statuses::of(world);
    let resume = world.probe.publish::<Bool>("/explore/resume", 5).unwrap();
    let _sim = world.simulate_kindly(SLOWLY);
    let explore = stays(world, &["_config:=liang"]);
    status.until(ExplorationStatus::ENDED, "the end");
    resume.send(Bool { data: false }).unwrap();
    explore.expect_log("nothing to pause: the exploration has ended", SOON);
    resume.send(Bool { data: true }).unwrap();
    explore.expect_log("another exploration begins", SOON);
    let ends = || explore.log().matches("complete: ").count() == 2;
    eventually(DEADLINE, ends, || explore.log());
}

pub fn goal(id: &str, goal: ExploreGoal) -> ExploreActionGoal {
    let goal_id = GoalID { id: id.to_owned(), ..GoalID::default() };
    ExploreActionGoal { goal_id, goal, ..ExploreActionGoal::default() }
}

fn action_goal(world: &World) {
    let feedback = Heard::<ExploreActionFeedback>::on(&world.probe, "/explore/explore/feedback");
    let results = Heard::<ExploreActionResult>::on(&world.probe, "/explore/explore/result");
    let mut goals = world.probe.publish::<ExploreActionGoal>("/explore/explore/goal", 5).unwrap();
    goals.set_latching(true);
    let _sim = world.simulate_kindly(SLOWLY);
    let _explore = stays(world, &["_autostart:=false"]);
    let mut wanted = ExploreGoal { return_home: true, ..ExploreGoal::default() };
    wanted.map_file = world.folder.join("ordered").display().to_string();
    let corner = |x: f32, y: f32| Point32 { x, y, z: 0.0 };
    wanted.region.polygon.points = vec![corner(0.0, 0.0), corner(3.7, 0.0), corner(3.7, 3.5), corner(0.0, 3.5)];
    goals.send(goal("one", wanted)).unwrap();
    let during = feedback.expect(DEADLINE, "feedback", |m| m.feedback.status.elapsed_s > 1.0);
    assert!(during.feedback.status.map_age_s < 5.0, "{during:?}");
    assert_eq!((during.status.goal_id.id.as_str(), during.status.status), ("one", GoalStatus::ACTIVE));
    let end = results.expect(DEADLINE, "a result", |_| true);
    let result = &end.result;
    assert_eq!((end.status.goal_id.id.as_str(), end.status.status), ("one", GoalStatus::SUCCEEDED), "{end:?}");
    assert!(result.success && result.message.contains("back at the start"), "{end:?}");
    assert_eq!(result.end_reason, "outside_region");
    assert!(result.map_file.ends_with("ordered.yaml") && world.folder.join("ordered.pgm").exists(), "{end:?}");
    assert!(result.totals.turns == 1 && !world.map().with_extension("pgm").exists(), "{end:?}");
}

fn action_ends(world: &World) {
    let status = Statuses::of(world);
    let results = Heard::<ExploreActionResult>::on(&world.probe, "/explore/explore/result");
    let goals = world.probe.publish::<ExploreActionGoal>("/explore/explore/goal", 5).unwrap();
    let cancels = world.probe.publish::<GoalID>("/explore/explore/cancel", 5).unwrap();
    let _sim = world.simulate_kindly(SLOWLY);
    let explore = stays(world, &[]);
    status.until(ExplorationStatus::TURNING, "exploring by itself");
    let of = |id: &str| {
        let id = id.to_owned();
        results.expect(SOON, &id, |m| m.status.goal_id.id == id)
    };
    let taken_up = |id: &str| explore.expect_log(&format!("the goal {id} of the action is taken up"), SOON);
    goals.send(goal("wrong", ExploreGoal { time_limit_s: -1.0, ..ExploreGoal::default() })).unwrap();
    let wrong = of("wrong");
    assert_eq!(wrong.status.status, GoalStatus::REJECTED);
    assert!(wrong.status.text.starts_with("time_limit_s is -1"), "{wrong:?}");
    goals.send(goal("first", ExploreGoal::default())).unwrap();
    taken_up("first");
    assert!(explore.log().contains("a goal of the action takes its place"), "{}", explore.log());
    goals.send(goal("second", ExploreGoal::default())).unwrap();
    assert_eq!(of("first").status.status, GoalStatus::PREEMPTED);
    taken_up("second");
    cancels.send(GoalID { id: "second".to_owned(), ..GoalID::default() }).unwrap();
    let second = of("second");
    assert_eq!((second.status.status, second.result.end_reason.as_str()), (GoalStatus::PREEMPTED, "interrupted"));
    goals.send(goal("third", ExploreGoal { time_limit_s: 3.0, ..ExploreGoal::default() })).unwrap();
    let third = of("third");
    assert_eq!((third.status.status, third.result.end_reason.as_str()), (GoalStatus::SUCCEEDED, "time_limit"));
    goals.send(goal("fourth", ExploreGoal::default())).unwrap();
    taken_up("fourth");
    ask(world, "stop", true, "stopped by the user");
    let fourth = of("fourth");
    assert_eq!((fourth.status.status, fourth.result.success), (GoalStatus::ABORTED, false), "{fourth:?}");
}

fn yields(world: &World) {
    let status = Statuses::of(world);
    let click = world.probe.publish::<PoseStamped>("/move_base_simple/goal", 1).unwrap();
    let _sim = world.simulate_kindly(SLOWLY);
    let mut explore = world.explore(&[]);
    status.until(ExplorationStatus::DRIVING, "driving");
    let mut goal = PoseStamped::default();
    goal.header.frame_id = "map".to_owned();
    (goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w) = (1.0, 1.2, 1.0);
    click.send(goal).unwrap();
    explore.expect_log("a goal of somebody else is under way (/sim", SOON);
    explore.expect_log("the goal of somebody else is over: going on", SOON);
    explore.expect_code(0, DEADLINE);
    status.until(ExplorationStatus::YIELDING, "yielding");
    let end = status.until(ExplorationStatus::ENDED, "the end");
    assert_eq!((end.end_reason.as_str(), end.goals_failed), ("complete", 0));
}

fn rivals(world: &World) {
    let _sim = world.simulate_kindly(SLOWLY);
    let status = Statuses::of(world);
    let mut first = stays(world, &[]);
    status.until(ExplorationStatus::TURNING, "exploring");
    let mut second = Process::start(
        env!("CARGO_BIN_EXE_explore_node"),
        &["__name:=second", "_config:=liang"],
        world.folder.join("second.log"),
    );
    second.expect_code(1, SOON);
    let log = second.log();
    assert!(log.contains("the explorer /explore is there already (preset wfd: "), "{log}");
    assert!(log.contains("by /move_base/goal: stop it first"), "{log}");
    // One that was killed is known to the master, and no rival.
    first.signal("KILL");
    first.wait(SOON);
    let third = Process::start(
        env!("CARGO_BIN_EXE_explore_node"),
        &["__name:=third", "_config:=liang"],
        world.folder.join("third.log"),
    );
    third.expect_log("the explorer /explore is registered and says nothing: taken for dead", SOON);
    third.expect_log("third: preset liang", SOON);
}
