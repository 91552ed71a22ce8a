//! How far it is from the robot to everywhere at once.

use super::PlanError;
use super::endpoints::start_index;
use super::lattice::{Lattice, STRAIGHT};
use super::search::Search;
use crate::geometry::Pose;
use crate::grid::{Cell, Costmap};
use std::sync::Arc;

/// The cheapest way from the robot to every cell of a costmap: one search serves all
/// candidates of a decision.
#[derive(Clone, Debug)]
pub struct PathField {
    costmap: Arc<Costmap>,
    search: Search,
}

impl PathField {
    /// Searches the whole costmap from the robot's pose.
    ///
    /// # Errors
    /// [`PlanError::StartOutsideMap`] or [`PlanError::StartOccupied`].
    pub fn new(costmap: Arc<Costmap>, robot_in_map: &Pose) -> Result<Self, PlanError> {
        let start = start_index(&costmap, robot_in_map)?;
        let mut search = Search::default();
        search.run(&Lattice::new(&costmap), start, None, false);
        Ok(Self { costmap, search })
    }

    /// The costmap that was searched.
    #[must_use]
    pub fn costmap(&self) -> &Costmap {
        &self.costmap
    }

    /// Whether the robot can get to a cell.
    #[must_use]
    pub fn reaches(&self, cell: Cell) -> bool {
        self.cost_cells(cell).is_some()
    }

    /// Cost of the cheapest way to a cell, as the number of open cells that cost as
    /// much; `None` when there is no way.
    #[must_use]
    pub fn cost_cells(&self, cell: Cell) -> Option<f64> {
        let index = self.costmap.info().index(cell)?;
        self.search.cost(index).map(|cost| f64::from(cost) / f64::from(STRAIGHT))
    }

    /// Length in metres of the cheapest way to a cell; `None` when there is no way.
    #[must_use]
    pub fn length_m(&self, cell: Cell) -> Option<f64> {
        let info = self.costmap.info();
        let index = info.index(cell)?;
        self.search.cost(index)?;
        let way = self.search.way(&Lattice::new(&self.costmap), index);
        let cells: f64 =
            way.windows(2).map(|pair| (info.cell(pair[0]).distance_squared(info.cell(pair[1])) as f64).sqrt()).sum();
        Some(cells * info.resolution_m())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Inflation, OccupancyGrid, Thresholds};

    #[test]
    fn lengths_lead_round_walls_and_stop_at_them() {
        let grid = OccupancyGrid::from_ascii("...#.\n.#.#.\n.#.#.").unwrap();
        let bare = Inflation { inscribed_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };
        let costmap = Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &bare));
        let field = PathField::new(costmap, &Pose::new(0.5, 0.5, 0.0)).unwrap();
        assert_eq!(field.length_m(Cell::new(2, 0)), Some(6.0));
        assert_eq!(field.cost_cells(Cell::new(2, 0)), Some(6.0));
        assert!(!field.reaches(Cell::new(4, 0)) && !field.reaches(Cell::new(1, 0)));
    }
}
