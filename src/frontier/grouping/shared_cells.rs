//! The cells of one frontier, as part of what a detection found.

use crate::frontier::grouping::cell_lists::FrontierCells;
use crate::grid::Cell;
use std::fmt;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// Cells of a grid: a slice of a list that the frontiers of a detection share, so that
/// thousands of them cost one allocation and to copy one costs none.
#[derive(Clone, Default)]
pub struct Cells {
    list: Arc<FrontierCells>,
    range: Range<usize>,
}

impl Cells {
    /// The cells of one frontier of a list.
    pub(crate) fn of(list: &Arc<FrontierCells>, frontier: usize) -> Self {
        Self { list: Arc::clone(list), range: list.range(frontier) }
    }
}

impl Deref for Cells {
    type Target = [Cell];

    fn deref(&self) -> &[Cell] {
        self.list.cells().get(self.range.clone()).unwrap_or_default()
    }
}

impl From<Vec<Cell>> for Cells {
    fn from(cells: Vec<Cell>) -> Self {
        Self { range: 0..cells.len(), list: Arc::new(FrontierCells::of_one(cells)) }
    }
}

impl FromIterator<Cell> for Cells {
    fn from_iter<I: IntoIterator<Item = Cell>>(cells: I) -> Self {
        Vec::from_iter(cells).into()
    }
}

impl<'a> IntoIterator for &'a Cells {
    type Item = &'a Cell;
    type IntoIter = std::slice::Iter<'a, Cell>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl PartialEq for Cells {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Cells {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}
