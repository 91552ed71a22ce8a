//! Part of the way to a goal that a planner gave up on: a place on the guide's path that it can plan to.
//!
//! A planner that gives up after so many expansions says nothing about the goal but that
//! it is far. When no nearer goal is left, the robot drives a part of the cheapest way
//! over the grid and asks again from there, rather than leave the frontier for good.

use crate::geometry::Pose;
use crate::grid::Costmap;
use crate::planning::{Astar, GlobalPlanner, Path};

/// The parts of the way that are tried, the longest first.
const PARTS: [f64; 4] = [0.5, 0.25, 0.125, 0.0625];

/// Nearer than this is not worth the drive, metres.
const SHORTEST_M: f64 = 1.0;

/// The farthest place on the cheapest way to `goal` to which `planner` has a path, with
/// that path; `None` when there is no way, or no path to any place on it.
pub fn stage(
    planner: &mut dyn GlobalPlanner,
    guide: &mut Astar,
    costmap: &Costmap,
    robot: &Pose,
    goal: &Pose,
) -> Option<(Pose, Path)> {
    let way = guide.plan(costmap, robot, goal).ok()?.poses;
    PARTS.iter().find_map(|part| {
        let place = *way.get((way.len() as f64 * part) as usize)?;
        if robot.distance_to(place.position()) < SHORTEST_M {
            return None;
        }
        planner.plan(costmap, robot, &place).ok().map(|path| (place, path))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridInfo;
    use crate::planning::PlanError;

    /// Gives up on goals farther than this, metres.
    struct ShortSighted(f64);

    impl GlobalPlanner for ShortSighted {
        fn name(&self) -> &'static str {
            "short_sighted"
        }

        fn plan(&mut self, _: &Costmap, start: &Pose, goal: &Pose) -> Result<Path, PlanError> {
            let length_m = start.distance_to(goal.position());
            if length_m > self.0 {
                return Err(PlanError::IterationLimit { limit: 1 });
            }
            Ok(Path { poses: vec![*start, *goal], cost: length_m })
        }
    }

    #[test]
    fn the_farthest_part_that_can_be_planned_is_driven() {
        let info = GridInfo::new(400, 3, 0.1, Pose::default()).unwrap();
        let costmap = Costmap::from_costs(info, vec![0; 1200]).unwrap();
        let (robot, goal) = (Pose::new(0.15, 0.15, 0.0), Pose::new(39.95, 0.15, 0.0));
        let x_m = |sight_m: f64| {
            stage(&mut ShortSighted(sight_m), &mut Astar::default(), &costmap, &robot, &goal).map(|(place, _)| place.x)
        };
        assert!(x_m(25.0).is_some_and(|x| (x - 20.0).abs() < 0.3));
        assert!(x_m(12.0).is_some_and(|x| (x - 10.0).abs() < 0.3));
        assert_eq!(x_m(2.0), None);
        let walled = Costmap::from_costs(info, (0..1200).map(|i| if i % 400 == 200 { 254 } else { 0 }).collect());
        assert!(stage(&mut ShortSighted(99.0), &mut Astar::default(), &walled.unwrap(), &robot, &goal).is_none());
    }
}
