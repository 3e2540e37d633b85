//! Working memory of whole cache lines.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use bytemuck::{Pod, Zeroable};

use crate::memory::Line;

/// A vector that begins on a cache line, so that no full-width load or store of its lanes straddles
/// two, and no [`Record`](super::Record) lies in two.
#[derive(Clone)]
pub struct Buffer<T> {
    lines: Vec<Line>,
    length: usize,
    values: PhantomData<T>,
}

impl<T> Default for Buffer<T> {
    fn default() -> Self {
        Self { lines: Vec::new(), length: 0, values: PhantomData }
    }
}

impl<T: Pod> Buffer<T> {
    /// Makes it `length` values long; new ones are zero, or what was there before it became shorter.
    pub fn resize(&mut self, length: usize) {
        const {
            assert!(size_of::<Line>().is_multiple_of(size_of::<T>()), "values fill a cache line");
        }
        let lines = (length * size_of::<T>()).div_ceil(size_of::<Line>());
        if lines > self.lines.len() {
            self.lines.resize(lines, Line::zeroed());
        }
        self.length = length;
    }
}

impl<T: Pod> Deref for Buffer<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &bytemuck::cast_slice(&self.lines)[..self.length]
    }
}

impl<T: Pod> DerefMut for Buffer<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut bytemuck::cast_slice_mut(&mut self.lines)[..self.length]
    }
}

impl<T> fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Buffer of {} values", self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_begins_on_a_cache_line_and_keeps_what_it_holds() {
        let mut buffer = Buffer::<f32>::default();
        assert!(buffer.is_empty());
        for length in [1, 15, 16, 17, 1000] {
            let before = buffer.to_vec();
            buffer.resize(length);
            assert_eq!(buffer.len(), length);
            assert_eq!(buffer.as_ptr().align_offset(64), 0);
            assert_eq!(buffer[..before.len()], before);
            assert!(buffer[before.len()..].iter().all(|&x| x == 0.0));
            buffer.fill(length as f32);
        }
        buffer.resize(3);
        assert_eq!(*buffer, [1000.0; 3]);
        let mut records = Buffer::<[f64; 8]>::default();
        records.resize(5);
        assert!(records.iter().all(|record| record.as_ptr().align_offset(64) == 0));
    }
}
