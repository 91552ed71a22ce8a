//! One ROS node: rosrust behind the guards that a robot needs.

use super::directory::{Directory, Listing};
use super::log::{Level, Log, bridge};
use super::master::{MasterError, probe};
use super::{params, stop};
use rosrust::api::Ros;
use rosrust::api::resolve;
use rosrust::{Message, Publisher, Service, ServicePair};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long the threads that listen may take to end.
const THREADS_END_WITHIN: Duration = Duration::from_millis(1500);

/// Why a node cannot run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NodeError {
    /// There is no master.
    #[error(transparent)]
    Master(#[from] MasterError),
    /// It was told to stop before it could begin.
    #[error("told to stop while waiting for the ROS master")]
    Stopped,
    /// The name, the arguments or the parameters on the command line are wrong.
    #[error("cannot start the node {name}: {why}")]
    Start {
        /// The node's name.
        name: String,
        /// What rosrust says.
        why: String,
    },
    /// A topic or a service that cannot be offered.
    #[error("cannot offer {name}: {why}")]
    Offer {
        /// The topic's or service's name.
        name: String,
        /// What rosrust says.
        why: String,
    },
    /// Parameters that cannot be read.
    #[error("cannot read the parameters of {name}: {why}")]
    Params {
        /// The node's name.
        name: String,
        /// What rosrust says.
        why: String,
    },
}

/// A running node; clones are the same node.
#[derive(Clone)]
pub struct Node {
    ros: Arc<Ros>,
    log: Log,
    began: Instant,
    failed: Arc<AtomicBool>,
    closing: Arc<AtomicBool>,
    directory: Arc<Directory>,
}

impl Node {
    /// Registers a node under a name, which `__name:=` replaces, once there is a
    /// master; waits for one as roscpp does.
    ///
    /// # Errors
    /// [`NodeError`] when it was told to stop while waiting, or cannot start.
    pub fn start(name: &str) -> Result<Self, NodeError> {
        Self::start_within(name, None)
    }

    /// The same for one who does not wait for a master for ever.
    ///
    /// # Errors
    /// As [`Self::start`], and [`NodeError::Master`] when none has answered for so long.
    pub fn start_within(name: &str, patience: Option<Duration>) -> Result<Self, NodeError> {
        bridge();
        let mut log = Log::new(name);
        wait_for_master(&log, patience)?;
        let wrong = |why: String| NodeError::Start { name: name.to_owned(), why };
        if let Some((param, _)) = resolve::params().iter().find(|(_, value)| value.is_empty()) {
            return Err(wrong(format!("the parameter {param} on the command line has no value")));
        }
        let ros = Ros::new(name).map_err(|e| wrong(describe(&e)))?;
        let rosout = ros.publish("/rosout", 100).map_err(|e| wrong(describe(&e)))?;
        log.connect(ros.name(), rosout);
        Ok(Self {
            ros: Arc::new(ros),
            log,
            began: Instant::now(),
            failed: Arc::default(),
            closing: Arc::default(),
            directory: Arc::default(),
        })
    }

    /// What it says.
    #[must_use]
    pub const fn log(&self) -> &Log {
        &self.log
    }

    /// Its full name.
    #[must_use]
    pub fn name(&self) -> &str {
        self.ros.name()
    }

    /// Whether it shall go on: nobody told it to stop, and no part of it failed.
    #[must_use]
    pub fn is_ok(&self) -> bool {
        let raised = |flag: &AtomicBool| flag.load(Ordering::Relaxed);
        self.ros.is_ok() && !stop::is_requested() && !raised(&self.failed) && !raised(&self.closing)
    }

    /// Whether a part of it failed.
    #[must_use]
    pub fn has_failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    /// The time of ROS in seconds: real, or that of `/clock`; 0 before the first one.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.ros.now().seconds()
    }

    /// The same as a message has it.
    #[must_use]
    pub fn stamp(&self) -> rosrust::Time {
        self.ros.now()
    }

    /// Whether `/clock` tells the time.
    #[must_use]
    pub fn is_simulated_time(&self) -> bool {
        self.ros.param("/use_sim_time").and_then(|param| param.get().ok()).unwrap_or(false)
    }

    /// Seconds of real time since the node began.
    #[must_use]
    pub fn wall_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Sets a parameter by its full name.
    ///
    /// # Errors
    /// [`NodeError::Params`] when the master does not take it.
    pub fn set_param<T: serde::Serialize>(&self, name: &str, value: &T) -> Result<(), NodeError> {
        let wrong = |why: String| NodeError::Params { name: name.to_owned(), why };
        let param = self.ros.param(name).ok_or_else(|| wrong("this is no name".to_owned()))?;
        param.set(value).map_err(|e| wrong(e.to_string()))
    }

    /// Takes a parameter away by its full name.
    ///
    /// # Errors
    /// [`NodeError::Params`] when the master does not do it, or knows none of that name.
    pub fn delete_param(&self, name: &str) -> Result<(), NodeError> {
        params::delete(&self.ros, name).map_err(|why| NodeError::Params { name: name.to_owned(), why })
    }

    /// Its private parameters as a tree.
    ///
    /// # Errors
    /// [`NodeError::Params`] when the master does not tell.
    pub fn private_params(&self) -> Result<serde_json::Value, NodeError> {
        self.params_below(self.name())
    }

    /// The parameters below any full name as a tree, such as those of another node.
    ///
    /// # Errors
    /// [`NodeError::Params`] when the master does not tell.
    pub fn params_below(&self, name: &str) -> Result<serde_json::Value, NodeError> {
        params::tree(&self.ros, name).map_err(|why| NodeError::Params { name: name.to_owned(), why })
    }

    /// One parameter, searched upwards from the node's namespace as `tf_prefix` is.
    #[must_use]
    pub fn searched_param(&self, name: &str) -> Option<String> {
        params::searched(&self.ros, name)
    }

    /// Offers a topic.
    ///
    /// # Errors
    /// [`NodeError::Offer`] with the topic.
    pub fn publish<T: Message>(&self, topic: &str, queue: usize) -> Result<Publisher<T>, NodeError> {
        self.ros.publish(topic, queue).map_err(|e| NodeError::Offer { name: topic.to_owned(), why: describe(&e) })
    }

    /// Offers a topic whose last message every new subscriber gets.
    ///
    /// # Errors
    /// [`NodeError::Offer`] with the topic.
    pub fn publish_latched<T: Message>(&self, topic: &str) -> Result<Publisher<T>, NodeError> {
        // Latching belongs to the handle: it is set before any clone is made.
        let mut publisher = self.publish(topic, 1)?;
        publisher.set_latching(true);
        Ok(publisher)
    }

    /// Offers a service.
    ///
    /// # Errors
    /// [`NodeError::Offer`] with the service.
    pub fn serve<T: ServicePair>(
        &self,
        service: &str,
        handler: impl Fn(T::Request) -> Result<T::Response, String> + Send + Sync + 'static,
    ) -> Result<Service, NodeError> {
        self.ros
            .service::<T, _>(service, handler)
            .map_err(|e| NodeError::Offer { name: service.to_owned(), why: describe(&e) })
    }

    /// What the master last said of topics and nodes. An answer older than `max_age` is
    /// asked for anew, for the next call; nobody waits for it.
    pub(super) fn listing(&self, max_age: Duration) -> Option<Arc<Listing>> {
        self.directory.look(&self.ros, max_age)
    }

    /// A name as the master knows it: in the node's namespace, and remapped.
    pub(crate) fn full_name(&self, name: &str) -> String {
        self.ros.param(name).map_or_else(|| name.to_owned(), |param| param.name().to_owned())
    }

    /// Marks the node as failed: it stops as if it were told to.
    pub(super) fn fail(&self, why: &str) {
        self.log.error(why);
        self.failed.store(true, Ordering::Relaxed);
    }

    pub(super) fn ros(&self) -> &Arc<Ros> {
        &self.ros
    }

    /// Waits in short slices of real time until `done`, the limit, or the node's end.
    /// rosrust's own sleep would hang for ever without `/clock`.
    pub fn wait_until(&self, limit: Duration, mut done: impl FnMut() -> bool) -> bool {
        let began = Instant::now();
        while self.is_ok() {
            if done() {
                return true;
            }
            if began.elapsed() >= limit {
                return false;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        false
    }

    /// Says good-bye: what was published goes out, the node's threads end, and all that
    /// was registered is given back, `/clock` and `/rosout` too. What its owner still
    /// holds must be dropped before.
    pub fn finish(self) {
        std::thread::sleep(Duration::from_millis(100));
        self.closing.store(true, Ordering::Relaxed);
        let began = Instant::now();
        while Arc::strong_count(&self.ros) > 1 && began.elapsed() < THREADS_END_WITHIN {
            std::thread::sleep(Duration::from_millis(20));
        }
        self.log.disconnect();
        self.ros.shutdown_sender().shutdown();
    }
}

fn wait_for_master(log: &Log, patience: Option<Duration>) -> Result<(), NodeError> {
    let uri = resolve::master();
    let began = Instant::now();
    let mut next_word = began;
    loop {
        match probe(&uri) {
            Ok(()) => return Ok(()),
            Err(error @ MasterError::Uri(_)) => return Err(error.into()),
            Err(error) if patience.is_some_and(|patience| began.elapsed() >= patience) => return Err(error.into()),
            Err(error) if Instant::now() >= next_word => {
                log.once(Level::Warn, format_args!("{error}; still waiting for it"));
                next_word = Instant::now() + Duration::from_secs(30);
            }
            Err(_) => {}
        }
        for _ in 0..20 {
            if stop::is_requested() {
                return Err(NodeError::Stopped);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

/// An error of rosrust with its causes in one line.
pub(super) fn describe(error: &rosrust::error::Error) -> String {
    error.iter().map(ToString::to_string).collect::<Vec<_>>().join(": ")
}
