//! What is left alone, as it is written down for a later session.

use super::{Blacklist, Entry, Visit};
use crate::geometry::Point;
use serde::{Deserialize, Serialize};

/// A file may say that a target failed so often: more would soon not fit the numbers.
const MOST: u32 = 1_000_000;

/// A target that failed. Points are metres of the map frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SavedEntry {
    target: [f64; 2],
    place: [f64; 2],
    failures: u32,
    this_round: u32,
    rounds: u32,
    openings: u32,
    why: String,
}

/// The targets that failed and the visits in vain. Which places to stand were refused in the round
/// under way is not kept: they are tried once more.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SavedBlacklist {
    failed: Vec<SavedEntry>,
    /// From where, and what was to be seen.
    visits: Vec<([f64; 2], [f64; 2])>,
}

impl SavedBlacklist {
    /// How many targets failed.
    #[must_use]
    pub const fn failed(&self) -> usize {
        self.failed.len()
    }
}

impl Blacklist {
    /// Writes it down.
    pub fn save(&self) -> SavedBlacklist {
        let saved = |entry: &Entry| SavedEntry {
            target: entry.target.into(),
            place: entry.place.into(),
            failures: entry.failures,
            this_round: entry.this_round,
            rounds: entry.rounds,
            openings: entry.openings,
            why: entry.why.clone(),
        };
        SavedBlacklist {
            failed: self.entries.iter().map(saved).collect(),
            visits: self.visits.iter().map(|visit| (visit.place.into(), visit.target.into())).collect(),
        }
    }

    /// Takes over what was written down, in place of what is known.
    pub fn restore(&mut self, saved: &SavedBlacklist) {
        let entry = |saved: &SavedEntry| Entry {
            target: Point::from(saved.target),
            place: Point::from(saved.place),
            failures: saved.failures.min(MOST),
            this_round: saved.this_round.min(MOST),
            rounds: saved.rounds.min(MOST),
            openings: saved.openings.min(MOST),
            why: saved.why.clone(),
        };
        self.clear();
        self.entries = saved.failed.iter().map(entry).collect();
        let visit = |&(place, target): &([f64; 2], [f64; 2])| Visit { place: place.into(), target: target.into() };
        self.visits = saved.visits.iter().map(visit).collect();
    }
}
