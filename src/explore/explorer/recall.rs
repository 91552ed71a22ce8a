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

    /// Goes on with what an earlier session knew. Numbers that nobody can have counted to are held
    /// at what can be.
    pub fn recall(&mut self, memory: &Memory) {
        self.start_pose = memory.home.or(self.start_pose);
        self.counts = memory.counts.believable();
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Preset, builtin_robot};
    use crate::grid::OccupancyGrid;
    use crate::robot::{MapSnapshot, Navigation, NavigationState, Observation};
    use std::sync::Arc;

    #[test]
    fn a_memory_with_numbers_beyond_all_counting_is_gone_on_with() {
        let robot = builtin_robot("turtlebot2").unwrap().traits();
        let mut explorer = Explorer::new(Preset::built_in("tour").unwrap().explorer, &robot).unwrap();
        let failed = serde_json::json!({
            "target": [5.0, 4.5], "place": [5.0, 4.5], "failures": u32::MAX, "this_round": u32::MAX,
            "rounds": u32::MAX, "openings": u32::MAX, "why": "",
        });
        let counts = Counts { detections: usize::MAX, goals_sent: usize::MAX, ..Counts::default() };
        let left_alone = serde_json::from_value(serde_json::json!({"failed": [failed], "visits": []})).unwrap();
        explorer.recall(&Memory { counts, left_alone, ..Memory::default() });
        let map = OccupancyGrid::from_ascii(&["#.......????"; 8].join("\n")).unwrap();
        explorer.step(&Observation {
            stamp_s: 0.0,
            pose_in_map: Ok(Pose::new(2.5, 4.5, 0.0)),
            map: Some(MapSnapshot::alone(0.0, 1, Arc::new(map))),
            scan: None,
            navigation: Navigation { command: 0, state: NavigationState::Idle },
        });
        assert!(explorer.counts().detections < usize::MAX && explorer.counts().goals_sent < usize::MAX);
        assert_eq!(explorer.memory().left_alone.failed(), 1);
    }
}
