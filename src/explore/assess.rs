//! From frontiers to candidates: where the robot would stand, how far it is, and what
//! speaks against going there.

use super::blacklist::{Blacklist, Taboo};
use super::opening::is_too_narrow;
use super::record::{CandidateRecord, CandidateStatus};
use super::settings::ExplorerSettings;
use super::sight::Sights;
use super::standing::{StandingGoal, StandingSearch};
use crate::frontier::Frontier;
use crate::geometry::{Point, Pose};
use crate::grid::{AreaCells, GridInfo, OccupancyGrid};
use crate::planning::{Fenced, PathField};
use crate::selection::{Candidate, GoalSelector, Needs, SelectionContext};
use std::sync::Arc;

/// A frontier, what is recorded of it, and the candidate if the robot could go there.
#[derive(Debug)]
pub struct Assessed {
    /// For the decision record; `status` is final unless it is `Eligible`.
    pub record: CandidateRecord,
    /// The representative point, or the cell that the robot is sent to see instead.
    pub target: Point,
    /// What the strategies see: present unless no place to stand is connected.
    pub candidate: Option<Candidate>,
    /// Why it is left alone, when its status is `Taboo`.
    pub taboo: Option<Taboo>,
    /// How far from it the best place to stand is, metres, where the robot was there in vain.
    pub spent_m: Option<f64>,
    /// What ranks it, once it has been scored.
    pub total: f64,
}

/// What an assessment looks at besides the frontiers.
pub struct Assessor<'a> {
    /// The settings.
    pub settings: &'a ExplorerSettings,
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// What the strategy needs to know.
    pub needs: Needs,
    /// How far it is to everywhere; `None` when the robot stands where it cannot.
    pub field: Option<&'a PathField>,
    /// Places to leave alone.
    pub blacklist: &'a Blacklist,
    /// Where the robot was.
    pub sights: &'a Sights,
    /// Everything sensed up to this time is in the map, seconds.
    pub map_s: f64,
    /// The robot has arrived somewhere and the map may be of before: what has come into
    /// plain sight since can wait for the next one.
    pub awaits_map: bool,
    /// Where the robot is.
    pub robot: Pose,
    /// The map's cells by the areas that they lie in, if there are areas.
    pub areas: Option<Arc<AreaCells>>,
    /// Where the robot may be, where it may not be everywhere.
    pub fenced: Option<Fenced>,
}

/// Where to go for a frontier.
struct Aim {
    target: Point,
    goal: Option<Pose>,
    status: CandidateStatus,
    taboo: Option<Taboo>,
    spent_m: Option<f64>,
}

/// A representative point farther than this from all cells of its frontier does not stand
/// for a place where these are seen, metres: the centre of a ring, of a bow.
const OFF_FRONTIER_M: f64 = 0.5;
/// So many of a frontier's cells are tried where its representative point serves for nothing.
const OTHER_CELLS: usize = 12;

impl Assessor<'_> {
    /// Assesses one frontier.
    pub fn assess(&self, frontier: &Frontier, standing: &mut StandingSearch) -> Assessed {
        let (info, needs) = (self.grid.info(), self.needs);
        let Aim { target, goal, status, taboo, spent_m } = self.aim(frontier, standing);
        let distance_m = self.robot.distance_to(target);
        let size_m = frontier.size_m(info);
        let candidate = goal.map(|goal| Candidate {
            radius_m: needs.radius.then(|| frontier.enclosing_circle(info).map_or(0.0, |circle| circle.radius_m)),
            nearest_m: needs.nearest.then(|| self.nearest_m(frontier)),
            way_m: self.way_m(&goal),
            ..Candidate::new(target, goal, frontier.cells.len(), info.resolution_m(), &self.robot)
        });
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
        Assessed { record, target, candidate, taboo, spent_m, total: f64::INFINITY }
    }

    fn aim(&self, frontier: &Frontier, standing: &mut StandingSearch) -> Aim {
        let (settings, info) = (self.settings, self.grid.info());
        let target = self.inside(frontier, settings.goal.representative.of(frontier, info, self.robot.position()));
        let left = |status, taboo| Aim { target, goal: None, status, taboo, spent_m: None };
        if self.areas.as_ref().is_some_and(|areas| !frontier.cells.iter().any(|&cell| areas.is_inside(cell))) {
            return left(CandidateStatus::OutsideRegion, None);
        }
        if self.field.is_some_and(|field| is_too_narrow(frontier, info, field.costmap())) {
            return left(CandidateStatus::TooNarrow, None);
        }
        let seen = |until_s| {
            let robot = self.robot.position();
            self.sights.of_frontier(frontier, self.grid, &settings.thresholds, robot, until_s)
        };
        let so_far = seen(self.map_s);
        let mut goal = self.place_for(target, standing);
        let mut target = target;
        let serves = |goal: &Option<Pose>| goal.is_some_and(|goal| !self.is_here(&goal));
        let is_open = self.spent_m(target, &goal).is_none();
        let stands_for_it = serves(&goal) && is_open && is_near(frontier, info, target);
        if !(so_far.all || stands_for_it) {
            let others = self.other_cells(frontier, so_far.nearest_open);
            let other = others.into_iter().find_map(|cell| {
                let place = self.place_for(cell, standing);
                let is_open = || !self.blacklist.has_failed(cell) && self.spent_m(cell, &place).is_none();
                (serves(&place) && is_open()).then_some((cell, place))
            });
            (target, goal) = other.unwrap_or((target, goal));
        }
        let has_failed = self.blacklist.has_failed(target);
        let taboo = if so_far.all { Some(Taboo::Exhausted) } else { has_failed.then_some(Taboo::Failed) };
        let spent_m = self.spent_m(target, &goal);
        let status = match goal {
            _ if taboo.is_some() => CandidateStatus::Taboo,
            None if self.has_failed(target, standing) => {
                return Aim { target, goal, status: CandidateStatus::Taboo, taboo: Some(Taboo::Failed), spent_m };
            }
            None => CandidateStatus::Unreachable,
            Some(_) if spent_m.is_some() => CandidateStatus::Unreachable,
            Some(goal) if self.is_here(&goal) => CandidateStatus::AlreadyThere,
            Some(_) if self.awaits_map && seen(f64::INFINITY).all => CandidateStatus::AlreadyThere,
            Some(_) => CandidateStatus::Eligible,
        };
        Aim { target, goal, status, taboo, spent_m }
    }

    /// How far from the target the best place to stand is, metres, where the robot was there
    /// and saw no more of it.
    fn spent_m(&self, target: Point, goal: &Option<Pose>) -> Option<f64> {
        let place = goal.as_ref()?.position();
        let is_spent = self.blacklist.is_spent(place, target, self.sights.sight().is_all_round());
        is_spent.then(|| nalgebra::distance(&place, &target))
    }

    /// The frontier's cells to go and see instead of its representative point: first the
    /// nearest that was not in plain sight so far, then some all along it.
    fn other_cells(&self, frontier: &Frontier, nearest_open: Option<Point>) -> Vec<Point> {
        let info = self.grid.info();
        let step = frontier.cells.len().div_ceil(OTHER_CELLS).max(1);
        let mut along: Vec<Point> = frontier.cells.iter().step_by(step).map(|&cell| info.center(cell)).collect();
        along.sort_by(|a, b| self.robot.distance_to(*a).total_cmp(&self.robot.distance_to(*b)));
        nearest_open.into_iter().chain(along).collect()
    }

    fn place_for(&self, target: Point, standing: &mut StandingSearch) -> Option<Pose> {
        self.place(target, standing, &|place| self.blacklist.refuses(place) || !self.allows(place))
    }

    fn place(&self, target: Point, standing: &mut StandingSearch, refused: &dyn Fn(Point) -> bool) -> Option<Pose> {
        let goal = &self.settings.goal;
        let heading = goal.heading.of_view(self.sights.sight().is_all_round());
        let search = StandingGoal { radius_m: goal.search_radius_m, heading, refused };
        standing.goal(self.field?, &self.robot, target, &search)
    }

    /// Whether there would be a place to stand but for those that have failed.
    fn has_failed(&self, target: Point, standing: &mut StandingSearch) -> bool {
        self.place(target, standing, &|place| !self.allows(place)).is_some()
    }

    fn allows(&self, place: Point) -> bool {
        self.fenced.as_ref().is_none_or(|fenced| fenced.allows(place))
    }

    /// A representative point inside of the areas: the frontier's cell that is nearest to one outside.
    fn inside(&self, frontier: &Frontier, target: Point) -> Point {
        let info = self.grid.info();
        if self.areas.as_ref().is_none_or(|areas| areas.is_inside(info.cell_at(target))) {
            return target;
        }
        let away_m = |point: &Point| nalgebra::distance(point, &target);
        let centers = frontier.cells.iter().map(|&cell| info.center(cell));
        centers.min_by(|a, b| away_m(a).total_cmp(&away_m(b))).unwrap_or(target)
    }

    fn is_here(&self, goal: &Pose) -> bool {
        self.robot.distance_to(goal.position()) < self.settings.goal.already_there_m
    }

    fn nearest_m(&self, frontier: &Frontier) -> f64 {
        let info = self.grid.info();
        frontier.cells.iter().map(|&cell| self.robot.distance_to(info.center(cell))).fold(f64::INFINITY, f64::min)
    }

    fn way_m(&self, goal: &Pose) -> Option<f64> {
        let info = self.grid.info();
        let cells = self.field?.cost_cells(info.cell_at(goal.position()))?;
        Some(cells * info.resolution_m())
    }
}

fn is_near(frontier: &Frontier, info: &GridInfo, target: Point) -> bool {
    frontier.cells.iter().any(|&cell| nalgebra::distance(&info.center(cell), &target) <= OFF_FRONTIER_M)
}

/// Scores the eligible ones and puts them first, best first; the others follow in the
/// order of their ids. Returns how many are eligible.
pub fn rank(assessed: &mut [Assessed], selector: &mut dyn GoalSelector, context: &mut SelectionContext<'_>) -> usize {
    assessed.sort_by_key(|a| (a.record.status != CandidateStatus::Eligible, a.record.id));
    let eligible = assessed.iter().filter(|a| a.record.status == CandidateStatus::Eligible).count();
    let (first, _) = assessed.split_at_mut(eligible);
    let candidates: Vec<Candidate> = first.iter().filter_map(|a| a.candidate.clone()).collect();
    let scores = selector.score(&candidates, context);
    for (assessed, score) in first.iter_mut().zip(scores) {
        assessed.total = score.total;
        assessed.record.scores = score.parts;
        assessed.record.scores.insert("total", score.total);
    }
    first.sort_by(|a, b| a.total.total_cmp(&b.total).then(a.record.id.cmp(&b.record.id)));
    eligible
}
