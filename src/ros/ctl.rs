//! Asking a running explorer for something: its services, and its status.

use super::call::{CallError, call};
use super::directory::list;
use super::feed::Feed;
use super::msg::frontier_explorer::ExplorationStatus;
use super::msg::std_srvs::{Trigger, TriggerReq};
use super::node::Node;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The type of an explorer's status.
const STATUS_TYPE: &str = "frontier_explorer/ExplorationStatus";
/// How old an answer of the master may be.
const LISTING_AGE: Duration = Duration::from_millis(500);
/// The master is asked for so long who explores.
const LISTING_LIMIT: Duration = Duration::from_secs(3);
/// A status comes once a second: a subscription is made anew after this silence.
const SILENCE: Duration = Duration::from_secs(10);
/// A publisher that the master does not know by then is not there.
const SETTLED_AFTER: Duration = Duration::from_millis(1500);

/// Why an explorer could not be asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CtlError {
    /// It is not there.
    #[error("no explorer {explorer} is there; explorers that run: {others}; choose one with --node")]
    Absent {
        /// Its name.
        explorer: String,
        /// The explorers that there are.
        others: String,
    },
    /// It is there, and does not offer that.
    #[error("the explorer {explorer} offers no service {service}: it is of another version")]
    Unknown {
        /// Its name.
        explorer: String,
        /// What it was asked for.
        service: String,
    },
    /// It gave no answer.
    #[error("{0}")]
    NoAnswer(String),
}

/// An explorer's answer to a request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Whether it does what was asked for.
    pub success: bool,
    /// What it says of it.
    pub message: String,
}

/// Calls one of an explorer's services, such as `pause`, and waits for the answer no longer than
/// `limit`. A relative name of the explorer is one in the namespace of `node`.
///
/// # Errors
/// [`CtlError`] when the explorer is not there, or does not answer.
pub fn request(node: &Node, explorer: &str, service: &str, limit: Duration) -> Result<Answer, CtlError> {
    let explorer = node.full_name(explorer);
    match call::<Trigger>(node, &format!("{explorer}/{service}"), TriggerReq {}, limit) {
        Ok(answer) => Ok(Answer { success: answer.success, message: answer.message }),
        Err(CallError::Absent { service }) => {
            let explorers = explorers(node);
            Err(if explorers.contains(&explorer) {
                CtlError::Unknown { explorer, service }
            } else {
                CtlError::Absent { explorer, others: list(&explorers) }
            })
        }
        Err(error) => Err(CtlError::NoAnswer(error.to_string())),
    }
}

/// The explorers that run, by their full names; none when the master does not tell.
fn explorers(node: &Node) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    node.wait_until(LISTING_LIMIT, || {
        let Some(listing) = node.listing(LISTING_AGE) else { return false };
        found = listing.published(STATUS_TYPE).flat_map(|(_, nodes)| nodes.clone()).collect();
        true
    });
    found
}

/// The status of an explorer, listened to until this is dropped.
pub struct StatusWatch {
    node: Node,
    explorer: String,
    newest: Arc<Mutex<Option<ExplorationStatus>>>,
    feed: Feed,
}

impl StatusWatch {
    /// Begins to listen. A relative name of the explorer is one in the namespace of `node`.
    #[must_use]
    pub fn begin(node: &Node, explorer: &str) -> Self {
        let explorer = node.full_name(explorer);
        let newest = Arc::<Mutex<Option<ExplorationStatus>>>::default();
        let theirs = Arc::clone(&newest);
        let feed =
            Feed::listen(node, &format!("{explorer}/status"), 2, SILENCE, move |message: ExplorationStatus, _| {
                *theirs.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
            });
        Self { node: node.clone(), explorer, newest, feed }
    }

    /// How long ago the last status came, if one came.
    #[must_use]
    pub fn age(&self) -> Option<Duration> {
        self.feed.age()
    }

    /// The newest status; waits for the first one no longer than `limit`.
    ///
    /// # Errors
    /// [`CtlError`] when the explorer is not there, or tells no status.
    pub fn newest(&self, limit: Duration) -> Result<ExplorationStatus, CtlError> {
        let (began, topic) = (Instant::now(), format!("{}/status", self.explorer));
        let newest = || self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let is_absent = || {
            let listing = self.node.listing(LISTING_AGE);
            began.elapsed() > SETTLED_AFTER && listing.is_some_and(|listing| listing.publishers(&topic).is_empty())
        };
        self.node.wait_until(limit, || newest().is_some() || is_absent());
        if let Some(status) = newest() {
            return Ok(status);
        }
        let (explorer, explorers) = (self.explorer.clone(), explorers(&self.node));
        Err(if explorers.contains(&explorer) {
            CtlError::NoAnswer(format!("{explorer} has told no status for {} s", limit.as_secs()))
        } else {
            CtlError::Absent { explorer, others: list(&explorers) }
        })
    }
}
