//! The exact Euclidean distance from every cell to the nearest obstacle.
//!
//! Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions" (Theory
//! of Computing 2012), in integers: one pass down the columns for the vertical
//! distance, one lower envelope of parabolas along each row. O(cells), exact.

use super::GridInfo;
use super::vertical::vertical_distances;

/// Squared distance in cells, between cell centres, from each cell to the nearest
/// cell for which `is_obstacle(index)` holds; `u32::MAX` everywhere without one.
/// Row-major, as the grid.
#[must_use]
pub fn squared_distance_cells(info: &GridInfo, is_obstacle: impl Fn(usize) -> bool) -> Vec<u32> {
    let width = info.width();
    let mut distances: Vec<u32> = (0..info.len()).map(|i| if is_obstacle(i) { 0 } else { NONE }).collect();
    vertical_distances(width, &mut distances);
    let mut envelope = Envelope::with_capacity(width);
    let mut row_squared = vec![0; width];
    for row in distances.chunks_exact_mut(width) {
        envelope.build(row);
        envelope.evaluate(row, &mut row_squared);
        row.copy_from_slice(&row_squared);
    }
    distances
}

/// No obstacle in this column.
const NONE: u32 = u32::MAX;

/// The lower envelope of the parabolas `(x - site)^2 + height[site]^2` of one row.
struct Envelope {
    /// Column of each parabola on the envelope.
    sites: Vec<usize>,
    /// First column at which each of them is the lowest.
    starts: Vec<i64>,
}

impl Envelope {
    fn with_capacity(width: usize) -> Self {
        Self { sites: Vec::with_capacity(width), starts: Vec::with_capacity(width) }
    }

    fn build(&mut self, heights: &[u32]) {
        self.sites.clear();
        self.starts.clear();
        for (site, &height) in heights.iter().enumerate() {
            if height == NONE {
                continue;
            }
            let mut start = 0;
            while let (Some(&last), Some(&last_start)) = (self.sites.last(), self.starts.last()) {
                start = first_column_of_second(last, heights[last], site, height);
                if start > last_start {
                    break;
                }
                self.sites.pop();
                self.starts.pop();
                start = 0;
            }
            if start < heights.len() as i64 {
                self.sites.push(site);
                self.starts.push(start);
            }
        }
    }

    fn evaluate(&self, heights: &[u32], squared: &mut [u32]) {
        if self.sites.is_empty() {
            squared.fill(NONE);
            return;
        }
        let mut current = 0;
        for (x, out) in squared.iter_mut().enumerate() {
            while current + 1 < self.sites.len() && self.starts[current + 1] <= x as i64 {
                current += 1;
            }
            let site = self.sites[current];
            let dx = (x as i64 - site as i64).pow(2);
            let dy = i64::from(heights[site]).pow(2);
            *out = u32::try_from(dx + dy).unwrap_or(NONE);
        }
    }
}

/// The first column at which the parabola of a later site is strictly lower than
/// that of an earlier one.
fn first_column_of_second(a: usize, height_a: u32, b: usize, height_b: u32) -> i64 {
    let (a, b) = (a as i64, b as i64);
    let (ha, hb) = (i64::from(height_a).pow(2), i64::from(height_b).pow(2));
    // (x-b)^2 + hb < (x-a)^2 + ha  <=>  x > (b^2 - a^2 + hb - ha) / (2 (b - a))
    (b * b - a * a + hb - ha).div_euclid(2 * (b - a)) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use proptest::prelude::*;

    #[test]
    fn no_obstacle_is_infinitely_far() {
        let info = GridInfo::new(3, 2, 1.0, Pose::default()).unwrap();
        assert_eq!(squared_distance_cells(&info, |_| false), vec![u32::MAX; 6]);
    }

    proptest! {
        #[test]
        fn equals_the_definition(
            (width, height, cells) in (1usize..24, 1usize..24).prop_flat_map(|(w, h)| {
                (Just(w), Just(h), proptest::collection::vec(proptest::bool::weighted(0.1), w * h))
            })
        ) {
            let info = GridInfo::new(width as u32, height as u32, 1.0, Pose::default()).unwrap();
            let fast = squared_distance_cells(&info, |i| cells[i]);
            for (index, &distance) in fast.iter().enumerate() {
                let here = info.cell(index);
                let expected = (0..cells.len())
                    .filter(|&i| cells[i])
                    .map(|i| here.distance_squared(info.cell(i)) as u32)
                    .min()
                    .unwrap_or(u32::MAX);
                prop_assert_eq!(distance, expected);
            }
        }
    }
}
