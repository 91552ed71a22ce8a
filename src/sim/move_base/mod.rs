//! A stand-in for move_base that refuses, waits and fails as the real one does.
//!
//! After move_base of the ROS 1 navigation stack, from its source and from recorded runs:
//!
//! - A goal is taken up some time after it was sent. A new one in motion does not stop the
//!   robot: it holds its last velocity until the new plan is there.
//! - A plan each second from the costmap of the last map, by GlobalPlanner's rules
//!   ([`InflatedPlanner`]), through unknown cells too. No plan for `planner_patience`, no
//!   valid velocity for `controller_patience`, or no way made for `oscillation_timeout`
//!   lead to the recovery behaviours, one each time: forget far obstacles, turn round, forget
//!   all but the nearest, turn round. When all have been tried the goal is aborted, with
//!   move_base's words. As there, the last valid velocity is not renewed by a recovery, so
//!   that a robot that is wedged fails all four at once.
//! - The local planner sees a window of 4 m in the odometry's frame, marked by the scans. Where
//!   the padded outline touches a marked cell there is no valid velocity, whatever way leads
//!   out, and no turn either.
//!
//! Compared with two recorded runs of Stage, slam_gmapping and move_base: a goal without a
//! plan was aborted after 38.2 s there and is here after 37 to 39 s; the recoveries came in
//! this order, a turn took 6.2 s; of goals by their cost see `docs/simulator.md`. With
//! `controller_patience` 5 s a wedged robot fails sooner than there, where it was 15 s.
//!
//! Kinder than the real one: the global costmap has no obstacle layer, so that nothing
//! ghosts in it; the local planner is our own Dynamic Window Approach, which brakes in time;
//! planning takes no time.

mod config;
mod global_planner;
mod input;
mod local_costmap;
mod local_planner;
mod recovery;
mod task;

pub use config::MoveBaseConfig;
pub use global_planner::InflatedPlanner;
pub use input::MoveBaseInput;

use crate::config::RobotConfig;
use crate::geometry::{Body, Footprint, Path, Pose, Twist};
use crate::grid::{Costmap, Inflation, LiveCostmap, Thresholds};
use crate::robot::{CommandId, Navigation, NavigationState};
use local_planner::LocalPlanner;
use rand_distr::{Distribution, Uniform};
use rand_pcg::Pcg32;
use std::sync::Arc;
use task::Task;

/// Which sequence of the seed the delays are drawn from.
const STREAM: u64 = 0x30fe;

/// What the stand-in plans on, and since when.
#[derive(Debug)]
struct Global {
    costmap: Arc<Costmap>,
    since_s: f64,
}

/// The stand-in.
#[derive(Debug)]
pub struct MoveBase {
    config: MoveBaseConfig,
    costs: LiveCostmap,
    planner: InflatedPlanner,
    local: LocalPlanner,
    random: Pcg32,
    global: Option<Global>,
    /// A goal that was sent and is taken up at a time in seconds.
    sent: Option<(f64, CommandId, Pose)>,
    task: Option<Task>,
    /// What became of the last goal.
    navigation: Navigation,
}

impl MoveBase {
    /// At rest. `robot` and `config` are validated; `seed` decides the delays.
    #[must_use]
    pub fn new(config: MoveBaseConfig, robot: &RobotConfig, seed: u64) -> Self {
        let footprint = padded(&robot.footprint, config.footprint_padding_m);
        let inflation = Inflation {
            inscribed_radius_m: footprint.inscribed_radius_m(),
            clear_radius_m: 0.0,
            inflation_radius_m: robot.costmap.inflation_radius_m,
            cost_scaling_factor: robot.costmap.cost_scaling_factor,
        };
        let body = Body { footprint, limits: robot.limits };
        Self {
            config,
            costs: LiveCostmap::new(Thresholds::default(), inflation),
            planner: InflatedPlanner::new(config.allow_unknown),
            local: LocalPlanner::new(&body, &robot.body(), inflation),
            random: Pcg32::new(seed, STREAM),
            global: None,
            sent: None,
            task: None,
            navigation: Navigation { command: 0, state: NavigationState::Idle },
        }
    }

    /// Sends a goal; that of the same id is under way already.
    pub fn send(&mut self, id: CommandId, goal_in_map: Pose, now_s: f64) {
        if self.current() == Some(id) {
            return;
        }
        let MoveBaseConfig { take_up_min_s: low, take_up_max_s: high, .. } = self.config;
        let delay_s = Uniform::new_inclusive(low, high).map_or(low, |delay| delay.sample(&mut self.random));
        self.sent = Some((now_s + delay_s, id, goal_in_map));
        self.navigation = Navigation { command: id, state: NavigationState::Active };
    }

    /// Cancels the goal under way.
    pub fn cancel(&mut self) {
        (self.sent, self.task) = (None, None);
        self.navigation = Navigation { command: 0, state: NavigationState::Idle };
    }

    /// Forgets all obstacles that are not seen any more, as the service `clear_costmaps` does.
    pub fn clear_costmaps(&mut self) {
        self.local.forget();
    }

    /// The plan being followed, if any.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.task.as_ref().and_then(|task| task.plan.as_ref())
    }

    /// The global costmap, once there is one.
    #[must_use]
    pub fn costmap(&self) -> Option<&Arc<Costmap>> {
        self.global.as_ref().map(|global| &global.costmap)
    }

    /// The velocity until the next tick, and how the goal is doing.
    pub fn update(&mut self, input: &MoveBaseInput<'_>) -> (Twist, Navigation) {
        self.local.look(input);
        self.look_at_map(input);
        if let Some((due_s, id, goal)) = self.sent
            && input.stamp_s >= due_s
        {
            self.sent = None;
            let held = self.task.take().map_or(Twist::ZERO, |task| task.twist);
            self.task = Some(Task::new(id, goal, held, input));
        }
        let (Some(task), Some(global)) = (&mut self.task, &self.global) else {
            return (Twist::ZERO, self.navigation.clone());
        };
        let state = task.cycle(input, &self.config, &global.costmap, &mut self.planner, &mut self.local);
        let twist = task.twist;
        if state != NavigationState::Active {
            let id = task.id;
            self.task = None;
            if self.sent.is_none() {
                self.navigation = Navigation { command: id, state };
            }
            return (Twist::ZERO, self.navigation.clone());
        }
        (twist, self.navigation.clone())
    }

    /// Takes a new map into the costmap, as often as costmaps are updated.
    fn look_at_map(&mut self, input: &MoveBaseInput<'_>) {
        let is_due = |global: &Global| input.stamp_s - global.since_s >= self.config.costmap_period_s;
        if self.global.as_ref().is_none_or(is_due) {
            let costmap = self.costs.update(&input.map.cells, &input.map.changes).cells;
            self.global = Some(Global { costmap, since_s: input.stamp_s });
        }
    }

    fn current(&self) -> Option<CommandId> {
        (self.navigation.state != NavigationState::Idle).then_some(self.navigation.command)
    }
}

/// A footprint with padding on every side, as costmap_2d puts it on.
fn padded(footprint: &Footprint, padding_m: f64) -> Footprint {
    match footprint {
        Footprint::RadiusM(radius_m) => Footprint::RadiusM(radius_m + padding_m),
        Footprint::PolygonM(corners) => {
            let pad = |value: f64| if value == 0.0 { value } else { value + padding_m.copysign(value) };
            Footprint::PolygonM(corners.iter().map(|&[x, y]| [pad(x), pad(y)]).collect())
        }
    }
}

#[cfg(test)]
mod tests;
