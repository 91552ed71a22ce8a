//! Distances to the nearest obstacle as far as they matter: for inflation.
//!
//! The two passes of Felzenszwalb and Huttenlocher (2012) as in [`super::distance`], in
//! small integers: a byte for the distance down a column, and each row slid over itself
//! for the least of `height(x + dx)^2 + dx^2`, which the compiler turns into vector code.
//! O(cells * limit) with many cells at a time; rows and ends of rows far from every
//! obstacle cost next to nothing. Exact within the limit.

use super::vertical::vertical_distances;
use std::ops::Range;

/// The longest limit, cells: its square must fit 16 bits with a sign, and envelopes are
/// faster beyond.
pub const LONGEST_LIMIT: usize = 48;

/// Calls `visit` for some rows of a grid of `width` columns with a value for each cell: the
/// one that `by_squared` has for the squared distance in cells to the nearest obstacle,
/// and beyond its end 0. Its length must be `limit^2 + 1` for a limit of at most
/// [`LONGEST_LIMIT`] cells. Obstacles are 0 and all else 255 in `obstacles`, row-major;
/// it is used up.
pub fn for_each_row(
    width: usize,
    obstacles: &mut [u8],
    rows: Range<usize>,
    by_squared: &[u8],
    visit: impl FnMut(&[u8]),
) {
    let limit = by_squared.len().saturating_sub(1).isqrt().min(LONGEST_LIMIT) as u8;
    vertical_distances(width, obstacles);
    let heights = &obstacles[rows.start * width..rows.end * width];
    if limit <= BYTE_LIMIT {
        slide_rows::<u8>(width, heights, limit, by_squared, visit);
    } else {
        slide_rows::<i16>(width, heights, limit, by_squared, visit);
    }
}

/// Up to this limit a squared distance fits a byte.
const BYTE_LIMIT: u8 = 15;

fn slide_rows<T: Square>(width: usize, heights: &[u8], limit: u8, by_squared: &[u8], mut visit: impl FnMut(&[u8])) {
    let mut sliding = Sliding::<T>::new(width, limit);
    let mut values = Vec::with_capacity(width);
    for heights in heights.chunks_exact(width) {
        values.clear();
        let squares = sliding.squares_of(heights).iter();
        values.extend(squares.map(|squared| by_squared.get(squared.index()).copied().unwrap_or_default()));
        visit(&values);
    }
}

/// A number that holds squared distances and more than the largest of them.
trait Square: Copy + Ord {
    fn of(height: u8) -> Self;
    fn plus(self, other: Self) -> Self;
    fn index(self) -> usize;
}

impl Square for u8 {
    fn of(height: u8) -> Self {
        height.saturating_mul(height)
    }

    fn plus(self, other: Self) -> Self {
        self.saturating_add(other)
    }

    fn index(self) -> usize {
        usize::from(self)
    }
}

impl Square for i16 {
    fn of(height: u8) -> Self {
        Self::from(height).saturating_mul(Self::from(height))
    }

    fn plus(self, other: Self) -> Self {
        self.saturating_add(other)
    }

    fn index(self) -> usize {
        usize::from(self.unsigned_abs())
    }
}

/// One row at a time.
struct Sliding<T> {
    limit: u8,
    /// More than any squared distance within the limit: stands for all that is farther.
    far: T,
    /// Squared vertical distances, with `limit` far ones before and after.
    squares: Vec<T>,
    least: Vec<T>,
}

impl<T: Square> Sliding<T> {
    fn new(width: usize, limit: u8) -> Self {
        let far = T::of(limit + 1);
        Self { limit, far, squares: vec![far; width + 2 * usize::from(limit)], least: vec![far; width] }
    }

    fn squares_of(&mut self, heights: &[u8]) -> &[T] {
        let (width, limit, far) = (heights.len(), usize::from(self.limit), self.far);
        self.least.fill(far);
        let is_near = |&height: &u8| height <= self.limit;
        let (Some(first), Some(last)) = (heights.iter().position(is_near), heights.iter().rposition(is_near)) else {
            return &self.least;
        };
        for (square, &height) in self.squares[limit..limit + width].iter_mut().zip(heights) {
            *square = T::of(height.min(self.limit + 1));
        }
        // Only these columns are within the limit of one that is.
        let (from, to) = (first.saturating_sub(limit), (last + limit + 1).min(width));
        let least = &mut self.least[from..to];
        least.copy_from_slice(&self.squares[limit + from..limit + to]);
        for dx in 1..=self.limit {
            let (add, dx) = (T::of(dx), usize::from(dx));
            let (left, right) = (&self.squares[limit - dx + from..], &self.squares[limit + dx + from..]);
            for ((least, &left), &right) in least.iter_mut().zip(left).zip(right) {
                *least = (*least).min(left.min(right).plus(add));
            }
        }
        &self.least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{GridInfo, squared_distance_cells};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn equals_the_distance_transform_within_the_limit(
            (width, cells) in (1usize..40, 1usize..40).prop_flat_map(|(w, h)| {
                (Just(w), proptest::collection::vec(proptest::bool::weighted(0.03), w * h))
            }),
            limit in 0usize..=LONGEST_LIMIT,
        ) {
            let info = GridInfo::new(width as u32, (cells.len() / width) as u32, 1.0, Pose::default()).unwrap();
            let by_squared: Vec<u8> = (0..=limit * limit).map(|squared| 1 + (squared % 251) as u8).collect();
            let mut obstacles: Vec<u8> = cells.iter().map(|&is_obstacle| if is_obstacle { 0 } else { 255 }).collect();
            let mut near = Vec::new();
            for_each_row(width, &mut obstacles, 0..info.height(), &by_squared, |row| near.extend_from_slice(row));
            let exact = squared_distance_cells(&info, |i| cells[i]);
            let value = |&squared: &u32| by_squared.get(squared as usize).copied().unwrap_or(0);
            prop_assert_eq!(near, exact.iter().map(value).collect::<Vec<u8>>());
        }
    }
}
