//! Frontiers from a plane of frontier cells: its components, each with its cells.
//!
//! Labelling by runs as in [`super::labels`], but for eight neighbours of two rows at a
//! time: columns beside each other that have a cell in either row are connected, whichever
//! row it is in (He, Chao and Suzuki, "An Efficient First-Scan Method for Label-Equivalence-
//! Based Labeling Algorithms", Pattern Recognition Letters 2010). Such bands have half as
//! many runs, which is half the work of uniting and half the memory.

use super::contacts::{Starts, for_each_band_contact};
use super::found::FrontierCells;
use super::union_find::{make_room, unite};
use crate::grid::{BitPlane, BitWork, Cell, Neighbourhood, WORD_CELLS, with_bit_counts};

/// Of a run: it is the first of its component, and what stands with it is the number of
/// the component's cells.
const FIRST: u32 = 1 << 31;
/// Of a first run: what stands with it is the place of the component among those found,
/// where the first stands for all that are dropped.
const PLACED: u32 = 1 << 30;

/// Groups the cells of planes into frontiers, with the buffer it keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Clusters {
    /// Of each run of the bands, while they are connected, one of the same component that
    /// is not after it; then the first, which has a flag and a number itself.
    of_run: Vec<u32>,
    /// A row without a cell, beyond the last.
    none: Vec<u64>,
}

/// A plane cut into bands.
#[derive(Clone, Copy)]
struct Bands<'a> {
    plane: &'a BitPlane,
    none: &'a [u64],
    eight: bool,
}

impl<'a> Bands<'a> {
    /// Rows of a band.
    #[inline(always)]
    const fn rows(self) -> usize {
        if self.eight { 2 } else { 1 }
    }

    #[inline(always)]
    const fn count(self) -> usize {
        self.plane.height().div_ceil(self.rows())
    }

    /// The two rows of a band, the second empty if there is none.
    #[inline(always)]
    fn band(self, band: usize) -> [&'a [u64]; 2] {
        let row = |y: usize| if y < self.plane.height() { self.plane.row(y) } else { self.none };
        if self.eight { [row(2 * band), row(2 * band + 1)] } else { [row(band), self.none] }
    }
}

impl Clusters {
    /// The components of a plane that have at least `min_cells` cells.
    pub fn collect(
        &mut self,
        plane: &BitPlane,
        neighbourhood: Neighbourhood,
        min_cells: usize,
        found: &mut FrontierCells,
    ) {
        let Self { of_run, none } = self;
        none.resize(plane.row_words(), 0);
        let bands = Bands { plane, none, eight: neighbourhood == Neighbourhood::Eight };
        with_bit_counts(Connect { of_run, bands });
        with_bit_counts(Count { of_run, bands });
        let (mut kept, mut total) = (0, 0);
        for run in of_run.iter_mut().filter(|run| **run & FIRST != 0) {
            let cells = *run & !FIRST;
            if cells as usize >= min_cells {
                kept += 1;
                total += cells;
            } else {
                *run = FIRST | PLACED;
            }
        }
        let (cells, ends) = found.prepare(total as usize, kept);
        with_bit_counts(List { of_run, bands, cells, ends });
        found.finish();
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.of_run.capacity() * size_of::<u32>() + self.none.capacity() * size_of::<u64>()
    }
}

/// Gives each run of each band a parent.
struct Connect<'a> {
    of_run: &'a mut Vec<u32>,
    bands: Bands<'a>,
}

impl BitWork for Connect<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of_run, bands } = self;
        of_run.clear();
        let most_in_band = (bands.plane.row_words() * WORD_CELLS / 2) as u32;
        let (mut below_first, mut first) = (0, 0);
        let mut below = [bands.none; 2];
        for band in 0..bands.count() {
            // There may be a run for every fourth cell.
            make_room(of_run, first, most_in_band, 32);
            let rows = bands.band(band);
            let nearest = if bands.eight { below[1] } else { below[0] };
            let words = rows[0].iter().zip(rows[1]).zip(below[0].iter().zip(below[1]).zip(nearest));
            let words = words.map(|((a, b), ((c, d), &near))| [(a | b, *a), (c | d, near)]);
            let count = for_each_band_contact(words, bands.eight, |run, below_run| {
                unite(of_run, first + run, below_first + below_run);
            });
            (below, below_first, first) = (rows, first, first + count);
        }
        of_run.truncate(first as usize);
    }
}

/// Replaces parents by the first runs, and writes to those the numbers of cells.
struct Count<'a> {
    of_run: &'a mut [u32],
    bands: Bands<'a>,
}

impl BitWork for Count<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of_run, bands } = self;
        let (mut begun, mut first) = (0, 0);
        for band in 0..bands.count() {
            let [a, b] = bands.band(band);
            let mut starts = Starts::default();
            for (&a, &b) in a.iter().zip(b) {
                let mut rest = a | b;
                let begins = starts.of(rest);
                while rest != 0 {
                    let lowest = rest & rest.wrapping_neg();
                    if begins & lowest != 0 {
                        // Parents come first, and so know their own first run already.
                        let parent = of_run[begun];
                        first = parent as usize;
                        if first == begun {
                            of_run[begun] = FIRST;
                        } else {
                            first = first_of(of_run[first], first);
                            of_run[begun] = first as u32;
                        }
                        begun += 1;
                    }
                    let run = rest & !rest.wrapping_add(lowest);
                    of_run[first] += (a & run).count_ones() + (b & run).count_ones();
                    rest &= !run;
                }
            }
        }
    }
}

/// The first run of the component of a run with this entry and place.
#[inline(always)]
const fn first_of(entry: u32, place: usize) -> usize {
    if entry & FIRST != 0 { place } else { entry as usize }
}

/// Puts all cells in their places, in row-major order; a component gets its place with its
/// first cell.
struct List<'a> {
    of_run: &'a mut [u32],
    bands: Bands<'a>,
    /// The cells of what is kept, and one more that takes all that is dropped: to write
    /// it is faster than to ask for each.
    cells: &'a mut [Cell],
    /// Where the next cell of each component goes, after the first entry.
    ends: &'a mut [u32],
}

impl BitWork for List<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of_run, bands, cells, ends } = self;
        let dropped = cells.len() - 1;
        ends[0] = dropped as u32;
        let (mut first, mut known, mut next) = (0, 0, 0);
        for band in 0..bands.count() {
            let rows = bands.band(band);
            let mut count = 0;
            for (y, row) in (bands.rows() * band..).zip(rows).take(bands.rows()) {
                let mut starts = Starts::default();
                let mut before = first;
                for (index, (&word, (a, b))) in row.iter().zip(rows[0].iter().zip(rows[1])).enumerate() {
                    let begins = starts.of(a | b);
                    let mut rest = word;
                    while rest != 0 {
                        let so_far = rest ^ (rest - 1);
                        let run = before + (begins & so_far).count_ones() as usize - 1;
                        let first_run = first_of(of_run[run], run);
                        let mut entry = of_run[first_run];
                        if entry & PLACED == 0 {
                            known += 1;
                            ends[known] = next;
                            next += entry & !FIRST;
                            entry = FIRST | PLACED | known as u32;
                            of_run[first_run] = entry;
                        }
                        let x = index * WORD_CELLS + rest.trailing_zeros() as usize;
                        let place = &mut ends[(entry & !(FIRST | PLACED)) as usize];
                        cells[(*place as usize).min(dropped)] = Cell::new(x as i32, y as i32);
                        *place += 1;
                        rest &= rest - 1;
                    }
                    before += begins.count_ones() as usize;
                }
                count = before - first;
            }
            first += count;
        }
    }
}
