//! Which nodes of tiles touch those of the tiles after and above them.
//!
//! The pairs of all tiles stand in one list, in the order of the tiles: whoever walks over
//! all of them, as every update does, reads memory from its beginning to its end.

/// Two nodes that touch, each counted within its tile.
pub(super) type Pair = [u16; 2];

/// Lists of pairs, one behind the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Joins {
    pairs: Vec<Pair>,
    /// Where each list ends.
    ends: Vec<u32>,
    /// What is built anew, and then takes the place of the others.
    next: (Vec<Pair>, Vec<u32>),
}

impl Joins {
    /// Forgets all, so that there are so many empty lists.
    pub fn reset(&mut self, lists: usize) {
        self.pairs.clear();
        self.ends.clear();
        self.ends.resize(lists, 0);
    }

    /// The pairs of a list.
    pub fn list(&self, index: usize) -> &[Pair] {
        let start = if index > 0 { self.ends[index - 1] } else { 0 };
        &self.pairs[start as usize..self.ends[index] as usize]
    }

    /// Makes some lists anew: `fresh` gets the place of each list in turn and appends its
    /// pairs, or returns `false` for one that is to stay.
    pub fn rebuild(&mut self, mut fresh: impl FnMut(usize, &mut Vec<Pair>) -> bool) {
        let (mut pairs, mut ends) = std::mem::take(&mut self.next);
        pairs.clear();
        ends.clear();
        for index in 0..self.ends.len() {
            if !fresh(index, &mut pairs) {
                pairs.extend_from_slice(self.list(index));
            }
            ends.push(pairs.len() as u32);
        }
        self.next = (std::mem::replace(&mut self.pairs, pairs), std::mem::replace(&mut self.ends, ends));
    }

    /// What the lists take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        (self.pairs.capacity() + self.next.0.capacity()) * size_of::<Pair>()
            + (self.ends.capacity() + self.next.1.capacity()) * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_made_anew_or_stay() {
        let mut joins = Joins::default();
        joins.reset(3);
        joins.rebuild(|index, pairs| {
            pairs.extend((0..index as u16).map(|node| [node, 7]));
            true
        });
        assert_eq!([joins.list(0).len(), joins.list(1).len(), joins.list(2).len()], [0, 1, 2]);
        joins.rebuild(|index, pairs| {
            pairs.extend((index == 1).then_some([5, 6]));
            index == 1
        });
        assert_eq!((joins.list(1), joins.list(2)), (&[[5, 6]][..], &[[0, 7], [1, 7]][..]));
    }
}
