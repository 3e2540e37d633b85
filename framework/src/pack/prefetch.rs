//! Asking for memory before it is needed.

/// Asks for element `index` of `values`, which may lie beyond its end: a hint that changes nothing but when
/// memory arrives. Processors foresee a few streams by themselves; kernels that read dozens, with much to
/// compute in between, are left waiting for them.
#[inline(always)]
pub fn prefetch<T>(values: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a prefetch of any address whatever has no effect that a program can see.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(values.as_ptr().wrapping_add(index).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (values, index);
}
