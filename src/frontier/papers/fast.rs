//! The Fast Frontier Detector: only what is new is examined.
//!
//! Keidar and Kaminka, "Robot Exploration with Fast Frontier Detection: Theory and
//! Experiments" (AAMAS 2012). The end points of the newest scan, sorted by angle, are
//! joined to a contour by Bresenham's lines; frontier cells on the contour are added to
//! those known from before; known ones inside the active area, the bounding rectangle
//! of the contour and the robot, are dropped when they are frontier cells no longer.
//!
//! What is decided here:
//! * A frontier cell is an open cell beside an unknown one, as in
//!   [`Yamauchi`](super::Yamauchi), so that the two agree where both see everything. The
//!   contour's cells and the eight around each are examined: the rim of a map
//!   and the end of a ray may differ by a cell.
//! * A ray that hit nothing ends where it leaves the map's open cells: mappers clear
//!   less than a lidar's range.
//! * The paper keeps frontiers as lists and splits and merges them; here their cells are
//!   kept and grouped anew, which splits and merges them as well.
//! * The paper's detector is fed every scan by the mapper. One that is asked at times,
//!   with maps that lag, would miss for good what the scans in between uncovered: unless
//!   `changed_cells` is off, the cells that differ from the last map, and the rim of a
//!   map that grew, are examined too. Then the result is that of a full scan.
//! * The state moves along with a map that grows or whose origin moves by whole cells.
//!   Without a scan, on another resolution or orientation, and when called for
//!   the first time, the whole grid is scanned.
//!
//! | parameter | default | paper |
//! |---|---|---|
//! | `changed_cells` | true | false |
//! | `neighbours` | 8 | not said |
//!
//! O(cells of the contour and changed cells) examined; besides, the memory of the grid
//! is swept to compare, to shift and to collect. [`Reachability::WallsBlock`] costs a
//! flood of the free cells at each call; the state is the same for both.

mod contour;
mod params;

pub use params::FastParams;

use crate::frontier::papers::groups::{group, set_cells};
use crate::frontier::papers::territory::{Territory, cells};
use crate::frontier::{
    CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, Reachability, number,
};
use crate::grid::{Cell, CellState, GridInfo, NEIGHBOURS_8, OccupancyGrid};
use contour::contour;

/// The detector, with what it knows from its last call.
///
/// The newest scan points to the right, where a wall came to light; on the left, out of its sight,
/// the unknown was uncovered as well. The paper's detector does not notice the latter:
///
/// ```
/// use frontier_explorer::frontier::{DetectionInput, DetectorParams, Fast, FastParams, FrontierDetector};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::OccupancyGrid;
/// use frontier_explorer::scan::LaserScan;
///
/// let [before, after] = ["?...........?", "#...........#"].map(|map| OccupancyGrid::from_ascii(map).unwrap());
/// let robot = Pose::new(6.5, 0.5, 0.0);
/// let scan = LaserScan { angle_increment_rad: 0.01, range_max_m: 20.0, ranges_m: vec![6.0; 3], ..LaserScan::default() };
/// let left_over = |changed_cells| -> Result<usize, frontier_explorer::frontier::DetectError> {
///     let fast = FastParams { changed_cells };
///     let mut detector = Fast::new(DetectorParams { fast, ..DetectorParams::default() });
///     assert_eq!(detector.detect(&DetectionInput::new(&before, robot))?.len(), 2);
///     Ok(detector.detect(&DetectionInput { scan: Some((&robot, &scan)), ..DetectionInput::new(&after, robot) })?.len())
/// };
/// assert_eq!((left_over(false)?, left_over(true)?), (1, 0));
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fast {
    params: DetectorParams,
    known: Option<Known>,
}

/// The state between two calls.
#[derive(Clone, Debug)]
struct Known {
    info: GridInfo,
    /// Whether each cell is a frontier cell, reachable or not; row-major.
    is_frontier: Vec<bool>,
    /// The map of the last call, where changed cells are looked for.
    grid: Option<OccupancyGrid>,
}

impl Fast {
    /// A detector with these parameters that knows nothing yet.
    #[must_use]
    pub const fn new(params: DetectorParams) -> Self {
        Self { params, known: None }
    }

    /// What is known after a look at this map.
    fn look(&self, input: &DetectionInput<'_>) -> Known {
        self.update(input).unwrap_or_else(|| self.start_over(input.grid))
    }

    /// A scan of the whole grid.
    fn start_over(&self, grid: &OccupancyGrid) -> Known {
        let info = *grid.info();
        let mut is_frontier = vec![false; info.len()];
        let territory = Territory::whole(grid, &self.params.thresholds);
        let found = cells(&territory.open_beside_unknown(self.params.neighbours));
        for index in found.into_iter().filter_map(|cell| info.index(cell)) {
            is_frontier[index] = true;
        }
        Known { info, is_frontier, grid: self.keep(grid) }
    }

    /// What was known, brought up to date; `None` when it cannot be.
    fn update(&self, input: &DetectionInput<'_>) -> Option<Known> {
        let known = self.known.as_ref()?;
        let info = *input.grid.info();
        let shift = Shift::between(&known.info, &info)?;
        let contour = contour(input, &self.params.thresholds)?;
        let mut is_frontier = shift.carry(&known.is_frontier);
        let examine = |cell: Cell, is_frontier: &mut [bool]| {
            if let Some(slot) = info.index(cell).and_then(|index| is_frontier.get_mut(index)) {
                *slot = self.is_frontier(input.grid, cell);
            }
        };
        let around = |cell: Cell| NEIGHBOURS_8.iter().map(move |&offset| cell.offset(offset)).chain([cell]);
        let robot = info.cell_at(input.robot_in_map.position());
        let active = Rectangle::around(contour.iter().copied().chain([robot]));
        for cell in active.cells_within(&info) {
            if info.index(cell).is_some_and(|index| is_frontier[index]) {
                examine(cell, &mut is_frontier);
            }
        }
        for cell in contour.into_iter().flat_map(around) {
            examine(cell, &mut is_frontier);
        }
        if let Some(before) = &known.grid {
            let changed = shift.changed_cells(before, input.grid);
            for cell in changed.into_iter().chain(shift.rim()).flat_map(around) {
                examine(cell, &mut is_frontier);
            }
        }
        Some(Known { info, is_frontier, grid: self.keep(input.grid) })
    }

    fn keep(&self, grid: &OccupancyGrid) -> Option<OccupancyGrid> {
        self.params.fast.changed_cells.then(|| grid.clone())
    }

    fn is_frontier(&self, grid: &OccupancyGrid, cell: Cell) -> bool {
        let state = |cell| grid.state(cell, &self.params.thresholds);
        state(cell) == CellState::Free
            && grid.info().neighbours(cell, self.params.neighbours).any(|n| state(n) == CellState::Unknown)
    }
}

impl FrontierDetector for Fast {
    fn name(&self) -> &'static str {
        "fast"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        // A map without an answer must not become the state of the next call.
        self.params.seed(input.grid, &input.robot_in_map)?;
        let known = self.look(input);
        let info = known.info;
        let mut found = set_cells(&info, &known.is_frontier);
        self.known = Some(known);
        if self.params.reachability == Reachability::WallsBlock {
            let open = Territory::of(input, &self.params)?.open;
            found.retain(|&cell| open.contains(cell));
        }
        let mut frontiers = group(&info, &found, self.params.neighbours);
        let min_cells = self.params.min_cells(&info);
        frontiers.retain(|cells| cells.len() >= min_cells);
        Ok(number(frontiers, CellSide::Free))
    }
}

/// How the cells of one grid are those of another.
struct Shift {
    from: GridInfo,
    to: GridInfo,
    /// Added to a cell of `from` it is the same place in `to`.
    offset: (i32, i32),
}

impl Shift {
    /// `None` when the cells of the two grids are not the same squares of the world.
    fn between(from: &GridInfo, to: &GridInfo) -> Option<Self> {
        let aligned = from.resolution_m() == to.resolution_m() && from.origin_in_map().yaw == to.origin_in_map().yaw;
        let offset = to.offset_of(from).filter(|_| aligned)?;
        Some(Self { from: *from, to: *to, offset })
    }

    /// The rectangle of `to` that both grids have.
    fn overlap(&self) -> Rectangle {
        let (dx, dy) = self.offset;
        Rectangle {
            min: Cell::new(dx.max(0), dy.max(0)),
            max: Cell::new(
                (self.from.width() as i32 + dx).min(self.to.width() as i32) - 1,
                (self.from.height() as i32 + dy).min(self.to.height() as i32) - 1,
            ),
        }
    }

    /// The stretches of the rows that both grids have: where they begin in `from` and
    /// in `to`, by index, and how long they are.
    fn rows(&self) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
        let Rectangle { min, max } = self.overlap();
        let length = usize::try_from(max.x - min.x + 1).unwrap_or_default();
        (min.y..=max.y).filter_map(move |y| {
            let there = Cell::new(min.x, y);
            let here = there.offset((-self.offset.0, -self.offset.1));
            Some((self.from.index(here)?, self.to.index(there)?, length))
        })
    }

    /// Marks of `from` on the cells of `to`; unset where `from` has none.
    fn carry(&self, marks: &[bool]) -> Vec<bool> {
        let mut carried = vec![false; self.to.len()];
        for (here, there, length) in self.rows() {
            carried[there..there + length].copy_from_slice(&marks[here..here + length]);
        }
        carried
    }

    /// The cells of `to` whose values differ, and those known ones that are new.
    fn changed_cells(&self, from: &OccupancyGrid, to: &OccupancyGrid) -> Vec<Cell> {
        let mut changed = Vec::new();
        let (before, after) = (from.data(), to.data());
        for (here, there, length) in self.rows() {
            let (old, new) = (&before[here..here + length], &after[there..there + length]);
            if old != new {
                let differ = old.iter().zip(new).zip(there..).filter(|((a, b), _)| a != b);
                changed.extend(differ.map(|(_, index)| self.to.cell(index)));
            }
        }
        if self.from != self.to {
            let overlap = self.overlap();
            let new = (0..self.to.len()).filter(|&index| after[index] >= 0).map(|index| self.to.cell(index));
            changed.extend(new.filter(|&cell| !overlap.contains(cell)));
        }
        changed
    }

    /// The cells along the inside of the overlap: those that have other neighbours in
    /// the one grid than in the other.
    fn rim(&self) -> Vec<Cell> {
        if self.from == self.to {
            return Vec::new();
        }
        let Rectangle { min, max } = self.overlap();
        let columns = (min.x..=max.x).flat_map(|x| [Cell::new(x, min.y), Cell::new(x, max.y)]);
        let rows = (min.y..=max.y).flat_map(|y| [Cell::new(min.x, y), Cell::new(max.x, y)]);
        columns.chain(rows).collect()
    }
}

/// A rectangle of cells, its corners included.
struct Rectangle {
    min: Cell,
    max: Cell,
}

impl Rectangle {
    /// The smallest one around cells; without any, it is empty.
    fn around(cells: impl Iterator<Item = Cell>) -> Self {
        let empty = Self { min: Cell::new(i32::MAX, i32::MAX), max: Cell::new(i32::MIN, i32::MIN) };
        cells.fold(empty, |Self { min, max }, c| Self {
            min: Cell::new(min.x.min(c.x), min.y.min(c.y)),
            max: Cell::new(max.x.max(c.x), max.y.max(c.y)),
        })
    }

    const fn contains(&self, cell: Cell) -> bool {
        self.min.x <= cell.x && cell.x <= self.max.x && self.min.y <= cell.y && cell.y <= self.max.y
    }

    /// Its cells that a grid has, row-major.
    fn cells_within(&self, info: &GridInfo) -> impl Iterator<Item = Cell> + use<> {
        let (left, right) = (self.min.x.max(0), self.max.x.min(info.width() as i32 - 1));
        let (bottom, top) = (self.min.y.max(0), self.max.y.min(info.height() as i32 - 1));
        (bottom..=top).flat_map(move |y| (left..=right).map(move |x| Cell::new(x, y)))
    }
}

#[cfg(test)]
#[path = "fast_tests.rs"]
mod tests;
