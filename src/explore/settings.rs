//! All that decides how an explorer behaves. Deserialised from a preset, validated
//! before use; every field has a default, so that a preset says only what is its own.

use super::blacklist::TabooConfig;
use super::standing::GoalHeading;
use crate::frontier::{
    CannyParams, DbscanParams, DetectorKind, DetectorParams, DetectorParamsError, FastParams, ImageParams,
    Reachability, Representative,
};
use crate::geometry::Polygon;
use crate::grid::{Neighbourhood, Thresholds};
use crate::planning::PlannerConfig;
use crate::range::OutOfRange;
use crate::selection::SelectorConfig;
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TurnSettings {
    /// Before the first decision.
    pub at_start: bool,
    /// On arrival at every goal.
    pub at_goal: bool,
    /// How many recovery turns are made, while frontiers remain to which there is no
    /// way, before giving up.
    pub recoveries: u32,
}

impl Default for TurnSettings {
    fn default() -> Self {
        Self { at_start: true, at_goal: true, recoveries: 2 }
    }
}

/// How a goal is derived from a frontier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GoalSettings {
    /// The point that stands for the frontier.
    pub representative: Representative,
    /// How far from it a place to stand is looked for, metres.
    pub search_radius_m: f64,
    /// Which way the robot looks at the goal.
    pub heading: GoalHeading,
    /// The robot stands at a goal already when nearer than this, metres.
    pub already_there_m: f64,
    /// Decide anew every so many seconds while driving; never when absent, as the
    /// papers that drive to the end of each goal have it.
    pub reconsider_period_s: Option<f64>,
    /// A goal that is reconsidered is kept while a frontier that could be chosen remains
    /// this near to the one it was chosen for, metres: robots that follow every change
    /// of mind run to and fro between rooms. 0 never keeps it.
    pub commit_radius_m: f64,
    /// A frontier to which the way is at most so long is seen before the robot leaves for a
    /// goal at least twice as far, where the way there leads away from it, metres. Frontiers
    /// that the preset drops for their size count as well. Never when absent.
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PatienceSettings {
    /// The robot counts as stuck after this time at one position, seconds.
    pub progress_timeout_s: f64,
    /// What counts as another position, metres.
    pub progress_distance_m: f64,
    /// The longest that one goal may take, seconds.
    pub goal_timeout_s: f64,
    /// How long a map that shows the newest sights is waited for before a small turn
    /// brings one, seconds: gmapping sends none while the robot stands. Only an end, and
    /// presets that turn round at their goals, wait for it.
    pub settle_s: f64,
    /// A robot that is sent to a goal and stands still for so long is sent elsewhere,
    /// seconds.
    pub stall_s: f64,
    /// One that has not moved at all since it was sent, after so long, seconds: its planner
    /// has found no way. GlobalPlanner fails so for one goal in twelve, wherever it lies in
    /// its cell.
    pub begin_s: f64,
    /// A pose that is unknown for less than this leaves the goal under way, seconds.
    pub pose_grace_s: f64,
    /// While frontiers are left and each attempt fails, the robot goes on trying for this
    /// time in all, with growing pauses, seconds.
    pub failing_s: f64,
    /// The run ends when nothing new was seen for so long, whatever is left, seconds.
    pub no_news_s: f64,
    /// The run ends when no usable map came for so long, seconds.
    pub map_timeout_s: f64,
    /// The run ends when the robot did not know where it was for so long, seconds.
    pub pose_timeout_s: f64,
    /// The run ends when nobody carried its commands out for so long, seconds.
    pub navigation_timeout_s: f64,
    /// The run ends after so long, seconds; never when absent.
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FinishSettings {
    /// Go on to frontiers that the preset's own detector does not see, where the check
    /// before the end finds some. Without it such a run ends `preset_sees_no_more`.
    pub explore_what_the_audit_sees: bool,
    /// End `good_enough` once this share of the free area is known, the area behind the
    /// frontiers left being an estimate; never when absent.
    pub good_enough_share: Option<f64>,
}

impl Default for FinishSettings {
    fn default() -> Self {
        Self { explore_what_the_audit_sees: true, good_enough_share: None }
    }
}

/// Which detector, with its parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DetectorSettings {
    /// Its name.
    pub name: DetectorKind,
    /// Which cells are adjacent: 4 or 8.
    pub neighbours: Neighbourhood,
    /// What counts as reachable.
    pub reachability: Reachability,
    /// Smaller frontiers are dropped; number of cells times resolution, metres.
    pub min_size_m: f64,
    /// Read by the image detector alone.
    pub image: ImageParams,
    /// Read by the dbscan detector alone.
    pub dbscan: DbscanParams,
    /// Read by the canny detector alone.
    pub canny: CannyParams,
    /// Read by the fast detector alone.
    pub fast: FastParams,
}

/// The explorer's settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ExplorerSettings {
    /// Where free ends and occupied begins.
    pub thresholds: Thresholds,
    /// How frontiers are found.
    pub detector: DetectorSettings,
    /// Which frontier comes first.
    pub selection: SelectorConfig,
    /// How ways are found.
    pub planner: PlannerConfig,
    /// How a goal is derived from a frontier.
    pub goal: GoalSettings,
    /// When to look about.
    pub turns: TurnSettings,
    /// What becomes of goals that fail.
    pub taboo: TabooConfig,
    /// How long is waited for what.
    pub patience: PatienceSettings,
    /// When the run is over.
    pub finish: FinishSettings,
    /// Only frontiers inside are explored: corners [x, y] in metres of the map frame.
    pub region: Option<Polygon>,
    /// Drive back to where the run began before it ends.
    pub return_to_start: bool,
}

impl ExplorerSettings {
    /// Checks every number.
    ///
    /// # Errors
    /// [`SettingsError`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let (goal, patience, taboo) = (&self.goal, &self.patience, &self.taboo);
        for (key, value) in [
            ("goal.search_radius_m", goal.search_radius_m),
            ("goal.reconsider_period_s", goal.reconsider_period_s.unwrap_or(1.0)),
            ("goal.beside_way_m", goal.beside_way_m.unwrap_or(1.0)),
            ("patience.progress_timeout_s", patience.progress_timeout_s),
            ("patience.progress_distance_m", patience.progress_distance_m),
            ("patience.goal_timeout_s", patience.goal_timeout_s),
            ("patience.stall_s", patience.stall_s),
            ("patience.begin_s", patience.begin_s),
            ("patience.no_news_s", patience.no_news_s),
            ("patience.map_timeout_s", patience.map_timeout_s),
            ("patience.pose_timeout_s", patience.pose_timeout_s),
            ("patience.navigation_timeout_s", patience.navigation_timeout_s),
            ("patience.time_limit_s", patience.time_limit_s.unwrap_or(1.0)),
            ("taboo.radius_m", taboo.radius_m),
            ("taboo.max_failures", f64::from(taboo.max_failures)),
            ("taboo.max_visits", f64::from(taboo.max_visits)),
            ("finish.good_enough_share", self.finish.good_enough_share.unwrap_or(1.0)),
        ] {
            OutOfRange::unless_positive(key, value)?;
        }
        for (key, value) in [
            ("goal.already_there_m", goal.already_there_m),
            ("goal.commit_radius_m", goal.commit_radius_m),
            ("patience.settle_s", patience.settle_s),
            ("patience.pose_grace_s", patience.pose_grace_s),
            ("patience.failing_s", patience.failing_s),
        ] {
            OutOfRange::unless_not_negative(key, value)?;
        }
        let share = self.finish.good_enough_share.unwrap_or(1.0);
        OutOfRange::unless(share <= 1.0, "finish.good_enough_share", share, "above 0 and at most 1")?;
        self.planner.validate()?;
        self.selection.validate()?;
        Ok(self.detector_params().validate()?)
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
