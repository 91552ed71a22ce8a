//! Messages of a recording that could not be used: how many of which topic, and why.

use std::collections::BTreeMap;

/// The most topics that are told apart.
const MAX_TOPICS: usize = 100;

/// What was wrong on a topic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fault {
    /// How many messages.
    pub messages: u64,
    /// What was wrong with the first of them.
    pub first: String,
}

/// The faults so far, by topic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults(BTreeMap<String, Fault>);

impl Faults {
    /// Counts a message.
    pub(super) fn count(&mut self, topic: &str, reason: impl std::fmt::Display) {
        if self.0.len() >= MAX_TOPICS && !self.0.contains_key(topic) {
            return;
        }
        let fault = self.0.entry(topic.to_owned()).or_default();
        if fault.messages == 0 {
            fault.first = reason.to_string();
        }
        fault.messages += 1;
    }

    /// What was wrong on a topic; `None` when nothing was.
    #[must_use]
    pub fn on(&self, topic: &str) -> Option<&Fault> {
        self.0.get(topic)
    }

    /// A sentence for each topic.
    pub fn sentences(&self) -> impl Iterator<Item = String> + '_ {
        self.0.iter().map(|(topic, Fault { messages, first })| {
            format!("{messages} messages on {topic} could not be used; the first: {first}")
        })
    }
}
