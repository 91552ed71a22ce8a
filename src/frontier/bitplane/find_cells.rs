//! Finds again which cells are frontier cells, in words of which something changed.

use crate::bits::neighbours::neighbours_of_row;
use crate::bits::word_spans::{WordSpan, WordSpans};
use crate::bits::{BitPlane, BitWork};
use crate::grid::Neighbourhood;

/// Finds the frontier cells of words: the unknown ones that are reached, or beside what is.
/// Notes the words in which they are others than before.
pub(super) struct FindCells<'a> {
    pub reached: &'a BitPlane,
    pub unknown: &'a BitPlane,
    pub beside: Option<Neighbourhood>,
    pub stale: &'a WordSpans,
    /// Room for a row.
    pub row: &'a mut [u64],
    pub frontier: &'a mut BitPlane,
    pub regroup: &'a mut WordSpans,
}

impl BitWork for FindCells<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { reached, unknown, beside, stale, row, frontier, regroup } = self;
        for (y, span) in stale.iter() {
            let words = span.words();
            let row = &mut row[words.clone()];
            match beside {
                Some(neighbours) => neighbours_of_row(reached, neighbours, y, words.clone(), row),
                None => row.copy_from_slice(&reached.row(y)[words.clone()]),
            }
            let unknown = &unknown.row(y)[words.clone()];
            let known = &mut frontier.row_mut(y)[words.clone()];
            let mut differ = WordSpan::NONE;
            for (i, (known, (row, unknown))) in words.zip(known.iter_mut().zip(row.iter().zip(unknown))) {
                let found = row & unknown;
                if *known != found {
                    *known = found;
                    differ.join(WordSpan::of(&(i..i + 1)));
                }
            }
            regroup.add(y, differ);
        }
    }
}
