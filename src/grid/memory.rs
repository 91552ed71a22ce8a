//! A map of an earlier session below the one that grows now: what was explored stays explored.
//!
//! Both are in the same frame, as when the SLAM goes on, or has found itself in the old map.
//! Where that is not so, the walls of the two do not lie on each other, and nothing of the old
//! one may be believed.

use super::{Cell, GridInfo, OccupancyGrid, Thresholds};
use crate::geometry::Pose;

/// Walls this near to each other are the same, cells: a SLAM does not draw them twice alike.
const SAME_WALL_CELLS: i32 = 2;
/// Fewer walls than this that both maps know say nothing, cells.
const FEWEST_WALLS: usize = 60;
/// Less of them on each other is another place, or another frame.
const LEAST_SHARE: f64 = 0.5;

/// The map of an earlier session.
#[derive(Clone, Debug)]
pub struct MapMemory {
    earlier: OccupancyGrid,
    thresholds: Thresholds,
    /// The earlier cells as they lie around a newer map of this size and place.
    around: Option<(GridInfo, OccupancyGrid, Cell)>,
}

impl MapMemory {
    /// Remembers a map.
    #[must_use]
    pub const fn new(earlier: OccupancyGrid, thresholds: Thresholds) -> Self {
        Self { earlier, thresholds, around: None }
    }

    /// The newer map where it knows something, and the earlier one elsewhere, in the cells of
    /// the newer one. Where both together are too large, the newer one alone.
    pub fn below(&mut self, newer: &OccupancyGrid) -> OccupancyGrid {
        let info = *newer.info();
        if self.around.as_ref().is_none_or(|(known, ..)| *known != info) {
            self.around = self.lie_around(&info).map(|(grid, corner)| (info, grid, corner));
        }
        let Some((_, around, corner)) = &self.around else { return newer.clone() };
        let mut joined = around.clone();
        let width = joined.info().width();
        let rows = newer.data().chunks_exact(info.width());
        for (row, cells) in rows.enumerate() {
            let begin = (row + corner.y as usize) * width + corner.x as usize;
            for (below, &cell) in joined.data_mut()[begin..begin + cells.len()].iter_mut().zip(cells) {
                if is_known(cell) {
                    *below = cell;
                }
            }
        }
        joined
    }

    /// The share of the earlier walls that a newer map sees, too, of those that it would have to;
    /// nothing where these are too few.
    #[must_use]
    pub fn agreement(&self, newer: &OccupancyGrid) -> Option<f64> {
        let is_wall = |value: i8| value >= self.thresholds.occupied_min;
        let info = self.earlier.info();
        let (mut seen, mut expected) = (0, 0);
        for (index, _) in
            self.earlier.data().iter().enumerate().filter(|&(_, &value)| is_known(value) && is_wall(value))
        {
            let at = info.center(info.cell(index));
            let cell = newer.info().cell_at(at);
            if newer.get(cell).is_none_or(|value| !is_known(value)) {
                continue;
            }
            expected += 1;
            let near = -SAME_WALL_CELLS..=SAME_WALL_CELLS;
            let around = near.clone().flat_map(|dy| near.clone().map(move |dx| Cell::new(cell.x + dx, cell.y + dy)));
            seen +=
                usize::from(around.filter_map(|cell| newer.get(cell)).any(|value| is_known(value) && is_wall(value)));
        }
        (expected >= FEWEST_WALLS).then(|| seen as f64 / expected as f64)
    }

    /// Whether the walls of both maps contradict each other.
    #[must_use]
    pub fn contradicts(&self, newer: &OccupancyGrid) -> bool {
        self.agreement(newer).is_some_and(|share| share < LEAST_SHARE)
    }

    /// The earlier cells on the lattice of a newer map, so that they enclose it, and the cell
    /// where it begins.
    fn lie_around(&self, newer: &GridInfo) -> Option<(OccupancyGrid, Cell)> {
        let earlier = self.earlier.info();
        let (width, height) = (earlier.width() as f64, earlier.height() as f64);
        let corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)]
            .map(|(x, y)| newer.to_grid_units(earlier.from_grid_units(x, y)));
        let least = |of: fn(&(f64, f64)) -> f64| corners.iter().map(of).fold(0.0, f64::min).floor();
        let most = |of: fn(&(f64, f64)) -> f64, size: usize| corners.iter().map(of).fold(size as f64, f64::max).ceil();
        let (left, bottom) = (least(|c| c.0), least(|c| c.1));
        let (right, top) = (most(|c| c.0, newer.width()), most(|c| c.1, newer.height()));
        let origin = newer.from_grid_units(left, bottom);
        let origin = Pose::new(origin.x, origin.y, newer.origin_in_map().yaw);
        // What is too large does not fit the numbers, and is refused.
        let info = GridInfo::new((right - left) as u32, (top - bottom) as u32, newer.resolution_m(), origin).ok()?;
        let mut grid = OccupancyGrid::filled(info, -1);
        for (index, value) in grid.data_mut().iter_mut().enumerate() {
            let at = info.center(info.cell(index));
            *value = self.earlier.get(earlier.cell_at(at)).unwrap_or(-1);
        }
        Some((grid, Cell::new(-left as i32, -bottom as i32)))
    }
}

const fn is_known(value: i8) -> bool {
    value >= 0 && value <= 100
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A room of so many cells with a wall around it, and its lower left corner in metres.
    fn room(width: u32, height: u32, resolution_m: f64, x: f64, y: f64) -> OccupancyGrid {
        let info = GridInfo::new(width, height, resolution_m, Pose::new(x, y, 0.0)).unwrap();
        let mut grid = OccupancyGrid::filled(info, 0);
        for (index, value) in grid.data_mut().iter_mut().enumerate() {
            let (column, row) = (index as u32 % width, index as u32 / width);
            if column == 0 || row == 0 || column == width - 1 || row == height - 1 {
                *value = 100;
            }
        }
        grid
    }

    #[test]
    fn the_newer_map_lies_on_the_earlier_one() {
        let mut memory = MapMemory::new(room(40, 30, 0.1, -1.0, -2.0), Thresholds::default());
        let info = GridInfo::new(20, 20, 0.05, Pose::new(0.02, 0.0, 0.0)).unwrap();
        let mut newer = OccupancyGrid::filled(info, -1);
        newer.set(Cell::new(3, 4), 100);
        let joined = memory.below(&newer);
        let at = |x: f64, y: f64| joined.get(joined.info().cell_at(crate::geometry::Point::new(x, y)));
        assert_eq!(at(0.02 + 0.175, 0.225), Some(100), "what is new");
        assert_eq!(at(0.5, 0.5), Some(0), "what was explored stays so");
        assert_eq!((at(-0.95, 0.0), at(2.5, 0.5)), (Some(100), Some(0)), "also outside the newer map");
        assert_eq!(joined.info().resolution_m(), 0.05);
        assert_eq!(joined.info().offset_of(newer.info()).map(|(x, y)| (x.abs(), y.abs())), Some((21, 40)));
        assert_eq!(memory.below(&newer), joined, "and again");
    }

    #[test]
    fn walls_that_do_not_lie_on_each_other_contradict() {
        let memory = MapMemory::new(room(80, 60, 0.05, 0.0, 0.0), Thresholds::default());
        let same = room(80, 60, 0.05, 0.05, 0.0);
        assert!(memory.agreement(&same).unwrap() > 0.9 && !memory.contradicts(&same), "a cell of drift");
        let elsewhere = room(200, 200, 0.05, -4.0, -4.0);
        assert!(memory.agreement(&elsewhere).unwrap() < 0.1 && memory.contradicts(&elsewhere));
        let unknown = OccupancyGrid::filled(*same.info(), -1);
        assert_eq!((memory.agreement(&unknown), memory.contradicts(&unknown)), (None, false));
    }
}
