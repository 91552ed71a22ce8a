//! What a recording lacked, when nothing could be decided or mapped.

use super::player::Player;
use super::robot::BagRobot;

impl Player {
    /// Why there is no map so far.
    #[must_use]
    pub fn why_no_map(&self) -> String {
        let inputs = self.inputs();
        let fault = |topic: &str| {
            let fault = self.faults().on(topic);
            fault.map(|fault| format!("; {} could not be used: {}", fault.messages, fault.first)).unwrap_or_default()
        };
        if let Some(mapping) = self.mapping() {
            let topic = inputs.scan_topic.as_deref().unwrap_or("none");
            let left_out: String = mapping.left_out().map(|left_out| format!("; {left_out}")).collect();
            return format!("no scan on {topic} could be taken into a map{left_out}{}", fault(topic));
        }
        let topic = inputs.map_topic.as_deref().unwrap_or("none");
        format!("no map came on {topic}{}", fault(topic))
    }
}

impl BagRobot {
    /// What was missing for a first decision, a sentence each: a map, or the robot's place.
    #[must_use]
    pub fn missing(&self) -> Vec<String> {
        let mut missing = Vec::new();
        if self.player().map().is_none() {
            missing.push(self.player().why_no_map());
        }
        if self.pose().is_none() {
            let why = self.no_pose().map_or_else(|| "it was never looked for".to_owned(), ToString::to_string);
            missing.push(format!("the robot's pose was never known: {why}"));
        }
        if missing.is_empty() {
            missing.push("a map and the robot's pose were never known at the same time".to_owned());
        }
        missing
    }
}
