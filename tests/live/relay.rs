//! Topics that pass through the test, which may change or hold back their messages.

use frontier_explorer::ros::msg::rosgraph_msgs::Clock;
use frontier_explorer::ros::msg::sensor_msgs::LaserScan;
use frontier_explorer::ros::msg::tf2_msgs::TFMessage;
use frontier_explorer::ros::{Feed, Node};
use rosrust::Publisher;
use std::sync::{Arc, Mutex};
use std::time::Duration;

type Change<T> = Box<dyn FnMut(T) -> Option<T> + Send>;

/// One topic; at first everything passes as it is.
pub struct Relay<T: rosrust::Message> {
    change: Arc<Mutex<Change<T>>>,
    out: Publisher<T>,
    _feed: Feed,
}

impl<T: rosrust::Message> Relay<T> {
    pub fn new(node: &Node, from: &str, to: &str) -> Self {
        Self::between(node, from, node.publish(to, 100).unwrap())
    }

    /// One whose last message is told to those who come later.
    pub fn latched(node: &Node, from: &str, to: &str) -> Self {
        Self::between(node, from, node.publish_latched(to).unwrap())
    }

    fn between(node: &Node, from: &str, out: Publisher<T>) -> Self {
        let change: Arc<Mutex<Change<T>>> = Arc::new(Mutex::new(Box::new(Some)));
        let (theirs, sender) = (Arc::clone(&change), out.clone());
        let feed = Feed::listen(node, from, 100, Duration::from_secs(120), move |message: T, _| {
            if let Some(message) = (theirs.lock().unwrap())(message) {
                sender.send(message).unwrap();
            }
        });
        Self { change, out, _feed: feed }
    }

    /// From now on messages go through this.
    pub fn set(&self, change: impl FnMut(T) -> Option<T> + Send + 'static) {
        *self.change.lock().unwrap() = Box::new(change);
    }

    /// From now on they pass as they are.
    pub fn pass(&self) {
        self.set(Some);
    }

    /// From now on nothing passes.
    pub fn hold(&self) {
        self.set(|_| None);
    }

    /// Sends a message past the relay.
    pub fn send(&self, message: T) {
        self.out.send(message).unwrap();
    }
}

/// The clock, the transforms and the scans of a simulator.
pub struct Relays {
    pub clock: Relay<Clock>,
    pub tf: Relay<TFMessage>,
    pub scan: Relay<LaserScan>,
}

impl Relays {
    /// What the simulator's arguments must be for [`Relays::new`].
    pub const REMAPPINGS: [&str; 3] = ["/clock:=/true/clock", "/tf:=/true/tf", "scan:=/true/scan"];

    pub fn new(node: &Node) -> Self {
        Self {
            clock: Relay::new(node, "/true/clock", "/clock"),
            tf: Relay::new(node, "/true/tf", "/tf"),
            scan: Relay::new(node, "/true/scan", "/scan"),
        }
    }

    /// From now on all times are so much later than the simulator's, seconds.
    pub fn shift(&self, by_s: u32) {
        self.clock.set(move |mut message| {
            message.clock.sec += by_s;
            Some(message)
        });
        self.tf.set(move |message| Some(later(message, by_s)));
        self.scan.set(move |mut message| {
            message.header.stamp.sec += by_s;
            Some(message)
        });
    }
}

/// Transforms with later stamps.
pub fn later(mut message: TFMessage, by_s: u32) -> TFMessage {
    for transform in &mut message.transforms {
        transform.header.stamp.sec += by_s;
    }
    message
}
