//! The oracle: how fast the same robot could have explored a world that it knew, as far as we
//! find out.
//!
//! A yardstick for strategies that do not know the world. The oracle plans on the true map and
//! drives the same simulated robot with the same navigator; what is measured of it is measured as
//! of every other run. Its aim is the least time to 99 % of coverage, and there its drive ends.
//!
//! It is an upper bound on the least possible time and not that time: routes are found by local
//! search, several are driven, and the fastest drive counts. Times to smaller shares
//! are what that drive comes to and may be beaten. Both of our controllers drive in turns: the
//! Dynamic Window Approach is the faster one in most drives, and pure pursuit gets through where it
//! finds no motion.
//!
//! | file | what |
//! |---|---|
//! | `ground.rs` | where the robot can stand, and the ways between |
//! | `sights.rs`, `seen.rs` | what the lidar sees from there |
//! | `routes.rs` | how long a route takes until enough is seen |
//! | `search.rs` | routes that take little time |
//! | `pilot.rs`, `stage.rs` | driving them |
//! | `record.rs` | what is recorded of a drive |

mod ground;
mod pilot;
mod record;
mod routes;
mod search;
mod seen;
mod sights;
mod stage;

pub use record::{ORACLE, OracleRun};

use crate::config::Preset;
use crate::control::{ControllerConfig, DwaConfig, FollowerConfig};
use crate::explore::EndReason;
use crate::run::{Plan, PlanError};
use crate::sim::SimRobot;
use ground::Ground;
use pilot::{Limits, Pilot};
use record::Driven;
use routes::{Routes, Situation};
use search::Search;
use sights::Sights;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The most routes that are driven. Each is the best of [`COVERS`] covers, and its drive teaches
/// what is really seen from where, which the next ones are planned with.
const MOST_DRIVES: f64 = 6.0;
/// Larger areas have fewer drives, so that each second of the computer's is about as much, square
/// metres.
const DRIVEN_M2: f64 = 1500.0;
const LEAST_DRIVES: f64 = 2.0;
/// Routes from which one is chosen to be driven.
const COVERS: usize = 2;
/// Trials by which each is bettered.
const TRIALS: usize = 10_000;
/// The shares that are planned for in turn. They are more than what is needed, as samples are few
/// and rays have gaps.
const SHARES: [f64; 2] = [0.9915, 0.994];

/// Who follows the ways, in turn.
const CONTROLLERS: [ControllerConfig; 2] =
    [ControllerConfig::Dwa(DwaConfig::DEFAULT), ControllerConfig::FollowPath(FollowerConfig::DEFAULT)];

/// Goals are places from which a corner is just looked round: a little short of one, much less is
/// seen, metres.
const GOAL_TOLERANCE_M: f64 = 0.08;

/// The settings of the oracle's runs, of which those of the navigation count.
#[must_use]
pub fn oracle_preset() -> Preset {
    let mut preset = Preset { preset: ORACLE.to_owned(), ..Preset::default() };
    preset.navigation.navigator.xy_goal_tolerance_m = GOAL_TOLERANCE_M;
    preset
}

/// Plans and drives in the world of a plan, whose preset is that of [`oracle_preset`] with a limit
/// of time; `None` when `stop` was raised.
///
/// # Errors
/// [`PlanError`] for a start where the robot does not fit.
pub fn run_oracle(plan: &Plan, stop: &AtomicBool) -> Result<Option<OracleRun>, PlanError> {
    let began = Instant::now();
    let best = match Planner::new(plan, &plan.robot()?) {
        Some(mut planner) => planner.best_drive(stop)?,
        None => Some(Driven::nowhere(plan.robot()?.stats())),
    };
    Ok(best.map(|driven| driven.record(plan, began.elapsed().as_secs_f64())))
}

/// What a world is to a robot that knows it, and where it begins.
struct Planner<'a> {
    plan: &'a Plan,
    routes: Routes,
    search: Search,
    begin: Situation,
    drives: usize,
}

impl<'a> Planner<'a> {
    /// Of a robot at its start; `None` where it cannot move.
    fn new(plan: &'a Plan, robot: &SimRobot) -> Option<Self> {
        let world = &plan.world.world;
        let sights = Sights::new(Arc::clone(world), plan.robot.lidar, robot.target());
        let ground = Ground::new(world, &plan.robot, &plan.start)?;
        let block = ground.block_at(plan.start.position())?;
        let begin = Situation { block, yaw: plan.start.yaw, seen: sights.known(robot.coverage()), enough: 0 };
        let mut routes = Routes::new(ground, sights, &plan.robot);
        let search = Search::new(&mut routes, plan.seed);
        let drives = (DRIVEN_M2 / robot.target().area_m2()).clamp(LEAST_DRIVES, MOST_DRIVES) as usize;
        Some(Self { plan, routes, search, begin, drives })
    }

    /// The fastest of several drives, `None` when `stop` was raised.
    fn best_drive(&mut self, stop: &AtomicBool) -> Result<Option<Driven>, PlanError> {
        let time_s = self.plan.preset.explorer.patience.time_limit_s.unwrap_or(f64::INFINITY);
        let mut best: Option<Driven> = None;
        for number in 0..self.drives {
            let share = SHARES[number / CONTROLLERS.len() % SHARES.len()];
            let route = self.best_route(share);
            let useful_s = best.as_ref().and_then(Driven::done_s).unwrap_or(f64::INFINITY);
            let limits = Limits { time_s, useful_s, stop };
            let mut plan = self.plan.clone();
            plan.preset.navigation.controller = CONTROLLERS[number % CONTROLLERS.len()];
            let mut robot = plan.robot()?;
            let driven = Pilot::new(&mut self.routes, &mut self.search, route, share).drive(&mut robot, &limits);
            if driven.end == EndReason::Interrupted {
                return Ok(None);
            }
            if best.as_ref().is_none_or(|best| driven.is_better_than(best)) {
                best = Some(driven);
            }
        }
        Ok(best)
    }

    /// The best route of several covers that see a share of what there is to see.
    fn best_route(&mut self, share: f64) -> Vec<usize> {
        self.begin.enough = self.routes.sights.samples_of(share);
        let mut best: Option<(Vec<usize>, f64)> = None;
        for _ in 0..COVERS {
            let cover = self.search.cover(&mut self.routes, &self.begin);
            let (route, estimate) = self.search.anneal(&mut self.routes, &self.begin, cover, TRIALS);
            if best.as_ref().is_none_or(|(_, least_s)| estimate.cost_s < *least_s) {
                best = Some((route, estimate.cost_s));
            }
        }
        best.map(|(route, _)| route).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests;
