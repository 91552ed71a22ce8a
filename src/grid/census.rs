//! How many cells of a map are free, occupied and unknown, counted for the price of what changed.

use super::{CellRect, CellState, Changes, OccupancyGrid, Since, Thresholds};
use std::sync::Arc;

/// Numbers of cells by kind of territory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Census {
    /// Free cells.
    pub free: usize,
    /// Occupied cells.
    pub occupied: usize,
    /// Unknown cells.
    pub unknown: usize,
    /// Seen cells that are neither free nor occupied.
    pub unsettled: usize,
}

impl Census {
    /// All cells that have been seen.
    #[must_use]
    pub const fn known(&self) -> usize {
        self.free + self.occupied + self.unsettled
    }

    /// The counts of a map by those of the last one, in which only what differs is counted; `None`
    /// where all may differ.
    pub(super) fn since(
        self,
        since: &Since,
        [last, next]: [&OccupancyGrid; 2],
        count: impl Fn(&OccupancyGrid, &CellRect) -> Self,
    ) -> Option<Self> {
        match since {
            Since::Part(changed) => Some(self.with_part(count(last, changed), count(next, changed))),
            Since::Grown(growth, changed) => {
                let before = growth.before(*changed);
                let after = before.moved(growth.offset(), next.info());
                let kept = self.with_part(count(last, &before), count(next, &after));
                let new = growth.outside(0).into_iter();
                Some(new.fold(kept, |census, part| census.with_part(Self::default(), count(next, &part))))
            }
            Since::All => None,
        }
    }

    /// The counts without those of a part and with others in their place.
    const fn with_part(self, without: Self, with: Self) -> Self {
        Self {
            free: self.free + with.free - without.free,
            occupied: self.occupied + with.occupied - without.occupied,
            unknown: self.unknown + with.unknown - without.unknown,
            unsettled: self.unsettled + with.unsettled - without.unsettled,
        }
    }
}

impl Census {
    /// One more cell.
    pub(super) const fn add(&mut self, state: CellState) {
        match state {
            CellState::Free => self.free += 1,
            CellState::Occupied => self.occupied += 1,
            CellState::Unknown => self.unknown += 1,
            CellState::Unsettled => self.unsettled += 1,
        }
    }
}

impl OccupancyGrid {
    /// How many cells are free, occupied and unknown.
    #[must_use]
    pub fn census(&self, thresholds: &Thresholds) -> Census {
        self.census_of(&CellRect::of(self.info()), thresholds)
    }

    /// The same of the cells of a rectangle alone.
    #[must_use]
    pub fn census_of(&self, part: &CellRect, thresholds: &Thresholds) -> Census {
        let (rows, columns) = (part.rows(self.info()), part.columns(self.info()));
        let lines = self.data().chunks_exact(self.info().width()).skip(rows.start).take(rows.len());
        let mut census = Census::default();
        for &value in lines.flat_map(|line| &line[columns.clone()]) {
            census.add(thresholds.classify(value));
        }
        census
    }
}

/// The census of a map that changes.
#[derive(Clone, Debug)]
pub struct LiveCensus {
    thresholds: Thresholds,
    /// The last map with its version and counts.
    last: Option<(Arc<OccupancyGrid>, u64, Census)>,
}

impl LiveCensus {
    /// No map yet.
    #[must_use]
    pub const fn new(thresholds: Thresholds) -> Self {
        Self { thresholds, last: None }
    }

    /// The census of a version of the map. O(cells that changed since the last call) where that
    /// is known.
    pub fn update(&mut self, grid: &Arc<OccupancyGrid>, changes: &Changes) -> Census {
        let from_last = self.last.as_ref().and_then(|(last, version, census)| {
            let since = changes.since_on((*version, last.info()), grid.info());
            let count = |grid: &OccupancyGrid, part: &CellRect| grid.census_of(part, &self.thresholds);
            census.since(&since, [last, grid], count)
        });
        let census = from_last.unwrap_or_else(|| grid.census(&self.thresholds));
        self.last = Some((Arc::clone(grid), changes.version(), census));
        census
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Cell, GridPatch, Live};

    #[test]
    fn the_census_adds_up() {
        let census = OccupancyGrid::from_ascii("?#.\n...").unwrap().census(&Thresholds::default());
        assert_eq!((census.free, census.occupied, census.unknown), (4, 1, 1));
        assert_eq!(census.known(), 5);
    }

    #[test]
    fn what_changed_is_counted_as_if_all_were() {
        let thresholds = Thresholds { free_max: 20, occupied_min: 60 };
        let mut map = Live::new(Arc::new(OccupancyGrid::from_ascii("?#.?\n....").unwrap()));
        let mut live = LiveCensus::new(thresholds);
        for (x, y, value) in [(0, 0, 100), (0, 1, 40), (3, 1, 0), (3, 1, 0), (1, 1, -1)] {
            assert_eq!(live.update(map.newest(), map.changes()), map.newest().census(&thresholds));
            map.apply(&GridPatch { corner: Cell::new(x, y), width: 1, height: 1, data: vec![value] }).unwrap();
        }
        let census = live.update(map.newest(), map.changes());
        assert_eq!(census, map.newest().census(&thresholds));
        assert_eq!((census.free, census.occupied, census.unknown, census.unsettled), (5, 1, 1, 1));
        map.replace(Arc::new(OccupancyGrid::from_ascii("..\n..\n#?").unwrap()));
        assert_eq!(live.update(map.newest(), map.changes()).known(), 5);
    }
}
