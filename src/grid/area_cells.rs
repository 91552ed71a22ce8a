//! Which cells of a grid lie in areas drawn in metres.

use super::{Cell, CellRect, Census, Changes, GridInfo, Growth, OccupancyGrid, Thresholds, squared_distance_cells};
use crate::geometry::{Areas, Polygon, spans_at};
use std::ops::Range;
use std::sync::Arc;

/// The cell lies outside of the region.
const OUTSIDE: u8 = 1;
/// The cell lies in a no-go area.
const NO_GO: u8 = 2;
/// The cell is too near to a no-go area for the robot's body.
const NEAR_NO_GO: u8 = 4;

/// The cells of a grid by the areas that they lie in: a cell counts by its centre.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AreaCells {
    width: usize,
    flags: Vec<u8>,
}

impl AreaCells {
    /// The cells of a grid; the robot's centre keeps `margin_m` metres from no-go areas.
    /// O(rows x corners + cells).
    #[must_use]
    pub fn of(info: &GridInfo, areas: &Areas, margin_m: f64) -> Self {
        let begin = if areas.region.is_some() { OUTSIDE } else { 0 };
        let mut flags = vec![begin; info.len()];
        if let Some(region) = &areas.region {
            for_each_run(info, region, |run| flags[run].fill(0));
        }
        for area in &areas.no_go {
            for_each_run(info, area, |run| flags[run].iter_mut().for_each(|flags| *flags |= NO_GO));
        }
        let margin_cells = info.cells(margin_m);
        if margin_cells > 0.0 && flags.iter().any(|flags| flags & NO_GO != 0) {
            let squared = squared_distance_cells(info, |index| flags[index] & NO_GO != 0);
            for (flags, squared) in flags.iter_mut().zip(squared) {
                if *flags & NO_GO == 0 && f64::from(squared) <= margin_cells * margin_cells {
                    *flags |= NEAR_NO_GO;
                }
            }
        }
        Self { width: info.width(), flags }
    }

    /// Whether a cell lies in the region and in no no-go area; outside of the grid none does.
    #[must_use]
    pub fn is_inside(&self, cell: Cell) -> bool {
        self.flags_of(cell).is_some_and(|flags| flags & (OUTSIDE | NO_GO) == 0)
    }

    /// Whether a cell lies outside of the region.
    #[must_use]
    pub fn is_outside_region(&self, cell: Cell) -> bool {
        self.flags_of(cell).is_none_or(|flags| flags & OUTSIDE != 0)
    }

    /// Whether a cell lies in a no-go area, or too near to one.
    #[must_use]
    pub fn is_near_no_go(&self, cell: Cell) -> bool {
        self.flags_of(cell).is_some_and(|flags| flags & (NO_GO | NEAR_NO_GO) != 0)
    }

    /// The smallest rectangle that holds all cells that lay in other areas before a grid grew: a centre on
    /// a border may come to lie beside it.
    pub(crate) fn changed_since(&self, last: &Self, growth: &Growth) -> CellRect {
        let all = CellRect::of(growth.new_info());
        growth.changed([&last.flags, &self.flags], &all).unwrap_or_default()
    }

    fn flags_of(&self, cell: Cell) -> Option<u8> {
        let (x, y) = (usize::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
        if x < self.width { self.flags.get(y * self.width + x).copied() } else { None }
    }

    /// How many cells of a rectangle of the grid inside of the areas are free, occupied and unknown.
    fn census_of(&self, grid: &OccupancyGrid, part: &CellRect, thresholds: &Thresholds) -> Census {
        let (width, rows, columns) = (self.width, part.rows(grid.info()), part.columns(grid.info()));
        let mut census = Census::default();
        for y in rows {
            let row = y * width + columns.start..y * width + columns.end;
            let inside = |flags: &u8| flags & (OUTSIDE | NO_GO) == 0;
            let cells = grid.data()[row.clone()].iter().zip(&self.flags[row]);
            cells.filter(|(_, flags)| inside(flags)).for_each(|(&value, _)| census.add(thresholds.classify(value)));
        }
        census
    }

    /// How many cells inside of the areas are free, occupied and unknown.
    #[must_use]
    pub fn census(&self, grid: &OccupancyGrid, thresholds: &Thresholds) -> Census {
        self.census_of(grid, &CellRect::of(grid.info()), thresholds)
    }
}

/// The census of a map that changes, of the cells inside of areas.
#[derive(Clone, Debug)]
pub struct AreaCensus {
    thresholds: Thresholds,
    areas: Areas,
    cells: Option<(GridInfo, AreaCells)>,
    /// The last map with its version and counts.
    last: Option<(Arc<OccupancyGrid>, u64, Census)>,
}

impl AreaCensus {
    /// No map yet, and no areas.
    #[must_use]
    pub const fn new(thresholds: Thresholds) -> Self {
        Self { thresholds, areas: Areas { region: None, no_go: Vec::new() }, cells: None, last: None }
    }

    /// Counts inside of these areas from now on.
    pub fn set_areas(&mut self, areas: &Areas) {
        if self.areas != *areas {
            (self.areas, self.cells, self.last) = (areas.clone(), None, None);
        }
    }

    /// The census of a version of the map. O(cells that changed since the last call) where that
    /// is known.
    pub fn update(&mut self, grid: &Arc<OccupancyGrid>, changes: &Changes) -> Census {
        let info = *grid.info();
        let is_known = self.cells.as_ref().is_some_and(|(known, _)| *known == info);
        if !self.areas.are_everywhere() && !is_known {
            (self.cells, self.last) = (Some((info, AreaCells::of(&info, &self.areas, 0.0))), None);
        }
        let count = |grid: &OccupancyGrid, part: &CellRect| match &self.cells {
            Some((_, cells)) => cells.census_of(grid, part, &self.thresholds),
            None => grid.census_of(part, &self.thresholds),
        };
        let from_last = self.last.as_ref().and_then(|(last, version, census)| {
            census.since(&changes.since_on((*version, last.info()), &info), [last, grid], count)
        });
        let census = from_last.unwrap_or_else(|| count(grid, &CellRect::of(&info)));
        self.last = Some((Arc::clone(grid), changes.version(), census));
        census
    }
}

/// The row-major runs of cells whose centres lie in a polygon.
fn for_each_run(info: &GridInfo, polygon: &Polygon, mut each: impl FnMut(Range<usize>)) {
    let corners: Vec<(f64, f64)> = polygon.corners().iter().map(|&corner| info.to_grid_units(corner)).collect();
    let column = |x: f64| (x - 0.5).ceil().clamp(0.0, info.width() as f64) as usize;
    for row in 0..info.height() {
        for (from, to) in spans_at(&corners, row as f64 + 0.5) {
            let (from, to) = (column(from), column(to));
            if from < to {
                each(row * info.width() + from..row * info.width() + to);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Pose};
    use crate::grid::{GridPatch, Live};
    use proptest::prelude::*;

    fn polygon(corners: &[(f64, f64)]) -> Polygon {
        Polygon::new(corners.iter().map(|&(x, y)| Point::new(x, y)).collect()).unwrap()
    }

    proptest! {
        /// Against the polygons themselves, on grids that are turned.
        #[test]
        fn cells_lie_where_their_centres_do(
            corners in proptest::collection::vec((-3.0..9.0f64, -3.0..9.0f64), 6),
            yaw in -3.0..3.0f64,
        ) {
            let triangle = |from: usize| {
                let corners = corners[from..from + 3].iter().map(|&(x, y)| Point::new(x, y)).collect();
                Polygon::new(corners).ok()
            };
            prop_assume!(triangle(0).is_some() && triangle(3).is_some());
            let areas = Areas { region: triangle(0), no_go: triangle(3).into_iter().collect() };
            let info = GridInfo::new(23, 17, 0.31, Pose::new(1.0, -0.5, yaw)).unwrap();
            let cells = AreaCells::of(&info, &areas, 0.0);
            for index in 0..info.len() {
                let cell = info.cell(index);
                prop_assert_eq!(cells.is_inside(cell), areas.contain(info.center(cell)), "{:?}", cell);
            }
            prop_assert!(!cells.is_inside(Cell::new(-1, 0)) && !cells.is_inside(Cell::new(23, 0)));
        }
    }

    #[test]
    fn a_margin_is_kept_from_no_go_areas_alone() {
        let info = GridInfo::new(20, 1, 0.1, Pose::default()).unwrap();
        let areas = Areas {
            region: Some(polygon(&[(0.0, -1.0), (1.5, -1.0), (1.5, 1.0), (0.0, 1.0)])),
            no_go: vec![polygon(&[(0.5, -1.0), (0.8, -1.0), (0.8, 1.0), (0.5, 1.0)])],
        };
        let cells = AreaCells::of(&info, &areas, 0.2);
        let all = |is: &dyn Fn(Cell) -> bool| (0..20).filter(|&x| is(Cell::new(x, 0))).collect::<Vec<i32>>();
        assert_eq!(all(&|cell| cells.is_near_no_go(cell)), [3, 4, 5, 6, 7, 8, 9]);
        assert_eq!(all(&|cell| cells.is_outside_region(cell)), [15, 16, 17, 18, 19]);
        assert_eq!(all(&|cell| cells.is_inside(cell)), [0, 1, 2, 3, 4, 8, 9, 10, 11, 12, 13, 14]);
    }

    #[test]
    fn what_changed_inside_is_counted_as_if_all_were() {
        let thresholds = Thresholds::default();
        let mut map = Live::new(Arc::new(OccupancyGrid::from_ascii("?#.?\n....").unwrap()));
        let mut live = AreaCensus::new(thresholds);
        assert_eq!(live.update(map.newest(), map.changes()), map.newest().census(&thresholds));
        let left =
            Areas { region: Some(polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])), no_go: Vec::new() };
        live.set_areas(&left);
        for (x, y, value) in [(0, 1, 100), (3, 1, 100), (1, 0, -1)] {
            map.apply(&GridPatch { corner: Cell::new(x, y), width: 1, height: 1, data: vec![value] }).unwrap();
            let all = AreaCells::of(map.newest().info(), &left, 0.0).census(map.newest(), &thresholds);
            assert_eq!(live.update(map.newest(), map.changes()), all);
        }
        let census = live.update(map.newest(), map.changes());
        assert_eq!((census.free, census.occupied, census.unknown), (1, 2, 1));
        map.replace(Arc::new(OccupancyGrid::from_ascii(".\n.\n.").unwrap()));
        assert_eq!(live.update(map.newest(), map.changes()).free, 2, "a map of another size");
        live.set_areas(&Areas::default());
        assert_eq!(live.update(map.newest(), map.changes()).free, 3);
    }
}
