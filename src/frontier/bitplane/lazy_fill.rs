//! Detects what a robot that reaches little can see, and packs only the words of the map that it meets.
//!
//! A scan-line fill over runs of cells (Smith, "Tint Fill", SIGGRAPH 1979) that packs the
//! words of the map as it comes to them. Reading and labelling a whole map costs its
//! cells and runs wherever they are, a fill only those that it reaches, though more for
//! each: it gives up once it has met more than the rest would cost.

use crate::bits::neighbours::neighbours_of_row;
use crate::bits::{BitPlane, BitPlanes, Classifier, WORD_CELLS};
use crate::frontier::grouping::cell_groups::Grouper;
use crate::frontier::grouping::cell_lists::FrontierCells;
use crate::frontier::{DetectorParams, Reachability};
use crate::grid::{Cell, Neighbourhood, OccupancyGrid};

/// What a cell costs the textbook's search, in quarters of what it costs to pack one. The
/// fill costs less: as long as it goes on, it is the fastest of the three.
const SEARCH_PER_CELL: usize = 256;
/// What a run costs where all are found, in the same unit.
const LABEL_PER_RUN: usize = 16;

/// A run is kept for so many cells of the map at most: each takes twelve bytes.
const CELLS_PER_RUN: usize = 256;
/// So many are kept in any case.
const MIN_RUNS: usize = 256;

/// Cells of one row.
#[derive(Clone, Copy, Debug)]
struct RowRun {
    y: u32,
    start: u32,
    end: u32,
}

/// The fill, with the buffers it keeps.
#[derive(Clone, Debug)]
pub(super) struct LazyFill {
    /// By what frontier cells are of one frontier.
    grouping: Neighbourhood,
    /// Runs taken, those before `next` with their neighbours.
    taken: Vec<RowRun>,
    /// Which words of the planes are packed, a bit each.
    packed: Vec<u64>,
    /// Which words of what can be entered are known, a bit each.
    opened: Vec<u64>,
    cells: Vec<Cell>,
    grouper: Grouper,
}

/// One fill over the planes that it packs.
struct Fill<'a> {
    grid: &'a OccupancyGrid,
    params: &'a DetectorParams,
    classifier: Classifier,
    planes: &'a mut BitPlanes,
    /// What can be entered and has not been taken.
    open: &'a mut BitPlane,
    kept: &'a mut LazyFill,
}

impl LazyFill {
    /// A fill whose frontier cells hang together by these neighbours.
    pub fn new(grouping: Neighbourhood) -> Self {
        Self {
            grouping,
            taken: Vec::new(),
            packed: Vec::new(),
            opened: Vec::new(),
            cells: Vec::new(),
            grouper: Grouper::default(),
        }
    }

    /// Finds the frontiers of what is connected to the seed. `None`, with nothing useful
    /// in the planes, if that is too much.
    pub fn search(
        &mut self,
        grid: &OccupancyGrid,
        params: &DetectorParams,
        seed: Cell,
        planes: &mut BitPlanes,
        open: &mut BitPlane,
        found: &mut FrontierCells,
    ) -> Option<()> {
        planes.resize(grid.info());
        open.resize(grid.info().width(), grid.info().height());
        let flags = open.words().len().div_ceil(WORD_CELLS);
        for known in [&mut self.packed, &mut self.opened] {
            known.clear();
            known.resize(flags, 0);
        }
        self.taken.clear();
        self.cells.clear();
        let classifier = Classifier::new(&params.thresholds);
        let mut fill = Fill { grid, params, classifier, planes, open, kept: self };
        fill.take_connected(seed)?;
        fill.gather();
        self.cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        self.grouper.group(&self.cells, self.grouping, params.min_cells(grid.info()), found);
        Some(())
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.taken.capacity() * size_of::<RowRun>()
            + (self.packed.capacity() + self.opened.capacity()) * size_of::<u64>()
            + self.cells.capacity() * size_of::<Cell>()
            + self.grouper.memory_bytes()
    }
}

impl Fill<'_> {
    /// Takes all runs that are connected to the seed.
    fn take_connected(&mut self, seed: Cell) -> Option<()> {
        let (x, y) = (u32::try_from(seed.x).ok()?, u32::try_from(seed.y).ok()?);
        self.open_word(y, x / 64);
        self.open.insert(seed);
        self.take(y, x, x + 1);
        let (margin, width, height) = match self.params.reachability {
            Reachability::Textbook if self.params.neighbours == Neighbourhood::Eight => {
                (1, self.width(), self.height())
            }
            _ => (0, self.width(), self.height()),
        };
        let all_cells = self.grid.info().len();
        let (mut next, mut cells) = (0, 0);
        while let Some(&RowRun { y, start, end }) = self.kept.taken.get(next) {
            next += 1;
            cells += (end - start) as usize;
            let is_dear = cells * SEARCH_PER_CELL > all_cells + all_cells / cells * next * LABEL_PER_RUN;
            if is_dear || self.kept.taken.len() > MIN_RUNS + all_cells / CELLS_PER_RUN {
                return None;
            }
            let (start, end) = (start.saturating_sub(margin), (end + margin).min(width));
            if y > 0 {
                self.take(y - 1, start, end);
            }
            if y + 1 < height {
                self.take(y + 1, start, end);
            }
        }
        Some(())
    }

    /// Takes the runs of a row that have a cell in the columns given.
    fn take(&mut self, y: u32, mut start: u32, end: u32) {
        while start < end {
            let index = start / 64;
            let word = self.open_word(y, index) & (u64::MAX << (start % 64));
            if word == 0 {
                start = (index + 1) * 64;
                continue;
            }
            let first = index * 64 + word.trailing_zeros();
            if first >= end {
                return;
            }
            let run = RowRun { y, start: self.start_of_run(y, first), end: self.end_of_run(y, first) };
            self.open.clear_run(y as usize, run.start as usize, run.end as usize);
            self.kept.taken.push(run);
            start = run.end;
        }
    }

    /// The first cell of the run around an open cell.
    fn start_of_run(&mut self, y: u32, x: u32) -> u32 {
        let mut index = x / 64;
        let mut gaps = !self.open_word(y, index) & (u64::MAX >> (63 - x % 64));
        while gaps == 0 && index > 0 {
            index -= 1;
            gaps = !self.open_word(y, index);
        }
        index * 64 + 64 - gaps.leading_zeros()
    }

    /// One past the last cell of the run around an open cell.
    fn end_of_run(&mut self, y: u32, x: u32) -> u32 {
        let mut index = x / 64;
        let mut gaps = !self.open_word(y, index) & (u64::MAX << (x % 64));
        while gaps == 0 && (index as usize + 1) < self.open.row_words() {
            index += 1;
            gaps = !self.open_word(y, index);
        }
        (index * 64 + gaps.trailing_zeros()).min(self.width())
    }

    /// Collects the unknown cells beside those taken where walls block; by the textbook,
    /// those taken that are unknown.
    fn gather(&mut self) {
        let (width, height) = (self.width(), self.height());
        let margin = u32::from(self.params.neighbours == Neighbourhood::Eight);
        for next in 0..self.kept.taken.len() {
            let RowRun { y, start, end } = self.kept.taken[next];
            if self.params.reachability == Reachability::Textbook {
                self.gather_unknown(y, start, end);
                continue;
            }
            self.gather_unknown(y, start.saturating_sub(1), (end + 1).min(width));
            let (start, end) = (start.saturating_sub(margin), (end + margin).min(width));
            if y > 0 {
                self.gather_unknown(y - 1, start, end);
            }
            if y + 1 < height {
                self.gather_unknown(y + 1, start, end);
            }
        }
    }

    /// Collects the unknown cells of a row in the columns given, each once.
    fn gather_unknown(&mut self, y: u32, start: u32, end: u32) {
        for index in start / 64..=(end - 1) / 64 {
            self.pack_word(y, index);
            let first = index * 64;
            let from = u64::MAX << (start.max(first) - first);
            let to = u64::MAX >> (63 - ((end - 1).min(first + 63) - first));
            let word = &mut self.planes.unknown_mut().row_mut(y as usize)[index as usize];
            let mut unknown = *word & from & to;
            *word &= !unknown;
            while unknown != 0 {
                self.kept.cells.push(Cell::new((first + unknown.trailing_zeros()) as i32, y as i32));
                unknown &= unknown - 1;
            }
        }
    }

    /// The cells of a word that can be entered and have not been taken.
    fn open_word(&mut self, y: u32, index: u32) -> u64 {
        let (row, column) = (y as usize, index as usize);
        if !first_time(&mut self.kept.opened, row * self.open.row_words() + column) {
            return self.open.row(row)[column];
        }
        let word = match self.params.reachability {
            Reachability::WallsBlock => {
                self.pack_word(y, index);
                self.planes.free().row(row)[column]
            }
            Reachability::Textbook => {
                for y in y.saturating_sub(1)..=(y + 1).min(self.height() - 1) {
                    for index in index.saturating_sub(1)..=(index + 1).min(self.open.row_words() as u32 - 1) {
                        self.pack_word(y, index);
                    }
                }
                let mut word = [0];
                neighbours_of_row(self.planes.free(), self.params.neighbours, row, column..column + 1, &mut word);
                word[0]
            }
        };
        self.open.row_mut(row)[column] = word;
        word
    }

    fn pack_word(&mut self, y: u32, index: u32) {
        let (row, column) = (y as usize, index as usize);
        if first_time(&mut self.kept.packed, row * self.open.row_words() + column) {
            self.planes.pack_word(self.grid, &self.classifier, row, column);
        }
    }

    const fn width(&self) -> u32 {
        self.grid.info().width() as u32
    }

    const fn height(&self) -> u32 {
        self.grid.info().height() as u32
    }
}

/// Whether a flag was not set; it is then.
fn first_time(flags: &mut [u64], index: usize) -> bool {
    let (word, bit) = (&mut flags[index / 64], 1 << (index % 64));
    let first = *word & bit == 0;
    *word |= bit;
    first
}
