//! Frontiers from a plane of frontier cells: its components, each with its cells.
//!
//! Labelling by runs as in [`super::labels`], but for eight neighbours of two rows at a
//! time: columns beside each other that have a cell in either row are connected, whichever
//! row it is in (He, Chao and Suzuki, "An Efficient First-Scan Method for Label-Equivalence-
//! Based Labeling Algorithms", Pattern Recognition Letters 2010). Such bands have half as
//! many runs, which is half the work of uniting and half the memory.

mod list;
mod sizes;

use super::contacts::for_each_band_contact;
use super::found::FrontierCells;
use super::union_find::{UniteRuns, make_room};
use crate::grid::{BitPlane, BitWork, Neighbourhood, WORD_CELLS, with_bit_instructions};
use list::{List, Piece};
use sizes::{Count, number};

/// Groups the cells of planes into frontiers, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Clusters {
    /// Of each run of the bands one of the same component that is not after it, while they
    /// are connected; then the first; then the number of the component, where 0 stands for
    /// all that are dropped.
    of_run: Vec<u32>,
    /// The words of a row that have cells.
    pieces: Vec<Piece>,
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
        let Self { of_run, pieces, none } = self;
        none.resize(plane.row_words(), 0);
        pieces.resize(plane.row_words() + 2, Piece::default());
        let bands = Bands { plane, none, eight: neighbourhood == Neighbourhood::Eight };
        with_bit_instructions(Connect { of_run, bands });
        with_bit_instructions(Count { of_run, bands });
        let total = number(of_run, min_cells, found.notes());
        let room = found.prepare(total as usize, plane.width());
        with_bit_instructions(List { of_run, pieces, bands, room });
        found.finish(total as usize);
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.of_run.capacity() * size_of::<u32>()
            + self.pieces.capacity() * size_of::<Piece>()
            + self.none.capacity() * size_of::<u64>()
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
            let unite = UniteRuns { parents: of_run, first, other_first: below_first };
            let count = for_each_band_contact(words, bands.eight, unite);
            (below, below_first, first) = (rows, first, first + count);
        }
        of_run.truncate(first as usize);
    }
}
