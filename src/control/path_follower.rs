//! Pure pursuit with turns on the spot: the plain follower of the simulator.
//!
//! R. C. Coulter, "Implementation of the Pure Pursuit Path Tracking Algorithm" (CMU
//! 1992), with the lookahead point pulled in until the straight line to it is free, so
//! that corners are not cut into obstacles.

use super::path_progress::PathProgress;
use super::{ControlError, ControlInput, Controller};
use crate::geometry::{Body, Pose, Twist, shortest_angle};
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the follower.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FollowerConfig {
    /// Distance of the point that is steered for, metres.
    pub lookahead_m: f64,
    /// Heading errors above this are turned away on the spot, radians.
    pub turn_on_spot_above_rad: f64,
    /// Turning speed for each radian of heading error, 1/s.
    pub heading_gain: f64,
}

impl FollowerConfig {
    /// The default parameters.
    pub const DEFAULT: Self = Self { lookahead_m: 0.6, turn_on_spot_above_rad: 0.7, heading_gain: 3.0 };

    /// The numbers with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        let positive = [
            ("controller.lookahead_m", self.lookahead_m),
            ("controller.turn_on_spot_above_rad", self.turn_on_spot_above_rad),
            ("controller.heading_gain", self.heading_gain),
        ];
        positive.map(|(key, value)| Range::POSITIVE.of(key, value)).into()
    }
}

impl Default for FollowerConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The follower and its progress along the current path.
#[derive(Clone, Debug)]
pub struct PathFollower {
    config: FollowerConfig,
    body: Body,
    progress: PathProgress,
}

impl PathFollower {
    /// A follower for a robot.
    #[must_use]
    pub const fn new(config: FollowerConfig, body: Body) -> Self {
        Self { config, body, progress: PathProgress::new() }
    }

    /// The forward speed from which the robot can still stop at the path's end.
    fn speed_before_end(&self, input: &ControlInput<'_>) -> f64 {
        let remaining_m = input.path.poses.last().map_or(0.0, |end| input.pose_in_map.distance_to(end.position()));
        (2.0 * 0.8 * self.body.limits.max_linear_mps2 * remaining_m).sqrt()
    }
}

impl Controller for PathFollower {
    fn name(&self) -> &'static str {
        "follow_path"
    }

    fn reset(&mut self) {
        self.progress = PathProgress::new();
    }

    fn control(&mut self, input: &ControlInput<'_>) -> Result<Twist, ControlError> {
        let robot = input.pose_in_map.position();
        self.progress.advance(input.path, robot, 3.0 * self.config.lookahead_m);
        let aim = self.progress.aim(input, self.config.lookahead_m).ok_or(ControlError::EmptyPath)?;
        let heading = Pose::facing(robot, aim).yaw;
        let error = shortest_angle(input.pose_in_map.yaw, heading);
        let limits = &self.body.limits;
        // Never faster than a turn that can be braked within the remaining error.
        let brakeable = (2.0 * 0.8 * limits.max_angular_rps2 * error.abs()).sqrt();
        let turn = (self.config.heading_gain * error).clamp(-brakeable, brakeable);
        if error.abs() > self.config.turn_on_spot_above_rad {
            return Ok(Twist::new(0.0, turn));
        }
        // A path of cells is jagged: its small errors are steered away at full speed, and from half
        // of what is turned away on the spot on it slows down.
        let share = (2.0 - 2.0 * error.abs() / self.config.turn_on_spot_above_rad).clamp(0.1, 1.0);
        let speed = (limits.max_linear_mps * share).min(self.speed_before_end(input)).max(0.02);
        Ok(Twist::new(speed, turn))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Path;
    use crate::geometry::{Footprint, MotionLimits, Point};
    use crate::grid::{Costmap, GridInfo};

    const DT_S: f64 = 0.1;

    fn follower() -> PathFollower {
        let limits =
            MotionLimits { max_linear_mps: 0.5, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 };
        PathFollower::new(FollowerConfig::default(), Body { footprint: Footprint::RadiusM(0.18), limits })
    }

    /// Drives along a path for `seconds` over an open costmap.
    fn drive(path: &Path, start: Pose, seconds: f64) -> Pose {
        let info = GridInfo::new(200, 200, 0.05, Pose::default()).unwrap();
        let costmap = Costmap::from_costs(info, vec![0; info.len()]).unwrap();
        let mut follower = follower();
        let (mut pose, mut twist) = (start, Twist::ZERO);
        for _ in 0..(seconds / DT_S) as usize {
            let input = ControlInput { pose_in_map: pose, twist, path, costmap: &costmap, scan: None, dt_s: DT_S };
            let wanted = follower.control(&input).unwrap();
            twist = follower.body.limits.reachable(&twist, &wanted, DT_S);
            pose = twist.advance(&pose, DT_S);
        }
        pose
    }

    fn path(points: &[(f64, f64)]) -> Path {
        Path { poses: points.iter().map(|&(x, y)| Pose::new(x, y, 0.0)).collect(), cost: 0.0 }
    }

    #[test]
    fn arrives_at_the_end_of_a_corner() {
        let corner: Vec<_> =
            (0..=60).map(|i| 0.1 * f64::from(i)).map(|s| (1.0 + s.min(3.0), 1.0 + (s - 3.0).max(0.0))).collect();
        let end = drive(&path(&corner), Pose::new(1.0, 1.0, 0.0), 18.0);
        assert!(end.distance_to(Point::new(4.0, 4.0)) < 0.15, "{end:?}");
    }

    #[test]
    fn turns_before_it_drives_when_the_path_lies_behind() {
        let behind: Vec<_> = (0..=40).map(|i| (5.0 - 0.05 * f64::from(i), 5.0)).collect();
        let behind = path(&behind);
        let soon = drive(&behind, Pose::new(5.0, 5.0, 0.0), 1.0);
        assert!(soon.distance_to(Point::new(5.0, 5.0)) < 0.05, "{soon:?}");
        let later = drive(&behind, Pose::new(5.0, 5.0, 0.0), 9.0);
        assert!(later.distance_to(Point::new(3.0, 5.0)) < 0.15, "{later:?}");
    }

    #[test]
    fn an_empty_path_is_an_error() {
        let info = GridInfo::new(5, 5, 1.0, Pose::default()).unwrap();
        let costmap = Costmap::from_costs(info, vec![0; 25]).unwrap();
        let path = Path::default();
        let input = ControlInput {
            pose_in_map: Pose::default(),
            twist: Twist::ZERO,
            path: &path,
            costmap: &costmap,
            scan: None,
            dt_s: DT_S,
        };
        assert_eq!(follower().control(&input), Err(ControlError::EmptyPath));
    }
}
