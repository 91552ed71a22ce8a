//! One decision: detect, assess, rank, and take the first to which there is a way; and
//! where there is none, look once more with other eyes.

mod beside;
mod choose;
mod costs;
mod map_ways;
mod second_look;
mod within;

use super::assess::{Assessed, Assessor, rank};
use super::audit::Audit;
use super::behind::unknown_behind_m2;
use super::blacklist::Blacklist;
use super::decided::{Audited, Choice, Decided, count, explain};
use super::record::{CandidateStatus, DecisionRecord, SeenFrontiers};
use super::settings::ExplorerSettings;
use super::sight::Sights;
use super::standing::StandingSearch;
use super::traits::RobotTraits;
use crate::frontier::{DetectError, DetectionInput, Frontier, FrontierDetector, FrontierTracker};
use crate::geometry::{Path, Point, Pose};
use crate::grid::Thresholds;
use crate::planning::{Astar, Driven, GlobalPlanner, PathField};
use crate::robot::{MapSnapshot, Observation};
use crate::selection::{GoalSelector, Ground, SelectionContext};
use costs::Costs;
use map_ways::MapWays;
use std::sync::Arc;

/// What a decision is made on, besides the map.
pub struct Situation<'a> {
    /// When, seconds.
    pub now_s: f64,
    /// The settings.
    pub settings: &'a ExplorerSettings,
    /// What failed or was visited.
    pub blacklist: &'a Blacklist,
    /// Where the robot was.
    pub sights: &'a Sights,
    /// Where it drove.
    pub driven: &'a Driven,
    /// Where it is.
    pub robot: Pose,
    /// It has arrived, and the map may be of before.
    pub awaits_map: bool,
    /// The frontier beside the way that it is on its way to, if it is.
    pub beside: Option<Point>,
    /// The target that it is on its way to, whatever that is.
    pub under_way: Option<Point>,
}

/// The algorithms that a decision wires together.
pub struct Lookout {
    detector: Box<dyn FrontierDetector>,
    selector: Box<dyn GoalSelector>,
    planner: Box<dyn GlobalPlanner>,
    guide: Astar,
    thresholds: Thresholds,
    standing: StandingSearch,
    tracker: FrontierTracker,
    audit: Audit,
    frontiers: Arc<SeenFrontiers>,
    path: Option<Arc<Path>>,
    costs: Costs,
}

/// What became of the frontiers of one detector.
struct Weighed {
    assessed: Vec<Assessed>,
    choice: Option<Choice>,
}

impl Lookout {
    /// The algorithms that the settings name, for a robot.
    pub fn new(settings: &ExplorerSettings, robot: &RobotTraits) -> Self {
        Self {
            detector: settings.detector.name.build(&settings.detector_params()),
            selector: settings.selection.build(),
            planner: settings.planner.build(&robot.body),
            guide: Astar::default(),
            thresholds: settings.thresholds,
            standing: StandingSearch::default(),
            tracker: FrontierTracker::new(),
            audit: Audit::new(robot, settings.thresholds),
            frontiers: Arc::default(),
            path: None,
            costs: Costs::new(settings.thresholds, robot.inflation, settings.areas()),
        }
    }

    /// Builds the detector and the strategy anew where their settings are others now; a strategy
    /// of one's own stays as long as the settings name the same one.
    pub fn adjust(&mut self, old: &ExplorerSettings, new: &ExplorerSettings) {
        if new.detector != old.detector {
            self.detector = new.detector.name.build(&new.detector_params());
        }
        if new.selection != old.selection {
            self.selector = new.selection.build();
        }
    }

    /// Whether the strategy itself weighs when a goal under way is given up for a better one.
    pub fn keeps_goals(&self) -> bool {
        self.selector.keeps_goals()
    }

    /// Chooses by another strategy, such as one of one's own.
    pub fn set_selector(&mut self, selector: Box<dyn GoalSelector>) {
        self.selector = selector;
    }

    /// Asks another planner for the way to a candidate, such as move_base's own.
    pub fn set_planner(&mut self, planner: Box<dyn GlobalPlanner>) {
        self.planner = planner;
    }

    /// The frontiers of the last decision.
    pub const fn frontiers(&self) -> &Arc<SeenFrontiers> {
        &self.frontiers
    }

    /// The way to the goal that was chosen last.
    pub const fn path(&self) -> Option<&Arc<Path>> {
        self.path.as_ref()
    }

    /// Whether the robot's centre may be at a point of the map.
    pub fn can_stand(&mut self, map: &MapSnapshot, point: Point) -> bool {
        let costmap = self.costs.of(map).cells;
        let is_allowed = self.costs.fence.fenced().is_none_or(|fenced| fenced.allows(point));
        is_allowed && costmap.is_passable(costmap.info().cell_at(point))
    }

    /// Weighs the frontiers of a map; of the observation, time and scan count.
    ///
    /// # Errors
    /// [`DetectError`] when this map gives no answer; that is not "no frontier".
    pub fn decide(
        &mut self,
        situation: &Situation<'_>,
        observation: &Observation,
        map: &MapSnapshot,
    ) -> Result<Decided, DetectError> {
        let (grid, robot) = (&map.grid, situation.robot);
        let tight = self.costs.of(map);
        let roomy = self.costs.roomy.update(&tight);
        let open = self.costs.opened.update(situation.driven, &roomy, &robot);
        let scan = observation.scan.as_ref().map(|(lidar_in_map, scan)| (lidar_in_map, &**scan));
        let changes = Some(&map.changes);
        let input = DetectionInput { grid, robot_in_map: robot, costmap: Some(&open.cells), scan, changes };
        let frontiers = self.detector.detect(&input)?;
        let mut frontiers = self.within(frontiers, grid.info(), situation.settings.detector.min_size_m);
        let names = self.tracker.update(&frontiers, grid.info());
        for (frontier, name) in frontiers.iter_mut().zip(names) {
            frontier.id = name.get();
        }
        self.frontiers = Arc::new(SeenFrontiers::new(*grid.info(), frontiers.clone()));
        // A robot that stands where it cannot reaches nothing: the recovery turn and
        // the next map may free it.
        let needs_ways = self.selector.needs().way;
        let fenced = self.costs.fence.update(&open, &robot);
        let passable = self.costs.passable.update(&fenced);
        let mut field = PathField::on(fenced.cells, passable, &robot, needs_ways).ok();
        let mut weighed = self.weigh(&frontiers, situation, map, field.as_ref());
        let has_nothing = |weighed: &Weighed| weighed.choice.is_none() && nearest_here(&weighed.assessed).is_none();
        if has_nothing(&weighed) && !Arc::ptr_eq(&tight.cells, &roomy.cells) {
            // Only now by ways on which the robot fits and cannot turn.
            let search = if needs_ways { PathField::new } else { PathField::reach_only };
            let cells = situation.driven.open(&tight.cells, &robot);
            field = search(self.costs.fence.close(&cells, &robot), &robot).ok();
            weighed = self.weigh(&frontiers, situation, map, field.as_ref());
        }
        let mut audit = None;
        if has_nothing(&weighed) {
            let (raw, second, audited) = self.look_again(situation, map, field.as_ref())?;
            frontiers = raw;
            (weighed, audit) = (second, Some(audited));
        }
        if let Some(field) = &field {
            self.look_beside(&mut weighed, situation, map, field)?;
        }
        let Weighed { assessed, choice } = weighed;
        let mut left_behind = count(&assessed);
        let wants_area = choice.is_none() || situation.settings.finish.good_enough_share.is_some();
        if wants_area {
            let is_inside = |f: &&Frontier| {
                let status = assessed.iter().find(|a| a.record.id == f.id).map(|a| a.record.status);
                status != Some(CandidateStatus::OutsideRegion)
            };
            let cells = self.costs.fence.cells_of(grid.info());
            left_behind.area_m2 =
                unknown_behind_m2(frontiers.iter().filter(is_inside), grid, &self.thresholds, cells.as_deref());
        }
        let is_forbidden = audit.is_some_and(|audit| audit.forbidden > 0);
        let here = if choice.is_none() && !is_forbidden { nearest_here(&assessed) } else { None };
        let mut why = explain(&assessed, choice.as_ref(), self.selector.name(), &left_behind);
        if audit.is_some() && choice.is_some() {
            why.insert_str(0, "the preset sees nothing more, the audit does: ");
        }
        if let Some(forbidden) = audit.as_ref().and_then(Audited::forbidden_by_areas) {
            why.push_str(&forbidden);
        }
        let record = DecisionRecord {
            time_s: observation.stamp_s,
            pose: robot,
            candidates: assessed.into_iter().map(|a| a.record).collect(),
            goal: choice.map(|c| c.goal),
            why,
        };
        Ok(Decided { record, choice, here, left_behind, audit })
    }

    /// Assesses and ranks frontiers, and takes the first to which there is a way.
    fn weigh(
        &mut self,
        frontiers: &[Frontier],
        situation: &Situation<'_>,
        map: &MapSnapshot,
        field: Option<&PathField>,
    ) -> Weighed {
        let assessor = self.assessor(situation, map, field);
        let standing = &mut self.standing;
        let mut assessed: Vec<Assessed> = frontiers.iter().map(|f| assessor.assess(f, standing)).collect();
        let mut ways = MapWays::of(field.filter(|_| self.selector.needs().ways), situation.robot);
        let thresholds = situation.settings.thresholds;
        let ground = field.map(|field| Ground { grid: &map.grid, thresholds, costmap: field.costmap() });
        let mut context = SelectionContext {
            now_s: situation.now_s,
            robot_in_map: situation.robot,
            sight: situation.sights.sight(),
            under_way: situation.under_way,
            ground,
            ways: &mut ways,
        };
        let eligible = rank(&mut assessed, &mut *self.selector, &mut context);
        let choice =
            field.and_then(|field| self.first_with_a_way(&mut assessed[..eligible], field.costmap(), &situation.robot));
        Weighed { assessed, choice }
    }

    fn assessor<'a>(
        &mut self,
        situation: &Situation<'a>,
        map: &'a MapSnapshot,
        field: Option<&'a PathField>,
    ) -> Assessor<'a> {
        Assessor {
            settings: situation.settings,
            grid: &map.grid,
            needs: self.selector.needs(),
            field,
            blacklist: situation.blacklist,
            sights: situation.sights,
            map_s: map.stamp_s,
            awaits_map: situation.awaits_map,
            robot: situation.robot,
            areas: self.costs.fence.cells_of(map.grid.info()),
            fenced: self.costs.fence.fenced().cloned(),
        }
    }
}

/// The nearest frontier that is seen from where the robot stands.
fn nearest_here(assessed: &[Assessed]) -> Option<Point> {
    assessed
        .iter()
        .filter(|a| a.record.status == CandidateStatus::AlreadyThere)
        .min_by(|a, b| a.record.distance_m.total_cmp(&b.record.distance_m))
        .map(|a| a.target)
}
