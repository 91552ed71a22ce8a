//! Reads memory ahead of its use, so that rows far apart are fetched at the same time.

/// Bytes that come from memory together.
const LINE: usize = 64;

/// Reads stretches of memory for nothing but that they are at hand soon. Work on rows far
/// from each other waits for the memory of each in turn; these reads wait for none before
/// they ask for the next.
pub fn prefetch<'a, T: Copy + 'a>(stretches: impl Iterator<Item = &'a [T]>) {
    for stretch in stretches {
        for item in stretch.iter().step_by((LINE / size_of::<T>()).max(1)).chain(stretch.last()) {
            std::hint::black_box(*item);
        }
    }
}
