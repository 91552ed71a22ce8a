//! How many cells the components have, and which are worth a number.

use super::Bands;
use super::list::UNPLACED;
use crate::grid::BitWork;

/// Of a run: it is the first of its component, and what stands with it is the number of
/// the component's cells.
const FIRST: u32 = 1 << 31;

/// Replaces parents by the first runs, and writes to those the numbers of cells.
pub(super) struct Count<'a> {
    pub of_run: &'a mut [u32],
    pub bands: Bands<'a>,
}

impl BitWork for Count<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of_run, bands } = self;
        // Parents come first, and so know their own first run already.
        for run in 0..of_run.len() {
            let parent = of_run[run];
            let first = first_of(of_run[parent as usize], parent);
            of_run[run] = if parent as usize == run { FIRST } else { first };
        }
        let mut next = 0;
        for band in 0..bands.count() {
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
const fn first_of(entry: u32, place: u32) -> u32 {
    let is_first = (entry.cast_signed() >> 31).cast_unsigned();
    place & is_first | entry & !is_first
}

/// Replaces first runs by the numbers of components, from 1 on for those with so many cells
/// at least, and writes the numbers of their cells. How many cells they have together.
pub(super) fn number(of_run: &mut [u32], min_cells: usize, sizes: &mut Vec<u32>) -> u32 {
    sizes.clear();
    sizes.push(0);
    let mut total = 0;
    for run in 0..of_run.len() {
        let entry = of_run[run];
        let size = entry & !FIRST;
        of_run[run] = if entry & FIRST == 0 {
            of_run[entry as usize]
        } else if size as usize >= min_cells {
            sizes.push(UNPLACED | size);
            total += size;
            sizes.len() as u32 - 1
        } else {
            0
        };
    }
    total
}
