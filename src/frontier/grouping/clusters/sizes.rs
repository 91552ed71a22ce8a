//! Counts the cells of components and numbers those that are large enough to be frontiers.

use super::bands::Bands;
use super::list::UNPLACED;
use crate::bits::BitWork;
use std::ops::Range;

/// Tag of a run's entry: the run is the first of its component, and the other bits count the
/// component's cells. Without the tag, the entry is the index of the component's first run.
pub(crate) const FIRST: u32 = 1 << 31;
/// Second tag of a first run's entry: its component goes on in another strip, and the other bits
/// are the component's index in the list of such components.
pub(crate) const CROSSING: u32 = 1 << 30;

/// Replaces parents by the first runs, and writes to those the numbers of cells.
pub(crate) struct Count<'a> {
    pub of_run: &'a mut [u32],
    pub bands: Bands<'a>,
    /// The bands that the runs are of.
    pub strip: Range<usize>,
}

impl BitWork for Count<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of_run, bands, strip } = self;
        // Parents come first, and so know their own first run already.
        for run in 0..of_run.len() {
            let parent = of_run[run];
            let first = first_of(of_run[parent as usize], parent);
            of_run[run] = if parent as usize == run { FIRST } else { first };
        }
        let mut next = 0;
        for band in strip {
            let [a, b] = bands.band(band);
            let mut last = 0;
            for (&a, &b) in a.iter().zip(b) {
                let mut rest = a | b;
                // A run that goes on from the word before is not a new one.
                next -= (rest & last) as u32;
                last = rest >> 63;
                while rest != 0 {
                    let run = rest & !rest.wrapping_add(rest & rest.wrapping_neg());
                    let first = first_of(of_run[next as usize], next);
                    of_run[first as usize] += (a & run).count_ones() + (b & run).count_ones();
                    next += 1;
                    rest &= !run;
                }
            }
        }
    }
}

/// The first run of the component of a run with this entry and place. There is no branch,
/// as nobody can guess which run is a first.
#[inline(always)]
pub(crate) const fn first_of(entry: u32, place: u32) -> u32 {
    let is_first = (entry.cast_signed() >> 31).cast_unsigned();
    place & is_first | entry & !is_first
}

/// Components that are kept.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Kept {
    /// How many.
    pub components: usize,
    /// How many cells they have together.
    pub cells: usize,
}

impl Kept {
    /// Adds those of a strip that have so many cells at least and do not cross its borders.
    pub fn add(&mut self, of_run: &[u32], min_cells: usize) {
        let (mut components, mut cells) = (0, 0);
        for &entry in of_run {
            let size = entry & !FIRST;
            let is_kept = entry & FIRST != 0 && size & CROSSING == 0 && size as usize >= min_cells;
            components += usize::from(is_kept);
            cells += if is_kept { size as usize } else { 0 };
        }
        self.components += components;
        self.cells += cells;
    }
}

/// Replaces first runs by the numbers of components, and writes the numbers of their cells to
/// `notes`: from `next` on for those with so many cells at least that do not cross the
/// strip's borders; `crossing` has the numbers of the others. The next number.
pub(crate) fn number(
    of_run: &mut [u32],
    min_cells: usize,
    crossing: &[u32],
    notes: &mut [u32],
    mut next: usize,
) -> usize {
    for run in 0..of_run.len() {
        let entry = of_run[run];
        let size = entry & !FIRST;
        of_run[run] = if entry & FIRST == 0 {
            of_run[entry as usize]
        } else if size & CROSSING != 0 {
            crossing[(size & !CROSSING) as usize]
        } else if size as usize >= min_cells {
            notes[next] = UNPLACED | size;
            next += 1;
            next as u32 - 1
        } else {
            0
        };
    }
    next
}
