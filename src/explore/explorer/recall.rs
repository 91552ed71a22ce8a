//! What an explorer knows beside the map, for a later session that goes on where it was.

use super::super::blacklist::SavedBlacklist;
use super::super::ledger::TimeSpent;
use super::super::record::Counts;
use super::Explorer;
use crate::geometry::Pose;
use serde::{Deserialize, Serialize};

/// What was done, where home is, and what is left alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Memory {
    /// Where the robot was first seen, in the map frame.
    pub home: Option<Pose>,
    /// What was done.
    pub counts: Counts,
    /// Where the time went.
    pub time_spent: TimeSpent,
    /// What failed or was visited in vain.
    pub left_alone: SavedBlacklist,
}

impl Explorer {
    /// What it knows beside the map.
    #[must_use]
    pub fn memory(&self) -> Memory {
        Memory {
            home: self.start_pose,
            counts: self.counts,
            time_spent: *self.time_spent(),
            left_alone: self.blacklist.save(),
        }
    }

    /// Goes on with what an earlier session knew.
    pub fn recall(&mut self, memory: &Memory) {
        self.start_pose = memory.home.or(self.start_pose);
        self.counts = memory.counts;
        self.ledger.go_on_from(memory.time_spent);
        self.blacklist.restore(&memory.left_alone);
    }

    /// Forgets all places, as those of another frame: what is left alone, and home, which is where
    /// the robot is seen next.
    pub fn forget_places(&mut self) {
        self.clear_blacklist();
        self.start_pose = None;
    }
}
