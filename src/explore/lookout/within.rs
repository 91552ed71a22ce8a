//! What lies inside of the areas that the robot keeps to.

use super::Lookout;
use crate::frontier::{DetectError, Frontier};
use crate::geometry::{Areas, Pose};
use crate::grid::{AreaCells, Cell, Census, GridInfo};
use crate::planning::Whereabouts;
use crate::robot::MapSnapshot;

impl Lookout {
    /// Keeps to other areas.
    pub fn set_areas(&mut self, areas: &Areas) {
        self.costs.set_areas(areas);
    }

    /// Where the robot stood at the last decision.
    pub const fn whereabouts(&self) -> Whereabouts {
        self.costs.fence.whereabouts()
    }

    /// How many cells of a map are free, occupied and unknown, inside of the areas.
    pub fn census(&mut self, map: &MapSnapshot) -> Census {
        let inside = self.costs.fence.cells_of(map.grid.info());
        let all = || map.grid.census(&self.thresholds);
        inside.map_or_else(all, |cells| cells.census(&map.grid, &self.thresholds))
    }

    /// The audit's frontiers, cut where the areas end.
    ///
    /// # Errors
    /// [`DetectError`] when the map gives no answer.
    pub(super) fn audit_frontiers(&mut self, map: &MapSnapshot, robot: Pose) -> Result<Vec<Frontier>, DetectError> {
        let frontiers = self.audit.frontiers(map, robot)?;
        Ok(self.within(frontiers, map.grid.info(), self.audit.min_size_m()))
    }

    /// Frontiers cut where the areas end: each lies inside or outside with all of its cells. What
    /// is left inside of a frontier counts from a size in metres on.
    pub(super) fn within(&mut self, frontiers: Vec<Frontier>, info: &GridInfo, min_size_m: f64) -> Vec<Frontier> {
        let Some(cells) = self.costs.fence.cells_of(info) else { return frontiers };
        let mut parts = Vec::with_capacity(frontiers.len());
        for frontier in frontiers {
            parts.extend(cut(frontier, &cells, info, min_size_m));
        }
        // The audit's are known by their numbers.
        for (frontier, id) in parts.iter_mut().zip(0..) {
            frontier.id = id;
        }
        parts
    }
}

fn cut(frontier: Frontier, cells: &AreaCells, info: &GridInfo, min_size_m: f64) -> Vec<Frontier> {
    let (inside, outside): (Vec<Cell>, Vec<Cell>) = frontier.cells.iter().partition(|&&cell| cells.is_inside(cell));
    if inside.is_empty() || outside.is_empty() {
        return vec![frontier];
    }
    let part = |cells: Vec<Cell>| Frontier { cells: cells.into(), circle: None, ..frontier };
    let is_enough = inside.len() as f64 * info.resolution_m() >= min_size_m;
    let parts = [is_enough.then(|| part(inside)), Some(part(outside))];
    parts.into_iter().flatten().collect()
}
