//! The wavefront's frontiers at the speed of memory: all from scratch on a first map, or where the
//! robot reaches little of it, and repaired where the map changed or grew on the next ones.
//!
//! Both engines give what [`Wavefront`](super::Wavefront) gives, to the cell and in the same
//! order, so that it is a question of time alone which of them is asked.

mod find_cells;
mod from_scratch;
mod lazy_fill;
mod repair;

pub use from_scratch::FromScratch;
pub use repair::Repair;

use super::FrontierCells;
use super::{DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector};
use crate::bits::placement::moved;
use crate::grid::{GridInfo, Neighbourhood};
use std::sync::Arc;

/// The detector: both engines, with what they keep from map to map.
///
/// The frontiers are those of the textbook, on a first map and on the ones after it:
///
/// ```
/// use frontier_explorer::frontier::{Bitplane, DetectionInput, DetectorParams, FrontierDetector, Wavefront};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::OccupancyGrid;
///
/// let params = DetectorParams::default();
/// let (mut fast, mut textbook) = (Bitplane::new(params), Wavefront::new(params));
/// for (drawing, count) in [("????\n#..?\n#..?", 1), ("##??\n#..?\n#..?", 1), ("##?#\n#..#\n#..?", 2)] {
///     let grid = OccupancyGrid::from_ascii(drawing).unwrap();
///     let input = DetectionInput::new(&grid, Pose::new(1.5, 0.5, 0.0));
///     let found = fast.detect(&input)?;
///     assert_eq!(found.len(), count);
///     assert_eq!(found, textbook.detect(&input)?);
/// }
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bitplane {
    from_scratch: FromScratch,
    repair: Repair,
    /// Size and place of the last map.
    last: Option<GridInfo>,
    /// The version of the map that the second engine knows.
    known: Option<u64>,
}

impl Bitplane {
    /// A detector with these parameters that has seen no map.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        Self::with_grouping(params, params.neighbours)
    }

    /// One that marks frontier cells by the parameters' neighbours and groups them by others.
    pub(super) fn with_grouping(params: DetectorParams, grouping: Neighbourhood) -> Self {
        Self {
            from_scratch: FromScratch::with_grouping(params, grouping),
            repair: Repair::with_grouping(params, grouping),
            last: None,
            known: None,
        }
    }

    /// The frontiers as lists of cells, without a copy of each.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map.
    pub fn detect_cells(&mut self, input: &DetectionInput<'_>) -> Result<&FrontierCells, DetectError> {
        Ok(self.detect_shared(input)?)
    }

    /// What the detector's own state takes in memory, bytes; the frontiers last found are not
    /// part of it.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.from_scratch.memory_bytes() + self.repair.memory_bytes()
    }

    fn detect_shared(&mut self, input: &DetectionInput<'_>) -> Result<&Arc<FrontierCells>, DetectError> {
        let info = input.grid.info();
        let follows = self.last.replace(*info).is_some_and(|last| moved(&last, info).is_some());
        // A fill that meets little of the map is faster than to repair all of it.
        if !follows || self.from_scratch.was_lazy() {
            return self.from_scratch.detect_shared(input);
        }
        let changed = self.known.zip(input.changes).and_then(|(known, changes)| changes.since_grown(known));
        self.known = input.changes.map(crate::grid::Changes::version);
        self.repair.update_shared(input, changed)
    }
}

impl FrontierDetector for Bitplane {
    fn name(&self) -> &'static str {
        "bitplane"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        Ok(Frontier::all_of(self.detect_shared(input)?))
    }

    fn forget(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontier::random_maps::noise;
    use crate::geometry::Pose;
    use crate::grid::{Cell, CellRect, GridInfo, Live, OccupancyGrid};
    use proptest::prelude::*;

    proptest! {
        /// Maps change by patches, come whole, grow and shrink; some are never looked at.
        #[test]
        fn whatever_comes_is_as_if_detected_from_scratch(
            first in noise(90, 40),
            steps in proptest::collection::vec((0usize..6, 0usize..60, 0usize..30, any::<i8>(), any::<bool>()), 1..12),
        ) {
            let params = DetectorParams::default();
            let mut detector = Bitplane::new(params);
            let mut map = Live::new(Arc::new(first.0));
            for (kind, x, y, value, is_told) in steps {
                let value = [0, 100, -1][value.unsigned_abs() as usize % 3];
                let info = *map.newest().info();
                match kind {
                    0 => {
                        let to = (info.width() as u32 % 90 + 1, info.height() as u32 % 40 + 1);
                        let info = GridInfo::new(to.0, to.1, 1.0, Pose::default()).unwrap();
                        map.replace(Arc::new(OccupancyGrid::filled(info, 0)));
                    }
                    1 => {
                        let corner = info.from_grid_units(-(x as f64), -(y as f64));
                        let (width, height) = (info.width() + x + y, info.height() + y);
                        let origin = Pose::new(corner.x, corner.y, 0.0);
                        let larger = GridInfo::new(width as u32, height as u32, 1.0, origin).unwrap();
                        let mut next = OccupancyGrid::filled(larger, value);
                        for index in 0..info.len() {
                            next.set(info.cell(index).offset((x as i32, y as i32)), map.newest().data()[index]);
                        }
                        next.set(Cell::new(2 * x as i32, 2 * y as i32), value);
                        map.replace(Arc::new(next));
                    }
                    2 => {
                        let mut next = OccupancyGrid::clone(map.newest());
                        next.set(Cell::new(x as i32, y as i32), value);
                        map.replace(Arc::new(next));
                    }
                    _ => {
                        let rect = CellRect { x, y, width: 20, height: 3 };
                        map.change(rect, |grid| {
                            for (x, y) in rect.rows(&info).flat_map(|y| rect.columns(&info).map(move |x| (x, y))) {
                                grid.set(Cell::new(x as i32, y as i32), value);
                            }
                        });
                    }
                }
                if x % 4 == 3 {
                    continue;
                }
                let grid = map.newest();
                let changes = is_told.then_some(map.changes());
                let input = DetectionInput { changes, ..DetectionInput::new(grid, Pose::new(x as f64 % 9.0, 0.5, 0.0)) };
                prop_assert_eq!(detector.detect(&input), FromScratch::new(params).detect(&input));
            }
        }
    }
}
