//! The map of an earlier session below the one that comes, as soon as both agree.

use crate::grid::{GridPatch, GridPatchError, MapMemory, OccupancyGrid};
use std::sync::Arc;

/// What has become of the earlier map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Recalled {
    /// There is none.
    #[default]
    Nothing,
    /// Too little was seen to tell whether it is the same place and frame.
    NotYet,
    /// It lies below the newer map.
    Below,
    /// Its walls are not where walls are seen now: it is left out.
    Contradicts,
}

/// The earlier map, and the newer one as it came.
#[derive(Default)]
pub struct Remembered {
    memory: Option<MapMemory>,
    state: Recalled,
    newer: Option<OccupancyGrid>,
}

impl Remembered {
    /// Remembers a map.
    pub fn new(memory: Option<MapMemory>) -> Self {
        let state = if memory.is_some() { Recalled::NotYet } else { Recalled::Nothing };
        Self { memory, state, newer: None }
    }

    /// What has become of it.
    pub const fn state(&self) -> Recalled {
        self.state
    }

    /// The map that is believed when a whole one comes.
    pub fn whole(&mut self, newer: OccupancyGrid) -> Arc<OccupancyGrid> {
        let Some(memory) = &mut self.memory else { return Arc::new(newer) };
        if memory.contradicts(&newer) {
            (self.memory, self.newer, self.state) = (None, None, Recalled::Contradicts);
            return Arc::new(newer);
        }
        if self.state == Recalled::NotYet && memory.agreement(&newer).is_none() {
            return Arc::new(newer);
        }
        self.state = Recalled::Below;
        let joined = memory.below(&newer);
        self.newer = Some(newer);
        Arc::new(joined)
    }

    /// The map that is believed when a part of the newer one changes; nothing where no earlier one
    /// lies below.
    pub fn patch(&mut self, patch: &GridPatch) -> Option<Result<Arc<OccupancyGrid>, GridPatchError>> {
        let (memory, newer) = (self.memory.as_mut()?, self.newer.as_mut()?);
        Some(newer.apply(patch).map(|()| Arc::new(memory.below(newer))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{Cell, GridInfo, Thresholds};

    /// A square room of 4 m whose lower left corner is at (x, x), in a map of 8 m.
    fn room(x: usize) -> OccupancyGrid {
        let info = GridInfo::new(160, 160, 0.05, Pose::default()).unwrap();
        let mut grid = OccupancyGrid::filled(info, -1);
        for (column, row) in (x..x + 80).flat_map(|column| (x..x + 80).map(move |row| (column, row))) {
            let is_wall = [column, row].iter().any(|&at| at == x || at == x + 79);
            grid.set(Cell::new(column as i32, row as i32), if is_wall { 100 } else { 0 });
        }
        grid
    }

    #[test]
    fn what_agrees_lies_below_and_what_does_not_is_left_out() {
        let unknown = OccupancyGrid::filled(*room(0).info(), -1);
        let earlier = || Remembered::new(Some(MapMemory::new(room(10), Thresholds::default())));
        let mut remembered = earlier();
        assert_eq!(*remembered.whole(unknown.clone()), unknown, "nothing shows yet that it is the same place");
        assert_eq!(remembered.state(), Recalled::NotYet);
        let mut part = room(10);
        part.set(Cell::new(30, 30), -1);
        assert_eq!(*remembered.whole(part), room(10));
        assert_eq!(remembered.state(), Recalled::Below);
        let patch = GridPatch { corner: Cell::new(40, 40), width: 2, height: 1, data: vec![100, -1] };
        let patched = remembered.patch(&patch).unwrap().unwrap();
        assert_eq!((patched.get(Cell::new(40, 40)), patched.get(Cell::new(41, 40))), (Some(100), Some(0)));
        let mut other = earlier();
        assert_eq!(*other.whole(room(40)), room(40));
        assert_eq!((other.state(), other.patch(&patch)), (Recalled::Contradicts, None));
    }
}
