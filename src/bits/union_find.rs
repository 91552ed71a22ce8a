//! Union-find over indices whose root is always the smallest, with path halving (Tarjan
//! and van Leeuwen, JACM 1984). A parent is never greater than its child.

use crate::bits::contacts::Meet;

/// Makes room for `most` members from `first` on, more than a row can have: each is its own
/// parent at first. The buffer grows by one part in `share` at the least, which is less greedy
/// than doubling.
#[inline(always)]
pub(crate) fn make_room(parents: &mut Vec<u32>, first: u32, most: u32, share: usize) {
    let known = parents.len() as u32;
    if known < first + most {
        let more = first + 4 * most - known;
        if parents.capacity() - parents.len() < more as usize {
            parents.reserve_exact((more as usize).max(parents.len() / share));
        }
        parents.extend(known..known + more);
    }
}

/// Unites runs that touch: the members from two places on are the runs of two rows.
pub(crate) struct UniteRuns<'a> {
    /// The parents of all runs.
    pub parents: &'a mut [u32],
    /// The first run of a row.
    pub first: u32,
    /// The first run of the row that it touches.
    pub other_first: u32,
}

impl Meet for UniteRuns<'_> {
    #[inline(always)]
    fn meet(&mut self, run: u32, other_run: u32) {
        unite(self.parents, self.first + run, self.other_first + other_run);
    }
}

/// Unites the sets of two members.
#[inline(always)]
pub(crate) fn unite(parents: &mut [u32], a: u32, b: u32) {
    let grandparent = |member: u32| parents[parents[member as usize] as usize];
    let (mut a, mut b) = (grandparent(a), grandparent(b));
    // Nearly always these are roots, and to look first is a branch well guessed.
    if parents[a as usize] != a || parents[b as usize] != b {
        (a, b) = (root_of(parents, a), root_of(parents, b));
    }
    parents[a.max(b) as usize] = a.min(b);
}

/// The smallest member of a set.
#[inline]
pub(crate) fn root_of(parents: &mut [u32], mut member: u32) -> u32 {
    loop {
        let parent = parents[member as usize];
        if parent == member {
            return member;
        }
        let grandparent = parents[parent as usize];
        parents[member as usize] = grandparent;
        member = grandparent;
    }
}
