//! Listening to a topic: on a thread of its own, and again when its connection is lost.
//!
//! rosrust's `subscribe` blocks as long as any publisher of the topic hangs, does not
//! connect anew after a connection broke, and a callback that panics ends its
//! subscription without a word. Here a thread subscribes, watches the age of the
//! messages and the master's list of publishers, and a panic ends the node with an error.

mod renewal;

use super::log::Level;
use super::node::{Node, describe};
use renewal::{Listed, Renewal, Rhythm, Seen};
use rosrust::{Message, Subscriber};
use std::collections::{BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::Thread;
use std::time::{Duration, Instant};

/// From one look at the age of the messages to the next, at the most.
const SLICE: Duration = Duration::from_millis(500);

struct Shared {
    closed: AtomicBool,
    /// Milliseconds since the feed was opened; 0 is never.
    last_message_ms: AtomicU64,
    opened: Instant,
    /// The nodes that have sent by this subscription, or that connected to send.
    callers: Mutex<BTreeSet<String>>,
}

/// A topic that is listened to until this is dropped.
pub struct Feed {
    shared: Arc<Shared>,
    keeper: Thread,
}

impl Feed {
    /// Listens to a topic on a thread of its own. When it has talked and is silent for
    /// longer than `silence`, the subscription is made anew.
    pub fn listen<T: Message>(
        node: &Node,
        topic: &str,
        queue: usize,
        silence: Duration,
        on_message: impl Fn(T, &str) + Send + Sync + 'static,
    ) -> Self {
        Self::open(node, topic, queue, Rhythm::Steady(silence), on_message)
    }

    /// Listens to a topic that may rightly be silent. Every `period` it is looked whether
    /// all its publishers are met; silence alone is no reason to subscribe anew.
    pub fn listen_seldom<T: Message>(
        node: &Node,
        topic: &str,
        queue: usize,
        period: Duration,
        on_message: impl Fn(T, &str) + Send + Sync + 'static,
    ) -> Self {
        Self::open(node, topic, queue, Rhythm::Seldom(period), on_message)
    }

    fn open<T: Message>(
        node: &Node,
        topic: &str,
        queue: usize,
        rhythm: Rhythm,
        on_message: impl Fn(T, &str) + Send + Sync + 'static,
    ) -> Self {
        let shared = Arc::new(Shared {
            closed: AtomicBool::new(false),
            last_message_ms: AtomicU64::new(0),
            opened: Instant::now(),
            callers: Mutex::default(),
        });
        let (theirs, node, topic) = (Arc::clone(&shared), node.clone(), topic.to_owned());
        let keeper = std::thread::spawn(move || keep(&node, &topic, queue, rhythm, &theirs, &Arc::new(on_message)));
        Self { shared, keeper: keeper.thread().clone() }
    }

    /// The nodes that publish it, as far as they have connected.
    #[must_use]
    pub fn callers(&self) -> BTreeSet<String> {
        self.shared.callers.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How long ago the last message came, if one came.
    #[must_use]
    pub fn age(&self) -> Option<Duration> {
        self.shared.age()
    }
}

impl Drop for Feed {
    fn drop(&mut self) {
        self.shared.closed.store(true, Ordering::Relaxed);
        self.keeper.unpark();
    }
}

impl Shared {
    fn age(&self) -> Option<Duration> {
        match self.last_message_ms.load(Ordering::Relaxed) {
            0 => None,
            at_ms => Some(self.opened.elapsed().saturating_sub(Duration::from_millis(at_ms))),
        }
    }

    fn heard(&self) {
        let now_ms = u64::try_from(self.opened.elapsed().as_millis()).unwrap_or(u64::MAX);
        self.last_message_ms.store(now_ms.max(1), Ordering::Relaxed);
    }

    fn met(&self, caller: &str) {
        let mut callers = self.callers.lock().unwrap_or_else(PoisonError::into_inner);
        if !callers.contains(caller) {
            callers.insert(caller.to_owned());
        }
    }
}

/// Holds a subscription and makes it anew when that helps.
fn keep<T: Message>(
    node: &Node,
    topic: &str,
    queue: usize,
    rhythm: Rhythm,
    shared: &Arc<Shared>,
    on_message: &Arc<impl Fn(T, &str) + Send + Sync + 'static>,
) {
    let mut renewal = Renewal::new(rhythm);
    let full_name = node.full_name(topic);
    let slice = SLICE.min(rhythm.period() / 4);
    while !shared.closed.load(Ordering::Relaxed) && node.is_ok() {
        shared.callers.lock().unwrap_or_else(PoisonError::into_inner).clear();
        let subscriber = subscribe(node, topic, queue, shared, on_message);
        if let Err(error) = &subscriber {
            node.log().once(Level::Warn, format_args!("cannot listen to {topic}: {}", describe(error)));
        }
        let began = Instant::now();
        renewal.begin();
        while !shared.closed.load(Ordering::Relaxed) && node.is_ok() {
            std::thread::park_timeout(slice);
            let now = began.elapsed();
            let spoke = shared.age().and_then(|age| now.checked_sub(age));
            if !renewal.wants_look(now, spoke) {
                continue;
            }
            let listed = node.listing(rhythm.period() / 2).map(|listing| Listed {
                publishers: listing.publishers(&full_name),
                hears: listing.subscribers(&full_name).contains(node.name()),
            });
            let met = shared.callers.lock().unwrap_or_else(PoisonError::into_inner).clone();
            if renewal.is_due(&Seen { now, spoke, met, listed }) || subscriber.is_err() {
                break;
            }
        }
    }
}

fn subscribe<T: Message>(
    node: &Node,
    topic: &str,
    queue: usize,
    shared: &Arc<Shared>,
    on_message: &Arc<impl Fn(T, &str) + Send + Sync + 'static>,
) -> Result<Subscriber, rosrust::error::Error> {
    let (heard, met) = (Arc::clone(shared), Arc::clone(shared));
    let (handler, guarded, name) = (Arc::clone(on_message), node.clone(), topic.to_owned());
    node.ros().subscribe_with_ids_and_headers(
        topic,
        queue,
        move |message: T, caller: &str| {
            heard.heard();
            heard.met(caller);
            if catch_unwind(AssertUnwindSafe(|| handler(message, caller))).is_err() {
                guarded.fail(&format!("a message of {name} from {caller} broke the node: this is a bug"));
            }
        },
        move |headers: HashMap<String, String>| {
            if let Some(caller) = headers.get("callerid") {
                met.met(caller);
            }
        },
    )
}
