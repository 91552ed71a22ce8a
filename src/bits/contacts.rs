//! Where the runs of one row touch those of the row above it, by expressions of bits.
//!
//! A run is known by how many of its row begin before it, which is a count of bits. Two
//! runs that overlap have one first column in common; of two that meet at a corner alone,
//! one begins in the column after the end of the other. So each pair of runs that touch is
//! met exactly once, in a column up to which both have begun, and there is a branch for each
//! such pair and no other.

/// Finds where runs begin, word by word along a row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Starts {
    /// The last cell of the word before.
    last: u64,
}

impl Starts {
    /// The cells at which a run begins.
    #[inline(always)]
    pub fn of(&mut self, word: u64) -> u64 {
        let starts = word & !(word << 1 | self.last);
        self.last = word >> 63;
        starts
    }
}

/// Number of runs of a row.
#[inline(always)]
pub(crate) fn count_runs(row: &[u64]) -> u32 {
    let mut starts = Starts::default();
    row.iter().map(|&word| starts.of(word).count_ones()).sum()
}

/// Who wants to know which runs touch: a closure, or a type of its own where the call has to
/// be compiled into the work that it is part of.
pub(crate) trait Meet {
    /// Takes the places of two runs that prefetch, each in its row.
    fn meet(&mut self, run: u32, above_run: u32);
}

impl<F: FnMut(u32, u32)> Meet for F {
    #[inline(always)]
    fn meet(&mut self, run: u32, above_run: u32) {
        self(run, above_run);
    }
}

/// Calls `visit` with the places of two runs in their rows, that of `row` first, for each
/// pair that touches. With `eight`, corners touch. Rows are as long as each other, or
/// `above` is empty. The number of runs of `row`.
#[inline(always)]
pub(crate) fn for_each_contact(row: &[u64], above: &[u64], eight: bool, visit: impl Meet) -> u32 {
    if above.is_empty() {
        return count_runs(row);
    }
    let words = row.iter().zip(above);
    for_each_band_contact(words.map(|(&word, &over)| [(word, word), (over, over)]), eight, visit)
}

/// The same for bands of rows. Of each band and of the one above it come word by word the
/// columns in which it has a cell, whose runs are meant, and the cells of that of its rows
/// which lies beside the other band. A pair may be met more than once.
#[inline(always)]
pub(crate) fn for_each_band_contact(
    words: impl Iterator<Item = [(u64, u64); 2]>,
    eight: bool,
    mut visit: impl Meet,
) -> u32 {
    // The last columns of the words before, and the last cells of the rows between.
    let (mut last, mut over_last) = ((0, 0), (0, 0));
    // How many runs began before this word.
    let (mut before, mut above_before) = (0, 0);
    for [(band, cells), (over_band, over)] in words {
        // Most words of most maps.
        if band | over_band | last.0 == 0 {
            over_last = (0, 0);
            continue;
        }
        let begun = band & !(band << 1 | last.0);
        let above_begun = over_band & !(over_band << 1 | over_last.0);
        let (cells_before, over_before) = (cells << 1 | last.1, over << 1 | over_last.1);
        // Where two runs begin to overlap.
        let mut contacts = cells & over & !(cells_before & over_before);
        if eight {
            // Where one begins right after the end of the other.
            contacts |= (cells ^ over) & (cells ^ cells_before) & (over ^ over_before);
        }
        while contacts != 0 {
            let so_far = contacts ^ (contacts - 1);
            let run = before + (begun & so_far).count_ones() - 1;
            visit.meet(run, above_before + (above_begun & so_far).count_ones() - 1);
            contacts &= contacts - 1;
        }
        before += begun.count_ones();
        above_before += above_begun.count_ones();
        (last, over_last) = ((band >> 63, cells >> 63), (over_band >> 63, over >> 63));
    }
    before
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The columns of each run.
    fn runs(row: &[u64]) -> Vec<(usize, usize)> {
        let set = |x: usize| row.get(x / 64).is_some_and(|word| word >> (x % 64) & 1 == 1);
        let starts = (0..row.len() * 64).filter(|&x| set(x) && (x == 0 || !set(x - 1)));
        starts.map(|start| (start, (start..).find(|&x| !set(x)).unwrap())).collect()
    }

    fn row() -> impl Strategy<Value = Vec<u64>> {
        proptest::collection::vec(
            prop_oneof![Just(0), Just(u64::MAX), any::<u64>(), any::<u64>().prop_map(|w| w | w << 1 | w >> 1)],
            3,
        )
    }

    proptest! {
        #[test]
        fn each_pair_that_touches_is_met_once(row in row(), above in row(), eight: bool) {
            let mut met = Vec::new();
            let count = for_each_contact(&row, &above, eight, |run, over| met.push((run as usize, over as usize)));
            met.sort_unstable();
            let (here, over) = (runs(&row), runs(&above));
            prop_assert_eq!((count as usize, count_runs(&row) as usize), (here.len(), here.len()));
            let margin = usize::from(eight);
            let mut expected = Vec::new();
            for (i, a) in here.iter().enumerate() {
                for (j, b) in over.iter().enumerate() {
                    if a.0 < b.1 + margin && b.0 < a.1 + margin {
                        expected.push((i, j));
                    }
                }
            }
            prop_assert_eq!(met, expected);
        }
    }
}
