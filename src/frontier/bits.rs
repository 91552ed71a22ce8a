//! What the detectors that look at the whole grid share, on planes of bits: what is
//! open, what is beside it, and what is connected. O(cells / 64 + runs) after the grid
//! has been packed.

use super::runs::{Run, Runs};
use super::{DetectError, DetectionInput, DetectorParams, Reachability};
use crate::grid::{BitPlane, BitPlanes, Cell, Neighbourhood};

/// The grid by what its cells mean to a detector.
pub(super) struct Territory {
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
        let mut planes = BitPlanes::default();
        planes.pack(input.grid, &params.thresholds);
        let mut open = planes.free().clone();
        if params.reachability == Reachability::WallsBlock {
            let mut runs = Runs::default();
            runs.label(&open, Neighbourhood::Four);
            runs.clear_others(&mut open, runs.component_at(seed));
        }
        Ok(Self { planes, open })
    }

    /// The open cells beside an unknown one: the frontier cells of Yamauchi.
    pub fn open_beside_unknown(&self, neighbours: Neighbourhood) -> BitPlane {
        let mut cells = with_neighbours(self.planes.unknown(), neighbours);
        cells.intersect(&self.open);
        cells
    }
}

/// A plane together with the neighbours of its cells.
pub(super) fn with_neighbours(source: &BitPlane, neighbours: Neighbourhood) -> BitPlane {
    let mut out = source.clone();
    let empty = vec![0; source.row_words()];
    // What spreads to the left and to the right: corners are the sides of what is above
    // and below.
    let mut sideways = vec![0; source.row_words()];
    for y in 0..source.height() {
        let here = source.row(y);
        let below = y.checked_sub(1).map_or(&*empty, |y| source.row(y));
        let above = if y + 1 < source.height() { source.row(y + 1) } else { &empty };
        let row = out.row_mut(y);
        for (((word, sideways), &here), (&below, &above)) in
            row.iter_mut().zip(&mut sideways).zip(here).zip(below.iter().zip(above))
        {
            *word = here | below | above;
            *sideways = if neighbours == Neighbourhood::Eight { *word } else { here };
        }
        let mut before = 0;
        for (i, word) in row.iter_mut().enumerate() {
            let after = sideways.get(i + 1).copied().unwrap_or_default();
            *word |= sideways[i] << 1 | before >> 63 | sideways[i] >> 1 | after << 63;
            before = sideways[i];
        }
        if let Some(last) = row.last_mut() {
            *last &= source.last_word_mask();
        }
    }
    out
}

/// The cells of a plane, row-major.
pub(super) fn cells(plane: &BitPlane) -> Vec<Cell> {
    let mut cells = Vec::new();
    for y in 0..plane.height() {
        for (i, &word) in plane.row(y).iter().enumerate() {
            let mut left = word;
            while left != 0 {
                let x = i * crate::grid::WORD_CELLS + left.trailing_zeros() as usize;
                cells.push(Cell::new(x as i32, y as i32));
                left &= left - 1;
            }
        }
    }
    cells
}

/// The connected components of a plane: each one's runs with their rows, row-major,
/// the components by their first cells.
pub(super) fn components(plane: &BitPlane, neighbours: Neighbourhood) -> Vec<Vec<(usize, Run)>> {
    let mut runs = Runs::default();
    runs.label(plane, neighbours);
    let mut places = vec![usize::MAX; runs.len()];
    let mut components: Vec<Vec<(usize, Run)>> = Vec::new();
    for (y, run, component) in runs.iter() {
        let place = &mut places[component as usize];
        if *place == usize::MAX {
            *place = components.len();
            components.push(Vec::new());
        }
        components[*place].push((y, run));
    }
    components
}

/// The cells of runs.
pub(super) fn cells_of(runs: &[(usize, Run)]) -> Vec<Cell> {
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
                let mut expected = crate::frontier::plane::group(&info, &set, neighbours);
                expected.iter_mut().for_each(|group| group.sort_unstable_by_key(|c| (c.y, c.x)));
                let found: Vec<Vec<Cell>> = components(&plane, neighbours).iter().map(|runs| cells_of(runs)).collect();
                prop_assert_eq!(found, expected);
            }
        }
    }
}
