//! What changed between two costmaps of one place, for a search that is kept between them.

use crate::grid::{Cell, GridInfo, INSCRIBED_COST};

/// Columns and rows by which the old cells moved in a new grid that holds them all;
/// `None` when it does not.
pub fn growth(old: &GridInfo, new: &GridInfo) -> Option<(i32, i32)> {
    let shift = new.offset_of(old)?;
    let last = Cell::new(old.width() as i32 - 1, old.height() as i32 - 1);
    let holds = |cell: Cell| new.contains(cell.offset(shift));
    (holds(Cell::new(0, 0)) && holds(last)).then_some(shift)
}

/// The index in the new grid of a cell of the old one, which the new one holds.
pub const fn moved(index: usize, old: &GridInfo, new: &GridInfo, shift: (i32, i32)) -> usize {
    let cell = old.cell(index).offset(shift);
    cell.y as usize * new.width() + cell.x as usize
}

/// Where two rows of costs differ in what they mean for a step.
pub fn changed_cells(old: &[u8], new: &[u8]) -> Vec<usize> {
    const BLOCK: usize = 256;
    let mut changed = Vec::new();
    for (block, (old, new)) in old.chunks(BLOCK).zip(new.chunks(BLOCK)).enumerate() {
        if old != new {
            let differ = |(a, b): (&u8, &u8)| a != b && (*a < INSCRIBED_COST || *b < INSCRIBED_COST);
            let cells = old.iter().zip(new).enumerate().filter(|(_, pair)| differ(*pair));
            changed.extend(cells.map(|(i, _)| block * BLOCK + i));
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;

    #[test]
    fn a_grid_that_holds_the_old_cells_has_grown() {
        let info = |width, height, x, y| GridInfo::new(width, height, 0.05, Pose::new(x, y, 0.0)).unwrap();
        let old = info(10, 8, 1.0, 2.0);
        let new = info(14, 10, 0.9, 1.95);
        assert_eq!(growth(&old, &new), Some((2, 1)));
        assert_eq!(moved(13, &old, &new, (2, 1)), 2 * 14 + 5);
        assert_eq!(growth(&new, &old), None, "it shrank");
        assert_eq!(growth(&old, &info(14, 10, 0.92, 1.95)), None, "by part of a cell");
    }

    #[test]
    fn a_change_among_blocked_costs_means_nothing() {
        let mut new = [0, 10, 253, 254, 255, 20];
        let old = new;
        new[1] = 11;
        new[2] = 255;
        new[4] = 7;
        assert_eq!(changed_cells(&old, &new), [1, 4]);
    }
}
