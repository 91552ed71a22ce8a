//! What D* Lite knows of one cell.

/// No way is known.
pub const INFINITE: u32 = u32::MAX;
/// The key of a cell that this search has not met.
pub const NOT_MET: u64 = u64::MAX;
/// The key of a cell that waits in no queue.
pub const NOT_QUEUED: u64 = u64::MAX - 1;

/// What the search knows of a cell: the paper's g, rhs and the key in the queue.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub g: u32,
    pub rhs: u32,
    pub key: u64,
}

impl Node {
    pub const NEW: Self = Self { g: INFINITE, rhs: INFINITE, key: NOT_MET };
}
