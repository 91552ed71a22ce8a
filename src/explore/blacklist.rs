//! Places to leave alone: in metres, so that they outlive every map (invariant 6).
//!
//! A round is the time until nothing is left to try. What failed stays taboo for the
//! round, however long it lasts, and is forgiven at its end, once more each time: a taboo
//! that expires by the clock comes back before the others have had their turn. The rests
//! between rounds grow (`trouble.rs`), and so does the circle around a target that failed
//! round after round: of the targets in it, those that have failed in this round too are left
//! with it. What has not been tried in this round is tried, so that no circle hides a frontier,
//! and what is left alone counts as failed, so that no run ends `complete` over it.
//!
//! Where the map has opened around a failure since, by a door or by a better look, it is
//! forgotten at once; each time the map must open twice as far, as maps tremble.

mod listed;
mod saved;
mod surroundings;

pub use listed::{Blacklisted, Forgiven};
pub use saved::SavedBlacklist;

use crate::geometry::Point;
use crate::grid::Thresholds;
use crate::robot::MapSnapshot;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use surroundings::Surroundings;

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

/// A goal that failed.
#[derive(Clone, Copy, Debug)]
pub struct Failure<'a> {
    /// What was to be seen.
    pub target: Point,
    /// Where the robot was sent.
    pub place: Point,
    /// Where it was when that failed.
    pub from: Point,
    /// Why, as its navigation or the explorer says.
    pub why: &'a str,
}

/// One frontier's point and its history.
#[derive(Clone, Debug)]
struct Entry {
    target: Point,
    failures: u32,
    /// Of these, how many are of this round.
    this_round: u32,
    /// In how many earlier rounds it became taboo.
    rounds: u32,
    /// How often a failure was forgotten as the map had opened.
    openings: u32,
    place: Point,
    why: String,
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
    /// What the map showed around the place and the target then.
    around: [Surroundings; 2],
}

/// The frontiers and places that failed or were visited.
#[derive(Clone, Debug)]
pub struct Blacklist {
    config: TabooConfig,
    thresholds: Thresholds,
    entries: Vec<Entry>,
    refused: Vec<Refused>,
    visits: Vec<Visit>,
    /// The version of the map that was looked at last.
    version: u64,
}

/// Places to stand within this distance are the same, and one nearer to a frontier by more is
/// worth another visit, metres.
pub const SAME_PLACE_M: f64 = 0.25;
/// The circle around a target grows by this share of itself with each round that it failed in, so
/// many times at most.
const GROWTH: f64 = 0.5;
const MOST_GROWTHS: u32 = 4;

impl Blacklist {
    /// An empty list; the thresholds tell what is open on the map.
    #[must_use]
    pub const fn new(config: TabooConfig, thresholds: Thresholds) -> Self {
        Self { config, thresholds, entries: Vec::new(), refused: Vec::new(), visits: Vec::new(), version: 0 }
    }

    /// A goal failed; the map is the one that was there.
    pub fn record_failure(&mut self, failure: &Failure<'_>, map: Option<&MapSnapshot>) {
        let Failure { target, place, from, why } = *failure;
        let around = [place, target].map(|point| Surroundings::of(map, point, &self.thresholds));
        let entry = self.entry(target);
        entry.failures += 1;
        entry.this_round += 1;
        entry.place = place;
        why.clone_into(&mut entry.why);
        self.refused.push(Refused { place, from, target, around });
    }

    /// The robot was at a place to see a target, and a newer map shows no change.
    pub fn record_visit(&mut self, target: Point, place: Point) {
        self.visits.push(Visit { place, target });
    }

    /// Whether driving to a frontier with this point has failed too often in this round.
    #[must_use]
    pub fn has_failed(&self, target: Point) -> bool {
        let away_m = |entry: &Entry| nalgebra::distance(&entry.target, &target);
        let is_tried = self.entries.iter().any(|e| away_m(e) <= self.config.radius_m && e.this_round > 0);
        let is_near = |e: &Entry| away_m(e) <= if is_tried { self.radius_m(e) } else { self.config.radius_m };
        self.entries.iter().any(|e| self.is_taboo(e) && is_near(e))
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
        let (max, last_chance) = (self.config.max_failures, self.config.max_failures.saturating_sub(1));
        for entry in &mut self.entries {
            entry.rounds += u32::from(entry.failures >= max);
            entry.this_round = 0;
            entry.failures = entry.failures.min(last_chance);
        }
    }

    /// What failed from near a place is not to blame: the robot could not get away.
    pub fn forgive_from(&mut self, from: Point, radius_m: f64) {
        let (forgiven, kept): (Vec<Refused>, _) =
            self.refused.drain(..).partition(|refused| nalgebra::distance(&refused.from, &from) <= radius_m);
        self.refused = kept;
        for refused in forgiven {
            self.forget(refused.target);
        }
    }

    /// Forgets what failed where the map has opened since, unless failures are final; the targets
    /// that are left alone no longer. O(failures of this round), and a look at two squares of two
    /// metres for each where the map changed there.
    pub fn look_again(&mut self, map: &MapSnapshot) -> Vec<Point> {
        let changed = map.changes.since(self.version);
        self.version = map.version();
        if self.config.is_final || self.refused.is_empty() || changed.is_some_and(|changed| changed.is_empty()) {
            return Vec::new();
        }
        let (mut opened, mut kept) = (Vec::new(), Vec::new());
        for refused in std::mem::take(&mut self.refused) {
            let openings = self.entry(refused.target).openings;
            let has_opened = |(before, point): (&Surroundings, Point)| {
                before.has_opened(map, point, changed.as_ref(), &self.thresholds, openings)
            };
            let points = [refused.place, refused.target];
            let is_open = refused.around.iter().zip(points).any(has_opened);
            if is_open { opened.push(refused) } else { kept.push(refused) }
        }
        self.refused = kept;
        let was_taboo: Vec<Point> =
            opened.iter().map(|refused| refused.target).filter(|&target| self.has_failed(target)).collect();
        for refused in opened {
            self.forget(refused.target);
            self.entry(refused.target).openings += 1;
        }
        was_taboo.into_iter().filter(|&target| !self.has_failed(target)).collect()
    }

    /// What failed in this round and is not forgiven yet.
    #[must_use]
    pub fn listed(&self) -> Vec<Blacklisted> {
        let is_listed = |entry: &&Entry| entry.this_round > 0;
        let listed = |entry: &Entry| Blacklisted {
            target: entry.target,
            place: entry.place,
            radius_m: self.radius_m(entry),
            failures: entry.this_round,
            is_left_alone: self.is_taboo(entry),
            why: entry.why.clone(),
            forgiven: if self.config.is_final { Forgiven::Never } else { Forgiven::AfterRound },
        };
        self.entries.iter().filter(is_listed).map(listed).collect()
    }

    /// Forgets everything, also visits in vain and what is final; how many targets had failed in
    /// this round.
    pub fn clear(&mut self) -> usize {
        let failed = self.entries.iter().filter(|entry| entry.this_round > 0).count();
        *self = Self { version: self.version, ..Self::new(self.config, self.thresholds) };
        failed
    }

    /// Judges by other numbers from now on, also what failed before.
    pub const fn set_config(&mut self, config: TabooConfig) {
        self.config = config;
    }

    const fn is_taboo(&self, entry: &Entry) -> bool {
        entry.failures >= self.config.max_failures
    }

    /// How far around a target those that failed too are left with it, metres.
    fn radius_m(&self, entry: &Entry) -> f64 {
        self.config.radius_m * (1.0 + GROWTH * f64::from(entry.rounds.min(MOST_GROWTHS)))
    }

    /// Takes one failure off a target.
    fn forget(&mut self, target: Point) {
        let entry = self.entry(target);
        entry.failures = entry.failures.saturating_sub(1);
        entry.this_round = entry.this_round.saturating_sub(1);
    }

    fn entry(&mut self, target: Point) -> &mut Entry {
        let radius_m = self.config.radius_m;
        let known = self.entries.iter().position(|e| nalgebra::distance(&e.target, &target) <= radius_m);
        let index = known.unwrap_or_else(|| {
            let (place, why) = (target, String::new());
            self.entries.push(Entry { target, failures: 0, this_round: 0, rounds: 0, openings: 0, place, why });
            self.entries.len() - 1
        });
        &mut self.entries[index]
    }
}

#[cfg(test)]
#[path = "blacklist_tests.rs"]
mod tests;
