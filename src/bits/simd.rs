//! Packing and bit work with AVX2 and BMI where the processor has them: the one module with unsafe code.
//!
//! Packing of cells to bits with AVX2, and code compiled a second time for processors that
//! count and find bits in one instruction and work on four words at a time. In [`pack`], 32
//! cells are compared in one instruction and the results gathered as the sign bits of their
//! bytes; the portable version of the same, and the tests of one against the other, are in
//! [`super::classify`].

#![allow(unsafe_code)]

use std::arch::is_x86_feature_detected;
use std::arch::x86_64::{
    __m256i, _mm256_cmpgt_epi8, _mm256_loadu_si256, _mm256_movemask_epi8, _mm256_or_si256, _mm256_set1_epi8,
};

/// Whether this processor has what [`pack`] needs.
pub(super) fn is_available() -> bool {
    is_x86_feature_detected!("avx2")
}

/// The free and the unknown cells of each word of 64, as [`crate::grid::Thresholds::classify`]
/// has it. As many words as the shortest of the three slices has; `false`, and nothing
/// done, on a processor without AVX2.
pub(super) fn pack(cells: &[[i8; 64]], free: &mut [u64], unknown: &mut [u64], free_max: i8) -> bool {
    if !is_available() {
        return false;
    }
    // SAFETY: the processor has AVX2, as just asked, which is all that the function
    // needs beyond its arguments.
    unsafe { pack_avx2(cells, free, unknown, free_max) };
    true
}

#[target_feature(enable = "avx2")]
fn pack_avx2(cells: &[[i8; 64]], free: &mut [u64], unknown: &mut [u64], free_max: i8) {
    let free_max = _mm256_set1_epi8(free_max);
    for ((cells, free), unknown) in cells.iter().zip(free).zip(unknown) {
        let (mut not_free, mut negative) = (0, 0);
        for (half, shift) in cells.as_chunks::<32>().0.iter().zip([0, 32]) {
            // SAFETY: `half` is 32 readable bytes, and `loadu` asks for no alignment.
            let values = unsafe { _mm256_loadu_si256(half.as_ptr().cast::<__m256i>()) };
            // The sign bit of a byte is set where it is negative, which is unknown, or all
            // ones: beyond `free_max`.
            let beyond = _mm256_or_si256(values, _mm256_cmpgt_epi8(values, free_max));
            not_free |= u64::from(_mm256_movemask_epi8(beyond).cast_unsigned()) << shift;
            negative |= u64::from(_mm256_movemask_epi8(values).cast_unsigned()) << shift;
        }
        *free = !not_free;
        *unknown = negative;
    }
}

/// Runs work on bits, compiled for the instructions that such work likes where the
/// processor has them all.
#[inline]
pub(super) fn with_bit_instructions<W: super::BitWork>(work: W) -> W::Output {
    let has = is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt");
    if has {
        // SAFETY: the processor has the five features, as just asked, which is all that the
        // function needs.
        unsafe { in_hardware(work) }
    } else {
        work.run()
    }
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn in_hardware<W: super::BitWork>(work: W) -> W::Output {
    work.run()
}
