//! Parallel stable sort of particles by cell.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

use crate::team::Team;

const DIGIT_BITS: u32 = 8;
const DIGITS: usize = 1 << DIGIT_BITS;
/// Particles that one task counts or moves.
const CHUNK: usize = 16_384;

/// Least-significant-digit radix sort; its memory is kept from sort to sort.
///
/// Stable, so that the result does not depend on how many workers took part. Targets are written
/// by several workers at disjoint places; relaxed atomics make that safe and cost plain moves.
#[derive(Debug, Default)]
pub(super) struct Sorter {
    keys: Vec<AtomicU64>,
    order: Vec<AtomicU32>,
    spare_keys: Vec<AtomicU64>,
    spare_order: Vec<AtomicU32>,
    counts: Vec<[u32; DIGITS]>,
}

impl Sorter {
    /// Sorts `0..points` by `key_of`, all keys being below `key_end`. Returns whether anything
    /// is out of its place.
    pub fn sort(
        &mut self,
        team: &mut Team,
        points: usize,
        key_end: u64,
        key_of: impl Fn(usize) -> u64 + Sync,
    ) -> bool {
        for keys in [&mut self.keys, &mut self.spare_keys] {
            keys.resize_with(points, || AtomicU64::new(0));
        }
        for order in [&mut self.order, &mut self.spare_order] {
            order.resize_with(points, || AtomicU32::new(0));
        }
        let (keys, order) = (&self.keys, &self.order);
        team.for_each(points.div_ceil(CHUNK), 1, |chunk| {
            for i in chunk * CHUNK..((chunk + 1) * CHUNK).min(points) {
                keys[i].store(key_of(i), Relaxed);
                order[i].store(i as u32, Relaxed);
            }
        });
        if keys.windows(2).all(|pair| pair[0].load(Relaxed) <= pair[1].load(Relaxed)) {
            return false;
        }
        let bits = u64::BITS - key_end.leading_zeros();
        for pass in 0..bits.div_ceil(DIGIT_BITS) {
            self.pass(team, pass * DIGIT_BITS);
        }
        true
    }

    /// How many different keys `0..points` have; cheap if those with the same key mostly follow one
    /// another, as they do after an earlier sort.
    pub fn distinct(
        &mut self,
        team: &mut Team,
        points: usize,
        key_of: impl Fn(usize) -> u64 + Sync,
    ) -> usize {
        let keys = &mut self.spare_keys;
        keys.resize_with(points, || AtomicU64::new(0));
        team.for_each_chunk(keys, CHUNK, |chunk, keys| {
            for (i, key) in keys.iter_mut().enumerate() {
                *key.get_mut() = key_of(chunk * CHUNK + i);
            }
        });
        let first_ones = |keys: &mut [AtomicU64]| {
            let mut found = 0;
            for i in 0..keys.len() {
                let key = *keys[i].get_mut();
                if found == 0 || key != *keys[found - 1].get_mut() {
                    *keys[found].get_mut() = key;
                    found += 1;
                }
            }
            found
        };
        let runs = first_ones(keys);
        keys[..runs].sort_unstable_by_key(|key| key.load(Relaxed));
        first_ones(&mut keys[..runs])
    }

    fn pass(&mut self, team: &mut Team, shift: u32) {
        let points = self.keys.len();
        let digit = |key: u64| (key >> shift) as usize & (DIGITS - 1);
        let range = |chunk: usize| chunk * CHUNK..((chunk + 1) * CHUNK).min(points);
        self.counts.resize(points.div_ceil(CHUNK), [0; DIGITS]);
        let keys = &self.keys;
        team.for_each_chunk(&mut self.counts, 1, |chunk, counts| {
            counts[0] = [0; DIGITS];
            for key in &keys[range(chunk)] {
                counts[0][digit(key.load(Relaxed))] += 1;
            }
        });
        // Counts become first places: digit by digit, within a digit chunk by chunk.
        let mut place = 0;
        for d in 0..DIGITS {
            for counts in &mut self.counts {
                let count = std::mem::replace(&mut counts[d], place);
                place += count;
            }
        }
        let (order, spare_keys, spare_order) = (&self.order, &self.spare_keys, &self.spare_order);
        team.for_each_chunk(&mut self.counts, 1, |chunk, places| {
            for i in range(chunk) {
                let key = keys[i].load(Relaxed);
                let place = &mut places[0][digit(key)];
                spare_keys[*place as usize].store(key, Relaxed);
                spare_order[*place as usize].store(order[i].load(Relaxed), Relaxed);
                *place += 1;
            }
        });
        std::mem::swap(&mut self.keys, &mut self.spare_keys);
        std::mem::swap(&mut self.order, &mut self.spare_order);
    }

    /// The keys, ascending after a sort.
    pub fn keys(&self) -> impl Iterator<Item = u64> + '_ {
        self.keys.iter().map(|k| k.load(Relaxed))
    }

    /// Which point belongs at place `i`.
    #[inline]
    pub fn source(&self, i: usize) -> usize {
        self.order[i].load(Relaxed) as usize
    }

    pub fn memory(&self) -> usize {
        (self.keys.capacity() + self.spare_keys.capacity()) * 8
            + (self.order.capacity() + self.spare_order.capacity()) * 4
            + self.counts.capacity() * size_of::<[u32; DIGITS]>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_stable_sort_whatever_the_workers() {
        let points = 50_000;
        let key = |i: usize| (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 47;
        let mut expected: Vec<usize> = (0..points).collect();
        expected.sort_by_key(|&i| key(i));
        for workers in [1, 2, 3, 8] {
            let mut team = Team::new(workers).unwrap();
            let mut sorter = Sorter::default();
            assert!(sorter.sort(&mut team, points, 1 << 17, key));
            assert!((0..points).all(|i| sorter.source(i) == expected[i]));
        }
    }

    #[test]
    fn different_keys_are_counted_in_any_order() {
        let mut team = Team::new(2).unwrap();
        let mut sorter = Sorter::default();
        for (points, keys) in [(0, 7), (1, 7), (5, 7), (50_000, 7), (50_000, 1009)] {
            let expected = points.min(keys);
            let mixed = |i: usize| (i * 31 % keys) as u64;
            assert_eq!(sorter.distinct(&mut team, points, mixed), expected);
            let in_runs = |i: usize| (i * keys / points.max(keys)) as u64;
            assert_eq!(sorter.distinct(&mut team, points, in_runs), expected);
        }
    }

    #[test]
    fn what_is_sorted_is_left_alone() {
        let mut team = Team::new(2).unwrap();
        assert!(!Sorter::default().sort(&mut team, 1000, 1 << 9, |i| i as u64 / 3));
    }
}
