//! Which clock the headers of a recording go by, beside the recorder's.
//!
//! A recorder on another computer, or one that does not go by simulated time, has a clock of
//! its own, which may also run at another speed. What counts for the robot's pose is how far
//! the transforms that lead to it are from the recorder's clock at the moment: that of the
//! last few, of which the one farthest behind is not believed alone.

use super::Inputs;
use super::guess::between;
use crate::bag::{MessageType, Summary};
use std::collections::{BTreeMap, VecDeque};

/// Clocks nearer than this are one: messages need their time too, seconds.
const SAME_S: f64 = 0.25;
/// Sources that are farther from each other than this have clocks of their own, seconds.
/// Below it, stamps are believed: a sensor or a network may be late.
const OWN_S: f64 = 5.0;
/// So many of the last transforms of a frame tell its clock.
const RECENT: usize = 15;

/// A frame on the way to the robot.
#[derive(Clone, Debug, PartialEq)]
struct Link {
    child: String,
    /// Header time minus record time of the last transforms, seconds.
    recent_s: VecDeque<f64>,
}

/// The headers' clock.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clock {
    chain: Vec<Link>,
    /// Header time minus record time, seconds; 0 where the two are one clock.
    offset_s: f64,
    /// How far the scans are from the transforms' clock, seconds; 0 where they go by it.
    scans_s: f64,
    /// How far transforms are from the clock of the chain, by child and parent.
    links_s: BTreeMap<(String, String), f64>,
    /// The median offset over the whole bag, seconds.
    whole_s: f64,
}

impl Clock {
    /// Finds the clocks of a bag.
    #[must_use]
    pub fn of(summary: &Summary, inputs: &Inputs) -> Self {
        let moving: Vec<_> = match (&inputs.map_frame, &inputs.base_frame) {
            (Some(map), Some(base)) => between(summary, map, base),
            _ => Vec::new(),
        }
        .into_iter()
        .filter_map(|child| Some((child, summary.tf.get(child)?)))
        .filter(|(_, link)| !link.is_static && link.skew.first_s().is_some())
        .collect();
        // The chain is as old as its oldest link: others may be stamped ahead of their time.
        let key = |s: Option<f64>| s.unwrap_or(0.0);
        let oldest = moving.iter().min_by(|(_, a), (_, b)| key(a.skew.median_s()).total_cmp(&key(b.skew.median_s())));
        let scans = inputs.scan_topic.as_ref().and_then(|name| summary.topics.iter().find(|t| t.topic == *name));
        let reference = match oldest {
            Some((_, link)) => Some(&link.skew),
            None => summary.topics_of(MessageType::Odometry).first().copied().or(scans).map(|topic| &topic.skew),
        };
        let Some(reference) = reference else { return Self::default() };
        let own = |s: Option<f64>| s.filter(|s| s.abs() > OWN_S);
        let links = summary.tf.iter().filter(|(_, link)| !link.is_static).filter_map(|(child, link)| {
            let own_s = own(link.skew.ahead_of_s(reference))?;
            Some(((child.clone(), link.parent.clone()), own_s))
        });
        let mut this = Self {
            chain: Vec::new(),
            offset_s: one_clock_if_near(key(reference.first_s())),
            scans_s: key(own(scans.and_then(|topic| topic.skew.ahead_of_s(reference)))),
            links_s: links.collect(),
            whole_s: one_clock_if_near(key(reference.median_s())),
        };
        for (child, link) in moving {
            let first_s = key(link.skew.first_s()) - this.link_s(&link.parent, child);
            this.chain.push(Link { child: child.to_owned(), recent_s: [first_s; RECENT].into() });
        }
        this.settle();
        this
    }

    /// Header time minus record time of the transforms to the robot by now, seconds.
    #[must_use]
    pub const fn offset_s(&self) -> f64 {
        self.offset_s
    }

    /// How far the scans are from that clock, seconds.
    #[must_use]
    pub const fn scans_s(&self) -> f64 {
        self.scans_s
    }

    /// How far the stamps of a transform are from that clock, seconds.
    #[must_use]
    pub fn link_s(&self, parent: &str, child: &str) -> f64 {
        if self.links_s.is_empty() {
            return 0.0;
        }
        self.links_s.get(&(child.to_owned(), parent.to_owned())).copied().unwrap_or(0.0)
    }

    /// Learns from a transform: header time, on the clock of the chain, minus record time.
    pub fn learn(&mut self, child: &str, difference_s: f64) {
        if let Some(link) = self.chain.iter_mut().find(|link| link.child == child) {
            link.recent_s.pop_front();
            link.recent_s.push_back(difference_s);
            self.settle();
        }
    }

    /// The oldest link's offset: the second lowest of its last ones.
    fn settle(&mut self) {
        let second_lowest = |link: &Link| {
            let mut recent_s: Vec<f64> = link.recent_s.iter().copied().collect();
            recent_s.sort_by(f64::total_cmp);
            recent_s.get(1).copied()
        };
        if let Some(offset_s) = self.chain.iter().filter_map(second_lowest).min_by(f64::total_cmp) {
            self.offset_s = one_clock_if_near(offset_s);
        }
    }

    /// What is worth telling about the clocks, a sentence each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let way = |s: f64| format!("{:.1} s {}", s.abs(), if s > 0.0 { "ahead of" } else { "behind" });
        let mut notes = Vec::new();
        if self.whole_s != 0.0 {
            notes.push(format!("transforms are stamped {} the recorder's clock", way(self.whole_s)));
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

fn one_clock_if_near(offset_s: f64) -> f64 {
    if offset_s.abs() > SAME_S { offset_s } else { 0.0 }
}
