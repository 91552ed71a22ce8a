//! What a message of a recording tells, if it is one of the explorer's inputs.

use super::Inputs;
use crate::bag::{
    Connection, GoalMessage, Malformed, MapMessage, MessageType, PatchMessage, ResultMessage, ScanMessage, goal, map,
    patch, pose, result, scan, transforms,
};
use crate::tf::TransformSample;

/// An input, decoded.
pub enum Told {
    Transforms { samples: Vec<TransformSample>, is_static: bool },
    Map(MapMessage),
    Patch(PatchMessage),
    Scan(ScanMessage),
    Goal(GoalMessage),
    Result(ResultMessage),
}

impl Told {
    /// What a message tells; `None` when it is no input.
    pub fn of(inputs: &Inputs, connection: &Connection, data: &[u8]) -> Option<Result<Self, Malformed>> {
        let kind = MessageType::of(&connection.kind, &connection.md5)?;
        let is = |topic: &Option<String>| topic.as_ref() == Some(&connection.topic);
        Some(match kind {
            MessageType::Transforms => {
                let is_static = connection.topic.ends_with("tf_static");
                transforms(data).map(|samples| Self::Transforms { samples, is_static })
            }
            MessageType::Map if is(&inputs.map_topic) => map(data).map(Self::Map),
            MessageType::MapUpdate if is(&inputs.updates_topic) => patch(data).map(Self::Patch),
            MessageType::Scan if is(&inputs.scan_topic) => scan(data).map(Self::Scan),
            MessageType::Goal if is(&inputs.goal_topic) => goal(data).map(Self::Goal),
            MessageType::Pose if is(&inputs.goal_topic) => {
                pose(data).map(|target| Self::Goal(GoalMessage { id: String::new(), target }))
            }
            MessageType::Result if is(&inputs.results_topic) => result(data).map(Self::Result),
            _ => return None,
        })
    }
}
