//! Makes planes of bits from grids of values, eight bytes to a multiplication.

use super::{BitPlane, WORD_CELLS};
use crate::grid::CellRect;

impl BitPlane {
    /// The plane of the cells whose values are such, of rows of `width` values. O(values):
    /// many are compared at a time; the bits of eight, one in each byte, are gathered by
    /// one multiplication (Warren, "Hacker's Delight", 2012).
    #[must_use]
    pub fn of_values<T: Copy>(width: usize, values: &[T], is_set: impl Fn(T) -> bool) -> Self {
        let mut plane = Self::new(width, values.len() / width);
        let all = CellRect { x: 0, y: 0, width, height: plane.height() };
        plane.set_values(&all, values, is_set);
        plane
    }

    /// Sets the bits of the words that hold the cells of a rectangle by the values of a grid of
    /// the plane's size. O(cells of the rectangle).
    pub fn set_values<T: Copy>(&mut self, rect: &CellRect, values: &[T], is_set: impl Fn(T) -> bool) {
        let width = self.width();
        let (first, end) = (rect.x / WORD_CELLS, (rect.x + rect.width).min(width).div_ceil(WORD_CELLS));
        let columns = first * WORD_CELLS..(end * WORD_CELLS).min(width);
        if rect.is_empty() || columns.is_empty() {
            return;
        }
        for (y, row) in values.chunks_exact(width).enumerate().skip(rect.y).take(rect.height) {
            let (whole, rest) = row[columns.clone()].as_chunks::<WORD_CELLS>();
            let (words, last) = self.row_mut(y)[first..end].split_at_mut(whole.len());
            for (word, values) in words.iter_mut().zip(whole) {
                let mut flags = [0; WORD_CELLS];
                for (flag, &value) in flags.iter_mut().zip(values) {
                    *flag = u8::from(is_set(value));
                }
                *word = gathered(&flags);
            }
            if let Some(last) = last.first_mut() {
                *last = rest.iter().enumerate().fold(0, |word, (i, &value)| word | u64::from(is_set(value)) << i);
            }
        }
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
            let height = values.len() / width;
            let plane = BitPlane::of_values(width, &values, |value| value > 6);
            for (index, &value) in values.iter().enumerate() {
                let cell = Cell::new((index % width) as i32, (index / width) as i32);
                prop_assert_eq!(plane.contains(cell), value > 6);
            }
            prop_assert_eq!(plane.count(), values.iter().filter(|&&value| value > 6).count());
            // A part of it by other values: at least the rectangle is as they are.
            let rect = CellRect { x: width / 3, y: height / 2, width: width / 2, height: 9 };
            let mut part = plane.clone();
            part.set_values(&rect, &values, |value| value > 3);
            for (index, &value) in values.iter().enumerate() {
                let (x, y) = (index % width, index / width);
                let is_in = (rect.x..rect.x + rect.width).contains(&x) && y >= rect.y;
                let is_set = part.contains(Cell::new(x as i32, y as i32));
                let is_as_expected = if is_in { is_set == (value > 3) } else { is_set == (value > 6) || value > 3 };
                prop_assert!(is_as_expected);
            }
        }
    }
}
