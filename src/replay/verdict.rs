//! What can be done with a bag: the one check behind `bag info`, `replay` and `map build`.

use super::Inputs;
use super::guess::{frames, is_connected, root};
use crate::bag::{MessageType, Summary, TopicSummary};
use crate::tf::frame_name;

/// What can be done, and with what; or what is missing, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// `frontier replay`.
    pub replay: Result<String, String>,
    /// `frontier map build`, and `frontier replay --map-from-scans`.
    pub map_build: Result<String, String>,
    /// The recording's goals, if it has any.
    goals: Option<String>,
}

impl Verdict {
    /// Checks a bag for what the inputs need.
    #[must_use]
    pub fn of(summary: &Summary, inputs: &Inputs) -> Self {
        let map_build = scans(summary, inputs);
        let replay = match &inputs.map_topic {
            Some(map) => with_map(summary, inputs, map).map_err(|missing| match &map_build {
                Ok(_) => format!("{missing}; its scans make a map with --map-from-scans"),
                Err(_) => missing,
            }),
            None if inputs.scan_topic.is_none() => Err("there is neither a map nor a scan".to_owned()),
            None => map_build.clone().map(|_| {
                let [scan, base, frame] = [&inputs.scan_topic, &inputs.base_frame, &inputs.map_frame].map(shown);
                format!("with a map made of the scans on {scan}, and the robot as {base} in {frame}")
            }),
        };
        Self { replay, map_build, goals: inputs.goal_topic.clone() }
    }

    /// A sentence each.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let told = |command: &str, outcome: &Result<String, String>| match outcome {
            Ok(how) => format!("{command}: yes, {how}"),
            Err(missing) => format!("{command}: no, {missing}"),
        };
        let mut says = vec![told("frontier replay", &self.replay), told("frontier map build", &self.map_build)];
        says.extend(self.goals.as_ref().map(|goals| format!("decisions are compared with the goals on {goals}")));
        says
    }
}

fn shown(name: &Option<String>) -> &str {
    name.as_deref().unwrap_or("none")
}

/// Whether the recorded map and the robot's place in it are there.
fn with_map(summary: &Summary, inputs: &Inputs, map: &str) -> Result<String, String> {
    readable(summary, map, MessageType::Map)?;
    let frame = shown(&inputs.map_frame);
    let Some(base) = &inputs.base_frame else { return Err(no_robot(summary, frame)) };
    leads(summary, frame, base, "the map", "the robot")?;
    let updates = if inputs.updates_topic.is_some() { " with its updates" } else { "" };
    Ok(format!("with the map on {map}{updates} and the robot as {base} in {frame}"))
}

/// Whether scans, odometry and the lidar's place on the robot are there.
fn scans(summary: &Summary, inputs: &Inputs) -> Result<String, String> {
    let Some(topic) = &inputs.scan_topic else { return Err("there are no scans".to_owned()) };
    let scans = readable(summary, topic, MessageType::Scan)?;
    if scans.is_some_and(|scans| scans.silent > 0 && scans.silent + scans.malformed >= scans.messages) {
        return Err(format!("no reading of any scan on {topic} tells a distance, or that nothing is there"));
    }
    let Some(base) = &inputs.base_frame else { return Err(no_robot(summary, "odom")) };
    let odom = shown(&inputs.odom_frame);
    leads(summary, odom, base, "odometry", "the robot")?;
    if odom == base {
        return Err(format!("tf tells no odometry: nothing is above {base}"));
    }
    let lidar = frame_name(scans.map_or("", |scans| &scans.frame));
    if lidar.is_empty() {
        return Err(format!("the scans on {topic} do not name their frame"));
    }
    leads(summary, base, lidar, "the robot", "the lidar").map_err(|missing| {
        format!(
            "{missing}; record /tf_static too (rosbag filter and split drop it), or play the bag beside `rosrun \
             tf2_ros static_transform_publisher X Y Z YAW PITCH ROLL {base} {lidar}` and record all of it anew"
        )
    })?;
    Ok(format!("with the scans on {topic} and {base}"))
}

/// The topic of an input, unless none of its messages can be understood.
fn readable<'a>(summary: &'a Summary, topic: &str, kind: MessageType) -> Result<Option<&'a TopicSummary>, String> {
    let found = summary.topics_of(kind).into_iter().find(|t| t.topic == topic);
    match found {
        Some(t) if t.messages > 0 && t.malformed >= t.messages => {
            let fault = t.first_fault.as_deref().unwrap_or("they are damaged");
            Err(format!("none of the {} messages on {topic} can be understood: {fault}", t.messages))
        }
        found => Ok(found),
    }
}

/// Whether tf leads from one frame to another, with the frame that is missing.
fn leads(summary: &Summary, a: &str, b: &str, a_is: &str, b_is: &str) -> Result<(), String> {
    if is_connected(summary, a, b) {
        return Ok(());
    }
    let known = frames(summary);
    let nothing = format!("nothing leads from {a_is} ({a}) to {b_is} ({b})");
    if let Some(name) = [a, b].into_iter().find(|name| !known.contains(name)) {
        return Err(format!("{name} is not in tf: {nothing}"));
    }
    let (root_a, root_b) = (root(summary, a), root(summary, b));
    Err(format!("tf does not connect the trees of {root_a} and {root_b}: {nothing}"))
}

fn no_robot(summary: &Summary, frame: &str) -> String {
    let known: Vec<&str> = frames(summary).into_iter().collect();
    if known.is_empty() {
        return "tf tells no odometry: the bag holds no transforms".to_owned();
    }
    let known = known.join(", ");
    format!("tf has nothing that leads from {frame} to a robot: it has {known}; --pose-frame names the robot's frame")
}

#[cfg(test)]
#[path = "verdict_tests.rs"]
mod tests;
