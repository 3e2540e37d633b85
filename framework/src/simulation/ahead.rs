//! How far ahead `PeerToPeer` runs between meetings: as far as the front stays in the cache.
//!
//! A worker that goes on with what it has just made ready walks along a front: sub-domain `i` at
//! step `n`, its neighbour at step `n + 1`, and so on up to `K` steps ahead. It comes back to a
//! sub-domain after some `K^d` others, `d` being the number of directions in which space is
//! divided. While those are still in the cache, memory is read once in `K` steps instead of once
//! a step. Measured on two cores with 32 MiB of shared cache, five-point heat in slabs of 128 KiB
//! to 1 MiB: the best `K` fills about half of a worker's share, and running past it loses what was
//! gained.
//!
//! Where sub-domains are numbered in strips, the front moves to the side by one with each step; once it has
//! left its strip, little of it stays in the cache. So `K` is no more than the strip is wide.

use super::Model;
use super::cache::cache_share;
use crate::domain::{Domain, Partition};

/// Past this nothing is gained, and a person who asks to stop waits longer.
const MOST: u64 = 32;

/// The number of steps for `model` on `workers` workers.
pub(super) fn steps_ahead<D: Domain>(model: &Model<D>, workers: usize) -> u64 {
    let partition = model.domain.partition();
    if partition.is_empty() {
        return 1;
    }
    let bytes = model.columns.memory() as f64 / partition.len() as f64;
    let steps = choose(bytes, directions(partition), cache_share(workers) as f64);
    partition.strip().map_or(steps, |strip| steps.min(strip as u64))
}

fn choose(bytes: f64, directions: f64, share: f64) -> u64 {
    let sub_domains = 0.5 * share / bytes.max(1.0);
    (sub_domains.powf(1.0 / directions) as u64).clamp(1, MOST)
}

/// In how many directions space is divided: a sub-domain of a lattice has `3^d - 1` neighbours.
fn directions(partition: &Partition) -> f64 {
    let neighbours = partition.mean_neighbours();
    (neighbours + 1.0).log(3.0).clamp(1.0, 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Domain;
    use crate::space::Grid;

    #[test]
    fn a_lattice_of_tiles_shows_its_directions() {
        let slabs = Grid::builder([8, 64]).periodic([true, true]).tile(2, 1).build();
        assert_eq!(directions(slabs.partition()), 1.0);
        let tiles = Grid::builder([8, 64, 64]).periodic([true; 3]).tile(4, 4).build();
        assert!((directions(tiles.partition()) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_front_fills_half_the_share() {
        let kib = 1024.0;
        assert_eq!(choose(128.0 * kib, 1.0, 16_384.0 * kib), 32);
        assert_eq!(choose(512.0 * kib, 1.0, 16_384.0 * kib), 16);
        assert_eq!(choose(256.0 * kib, 2.0, 16_384.0 * kib), 5);
        assert_eq!(choose(4096.0 * kib, 1.0, 1024.0 * kib), 1);
    }
}
