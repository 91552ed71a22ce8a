//! Union-find over indices whose root is always the smallest, with path halving (Tarjan
//! and van Leeuwen, JACM 1984). A parent is never greater than its child.

/// Unites the sets of two members.
#[inline(always)]
pub(super) fn unite(parents: &mut [u32], a: u32, b: u32) {
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
pub(super) fn root_of(parents: &mut [u32], mut member: u32) -> u32 {
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
