//! Work on many bits, to be compiled for the instructions that the processor has.

/// Work on many bits: see [`with_bit_instructions`](super::with_bit_instructions).
pub trait BitWork {
    /// What comes out of it.
    type Output;

    /// Does the work. To be compiled for better processors it must be inlined: mark it,
    /// and all that it calls, `#[inline(always)]`.
    fn run(self) -> Self::Output;
}
