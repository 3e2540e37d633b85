//! Writing past the caches.
//!
//! A line that is written is read first, unless it is written past the caches, whole; and one that is not
//! read again soon only drives out others. Where a step touches far more than the caches hold, copies of
//! columns are half as fast again with it.

use std::marker::PhantomData;
use std::ops::Range;

use bytemuck::Pod;

/// Makes what was written past the caches visible to others when it goes out of scope.
pub(crate) struct Fence {
    /// Bytes that this processor writes at once; `None` if it cannot, or it would not pay.
    bytes: Option<usize>,
}

impl Fence {
    pub fn new(pays: bool) -> Self {
        Self { bytes: widest().filter(|_| pays) }
    }

    /// Leave to write past the caches inside this fence, if it pays.
    pub fn bypass(&self) -> Option<Bypass<'_>> {
        self.bytes.map(|bytes| Bypass { bytes, fence: PhantomData })
    }
}

impl Drop for Fence {
    fn drop(&mut self) {
        if self.bytes.is_some() {
            fence();
        }
    }
}

/// Makes what this thread has written past the caches visible to others, before whatever it writes next. It
/// takes as long as memory does: not for every row.
pub(crate) fn fence() {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: part of every x86-64.
    unsafe {
        std::arch::x86_64::_mm_sfence()
    };
}

fn widest() -> Option<usize> {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            return Some(64);
        }
        if is_x86_feature_detected!("avx") {
            return Some(32);
        }
    }
    None
}

/// Leave to write past the caches, which a stage has while that pays. It does not leave its thread, as a fence
/// is one of the thread that has written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bypass<'a> {
    bytes: usize,
    fence: PhantomData<(&'a Fence, *const ())>,
}

impl std::fmt::Debug for Fence {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Fence({:?})", self.bytes)
    }
}

/// What fills rows of vectors. A trait and not a closure: it is to be inlined where the instruction set
/// is known.
pub trait Fill<V, const N: usize> {
    /// Writes the vectors.
    fn fill(self, targets: &mut Targets<'_, V, N>);
}

/// Rows of vectors to be written side by side, past the caches if that pays; see
/// [`RowsOfMut::fill`](crate::space::grid::RowsOfMut::fill).
#[derive(Debug)]
pub struct Targets<'a, V, const N: usize> {
    to: [&'a mut [V]; N],
    /// Vectors are as long as the processor writes at once, and aligned.
    is_past: bool,
    thread: PhantomData<*const ()>,
}

impl<'a, V: Pod, const N: usize> Targets<'a, V, N> {
    /// # Safety
    /// If this is to be past the caches ([`Targets::is_past`]) nobody but this thread sees the rows, and nobody who
    /// could show them to another one, before it has called [`fence`].
    #[inline(always)]
    pub(crate) unsafe fn new(mut to: [&'a mut [V]; N], bypass: Option<Bypass<'_>>) -> Self {
        let mut is_past = bypass.is_some_and(|bypass| bypass.bytes == size_of::<V>());
        // All as long as the first, as the compiler sees: who writes as many checks no index.
        let count = to[0].len();
        for to in &mut to {
            is_past &= to.as_ptr().addr().is_multiple_of(size_of::<V>());
            *to = &mut std::mem::take(to)[..count];
        }
        Self { to, is_past, thread: PhantomData }
    }

    /// Whether they are written past the caches.
    pub(crate) fn is_past(&self) -> bool {
        self.is_past
    }
}

impl<V: Pod, const N: usize> Targets<'_, V, N> {
    /// Number of vectors in each row.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.to[0].len()
    }

    /// A part of every row.
    ///
    /// # Panics
    /// If there are not so many vectors.
    #[inline(always)]
    pub fn part(&mut self, vectors: Range<usize>) -> Targets<'_, V, N> {
        let to = self.to.each_mut().map(|to| &mut to[vectors.clone()]);
        Targets { to, is_past: self.is_past, thread: PhantomData }
    }

    /// Writes vector `i` of every row.
    ///
    /// # Panics
    /// If there is no such vector.
    #[inline(always)]
    pub fn write(&mut self, i: usize, values: [V; N]) {
        #[cfg(target_arch = "x86_64")]
        if self.is_past {
            use std::arch::x86_64::{__m256i, __m512i, _mm256_stream_si256, _mm512_stream_si512};
            for n in 0..N {
                let to = std::ptr::from_mut(&mut self.to[n][i]);
                // SAFETY: `new` saw leave for as many bytes as a vector has, which there is only on
                // processors with these instructions, and that vectors are aligned. This one is borrowed
                // exclusively, and plain bytes. Nobody else sees it before a fence on this thread, which
                // `self` does not leave: who called `new` promised that.
                unsafe {
                    match size_of::<V>() {
                        64 => _mm512_stream_si512(to.cast::<__m512i>(), bytemuck::cast(values[n])),
                        32 => _mm256_stream_si256(to.cast::<__m256i>(), bytemuck::cast(values[n])),
                        _ => to.write(values[n]),
                    }
                }
            }
            return;
        }
        for n in 0..N {
            self.to[n][i] = values[n];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct All<V>(V);

    impl<V: Pod> Fill<V, 1> for All<V> {
        fn fill(self, targets: &mut Targets<'_, V, 1>) {
            for i in 0..targets.to[0].len() {
                targets.write(i, [self.0]);
            }
        }
    }

    /// Whatever the size and place, what is written is there.
    #[test]
    fn what_is_written_past_the_caches_is_there() {
        fn check<V: Pod + PartialEq + std::fmt::Debug>(value: V) {
            #[repr(C, align(64))]
            #[derive(Clone, Copy)]
            struct Lines([u8; 256]);
            for pays in [false, true] {
                let mut lines = Lines([7; 256]);
                let size = size_of::<V>();
                let fence = Fence::new(pays);
                assert!(pays || fence.bypass().is_none());
                let places = bytemuck::cast_slice_mut::<u8, V>(&mut lines.0[size..]);
                // SAFETY: they stay on this thread.
                let mut targets = unsafe { Targets::new([places], fence.bypass()) };
                All(value).fill(&mut targets);
                assert!(lines.0[..size].iter().all(|&b| b == 7));
                assert!(
                    bytemuck::cast_slice::<u8, V>(&lines.0[size..]).iter().all(|v| *v == value)
                );
            }
        }
        check([1.5f64; 8]);
        check([2.5f32; 8]);
        check([2.5f64; 4]);
        check([3.5f64; 2]);
        check(4.5f64);
    }
}
