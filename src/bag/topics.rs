//! The topics of a bag while they are counted: rates, pauses, frames, clocks.

use super::connections::Connection;
use super::cursor::Malformed;
use super::definitions::MessageType;
use super::links::Links;
use super::message;
use super::skew::Skew;
use super::span::{Body, PAUSE_S, Span, Within};
use super::{Nanos, seconds};
use serde::{Serialize, Serializer};
use std::collections::{BTreeMap, BTreeSet};

/// The most frames that are told apart for one topic.
const MAX_FRAMES: usize = 4096;

/// What is recorded of one topic.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TopicSummary {
    /// Its name.
    pub topic: String,
    /// Its type.
    pub kind: String,
    /// The type's md5 sum.
    pub md5: String,
    /// The type, if it is one that this program reads.
    pub is_read: bool,
    /// How many publishers there were.
    pub connections: usize,
    /// Whether one of them latched.
    pub is_latching: bool,
    /// How many messages.
    pub messages: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Time of the first message, seconds; times that cannot be do not count.
    pub first_s: f64,
    /// Time of the last message, seconds, likewise.
    pub last_s: f64,
    /// Messages a second, on average; 0 of a single message, which has no rate.
    #[serde(serialize_with = "unless_zero")]
    pub rate_hz: f64,
    /// The longest time without a message between two, seconds; `None` where there are no two.
    pub longest_gap_s: Option<f64>,
    /// When it began, seconds.
    pub longest_gap_at_s: Option<f64>,
    /// The frames of the headers, where the type is read.
    pub frames: BTreeSet<String>,
    /// The frame of most headers; empty where there are none.
    pub frame: String,
    /// Messages that are not what their type says, or hold what cannot be.
    pub malformed: u64,
    /// What is wrong with the first of them.
    pub first_fault: Option<String>,
    /// Scans of which no reading tells a distance, or that nothing is there.
    pub silent: u64,
    /// How far their stamps are from the recorder's clock.
    #[serde(skip)]
    pub skew: Skew,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn unless_zero<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    (*value > 0.0).then_some(*value).serialize(serializer)
}

/// The topics while they are counted; the connections of one topic and type are one.
#[derive(Default)]
pub(super) struct Topics {
    topics: Vec<Counted>,
    by_connection: BTreeMap<u32, usize>,
}

impl Topics {
    /// The topic of a connection.
    pub fn of(&mut self, number: u32, connection: &Connection) -> Option<&mut Counted> {
        let index = match self.by_connection.get(&number) {
            Some(&index) => index,
            None => {
                let is_it = |t: &Counted| t.summary.topic == connection.topic && t.summary.md5 == connection.md5;
                let index = self.topics.iter().position(is_it).unwrap_or_else(|| {
                    self.topics.push(Counted::new(connection));
                    self.topics.len() - 1
                });
                self.by_connection.insert(number, index);
                if let Some(counted) = self.topics.get_mut(index) {
                    counted.summary.connections += 1;
                    counted.summary.is_latching |= connection.is_latching;
                }
                index
            }
        };
        self.topics.get_mut(index)
    }

    /// The topics in the order of their names.
    pub fn finish(self, body: &Body) -> Vec<TopicSummary> {
        let mut topics: Vec<_> = self.topics.into_iter().map(|counted| counted.finish(body)).collect();
        topics.sort_by(|a, b| (&a.topic, &a.md5).cmp(&(&b.topic, &b.md5)));
        topics
    }
}

/// A topic while it is counted.
pub(super) struct Counted {
    kind: Option<MessageType>,
    last: Option<Nanos>,
    span: Span,
    /// The longest gap that is no pause, and when it began.
    gap: Option<(f64, Nanos)>,
    /// How many headers had which frame.
    frames: BTreeMap<String, u64>,
    summary: TopicSummary,
}

impl Counted {
    fn new(connection: &Connection) -> Self {
        let kind = MessageType::of(&connection.kind, &connection.md5);
        let summary = TopicSummary {
            topic: connection.topic.clone(),
            kind: connection.kind.clone(),
            md5: connection.md5.clone(),
            is_read: kind.is_some(),
            ..TopicSummary::default()
        };
        Self { kind, last: None, span: Span::default(), gap: None, frames: BTreeMap::new(), summary }
    }

    /// Counts a message.
    pub fn count(&mut self, time: Nanos, data: &[u8], links: &mut Links) {
        self.span.add(time);
        if let Some(last) = self.last {
            let gap_s = seconds(time.saturating_sub(last));
            // Longer ones are pauses, which the span knows.
            if gap_s <= PAUSE_S && time >= last && self.gap.is_none_or(|(longest_s, _)| gap_s > longest_s) {
                self.gap = Some((gap_s, last));
            }
        }
        self.last = Some(time);
        self.summary.messages += 1;
        self.summary.bytes += data.len() as u64;
        if let Err(error) = self.look_into(time, data, links) {
            self.summary.malformed += 1;
            self.summary.first_fault.get_or_insert_with(|| error.to_string());
        }
    }

    fn look_into(&mut self, time: Nanos, data: &[u8], links: &mut Links) -> Result<(), Malformed> {
        let Some(kind) = self.kind else { return Ok(()) };
        if kind == MessageType::Transforms {
            let is_static = self.summary.topic.ends_with("tf_static");
            for sample in message::transforms(data)? {
                links.count(&sample, &self.summary.topic, is_static, time);
            }
        } else if kind.has_header() {
            let header = message::header(data)?;
            self.summary.skew.add(header.stamp, time);
            if let Some(count) = self.frames.get_mut(&header.frame) {
                *count += 1;
            } else if self.frames.len() < MAX_FRAMES {
                self.frames.insert(header.frame, 1);
            }
            message::check(kind, data)?;
            if kind == MessageType::Scan && !message::scan_tells(data)? {
                self.summary.silent += 1;
            }
        }
        Ok(())
    }

    fn finish(self, body: &Body) -> TopicSummary {
        let mut summary = self.summary;
        if let Some(Within { first, last, longest: pause }) = self.span.within(body) {
            (summary.first_s, summary.last_s) = (seconds(first), seconds(last));
            let span_s = summary.last_s - summary.first_s;
            summary.rate_hz = if span_s > 0.0 { summary.messages.saturating_sub(1) as f64 / span_s } else { 0.0 };
            let gap = self.gap.filter(|(_, at)| body.contains(*at));
            let longest = pause.into_iter().chain(gap).max_by(|a, b| a.0.total_cmp(&b.0));
            (summary.longest_gap_s, summary.longest_gap_at_s) =
                longest.map_or((None, None), |(gap_s, at)| (Some(gap_s), Some(seconds(at))));
        } else {
            // All its messages are strays.
            (summary.first_s, summary.last_s) = (seconds(body.start), seconds(body.start));
        }
        let most = self.frames.iter().max_by_key(|(_, count)| **count);
        summary.frame = most.map(|(frame, _)| frame.clone()).unwrap_or_default();
        summary.frames = self.frames.into_keys().collect();
        summary
    }
}
