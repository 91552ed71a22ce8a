//! Classifies rows of grid values into bits: free, unknown, or neither.
//!
//! With AVX2 where the processor has it ([`super::simd`]). Elsewhere eight cells are
//! compared at a time within one integer (Lamport, "Multiple Byte Processing with
//! Full-Word Instructions", CACM 1975) and the results gathered with the 8 x 8 bit
//! transpose of Warren, "Hacker's Delight" (2012), 7-3.

use super::WORD_CELLS;
use crate::grid::{OccupancyGrid, Thresholds};

/// Turns cells into bits by their thresholds.
#[derive(Clone, Copy, Debug)]
pub struct Classifier {
    thresholds: Thresholds,
    portable: Portable,
}

impl Classifier {
    /// For thresholds that satisfy [`Thresholds::validate`].
    #[must_use]
    pub fn new(thresholds: &Thresholds) -> Self {
        Self { thresholds: *thresholds, portable: Portable::new(thresholds) }
    }

    /// The free and the unknown cells among `cells`, 64 a word from the lowest bit; both
    /// slices must have a word for every 64 begun. Bits beyond the last cell are zero.
    pub fn classify(&self, cells: &[i8], free: &mut [u64], unknown: &mut [u64]) {
        let (whole, rest) = cells.as_chunks::<WORD_CELLS>();
        self.classify_words(whole, free, unknown);
        if !rest.is_empty() {
            let mut padded = [[OccupancyGrid::OCCUPIED; WORD_CELLS]];
            padded[0][..rest.len()].copy_from_slice(rest);
            self.classify_words(&padded, &mut free[whole.len()..], &mut unknown[whole.len()..]);
        }
    }

    /// The same of cells that begin `lead` bits behind the beginning of the first word. All bits of
    /// both slices that stand for no cell are zero.
    pub fn classify_behind(&self, lead: usize, mut cells: &[i8], free: &mut [u64], unknown: &mut [u64]) {
        let mut next = (lead / WORD_CELLS).min(free.len());
        let (begun, missing) = (lead % WORD_CELLS, (WORD_CELLS - lead % WORD_CELLS) % WORD_CELLS);
        free[..next].fill(0);
        unknown[..next].fill(0);
        if begun > 0 && !cells.is_empty() {
            let head;
            (head, cells) = cells.split_at(missing.min(cells.len()));
            let mut padded = [[OccupancyGrid::OCCUPIED; WORD_CELLS]];
            padded[0][begun..begun + head.len()].copy_from_slice(head);
            self.classify_words(&padded, &mut free[next..], &mut unknown[next..]);
            next += 1;
        }
        self.classify(cells, &mut free[next..], &mut unknown[next..]);
        next += cells.len().div_ceil(WORD_CELLS);
        free[next..].fill(0);
        unknown[next..].fill(0);
    }

    fn classify_words(&self, cells: &[[i8; WORD_CELLS]], free: &mut [u64], unknown: &mut [u64]) {
        #[cfg(target_arch = "x86_64")]
        {
            if super::simd::pack(cells, free, unknown, self.thresholds.free_max) {
                return;
            }
        }
        self.portable.classify_words(cells, free, unknown);
    }
}

/// The lowest bit of each byte.
const LOW_BITS: u64 = 0x0101_0101_0101_0101;
/// The highest bit of each byte: the sign of its cell.
const HIGH_BITS: u64 = LOW_BITS << 7;

/// Compares eight cells at a time within one integer.
#[derive(Clone, Copy, Debug)]
struct Portable {
    /// Added to seven bits of each byte, carries into the eighth above `free_max`.
    beyond_free: u64,
}

impl Portable {
    fn new(thresholds: &Thresholds) -> Self {
        let bytes = |value: u8| u64::from(value) * LOW_BITS;
        Self { beyond_free: bytes(127 - thresholds.free_max.max(0).cast_unsigned()) }
    }

    fn classify_words(&self, cells: &[[i8; WORD_CELLS]], free: &mut [u64], unknown: &mut [u64]) {
        for ((cells, free), unknown) in cells.iter().zip(free).zip(unknown) {
            (*free, *unknown) = self.pack(cells);
        }
    }

    /// The free and the unknown cells of a word. Sixteen cells are taken in at a time
    /// as a pair of integers, which the compiler holds in one vector register; the two
    /// halves then hold the even and the odd bytes of the transposed word.
    #[inline]
    fn pack(&self, cells: &[i8; WORD_CELLS]) -> (u64, u64) {
        let (mut free, mut unknown) = ([0; 2], [0; 2]);
        for (i, pair) in cells.as_chunks::<16>().0.iter().enumerate() {
            for (half, eight) in pair.as_chunks::<8>().0.iter().enumerate() {
                let values = u64::from_le_bytes(eight.map(i8::cast_unsigned));
                let magnitudes = values & !HIGH_BITS;
                free[half] |= (!(values | (magnitudes + self.beyond_free)) & HIGH_BITS) >> (7 - 2 * i);
                unknown[half] |= (values & HIGH_BITS) >> (7 - 2 * i);
            }
        }
        (transposed(free[0] | free[1] << 1), transposed(unknown[0] | unknown[1] << 1))
    }
}

/// Swaps bit `8 r + c` with bit `8 c + r` for all `r` and `c` below 8.
#[inline]
const fn transposed(bits: u64) -> u64 {
    let swap = (bits ^ (bits >> 7)) & 0x00AA_00AA_00AA_00AA;
    let bits = bits ^ swap ^ (swap << 7);
    let swap = (bits ^ (bits >> 14)) & 0x0000_CCCC_0000_CCCC;
    let bits = bits ^ swap ^ (swap << 14);
    let swap = (bits ^ (bits >> 28)) & 0x0000_0000_F0F0_F0F0;
    bits ^ swap ^ (swap << 28)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::CellState;

    /// Both versions against the definition.
    fn check(cells: &[i8], thresholds: Thresholds) {
        let classifier = Classifier::new(&thresholds);
        let words = cells.len().div_ceil(WORD_CELLS);
        let (mut free, mut unknown) = (vec![7; words], vec![7; words]);
        classifier.classify(cells, &mut free, &mut unknown);
        let bit = |words: &[u64], i: usize| words[i / WORD_CELLS] >> (i % WORD_CELLS) & 1 == 1;
        for i in 0..words * WORD_CELLS {
            let state = cells.get(i).map(|&value| thresholds.classify(value));
            assert_eq!(bit(&free, i), state == Some(CellState::Free), "{:?} at {i}, {thresholds:?}", cells.get(i));
            assert_eq!(
                bit(&unknown, i),
                state == Some(CellState::Unknown),
                "{:?} at {i}, {thresholds:?}",
                cells.get(i)
            );
        }
        let whole = cells.as_chunks().0;
        let (mut portable_free, mut portable_unknown) = (vec![7; whole.len()], vec![7; whole.len()]);
        classifier.portable.classify_words(whole, &mut portable_free, &mut portable_unknown);
        assert_eq!((&portable_free[..], &portable_unknown[..]), (&free[..whole.len()], &unknown[..whole.len()]));
    }

    /// Values without a pattern in the low places.
    fn values(count: usize) -> Vec<i8> {
        (0..count).map(|i| (i.wrapping_mul(2_654_435_761) >> 7) as i8).collect()
    }

    #[test]
    fn all_lengths_and_alignments_are_classified_alike() {
        let values = values(400);
        for start in 0..65 {
            for length in 0..200 {
                check(&values[start..start + length], Thresholds::default());
            }
        }
    }

    #[test]
    fn cells_stand_as_far_behind_as_is_said() {
        let classifier = Classifier::new(&Thresholds::default());
        let values = values(200);
        for (lead, length) in (0..200usize).flat_map(|lead| [0usize, 1, 30, 64, 70, 200].map(|length| (lead, length))) {
            let words = (lead + length).div_ceil(WORD_CELLS) + 1;
            let mut padded = vec![OccupancyGrid::OCCUPIED; words * WORD_CELLS];
            padded[lead..lead + length].copy_from_slice(&values[..length]);
            let [mut expected, mut found] = [[0; 2], [7; 2]].map(|bits| bits.map(|bits| vec![bits; words]));
            let [free, unknown] = &mut expected;
            classifier.classify(&padded, free, unknown);
            let [free, unknown] = &mut found;
            classifier.classify_behind(lead, &values[..length], free, unknown);
            assert_eq!(found, expected, "{length} cells behind {lead}");
        }
    }

    #[test]
    fn every_value_meets_every_pair_of_thresholds() {
        // Each value at two places of a word, the second time across its halves.
        let all: Vec<i8> = (0..256 + 31 + 256).map(|i| i as i8).collect();
        for free_max in 0..100 {
            for occupied_min in [free_max + 1, (free_max + 20).min(100), 100] {
                check(&all, Thresholds { free_max, occupied_min });
            }
        }
    }
}
