//! Planes of bits from bytes.

use super::{BitPlane, WORD_CELLS};

impl BitPlane {
    /// The plane of the cells whose values are such, of rows of `width` values. The bits
    /// of eight values at a time, one in each byte, are gathered by one multiplication
    /// (Warren, "Hacker's Delight", 2012). O(values).
    #[must_use]
    pub fn of_values<T: Copy>(width: usize, values: &[T], is_set: impl Fn(T) -> bool) -> Self {
        const GATHER: u64 = 0x0102_0408_1020_4080;
        let mut plane = Self::new(width, values.len() / width);
        let byte = |value: T| u8::from(is_set(value));
        for (y, row) in values.chunks_exact(width).enumerate() {
            for (word, values) in plane.row_mut(y).iter_mut().zip(row.chunks(WORD_CELLS)) {
                let (eights, rest) = values.as_chunks::<8>();
                for (i, eight) in eights.iter().enumerate() {
                    *word |= (u64::from_le_bytes(eight.map(byte)).wrapping_mul(GATHER) >> 56) << (8 * i);
                }
                for (i, &value) in rest.iter().enumerate() {
                    *word |= u64::from(byte(value)) << (8 * eights.len() + i);
                }
            }
        }
        plane
    }
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
