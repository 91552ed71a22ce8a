//! From frontiers to candidates: where the robot would stand, how far it is, and what
//! speaks against going there.

use super::blacklist::{Blacklist, Taboo};
use super::record::{CandidateRecord, CandidateStatus};
use super::settings::ExplorerSettings;
use super::standing::StandingSearch;
use crate::frontier::Frontier;
use crate::geometry::{Point, Pose};
use crate::grid::GridInfo;
use crate::planning::PathField;
use crate::selection::{Candidate, GoalSelector, Needs, SelectionContext};

/// A frontier, what is recorded of it, and the candidate if the robot could go there.
#[derive(Debug)]
pub struct Assessed {
    /// For the decision record; `status` is final unless it is `Eligible`.
    pub record: CandidateRecord,
    /// The representative point.
    pub target: Point,
    /// What the strategies see: present unless no place to stand is connected.
    pub candidate: Option<Candidate>,
    /// Why it is left alone, when its status is `Taboo`.
    pub taboo: Option<Taboo>,
    /// What ranks it, once it has been scored.
    pub total: f64,
}

/// What an assessment looks at besides the frontiers.
pub struct Surroundings<'a> {
    /// The settings.
    pub settings: &'a ExplorerSettings,
    /// Where the frontiers' cells lie.
    pub info: &'a GridInfo,
    /// What the strategy needs to know.
    pub needs: Needs,
    /// How far it is to everywhere; `None` when the robot stands where it cannot.
    pub field: Option<&'a PathField>,
    /// Places to leave alone.
    pub blacklist: &'a Blacklist,
    /// Where the robot is.
    pub robot: Pose,
    /// Now, seconds.
    pub now_s: f64,
}

impl Surroundings<'_> {
    /// Assesses one frontier.
    pub fn assess(&self, frontier: &Frontier, standing: &mut StandingSearch) -> Assessed {
        let (settings, needs) = (self.settings, self.needs);
        let target = settings.goal.representative.of(frontier, self.info, self.robot.position());
        let distance_m = self.robot.distance_to(target);
        let goal = self.field.and_then(|field| {
            standing.goal(field, &self.robot, target, settings.goal.search_radius_m, settings.goal.heading)
        });
        let size_m = frontier.size_m(self.info);
        let candidate = goal.map(|goal| Candidate {
            target,
            goal,
            size_cells: frontier.cells.len(),
            size_m,
            radius_m: needs.radius.then(|| frontier.enclosing_circle(self.info).map_or(0.0, |circle| circle.radius_m)),
            distance_m,
            nearest_m: needs.nearest.then(|| self.nearest_m(frontier)),
            way_m: self.way_m(&goal),
        });
        let taboo = self.blacklist.check(target, self.now_s);
        let status = if settings.region.as_ref().is_some_and(|region| !region.contains(target)) {
            CandidateStatus::OutsideRegion
        } else if taboo.is_some() {
            CandidateStatus::Taboo
        } else {
            match goal {
                None => CandidateStatus::Unreachable,
                Some(goal) if self.robot.distance_to(goal.position()) < settings.goal.already_there_m => {
                    CandidateStatus::AlreadyThere
                }
                Some(_) => CandidateStatus::Eligible,
            }
        };
        let record = CandidateRecord {
            id: frontier.id,
            target: target.into(),
            goal,
            size_cells: frontier.cells.len(),
            size_m,
            distance_m,
            path_m: None,
            scores: Default::default(),
            status,
        };
        Assessed { record, target, candidate, taboo, total: f64::INFINITY }
    }

    fn nearest_m(&self, frontier: &Frontier) -> f64 {
        frontier.cells.iter().map(|&cell| self.robot.distance_to(self.info.center(cell))).fold(f64::INFINITY, f64::min)
    }

    fn way_m(&self, goal: &Pose) -> Option<f64> {
        let cells = self.field?.cost_cells(self.info.cell_at(goal.position()))?;
        Some(cells * self.info.resolution_m())
    }
}

/// Scores the eligible ones and puts them first, best first; the others follow in the
/// order of their ids. Returns how many are eligible.
pub fn rank(assessed: &mut [Assessed], selector: &mut dyn GoalSelector, robot: Pose) -> usize {
    assessed.sort_by_key(|a| (a.record.status != CandidateStatus::Eligible, a.record.id));
    let eligible = assessed.iter().filter(|a| a.record.status == CandidateStatus::Eligible).count();
    let (first, _) = assessed.split_at_mut(eligible);
    let candidates: Vec<Candidate> = first.iter().filter_map(|a| a.candidate.clone()).collect();
    let scores = selector.score(&candidates, &SelectionContext { robot_in_map: robot });
    for (assessed, score) in first.iter_mut().zip(scores) {
        assessed.total = score.total;
        assessed.record.scores = score.parts;
        assessed.record.scores.insert("total", score.total);
    }
    first.sort_by(|a, b| a.total.total_cmp(&b.total).then(a.record.id.cmp(&b.record.id)));
    eligible
}
