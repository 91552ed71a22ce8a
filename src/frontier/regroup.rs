//! The frontiers of a plane of which some tiles changed.

use super::found::FrontierCells;
use super::tiles::Tiling;
use super::window::Window;
use crate::grid::{BitPlane, Cell, Neighbourhood, WORD_CELLS};
use std::ops::Range;

/// To find a cell's frontier again costs about as much as to label so many words.
const WORDS_PER_CELL: usize = 8;
/// So many cells are found again in any case.
const MIN_CELLS: usize = 16;

/// Repairs lists of frontiers, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Regroup {
    /// The cells taken out of the plane, those of one frontier after those of another.
    cells: Vec<Cell>,
    /// Which of them each frontier has.
    frontiers: Vec<[u32; 2]>,
}

impl Regroup {
    /// Finds again the frontiers that have a cell in a tile that changed or touch one that
    /// has; the others are kept. `false`, and nothing done, if these are so many that to
    /// find all anew is as good. Of the plane nothing is changed in the end.
    pub fn update(
        &mut self,
        plane: &mut BitPlane,
        tiling: &Tiling,
        changed: &[bool],
        neighbourhood: Neighbourhood,
        min_cells: usize,
        found: &mut FrontierCells,
    ) -> bool {
        let most_cells = plane.words().len() / WORDS_PER_CELL + MIN_CELLS;
        self.cells.clear();
        self.frontiers.clear();
        let tiles = ChangedTiles::new(tiling, changed);
        let done = self.take_touched(plane, &tiles, neighbourhood, found, most_cells).is_some();
        if done {
            self.order(min_cells);
            // Kept are those whose cells are still in the plane: all that have no cell within
            // or beside the rows that changed.
            let is_far = |cells: &[Cell]| match cells {
                [first, .., last] => first.y > tiles.rows.end || last.y + 1 < tiles.rows.start,
                _ => false,
            };
            let is_kept = |cells: &[Cell]| is_far(cells) || cells.first().is_some_and(|&cell| plane.contains(cell));
            let cells_of = |&[start, end]: &[u32; 2]| &self.cells[start as usize..end as usize];
            found.replace(is_kept, self.frontiers.iter().map(cells_of));
        }
        for &cell in &self.cells {
            plane.insert(cell);
        }
        done
    }

    /// Takes the cells of the frontiers to be found again out of the plane; `None` if they
    /// are too many.
    fn take_touched(
        &mut self,
        plane: &mut BitPlane,
        tiles: &ChangedTiles<'_>,
        neighbourhood: Neighbourhood,
        found: &FrontierCells,
        most_cells: usize,
    ) -> Option<()> {
        for window in tiles.windows() {
            for y in window.rows.clone() {
                for index in window.words.clone() {
                    while let bits @ 1.. = plane.row(y)[index] {
                        let x = index * WORD_CELLS + bits.trailing_zeros() as usize;
                        self.take(plane, Cell::new(x as i32, y as i32), neighbourhood, most_cells)?;
                    }
                }
            }
        }
        // What is left of the frontiers that lost a cell; their cells are in the order of rows,
        // and they in that of their first cells.
        let begins_before = |cells: &&[Cell]| cells.first().is_some_and(|first| first.y < tiles.rows.end);
        let is_near = |cells: &[Cell]| cells.last().is_some_and(|last| last.y >= tiles.rows.start);
        let is_changed = |cell: &Cell| tiles.contain(*cell);
        for cells in
            found.iter().take_while(begins_before).filter(|cells| is_near(cells) && cells.iter().any(is_changed))
        {
            for &cell in cells {
                self.take(plane, cell, neighbourhood, most_cells)?;
            }
        }
        Some(())
    }

    /// Drops the frontiers with fewer cells, and orders the others and their cells.
    fn order(&mut self, min_cells: usize) {
        let Self { cells, frontiers } = self;
        let row_major = |cell: &Cell| (cell.y, cell.x);
        frontiers.retain(|&[start, end]| (end - start) as usize >= min_cells);
        for &[start, end] in &*frontiers {
            cells[start as usize..end as usize].sort_unstable_by_key(row_major);
        }
        frontiers.sort_unstable_by_key(|&[start, _]| row_major(&cells[start as usize]));
    }

    /// Takes a cell that is still set out of the plane, and all that are connected to it: a
    /// frontier.
    fn take(
        &mut self,
        plane: &mut BitPlane,
        cell: Cell,
        neighbourhood: Neighbourhood,
        most_cells: usize,
    ) -> Option<()> {
        if !plane.remove(cell) {
            return Some(());
        }
        let start = self.cells.len();
        let mut next = start;
        self.cells.push(cell);
        while let Some(&cell) = self.cells.get(next) {
            next += 1;
            for beside in [-1, 0, 1].map(|y| cell.offset((0, y))) {
                let set = match neighbourhood {
                    Neighbourhood::Four if beside != cell => [false, plane.remove(beside), false],
                    _ => plane.remove_three(beside),
                };
                for x in (-1..=1).zip(set).filter_map(|(x, set)| set.then_some(x)) {
                    self.cells.push(beside.offset((x, 0)));
                }
            }
        }
        self.frontiers.push([start as u32, next as u32]);
        (next <= most_cells).then_some(())
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>() + self.frontiers.capacity() * size_of::<[u32; 2]>()
    }
}

/// The tiles that changed.
struct ChangedTiles<'a> {
    tiling: &'a Tiling,
    changed: &'a [bool],
    /// From the lowest to the highest of them.
    rows: Range<i32>,
}

impl<'a> ChangedTiles<'a> {
    fn new(tiling: &'a Tiling, changed: &'a [bool]) -> Self {
        let mut this = Self { tiling, changed, rows: 0..0 };
        let rows = this.windows().map(|window| window.rows.start as i32..window.rows.end as i32);
        this.rows = rows.reduce(|all, rows| all.start.min(rows.start)..all.end.max(rows.end)).unwrap_or(0..0);
        this
    }

    fn windows(&self) -> impl Iterator<Item = Window> {
        (0..self.tiling.len()).filter(|&tile| self.changed[tile]).map(|tile| self.tiling.window(tile))
    }

    fn contain(&self, cell: Cell) -> bool {
        self.changed[self.tiling.at(cell.y as usize, cell.x as usize / WORD_CELLS)]
    }
}
