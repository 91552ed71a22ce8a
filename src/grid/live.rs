//! The newest state of a map or costmap, changed in place while others still read earlier ones.
//!
//! Readers hold an [`Arc`] of the state that they look at. A change must not disturb them, and
//! a copy of the whole grid for each small change would cost more than all that is done with it.
//! So earlier states are kept until their readers have let go, brought up to date by copying the
//! rectangles that changed since, and become the next newest state.

use super::{CellRect, CellValues, Changes, GridInfo, Growth, Since, changed_rect};
use std::sync::Arc;

/// So many earlier states are kept for their memory.
const SPARES: usize = 2;

/// One state, with what changed before it.
#[derive(Clone, Debug)]
pub struct Snapshot<T> {
    /// The state.
    pub cells: Arc<T>,
    /// Its version, and what changed since earlier ones.
    pub changes: Changes,
}

impl<T> Snapshot<T> {
    /// A state of which nothing earlier is known.
    #[must_use]
    pub fn alone(cells: T) -> Self {
        Self { cells: Arc::new(cells), changes: Changes::default() }
    }
}

/// A grid that changes, with what changed from version to version.
#[derive(Clone, Debug)]
pub struct Live<T> {
    newest: Arc<T>,
    changes: Changes,
    /// Earlier states by version, the latest last.
    spares: Vec<(u64, Arc<T>)>,
}

impl<T: CellValues> Live<T> {
    /// The first state, as version 1.
    #[must_use]
    pub fn new(first: Arc<T>) -> Self {
        Self { newest: first, changes: Changes::beginning_at(1), spares: Vec::new() }
    }

    /// The newest state with its history.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot<T> {
        Snapshot { cells: Arc::clone(&self.newest), changes: self.changes.clone() }
    }

    /// The newest state.
    #[must_use]
    pub const fn newest(&self) -> &Arc<T> {
        &self.newest
    }

    /// What changed from version to version; its version is that of the newest state.
    #[must_use]
    pub const fn changes(&self) -> &Changes {
        &self.changes
    }

    /// The version of the newest state.
    #[must_use]
    pub const fn version(&self) -> u64 {
        self.changes.version()
    }

    /// A whole state comes; it is compared with the last one here, and nowhere else, as far as the
    /// last one lies on it.
    pub fn replace(&mut self, next: Arc<T>) {
        if next.info() == self.newest.info() {
            let changed = changed_rect(&*self.newest, &*next).unwrap_or_default();
            self.changes = self.changes.then(changed);
            let last = std::mem::replace(&mut self.newest, next);
            self.retire(self.version() - 1, last);
        } else if let Some(growth) = Growth::of(self.newest.info(), next.info()) {
            let all = CellRect::of(next.info());
            let changed = growth.changed([self.newest.values(), next.values()], &all).unwrap_or_default();
            self.changes = self.changes.then_grown(growth.corner(), changed);
            self.newest = next;
            self.spares.clear();
        } else {
            self.replace_unlike(next);
        }
    }

    /// A whole state comes where there may have been none: the first one, or the next of `slot`,
    /// compared with the last as by [`Self::replace`].
    pub fn renew(slot: &mut Option<Self>, next: Arc<T>) {
        match slot {
            Some(live) => live.replace(next),
            None => *slot = Some(Self::new(next)),
        }
    }

    /// A whole state comes of which nothing is known before.
    pub fn replace_unlike(&mut self, next: Arc<T>) {
        self.changes = self.changes.then_all();
        self.newest = next;
        self.spares.clear();
    }

    /// Writes the cells of a rectangle anew. O(cells of it and of those that changed in the last
    /// versions), and a copy of all where every earlier state is still read by somebody.
    pub fn change(&mut self, changed: CellRect, write: impl FnOnce(&mut T)) {
        if let Some(newest) = Arc::get_mut(&mut self.newest) {
            write(newest);
            self.changes = self.changes.then(changed);
            return;
        }
        let mut next = self.spare().unwrap_or_else(|| Arc::new(T::clone(&self.newest)));
        if let Some(cells) = Arc::get_mut(&mut next) {
            write(cells);
        }
        self.changes = self.changes.then(changed);
        let last = std::mem::replace(&mut self.newest, next);
        self.retire(self.version() - 1, last);
    }

    /// The next state, on a grid that grew: what was there lies where it did. Writes anew the cells that
    /// changed, those that are new, and those fewer than `rim` columns or rows from such. O(cells), and
    /// but for these they are copied.
    pub fn grow(&mut self, growth: &Growth, changed: CellRect, rim: usize, mut write: impl FnMut(&mut T, &CellRect)) {
        let values = growth.lay(self.newest.values(), T::UNKNOWN);
        let mut next = T::of_values(*growth.new_info(), values);
        let outside = growth.outside(rim);
        outside.iter().chain([&changed]).filter(|part| !part.is_empty()).for_each(|part| write(&mut next, part));
        let differs = |part: &CellRect| growth.changed([self.newest.values(), next.values()], part);
        let changed = outside.iter().filter_map(differs).fold(changed, CellRect::union);
        self.changes = self.changes.then_grown(growth.corner(), changed);
        self.newest = Arc::new(next);
        self.spares.clear();
    }

    /// What is made cell by cell of a state with these cells follows it: `write` makes the cells of a
    /// rectangle, and `all` makes all where nothing is kept that would serve.
    pub fn follow(
        slot: &mut Option<Self>,
        since: &Since,
        info: &GridInfo,
        mut write: impl FnMut(&mut T, &CellRect),
        all: impl FnOnce() -> T,
    ) {
        match (slot, since) {
            (Some(live), Since::Part(changed)) if live.newest.info() == info => {
                if !changed.is_empty() {
                    live.change(*changed, |cells| write(cells, changed));
                }
            }
            (Some(live), Since::Grown(growth, changed)) if live.newest.info() == growth.old() => {
                live.grow(growth, *changed, 0, write);
            }
            (slot, _) => *slot = Some(Self::new(Arc::new(all()))),
        }
    }

    /// An earlier state that nobody reads any longer, brought up to date.
    fn spare(&mut self) -> Option<Arc<T>> {
        let free = self.spares.iter_mut().rposition(|(_, state)| Arc::get_mut(state).is_some())?;
        let (version, mut state) = self.spares.remove(free);
        let missed = self.changes.since(version)?;
        Arc::get_mut(&mut state)?.copy_rect(&self.newest, &missed);
        Some(state)
    }

    fn retire(&mut self, version: u64, state: Arc<T>) {
        if self.spares.len() == SPARES {
            self.spares.remove(0);
        }
        self.spares.push((version, state));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{Cell, OccupancyGrid};
    use proptest::prelude::*;

    fn grid() -> OccupancyGrid {
        OccupancyGrid::filled(GridInfo::new(9, 7, 1.0, Pose::default()).unwrap(), -1)
    }

    proptest! {
        /// Readers hold on to some states for some time; what they hold never changes.
        #[test]
        fn states_are_as_if_copied_each_time(steps in proptest::collection::vec((0usize..9, 0usize..7, 1usize..4, any::<i8>(), 0usize..5), 1..40)) {
            let mut live = Live::new(Arc::new(grid()));
            let mut plain = grid();
            let mut readers: Vec<(Arc<OccupancyGrid>, OccupancyGrid)> = Vec::new();
            for (x, y, size, value, held) in steps {
                let rect = CellRect { x, y, width: size.min(9 - x), height: size.min(7 - y) };
                let write = |grid: &mut OccupancyGrid| {
                    for (x, y) in rect.rows(&{ *grid.info() }).flat_map(|y| (rect.x..rect.x + rect.width).map(move |x| (x, y))) {
                        grid.set(Cell::new(x as i32, y as i32), value);
                    }
                };
                let before = plain.clone();
                write(&mut plain);
                live.change(rect, write);
                prop_assert_eq!(&**live.newest(), &plain);
                let told = live.changes().since(live.version() - 1).unwrap();
                prop_assert_eq!(changed_rect(&before, &plain).unwrap_or_default().union(told), told);
                readers.push((Arc::clone(live.newest()), plain.clone()));
                let kept = readers.len().saturating_sub(held);
                readers.drain(..kept);
                prop_assert!(readers.iter().all(|(held, seen)| **held == *seen));
            }
        }
    }

    #[test]
    fn memory_of_states_that_nobody_reads_serves_again() {
        let mut live = Live::new(Arc::new(grid()));
        let mut places = std::collections::BTreeSet::new();
        let mut reader = Arc::clone(live.newest());
        for step in 0..20 {
            let rect = CellRect { x: step % 9, y: step % 7, width: 1, height: 1 };
            live.change(rect, |grid| grid.set(Cell::new(rect.x as i32, rect.y as i32), step as i8));
            places.insert(live.newest().data().as_ptr() as usize);
            reader = Arc::clone(live.newest());
        }
        assert_eq!(reader.data(), live.newest().data());
        assert!(places.len() <= 3, "{} states in memory", places.len());
    }

    #[test]
    fn a_whole_state_is_compared_and_another_size_is_all_new() {
        let mut live = Live::new(Arc::new(grid()));
        let mut next = grid();
        next.set(Cell::new(4, 2), 0);
        live.replace(Arc::new(next));
        assert_eq!(live.changes().since(1), Some(CellRect { x: 4, y: 2, width: 1, height: 1 }));
        let larger = GridInfo::new(10, 7, 1.0, Pose::default()).unwrap();
        live.replace(Arc::new(OccupancyGrid::filled(larger, 0)));
        assert_eq!((live.version(), live.changes().since(2)), (3, None));
    }

    #[test]
    fn a_state_that_grew_is_compared_where_the_last_one_was() {
        let mut live = Live::new(Arc::new(grid()));
        let info = GridInfo::new(20, 15, 1.0, Pose::new(-3.0, -2.0, 0.0)).unwrap();
        let mut next = OccupancyGrid::filled(info, 0);
        (0..63).for_each(|index| next.set(grid().info().cell(index).offset((3, 2)), -1));
        next.set(Cell::new(11, 8), 100);
        live.replace(Arc::new(next.clone()));
        let changed = CellRect { x: 11, y: 8, width: 1, height: 1 };
        assert_eq!((live.changes().since(1), live.changes().since_grown(1)), (None, Some(changed)));
        live.replace(Arc::new(grid()));
        assert_eq!(live.changes().since_grown(2), None, "a map that was cut");
    }
}
