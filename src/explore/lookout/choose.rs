//! The first of the ranked candidates to which there is a way.

use super::super::assess::Assessed;
use super::super::stages::stage;
use super::{Choice, Lookout};
use crate::explore::record::CandidateStatus;
use crate::geometry::{Path, Pose};
use crate::grid::Costmap;
use crate::planning::PlanError;
use std::sync::Arc;

impl Lookout {
    /// Asks the planner in order of rank; what has no path says so in its record. When
    /// none has, and the planner gave up on some before it knew, part of the way to the
    /// first of these is taken.
    pub(super) fn first_with_a_way(
        &mut self,
        ranked: &mut [Assessed],
        costmap: &Costmap,
        robot: &Pose,
    ) -> Option<Choice> {
        let mut given_up = Vec::new();
        for (index, assessed) in ranked.iter_mut().enumerate() {
            let Some(goal) = assessed.candidate.as_ref().map(|c| c.goal) else { continue };
            let plan = self.planner.plan(costmap, robot, &goal);
            // A planner that knows nothing of the areas may lead through them.
            let keeps_inside = |path: &Path| self.costs.fence.fenced().is_none_or(|fenced| fenced.keeps(path));
            match plan {
                Ok(path) if !keeps_inside(&path) => assessed.record.status = CandidateStatus::NoPath,
                Ok(path) => {
                    let choice = assessed.choose(goal, &path, false);
                    self.path = Some(Arc::new(path));
                    return Some(choice);
                }
                Err(error) => {
                    assessed.record.status = CandidateStatus::NoPath;
                    if matches!(error, PlanError::IterationLimit { .. }) {
                        given_up.push((index, goal));
                    }
                }
            }
        }
        given_up.into_iter().find_map(|(index, goal)| {
            let (place, path) = stage(&mut *self.planner, &mut self.guide, costmap, robot, &goal)?;
            let choice = ranked.get_mut(index)?.choose(place, &path, true);
            self.path = Some(Arc::new(path));
            Some(choice)
        })
    }
}

impl Assessed {
    /// Makes it the choice of its decision.
    pub(super) fn choose(&mut self, goal: Pose, path: &Path, is_stage: bool) -> Choice {
        self.record.path_m = Some(path.length_m());
        self.record.status = CandidateStatus::Chosen;
        Choice { goal, target: self.target, is_stage, is_beside: false }
    }
}
