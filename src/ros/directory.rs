//! What the master knows of topics and services: who publishes, hears and offers them. Asked
//! on a thread of its own, one question at a time, so that a master that hangs keeps nobody
//! waiting.

use rosrust::api::Ros;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Names of nodes by topic.
type Nodes = BTreeMap<String, BTreeSet<String>>;

/// One answer of the master.
#[derive(Clone, Debug)]
pub(super) struct Listing {
    publishers: Nodes,
    subscribers: Nodes,
    services: Nodes,
    types: BTreeMap<String, String>,
    taken: Instant,
}

impl Listing {
    /// The nodes that publish a topic, by its full name.
    pub fn publishers(&self, topic: &str) -> BTreeSet<String> {
        self.publishers.get(topic).cloned().unwrap_or_default()
    }

    /// The nodes that hear a topic, by its full name.
    pub fn subscribers(&self, topic: &str) -> BTreeSet<String> {
        self.subscribers.get(topic).cloned().unwrap_or_default()
    }

    /// The nodes that offer a service, by its full name.
    pub fn servers(&self, service: &str) -> BTreeSet<String> {
        self.services.get(service).cloned().unwrap_or_default()
    }

    /// The type of a topic, such as `nav_msgs/OccupancyGrid`.
    pub fn type_of(&self, topic: &str) -> Option<&str> {
        self.types.get(topic).map(String::as_str)
    }

    /// The topics of a type that somebody publishes, with those who do.
    pub fn published<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = (&'a str, &'a BTreeSet<String>)> {
        self.of_type(&self.publishers, kind)
    }

    /// The topics of a type that somebody hears, with those who do.
    pub fn heard<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = (&'a str, &'a BTreeSet<String>)> {
        self.of_type(&self.subscribers, kind)
    }

    /// The action servers that drive as move_base does, by their full names: they hear goals and
    /// publish feedback. Not every master knows the types of topics that are only heard.
    pub fn driving_servers(&self) -> BTreeSet<String> {
        let goals = self.heard("move_base_msgs/MoveBaseActionGoal").filter_map(|(t, _)| t.strip_suffix("/goal"));
        let feedback = self.published("move_base_msgs/MoveBaseActionFeedback");
        goals.chain(feedback.filter_map(|(t, _)| t.strip_suffix("/feedback"))).map(ToOwned::to_owned).collect()
    }

    /// How long ago the master answered.
    pub fn age(&self) -> Duration {
        self.taken.elapsed()
    }

    fn of_type<'a>(&'a self, nodes: &'a Nodes, kind: &'a str) -> impl Iterator<Item = (&'a str, &'a BTreeSet<String>)> {
        let is_of_type = move |topic: &str| self.type_of(topic) == Some(kind);
        nodes.iter().filter(move |(topic, nodes)| is_of_type(topic) && !nodes.is_empty()).map(|(t, n)| (t.as_str(), n))
    }
}

/// Asks the master, and keeps its last answer.
#[derive(Default)]
pub(super) struct Directory {
    last: Arc<Mutex<Option<Arc<Listing>>>>,
    is_asking: Arc<AtomicBool>,
}

impl Directory {
    /// The last answer, if one came. One that is older than `max_age` is asked for anew,
    /// for the next call.
    pub fn look(&self, ros: &Arc<Ros>, max_age: Duration) -> Option<Arc<Listing>> {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let is_fresh = last.as_ref().is_some_and(|listing| listing.age() <= max_age);
        if !is_fresh && !self.is_asking.swap(true, Ordering::Relaxed) {
            let (ros, last, is_asking) = (Arc::clone(ros), Arc::clone(&self.last), Arc::clone(&self.is_asking));
            std::thread::spawn(move || {
                if let Some(listing) = ask(&ros) {
                    *last.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(listing));
                }
                is_asking.store(false, Ordering::Relaxed);
            });
        }
        last
    }
}

/// A master that does not answer, or not as it should, tells nothing.
fn ask(ros: &Ros) -> Option<Listing> {
    let state = ros.state().ok()?;
    let types = ros.topics().ok()?;
    Some(Listing {
        publishers: state.publishers.into_iter().map(|t| (t.name, t.connections.into_iter().collect())).collect(),
        subscribers: state.subscribers.into_iter().map(|t| (t.name, t.connections.into_iter().collect())).collect(),
        services: state.services.into_iter().map(|t| (t.name, t.connections.into_iter().collect())).collect(),
        types: types.into_iter().map(|topic| (topic.name, topic.datatype)).collect(),
        taken: Instant::now(),
    })
}

/// Names as a list for people; "none" without any.
pub(super) fn list<'a>(names: impl IntoIterator<Item = &'a String>) -> String {
    let names: Vec<&str> = names.into_iter().map(String::as_str).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
