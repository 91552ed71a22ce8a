//! One decision: detect, assess, rank, and take the first to which there is a way.

use super::assess::{Assessed, Surroundings, rank};
use super::blacklist::{Blacklist, Taboo};
use super::record::{CandidateStatus, DecisionRecord, EndReason, LeftBehind, Position, SeenFrontier};
use super::settings::ExplorerSettings;
use super::stages::stage;
use super::standing::StandingSearch;
use crate::frontier::{DetectError, DetectionInput, Frontier, FrontierDetector, FrontierTracker};
use crate::geometry::{Body, Path, Point, Pose};
use crate::grid::{Costmap, GridInfo, Inflation, OccupancyGrid, Thresholds};
use crate::planning::{Astar, GlobalPlanner, PathField, PlanError};
use crate::robot::{MapSnapshot, Observation};
use crate::selection::GoalSelector;
use std::sync::Arc;

/// Where to go, when there is somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Where the robot shall stand.
    pub goal: Pose,
    /// The frontier's representative point.
    pub target: Point,
    /// Whether the goal is only a place on the way there.
    pub is_stage: bool,
}

/// What one decision found.
#[derive(Clone, Debug)]
pub struct Decided {
    /// For the log.
    pub record: DecisionRecord,
    /// The goal, if there is one.
    pub choice: Option<Choice>,
    /// The target that is seen from where the robot stands, when only such are left.
    pub here: Option<Point>,
    /// What is left, by the reason for leaving it.
    pub left_behind: LeftBehind,
}

impl Decided {
    /// Whether the robot could still be sent to a frontier near a point.
    pub fn is_open_near(&self, target: Point, radius_m: f64) -> bool {
        let is_open = |status| matches!(status, CandidateStatus::Chosen | CandidateStatus::Eligible);
        let near = |at: Position| nalgebra::distance(&target, &Point::new(at.x, at.y)) <= radius_m;
        self.record.candidates.iter().any(|c| is_open(c.status) && near(c.target))
    }

    /// Why a run ends for which nothing is left to choose.
    pub fn why_nothing_is_left(&self) -> (EndReason, String) {
        let LeftBehind { frontiers, unreachable, failed, exhausted, outside_region } = self.left_behind;
        if unreachable + failed > 0 {
            let message = format!(
                "{} of {frontiers} frontiers cannot be reached ({unreachable} without a place to stand that is \
                 connected, {failed} where driving failed)",
                unreachable + failed
            );
            (EndReason::AllUnreachable, message)
        } else if exhausted > 0 || outside_region == 0 {
            let message = format!("nothing more can be seen of the {exhausted} frontiers that are left");
            (EndReason::Complete, message)
        } else {
            (EndReason::OutsideRegion, format!("all {outside_region} frontiers left lie outside the region"))
        }
    }
}

/// The algorithms that a decision wires together.
pub struct Lookout {
    detector: Box<dyn FrontierDetector>,
    selector: Box<dyn GoalSelector>,
    planner: Box<dyn GlobalPlanner>,
    guide: Astar,
    thresholds: Thresholds,
    inflation: Inflation,
    standing: StandingSearch,
    tracker: FrontierTracker,
    frontiers: Vec<SeenFrontier>,
    path: Option<Path>,
    /// The costmap made last, with its map and the map's stamp.
    costmap: Option<(f64, Arc<OccupancyGrid>, Arc<Costmap>)>,
}

impl Lookout {
    /// The algorithms that the settings name, for a robot.
    pub fn new(settings: &ExplorerSettings, inflation: Inflation, body: &Body) -> Self {
        Self {
            detector: settings.detector.name.build(&settings.detector_params()),
            selector: settings.selection.build(),
            planner: settings.planner.build(body),
            guide: Astar::default(),
            thresholds: settings.thresholds,
            inflation,
            standing: StandingSearch::default(),
            tracker: FrontierTracker::new(),
            frontiers: Vec::new(),
            path: None,
            costmap: None,
        }
    }

    /// Asks another planner for the way to a candidate, such as move_base's own.
    pub fn set_planner(&mut self, planner: Box<dyn GlobalPlanner>) {
        self.planner = planner;
    }

    /// The frontiers of the last decision.
    pub fn frontiers(&self) -> &[SeenFrontier] {
        &self.frontiers
    }

    /// The way to the goal that was chosen last.
    pub const fn path(&self) -> Option<&Path> {
        self.path.as_ref()
    }

    /// Whether the robot's centre may be at a point of the map.
    pub fn can_stand(&mut self, map: &MapSnapshot, point: Point) -> bool {
        let costmap = self.costmap(map);
        costmap.is_passable(costmap.info().cell_at(point))
    }

    /// Weighs the frontiers of a map; of the observation, time and scan count.
    ///
    /// # Errors
    /// [`DetectError`] when this map gives no answer; that is not "no frontier".
    pub fn decide(
        &mut self,
        settings: &ExplorerSettings,
        blacklist: &Blacklist,
        observation: &Observation,
        map: &MapSnapshot,
        robot: Pose,
    ) -> Result<Decided, DetectError> {
        let (grid, now_s) = (&map.grid, observation.stamp_s);
        let costmap = self.costmap(map);
        let scan = observation.scan.as_ref().map(|(lidar_in_map, scan)| (lidar_in_map, &**scan));
        let input = DetectionInput { grid, robot_in_map: robot, costmap: Some(&costmap), scan };
        let mut frontiers = self.detector.detect(&input)?;
        let names = self.tracker.update(&frontiers, grid.info()).ids;
        for (frontier, name) in frontiers.iter_mut().zip(names) {
            frontier.id = name.get();
        }
        self.frontiers = in_metres(&frontiers, grid.info());
        // A robot that stands where it cannot reaches nothing: the recovery turn and
        // the next map may free it.
        let needs = self.selector.needs();
        let search = if needs.way { PathField::new } else { PathField::reach_only };
        let field = search(Arc::clone(&costmap), &robot).ok();
        let surroundings =
            Surroundings { settings, info: grid.info(), needs, field: field.as_ref(), blacklist, robot, now_s };
        let standing = &mut self.standing;
        let mut assessed: Vec<Assessed> = frontiers.iter().map(|f| surroundings.assess(f, standing)).collect();
        let eligible = rank(&mut assessed, &mut *self.selector, robot);
        let choice = self.first_with_a_way(&mut assessed[..eligible], &costmap, &robot);
        let left_behind = count(&assessed);
        let here = if choice.is_none() { nearest_here(&assessed) } else { None };
        let why = explain(&assessed, choice.as_ref(), self.selector.name(), &left_behind);
        let record = DecisionRecord {
            time_s: now_s,
            pose: robot,
            candidates: assessed.into_iter().map(|a| a.record).collect(),
            goal: choice.map(|c| c.goal),
            why,
        };
        Ok(Decided { record, choice, here, left_behind })
    }

    /// Asks the planner in order of rank; what has no path says so in its record. When
    /// none has, and the planner gave up on some before it knew, part of the way to the
    /// first of these is taken.
    fn first_with_a_way(&mut self, ranked: &mut [Assessed], costmap: &Costmap, robot: &Pose) -> Option<Choice> {
        let mut given_up = Vec::new();
        for (index, assessed) in ranked.iter_mut().enumerate() {
            let Some(goal) = assessed.candidate.as_ref().map(|c| c.goal) else { continue };
            match self.planner.plan(costmap, robot, &goal) {
                Ok(path) => {
                    let choice = assessed.choose(goal, &path, false);
                    self.path = Some(path);
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
            self.path = Some(path);
            Some(choice)
        })
    }

    /// The costmap that came with the map, or our own, made once for each map.
    fn costmap(&mut self, map: &MapSnapshot) -> Arc<Costmap> {
        if let Some(costmap) = &map.costmap {
            return Arc::clone(costmap);
        }
        let (thresholds, inflation) = (&self.thresholds, &self.inflation);
        let costmap = match &self.costmap {
            Some((stamp_s, _, costmap)) if *stamp_s == map.stamp_s => return Arc::clone(costmap),
            Some((_, old, costmap)) => costmap.reinflate(old, &map.grid, thresholds, inflation),
            None => Costmap::inflate(&map.grid, thresholds, inflation),
        };
        let costmap = Arc::new(costmap);
        self.costmap = Some((map.stamp_s, Arc::clone(&map.grid), Arc::clone(&costmap)));
        costmap
    }
}

impl Assessed {
    /// Makes it the choice of its decision.
    fn choose(&mut self, goal: Pose, path: &Path, is_stage: bool) -> Choice {
        self.record.path_m = Some(path.length_m());
        self.record.status = CandidateStatus::Chosen;
        Choice { goal, target: self.target, is_stage }
    }
}

fn in_metres(frontiers: &[Frontier], info: &GridInfo) -> Vec<SeenFrontier> {
    let seen = |f: &Frontier| SeenFrontier { id: f.id, cells: f.cells.iter().map(|&cell| info.center(cell)).collect() };
    frontiers.iter().map(seen).collect()
}

/// The nearest frontier that is seen from where the robot stands.
fn nearest_here(assessed: &[Assessed]) -> Option<Point> {
    assessed
        .iter()
        .filter(|a| a.record.status == CandidateStatus::AlreadyThere)
        .min_by(|a, b| a.record.distance_m.total_cmp(&b.record.distance_m))
        .map(|a| a.target)
}

fn count(assessed: &[Assessed]) -> LeftBehind {
    let mut left = LeftBehind { frontiers: assessed.len(), ..LeftBehind::default() };
    for a in assessed {
        match (a.record.status, a.taboo) {
            (CandidateStatus::OutsideRegion, _) => left.outside_region += 1,
            (CandidateStatus::Unreachable | CandidateStatus::NoPath, _) => left.unreachable += 1,
            (CandidateStatus::Taboo, Some(Taboo::Exhausted)) => left.exhausted += 1,
            (CandidateStatus::Taboo, _) => left.failed += 1,
            (CandidateStatus::Chosen | CandidateStatus::Eligible | CandidateStatus::AlreadyThere, _) => {}
        }
    }
    left
}

/// One sentence about the decision.
fn explain(assessed: &[Assessed], choice: Option<&Choice>, strategy: &str, left: &LeftBehind) -> String {
    let skipped = assessed.iter().filter(|a| a.record.status == CandidateStatus::NoPath).count();
    match choice {
        Some(choice) => {
            let passed_over = if skipped > 0 { format!(", {skipped} before it had no path") } else { String::new() };
            let part = if choice.is_stage { ": the planner gave up, part of the way" } else { "" };
            format!(
                "{strategy}: best of {} frontiers, at ({:.2}, {:.2}) m{passed_over}{part}",
                left.frontiers, choice.target.x, choice.target.y
            )
        }
        None => format!(
            "no goal among {} frontiers: {} unreachable, {} failed, {} exhausted, {} outside the region",
            left.frontiers, left.unreachable, left.failed, left.exhausted, left.outside_region
        ),
    }
}
