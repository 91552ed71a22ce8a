//! The pass down and up the columns that the distance transforms begin with.

/// A number of cells that stays where it is at its largest.
pub trait Cells: Copy + Ord {
    /// One cell farther.
    fn farther(self) -> Self;
}

impl Cells for u8 {
    fn farther(self) -> Self {
        self.saturating_add(1)
    }
}

impl Cells for u32 {
    fn farther(self) -> Self {
        self.saturating_add(1)
    }
}

/// Makes of zeros for obstacles, and the largest number for all else, the number of cells to
/// the nearest obstacle in the same column. Row-major; whole rows at a time, so that the
/// compiler turns it into vector code.
pub fn vertical_distances<T: Cells>(width: usize, distances: &mut [T]) {
    let nearer = |row: &mut [T], neighbours: &[T]| {
        for (distance, &neighbour) in row.iter_mut().zip(neighbours) {
            *distance = (*distance).min(neighbour.farther());
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
