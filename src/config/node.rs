//! The node's parameters: what a launch file or `rosparam load` may set, checked and
//! laid over a preset.
//!
//! Beside the node's own names it knows those of explore_lite, so that its launch file
//! works with another `pkg` and `type`.

use super::found_live::{FoundLive, hinted};
use super::live::LiveNode;
use super::merge::merge;
use super::node_error::NodeParamsError;
use super::params::{ParamError, read_params};
use super::preset::Preset;
use crate::geometry::Polygon;
use crate::grid::Thresholds;
use crate::range::OutOfRange;
use crate::selection::{ExploreLiteConfig, SelectorConfig};
use serde::Deserialize;
use serde_json::{Map, Value};

/// Who makes the robot look round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnBy {
    /// Velocity commands of our own.
    #[default]
    CmdVel,
    /// Goals of move_base at the robot's own place, a third of a turn apart.
    MoveBase,
}

/// The node's parameters as they come, with their defaults.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NodeParams {
    /// The preset: a built-in name, or a YAML file. `tour` when absent, and
    /// `explore_lite` when one of explore_lite's weights is set.
    pub config: Option<String>,
    /// The robot: a built-in name, or a YAML file.
    pub robot: String,
    /// What reports call the settings, as `rosparam load` of a preset sets it.
    pub preset: Option<String>,
    /// Laid over the preset's `explorer`.
    pub explorer: Option<Value>,
    /// Laid over the preset's `navigation`.
    pub navigation: Option<Value>,
    /// The topic of the map.
    pub map_topic: String,
    /// The topic of its updates.
    pub map_updates_topic: String,
    /// The topic of a global costmap to plan on; our own inflation when empty.
    pub global_costmap_topic: String,
    /// Where the server publishes its global costmap, goals keep away from what that says
    /// is no place to stand.
    pub believe_costmap: bool,
    /// The robot's frame.
    pub base_frame: String,
    /// How old the robot's transform may be, seconds.
    pub transform_tolerance: f64,
    /// Observations a second.
    pub tick_rate: f64,
    /// The action server that drives.
    pub move_base: String,
    /// Ask the server's `make_plan` whether there is a way, where it can be asked.
    pub check_with_make_plan: bool,
    /// Call the server's `clear_costmaps` when a goal failed.
    pub clear_costmaps: bool,
    /// Who makes the robot look round.
    pub turn_by: TurnBy,
    /// Velocity commands of our own get the robot away from what stands too near, guarded
    /// by the scan, when goals fail from one place again and again.
    pub back_off: bool,
    /// Corners `[x, y]` in metres of the map frame: the robot explores and keeps to the inside.
    pub region: Option<Vec<[f64; 2]>>,
    /// Areas that the robot keeps out of, each by its corners.
    pub no_go: Option<Vec<Vec<[f64; 2]>>>,
    /// Explore at once; where not, `~start` or a goal of the action begins.
    pub autostart: bool,
    /// How long goals of others, such as those clicked in RViz, are left to their end, seconds.
    pub yield_to_others: f64,
    /// Where the map is saved at the end, as map_saver's `-f`; not at all when empty.
    pub map_file: String,
    /// Where the session is kept, a JSON file: what is needed to go on after a crash; not at all
    /// when empty. Its map lies beside it.
    pub session_file: String,
    /// From one time that the session is written to the next, seconds of real time.
    pub session_period: f64,
    /// Go on from this session, where its file is there.
    pub resume_from: String,
    /// Leave when the exploration has ended.
    pub exit_when_done: bool,
    /// Publish markers for RViz.
    pub visualize: bool,
    /// explore_lite's name of `base_frame`.
    pub robot_base_frame: Option<String>,
    /// explore_lite's name of `map_topic`.
    pub costmap_topic: Option<String>,
    /// explore_lite's name of `map_updates_topic`.
    pub costmap_updates_topic: Option<String>,
    /// explore_lite: decisions a second on the way to a goal.
    pub planner_frequency: Option<f64>,
    /// explore_lite: seconds without progress after which a goal is given up.
    pub progress_timeout: Option<f64>,
    /// explore_lite: weight of the distance.
    pub potential_scale: Option<f64>,
    /// explore_lite: weight of the turn.
    pub orientation_scale: Option<f64>,
    /// explore_lite: weight of the size.
    pub gain_scale: Option<f64>,
    /// explore_lite: smaller frontiers are dropped, metres.
    pub min_frontier_size: Option<f64>,
    /// explore_lite (ROS 2): drive back to the start at the end.
    pub return_to_init: Option<bool>,
    /// Those that may change while the node runs, as they were found.
    #[serde(skip)]
    pub live: FoundLive,
}

/// The live parameters of a preset that explore_lite has too.
const EXPLORE_LITE: [&str; 4] = ["progress_timeout", "potential_scale", "orientation_scale", "gain_scale"];

impl Default for NodeParams {
    fn default() -> Self {
        Self {
            config: None,
            robot: "turtlebot2".to_owned(),
            preset: None,
            explorer: None,
            navigation: None,
            map_topic: "map".to_owned(),
            map_updates_topic: "map_updates".to_owned(),
            global_costmap_topic: String::new(),
            believe_costmap: true,
            base_frame: "base_link".to_owned(),
            transform_tolerance: 0.5,
            tick_rate: 5.0,
            move_base: "move_base".to_owned(),
            check_with_make_plan: false,
            clear_costmaps: true,
            turn_by: TurnBy::default(),
            back_off: true,
            region: None,
            no_go: None,
            autostart: true,
            yield_to_others: 300.0,
            map_file: String::new(),
            session_file: String::new(),
            session_period: 30.0,
            resume_from: String::new(),
            exit_when_done: false,
            visualize: true,
            robot_base_frame: None,
            costmap_topic: None,
            costmap_updates_topic: None,
            planner_frequency: None,
            progress_timeout: None,
            potential_scale: None,
            orientation_scale: None,
            gain_scale: None,
            min_frontier_size: None,
            return_to_init: None,
            live: FoundLive::default(),
        }
    }
}

impl NodeParams {
    /// Reads a tree of parameters. explore_lite's names of topics and frames take the
    /// place of ours; `region` and `no_go` may be empty for those of the preset.
    ///
    /// # Errors
    /// [`NodeParamsError`] with the parameter, its value and what is allowed.
    pub fn from_tree(mut tree: Value) -> Result<Self, NodeParamsError> {
        let live = FoundLive::take(&mut tree, Self::is_own);
        let mut params = Self { live, ..read_params(tree).map_err(hinted)? };
        let replace = |ours: &mut String, theirs: &mut Option<String>| {
            if let Some(name) = theirs.take() {
                *ours = name;
            }
        };
        replace(&mut params.base_frame, &mut params.robot_base_frame);
        replace(&mut params.map_topic, &mut params.costmap_topic);
        replace(&mut params.map_updates_topic, &mut params.costmap_updates_topic);
        params.region = params.region.filter(|corners| !corners.is_empty());
        params.no_go = params.no_go.filter(|areas| !areas.is_empty());
        params.validate()?;
        Ok(params)
    }

    /// Whether a live parameter has a field here.
    fn is_own(name: &str) -> bool {
        EXPLORE_LITE.contains(&name) || LiveNode::NAMES.contains(&name)
    }

    /// What of the node itself may change while it runs.
    #[must_use]
    pub const fn live_node(&self) -> LiveNode {
        let &Self { transform_tolerance, yield_to_others, clear_costmaps, visualize, exit_when_done, .. } = self;
        LiveNode { transform_tolerance, yield_to_others, clear_costmaps, visualize, exit_when_done }
    }

    fn validate(&self) -> Result<(), NodeParamsError> {
        OutOfRange::unless_positive("transform_tolerance", self.transform_tolerance)?;
        let rate = self.tick_rate;
        OutOfRange::unless((0.1..=50.0).contains(&rate), "tick_rate", rate, "within 0.1 to 50 observations a second")?;
        let frequency = self.planner_frequency.unwrap_or(1.0);
        OutOfRange::unless_not_negative("planner_frequency", frequency)?;
        OutOfRange::unless_not_negative("yield_to_others", self.yield_to_others)?;
        let period = self.session_period;
        OutOfRange::unless((0.1..=3600.0).contains(&period), "session_period", period, "within 0.1 to 3600 s")?;
        OutOfRange::unless_positive("progress_timeout", self.progress_timeout.unwrap_or(1.0))?;
        for (name, text) in
            [("map_topic", &self.map_topic), ("base_frame", &self.base_frame), ("move_base", &self.move_base)]
        {
            if text.is_empty() {
                let message = "is empty: must be a name".to_owned();
                return Err(ParamError { path: name.to_owned(), message }.into());
            }
        }
        Ok(())
    }

    /// The name or the file of the preset that the other parameters are laid over.
    #[must_use]
    pub fn base_preset(&self) -> &str {
        let weighed = [self.potential_scale, self.orientation_scale, self.gain_scale, self.min_frontier_size];
        let default = if weighed.iter().any(Option::is_some) { "explore_lite" } else { Preset::DEFAULT };
        self.config.as_deref().unwrap_or(default)
    }

    /// The settings that the parameters make of a preset.
    ///
    /// # Errors
    /// [`NodeParamsError`] with the parameter, its value and what is allowed.
    pub fn apply_to(&self, base: Preset) -> Result<Preset, NodeParamsError> {
        let mut tree =
            serde_json::to_value(base).map_err(|e| ParamError { path: "config".to_owned(), message: e.to_string() })?;
        let mut over = Map::new();
        let parts = [("explorer", &self.explorer), ("navigation", &self.navigation)];
        over.extend(parts.into_iter().filter_map(|(name, part)| Some((name.to_owned(), part.clone()?))));
        if let Some(name) = &self.preset {
            over.insert("preset".to_owned(), Value::String(name.clone()));
        }
        merge(&mut tree, Value::Object(over));
        let mut preset: Preset = read_params(tree)?;
        self.set_explore_lite(&mut preset);
        if self.map_topic.ends_with("costmap") {
            // A published costmap: 100 is an obstacle, and what is below was inflated
            // around it; the frontiers' map is what lies beneath.
            preset.explorer.thresholds = Thresholds { free_max: 99, occupied_min: 100 };
        }
        if let Some(corners) = &self.region {
            let region = Polygon::try_from(corners.clone()).map_err(|e| NodeParamsError::Region(e.to_string()))?;
            preset.explorer.region = Some(region);
        }
        if let Some(areas) = &self.no_go {
            let area = |(index, corners): (usize, &Vec<[f64; 2]>)| {
                Polygon::try_from(corners.clone()).map_err(|e| NodeParamsError::NoGo { index, why: e.to_string() })
            };
            preset.explorer.no_go = areas.iter().enumerate().map(area).collect::<Result<_, _>>()?;
        }
        let preset: Preset = self.live.lay_over::<NodeParamsError>(preset, Self::is_own)?;
        preset.validate()?;
        Ok(preset)
    }

    fn set_explore_lite(&self, preset: &mut Preset) {
        let explorer = &mut preset.explorer;
        if let SelectorConfig::ExploreLite(weights) = &mut explorer.selection {
            let ExploreLiteConfig { potential_scale, orientation_scale, gain_scale } = weights;
            for (ours, theirs) in [
                (potential_scale, self.potential_scale),
                (orientation_scale, self.orientation_scale),
                (gain_scale, self.gain_scale),
            ] {
                *ours = theirs.unwrap_or(*ours);
            }
        }
        if let Some(min_size_m) = self.min_frontier_size {
            explorer.detector.min_size_m = min_size_m;
        }
        if let Some(timeout_s) = self.progress_timeout {
            explorer.patience.progress_timeout_s = timeout_s;
        }
        if let Some(frequency) = self.planner_frequency.filter(|&f| f > 0.0) {
            explorer.goal.reconsider_period_s = Some(1.0 / frequency);
        }
        explorer.return_to_start = self.return_to_init.unwrap_or(explorer.return_to_start);
    }
}

#[cfg(test)]
#[path = "node_tests.rs"]
mod tests;
