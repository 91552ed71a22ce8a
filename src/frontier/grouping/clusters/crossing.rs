//! Joins components that go on from one strip of rows to the next.

use super::list::UNPLACED;
use super::sizes::{CROSSING, FIRST, first_of};
use crate::bits::union_find::unite;
use std::ops::Range;

/// All of them, with the buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Crossing {
    /// Of each part, which is a component of a strip, one of the same component that is not
    /// after it.
    parents: Vec<u32>,
    /// Of each part the number of its cells; in the end the number of its component.
    notes: Vec<u32>,
    /// The parts of the runs of the last band of the strip before.
    below: Vec<u32>,
    /// How many parts the strips so far have.
    parts: usize,
}

impl Crossing {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.parents.clear();
        self.notes.clear();
        self.start_again();
    }

    /// Goes back to the first strip, to name the same parts again.
    pub fn start_again(&mut self) {
        self.below.clear();
        self.parts = 0;
    }

    /// Names the parts among the components of the next strip: those that have one of these
    /// runs, of its first band and of its last.
    pub fn name(&mut self, of_run: &mut [u32], runs: [Range<usize>; 2]) {
        for run in runs.into_iter().flatten() {
            let first = first_of(of_run[run], run as u32) as usize;
            if of_run[first] & CROSSING == 0 {
                if self.parts == self.parents.len() {
                    self.parents.push(self.parts as u32);
                    self.notes.push(of_run[first] & !FIRST);
                }
                of_run[first] = FIRST | CROSSING | self.parts as u32;
                self.parts += 1;
            }
        }
    }

    /// Unites the parts of a run of the strip's first band and of one of the band before it,
    /// each counted in its band.
    pub fn join(&mut self, of_run: &[u32], run: u32, run_below: u32) {
        unite(&mut self.parents, part(of_run, run as usize), self.below[run_below as usize]);
    }

    /// Remembers the parts of the runs of the strip's last band.
    pub fn keep_last(&mut self, of_run: &[u32], runs: Range<usize>) {
        self.below.clear();
        self.below.extend(runs.map(|run| part(of_run, run)));
    }

    /// Numbers the components from 1 on that have so many cells at least, and tells the
    /// numbers of their cells; 0 stands for the others. How many cells they have together.
    pub fn number(&mut self, min_cells: usize, sizes: &mut Vec<u32>) -> usize {
        let Self { parents, notes, .. } = self;
        // A parent comes before its children, and so knows its root when they ask.
        for i in 0..parents.len() {
            parents[i] = parents[parents[i] as usize];
            if parents[i] as usize != i {
                notes[parents[i] as usize] += notes[i];
            }
        }
        let mut cells = 0;
        for i in 0..parents.len() {
            notes[i] = if parents[i] as usize != i {
                notes[parents[i] as usize]
            } else if notes[i] as usize >= min_cells {
                cells += notes[i] as usize;
                sizes.push(UNPLACED | notes[i]);
                sizes.len() as u32 - 1
            } else {
                0
            };
        }
        cells
    }

    /// The number of the component of each part.
    pub fn numbers(&self) -> &[u32] {
        &self.notes
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        (self.parents.capacity() + self.notes.capacity() + self.below.capacity()) * size_of::<u32>()
    }
}

/// The part of a run whose component has been named.
fn part(of_run: &[u32], run: usize) -> u32 {
    of_run[first_of(of_run[run], run as u32) as usize] & !(FIRST | CROSSING)
}
