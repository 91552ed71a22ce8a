//! The connected components of a plane.
//!
//! Two-pass labelling by runs after He, Chao and Suzuki, "A Run-Based Two-Scan Labeling
//! Algorithm" (IEEE Transactions on Image Processing 2008). Runs are never written down:
//! see [`super::contacts`]. O(words + runs), up to a factor that grows as the inverse
//! Ackermann function.

use crate::bits::contacts::{Starts, count_runs, for_each_contact};
use crate::bits::union_find::{UniteRuns, make_room};
use crate::bits::window::Window;
use crate::bits::{BitPlane, BitWork, WORD_CELLS, with_bit_instructions};
use crate::grid::{Cell, Neighbourhood};

/// The component of each run of a window, in row-major order. The buffers are kept from
/// one window to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Labels {
    /// While labelling, a run of the same component that is not after it; then the
    /// number of the component.
    of_run: Vec<u32>,
    /// Index of the first run of each row, and of the end.
    row_first: Vec<u32>,
    components: usize,
}

impl Labels {
    /// Labels the runs of a window of a plane: components are numbered in the order of
    /// their first cells.
    pub fn label(&mut self, plane: &BitPlane, window: &Window, neighbourhood: Neighbourhood) {
        with_bit_instructions(ConnectRows { labels: self, plane, window, neighbourhood });
        self.number();
    }

    /// Number of components.
    pub const fn components(&self) -> usize {
        self.components
    }

    /// The components of the runs of a row, which is counted from the window's first.
    pub fn row(&self, row: usize) -> &[u32] {
        match (self.row_first.get(row), self.row_first.get(row + 1)) {
            (Some(&first), Some(&end)) => &self.of_run[first as usize..end as usize],
            _ => &[],
        }
    }

    /// The component of a cell, `None` where the labelled plane is not set or the cell is
    /// not in the window.
    pub fn component_at(&self, plane: &BitPlane, window: &Window, cell: Cell) -> Option<u32> {
        let (x, y) = (usize::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
        if !plane.contains(cell) || !window.rows.contains(&y) || !window.words.contains(&(x / WORD_CELLS)) {
            return None;
        }
        let (before, from) = window.row(plane, y).split_at(x / WORD_CELLS - window.words.start);
        let up_to = u64::MAX >> (63 - x % WORD_CELLS);
        let last = before.last().map_or(0, |word| word >> 63);
        let here = from.first().map_or(0, |word| word & !(word << 1 | last) & up_to);
        let begun = count_runs(before) + here.count_ones();
        self.row(y - window.rows.start).get((begun as usize).checked_sub(1)?).copied()
    }

    /// Hands over each word of the labelled window, by row and place in the plane, with
    /// the bits alone whose component is kept.
    #[inline]
    pub fn select(
        &self,
        plane: &BitPlane,
        window: &Window,
        is_kept: impl Fn(u32) -> bool,
        mut visit: impl FnMut(usize, usize, u64),
    ) {
        let mut next = self.of_run.iter();
        for y in window.rows.clone() {
            let mut starts = Starts::default();
            let mut keep = false;
            for (i, &word) in window.words.clone().zip(window.row(plane, y)) {
                let begun = starts.of(word);
                let (mut rest, mut kept) = (word, 0);
                while rest != 0 {
                    let lowest = rest & rest.wrapping_neg();
                    if begun & lowest != 0 {
                        keep = next.next().is_some_and(|&component| is_kept(component));
                    }
                    let run = rest & !rest.wrapping_add(lowest);
                    kept |= if keep { run } else { 0 };
                    rest &= !run;
                }
                visit(y, i, kept);
            }
        }
    }

    /// What the labels take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        (self.of_run.capacity() + self.row_first.capacity()) * size_of::<u32>()
    }

    /// Replaces parents by the numbers of components. A run's parent comes before it and
    /// so has its number already.
    fn number(&mut self) {
        let mut next = 0;
        for run in 0..self.of_run.len() {
            let parent = self.of_run[run] as usize;
            self.of_run[run] = if parent == run { next } else { self.of_run[parent] };
            next += u32::from(parent == run);
        }
        self.components = next as usize;
    }
}

/// The first pass.
struct ConnectRows<'a> {
    labels: &'a mut Labels,
    plane: &'a BitPlane,
    window: &'a Window,
    neighbourhood: Neighbourhood,
}

impl BitWork for ConnectRows<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { labels: Labels { of_run, row_first, .. }, plane, window, neighbourhood } = self;
        let eight = neighbourhood == Neighbourhood::Eight;
        row_first.clear();
        of_run.clear();
        let most_in_row = (window.words.len() * WORD_CELLS / 2) as u32;
        let (mut above_first, mut first) = (0, 0);
        let mut above: &[u64] = &[];
        for y in window.rows.clone() {
            row_first.push(first);
            // There may be a run for every other cell.
            make_room(of_run, first, most_in_row, 8);
            let row = window.row(plane, y);
            let unite = UniteRuns { parents: of_run, first, other_first: above_first };
            let count = for_each_contact(row, above, eight, unite);
            (above, above_first, first) = (row, first, first + count);
        }
        row_first.push(first);
        of_run.truncate(first as usize);
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
        let mut labels = Labels::default();
        let all = Window::of(&plane);
        labels.label(&plane, &all, neighbourhood);
        let letter = |c: u32| char::from(b'a' + c as u8);
        let at = |x, y| labels.component_at(&plane, &all, Cell::new(x as i32, y as i32)).map_or('.', letter);
        let found = (0..plane.height()).map(|y| (0..plane.width()).map(|x| at(x, y)).collect()).collect();
        for kept in 0..labels.components() as u32 {
            let mut rest = BitPlane::new(plane.width(), plane.height());
            labels.select(&plane, &all, |component| component == kept, |y, i, word| rest.row_mut(y)[i] = word);
            for y in 0..plane.height() {
                for x in 0..plane.width() {
                    let cell = Cell::new(x as i32, y as i32);
                    assert_eq!(
                        rest.contains(cell),
                        labels.component_at(&plane, &all, cell) == Some(kept),
                        "{kept} {cell:?}"
                    );
                }
            }
        }
        found
    }

    #[test]
    fn corners_connect_eight_neighbours_only() {
        let drawing = ["##..#", "..##.", "#...#"];
        assert_eq!(labelled(&drawing, Neighbourhood::Four), ["aa..b", "..cc.", "d...e"]);
        assert_eq!(labelled(&drawing, Neighbourhood::Eight), ["aa..a", "..aa.", "b...a"]);
    }

    #[test]
    fn a_component_is_numbered_by_its_first_run_however_late_it_joins() {
        let drawing = ["#.#.#.#", "#.#.#..", "#.###..", "###...#"];
        assert_eq!(labelled(&drawing, Neighbourhood::Four), ["a.a.a.b", "a.a.a..", "a.aaa..", "aaa...c"]);
    }

    #[test]
    fn corners_connect_across_the_seams_of_words() {
        let line = |column: usize| format!("{}#", ".".repeat(column));
        for (above, below) in [(63, 64), (64, 63), (127, 128), (128, 127), (62, 63), (63, 62)] {
            let (above, below) = (format!("{:.<130}", line(above)), format!("{:.<130}", line(below)));
            let components = |neighbourhood| {
                let drawn = labelled(&[&above, &below], neighbourhood).concat();
                drawn.chars().filter(char::is_ascii_lowercase).collect::<String>()
            };
            assert_eq!((components(Neighbourhood::Four), components(Neighbourhood::Eight)), ("ab".into(), "aa".into()));
        }
    }

    #[test]
    fn a_window_sees_nothing_around_it() {
        let mut plane = BitPlane::new(192, 4);
        for (x, y) in [(60, 1), (64, 1), (70, 1), (64, 2), (70, 2), (71, 3)] {
            plane.insert(Cell::new(x, y));
        }
        // A bridge from the one to the other outside.
        (60..80).for_each(|x| plane.insert(Cell::new(x, 0)));
        let window = Window { rows: 1..3, words: 1..2 };
        let mut labels = Labels::default();
        labels.label(&plane, &window, Neighbourhood::Eight);
        assert_eq!((labels.row(0), labels.row(1), labels.components()), (&[0, 1][..], &[0, 1][..], 2));
        assert_eq!(labels.component_at(&plane, &window, Cell::new(70, 2)), Some(1));
        for outside in [Cell::new(60, 1), Cell::new(71, 3), Cell::new(65, 1), Cell::new(-1, 1)] {
            assert_eq!(labels.component_at(&plane, &window, outside), None);
        }
    }

    #[test]
    fn runs_cross_words_and_end_with_them() {
        let mut plane = BitPlane::new(128, 2);
        plane.row_mut(0).copy_from_slice(&[1 << 63 | 1, u64::MAX]);
        plane.row_mut(1).copy_from_slice(&[0, 1 << 63]);
        let mut labels = Labels::default();
        labels.label(&plane, &Window::of(&plane), Neighbourhood::Four);
        assert_eq!(labels.of_run, [0, 1, 1]);
        assert_eq!((labels.row_first.as_slice(), labels.components()), (&[0, 2, 3][..], 2));
    }
}
