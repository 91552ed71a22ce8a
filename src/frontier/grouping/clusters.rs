//! Connected components of a plane of frontier cells, found two rows at a time, with their cells.
//!
//! Labelling by runs as in `bits::labels`, but for eight neighbours of two rows at a
//! time: columns beside each other that have a cell in either row are connected, whichever
//! row it is in (He, Chao and Suzuki, "An Efficient First-Scan Method for Label-Equivalence-
//! Based Labeling Algorithms", Pattern Recognition Letters 2010). Such bands have half as
//! many runs, which is half the work of uniting and half the memory.
//!
//! Where runs are so many that their labels would take too much memory, as in noise, the plane
//! is cut into strips whose runs are labelled one strip after the other, and once more to
//! list the cells, when it is known which components cross from strip to strip and how large
//! they are.

mod bands;
mod crossing;
mod list;
mod sizes;

use crate::bits::union_find::{UniteRuns, make_room};
use crate::bits::{BitPlane, BitWork, WORD_CELLS, with_bit_instructions};
use crate::frontier::grouping::cell_lists::FrontierCells;
use crate::grid::Neighbourhood;
use bands::Bands;
use crossing::Crossing;
use list::{Given, List, Piece};
use sizes::{Count, Kept, number};
use std::ops::Range;

/// There is one strip as long as there is not more than a run for so many cells: a label
/// takes four bytes.
const CELLS_PER_RUN: usize = 32;

/// Groups the cells of planes into frontiers, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clusters {
    /// Of each run of a strip one of the same component that is not after it, while they
    /// are connected; then the first; then the number of the component, where 0 stands for
    /// all that are dropped.
    of_run: Vec<u32>,
    /// The words of a row that have cells.
    pieces: Vec<Piece>,
    /// A row without a cell, beyond the last.
    none: Vec<u64>,
    crossing: Crossing,
}

/// Bands whose runs are labelled together.
#[derive(Clone, Debug)]
struct Strip {
    bands: Range<usize>,
    /// The runs of its first band and of its last.
    first_runs: Range<usize>,
    last_runs: Range<usize>,
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
        let mut none = std::mem::take(&mut self.none);
        none.resize(plane.row_words(), 0);
        self.pieces.resize(plane.row_words() + 2, Piece::default());
        let bands = Bands { plane, none: &none, eight: neighbourhood == Neighbourhood::Eight };
        let (whole, mut kept) = self.measure(bands, min_cells);
        let notes = found.notes();
        notes.clear();
        notes.push(0);
        kept.cells += self.crossing.number(min_cells, notes);
        let mut next = notes.len();
        notes.resize(next + kept.components, 0);
        let mut room = found.prepare(kept.cells, plane.width());
        let mut given = Given::default();
        self.crossing.start_again();
        let mut start = 0;
        while start < bands.count() {
            let strip = if whole { 0..bands.count() } else { self.label(bands, start).bands };
            start = strip.end;
            let Self { of_run, pieces, crossing, .. } = self;
            next = number(of_run, min_cells, crossing.numbers(), room.notes, next);
            with_bit_instructions(List { of_run, pieces, bands, strip, given: &mut given, room: &mut room });
        }
        found.finish(kept.cells);
        self.none = none;
    }

    /// Labels all strips and notes what crosses their borders. Whether there is one alone,
    /// whose labels are there then, and what is kept of the components that do not cross.
    fn measure(&mut self, bands: Bands<'_>, min_cells: usize) -> (bool, Kept) {
        let mut kept = Kept::default();
        self.crossing.clear();
        let mut start = 0;
        while start < bands.count() {
            let strip = self.label(bands, start);
            let Self { of_run, crossing, .. } = self;
            if start > 0 {
                let join = |run, run_below| crossing.join(of_run, run, run_below);
                bands.for_each_contact(bands.band(start), bands.band(start - 1), join);
            }
            if strip.bands.end < bands.count() {
                crossing.keep_last(of_run, strip.last_runs);
            }
            kept.add(of_run, min_cells);
            start = strip.bands.end;
            if strip.bands == (0..bands.count()) {
                return (true, kept);
            }
        }
        (false, kept)
    }

    /// Labels the runs of the next strip, each with the first of its component, which has
    /// the number of its cells or the name of what crosses the borders.
    fn label(&mut self, bands: Bands<'_>, start: usize) -> Strip {
        let Self { of_run, crossing, .. } = self;
        let most_runs = bands.plane.width() * bands.plane.height() / CELLS_PER_RUN;
        let strip = with_bit_instructions(Connect { of_run, bands, start, most_runs });
        with_bit_instructions(Count { of_run, bands, strip: strip.bands.clone() });
        let below = if start > 0 { strip.first_runs.clone() } else { 0..0 };
        let above = if strip.bands.end < bands.count() { strip.last_runs.clone() } else { 0..0 };
        crossing.name(of_run, [below, above]);
        strip
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.of_run.capacity() * size_of::<u32>()
            + self.pieces.capacity() * size_of::<Piece>()
            + self.none.capacity() * size_of::<u64>()
            + self.crossing.memory_bytes()
    }
}

/// Gives each run of each band of a strip a parent.
struct Connect<'a> {
    of_run: &'a mut Vec<u32>,
    bands: Bands<'a>,
    /// The first band of the strip.
    start: usize,
    /// The strip ends before it may have more runs, but for its first band.
    most_runs: usize,
}

impl BitWork for Connect<'_> {
    type Output = Strip;

    #[inline(always)]
    fn run(self) -> Strip {
        let Self { of_run, bands, start, most_runs } = self;
        of_run.clear();
        // There may be a run for every other column.
        let most_in_band = (bands.plane.row_words() * WORD_CELLS / 2) as u32;
        let mut strip = Strip { bands: start..start, first_runs: 0..0, last_runs: 0..0 };
        let (mut below_first, mut first) = (0, 0);
        let mut below = [bands.none; 2];
        while strip.bands.end < bands.count() {
            if strip.bands.end > start && (first + most_in_band) as usize > most_runs {
                break;
            }
            make_room(of_run, first, most_in_band, 32);
            let rows = bands.band(strip.bands.end);
            let unite = UniteRuns { parents: of_run, first, other_first: below_first };
            let count = bands.for_each_contact(rows, below, unite);
            strip.last_runs = first as usize..(first + count) as usize;
            if strip.bands.end == start {
                strip.first_runs = strip.last_runs.clone();
            }
            (below, below_first, first) = (rows, first, first + count);
            strip.bands.end += 1;
        }
        of_run.truncate(first as usize);
        strip
    }
}
