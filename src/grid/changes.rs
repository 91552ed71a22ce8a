//! Which cells of a map changed from version to version, for whoever keeps something that was
//! made of an earlier one.

use super::{CellRect, GridInfo, Growth, Since};
use std::sync::Arc;

/// So many versions are remembered: a consumer that looks more rarely looks at all cells.
const REMEMBERED: usize = 64;

/// The rectangles that changed in the last versions of a map. A consumer names the version that
/// it knows, whichever it skipped, and is told where it has to look.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    version: u64,
    /// What each of the last versions changed, the newest last, by its columns and rows.
    recent: Arc<[CellRect]>,
    /// The last version of which the map grew; 0 if none did.
    grown: u64,
}

impl Changes {
    /// A version of which nothing earlier is known.
    #[must_use]
    pub fn beginning_at(version: u64) -> Self {
        Self { version, recent: Arc::default(), grown: 0 }
    }

    /// The next version, of which only a rectangle differs.
    #[must_use]
    pub fn then(&self, changed: CellRect) -> Self {
        let kept = self.recent.iter().skip((self.recent.len() + 1).saturating_sub(REMEMBERED));
        Self { version: self.version + 1, recent: kept.copied().chain([changed]).collect(), ..*self }
    }

    /// The next version, a map that grew: by so many columns in front and rows below, and any
    /// number behind and above. Of what was on the map before only a rectangle of the new map differs.
    #[must_use]
    pub fn then_grown(&self, (columns, rows): (usize, usize), changed: CellRect) -> Self {
        let moved = |rect: &CellRect| CellRect { x: rect.x + columns, y: rect.y + rows, ..*rect };
        let last = Self { recent: self.recent.iter().map(moved).collect(), ..*self };
        Self { grown: self.version + 1, ..last.then(changed) }
    }

    /// The next version, of which all may differ: a map of another size or place.
    #[must_use]
    pub fn then_all(&self) -> Self {
        Self::beginning_at(self.version + 1)
    }

    /// The next version of something that lies cell by cell where a map does, which may differ where
    /// that one does.
    #[must_use]
    pub fn then_since(&self, since: &Since) -> Self {
        match since {
            Since::Part(changed) => self.then(*changed),
            Since::Grown(growth, changed) => self.then_grown(growth.corner(), *changed),
            Since::All => self.then_all(),
        }
    }

    /// The newest version.
    #[must_use]
    pub const fn version(&self) -> u64 {
        self.version
    }

    /// The smallest rectangle known to hold all that changed since a version, empty for the
    /// newest; `None` when all may have: the version is too old, unknown, or was of another size.
    /// Version 0 stands for a map that has none, of which nothing is known.
    #[must_use]
    pub fn since(&self, version: u64) -> Option<CellRect> {
        if version < self.grown { None } else { self.since_grown(version) }
    }

    /// The same for whoever keeps what lies at the same place when a map grows: by the columns and
    /// rows of the newest version, and only of cells that were on the map before.
    #[must_use]
    pub fn since_grown(&self, version: u64) -> Option<CellRect> {
        if version == 0 {
            return None;
        }
        let missed = usize::try_from(self.version.checked_sub(version)?).ok()?;
        let first = self.recent.len().checked_sub(missed)?;
        Some(self.recent[first..].iter().copied().fold(CellRect::default(), CellRect::union))
    }

    /// Where the newest version, of which size and place are given, may differ from one that is
    /// known with its own.
    #[must_use]
    pub fn since_on(&self, (version, old): (u64, &GridInfo), new: &GridInfo) -> Since {
        match self.since_grown(version) {
            Some(changed) if old == new => Since::Part(changed),
            Some(changed) => Growth::of(old, new).map_or(Since::All, |growth| Since::Grown(growth, changed)),
            None => Since::All,
        }
    }
}

/// The version of a state that somebody has seen last, with its size and place.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Known(Option<(u64, GridInfo)>);

impl Known {
    /// Takes note of the newest version, and tells where it may differ from the one before.
    pub fn renew(&mut self, changes: &Changes, info: &GridInfo) -> Since {
        let last = self.0.replace((changes.version(), *info));
        last.map_or(Since::All, |(version, last)| changes.since_on((version, &last), info))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn rect(x: usize, width: usize) -> CellRect {
        CellRect { x, y: 2, width, height: 1 }
    }

    #[test]
    fn skipped_versions_add_up() {
        let changes = Changes::beginning_at(5).then(rect(3, 2)).then(rect(8, 0)).then(rect(10, 1));
        assert_eq!(changes.version(), 8);
        assert_eq!(changes.since(8), Some(CellRect::default()));
        assert_eq!(changes.since(7), Some(rect(10, 1)));
        assert_eq!(changes.since(5), Some(rect(3, 8)));
        assert_eq!((changes.since(4), changes.since(9)), (None, None), "before the beginning, and to come");
        assert_eq!(changes.then_all().since(8), None);
    }

    #[test]
    fn what_changed_before_a_map_grew_is_named_by_its_new_columns() {
        let changes = Changes::beginning_at(5).then(rect(3, 2)).then_grown((10, 0), rect(1, 0)).then(rect(20, 1));
        assert_eq!(changes.since_grown(5), Some(rect(13, 8)));
        assert_eq!(changes.since_grown(6), Some(rect(20, 1)));
        assert_eq!([5, 6, 7].map(|version| changes.since(version)), [None, None, Some(rect(20, 1))]);
        assert_eq!(changes.then_all().since_grown(8), None);
    }

    #[test]
    fn what_is_long_past_is_forgotten() {
        let changes = (1..101).fold(Changes::beginning_at(1), |changes, x| changes.then(rect(x, 1)));
        assert_eq!(changes.since(101 - REMEMBERED as u64), Some(rect(101 - REMEMBERED, REMEMBERED)));
        assert_eq!(changes.since(100 - REMEMBERED as u64), None);
        assert_eq!(Changes::default().since(0), None);
    }
}
