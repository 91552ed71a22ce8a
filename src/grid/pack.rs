//! Planes of bits from bytes.

use super::{BitPlane, WORD_CELLS};

impl BitPlane {
    /// The plane of the cells whose values are such, of rows of `width` values. O(values):
    /// many are compared at a time; the bits of eight, one in each byte, are gathered by
    /// one multiplication (Warren, "Hacker's Delight", 2012).
    #[must_use]
    pub fn of_values<T: Copy>(width: usize, values: &[T], is_set: impl Fn(T) -> bool) -> Self {
        let mut plane = Self::new(width, values.len() / width);
        for (y, row) in values.chunks_exact(width).enumerate() {
            let (whole, rest) = row.as_chunks::<WORD_CELLS>();
            let (words, last) = plane.row_mut(y).split_at_mut(whole.len());
            for (word, values) in words.iter_mut().zip(whole) {
                let mut flags = [0; WORD_CELLS];
                for (flag, &value) in flags.iter_mut().zip(values) {
                    *flag = u8::from(is_set(value));
                }
                *word = gathered(&flags);
            }
            for (i, &value) in rest.iter().enumerate() {
                last[0] |= u64::from(is_set(value)) << i;
            }
        }
        plane
    }
}

/// The lowest bits of the bytes.
fn gathered(flags: &[u8; WORD_CELLS]) -> u64 {
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let eights = flags.as_chunks::<8>().0.iter().enumerate();
    eights.fold(0, |word, (i, &eight)| word | (u64::from_le_bytes(eight).wrapping_mul(GATHER) >> 56) << (8 * i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Cell;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bits_are_where_values_are_such(
            (width, values) in (1usize..200, 1usize..4)
                .prop_flat_map(|(w, h)| (Just(w), proptest::collection::vec(0u8..10, w * h))),
        ) {
            let plane = BitPlane::of_values(width, &values, |value| value > 6);
            for (index, &value) in values.iter().enumerate() {
                let cell = Cell::new((index % width) as i32, (index / width) as i32);
                prop_assert_eq!(plane.contains(cell), value > 6);
            }
            prop_assert_eq!(plane.count(), values.iter().filter(|&&value| value > 6).count());
        }
    }
}
