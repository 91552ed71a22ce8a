//! What is new on a map that grew, and what lies where it did.

use super::{CellRect, GridInfo};

/// A grid and a later one that holds all of its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    old: GridInfo,
    new: GridInfo,
    /// The column and row of the first cell of the old grid in the new one.
    corner: (usize, usize),
}

/// Where a state may differ from an earlier one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Since {
    /// In these cells alone.
    Part(CellRect),
    /// It grew; of the cells that were there it may differ in those that lie in this rectangle of
    /// the new one.
    Grown(Growth, CellRect),
    /// Everywhere.
    All,
}

impl Growth {
    /// How one grid grew to another; `None` where it did not.
    #[must_use]
    pub fn of(old: &GridInfo, new: &GridInfo) -> Option<Self> {
        new.corner_of(old).map(|corner| Self { old: *old, new: *new, corner })
    }

    /// A grid that stayed as it was.
    pub(super) const fn none(info: &GridInfo) -> Self {
        Self { old: *info, new: *info, corner: (0, 0) }
    }

    /// The grid that was.
    #[must_use]
    pub const fn old(&self) -> &GridInfo {
        &self.old
    }

    /// The grid that is.
    #[must_use]
    pub const fn new_info(&self) -> &GridInfo {
        &self.new
    }

    /// The column and row of the first cell of the old grid in the new one.
    #[must_use]
    pub const fn corner(&self) -> (usize, usize) {
        self.corner
    }

    /// By how many columns and rows old cells lie further on in the new grid.
    #[must_use]
    pub const fn offset(&self) -> (i32, i32) {
        (self.corner.0 as i32, self.corner.1 as i32)
    }

    /// Cells of a rectangle of the new grid, as far as they were there, by their old columns and rows.
    #[must_use]
    pub fn before(&self, rect: CellRect) -> CellRect {
        rect.moved((-self.offset().0, -self.offset().1), &self.old)
    }

    /// The cells that are new, and the old ones that lie fewer than `rim` columns or rows from such,
    /// as rectangles of the new grid. No cell lies in two of them where the rim is 0.
    #[must_use]
    pub fn outside(&self, rim: usize) -> [CellRect; 4] {
        let span = |corner: usize, old: usize, new: usize| {
            let low = if corner > 0 { (corner + rim).min(new) } else { 0 };
            let high = if corner + old < new { (corner + old).saturating_sub(rim) } else { new };
            (low, high.max(low))
        };
        let (width, height) = (self.new.width(), self.new.height());
        let (left, right) = span(self.corner.0, self.old.width(), width);
        let (low, high) = span(self.corner.1, self.old.height(), height);
        let rect = |x: usize, y: usize, right: usize, top: usize| CellRect { x, y, width: right - x, height: top - y };
        [
            rect(0, 0, left, height),
            rect(right, 0, width, height),
            rect(left, 0, right, low),
            rect(left, high, right, height),
        ]
    }

    /// Values laid out for the new grid, with others in the cells that are new.
    pub fn lay<T: Copy>(&self, values: &[T], blank: T) -> Vec<T> {
        let (width, old_width) = (self.new.width(), self.old.width());
        let mut laid = Vec::with_capacity(self.new.len());
        laid.resize(self.corner.1 * width + self.corner.0, blank);
        for row in values.chunks_exact(old_width) {
            laid.extend_from_slice(row);
            // To where the next row begins.
            laid.resize((laid.len() + width - old_width).min(self.new.len()), blank);
        }
        laid.resize(self.new.len(), blank);
        laid
    }

    /// The smallest rectangle that holds all cells of a rectangle of the new grid that were there and
    /// had other values, of old and new ones, row-major; `None` where there are none.
    pub fn changed<T: PartialEq>(&self, [old, new]: [&[T]; 2], part: &CellRect) -> Option<CellRect> {
        let Self { corner: (column, row), .. } = *self;
        let (width, old_width) = (self.new.width(), self.old.width());
        let (left, right) = (part.x.max(column), (part.x + part.width).min(column + old_width));
        let (low, high) = (part.y.max(row), (part.y + part.height).min(row + self.old.height()));
        if left >= right || low >= high {
            return None;
        }
        let new_rows = new.chunks_exact(width).enumerate().skip(low).take(high - low);
        let rows = new_rows.zip(old.chunks_exact(old_width).skip(low - row));
        let rows = rows.map(|((y, new), old)| (y, &new[left..right], &old[left - column..right - column]));
        let changed = rows.filter(|(_, new, old)| new != old).filter_map(|(y, new, old)| {
            let differ = || new.iter().zip(old).map(|(new, old)| new != old);
            let (first, last) = (differ().position(|differs| differs)?, differ().rposition(|differs| differs)?);
            Some(CellRect { x: left + first, y, width: last + 1 - first, height: 1 })
        });
        changed.reduce(CellRect::union)
    }

    /// One value for each row, laid out for the new grid, with another for the rows that are new.
    #[must_use]
    pub fn rows<T: Copy>(&self, values: &[T], blank: T) -> Vec<T> {
        let mut laid = vec![blank; self.new.height()];
        laid.iter_mut().skip(self.corner.1).zip(values).for_each(|(to, from)| *to = *from);
        laid
    }
}

impl Since {
    /// Whether nothing differs.
    #[must_use]
    pub const fn is_nothing(&self) -> bool {
        matches!(self, Self::Part(part) if part.is_empty())
    }

    /// What is kept, at least, may differ in other cells too.
    #[must_use]
    pub fn and(self, others: impl IntoIterator<Item = CellRect>) -> Self {
        let with = |part: CellRect| others.into_iter().fold(part, CellRect::union);
        match self {
            Self::Part(part) => Self::Part(with(part)),
            Self::Grown(growth, part) => Self::Grown(growth, with(part)),
            Self::All => Self::All,
        }
    }

    /// By how many columns and rows what is kept lies further on.
    #[must_use]
    pub const fn offset(&self) -> (i32, i32) {
        match self {
            Self::Grown(growth, _) => growth.offset(),
            Self::Part(_) | Self::All => (0, 0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::Cell;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn each_cell_is_new_or_near_to_such_or_lies_where_it_did(
            (width, height) in (1u32..8, 1u32..8),
            sides in [0u32..5, 0u32..5, 0u32..5, 0u32..5],
            rim in 0usize..5,
        ) {
            let [left, right, low, high] = sides;
            let old = GridInfo::new(width, height, 0.5, Pose::default()).unwrap();
            let corner = old.from_grid_units(-f64::from(left), -f64::from(low));
            let origin = Pose::new(corner.x, corner.y, 0.0);
            let new = GridInfo::new(left + width + right, low + height + high, 0.5, origin).unwrap();
            let growth = Growth::of(&old, &new).unwrap();
            let values: Vec<usize> = (0..old.len()).collect();
            let laid = growth.lay(&values, usize::MAX);
            prop_assert_eq!(laid.len(), new.len());
            let is_new = |cell: Cell| !old.contains(cell.offset((-growth.offset().0, -growth.offset().1)));
            let reach = rim as i32;
            for (index, &value) in laid.iter().enumerate() {
                let cell = new.cell(index);
                let holds = |rect: &&CellRect| rect.columns(&new).contains(&(cell.x as usize)) && rect.rows(&new).contains(&(cell.y as usize));
                let parts = growth.outside(rim);
                let found = parts.iter().filter(holds).count();
                let mut around = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
                let is_near = around.any(|offset| new.contains(cell.offset(offset)) && is_new(cell.offset(offset)));
                prop_assert!(!is_near || found > 0, "{:?} {:?}", cell, parts);
                prop_assert!(rim > 0 || found <= 1 && (found == 1) == is_new(cell));
                let before = growth.before(CellRect::of_cell(cell).unwrap());
                let expected = if is_new(cell) { usize::MAX } else { before.y * old.width() + before.x };
                prop_assert_eq!((value, before.is_empty()), (expected, is_new(cell)));
            }
            prop_assert_eq!(Growth::of(&new, &old).is_some(), new == old);
        }
    }
}
