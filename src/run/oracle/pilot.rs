//! Drives the simulated robot along a route of which it knows what it is good for.
//!
//! Commands are those of an explorer: goals for the navigator, which plans on the robot's own
//! map. Of the way to the next block of the route the farthest part that this map knows
//! is the goal. With each map the rest of the route is bettered from where the robot is, by what
//! has really been seen: what is no longer worth driving to is left out.

use super::record::{DONE, Driven};
use super::routes::{Routes, Situation};
use super::search::Search;
use super::seen::Seen;
use super::stage::Stage;
use crate::explore::{Counts, EndReason};
use crate::geometry::{Point, Pose};
use crate::report::Series;
use crate::robot::{Command, CommandId, NavigationState, Observation, Robot};
use crate::sim::SimRobot;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

/// How much more than that is planned for again when a route did not suffice.
const MORE: f64 = 0.002;
/// A block is reached within this distance of its stand, metres.
const REACHED_M: f64 = 0.1;
/// Or within this one where no more than [`LEFT`] of its samples cannot be seen from the robot.
const NEAR_M: f64 = 0.7;
const LEFT: f64 = 0.0005;
/// Trials by which the rest of a route is bettered with each map.
const TRIALS: usize = 120;
/// Trials when there is no route.
const NEW_TRIALS: usize = 2000;
/// The rest of a route is changed for a gain of this, seconds.
const WORTHWHILE_S: f64 = 0.6;
/// A robot that got nowhere for so long gives its block up, seconds.
const STALL_S: f64 = 6.0;
/// So many routes may turn out not to suffice, or not to be driven.
const MOST_ROUTES: usize = 40;

/// A new point of the trajectory is remembered after this way, metres.
const TRAJECTORY_STEP_M: f64 = 0.05;

/// When a drive ends besides by having seen enough.
pub(super) struct Limits<'a> {
    /// At this time it has failed, seconds.
    pub time_s: f64,
    /// At this time it is of no more use, seconds.
    pub useful_s: f64,
    /// Raised when the user stops it.
    pub stop: &'a AtomicBool,
}

/// What is done between two drives.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pause {
    /// A look round at the block that was reached.
    Turn,
    /// Getting away from where no way is free, as an explorer does.
    BackOff,
}

impl Pause {
    const fn command(self, id: CommandId) -> Command {
        match self {
            Self::Turn => Command::Turn { id, angle_rad: TAU },
            Self::BackOff => Command::BackOff { id },
        }
    }
}

/// Who drives.
pub(super) struct Pilot<'a> {
    routes: &'a mut Routes,
    search: &'a mut Search,
    route: Vec<usize>,
    /// The share of the samples that is planned for.
    share: f64,
    id: CommandId,
    stage: Option<Stage>,
    /// What it does instead of driving on.
    pause: Option<Pause>,
    /// The block reached since the last map.
    reached: Option<usize>,
    map_version: u64,
    moved: (f64, Pose),
    new_routes: usize,
    counts: Counts,
}

impl<'a> Pilot<'a> {
    /// One that drives a route, planned for a share of what there is to see.
    pub fn new(routes: &'a mut Routes, search: &'a mut Search, route: Vec<usize>, share: f64) -> Self {
        Self {
            routes,
            search,
            route,
            share,
            id: 0,
            stage: None,
            pause: None,
            reached: None,
            map_version: 0,
            moved: (0.0, Pose::default()),
            new_routes: 0,
            counts: Counts::default(),
        }
    }

    /// Drives until enough has been seen, or a limit is met.
    pub fn drive(mut self, robot: &mut SimRobot, limits: &Limits<'_>) -> Driven {
        let (mut series, mut trajectory) = (Series::new(), Vec::<Point>::new());
        let mut coverage = -1.0;
        let end = loop {
            let Ok(observation) = robot.observe() else { break EndReason::Disconnected };
            let (stats, pose) = (robot.stats(), robot.pose_in_map());
            series.push(stats.sim_time_s, stats.coverage, stats.distance_m);
            if trajectory.last().is_none_or(|&last| pose.distance_to(last) >= TRAJECTORY_STEP_M) {
                trajectory.push(pose.position());
            }
            if stats.coverage >= DONE {
                break EndReason::Complete;
            }
            if limits.stop.load(Ordering::Relaxed) {
                break EndReason::Interrupted;
            }
            if stats.sim_time_s >= limits.time_s.min(limits.useful_s) {
                break EndReason::TimeLimit;
            }
            self.watch_motion(stats.sim_time_s, &pose);
            let is_news = coverage != stats.coverage;
            coverage = stats.coverage;
            let Some(command) = self.decide(robot, &observation, &pose, is_news) else { break EndReason::Stuck };
            if robot.command(&command).is_err() {
                break EndReason::Disconnected;
            }
        };
        Driven { end, series, trajectory, stats: robot.stats(), counts: self.counts }
    }

    /// The block under way is given up when the robot has not moved for long.
    fn watch_motion(&mut self, now_s: f64, pose: &Pose) {
        let (since_s, from) = self.moved;
        if pose.distance_to(from.position()) > 0.2 || self.pause.is_some() {
            self.moved = (now_s, *pose);
        } else if now_s - since_s > STALL_S {
            self.moved = (now_s, *pose);
            self.give_up();
        }
    }

    fn give_up(&mut self) {
        if !self.route.is_empty() {
            self.route.remove(0);
        }
        self.stage = None;
    }

    const fn begin(&mut self, pause: Pause) -> Command {
        self.id += 1;
        self.pause = Some(pause);
        pause.command(self.id)
    }

    /// What the robot shall do, `None` where nothing more can be done.
    fn decide(&mut self, robot: &SimRobot, observation: &Observation, pose: &Pose, is_news: bool) -> Option<Command> {
        let state = (observation.navigation.command == self.id).then_some(&observation.navigation.state);
        if let Some(pause) = self.pause {
            if matches!(state, Some(NavigationState::Active | NavigationState::Idle) | None) {
                return Some(pause.command(self.id));
            }
            (self.pause, self.stage) = (None, None);
            if pause == Pause::Turn {
                self.reached = Some(self.route.remove(0));
            }
        }
        if matches!(state, Some(NavigationState::Aborted(_))) && self.stage.is_some() {
            self.counts.goals_failed += 1;
            self.give_up();
            return Some(self.begin(Pause::BackOff));
        }
        let map = observation.map.as_ref()?;
        let is_new_map = map.version() != self.map_version;
        self.map_version = map.version();
        if is_new_map && let Some(block) = self.reached.take() {
            let known = self.routes.sights.known(robot.coverage());
            self.routes.learn(block, &known);
        }
        if is_new_map && is_news {
            self.better(robot, pose);
        }
        loop {
            let Some(&next) = self.route.first() else {
                if self.reached.is_some() {
                    // What is seen from here is in the next map.
                    return Some(Command::Hold);
                }
                self.new_route(robot, pose)?;
                continue;
            };
            let is_at_end = self.stage.is_some_and(|stage| stage.is_last && stage.block == next)
                && state == Some(&NavigationState::Succeeded);
            if !is_at_end && !self.is_reached(next, pose, robot) {
                break;
            }
            self.stage = None;
            if !self.routes.sights.is_all_round() && !self.is_seen(next, robot) {
                return Some(self.begin(Pause::Turn));
            }
            self.reached = Some(self.route.remove(0));
        }
        let next = *self.route.first()?;
        let costmap = map.costmap.as_ref()?;
        let is_stale = self.stage.as_ref().is_none_or(|stage| stage.is_stale(next, pose, is_new_map));
        if is_stale {
            let ways = self.routes.ways_from(next);
            let way = self.routes.ground.way(&ways, pose.position());
            let stage = Stage::new(next, &way, self.routes.ground.stand(next), &costmap.cells);
            if self.stage.as_ref().is_none_or(|old| old.goal != stage.goal) {
                self.id += 1;
                self.counts.goals_sent += 1;
            }
            self.stage = Some(stage);
        }
        let goal_in_map = self.stage.as_ref()?.goal;
        Some(Command::Drive { id: self.id, goal_in_map })
    }

    /// Whether the robot is at a block, or sees from where it is what the block is for. At the
    /// last one of a route it must have seen it: nothing later would.
    fn is_reached(&mut self, block: usize, pose: &Pose, robot: &SimRobot) -> bool {
        let away_m = pose.distance_to(self.routes.ground.stand(block));
        if away_m <= REACHED_M {
            return true;
        }
        if away_m > NEAR_M || self.route.len() < 2 || !self.routes.sights.is_all_round() {
            return false;
        }
        let mut seen = self.routes.sights.known(robot.coverage());
        seen.add(&self.routes.sights.ahead(pose));
        self.lacks_little(block, &seen)
    }

    /// Whether what can be seen from a block has been.
    fn is_seen(&mut self, block: usize, robot: &SimRobot) -> bool {
        let known = self.routes.sights.known(robot.coverage());
        self.lacks_little(block, &known)
    }

    fn lacks_little(&mut self, block: usize, seen: &Seen) -> bool {
        self.routes.around(block).new_to(seen) <= self.routes.sights.samples_of(LEFT)
    }

    fn situation(&self, robot: &SimRobot, pose: &Pose) -> Option<Situation> {
        let block = self.routes.ground.block_at(pose.position())?;
        let sights = &self.routes.sights;
        let enough = sights.samples_of(self.share);
        Some(Situation { block, yaw: pose.yaw, seen: sights.known(robot.coverage()), enough })
    }

    /// Betters the rest of the route from here.
    fn better(&mut self, robot: &SimRobot, pose: &Pose) {
        let Some(here) = self.situation(robot, pose) else { return };
        let now = self.routes.estimate(&here, &self.route);
        let (route, estimate) = self.search.descend(self.routes, &here, &self.route, TRIALS);
        if estimate.cost_s < now.cost_s - WORTHWHILE_S && !route.is_empty() {
            if route.first() != self.route.first() {
                self.stage = None;
            }
            self.route = route;
        }
    }

    /// Plans anew from here for what is still lacking.
    fn new_route(&mut self, robot: &SimRobot, pose: &Pose) -> Option<()> {
        while self.new_routes < MOST_ROUTES {
            self.new_routes += 1;
            let here = self.situation(robot, pose)?;
            if here.seen.count() >= here.enough {
                // The samples are few, and coverage is counted on all cells.
                if self.share >= 1.0 {
                    return None;
                }
                self.share = (self.share + MORE).min(1.0);
                continue;
            }
            let cover = self.search.cover(self.routes, &here);
            let (route, _) = self.search.anneal(self.routes, &here, cover, NEW_TRIALS);
            if !route.is_empty() {
                self.route = route;
                return Some(());
            }
            self.share = (self.share + MORE).min(1.0);
        }
        None
    }
}
