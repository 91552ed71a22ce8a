//! Places to leave alone: in metres, so that they outlive every map (invariant 6).
//!
//! A round is the time until nothing is left to try. What failed stays taboo for the
//! round, however long it lasts, and is forgiven at its end, once more each time: a taboo
//! that expires by the clock comes back before the others have had their turn.

use crate::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How failures and vain visits become taboo.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TabooConfig {
    /// Targets within this distance are the same place, metres.
    pub radius_m: f64,
    /// A frontier is taboo for the round after so many failures. A round lasts until nothing is
    /// left to try; each failure is that of another place to stand.
    pub max_failures: u32,
    /// What has failed is not tried again in later rounds either (Yamauchi 1997).
    pub is_final: bool,
    /// A place to stand is spent after so many visits without a change in newer maps. Only
    /// a place closer to the frontier is worth a visit then.
    pub max_visits: u32,
}

impl Default for TabooConfig {
    fn default() -> Self {
        Self { radius_m: 0.4, max_failures: 2, is_final: false, max_visits: 2 }
    }
}

/// Why a place is left alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taboo {
    /// Driving there failed.
    Failed,
    /// It was seen from nearby, and nothing more could be seen.
    Exhausted,
}

/// One frontier's point and its history.
#[derive(Clone, Debug)]
struct Entry {
    target: Point,
    failures: u32,
}

/// A visit in vain.
#[derive(Clone, Copy, Debug)]
struct Visit {
    place: Point,
    target: Point,
}

/// A place to stand that could not be reached.
#[derive(Clone, Copy, Debug)]
struct Refused {
    place: Point,
    /// Where the robot was when it failed.
    from: Point,
    target: Point,
}

/// The frontiers and places that failed or were visited.
#[derive(Clone, Debug)]
pub struct Blacklist {
    config: TabooConfig,
    entries: Vec<Entry>,
    refused: Vec<Refused>,
    visits: Vec<Visit>,
}

/// Places to stand within this distance are the same, and one nearer to a frontier by more is
/// worth another visit, metres.
pub const SAME_PLACE_M: f64 = 0.25;

impl Blacklist {
    /// An empty list.
    #[must_use]
    pub const fn new(config: TabooConfig) -> Self {
        Self { config, entries: Vec::new(), refused: Vec::new(), visits: Vec::new() }
    }

    /// Driving from a place to another one, to see a target, failed.
    pub fn record_failure(&mut self, target: Point, place: Point, from: Point) {
        self.entry(target).failures += 1;
        self.refused.push(Refused { place, from, target });
    }

    /// The robot was at a place to see a target, and a newer map shows no change.
    pub fn record_visit(&mut self, target: Point, place: Point) {
        self.visits.push(Visit { place, target });
    }

    /// Whether driving to a frontier with this point has failed too often in this round.
    #[must_use]
    pub fn has_failed(&self, target: Point) -> bool {
        let is_near = |entry: &Entry| nalgebra::distance(&entry.target, &target) <= self.config.radius_m;
        self.entries.iter().any(|entry| is_near(entry) && entry.failures >= self.config.max_failures)
    }

    /// Whether the robot was at a place often enough, or nearer to the target, without seeing
    /// more of it: only a closer place is worth a visit. A robot that sees all round has seen
    /// from a place whatever can be seen from there, for this target or another one.
    #[must_use]
    pub fn is_spent(&self, place: Point, target: Point, sees_all_round: bool) -> bool {
        let away_m = nalgebra::distance(&place, &target);
        let is_vain = |visit: &&Visit| {
            let is_same_place = nalgebra::distance(&visit.place, &place) <= SAME_PLACE_M;
            let is_same_target = nalgebra::distance(&visit.target, &target) <= self.config.radius_m;
            let was_as_close = nalgebra::distance(&visit.place, &visit.target) <= away_m + SAME_PLACE_M;
            (is_same_place && sees_all_round) || (is_same_target && was_as_close)
        };
        self.visits.iter().filter(is_vain).count() >= self.config.max_visits as usize
    }

    /// Whether the robot has failed to get to a place to stand in this round.
    #[must_use]
    pub fn refuses(&self, place: Point) -> bool {
        self.refused.iter().any(|refused| nalgebra::distance(&refused.place, &place) <= SAME_PLACE_M)
    }

    /// A new round: every failed place has one more chance, unless failures are final.
    pub fn forgive_failures(&mut self) {
        if self.config.is_final {
            return;
        }
        self.refused.clear();
        let last_chance = self.config.max_failures.saturating_sub(1);
        for entry in &mut self.entries {
            entry.failures = entry.failures.min(last_chance);
        }
    }

    /// What failed from near a place is not to blame: the robot could not get away.
    pub fn forgive_from(&mut self, from: Point, radius_m: f64) {
        let (forgiven, kept): (Vec<Refused>, _) =
            self.refused.drain(..).partition(|refused| nalgebra::distance(&refused.from, &from) <= radius_m);
        self.refused = kept;
        for refused in forgiven {
            let entry = self.entry(refused.target);
            entry.failures = entry.failures.saturating_sub(1);
        }
    }

    /// Forgets everything; returns how many frontiers and places were left alone.
    pub fn clear(&mut self) -> usize {
        let left_alone = self.entries.len() + self.visits.len();
        (self.entries, self.refused, self.visits) = (Vec::new(), Vec::new(), Vec::new());
        left_alone
    }

    fn entry(&mut self, target: Point) -> &mut Entry {
        let radius_m = self.config.radius_m;
        let known = self.entries.iter().position(|e| nalgebra::distance(&e.target, &target) <= radius_m);
        let index = known.unwrap_or_else(|| {
            self.entries.push(Entry { target, failures: 0 });
            self.entries.len() - 1
        });
        &mut self.entries[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Point = Point::new(9.0, 9.0);

    #[test]
    fn failures_add_up_for_the_round_and_are_forgiven_after_it() {
        let mut list = Blacklist::new(TabooConfig { max_failures: 2, ..TabooConfig::default() });
        let (target, near) = (Point::new(1.0, 1.0), Point::new(1.2, 1.0));
        let stand = Point::new(0.5, 1.0);
        list.record_failure(target, stand, HERE);
        assert_eq!((list.has_failed(target), list.refuses(stand)), (false, true));
        list.record_failure(near, Point::new(0.5, 2.0), HERE);
        assert!(list.has_failed(near));
        assert!(!list.has_failed(Point::new(2.0, 2.0)));
        list.forgive_failures();
        assert_eq!((list.has_failed(near), list.refuses(stand)), (false, false), "one more chance");
        list.record_failure(near, stand, HERE);
        assert!(list.has_failed(near));
        let mut for_good = Blacklist::new(TabooConfig { max_failures: 1, is_final: true, ..TabooConfig::default() });
        for_good.record_failure(target, stand, HERE);
        for_good.forgive_failures();
        assert!(for_good.has_failed(target));
    }

    #[test]
    fn what_failed_from_where_the_robot_was_wedged_is_not_to_blame() {
        let mut list = Blacklist::new(TabooConfig { max_failures: 1, ..TabooConfig::default() });
        let (target, other) = (Point::new(1.0, 1.0), Point::new(5.0, 5.0));
        list.record_failure(target, target, HERE);
        list.record_failure(other, other, Point::new(0.0, 0.0));
        list.forgive_from(Point::new(9.1, 9.0), 0.3);
        assert_eq!((list.has_failed(target), list.refuses(target)), (false, false));
        assert_eq!((list.has_failed(other), list.refuses(other)), (true, true));
    }

    #[test]
    fn vain_visits_do_not_expire() {
        let mut list = Blacklist::new(TabooConfig::default());
        let stand = Point::new(1.0, 0.0);
        list.record_visit(Point::new(0.0, 0.0), stand);
        list.record_visit(Point::new(0.1, 0.0), stand);
        list.forgive_failures();
        let target = Point::new(0.0, 0.1);
        assert!(list.is_spent(stand, target, false));
        assert!(list.is_spent(Point::new(-1.5, 0.0), target, false), "no closer");
        assert!(!list.is_spent(Point::new(0.5, 0.0), target, false), "a closer look");
        let other = Point::new(2.0, 0.0);
        assert!(!list.is_spent(stand, other, false) && list.is_spent(stand, other, true));
    }
}
