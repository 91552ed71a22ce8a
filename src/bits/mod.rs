//! Planes of one bit a cell and what is connected in them (floor 0): work on 64 cells at once,
//! shared by detectors and planners.

mod bit_work;
mod classify;
pub(crate) mod connectivity;
pub(crate) mod contacts;
pub(crate) mod labels;
pub(crate) mod neighbours;
mod pack;
pub(crate) mod placement;
mod plane;
mod planes;
mod prefetch;
pub(crate) mod runs;
#[cfg(target_arch = "x86_64")]
mod simd;
pub(crate) mod union_find;
pub(crate) mod window;
pub(crate) mod word_spans;

pub(crate) use bit_work::BitWork;
pub(crate) use classify::Classifier;
pub use plane::BitPlane;
pub(crate) use plane::{WORD_CELLS, with_bit_instructions, words_of};
pub(crate) use planes::BitPlanes;
pub(crate) use prefetch::prefetch;
