//! Plans for others: what move_base's service `make_plan` looks for.

use crate::geometry::Pose;
use crate::grid::Costmap;
use crate::planning::{GlobalPlanner, Path};
use std::sync::Arc;

/// What the plan service knows.
pub struct Plans {
    /// Plans.
    pub planner: Box<dyn GlobalPlanner>,
    /// On these costs.
    pub costmap: Arc<Costmap>,
    /// Where the robot is, in the map's frame.
    pub pose: Pose,
    /// Whether a goal is under way.
    pub is_busy: bool,
}

/// A plan to a goal, or else to the nearest square around it, three cells apart, up to a
/// tolerance in metres, as move_base looks for one.
pub fn plan_within(plans: &mut Plans, start: &Pose, goal: &Pose, tolerance_m: f64) -> Option<Path> {
    let Plans { planner, costmap, .. } = plans;
    let mut plan = |x: f64, y: f64| planner.plan(costmap, start, &Pose::new(goal.x + x, goal.y + y, goal.yaw)).ok();
    if let Some(path) = plan(0.0, 0.0) {
        return Some(path);
    }
    let usual_m = 3.0 * costmap.info().resolution_m();
    let step_m = if tolerance_m > 0.0 && tolerance_m < usual_m { tolerance_m } else { usual_m };
    // No tolerance that makes sense is farther.
    let rings = (tolerance_m / step_m + 1e-6).clamp(0.0, 100.0) as i32;
    (1..=rings).find_map(|ring| {
        let square = (-ring..=ring).flat_map(|y| (-ring..=ring).map(move |x| (x, y)));
        let rim = square.filter(|&(x, y): &(i32, i32)| x.abs().max(y.abs()) == ring);
        rim.map(|(x, y)| (f64::from(x) * step_m, f64::from(y) * step_m)).find_map(|(x, y)| plan(x, y))
    })
}
