//! The instructions of a processor that kernels are compiled for.
//!
//! Every set of instructions is a copy of all kernels, and compiling them is most of what building a
//! method takes. On x86-64 there are two: AVX-512 (x86-64-v4), and AVX2 with FMA (x86-64-v3), which
//! processors have had since 2013 and distributions of Linux have begun to ask for. On other
//! architectures there are those that [`pulp::Arch`] knows.

use pulp::{Arch, WithSimd};

/// This processor lacks instructions that all kernels need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "this processor has neither AVX-512 nor AVX2 with FMA (x86-64-v3), which kernels are compiled for"
)]
pub struct Unsupported;

/// Finds out whether kernels run on this processor.
///
/// # Errors
/// If they do not.
pub fn check() -> Result<(), Unsupported> {
    match Arch::new() {
        #[cfg(target_arch = "x86_64")]
        Arch::Scalar => Err(Unsupported),
        _ => Ok(()),
    }
}

/// Runs a task by the best instructions of this processor.
///
/// ```
/// /// Halves all values.
/// struct Halve<'a>(&'a mut [f64]);
///
/// impl pulp::WithSimd for Halve<'_> {
///     type Output = ();
///
///     #[inline(always)]
///     fn with_simd<S: pulp::Simd>(self, _: S) {
///         self.0.iter_mut().for_each(|value| *value *= 0.5);
///     }
/// }
///
/// let mut values = [1.0, 2.0, 3.0];
/// finegrain_framework::instructions::dispatch(Halve(&mut values));
/// assert_eq!(values, [0.5, 1.0, 1.5]);
/// ```
///
/// # Panics
/// If this processor has none of them: see [`check`].
#[inline]
pub fn dispatch<Task: WithSimd>(task: Task) -> Task::Output {
    match Arch::new() {
        #[cfg(target_arch = "x86_64")]
        Arch::V4(simd) => pulp::Simd::vectorize(simd, task),
        #[cfg(target_arch = "x86_64")]
        Arch::V3(simd) => pulp::Simd::vectorize(simd, task),
        #[cfg(target_arch = "x86_64")]
        _ => panic!("{Unsupported}"),
        #[cfg(not(target_arch = "x86_64"))]
        arch => arch.dispatch(task),
    }
}
