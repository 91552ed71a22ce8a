//! What was asked, and what was seen: the facts that findings are made of.

use super::costmap_params::CostmapParams;
use crate::robot::PoseError;
use crate::ros::frames::ToldLink;
use std::collections::BTreeSet;

/// What to look at. All names but those of frames are full ones.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// The node that is to explore.
    pub node: String,
    /// The topic of the map.
    pub map_topic: String,
    /// The robot's frame.
    pub base_frame: String,
    /// How old the robot's transform may be, seconds.
    pub tolerance_s: f64,
    /// The action server that drives; none where we drive ourselves.
    pub move_base: Option<String>,
    /// Whether the costs of the server's global costmap take the place of our own.
    pub plans_on_costmap: bool,
    /// The topic of the scans, where they are needed.
    pub scan_topic: Option<String>,
    /// The outline of our robot.
    pub outline: OwnOutline,
}

/// The outline of the robot that the explorer believes in, metres.
#[derive(Clone, Debug)]
pub struct OwnOutline {
    /// What the robot is called.
    pub robot: String,
    /// Radius of the largest disc inside.
    pub inscribed_m: f64,
    /// Radius of the smallest disc around it.
    pub circumscribed_m: f64,
}

/// All that was seen.
#[derive(Clone, Debug)]
pub struct Facts {
    pub clock: ClockFacts,
    pub map: MapFacts,
    pub frames: FrameFacts,
    /// None where no server is wanted.
    pub server: Option<ServerFacts>,
    /// None where no server is wanted.
    pub costmap: Option<CostmapFacts>,
    pub drivers: DriverFacts,
    /// None where no scans are wanted.
    pub scans: Option<ScanFacts>,
}

/// ROS time over some seconds of real time.
#[derive(Clone, Debug, Default)]
pub struct ClockFacts {
    /// Whether `/use_sim_time` is set.
    pub is_simulated: bool,
    /// Who publishes `/clock`.
    pub publishers: BTreeSet<String>,
    /// ROS time at the end, seconds; 0 is none.
    pub now_s: f64,
    /// For how long it has stood then, seconds of real time.
    pub stands_s: f64,
    /// ROS seconds a real second.
    pub pace: f64,
}

impl ClockFacts {
    /// Whether times can be compared with it.
    #[must_use]
    pub fn goes(&self) -> bool {
        self.now_s > 0.0 && self.stands_s < STANDS_FROM_S
    }
}

/// A clock that has not moved for so long stands, seconds.
pub const STANDS_FROM_S: f64 = 2.0;

/// A topic as the master knows it.
#[derive(Clone, Debug, Default)]
pub struct TopicFacts {
    /// Its full name.
    pub topic: String,
    /// Its type, where the master knows one.
    pub kind: Option<String>,
    /// Who publishes it.
    pub publishers: BTreeSet<String>,
    /// The topics of the type that is wanted, with who publishes them.
    pub others: Vec<(String, BTreeSet<String>)>,
    /// For how long it was listened to, seconds.
    pub listened_s: f64,
}

impl TopicFacts {
    /// The names of the topics of the right type.
    pub fn other_names(&self) -> impl Iterator<Item = &str> {
        self.others.iter().map(|(topic, _)| topic.as_str())
    }
}

/// What came of the map.
#[derive(Clone, Debug, Default)]
pub struct MapFacts {
    pub topic: TopicFacts,
    /// The newest map.
    pub newest: Option<MapSeen>,
    /// Why the last message was no map.
    pub broken: Option<String>,
    /// Seconds from one map to the next, where more than one came.
    pub period_s: Option<f64>,
}

/// A map, in numbers.
#[derive(Clone, Debug, Default)]
pub struct MapSeen {
    pub width: usize,
    pub height: usize,
    pub resolution_m: f64,
    pub free: usize,
    pub unknown: usize,
}

/// The way from the map's frame to the robot's.
#[derive(Clone, Debug)]
pub struct FrameFacts {
    pub map_frame: String,
    pub base_frame: String,
    /// The frames that there are.
    pub known: Vec<String>,
    /// The moving links between the two, or what is missing.
    pub links: Result<Vec<ToldLink>, String>,
    /// Whether what is told can be believed now; none without a time to judge it by.
    pub pose: Option<Result<(), PoseError>>,
    /// Who publishes `/tf`.
    pub publishers: BTreeSet<String>,
}

/// An action server by its topics.
#[derive(Clone, Debug, Default)]
pub struct ServerFacts {
    /// Its full name.
    pub name: String,
    /// For each of its topics who serves it: hears goals and cancellations, publishes the rest.
    pub served: Vec<(&'static str, BTreeSet<String>)>,
    /// Whether it told its status.
    pub has_told: bool,
    /// The ids of goals under way.
    pub under_way: Vec<String>,
    /// The servers of this kind that there are.
    pub others: Vec<String>,
    /// What `make_plan` said.
    pub make_plan: PlanAnswer,
}

impl ServerFacts {
    /// The nodes that serve all topics.
    #[must_use]
    pub fn whole(&self) -> BTreeSet<String> {
        let mut nodes = self.served.iter().map(|(_, nodes)| nodes.clone());
        let first = nodes.next().unwrap_or_default();
        nodes.fold(first, |all, nodes| all.intersection(&nodes).cloned().collect())
    }
}

/// An answer of `make_plan` to a request for the way to the robot's own place.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PlanAnswer {
    /// It was not asked, with the reason.
    #[default]
    NotAsked,
    /// A goal is under way, and it answers to nobody.
    Busy,
    /// So many poses.
    Plan(usize),
    /// The service is not there.
    Absent,
    /// It did not answer, or said no.
    Failed(String),
}

/// The global costmap of the action server.
#[derive(Clone, Debug, Default)]
pub struct CostmapFacts {
    pub topic: TopicFacts,
    /// Whether one came.
    pub has_come: bool,
    /// The share of unknown cells of the map that it does not show, where it shows none.
    pub hidden_unknown: Option<f64>,
    /// What the server's parameters say.
    pub params: CostmapParams,
}

/// Who sends goals and who explores.
#[derive(Clone, Debug, Default)]
pub struct DriverFacts {
    /// Nodes of ours.
    pub explorers: BTreeSet<String>,
    /// Nodes that show frontiers as explore_lite does.
    pub explore_lite: BTreeSet<String>,
    /// Who publishes goals for the server, without the server itself.
    pub goal_clients: BTreeSet<String>,
    /// Who publishes `cmd_vel` of the node's namespace, without the server.
    pub velocity_clients: BTreeSet<String>,
}

/// What came of the scans.
#[derive(Clone, Debug, Default)]
pub struct ScanFacts {
    pub topic: TopicFacts,
    /// What is wrong with the last one, where it shows nothing; none when none came.
    pub last: Option<Result<(), String>>,
}
