//! When messages were recorded: from when to when, without the few whose record time cannot
//! be.
//!
//! A recorder that waits for simulated time writes time 0, and a clock that is set while it
//! records leaves messages decades away. Such a message must not stretch the bag. Times are
//! kept as parts with no long pause inside; the part with most messages is believed, and so
//! is what lies near it or holds many messages.

use super::{Nanos, seconds};

/// A pause longer than this parts two parts, seconds.
pub(super) const PAUSE_S: f64 = 60.0;
/// Messages nearer than this to the rest are never strays, seconds.
const NEAR_S: f64 = 600.0;
/// Nor are those nearer than so many times the time that the rest takes.
const NEAR_TIMES: f64 = 10.0;
/// The most parts that are kept apart; beyond it, the shortest pauses are closed.
const MAX_PARTS: usize = 256;
/// So many messages may always be strays; of more, one in a hundred may.
const FEW: u64 = 3;

/// A time without a long pause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    start: Nanos,
    end: Nanos,
    messages: u64,
}

/// The times of messages, added one by one.
#[derive(Clone, Debug, Default)]
pub(super) struct Span {
    /// In the order of their times.
    parts: Vec<Part>,
    /// Where the last one was added.
    last: usize,
    /// Messages at time 0, which in ROS is none.
    at_zero: u64,
}

/// From when to when, and what lies outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Body {
    /// The first time that is believed.
    pub start: Nanos,
    /// The last.
    pub end: Nanos,
    /// Messages outside, and the time of the farthest of them.
    pub strays: Option<(u64, Nanos)>,
}

/// The times of a part of the messages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Within {
    /// The first.
    pub first: Nanos,
    /// The last.
    pub last: Nanos,
    /// The longest pause between, in seconds, and when it began.
    pub longest: Option<(f64, Nanos)>,
}

impl Body {
    /// Whether a time is believed.
    pub const fn contains(&self, time: Nanos) -> bool {
        self.start <= time && time <= self.end
    }
}

impl Span {
    /// Adds the time of a message.
    pub fn add(&mut self, time: Nanos) {
        if time == 0 {
            self.at_zero += 1;
            return;
        }
        let pause = (PAUSE_S * 1e9) as Nanos;
        let is_near = |part: &Part| time.saturating_add(pause) >= part.start && time <= part.end.saturating_add(pause);
        if !self.parts.get(self.last).is_some_and(is_near) {
            self.last = self.parts.partition_point(|part| part.end.saturating_add(pause) < time);
            if !self.parts.get(self.last).is_some_and(is_near) {
                self.parts.insert(self.last, Part { start: time, end: time, messages: 0 });
            }
        }
        let Some(part) = self.parts.get_mut(self.last) else { return };
        (part.start, part.end) = (part.start.min(time), part.end.max(time));
        part.messages += 1;
        self.join(self.last, pause);
        if self.parts.len() > MAX_PARTS {
            self.close_shortest();
        }
    }

    /// Joins a part that grew with its neighbours, where no pause is left between them.
    fn join(&mut self, index: usize, pause: Nanos) {
        for first in [index, index.wrapping_sub(1)] {
            if let (Some(a), Some(b)) = (self.parts.get(first), self.parts.get(first.wrapping_add(1)))
                && b.start <= a.end.saturating_add(pause)
            {
                self.merge(first);
            }
        }
    }

    /// Makes one of a part and the next.
    fn merge(&mut self, first: usize) {
        let next = self.parts.remove(first + 1);
        if let Some(part) = self.parts.get_mut(first) {
            (part.start, part.end) = (part.start.min(next.start), part.end.max(next.end));
            part.messages += next.messages;
        }
        if self.last > first {
            self.last -= 1;
        }
    }

    fn close_shortest(&mut self) {
        let pauses = self.parts.windows(2).map(|pair| match pair {
            [a, b] => b.start.saturating_sub(a.end),
            _ => Nanos::MAX,
        });
        if let Some((first, _)) = pauses.enumerate().min_by_key(|(_, pause)| *pause) {
            self.merge(first);
        }
    }

    /// From when to when the messages were recorded, strays left out; `None` without any.
    pub fn body(&self) -> Option<Body> {
        let Some(main) = (0..self.parts.len()).max_by_key(|&i| self.parts.get(i).map(|part| part.messages)) else {
            return (self.at_zero > 0).then(Body::default);
        };
        let mut body = *self.parts.get(main)?;
        let (mut before, mut after) = (main, main + 1);
        loop {
            let left = before.checked_sub(1).and_then(|i| self.parts.get(i));
            let right = self.parts.get(after);
            let (next, is_left) = match (left, right) {
                (Some(a), Some(b)) => {
                    let is_left = body.start.saturating_sub(a.end) <= b.start.saturating_sub(body.end);
                    (if is_left { a } else { b }, is_left)
                }
                (Some(a), None) => (a, true),
                (None, Some(b)) => (b, false),
                (None, None) => break,
            };
            // What lies behind a stray part is as far away, and may be many.
            let farther = if is_left { self.parts.get(..before) } else { self.parts.get(after..) };
            let messages = farther.unwrap_or_default().iter().map(|part| part.messages).sum();
            if is_stray(&body, next, messages) {
                if is_left {
                    before = 0;
                } else {
                    after = self.parts.len();
                }
                continue;
            }
            (body.start, body.end) = (body.start.min(next.start), body.end.max(next.end));
            body.messages += next.messages;
            if is_left { before -= 1 } else { after += 1 }
        }
        Some(Body { start: body.start, end: body.end, strays: self.strays(&body) })
    }

    fn strays(&self, body: &Part) -> Option<(u64, Nanos)> {
        let outside = self.parts.iter().filter(|part| part.end < body.start || part.start > body.end);
        let far = |time: Nanos| time.abs_diff(body.start);
        let mut found = (self.at_zero > 0).then_some((self.at_zero, 0));
        for part in outside {
            let end = if far(part.start) > far(part.end) { part.start } else { part.end };
            let (messages, time) = found.unwrap_or((0, end));
            found = Some((messages + part.messages, if far(time) > far(end) { time } else { end }));
        }
        found
    }

    /// The times within a body; `None` when there are none.
    pub fn within(&self, body: &Body) -> Option<Within> {
        let inside: Vec<&Part> =
            self.parts.iter().filter(|part| part.end >= body.start && part.start <= body.end).collect();
        let (first, last) = (inside.first()?, inside.last()?);
        let pauses = inside.iter().zip(inside.iter().skip(1)).map(|(a, b)| (b.start.saturating_sub(a.end), a.end));
        let longest = pauses.max_by_key(|(pause, _)| *pause).map(|(pause, at)| (seconds(pause), at));
        Some(Within { first: first.start, last: last.end, longest })
    }
}

/// Whether the next part, with so many messages in it and behind it, is not of the body.
fn is_stray(body: &Part, next: &Part, messages: u64) -> bool {
    let pause =
        if next.end < body.start { body.start.saturating_sub(next.end) } else { next.start.saturating_sub(body.end) };
    let near_s = NEAR_S.max(NEAR_TIMES * seconds(body.end.saturating_sub(body.start)));
    let is_few = 10 * messages <= body.messages && (messages <= FEW || 100 * messages <= body.messages);
    is_few && seconds(pause) > near_s
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: Nanos = 1_000_000_000;

    fn body(times: impl IntoIterator<Item = Nanos>) -> Body {
        let mut span = Span::default();
        times.into_iter().for_each(|time| span.add(time));
        span.body().unwrap()
    }

    #[test]
    fn a_time_that_cannot_be_stretches_nothing() {
        let drive = || (0..300).map(|i| 1000 * S + i * S / 10);
        let expected = (1000 * S, 1000 * S + 299 * S / 10);
        for stray in [0, 1, 5 * S, 4_000_000_000 * S, u64::from(u32::MAX) * S] {
            for at in [0, 150, 300] {
                let mut times: Vec<Nanos> = drive().collect();
                times.insert(at, stray);
                let found = body(times);
                assert_eq!((found.start, found.end, found.strays), (expected.0, expected.1, Some((1, stray))));
            }
        }
        assert_eq!(body(drive()).strays, None);
        let both = body(drive().chain([0, 0, 9_000 * S, 4_000_000_000 * S]));
        assert_eq!((both.start, both.end, both.strays), (expected.0, expected.1, Some((4, 4_000_000_000 * S))));
    }

    #[test]
    fn pauses_are_part_of_a_bag() {
        // Two drives with a week between, one message an hour, and one early.
        let twice = body((0..100).map(|i| 1000 * S + i * S).chain((0..50).map(|i| 600_000 * S + i * S)));
        assert_eq!((twice.start, twice.end, twice.strays), (1000 * S, 600_049 * S, None));
        let hourly = body((1..2000).map(|i| i * 3600 * S));
        assert_eq!((hourly.start, hourly.end, hourly.strays), (3600 * S, 1999 * 3600 * S, None));
        let early = body([1000 * S].into_iter().chain((0..900).map(|i| 1400 * S + i * S / 10)));
        assert_eq!((early.start, early.strays), (1000 * S, None));
        assert_eq!(body([0, 0]), Body::default());
    }

    #[test]
    fn parts_stay_few_and_in_order() {
        let mut span = Span::default();
        for i in 0..5000_u64 {
            span.add(1 + (i * 7919 % 5000) * 100 * S);
        }
        assert!(span.parts.len() <= MAX_PARTS);
        assert!(span.parts.windows(2).all(|pair| pair[0].end < pair[1].start));
        assert_eq!(span.parts.iter().map(|part| part.messages).sum::<u64>(), 5000);
        let all = Body { start: 1, end: 5000 * 100 * S, strays: None };
        let within = span.within(&all).unwrap();
        assert_eq!((within.first, within.last), (1, 1 + 4999 * 100 * S));
    }
}
