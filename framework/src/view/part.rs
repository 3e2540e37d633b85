//! Own parts of a column. The argument for its `unsafe` is the [parent's](super).

use std::marker::PhantomData;

use crate::domain::Span;

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
}

impl<'a, T> PartMut<'a, T> {
    /// # Safety
    /// `base` is a column that holds all of `spans`, and nobody else touches it there during `'a`.
    pub(super) unsafe fn new(base: *mut T, spans: &'a [Span]) -> Self {
        Self { base, spans, part: PhantomData }
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
    pub fn whole(self) -> &'a mut [T] {
        assert_eq!(self.spans.len(), 1, "the sub-domain owns several spans");
        let span = self.spans[0];
        // SAFETY: as in `span`, and `self` is consumed, so this stays the only borrow during `'a`.
        unsafe { std::slice::from_raw_parts_mut(self.base.add(span.start), span.len()) }
    }
}
