//! What is connected to one cell, when that is little.
//!
//! A scan-line fill over the runs of a plane (Smith, "Tint Fill", SIGGRAPH 1979) that
//! gives up after so many runs. Labelling a whole plane costs its runs wherever they
//! are, a fill only those that it reaches, though more for each: a robot shut into a
//! corner of a noisy map is answered here, all else by [`super::runs`].

use crate::grid::{BitPlane, Cell, Neighbourhood};
use std::ops::Range;

/// The fill, with the buffer it keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Flood {
    /// Runs taken whose neighbours are still to be looked at, each with its row.
    open: Vec<(usize, Range<usize>)>,
}

impl Flood {
    /// Clears all cells of a plane that are connected to the seed. Gives up, with an
    /// unspecified part of them cleared, once it has met more than `max_runs` runs.
    pub fn clear_connected(
        &mut self,
        plane: &mut BitPlane,
        seed: Cell,
        neighbourhood: Neighbourhood,
        max_runs: usize,
    ) -> Option<()> {
        let margin = usize::from(neighbourhood == Neighbourhood::Eight);
        let (x, y) = (usize::try_from(seed.x).ok()?, usize::try_from(seed.y).ok()?);
        self.open.clear();
        self.take(plane, y, x..x + 1);
        let mut runs = 0;
        while let Some((y, run)) = self.open.pop() {
            runs += 1;
            if runs > max_runs {
                return None;
            }
            let touched = run.start.saturating_sub(margin)..(run.end + margin).min(plane.width());
            if y > 0 {
                self.take(plane, y - 1, touched.clone());
            }
            if y + 1 < plane.height() {
                self.take(plane, y + 1, touched);
            }
        }
        Some(())
    }

    /// Clears all runs of a row that have a cell within the columns given, and keeps
    /// them for later.
    fn take(&mut self, plane: &mut BitPlane, y: usize, mut columns: Range<usize>) {
        while let Some(x) = plane.first_in(y, columns.clone()) {
            let run = plane.run_around(y, x);
            plane.clear_run(y, run.start, run.end);
            columns.start = run.end;
            self.open.push((y, run));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many cells a fill leaves of two shapes, of three runs and five cells and of
    /// two runs and six cells, that meet at a corner.
    fn left_by(neighbourhood: Neighbourhood, max_runs: usize) -> Option<usize> {
        let mut plane = BitPlane::new(5, 4);
        for (y, line) in ["#.#..", "###..", "...##", "####."].iter().enumerate() {
            for (x, _) in line.match_indices('#') {
                plane.insert(Cell::new(x as i32, y as i32));
            }
        }
        let filled = Flood::default().clear_connected(&mut plane, Cell::new(2, 0), neighbourhood, max_runs);
        filled.map(|()| plane.count())
    }

    #[test]
    fn a_fill_takes_what_is_connected_or_gives_up() {
        assert_eq!(left_by(Neighbourhood::Four, 3), Some(6));
        assert_eq!(left_by(Neighbourhood::Four, 2), None);
        assert_eq!(left_by(Neighbourhood::Eight, 5), Some(0));
        assert_eq!(left_by(Neighbourhood::Eight, 4), None);
    }
}
