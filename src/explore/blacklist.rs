//! Places to leave alone: in metres, so that they outlive every map (invariant 6).

use crate::geometry::Point;
use serde::{Deserialize, Serialize};

/// How failures and vain visits become taboo.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TabooConfig {
    /// Targets within this distance are the same place, metres.
    pub radius_m: f64,
    /// A place is taboo after failing this often.
    pub max_failures: u32,
    /// And again allowed after this time, seconds.
    pub expiry_s: f64,
    /// A place is exhausted after being visited this often with its frontier unchanged.
    pub max_visits: u32,
}

impl Default for TabooConfig {
    fn default() -> Self {
        Self { radius_m: 0.4, max_failures: 2, expiry_s: 120.0, max_visits: 2 }
    }
}

/// Why a place is left alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taboo {
    /// Driving there failed.
    Failed,
    /// The robot was there, and nothing more could be seen.
    Exhausted,
}

/// One place and its history.
#[derive(Clone, Debug)]
struct Entry {
    place: Point,
    failures: u32,
    failed_s: f64,
    visits: u32,
}

/// The places that failed or were visited.
#[derive(Clone, Debug)]
pub struct Blacklist {
    config: TabooConfig,
    entries: Vec<Entry>,
}

impl Blacklist {
    /// An empty list.
    #[must_use]
    pub const fn new(config: TabooConfig) -> Self {
        Self { config, entries: Vec::new() }
    }

    /// Driving to a place failed at a time in seconds.
    pub fn record_failure(&mut self, place: Point, now_s: f64) {
        let entry = self.entry(place);
        entry.failures += 1;
        entry.failed_s = now_s;
    }

    /// The robot was at a place and looked around.
    pub fn record_visit(&mut self, place: Point) {
        self.entry(place).visits += 1;
    }

    /// Whether a place is to be left alone at a time in seconds, and why.
    #[must_use]
    pub fn check(&self, place: Point, now_s: f64) -> Option<Taboo> {
        let near = |entry: &&Entry| nalgebra::distance(&entry.place, &place) <= self.config.radius_m;
        let mut found = None;
        for entry in self.entries.iter().filter(near) {
            if entry.visits >= self.config.max_visits {
                return Some(Taboo::Exhausted);
            }
            if entry.failures >= self.config.max_failures && now_s - entry.failed_s < self.config.expiry_s {
                found = Some(Taboo::Failed);
            }
        }
        found
    }

    /// Gives every failed place one more chance.
    pub fn forgive_failures(&mut self) {
        let last_chance = self.config.max_failures.saturating_sub(1);
        for entry in &mut self.entries {
            entry.failures = entry.failures.min(last_chance);
        }
    }

    /// The places that are taboo now, for markers.
    pub fn places(&self, now_s: f64) -> impl Iterator<Item = (Point, Taboo)> + '_ {
        self.entries.iter().filter_map(move |e| self.check(e.place, now_s).map(|taboo| (e.place, taboo)))
    }

    fn entry(&mut self, place: Point) -> &mut Entry {
        let radius_m = self.config.radius_m;
        let known = self.entries.iter().position(|e| nalgebra::distance(&e.place, &place) <= radius_m);
        let index = known.unwrap_or_else(|| {
            self.entries.push(Entry { place, failures: 0, failed_s: 0.0, visits: 0 });
            self.entries.len() - 1
        });
        &mut self.entries[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_add_up_expire_and_are_forgiven() {
        let mut list = Blacklist::new(TabooConfig { max_failures: 2, expiry_s: 10.0, ..TabooConfig::default() });
        let (place, near) = (Point::new(1.0, 1.0), Point::new(1.2, 1.0));
        list.record_failure(place, 0.0);
        assert_eq!(list.check(place, 1.0), None);
        list.record_failure(near, 2.0);
        assert_eq!(list.check(near, 3.0), Some(Taboo::Failed));
        assert_eq!(list.check(Point::new(2.0, 2.0), 3.0), None);
        assert_eq!(list.check(near, 12.5), None, "expired");
        list.record_failure(near, 13.0);
        list.forgive_failures();
        assert_eq!(list.check(near, 14.0), None, "one more chance");
        list.record_failure(near, 15.0);
        assert_eq!(list.check(near, 16.0), Some(Taboo::Failed));
    }

    #[test]
    fn vain_visits_do_not_expire() {
        let mut list = Blacklist::new(TabooConfig::default());
        list.record_visit(Point::new(0.0, 0.0));
        list.record_visit(Point::new(0.1, 0.0));
        assert_eq!(list.check(Point::new(0.0, 0.1), 1e9), Some(Taboo::Exhausted));
        assert_eq!(list.places(0.0).count(), 1);
    }
}
