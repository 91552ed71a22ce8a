//! How far it is from the robot to everywhere at once.

use super::PlanError;
use super::canonical::CanonicalSearch;
use super::endpoints::start_index;
use super::lattice::STRAIGHT;
use super::reach::{connected, passable};
use crate::bits::BitPlane;
use crate::bits::runs::runs_of;
use crate::geometry::Pose;
use crate::grid::{Cell, Costmap};
use std::sync::Arc;

/// Where the robot can get to, and if asked for the cheapest way to every cell of it: one
/// search serves all candidates of a decision.
#[derive(Clone, Debug)]
pub struct PathField {
    costmap: Arc<Costmap>,
    reach: BitPlane,
    /// What it costs to get there.
    ways: Option<CanonicalSearch>,
}

impl PathField {
    /// Searches the whole costmap from the robot's pose for the cheapest ways.
    ///
    /// # Errors
    /// [`PlanError::StartOutsideMap`] or [`PlanError::StartOccupied`].
    pub fn new(costmap: Arc<Costmap>, robot_in_map: &Pose) -> Result<Self, PlanError> {
        let passable = passable(&costmap);
        Self::on(costmap, &passable, robot_in_map, true)
    }

    /// Finds out which cells can be reached and no more, which is many times faster.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn reach_only(costmap: Arc<Costmap>, robot_in_map: &Pose) -> Result<Self, PlanError> {
        let passable = passable(&costmap);
        Self::on(costmap, &passable, robot_in_map, false)
    }

    /// The same where the passable cells of the costmap are known, as by
    /// [`Passable`](super::Passable); with or without the ways.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on(
        costmap: Arc<Costmap>,
        passable: &BitPlane,
        robot_in_map: &Pose,
        with_ways: bool,
    ) -> Result<Self, PlanError> {
        let start = start_index(&costmap, robot_in_map)?;
        let reach = connected(passable, start);
        let ways = with_ways.then(|| {
            let mut ways = CanonicalSearch::default();
            ways.run(&costmap, start, &reach.bounds());
            ways
        });
        Ok(Self { costmap, reach, ways })
    }

    /// The costmap that was searched.
    #[must_use]
    pub fn costmap(&self) -> &Costmap {
        &self.costmap
    }

    /// The area that the robot's centre can get to, square metres.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.reach.count() as f64 * self.costmap.info().cell_area_m2()
    }

    /// The columns of a row that the robot can get to.
    pub(super) fn reached_in_row(&self, y: usize) -> impl Iterator<Item = usize> + '_ {
        runs_of(self.reach.row(y)).flat_map(|run| run.start as usize..run.end as usize)
    }

    /// Whether the robot can get to a cell.
    #[must_use]
    pub fn reaches(&self, cell: Cell) -> bool {
        self.reach.contains(cell)
    }

    /// Whether the robot can get to any cell that is at most `reach_cells` columns and
    /// rows away from `center`.
    #[must_use]
    pub fn reaches_near(&self, center: Cell, reach_cells: u32) -> bool {
        let within = |center: i32, size: usize| {
            let clamp = |value: i64| value.clamp(0, size as i64) as usize;
            let reach = i64::from(reach_cells);
            clamp(i64::from(center) - reach)..clamp(i64::from(center) + reach + 1)
        };
        let columns = within(center.x, self.reach.width());
        !columns.is_empty()
            && within(center.y, self.reach.height()).any(|y| self.reach.first_in(y, columns.clone()).is_some())
    }

    /// Cost of the cheapest way to a cell, as the number of open cells that cost as
    /// much; `None` when there is no way, or ways were not asked for.
    #[must_use]
    pub fn cost_cells(&self, cell: Cell) -> Option<f64> {
        let index = self.costmap.info().index(cell)?;
        let cost = self.ways.as_ref()?.cost(index)?;
        Some(f64::from(cost) / f64::from(STRAIGHT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{GridInfo, Inflation, OccupancyGrid, Thresholds};
    use proptest::prelude::*;

    const BARE: Inflation =
        Inflation { inscribed_radius_m: 0.0, clear_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };

    #[test]
    fn ways_lead_round_walls_and_stop_at_them() {
        let grid = OccupancyGrid::from_ascii("...#.\n.#.#.\n.#.#.").unwrap();
        let costmap = Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &BARE));
        let field = PathField::new(costmap, &Pose::new(0.5, 0.5, 0.0)).unwrap();
        assert_eq!(field.cost_cells(Cell::new(2, 0)), Some(6.0));
        assert!(!field.reaches(Cell::new(4, 0)) && !field.reaches(Cell::new(1, 0)));
        assert!(!field.reaches(Cell::new(-1, 0)) && field.cost_cells(Cell::new(9, 9)).is_none());
    }

    proptest! {
        #[test]
        fn what_can_be_reached_is_what_has_a_way(
            (width, height, costs) in (1u32..20, 1u32..20).prop_flat_map(|(w, h)| {
                let cost = prop_oneof![3 => Just(0u8), 1 => 0u8..=252, 2 => Just(254u8)];
                (Just(w), Just(h), proptest::collection::vec(cost, (w * h) as usize))
            })
        ) {
            let info = GridInfo::new(width, height, 1.0, Pose::default()).unwrap();
            let mut costs = costs;
            costs[0] = 0;
            let costmap = Arc::new(Costmap::from_costs(info, costs).unwrap());
            let robot = Pose::new(0.5, 0.5, 0.0);
            let ways = PathField::new(Arc::clone(&costmap), &robot).unwrap();
            let reach = PathField::reach_only(costmap, &robot).unwrap();
            for index in 0..info.len() {
                let cell = info.cell(index);
                prop_assert_eq!(ways.cost_cells(cell).is_some(), reach.reaches(cell));
                let around = |c: Cell| (-2..=2).flat_map(move |dy| (-2..=2).map(move |dx| c.offset((dx, dy))));
                prop_assert_eq!(reach.reaches_near(cell, 2), around(cell).any(|c| reach.reaches(c)));
            }
            prop_assert!(!reach.reaches_near(Cell::new(-3, 0), 2) && reach.reaches_near(Cell::new(-2, 0), 2));
        }
    }
}
