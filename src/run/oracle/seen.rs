//! Sets of samples of the area that coverage is counted on, one bit each.

/// Which samples have been seen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Seen(Vec<u64>);

impl Seen {
    /// None of so many samples.
    pub fn none(samples: usize) -> Self {
        Self(vec![0; samples.div_ceil(64)])
    }

    /// Adds a sample.
    pub fn insert(&mut self, sample: usize) {
        self.0[sample / 64] |= 1 << (sample % 64);
    }

    /// Takes a sample away.
    pub fn remove(&mut self, sample: usize) {
        self.0[sample / 64] &= !(1 << (sample % 64));
    }

    /// Adds all samples of another set.
    pub fn add(&mut self, other: &Self) {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            *mine |= theirs;
        }
    }

    /// Takes away all that are not in another set.
    pub fn keep(&mut self, other: &Self) {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            *mine &= theirs;
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// How many there are with those of another set.
    pub fn count_with(&self, other: &Self) -> usize {
        self.0.iter().zip(&other.0).map(|(mine, theirs)| (mine | theirs).count_ones() as usize).sum()
    }

    /// How many of its samples another set lacks.
    pub fn new_to(&self, other: &Self) -> usize {
        self.0.iter().zip(&other.0).map(|(mine, theirs)| (mine & !theirs).count_ones() as usize).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_counted_alone_and_together() {
        let mut evens = Seen::none(130);
        let mut threes = Seen::none(130);
        (0..130).step_by(2).for_each(|i| evens.insert(i));
        (0..130).step_by(3).for_each(|i| threes.insert(i));
        let (both, sixes) = (65 + 44 - 22, 22);
        assert_eq!((evens.count(), threes.count(), evens.count_with(&threes)), (65, 44, both));
        assert_eq!(threes.new_to(&evens), 44 - sixes);
        evens.add(&threes);
        assert_eq!((evens.count(), threes.new_to(&evens)), (both, 0));
        evens.remove(129);
        assert_eq!(threes.new_to(&evens), 1);
    }
}
