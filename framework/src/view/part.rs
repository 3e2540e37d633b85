//! Own parts of a column. The argument for its `unsafe` is the [parent's](super).

use std::marker::PhantomData;
use std::mem;
use std::ops::Range;

use crate::domain::Span;
use crate::pack::{Bypass, Fill, Pack, Targets, fence};

/// A sub-domain's own part of one column, read only.
#[derive(Clone, Copy)]
pub struct Part<'a, T> {
    base: *const T,
    spans: &'a [Span],
    part: PhantomData<&'a [T]>,
}

impl<'a, T> Part<'a, T> {
    /// # Safety
    /// `base` is a column that holds all of `spans`, and nobody writes there during `'a`.
    pub(super) unsafe fn new(base: *const T, spans: &'a [Span]) -> Self {
        Self { base, spans, part: PhantomData }
    }

    /// Values of span `k` of the sub-domain.
    ///
    /// # Panics
    /// If there is no such span.
    #[inline]
    pub fn span(&self, k: usize) -> &'a [T] {
        let span = self.spans[k];
        // SAFETY: `new` promises that the column holds the span and nobody writes there during `'a`.
        unsafe { std::slice::from_raw_parts(self.base.add(span.start), span.len()) }
    }

    /// All values of a sub-domain that owns one span.
    ///
    /// # Panics
    /// If it owns several.
    #[inline]
    pub fn whole(&self) -> &'a [T] {
        assert_eq!(self.spans.len(), 1, "the sub-domain owns several spans");
        self.span(0)
    }
}

/// A sub-domain's own part of one column, to be written.
pub struct PartMut<'a, T> {
    base: *mut T,
    spans: &'a [Span],
    part: PhantomData<&'a mut [T]>,
    /// Whether some of it was written past the caches, and no fence has come since. Before one, nobody gets to see
    /// any of it who could show it to another thread; this does not leave its own. The last is that of the
    /// leave to do so, which a worker drops before it tells anybody what it has run.
    is_past: bool,
}

impl<'a, T> PartMut<'a, T> {
    /// # Safety
    /// `base` is a column that holds all of `spans`, and nobody else touches it there during `'a`.
    pub(super) unsafe fn new(base: *mut T, spans: &'a [Span]) -> Self {
        Self { base, spans, part: PhantomData, is_past: false }
    }

    /// Number of spans.
    pub fn spans(&self) -> usize {
        self.spans.len()
    }

    /// Values of span `k` of the sub-domain.
    ///
    /// # Panics
    /// If there is no such span.
    #[inline]
    pub fn span(&mut self, k: usize) -> &mut [T] {
        self.show();
        let span = self.spans[k];
        // SAFETY: `new` promises that the column holds the span and nobody else touches it during
        // `'a`; `self` is borrowed for as long as the result lives.
        unsafe { std::slice::from_raw_parts_mut(self.base.add(span.start), span.len()) }
    }

    /// All values of a sub-domain that owns one span.
    ///
    /// # Panics
    /// If it owns several.
    #[inline]
    pub fn whole(mut self) -> &'a mut [T] {
        self.show();
        assert_eq!(self.spans.len(), 1, "the sub-domain owns several spans");
        let span = self.spans[0];
        // SAFETY: as in `span`, and `self` is consumed, so this stays the only borrow during `'a`.
        unsafe { std::slice::from_raw_parts_mut(self.base.add(span.start), span.len()) }
    }

    /// Lets `task` write `range` of span `k` of every part, vector by vector, past the caches if there is leave to.
    ///
    /// # Panics
    /// If a part has no such span, or the span no such range.
    #[inline(always)]
    pub(crate) fn fill<P: Pack<Scalar = T>, const N: usize>(
        simd: P::Simd,
        parts: &mut [Self; N],
        (k, range): (usize, Range<usize>),
        bypass: Option<Bypass<'_>>,
        task: impl Fill<P::Vector, N>,
    ) {
        let mut rows = std::array::from_fn(|_| <&mut [P::Vector]>::default());
        for (row, part) in rows.iter_mut().zip(&*parts) {
            let span = part.spans[k];
            assert!(range.start <= range.end && range.end <= span.len(), "no such range");
            // SAFETY: as in `span`, of a range within it; `parts` are borrowed until this returns, and each is
            // the only one that leads there.
            let values = unsafe {
                std::slice::from_raw_parts_mut(part.base.add(span.start + range.start), range.len())
            };
            *row = P::packs_mut(simd, values);
        }
        // SAFETY: the parts remember it until there is a fence. The last is that of `bypass`, which is on this
        // thread, behind all that the stage does, and before anybody is told that it has been done.
        let mut targets = unsafe { Targets::new(rows, bypass) };
        for part in parts {
            part.is_past |= targets.is_past();
        }
        task.fill(&mut targets);
    }

    /// Before it is shown.
    #[inline]
    fn show(&mut self) {
        if mem::take(&mut self.is_past) {
            fence();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instructions;
    use crate::pack::{Fence, Packed};

    struct Count;

    impl<V: bytemuck::Pod> Fill<V, 1> for Count {
        fn fill(self, targets: &mut Targets<'_, V, 1>) {
            let values: Vec<_> = (0..(size_of::<V>() / 8) as u64).collect();
            targets.write(1, [*bytemuck::from_bytes(bytemuck::cast_slice(&values))]);
        }
    }

    struct FillAndLook<'a>(PartMut<'a, f64>, Option<Bypass<'a>>);

    impl pulp::WithSimd for FillAndLook<'_> {
        type Output = (usize, Vec<u64>);

        fn with_simd<S: pulp::Simd>(self, simd: S) -> Self::Output {
            type P<S> = <f64 as Packed>::Pack<S>;
            let (lanes, mut parts) = (P::<S>::LANES, [self.0]);
            PartMut::fill::<P<S>, 1>(simd, &mut parts, (1, 8..8 + 2 * lanes), self.1, Count);
            let goes_past = size_of::<<P<S> as Pack>::Vector>() == 64 && self.1.is_some();
            assert!(parts[0].is_past || !goes_past, "a fence will be forgotten");
            let bits = parts[0].span(1).iter().map(|x| x.to_bits()).collect();
            assert!(!parts[0].is_past);
            (lanes, bits)
        }
    }

    #[test]
    fn what_was_filled_is_seen_behind_a_fence() {
        #[repr(align(64))]
        struct Lines([f64; 48]);
        let spans = [Span { start: 0, end: 8 }, Span { start: 8, end: 48 }];
        for pays in [false, true] {
            let (mut lines, fence) = (Lines([1.5; 48]), Fence::new(pays));
            // SAFETY: the column holds both spans, and nobody else touches it.
            let part = unsafe { PartMut::new(lines.0.as_mut_ptr(), &spans) };
            let (lanes, bits) = instructions::dispatch(FillAndLook(part, fence.bypass()));
            let mut expected = [1.5f64.to_bits(); 40];
            expected[8 + lanes..][..lanes].copy_from_slice(&[0, 1, 2, 3, 4, 5, 6, 7][..lanes]);
            assert_eq!(bits, expected);
        }
    }

    #[test]
    #[should_panic(expected = "no such range")]
    fn nothing_beyond_a_span_is_filled() {
        let (mut values, spans) = ([0.0; 4], [Span { start: 0, end: 2 }]);
        // SAFETY: as above.
        let mut parts = [unsafe { PartMut::new(values.as_mut_ptr(), &spans) }];
        type One = <f64 as Packed>::Pack<pulp::Scalar>;
        PartMut::fill::<One, 1>(pulp::Scalar, &mut parts, (0, 1..3), None, Count);
    }
}
