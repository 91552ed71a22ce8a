//! Distances to the nearest obstacle as far as they matter: for inflation.
//!
//! The two passes of Felzenszwalb and Huttenlocher (2012) as in [`super::distance`], in
//! small integers: a byte for the distance down a column, and each row slid over itself
//! for the least of `height(x + dx)^2 + dx^2`, which the compiler turns into vector code.
//! O(cells * limit) with many cells at a time; rows and ends of rows far from every
//! obstacle cost next to nothing. Exact within the limit.

/// The longest limit, cells: its square must fit 16 bits with a sign, and envelopes are
/// faster beyond.
pub const LONGEST_LIMIT: u32 = 48;

/// Calls `visit` for each row of a grid of `width` columns with the squared distances
/// in cells from its cells to the nearest obstacle: exact up to `limit` cells, which is
/// at most [`LONGEST_LIMIT`], and `limit^2 + 1` beyond. Obstacles are 0 and all else
/// 255 in `obstacles`, row-major; it is used up.
pub fn for_each_row(width: usize, obstacles: &mut [u8], limit: u32, mut visit: impl FnMut(&[i16])) {
    let limit = limit.min(LONGEST_LIMIT) as u8;
    vertical_distances(width, obstacles);
    let mut sliding = Sliding::new(width, limit);
    for heights in obstacles.chunks_exact(width) {
        visit(sliding.squares_of(heights));
    }
}

/// Cells to the nearest obstacle in the same column, 255 for that many or more.
fn vertical_distances(width: usize, distances: &mut [u8]) {
    let nearer = |row: &mut [u8], neighbours: &[u8]| {
        for (distance, &neighbour) in row.iter_mut().zip(neighbours) {
            *distance = (*distance).min(neighbour.saturating_add(1));
        }
    };
    let height = distances.len() / width;
    for y in 1..height {
        let (before, rest) = distances.split_at_mut(y * width);
        nearer(&mut rest[..width], &before[(y - 1) * width..]);
    }
    for y in (1..height).rev() {
        let (before, rest) = distances.split_at_mut(y * width);
        nearer(&mut before[(y - 1) * width..], &rest[..width]);
    }
}

/// One row at a time.
struct Sliding {
    limit: u8,
    /// More than any squared distance within the limit: stands for all that is farther.
    far: i16,
    /// Squared vertical distances, with `limit` far ones before and after.
    squares: Vec<i16>,
    least: Vec<i16>,
}

impl Sliding {
    fn new(width: usize, limit: u8) -> Self {
        let far = i16::from(limit) * i16::from(limit) + 1;
        Self { limit, far, squares: vec![far; width + 2 * usize::from(limit)], least: vec![far; width] }
    }

    fn squares_of(&mut self, heights: &[u8]) -> &[i16] {
        let (width, limit, far) = (heights.len(), usize::from(self.limit), self.far);
        self.least.fill(far);
        let is_near = |&height: &u8| height <= self.limit;
        let (Some(first), Some(last)) = (heights.iter().position(is_near), heights.iter().rposition(is_near)) else {
            return &self.least;
        };
        for (square, &height) in self.squares[limit..limit + width].iter_mut().zip(heights) {
            let height = i16::from(height.min(self.limit + 1));
            *square = (height * height).min(far);
        }
        // Only these columns are within the limit of one that is.
        let (from, to) = (first.saturating_sub(limit), (last + limit + 1).min(width));
        let least = &mut self.least[from..to];
        least.copy_from_slice(&self.squares[limit + from..limit + to]);
        for dx in 1..=limit {
            let add = (dx * dx) as i16;
            let (left, right) = (&self.squares[limit - dx + from..], &self.squares[limit + dx + from..]);
            for ((least, &left), &right) in least.iter_mut().zip(left).zip(right) {
                *least = (*least).min(left.min(right) + add);
            }
        }
        for least in least {
            *least = (*least).min(far);
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
            limit in 0u32..=LONGEST_LIMIT,
        ) {
            let info = GridInfo::new(width as u32, (cells.len() / width) as u32, 1.0, Pose::default()).unwrap();
            let exact = squared_distance_cells(&info, |i| cells[i]);
            let mut obstacles: Vec<u8> = cells.iter().map(|&is_obstacle| if is_obstacle { 0 } else { 255 }).collect();
            let mut near = Vec::new();
            for_each_row(width, &mut obstacles, limit, |row| near.extend_from_slice(row));
            let far = limit * limit + 1;
            let expected: Vec<u32> = exact.iter().map(|&squared| squared.min(far)).collect();
            let found: Vec<u32> = near.iter().map(|&squared| u32::from(squared.unsigned_abs())).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
