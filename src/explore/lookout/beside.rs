//! What lies beside the way is seen before the robot leaves it behind: a frontier that is
//! passed over near by costs a way back from the other end of the building.

use super::super::assess::Assessed;
use super::{Choice, Lookout, Situation, Weighed};
use crate::explore::record::CandidateStatus;
use crate::explore::sight::is_in_sight;
use crate::frontier::{DetectError, Frontier};
use crate::geometry::{Path, Point, Pose};
use crate::grid::{OccupancyGrid, Thresholds};
use crate::planning::{GlobalPlanner, PathField};
use crate::robot::MapSnapshot;
use std::sync::Arc;

/// A frontier is worth at most this share of the way to the goal that it comes before.
const SHARE_OF_WAY: f64 = 0.5;
/// Where a way comes nearer to a frontier than the robot is by more than this, and in sight of
/// it, the robot will see it later, metres.
const NEARER_M: f64 = 0.3;
/// From one place on a way that is asked for that to the next, metres.
const STEP_M: f64 = 0.25;
/// A robot that is on its way to a frontier beside goes on though it has become a little
/// farther than it seemed.
const UNDER_WAY_FACTOR: f64 = 1.5;

impl Lookout {
    /// Puts a frontier near by before the chosen one, where the way to the chosen one leads
    /// away from it. All frontiers count that the robot fits through, also those that the
    /// preset drops for their size.
    ///
    /// # Errors
    /// [`DetectError`] when the map gives no answer.
    pub(super) fn look_beside(
        &mut self,
        weighed: &mut Weighed,
        situation: &Situation<'_>,
        map: &MapSnapshot,
        field: &PathField,
    ) -> Result<(), DetectError> {
        let settings = &situation.settings.goal;
        let (Some(limit_m), Some(chosen), Some(way)) = (settings.beside_way_m, weighed.choice, self.path.clone())
        else {
            return Ok(());
        };
        let (robot, info) = (situation.robot, map.grid.info());
        let worth_m = limit_m.min(SHARE_OF_WAY * way.length_m());
        let under_way = |target: Point| {
            situation.beside.is_some_and(|beside| nalgebra::distance(&beside, &target) <= settings.commit_radius_m)
        };
        let mut near = self.audit_frontiers(map, robot)?;
        near.retain(|f| f.cells.iter().any(|&cell| robot.distance_to(info.center(cell)) <= limit_m));
        let assessor = self.assessor(situation, map, Some(field));
        let standing = &mut self.standing;
        let mut open: Vec<(Pose, Assessed)> = near
            .iter()
            .map(|frontier| assessor.assess(frontier, standing))
            .filter(|a| a.record.status == CandidateStatus::Eligible)
            .filter_map(|a| Some((a.candidate.as_ref()?.goal, a)))
            .filter(|(_, a)| under_way(a.target) || leads_away(&way, a.target, &map.grid, &self.thresholds))
            .collect();
        open.sort_by(|(a, _), (b, _)| robot.distance_to(a.position()).total_cmp(&robot.distance_to(b.position())));
        for (goal, mut beside) in open {
            if nalgebra::distance(&beside.target, &chosen.target) <= settings.commit_radius_m {
                return Ok(());
            }
            let limit_m = if under_way(beside.target) { UNDER_WAY_FACTOR * limit_m } else { worth_m };
            let Ok(path) = self.guide.plan(field.costmap(), &robot, &goal) else { continue };
            if path.length_m() > limit_m {
                continue;
            }
            for other in &mut weighed.assessed {
                if other.record.status == CandidateStatus::Chosen {
                    (other.record.status, other.record.path_m) = (CandidateStatus::Eligible, None);
                }
            }
            let number = beside.record.id as usize;
            beside.record.id = weighed.assessed.iter().map(|a| a.record.id + 1).max().unwrap_or(0);
            if let Some(frontier) = near.get(number) {
                Arc::make_mut(&mut self.frontiers).push(Frontier { id: beside.record.id, ..frontier.clone() });
            }
            weighed.choice = Some(Choice { is_beside: true, ..beside.choose(goal, &path, false) });
            weighed.assessed.insert(0, beside);
            self.path = Some(Arc::new(path));
            break;
        }
        Ok(())
    }
}

/// Whether a way comes nowhere nearer to a point than it begins, where that is in sight.
fn leads_away(way: &Path, target: Point, grid: &OccupancyGrid, thresholds: &Thresholds) -> bool {
    let Some(&(mut last)) = way.poses.first() else { return true };
    let here_m = last.distance_to(target);
    let cell = grid.info().cell_at(target);
    way.poses.iter().all(|pose| {
        if pose.distance_to(target) >= here_m - NEARER_M || pose.distance_to(last.position()) < STEP_M {
            return true;
        }
        last = *pose;
        !is_in_sight(pose.position(), cell, grid, thresholds)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Cell, GridInfo};

    #[test]
    fn a_way_that_passes_by_leads_not_away() {
        let way = Path { poses: (0..10).map(|x| Pose::new(f64::from(x), 0.0, 0.0)).collect(), cost: 9.0 };
        let info = GridInfo::new(40, 40, 0.5, Pose::new(-5.0, -5.0, 0.0)).unwrap();
        let mut grid = OccupancyGrid::filled(info, 0);
        let away = |grid: &OccupancyGrid, x, y| leads_away(&way, Point::new(x, y), grid, &Thresholds::default());
        assert!(away(&grid, -1.0, 1.0));
        assert!(away(&grid, 0.2, 2.0), "nearly abeam");
        assert!(!away(&grid, 4.0, 2.2));
        for x in 0..40 {
            grid.set(Cell::new(x, 12), 100);
        }
        assert!(away(&grid, 4.0, 2.2), "behind a wall it is not seen in passing");
    }
}
