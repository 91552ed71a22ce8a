//! What may be exchanged while a run goes on: the region, the strategy, the planner.

use super::Explorer;
use crate::geometry::Polygon;
use crate::planning::GlobalPlanner;
use crate::selection::GoalSelector;

impl Explorer {
    /// Explores only inside a region from now on, or everywhere again.
    pub fn set_region(&mut self, region: Option<Polygon>) {
        self.settings.region = region;
    }

    /// Only frontiers inside are explored, if there is one.
    #[must_use]
    pub const fn region(&self) -> Option<&Polygon> {
        self.settings.region.as_ref()
    }

    /// Forgets what failed and what was visited in vain; returns how many places that were.
    pub fn clear_blacklist(&mut self) -> usize {
        self.blacklist.clear()
    }

    /// Chooses goals by another strategy than the settings name, such as one of one's own.
    pub fn set_selector(&mut self, selector: Box<dyn GoalSelector>) {
        self.lookout.set_selector(selector);
    }

    /// Asks another planner for the way to a candidate, such as move_base's own.
    pub fn set_planner(&mut self, planner: Box<dyn GlobalPlanner>) {
        self.lookout.set_planner(planner);
    }
}
