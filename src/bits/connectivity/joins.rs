//! Which components on the rim of a tile touch those of the tiles to its right and above it.
//!
//! The pairs of all tiles stand in one list, in the order of the tiles: whoever walks over
//! all of them, as every update does, reads memory from its beginning to its end.

/// Two nodes that prefetch, each counted within its tile.
pub(crate) type Pair = [u16; 2];

/// Lists of pairs, one behind the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joins {
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
        &self.pairs[self.start(index) as usize..self.ends[index] as usize]
    }

    /// Makes some lists anew: `append` appends the pairs of each list for which `is_stale`
    /// holds, in turn; all others stay.
    pub fn rebuild(&mut self, is_stale: impl Fn(usize) -> bool, mut append: impl FnMut(usize, &mut Vec<Pair>)) {
        let (mut pairs, mut ends) = std::mem::take(&mut self.next);
        pairs.clear();
        ends.clear();
        let mut next = 0;
        while next < self.ends.len() {
            // Lists that stay are copied together.
            let stay = next..(next..self.ends.len()).find(|&index| is_stale(index)).unwrap_or(self.ends.len());
            let (start, end) = (self.start(stay.start), self.start(stay.end));
            let shift = (pairs.len() as u32).wrapping_sub(start);
            ends.extend(self.ends[stay.clone()].iter().map(|end| end.wrapping_add(shift)));
            pairs.extend_from_slice(&self.pairs[start as usize..end as usize]);
            if stay.end < self.ends.len() {
                append(stay.end, &mut pairs);
                ends.push(pairs.len() as u32);
            }
            next = stay.end + 1;
        }
        self.next = (std::mem::replace(&mut self.pairs, pairs), std::mem::replace(&mut self.ends, ends));
    }

    /// Puts the lists in another order: each becomes the one named, or empty.
    pub fn rearrange(&mut self, origins: impl Iterator<Item = Option<usize>>) {
        let (mut pairs, mut ends) = std::mem::take(&mut self.next);
        pairs.clear();
        ends.clear();
        for origin in origins {
            pairs.extend_from_slice(origin.map_or(&[], |origin| self.list(origin)));
            ends.push(pairs.len() as u32);
        }
        self.next = (std::mem::replace(&mut self.pairs, pairs), std::mem::replace(&mut self.ends, ends));
    }

    /// Where a list starts, or the last ends.
    fn start(&self, index: usize) -> u32 {
        if index > 0 { self.ends[index - 1] } else { 0 }
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
        let count_up = |index: usize, pairs: &mut Vec<Pair>| pairs.extend((0..index as u16).map(|node| [node, 7]));
        joins.rebuild(|_| true, count_up);
        assert_eq!([joins.list(0).len(), joins.list(1).len(), joins.list(2).len()], [0, 1, 2]);
        joins.rebuild(|index| index == 1, |_, pairs| pairs.push([5, 6]));
        assert_eq!((joins.list(1), joins.list(2)), (&[[5, 6]][..], &[[0, 7], [1, 7]][..]));
        joins.rearrange([Some(2), None, Some(1), Some(0)].into_iter());
        let lists = [0, 1, 2, 3].map(|index| joins.list(index));
        assert_eq!(lists, [&[[0, 7], [1, 7]][..], &[], &[[5, 6]], &[]]);
    }
}
