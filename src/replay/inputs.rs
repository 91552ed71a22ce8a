//! Which topics and frames of a bag are the explorer's inputs: as the user says, and else
//! as their types and names tell.

use super::guess::{base_frame, best, frames, is_connected, map_frame, map_rank, odom_frame, odometry_root, root};
use crate::bag::{MessageType, Summary};
use crate::tf::frame_name;
use serde::Serialize;
use std::collections::BTreeSet;

/// What the user says; the rest is guessed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The topic of the map.
    pub map_topic: Option<String>,
    /// The topic of the scans.
    pub scan_topic: Option<String>,
    /// The map's frame.
    pub map_frame: Option<String>,
    /// The robot's frame.
    pub pose_frame: Option<String>,
}

/// A topic or a frame that a bag does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InputError {
    /// No such topic.
    #[error("the bag has no {kind} on {topic}: it has {known}")]
    NoTopic {
        /// As given.
        topic: String,
        /// The type that is needed.
        kind: &'static str,
        /// The topics of that type.
        known: String,
    },
    /// No such frame.
    #[error("tf in the bag has no frame {frame}: it has {known}")]
    NoFrame {
        /// As given.
        frame: String,
        /// All frames.
        known: String,
    },
}

/// The explorer's inputs in a bag.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Inputs {
    /// `nav_msgs/OccupancyGrid`.
    pub map_topic: Option<String>,
    /// `map_msgs/OccupancyGridUpdate`, beside the map.
    pub updates_topic: Option<String>,
    /// `sensor_msgs/LaserScan`.
    pub scan_topic: Option<String>,
    /// `move_base_msgs/MoveBaseActionGoal` or `geometry_msgs/PoseStamped`: what the
    /// recording was sent to.
    pub goal_topic: Option<String>,
    /// `move_base_msgs/MoveBaseActionResult`, beside the goals: how they ended.
    pub results_topic: Option<String>,
    /// The map's frame; without a map, the one that odometry is in.
    pub map_frame: Option<String>,
    /// The robot's frame, be it below the map's or not.
    pub base_frame: Option<String>,
    /// The frame that the wheels' odometry is in: `odom` above the robot, or the map's, or
    /// the top of the robot's tree.
    pub odom_frame: Option<String>,
}

impl Inputs {
    /// Finds the inputs of a bag.
    ///
    /// # Errors
    /// [`InputError`] when the bag does not have what the user says.
    pub fn of(summary: &Summary, wanted: &Wanted) -> Result<Self, InputError> {
        let frames = frames(summary);
        let map_topic = match &wanted.map_topic {
            Some(topic) => Some(given(summary, topic, MessageType::Map)?),
            None => best(summary, MessageType::Map, map_rank),
        };
        let updates = map_topic.as_ref().map(|topic| format!("{topic}_updates"));
        let updates_topic = updates.filter(|name| has(summary, name, MessageType::MapUpdate));
        let scan_topic = match &wanted.scan_topic {
            Some(topic) => Some(given(summary, topic, MessageType::Scan)?),
            None => best(summary, MessageType::Scan, |_| Some(0)),
        };
        let goal_topic = best(summary, MessageType::Goal, |_| Some(0))
            .or_else(|| best(summary, MessageType::Pose, |name| name.ends_with("goal").then_some(0)));
        let results = goal_topic.as_deref().and_then(|goals| goals.strip_suffix("/goal"));
        let results_topic =
            results.map(|server| format!("{server}/result")).filter(|name| has(summary, name, MessageType::Result));
        let map_frame = match &wanted.map_frame {
            Some(frame) => Some(known(&frames, frame)?),
            None => map_frame(summary, map_topic.as_deref()),
        };
        let base_frame = match &wanted.pose_frame {
            Some(frame) => Some(known(&frames, frame)?),
            // A map that nobody localised in leaves the robot to odometry.
            None => [map_frame.as_deref(), odometry_root(summary)]
                .into_iter()
                .flatten()
                .find_map(|top| base_frame(summary, top)),
        };
        let odom_frame = match (&base_frame, &map_frame) {
            (Some(base), map) => odom_frame(summary, base)
                .or_else(|| map.clone().filter(|map| is_connected(summary, map, base)))
                .or_else(|| Some(root(summary, base).to_owned())),
            (None, map) => map.clone(),
        };
        Ok(Self { map_topic, updates_topic, scan_topic, goal_topic, results_topic, map_frame, base_frame, odom_frame })
    }

    /// Leaves the recorded map out: one is made of the scans, in the frame of odometry.
    pub fn forget_map(&mut self) {
        (self.map_topic, self.updates_topic) = (None, None);
        self.map_frame.clone_from(&self.odom_frame);
    }
}

fn known(frames: &BTreeSet<&str>, frame: &str) -> Result<String, InputError> {
    let name = frame_name(frame);
    if frames.contains(name) {
        return Ok(name.to_owned());
    }
    Err(InputError::NoFrame { frame: frame.to_owned(), known: list(frames.iter().copied()) })
}

fn has(summary: &Summary, topic: &str, kind: MessageType) -> bool {
    summary.topics_of(kind).iter().any(|t| t.topic == topic)
}

fn given(summary: &Summary, topic: &str, kind: MessageType) -> Result<String, InputError> {
    let topics = summary.topics_of(kind);
    let is_it = |name: &str| name == topic || name.trim_start_matches('/') == topic.trim_start_matches('/');
    topics.iter().find(|t| is_it(&t.topic)).map(|t| t.topic.clone()).ok_or_else(|| InputError::NoTopic {
        topic: topic.to_owned(),
        kind: kind.name(),
        known: list(topics.iter().map(|t| t.topic.as_str())),
    })
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bag::{FrameLink, TopicSummary};
    use crate::replay::Verdict;

    fn summary() -> Summary {
        let topic = |topic: &str, kind: MessageType, messages: u64, frame: &str| TopicSummary {
            topic: topic.to_owned(),
            kind: kind.name().to_owned(),
            md5: kind.md5().to_owned(),
            messages,
            frames: [frame.to_owned()].into(),
            frame: frame.to_owned(),
            ..TopicSummary::default()
        };
        let link = |parent: &str, is_static| FrameLink {
            parent: parent.to_owned(),
            is_static,
            messages: 10,
            ..FrameLink::default()
        };
        Summary {
            topics: vec![
                topic("/move_base/global_costmap/costmap", MessageType::Map, 99, "map"),
                topic("/robot/map", MessageType::Map, 5, "/world"),
                topic("/robot/map_updates", MessageType::MapUpdate, 50, "/world"),
                topic("/robot/scan", MessageType::Scan, 500, "laser"),
                topic("/robot/move_base/goal", MessageType::Goal, 5, ""),
                topic("/robot/move_base/result", MessageType::Result, 5, ""),
            ],
            tf: [
                ("odom".to_owned(), link("world", false)),
                ("robot/base_link".to_owned(), link("odom", false)),
                ("laser".to_owned(), link("robot/base_link", true)),
            ]
            .into(),
            ..Summary::default()
        }
    }

    #[test]
    fn inputs_are_guessed_by_type_and_name() {
        let inputs = Inputs::of(&summary(), &Wanted::default()).unwrap();
        let expected = Inputs {
            map_topic: Some("/robot/map".into()),
            updates_topic: Some("/robot/map_updates".into()),
            scan_topic: Some("/robot/scan".into()),
            goal_topic: Some("/robot/move_base/goal".into()),
            results_topic: Some("/robot/move_base/result".into()),
            map_frame: Some("world".into()),
            base_frame: Some("robot/base_link".into()),
            odom_frame: Some("odom".into()),
        };
        assert_eq!(inputs, expected);
        assert!(Verdict::of(&summary(), &inputs).sentences()[0].starts_with("frontier replay: yes"));
    }

    #[test]
    fn what_is_given_must_be_there() {
        let wanted = Wanted { map_topic: Some("/map".into()), ..Wanted::default() };
        let error = Inputs::of(&summary(), &wanted).unwrap_err().to_string();
        assert!(error.starts_with("the bag has no nav_msgs/OccupancyGrid on /map: it has "), "{error}");
        let wanted = Wanted { pose_frame: Some("base".into()), ..Wanted::default() };
        let error = Inputs::of(&summary(), &wanted).unwrap_err().to_string();
        assert_eq!(error, "tf in the bag has no frame base: it has laser, odom, robot/base_link, world");
    }

    #[test]
    fn without_a_map_odometry_is_the_frame() {
        let mut scans = summary();
        scans.topics.retain(|t| t.topic.ends_with("scan"));
        let inputs = Inputs::of(&scans, &Wanted::default()).unwrap();
        assert_eq!((inputs.map_frame.as_deref(), inputs.map_topic.is_none()), (Some("odom"), true));
        assert!(Verdict::of(&scans, &inputs).sentences()[1].starts_with("frontier map build: yes"));
    }
}
