//! Which clock the headers of a recording go by, beside the recorder's.
//!
//! A recorder on another computer, or one that plays with simulated time, has a clock of its
//! own. How far it is from that of the headers is the median over all messages of a source
//! ([`Skew`](crate::bag::Skew)): for the robot's pose, that of the transforms which lead to it.

use super::Inputs;
use super::guess::between;
use crate::bag::{MessageType, Summary};
use std::collections::BTreeMap;

/// Clocks nearer than this are one: messages need their time too, seconds.
const SAME_S: f64 = 0.25;
/// Sources that are farther from each other than this have clocks of their own, seconds.
/// Below it, stamps are believed: a sensor or a network may be late.
const OWN_S: f64 = 5.0;

/// The headers' clock.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clock {
    /// Header time minus record time of the transforms to the robot, seconds; 0 where the
    /// two are one clock.
    pub offset_s: f64,
    /// How far the scans are from that clock, seconds; 0 where they go by it.
    pub scans_s: f64,
    /// The same of transforms, by child and parent.
    links_s: BTreeMap<(String, String), f64>,
}

impl Clock {
    /// Finds the clocks of a bag.
    #[must_use]
    pub fn of(summary: &Summary, inputs: &Inputs) -> Self {
        let scans = inputs.scan_topic.as_ref().and_then(|name| summary.topics.iter().find(|t| t.topic == *name));
        let scans_s = scans.and_then(|topic| topic.skew.median_s());
        // The chain is as old as its oldest link: others may be stamped ahead of their time.
        let chain = match (&inputs.map_frame, &inputs.base_frame) {
            (Some(map), Some(base)) => between(summary, map, base),
            _ => Vec::new(),
        };
        let moving = chain.iter().filter_map(|child| summary.tf.get(*child)).filter(|link| !link.is_static);
        let oldest_s = moving.filter_map(|link| link.skew.median_s()).min_by(f64::total_cmp);
        let odometry = summary.topics_of(MessageType::Odometry);
        let or_else = || odometry.iter().find_map(|topic| topic.skew.median_s()).or(scans_s);
        let offset_s = oldest_s.or_else(or_else).filter(|offset_s| offset_s.abs() > SAME_S).unwrap_or(0.0);
        let own = |median_s: Option<f64>| median_s.map(|s| s - offset_s).filter(|s| s.abs() > OWN_S);
        let links_s = summary.tf.iter().filter(|(_, link)| !link.is_static).filter_map(|(child, link)| {
            own(link.skew.median_s()).map(|own_s| ((child.clone(), link.parent.clone()), own_s))
        });
        Self { offset_s, scans_s: own(scans_s).unwrap_or(0.0), links_s: links_s.collect() }
    }

    /// How far the stamps of a transform are from the headers' clock, seconds.
    #[must_use]
    pub fn link_s(&self, parent: &str, child: &str) -> f64 {
        if self.links_s.is_empty() {
            return 0.0;
        }
        self.links_s.get(&(child.to_owned(), parent.to_owned())).copied().unwrap_or(0.0)
    }

    /// What is worth telling about the clocks, a sentence each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let way = |s: f64| format!("{:.1} s {}", s.abs(), if s > 0.0 { "ahead of" } else { "behind" });
        let mut notes = Vec::new();
        if self.offset_s != 0.0 {
            notes.push(format!("transforms are stamped {} the recorder's clock", way(self.offset_s)));
        }
        if self.scans_s != 0.0 {
            notes.push(format!("scans are stamped {} the transforms, and moved to their clock", way(self.scans_s)));
        }
        for ((child, parent), own_s) in self.links_s.iter().take(5) {
            notes.push(format!("{child} in {parent} is stamped {} the rest, and moved to its clock", way(*own_s)));
        }
        notes
    }
}
