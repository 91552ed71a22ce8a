//! The local planner: our Dynamic Window Approach on the local costmap, blocked where
//! dwa_local_planner is.

use super::MoveBaseInput;
use super::local_costmap::LocalCostmap;
use crate::control::{ControlError, ControlInput, Controller, Dwa, DwaConfig};
use crate::geometry::{Body, Path, Pose, Twist, shortest_angle};
use crate::grid::{Costmap, Inflation};

/// From one inflation of the window to the next, seconds: the local costmap's usual 5 Hz.
const PERIOD_S: f64 = 0.2;
/// Turning at the goal, radians per second: `min_in_place_vel_theta` at least.
const SLOWEST_TURN_RPS: f64 = 0.4;

/// Sees the scans and follows plans.
pub struct LocalPlanner {
    /// With padding, for the checks of the outline.
    padded: Body,
    inflation: Inflation,
    dwa: Dwa,
    window: Option<LocalCostmap>,
    costmap: Option<(f64, Costmap)>,
    scan_s: f64,
}

impl std::fmt::Debug for LocalPlanner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LocalPlanner").field("padded", &self.padded).finish_non_exhaustive()
    }
}

impl LocalPlanner {
    /// For a robot, with its padded outline and without.
    pub fn new(padded: &Body, body: &Body, inflation: Inflation) -> Self {
        Self {
            padded: padded.clone(),
            inflation,
            dwa: Dwa::new(DwaConfig::DEFAULT, body),
            window: None,
            costmap: None,
            scan_s: f64::NEG_INFINITY,
        }
    }

    /// Takes the newest scan into the window.
    pub fn look(&mut self, input: &MoveBaseInput<'_>) {
        let place = input.pose_in_odom.position();
        if self.window.is_none() {
            self.window = LocalCostmap::around(place);
        }
        let Some(window) = &mut self.window else { return };
        window.follow(place);
        let (lidar_in_odom, scan) = input.scan;
        if scan.stamp_s != self.scan_s {
            self.scan_s = scan.stamp_s;
            window.add(lidar_in_odom, scan);
        }
        if self.costmap.as_ref().is_none_or(|(since_s, _)| input.stamp_s - since_s >= PERIOD_S) {
            self.costmap = Some((input.stamp_s, window.inflated(&self.inflation)));
        }
    }

    /// Forgets all obstacles; the next scan marks what is there.
    pub fn forget(&mut self) {
        (self.window, self.costmap, self.scan_s) = (None, None, f64::NEG_INFINITY);
    }

    /// Forgets obstacles beyond a distance in metres.
    pub fn clear_beyond(&mut self, place: &Pose, distance_m: f64) {
        if let Some(window) = &mut self.window {
            window.clear_beyond(place.position(), distance_m);
        }
    }

    /// Whether the padded outline touches an obstacle at a pose of the odometry's frame.
    pub fn touches(&self, pose_in_odom: &Pose) -> bool {
        self.window.as_ref().is_some_and(|window| window.touches(&self.padded.footprint, pose_in_odom))
    }

    /// Begins a new plan.
    pub fn set_plan(&mut self) {
        self.dwa.reset();
    }

    /// A velocity along a plan of the map's frame.
    ///
    /// # Errors
    /// [`ControlError`] when there is none: dwa_local_planner finds none where the outline
    /// touches an obstacle already, as every trajectory begins there.
    pub fn follow(&mut self, input: &MoveBaseInput<'_>, plan: &Path) -> Result<Twist, ControlError> {
        let Some((_, costmap)) = &self.costmap else { return Err(ControlError::Blocked) };
        if self.touches(&input.pose_in_odom) {
            return Err(ControlError::Blocked);
        }
        let odom_from_map = input.map_from_odom.inverse();
        let path = Path { poses: plan.poses.iter().map(|pose| odom_from_map.compose(pose)).collect(), cost: plan.cost };
        self.dwa.control(&ControlInput {
            pose_in_map: input.pose_in_odom,
            twist: input.twist,
            path: &path,
            costmap,
            scan: Some(input.scan),
            dt_s: input.dt_s,
        })
    }

    /// A turn on the spot towards a heading of the map.
    ///
    /// # Errors
    /// [`ControlError::Blocked`] when the outline would touch something.
    pub fn turn(&self, input: &MoveBaseInput<'_>, yaw_in_map: f64) -> Result<Twist, ControlError> {
        let error = shortest_angle(input.pose_in_map().yaw, yaw_in_map);
        let top_rps = self.padded.limits.max_angular_rps.max(SLOWEST_TURN_RPS);
        let speed = (2.0 * error.abs()).clamp(SLOWEST_TURN_RPS, top_rps).copysign(error);
        let twist = Twist::new(0.0, speed);
        let ahead = twist.advance(&input.pose_in_odom, 2.0 * input.dt_s);
        if self.touches(&input.pose_in_odom) || self.touches(&ahead) { Err(ControlError::Blocked) } else { Ok(twist) }
    }
}
