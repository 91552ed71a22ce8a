//! What the detectors that look at the whole grid share, on planes of bits: what is
//! open, what is beside it, and what is connected. O(cells / 64 + runs) after the grid
//! has been packed.

use crate::bits::connectivity::Connectivity;
use crate::bits::labels::Labels;
use crate::bits::neighbours::neighbours_of_row;
use crate::bits::runs::{Run, runs_of};
use crate::bits::window::Window;
use crate::bits::{BitPlane, BitPlanes};
use crate::frontier::{DetectError, DetectionInput, DetectorParams, Reachability};
use crate::grid::{Cell, Neighbourhood, OccupancyGrid, Thresholds};

/// The grid by what its cells mean to a detector.
pub(crate) struct Territory {
    /// All cells.
    pub planes: BitPlanes,
    /// The free cells, where that is asked for those connected with the robot's alone.
    pub open: BitPlane,
}

impl Territory {
    /// That of a detection's grid as its parameters see it.
    ///
    /// # Errors
    /// [`DetectError`] when the robot is off the map or nowhere near free space.
    pub fn of(input: &DetectionInput<'_>, params: &DetectorParams) -> Result<Self, DetectError> {
        let seed = params.seed(input.grid, &input.robot_in_map)?;
        let mut this = Self::whole(input.grid, &params.thresholds);
        if params.reachability == Reachability::WallsBlock {
            Connectivity::by(params.search_neighbours()).find(this.planes.free(), seed, &mut this.open);
        }
        Ok(this)
    }

    /// All of a grid, wherever the robot is.
    pub fn whole(grid: &OccupancyGrid, thresholds: &Thresholds) -> Self {
        let mut planes = BitPlanes::default();
        planes.pack(grid, thresholds);
        Self { open: planes.free().clone(), planes }
    }

    /// The open cells beside an unknown one: the frontier cells of Yamauchi.
    pub fn open_beside_unknown(&self, neighbours: Neighbourhood) -> BitPlane {
        let mut cells = with_neighbours(self.planes.unknown(), neighbours);
        cells.intersect(&self.open);
        cells
    }
}

/// A plane together with the neighbours of its cells.
pub(crate) fn with_neighbours(source: &BitPlane, neighbours: Neighbourhood) -> BitPlane {
    let mut out = source.clone();
    let mut beside = vec![0; source.row_words()];
    for y in 0..source.height() {
        neighbours_of_row(source, neighbours, y, 0..source.row_words(), &mut beside);
        out.row_mut(y).iter_mut().zip(&beside).for_each(|(word, beside)| *word |= beside);
    }
    out
}

/// The cells of a plane, row-major.
pub(crate) fn cells(plane: &BitPlane) -> Vec<Cell> {
    let mut cells = Vec::new();
    for y in 0..plane.height() {
        for (i, &word) in plane.row(y).iter().enumerate() {
            let mut left = word;
            while left != 0 {
                let x = i * crate::bits::WORD_CELLS + left.trailing_zeros() as usize;
                cells.push(Cell::new(x as i32, y as i32));
                left &= left - 1;
            }
        }
    }
    cells
}

/// The connected components of a plane: each one's runs with their rows, row-major,
/// the components by their first cells.
pub(crate) fn components(plane: &BitPlane, neighbours: Neighbourhood) -> Vec<Vec<(usize, Run)>> {
    let mut labels = Labels::default();
    labels.label(plane, &Window::of(plane), neighbours);
    let mut components = vec![Vec::new(); labels.components()];
    for y in 0..plane.height() {
        for (run, &component) in runs_of(plane.row(y)).zip(labels.row(y)) {
            components[component as usize].push((y, run));
        }
    }
    components
}

/// The cells of runs.
pub(crate) fn cells_of(runs: &[(usize, Run)]) -> Vec<Cell> {
    runs.iter().flat_map(|&(y, run)| (run.start..run.end).map(move |x| Cell::new(x as i32, y as i32))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::GridInfo;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn neighbours_and_components_are_those_of_the_cells(
            (width, values) in (1usize..150, 1usize..8).prop_flat_map(|(w, h)| {
                (Just(w), proptest::collection::vec(proptest::bool::weighted(0.2), w * h))
            }),
        ) {
            let info = GridInfo::new(width as u32, (values.len() / width) as u32, 1.0, Pose::default()).unwrap();
            let plane = BitPlane::of_values(width, &values, |value| value);
            let set: Vec<Cell> = (0..info.len()).filter(|&i| values[i]).map(|i| info.cell(i)).collect();
            prop_assert_eq!(&cells(&plane), &set);
            for neighbours in [Neighbourhood::Four, Neighbourhood::Eight] {
                let grown = with_neighbours(&plane, neighbours);
                for cell in (0..info.len()).map(|i| info.cell(i)) {
                    let expected = set.contains(&cell) || info.neighbours(cell, neighbours).any(|n| set.contains(&n));
                    prop_assert_eq!(grown.contains(cell), expected);
                }
                let mut expected = crate::frontier::papers::groups::group(&info, &set, neighbours);
                expected.iter_mut().for_each(|group| group.sort_unstable_by_key(|c| (c.y, c.x)));
                let found: Vec<Vec<Cell>> = components(&plane, neighbours).iter().map(|runs| cells_of(runs)).collect();
                prop_assert_eq!(found, expected);
            }
        }
    }
}
