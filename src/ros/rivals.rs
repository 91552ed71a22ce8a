//! Who else explores with the same robot: two explorers would take each other's goals away for
//! ever, so that the second one leaves. Other clients of move_base are told of, and no more.

use super::directory::{Listing, list};
use super::feed::Feed;
use super::msg::frontier_explorer::ExplorationStatus;
use super::node::Node;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// So long the master is waited for; one that is silent knows nobody.
const MASTER_WITHIN: Duration = Duration::from_secs(2);
/// An explorer tells its status once a second: one that is silent for so long is dead, and the
/// master has not noticed.
const ALIVE_WITHIN: Duration = Duration::from_millis(2500);
/// The type by which explorers are known.
const STATUS: &str = "frontier_explorer/ExplorationStatus";

/// Why this node leaves the robot to another one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the explorer {name} is there already ({what}) and drives the same robot by {topic}: stop it first, or start this \
     one in the namespace of another robot"
)]
pub struct RivalError {
    name: String,
    what: String,
    topic: String,
}

/// The explorers of one robot, as they were when this was made.
pub struct Rivals<'a> {
    node: &'a Node,
    /// The topics that drive the robot.
    topics: [String; 2],
    before: BTreeSet<String>,
}

impl<'a> Rivals<'a> {
    /// Looks who else sends goals on a topic, or velocities on `cmd_vel`.
    pub fn of(node: &'a Node, goals: &str) -> Self {
        let topics = [node.full_name(goals), node.full_name("cmd_vel")];
        let mut rivals = Self { node, topics, before: BTreeSet::new() };
        rivals.before = rivals.look().into_iter().map(|rival| rival.name).collect();
        rivals
    }

    /// Refuses to go on if any of them lives.
    ///
    /// # Errors
    /// [`RivalError`] with its name and what it is about.
    pub fn refuse_all(&self) -> Result<(), RivalError> {
        self.refuse(|_| true)
    }

    /// Refuses to go on if one came while this node connected: of two that come at the same
    /// time the one leaves whose name comes later.
    ///
    /// # Errors
    /// [`RivalError`] with its name and what it is about.
    pub fn refuse_those_who_came_since(&self) -> Result<(), RivalError> {
        let own = self.node.name().to_owned();
        self.refuse(|name| !self.before.contains(name) && *name < own)
    }

    fn refuse(&self, is_first: impl Fn(&String) -> bool) -> Result<(), RivalError> {
        for rival in self.look().into_iter().filter(|rival| is_first(&rival.name)) {
            if let Some(what) = self.status_of(&rival) {
                return Err(RivalError { name: rival.name, what, topic: rival.topic });
            }
            let name = &rival.name;
            self.node.log().warn(format_args!("the explorer {name} is registered and says nothing: taken for dead"));
        }
        Ok(())
    }

    fn look(&self) -> Vec<Rival> {
        let mut listing = None;
        self.node.wait_until(MASTER_WITHIN, || {
            // An answer of before this question does not count.
            listing = self.node.listing(Duration::from_millis(500)).filter(|l| l.age() < Duration::from_millis(500));
            listing.is_some()
        });
        let Some(listing) = listing else { return Vec::new() };
        let (found, clients) = find(&listing, &self.topics, self.node.name());
        if !clients.is_empty() {
            let (goals, clients) = (&self.topics[0], list(&clients));
            self.node.log().once(super::log::Level::Info, format_args!("{clients} can send goals on {goals}, too"));
        }
        found
    }

    /// What a rival is about, if it lives.
    fn status_of(&self, rival: &Rival) -> Option<String> {
        let heard = Arc::<Mutex<Option<ExplorationStatus>>>::default();
        let theirs = Arc::clone(&heard);
        let _feed = Feed::listen_seldom(self.node, &rival.status_topic, 1, ALIVE_WITHIN, move |status, _| {
            *theirs.lock().unwrap_or_else(PoisonError::into_inner) = Some(status);
        });
        let is_heard = || heard.lock().unwrap_or_else(PoisonError::into_inner).is_some();
        self.node.wait_until(ALIVE_WITHIN, is_heard);
        let status = heard.lock().unwrap_or_else(PoisonError::into_inner).take()?;
        Some(format!("preset {}: {}", status.preset, status.message))
    }
}

/// An explorer that drives the same robot.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Rival {
    name: String,
    status_topic: String,
    /// What it drives the robot by.
    topic: String,
}

/// The explorers that publish on one of the topics, and the other clients of the first one.
fn find(listing: &Listing, topics: &[String; 2], own: &str) -> (Vec<Rival>, BTreeSet<String>) {
    let mut rivals: Vec<Rival> = Vec::new();
    for (status_topic, names) in listing.published(STATUS) {
        for name in names.iter().filter(|name| *name != own) {
            let is_new = rivals.iter().all(|rival| rival.name != *name);
            if let (Some(topic), true) = (topics.iter().find(|topic| listing.publishers(topic).contains(name)), is_new)
            {
                let (status_topic, topic) = (status_topic.to_owned(), topic.clone());
                rivals.push(Rival { name: name.clone(), status_topic, topic });
            }
        }
    }
    let servers = listing.subscribers(&topics[0]);
    let is_other = |name: &String| name != own && !servers.contains(name) && rivals.iter().all(|r| r.name != *name);
    let clients = listing.publishers(&topics[0]).into_iter().filter(is_other).collect();
    (rivals, clients)
}
