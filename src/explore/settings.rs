//! All that decides how an explorer behaves. Deserialised from a preset, validated
//! before use; every field has a default, so that a preset says only what is its own.

use super::blacklist::TabooConfig;
use super::standing::GoalHeading;
use crate::frontier::{
    CannyParams, DbscanParams, DetectorKind, DetectorParams, DetectorParamsError, FastParams, ImageParams,
    Reachability, Representative,
};
use crate::geometry::{Areas, Polygon};
use crate::grid::{Neighbourhood, Thresholds};
use crate::planning::PlannerConfig;
use crate::range::{OutOfRange, Range, Ranged};
use crate::selection::SelectorConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A setting that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// A number out of its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A parameter of the detector.
    #[error(transparent)]
    Detector(#[from] DetectorParamsError),
}

/// When the robot turns round to look about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TurnSettings {
    /// A full turn is made before the first decision.
    pub at_start: bool,
    /// A full turn is made on arrival at every goal.
    pub at_goal: bool,
    /// How many recovery turns are made before giving up, while no way leads to any frontier.
    pub recoveries: u32,
}

impl Default for TurnSettings {
    fn default() -> Self {
        Self { at_start: true, at_goal: true, recoveries: 2 }
    }
}

/// How a goal is derived from a frontier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GoalSettings {
    /// The point that stands for the frontier.
    pub representative: Representative,
    /// How far from the frontier's point a place to stand is looked for, metres.
    pub search_radius_m: f64,
    /// Which way the robot looks at the goal.
    pub heading: GoalHeading,
    /// The robot stands at a goal already when nearer than this, metres.
    pub already_there_m: f64,
    /// On the way the goal is reconsidered after each such time, seconds. Never when null, as
    /// the papers that drive to the end of each goal have it.
    pub reconsider_period_s: Option<f64>,
    /// A reconsidered goal is kept while a frontier remains this near to its own, metres. The
    /// frontier must be one that could be chosen. Robots that follow every change of mind run to
    /// and fro between rooms; with 0 no goal is kept.
    pub commit_radius_m: f64,
    /// Frontiers to which the way is at most so long are seen before a far goal, metres. Far is
    /// a goal at least twice as far away, where the way there leads away from the frontier.
    /// Frontiers that the preset drops for their size count as well. None when null.
    pub beside_way_m: Option<f64>,
}

impl Default for GoalSettings {
    fn default() -> Self {
        Self {
            representative: Representative::Median,
            search_radius_m: 2.0,
            heading: GoalHeading::TowardFrontier,
            already_there_m: 0.25,
            reconsider_period_s: None,
            commit_radius_m: 1.0,
            beside_way_m: None,
        }
    }
}

/// How long is waited for what.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PatienceSettings {
    /// The robot counts as stuck after this time at one position, seconds.
    pub progress_timeout_s: f64,
    /// The distance from which on a position counts as another one, metres.
    pub progress_distance_m: f64,
    /// The longest that one goal may take, seconds.
    pub goal_timeout_s: f64,
    /// How long a map with the newest sights is waited for before a small turn brings one,
    /// seconds. The robot turns since gmapping sends no map while it stands. Only an end, and
    /// presets that turn round at their goals, wait for such a map.
    pub settle_s: f64,
    /// A robot that is sent to a goal and stands still for so long is sent elsewhere,
    /// seconds.
    pub stall_s: f64,
    /// A robot that has not moved at all for a new goal is sent elsewhere after so long, seconds.
    /// Its planner has found no way: GlobalPlanner fails so for one goal in twelve, wherever the
    /// goal lies in its cell.
    pub begin_s: f64,
    /// A goal stays under way while the pose is unknown for less than this time, seconds.
    pub pose_grace_s: f64,
    /// How long the robot goes on trying, in all, while each attempt fails, seconds. The pauses
    /// between the attempts grow.
    pub failing_s: f64,
    /// The run ends when nothing new was seen for so long, whatever is left, seconds.
    pub no_news_s: f64,
    /// The run ends when no usable map came for so long, seconds.
    pub map_timeout_s: f64,
    /// The run ends when the robot did not know where it was for so long, seconds.
    pub pose_timeout_s: f64,
    /// The run ends when nobody carried its commands out for so long, seconds.
    pub navigation_timeout_s: f64,
    /// The run ends after so long, seconds. Never when null.
    pub time_limit_s: Option<f64>,
}

impl Default for PatienceSettings {
    fn default() -> Self {
        Self {
            progress_timeout_s: 20.0,
            progress_distance_m: 0.25,
            goal_timeout_s: 300.0,
            settle_s: 2.5,
            stall_s: 5.0,
            begin_s: 2.0,
            pose_grace_s: 1.0,
            failing_s: 120.0,
            no_news_s: 900.0,
            map_timeout_s: 60.0,
            pose_timeout_s: 60.0,
            navigation_timeout_s: 60.0,
            time_limit_s: None,
        }
    }
}

/// When a run is over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FinishSettings {
    /// The run goes on to frontiers that the check before the end alone sees. The preset's own
    /// detector does not see them; without this setting such a run ends `preset_sees_no_more`.
    pub explore_what_the_audit_sees: bool,
    /// The run ends `good_enough` once this share of the free area is known, 1 being all. The
    /// area behind the frontiers left is an estimate. Never when null.
    pub good_enough_share: Option<f64>,
}

impl Default for FinishSettings {
    fn default() -> Self {
        Self { explore_what_the_audit_sees: true, good_enough_share: None }
    }
}

/// Which detector, with its parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DetectorSettings {
    /// Which detector finds the frontiers.
    pub name: DetectorKind,
    /// How many cells are adjacent to one: 4 share a side with it, 8 a side or a corner.
    pub neighbours: Neighbourhood,
    /// Which frontier cells count as within the robot's reach.
    pub reachability: Reachability,
    /// Frontiers smaller than this are dropped, metres. The size is the number of cells times the
    /// resolution.
    pub min_size_m: f64,
    /// Parameters of the detector `image`; no other reads them.
    pub image: ImageParams,
    /// Parameters of the detector `dbscan`; no other reads them.
    pub dbscan: DbscanParams,
    /// Parameters of the detector `canny`; no other reads them.
    pub canny: CannyParams,
    /// Parameters of the detector `fast`; no other reads them.
    pub fast: FastParams,
}

/// The explorer's settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExplorerSettings {
    /// Which values of the map are free and which are occupied. The scale is that of
    /// `nav_msgs/OccupancyGrid`, -1 unknown and 0 to 100; values in between are neither.
    pub thresholds: Thresholds,
    /// How frontiers are found.
    pub detector: DetectorSettings,
    /// Which frontier comes first.
    pub selection: SelectorConfig,
    /// How paths to goals are planned.
    pub planner: PlannerConfig,
    /// How a goal is derived from a frontier.
    pub goal: GoalSettings,
    /// When the robot turns round to look about.
    pub turns: TurnSettings,
    /// What becomes of goals that fail.
    pub taboo: TabooConfig,
    /// How long the robot waits for what, and when it gives up.
    pub patience: PatienceSettings,
    /// When the run is over.
    pub finish: FinishSettings,
    /// The robot explores and keeps to the inside of this polygon, metres of the map frame. At
    /// least three corners `[x, y]`, in order; everywhere when null.
    pub region: Option<Polygon>,
    /// The robot keeps out of these polygons, metres of the map frame. Each has at least three
    /// corners `[x, y]`, in order; its body keeps out too.
    pub no_go: Vec<Polygon>,
    /// The robot drives back to where the run began before it ends.
    pub return_to_start: bool,
}

impl ExplorerSettings {
    /// Checks every number.
    ///
    /// # Errors
    /// [`SettingsError`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), SettingsError> {
        Ranged::check_all(self.numbers())?;
        Ok(self.detector_params().validate()?)
    }

    /// The numbers with their ranges, but for those of the detector.
    pub(crate) fn numbers(&self) -> Vec<Ranged> {
        let (goal, patience, taboo) = (&self.goal, &self.patience, &self.taboo);
        let positive = [
            ("goal.search_radius_m", Some(goal.search_radius_m)),
            ("goal.reconsider_period_s", goal.reconsider_period_s),
            ("goal.beside_way_m", goal.beside_way_m),
            ("patience.progress_timeout_s", Some(patience.progress_timeout_s)),
            ("patience.progress_distance_m", Some(patience.progress_distance_m)),
            ("patience.goal_timeout_s", Some(patience.goal_timeout_s)),
            ("patience.stall_s", Some(patience.stall_s)),
            ("patience.begin_s", Some(patience.begin_s)),
            ("patience.no_news_s", Some(patience.no_news_s)),
            ("patience.map_timeout_s", Some(patience.map_timeout_s)),
            ("patience.pose_timeout_s", Some(patience.pose_timeout_s)),
            ("patience.navigation_timeout_s", Some(patience.navigation_timeout_s)),
            ("patience.time_limit_s", patience.time_limit_s),
            ("taboo.radius_m", Some(taboo.radius_m)),
            ("taboo.max_failures", Some(f64::from(taboo.max_failures))),
            ("taboo.max_visits", Some(f64::from(taboo.max_visits))),
        ];
        let not_negative = [
            ("goal.already_there_m", goal.already_there_m),
            ("goal.commit_radius_m", goal.commit_radius_m),
            ("patience.settle_s", patience.settle_s),
            ("patience.pose_grace_s", patience.pose_grace_s),
            ("patience.failing_s", patience.failing_s),
        ];
        let share = Range::above(0.0, 1.0, "above 0 and at most 1");
        let mut numbers = positive.map(|(key, value)| Range::POSITIVE.of(key, value)).to_vec();
        numbers.extend(not_negative.map(|(key, value)| Range::NOT_NEGATIVE.of(key, value)));
        numbers.push(share.of("finish.good_enough_share", self.finish.good_enough_share));
        numbers.extend(self.planner.numbers());
        numbers.extend(self.selection.numbers());
        numbers
    }

    /// Where the robot may be.
    #[must_use]
    pub fn areas(&self) -> Areas {
        Areas { region: self.region.clone(), no_go: self.no_go.clone() }
    }

    /// The detector's parameters with the thresholds that apply to all detectors.
    #[must_use]
    pub fn detector_params(&self) -> DetectorParams {
        let DetectorSettings { name: _, neighbours, reachability, min_size_m, image, dbscan, canny, fast } =
            self.detector;
        let thresholds = self.thresholds;
        DetectorParams { neighbours, reachability, min_size_m, thresholds, image, dbscan, canny, fast }
    }
}
