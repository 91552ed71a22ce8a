//! The runs of set bits in a row, one after the other.

use crate::bits::WORD_CELLS;

/// The cells `start..end` of one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// The first column.
    pub start: u32,
    /// One past the last column.
    pub end: u32,
}

/// The runs of a row, the first first.
pub(crate) fn runs_of(row: &[u64]) -> impl Iterator<Item = Run> {
    let mut edges = edges_of(row);
    std::iter::from_fn(move || Some(Run { start: edges.next()?, end: edges.next()? }))
}

/// The starts and ends of the runs of a row in turn. A run begins and ends where a bit
/// differs from the one before it.
fn edges_of(row: &[u64]) -> impl Iterator<Item = u32> {
    let mut last_bit = 0;
    // Beyond the row nothing is set.
    row.iter().chain(&[0]).enumerate().flat_map(move |(index, &word)| {
        let mut changes = word ^ (word << 1 | last_bit);
        last_bit = word >> (WORD_CELLS - 1);
        std::iter::from_fn(move || {
            let next = (changes != 0).then(|| (index * WORD_CELLS) as u32 + changes.trailing_zeros())?;
            changes &= changes - 1;
            Some(next)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_cross_words_and_end_with_them() {
        let runs = |row: &[u64]| runs_of(row).map(|run| (run.start, run.end)).collect::<Vec<_>>();
        assert_eq!(runs(&[1 << 63, u64::MAX << 1 | 1]), [(63, 128)]);
        assert_eq!(runs(&[1 << 63 | 1, 6]), [(0, 1), (63, 64), (65, 67)]);
        assert_eq!(runs(&[0, 1 << 63]), [(127, 128)]);
        assert_eq!(runs(&[]), []);
    }
}
