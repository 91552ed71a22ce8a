//! Runs of set bits and the connected components that they form.
//!
//! Two-pass labelling by runs: He, Chao and Suzuki, "A Run-Based Two-Scan Labeling
//! Algorithm" (IEEE Transactions on Image Processing 2008), over the union-find of
//! [`union_find`]. O(words + runs), up to a factor that grows as the inverse Ackermann
//! function.

use super::union_find;
use crate::grid::{BitPlane, Cell, Neighbourhood, WORD_CELLS};
use std::ops::Range;

/// The cells `start..end` of one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    /// The first column.
    pub start: u32,
    /// One past the last column.
    pub end: u32,
}

/// The runs of a plane in row-major order, each with the component it belongs to. The
/// buffers are kept from one plane to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Runs {
    /// Start and end of each run in turn.
    edges: Vec<u32>,
    /// Index of the first run of each row, and of the end.
    row_first: Vec<u32>,
    /// The component of each run: the index of its first run. Until [`Self::label`] is
    /// done, a run of the same component that is not after it.
    component: Vec<u32>,
}

impl Runs {
    /// Takes in the runs of a plane and connects them.
    pub fn label(&mut self, plane: &BitPlane, neighbourhood: Neighbourhood) {
        self.edges.clear();
        self.component.clear();
        self.row_first.clear();
        self.row_first.push(0);
        // Diagonal neighbours overlap once one of the two runs is a cell longer at
        // both ends.
        let margin = u32::from(neighbourhood == Neighbourhood::Eight);
        let mut above = 0..0;
        for y in 0..plane.height() {
            let first = self.len();
            extract(plane.row(y), &mut self.edges);
            let row = first..self.len();
            self.connect(above, row.clone(), margin);
            self.row_first.push(row.end as u32);
            above = row;
        }
        // A run's parent comes before it and so knows its root already.
        for i in 0..self.component.len() {
            self.component[i] = self.component[self.component[i] as usize];
        }
    }

    /// Number of runs.
    pub const fn len(&self) -> usize {
        self.edges.len() / 2
    }

    /// All runs in row-major order: row, run, component.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Run, u32)> {
        self.row_first.windows(2).enumerate().flat_map(move |(y, bounds)| {
            let row = bounds[0] as usize..bounds[1] as usize;
            self.pairs()[row.clone()]
                .iter()
                .zip(&self.component[row])
                .map(move |(&[start, end], &component)| (y, Run { start, end }, component))
        })
    }

    /// The component of a cell, `None` where the plane was not set.
    pub fn component_at(&self, cell: Cell) -> Option<u32> {
        let (x, y) = (u32::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
        let (first, end) = (*self.row_first.get(y)? as usize, *self.row_first.get(y + 1)? as usize);
        let row = &self.pairs()[first..end];
        let in_row = row.partition_point(|&[_, end]| end <= x);
        (row.get(in_row)?[0] <= x).then(|| self.component[first + in_row])
    }

    /// Clears in the labelled plane, or in one of the same size, all runs that do not
    /// belong to a component.
    pub fn clear_others(&self, plane: &mut BitPlane, kept: Option<u32>) {
        self.iter().filter(|&(.., component)| Some(component) != kept).for_each(|(y, run, _)| {
            plane.clear_run(y, run.start as usize, run.end as usize);
        });
    }

    /// The runs as pairs of start and end.
    fn pairs(&self) -> &[[u32; 2]] {
        self.edges.as_chunks::<2>().0
    }

    /// Gives each run of a row a parent, and unites it with the runs above that it
    /// touches.
    fn connect(&mut self, above: Range<usize>, row: Range<usize>, margin: u32) {
        let Self { edges, component, .. } = self;
        let pairs = edges.as_chunks::<2>().0;
        let mut candidates = &pairs[above.clone()];
        let mut candidate = above.start as u32;
        for (&[start, end], i) in pairs[row.clone()].iter().zip(row.start as u32..) {
            component.push(i);
            while let [[above_start, above_end], rest @ ..] = candidates
                && *above_start < end + margin
            {
                if above_end + margin > start {
                    union_find::unite(component, i, candidate);
                }
                // A run above that goes on beyond this one may touch the next too.
                if *above_end > end {
                    break;
                }
                candidates = rest;
                candidate += 1;
            }
        }
    }
}

/// Appends the runs of one row. A run begins and ends where a bit differs from the one
/// before it, so that the edges of a row, in order, are starts and ends in turn.
fn extract(row: &[u64], edges: &mut Vec<u32>) {
    let mut last_bit = 0;
    for (index, &word) in row.iter().enumerate() {
        let mut changes = word ^ (word << 1 | last_bit);
        last_bit = word >> (WORD_CELLS - 1);
        let base = (index * WORD_CELLS) as u32;
        while changes != 0 {
            edges.push(base + changes.trailing_zeros());
            changes &= changes - 1;
        }
    }
    if last_bit != 0 {
        edges.push((row.len() * WORD_CELLS) as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The components of a drawing's `#` cells, as drawn: a letter for each.
    fn labelled(drawing: &[&str], neighbourhood: Neighbourhood) -> Vec<String> {
        let mut plane = BitPlane::new(drawing[0].len(), drawing.len());
        for (y, line) in drawing.iter().enumerate() {
            for (x, _) in line.match_indices('#') {
                plane.insert(Cell::new(x as i32, y as i32));
            }
        }
        let mut runs = Runs::default();
        runs.label(&plane, neighbourhood);
        let letter = |c: u32| char::from(b'a' + c as u8);
        let at = |x, y| runs.component_at(Cell::new(x as i32, y as i32)).map_or('.', letter);
        (0..plane.height()).map(|y| (0..plane.width()).map(|x| at(x, y)).collect()).collect()
    }

    #[test]
    fn corners_connect_eight_neighbours_only() {
        let drawing = ["##..#", "..##.", "#...#"];
        assert_eq!(labelled(&drawing, Neighbourhood::Four), ["aa..b", "..cc.", "d...e"]);
        assert_eq!(labelled(&drawing, Neighbourhood::Eight), ["aa..a", "..aa.", "d...a"]);
    }

    #[test]
    fn a_component_is_named_by_its_first_run_however_late_it_joins() {
        let drawing = ["#.#.#", "#.#.#", "#.###", "###.."];
        assert_eq!(labelled(&drawing, Neighbourhood::Four), ["a.a.a", "a.a.a", "a.aaa", "aaa.."]);
    }

    #[test]
    fn runs_cross_words_and_end_with_them() {
        let mut plane = BitPlane::new(128, 1);
        plane.row_mut(0).copy_from_slice(&[1 << 63, u64::MAX << 1 | 1]);
        let mut runs = Runs::default();
        runs.label(&plane, Neighbourhood::Four);
        assert_eq!(runs.iter().collect::<Vec<_>>(), [(0, Run { start: 63, end: 128 }, 0)]);
    }
}
