//! Memory of columns: whole cache lines, in large pages, side by side in the caches.
//!
//! A stage walks along many columns at once. If all of these began at the same place of a page, what it
//! touches of them would fall into the same few sets of a cache and drive one another out, long before
//! the cache is full; and columns as large as a power of two, each in pages of its own, do begin so.
//! So each column begins some lines further into its first page than the one before. Large pages spare
//! the processor most of the search for where a page lies. What nobody has touched takes no memory:
//! fields that are derived for those who look cost nothing until somebody does.

use std::ops::{Deref, DerefMut, Range};

use bytemuck::{Pod, Zeroable};
use memmap2::MmapMut;

/// One cache line: columns begin on one, so that full-width loads do not straddle two.
#[repr(C, align(64))]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct Line([u8; 64]);

/// Lines between the beginnings of two columns, as caches of the second level see it: some twenty
/// columns spread over the 64 KiB after which its sets repeat, and over the 4 KiB of the first level's.
const STAGGER: usize = 59;
/// Beginnings that differ.
const PLACES: usize = 32;

impl std::fmt::Debug for Line {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Line")
    }
}

/// Lines, all zero at first.
#[derive(Debug)]
pub(crate) struct Memory {
    map: MmapMut,
    first: usize,
    length: usize,
}

/// The system has no memory for so many bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this takes at least {:.1} GB of memory, which the system does not have", *bytes as f64 / 1e9)]
pub struct NoMemory {
    /// How many.
    pub bytes: usize,
}

/// Asks the system whether it has memory for `elements` of `size` bytes in all, before columns are declared that fill
/// it. That it has does not say that nobody else takes it meanwhile.
///
/// # Errors
/// If it has not.
pub fn check_memory(elements: usize, size: usize) -> Result<(), NoMemory> {
    let bytes = elements.saturating_mul(size);
    // A map of the whole is what systems refuse, where they would give its parts until all is taken.
    MmapMut::map_anon(bytes.max(1)).map(drop).map_err(|_| NoMemory { bytes })
}

impl Memory {
    /// `length` lines for column number `number`.
    ///
    /// # Panics
    /// If the system has no memory left.
    pub fn new(number: usize, length: usize) -> Self {
        let first = number % PLACES * STAGGER;
        // No map is empty.
        let bytes = (first + length).max(1) * size_of::<Line>();
        let map = MmapMut::map_anon(bytes);
        let map = map.unwrap_or_else(|error| panic!("no memory for {bytes} bytes: {error}"));
        // A system without large pages does without.
        #[cfg(target_os = "linux")]
        let _ = map.advise(memmap2::Advice::HugePage);
        Self { map, first, length }
    }

    /// Makes it `length` lines long, whatever they hold.
    pub fn resize(&mut self, length: usize) {
        if length > self.capacity() {
            *self = Self::new(self.first / STAGGER, length);
        }
        self.length = length;
    }

    /// Lines there is room for.
    pub fn capacity(&self) -> usize {
        self.map.len() / size_of::<Line>() - self.first
    }

    fn bytes(&self) -> Range<usize> {
        let [start, end] = [self.first, self.first + self.length];
        start * size_of::<Line>()..end * size_of::<Line>()
    }
}

impl Deref for Memory {
    type Target = [Line];

    fn deref(&self) -> &[Line] {
        bytemuck::cast_slice(&self.map[self.bytes()])
    }
}

impl DerefMut for Memory {
    fn deref_mut(&mut self) -> &mut [Line] {
        let bytes = self.bytes();
        bytemuck::cast_slice_mut(&mut self.map[bytes])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_as_many_as_asked_for_and_zero() {
        for (number, length) in [(0, 0), (0, 1), (1, 1000), (40, 3)] {
            let memory = Memory::new(number, length);
            assert_eq!(memory.len(), length);
            assert!(bytemuck::cast_slice::<Line, u64>(&memory).iter().all(|&word| word == 0));
        }
    }

    #[test]
    fn columns_begin_at_different_places_of_a_page() {
        let place = |number| Memory::new(number, 1).as_ptr().addr() % 4096;
        let mut places: Vec<_> = (0..PLACES).map(place).collect();
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), PLACES);
        assert!(places.iter().all(|place| place % size_of::<Line>() == 0));
    }

    #[test]
    fn room_is_kept() {
        let mut memory = Memory::new(3, 1 << 16);
        let address = memory.as_ptr();
        memory.resize(10);
        assert_eq!(memory.len(), 10);
        memory.resize(1 << 16);
        assert_eq!((memory.len(), memory.as_ptr()), (1 << 16, address));
        memory.resize(1 << 17);
        assert_eq!(memory.len(), 1 << 17);
        assert!(memory.capacity() >= 1 << 17);
    }

    #[test]
    fn more_memory_than_there_is_is_refused() {
        assert_eq!(check_memory(1000, 8), Ok(()));
        for (elements, size) in [(1 << 46, 8), (usize::MAX, 8)] {
            let refused = check_memory(elements, size).unwrap_err();
            assert_eq!(refused.bytes, elements.saturating_mul(size));
        }
        let said = NoMemory { bytes: 512_000_000_000 }.to_string();
        assert_eq!(said, "this takes at least 512.0 GB of memory, which the system does not have");
    }

    /// Columns that nobody looks at take no memory.
    #[test]
    #[cfg(target_os = "linux")]
    fn lines_that_nobody_touches_take_no_memory() {
        let resident = || {
            let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
            pages.split(' ').nth(1).unwrap().parse::<usize>().unwrap() * 4096
        };
        let (before, size) = (resident(), 1 << 30);
        let memory = Memory::new(0, size / size_of::<Line>());
        assert!(resident() < before + size / 4);
        assert_eq!(memory.len() * size_of::<Line>(), size);
    }
}
