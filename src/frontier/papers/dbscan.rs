//! Frontier cells clustered by density.
//!
//! Alghfeli, Alhosani and Almheiri: the whole grid is scanned for free cells beside an
//! unknown one, and DBSCAN (Ester et al. 1996) clusters them, as scikit-learn's
//! `DBSCAN(eps=3)` does: a cell with at least `min_samples` frontier cells within
//! `eps_cells`, itself included, is a core cell; core cells within `eps_cells` of each
//! other share a cluster; a cell near a core cell joins its cluster, the first one in
//! row-major order when there are several; what is left is noise and dropped.
//!
//! | parameter | unit | paper |
//! |---|---|---|
//! | `eps_cells` | cells, between centres | 3 |
//! | `min_samples` | cells | not said; 5 is scikit-learn's default |
//! | `neighbours` | which cells are "beside" | 4 |
//!
//! Cells are looked up on the grid: O(cells of the grid + frontier cells * eps^2).
//! A short frontier, fewer than `min_samples` cells, is noise: narrow gaps stay unseen.

mod params;

pub use params::DbscanParams;

use crate::frontier::papers::territory::{Territory, cells};
use crate::frontier::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, number};
use crate::grid::{Cell, GridInfo};

/// The detector.
///
/// A gap of one cell is noise beside an opening of seven, until two cells make a cluster:
///
/// ```
/// use frontier_explorer::frontier::{Dbscan, DetectionInput, DetectorParams, FrontierDetector};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Neighbourhood, OccupancyGrid};
///
/// let grid = OccupancyGrid::from_ascii(
///     "#?##########???????
///      ...................",
/// ).unwrap();
/// let input = DetectionInput::new(&grid, Pose::new(5.5, 0.5, 0.0));
/// let mut params = DetectorParams { neighbours: Neighbourhood::Four, ..DetectorParams::default() };
/// let sizes = |params| -> Result<Vec<usize>, frontier_explorer::frontier::DetectError> {
///     Ok(Dbscan::new(params).detect(&input)?.iter().map(|frontier| frontier.cells.len()).collect())
/// };
/// assert_eq!(sizes(params)?, [7]);
/// params.dbscan.min_samples = 1;
/// assert_eq!(sizes(params)?, [1, 7]);
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Dbscan {
    params: DetectorParams,
}

impl Dbscan {
    /// A detector with these parameters.
    #[must_use]
    pub const fn new(params: DetectorParams) -> Self {
        Self { params }
    }
}

impl FrontierDetector for Dbscan {
    fn name(&self) -> &'static str {
        "dbscan"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let info = input.grid.info();
        let territory = Territory::of(input, &self.params)?;
        let cells = cells(&territory.open_beside_unknown(self.params.neighbours));
        let mut clusters = cluster(info, &cells, &self.params.dbscan);
        let min_cells = self.params.min_cells(info);
        clusters.retain(|cluster| cluster.len() >= min_cells);
        Ok(number(clusters, CellSide::Free))
    }
}

/// The clusters of distinct cells of the grid in row-major order, in the order of scikit-learn.
fn cluster(info: &GridInfo, cells: &[Cell], params: &DbscanParams) -> Vec<Vec<Cell>> {
    const NONE: u32 = 0;
    // Which of the cells stands where on the grid, counted from 1, with a margin so wide
    // that no neighbour of a cell lies outside.
    let margin = params.eps_cells.floor() as usize;
    let stride = info.width() + 2 * margin;
    let mut numbers = vec![NONE; stride * (info.height() + 2 * margin)];
    let place = |cell: &Cell| (cell.y as usize + margin) * stride + cell.x as usize + margin;
    let places: Vec<usize> = cells.iter().map(place).collect();
    for (&place, number) in places.iter().zip(1..) {
        numbers[place] = number;
    }
    let offsets: Vec<isize> =
        disc(params.eps_cells).iter().map(|&(dx, dy)| dy as isize * stride as isize + dx as isize).collect();
    let is_core = |place: usize| {
        let near = offsets.iter().filter(|&&offset| numbers[place.wrapping_add_signed(offset)] != NONE);
        near.count() >= params.min_samples as usize
    };
    let is_core: Vec<bool> = places.iter().map(|&place| is_core(place)).collect();
    let mut clusters = Vec::new();
    for (first, &place) in places.iter().enumerate() {
        // The number of a cell is taken away when a cluster takes the cell.
        if !is_core[first] || std::mem::take(&mut numbers[place]) == NONE {
            continue;
        }
        let mut members = vec![first];
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            next += 1;
            // Border cells belong to the cluster and do not carry it on.
            if !is_core[member] {
                continue;
            }
            for &offset in &offsets {
                let number = std::mem::take(&mut numbers[places[member].wrapping_add_signed(offset)]);
                if number != NONE {
                    members.push(number as usize - 1);
                }
            }
        }
        clusters.push(members.into_iter().filter_map(|i| cells.get(i)).copied().collect());
    }
    clusters
}

/// Offsets to all cells within a radius, the cell itself included.
fn disc(radius_cells: f64) -> Vec<(i32, i32)> {
    let reach = radius_cells.floor() as i32;
    (-reach..=reach)
        .flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)))
        .filter(|&(dx, dy)| f64::from(dx * dx + dy * dy) <= radius_cells * radius_cells)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    /// scikit-learn's `dbscan_inner`, restated: neighbourhoods by brute force, labels
    /// given by a depth-first walk from each unlabelled core point in order.
    fn brute_force(cells: &[Cell], params: &DbscanParams) -> Vec<Vec<Cell>> {
        let near = |a: &Cell| -> Vec<usize> {
            let close = |b: &Cell| (a.distance_squared(*b) as f64).sqrt() <= params.eps_cells;
            (0..cells.len()).filter(|&j| close(&cells[j])).collect()
        };
        let neighbourhoods: Vec<Vec<usize>> = cells.iter().map(near).collect();
        let is_core = |i: usize| neighbourhoods[i].len() >= params.min_samples as usize;
        let mut labels: Vec<i32> = vec![-1; cells.len()];
        let mut label = 0;
        for start in 0..cells.len() {
            if labels[start] != -1 || !is_core(start) {
                continue;
            }
            let mut stack = vec![start];
            while let Some(i) = stack.pop() {
                if labels[i] == -1 {
                    labels[i] = label;
                    if is_core(i) {
                        stack.extend(neighbourhoods[i].iter().filter(|&&j| labels[j] == -1));
                    }
                }
            }
            label += 1;
        }
        (0..label).map(|l| cells.iter().zip(&labels).filter(|&(_, &m)| m == l).map(|(c, _)| *c).collect()).collect()
    }

    fn check(cells: &BTreeSet<(i32, i32)>, params: &DbscanParams) {
        let info = GridInfo::new(24, 24, 1.0, Pose::default()).unwrap();
        let cells: Vec<Cell> = cells.iter().map(|&(y, x)| Cell::new(x, y)).collect();
        let mut found = cluster(&info, &cells, params);
        for cluster in &mut found {
            cluster.sort_unstable_by_key(|c| (c.y, c.x));
        }
        assert_eq!(found, brute_force(&cells, params));
    }

    #[test]
    fn the_disc_of_three_cells_has_29() {
        assert_eq!(disc(3.0).len(), 29);
        assert_eq!(disc(1.0).len(), 5);
    }

    #[test]
    fn a_border_cell_between_two_clusters_goes_to_the_first() {
        // Two lines of five with one cell between them, three from either end.
        let line = |from: i32| (from..from + 5).map(|x| (4, x));
        let cells: BTreeSet<(i32, i32)> = line(0).chain([(4, 7)]).chain(line(10)).collect();
        let params = DbscanParams::default();
        check(&cells, &params);
        let info = GridInfo::new(24, 24, 1.0, Pose::default()).unwrap();
        let cells: Vec<Cell> = cells.iter().map(|&(y, x)| Cell::new(x, y)).collect();
        let sizes: Vec<usize> = cluster(&info, &cells, &params).iter().map(Vec::len).collect();
        assert_eq!(sizes, [6, 5]);
        // Four cells together are noise.
        assert!(cluster(&info, &cells[..4], &params).is_empty());
    }

    proptest! {
        #[test]
        fn equals_scikit_learn_restated(
            cells in proptest::collection::btree_set((0i32..24, 0i32..24), 0..120),
            eps_cells in 1.0f64..5.0,
            min_samples in 1u32..9,
        ) {
            check(&cells, &DbscanParams { eps_cells, min_samples });
        }
    }
}
