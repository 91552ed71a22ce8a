//! The costmap of a map together with one that somebody else publishes of the same ground.

use super::published::cost_of_published;
use super::{Costmap, INSCRIBED_COST, LETHAL_COST, NARROW_COST, UNKNOWN_COST};
use crate::grid::{Cell, CellRect, GridInfo, Live, OccupancyGrid, Snapshot};
use std::sync::Arc;

/// Costs on the cells of a map, made of our own costs and of published ones, for the price of what
/// changed in either.
#[derive(Clone, Debug, Default)]
pub struct BelievedCosts {
    /// The versions of our own costs and of the published ones that are known.
    known: Option<[u64; 2]>,
    /// Where the published ones lay.
    theirs: Option<GridInfo>,
    made: Option<Live<Costmap>>,
}

impl BelievedCosts {
    /// Our own costs where the others know of no more: their lethal and inscribed cells are such
    /// here too, and their costs count where they are higher; they say nothing about room to turn.
    /// What they do not know says nothing.
    pub fn beside(&mut self, own: &Snapshot<Costmap>, theirs: &Snapshot<OccupancyGrid>) -> Snapshot<Costmap> {
        let info = *own.cells.info();
        let since = |known: [u64; 2]| {
            let changed = self.on_map(&info, theirs, known[1])?;
            Some(own.changes.since(known[0])?.union(changed))
        };
        let changed = self.known.and_then(since);
        self.known = Some([own.changes.version(), theirs.changes.version()]);
        self.write(info, changed, theirs, |cell, theirs| higher(own.cells.cost(cell), theirs))
    }

    /// The published costs alone, on the cells of a map; what lies outside of them is unknown. A
    /// costmap's size and place need not be those of the map that it was made from.
    pub fn instead(&mut self, info: &GridInfo, theirs: &Snapshot<OccupancyGrid>) -> Snapshot<Costmap> {
        let changed = self.known.and_then(|known| self.on_map(info, theirs, known[1]));
        self.known = Some([0, theirs.changes.version()]);
        self.write(*info, changed, theirs, |_, theirs| theirs)
    }

    /// Where the published costs changed since a version, in cells of the map.
    fn on_map(&self, info: &GridInfo, theirs: &Snapshot<OccupancyGrid>, version: u64) -> Option<CellRect> {
        if self.theirs.as_ref() != Some(theirs.cells.info()) {
            return None;
        }
        let changed = theirs.changes.since(version)?;
        Some(changed.moved(info.offset_of(theirs.cells.info())?, info))
    }

    fn write(
        &mut self,
        info: GridInfo,
        changed: Option<CellRect>,
        theirs: &Snapshot<OccupancyGrid>,
        cost: impl Fn(Cell, u8) -> u8,
    ) -> Snapshot<Costmap> {
        self.theirs = Some(*theirs.cells.info());
        let published = published_on(&info, &theirs.cells);
        let write = |costmap: &mut Costmap, rect: &CellRect| {
            let (width, columns) = (info.width(), rect.columns(&info));
            for y in rect.rows(&info) {
                let row = &mut costmap.costs_mut()[y * width..][columns.clone()];
                for (x, slot) in columns.clone().zip(row) {
                    let cell = Cell::new(x as i32, y as i32);
                    *slot = cost(cell, published(cell));
                }
            }
        };
        match (&mut self.made, changed) {
            (Some(made), Some(changed)) if *made.newest().info() == info => {
                if !changed.is_empty() {
                    made.change(changed, |costmap| write(costmap, &changed));
                }
                made.snapshot()
            }
            (made, _) => {
                let mut costmap = Costmap::of(info, vec![UNKNOWN_COST; info.len()]);
                write(&mut costmap, &CellRect::of(&info));
                let live = match made.take() {
                    Some(mut live) => {
                        live.replace_unlike(Arc::new(costmap));
                        live
                    }
                    None => Live::new(Arc::new(costmap)),
                };
                made.insert(live).snapshot()
            }
        }
    }
}

/// The published cost of a cell of a map.
fn published_on<'a>(info: &'a GridInfo, theirs: &'a OccupancyGrid) -> impl Fn(Cell) -> u8 + 'a {
    let offset = theirs.info().offset_of(info);
    move |cell| {
        let there = offset.map_or_else(|| theirs.info().cell_at(info.center(cell)), |offset| cell.offset(offset));
        theirs.get(there).map_or(UNKNOWN_COST, cost_of_published)
    }
}

const fn higher(own: u8, theirs: u8) -> u8 {
    const fn max(a: u8, b: u8) -> u8 {
        if a < b { b } else { a }
    }
    match (own, theirs) {
        (_, UNKNOWN_COST) => own,
        (UNKNOWN_COST, INSCRIBED_COST | LETHAL_COST) => theirs,
        (UNKNOWN_COST, _) => own,
        (_, INSCRIBED_COST | LETHAL_COST) => max(own, theirs),
        _ => max(own, if theirs < NARROW_COST { theirs } else { NARROW_COST - 1 }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::GridPatch;
    use proptest::prelude::*;

    fn grid(width: u32, height: u32, x_m: f64, values: Vec<i8>) -> OccupancyGrid {
        OccupancyGrid::new(GridInfo::new(width, height, 1.0, Pose::new(x_m, 0.0, 0.0)).unwrap(), values).unwrap()
    }

    fn costs(costs: Vec<u8>) -> Snapshot<Costmap> {
        let info = GridInfo::new(costs.len() as u32, 1, 1.0, Pose::default()).unwrap();
        Snapshot::alone(Costmap::from_costs(info, costs).unwrap())
    }

    #[test]
    fn the_others_know_of_obstacles_and_not_of_room_to_turn() {
        let own = costs(vec![254, 253, 253, 253, 73, 26, 255, 255, 10]);
        let theirs = Snapshot::alone(grid(9, 1, 0.0, vec![0, 0, 0, 99, 98, 0, 100, 50, -1]));
        let both = BelievedCosts::default().beside(&own, &theirs);
        assert_eq!(both.cells.costs(), &[254, 253, 253, 253, 199, 26, 254, 255, 10]);
    }

    #[test]
    fn a_costmap_of_another_place_counts_where_it_lies() {
        let theirs = Snapshot::alone(grid(3, 1, 0.0, vec![10, 20, 99]));
        let info = GridInfo::new(4, 2, 1.0, Pose::new(-1.0, 0.0, 0.0)).unwrap();
        let expected = [255, cost_of_published(10), cost_of_published(20), 253, 255, 255, 255, 255];
        assert_eq!(BelievedCosts::default().instead(&info, &theirs).cells.costs(), expected);
        let between = GridInfo::new(2, 1, 1.0, Pose::new(0.4, 0.0, 0.0)).unwrap();
        let found = BelievedCosts::default().instead(&between, &theirs);
        assert_eq!(found.cells.costs(), [cost_of_published(10), cost_of_published(20)]);
    }

    proptest! {
        /// The published costmap may lie elsewhere, and one of both may change or none.
        #[test]
        fn what_changed_is_merged_as_if_all_were(
            x_m in -3i32..4,
            steps in proptest::collection::vec((0u32..9, 0u32..5, 1u32..4, any::<i8>(), any::<bool>()), 1..12),
        ) {
            let mut theirs = Live::new(Arc::new(grid(9, 5, f64::from(x_m), vec![0; 45])));
            let mut own = Live::new(Arc::new(Costmap::from_costs(*grid(12, 6, 0.0, vec![0; 72]).info(), vec![7; 72]).unwrap()));
            let (mut beside, mut instead) = (BelievedCosts::default(), BelievedCosts::default());
            for (x, y, size, value, is_theirs) in steps {
                if is_theirs {
                    let (width, height) = (size.min(9 - x), size.min(5 - y));
                    let data = vec![value.rem_euclid(102) - 1; (width * height) as usize];
                    theirs.apply(&GridPatch { corner: Cell::new(x as i32, y as i32), width, height, data }).unwrap();
                } else {
                    let rect = CellRect { x: x as usize, y: y as usize, width: 1, height: 1 };
                    own.change(rect, |costs| costs.costs_mut()[(y * 12 + x) as usize] = value as u8);
                }
                let (own, theirs) = (own.snapshot(), theirs.snapshot());
                let all = BelievedCosts::default().beside(&own, &theirs);
                prop_assert_eq!(beside.beside(&own, &theirs).cells, all.cells);
                let info = *own.cells.info();
                let all = BelievedCosts::default().instead(&info, &theirs);
                prop_assert_eq!(instead.instead(&info, &theirs).cells, all.cells);
            }
        }
    }
}
