use approx::assert_relative_eq;

use super::{Lattice, Packing, PackingError, wrap};

const PACKINGS: [Packing; 4] =
    [Packing::Square, Packing::Hexagonal, Packing::Cubic, Packing::HexagonalClosePacked];

/// Distances from a particle to all others and to all images next to the box, up to `reach`.
fn distances(lattice: &Lattice, x: [f64; 3], reach: f64) -> Vec<f64> {
    let lengths = lattice.lengths();
    let layers = if lengths[2] > 0.0 { -1..=1 } else { 0..=0 };
    let mut distances = Vec::new();
    for y in lattice.positions() {
        for k in layers.clone() {
            for j in -1..=1 {
                for i in -1..=1 {
                    let shift = [i, j, k].map(f64::from);
                    let r2: f64 =
                        (0..3).map(|k| (x[k] - y[k] - shift[k] * lengths[k]).powi(2)).sum();
                    if r2.sqrt() < reach {
                        distances.push(r2.sqrt());
                    }
                }
            }
        }
    }
    distances.sort_by(f64::total_cmp);
    distances
}

#[test]
fn every_particle_has_all_nearest_neighbours_at_the_spacing() {
    let spacing = 0.3;
    // A box of several cells, and one of a single cell, whose neighbours are all images.
    for wished in [[1.5, 1.6, 1.7], [0.3, 0.4, 0.4]] {
        for (packing, neighbours) in PACKINGS.into_iter().zip([4, 6, 6, 12]) {
            let lattice = packing.fit(wished, spacing).unwrap();
            for x in lattice.positions() {
                let distances = distances(&lattice, x, 1.4 * spacing);
                assert_eq!(distances.len(), 1 + neighbours, "{packing:?} at {x:?}");
                assert_eq!(distances[0], 0.0);
                for distance in &distances[1..] {
                    assert_relative_eq!(*distance, spacing, max_relative = 1e-14);
                }
            }
        }
    }
}

#[test]
fn close_packing_has_the_shells_of_hcp() {
    let lattice = Packing::HexagonalClosePacked.fit([6.0, 6.0, 6.0], 1.0).unwrap();
    let x = lattice.positions().next().unwrap();
    // Neighbours by distance squared: 12 at 1, 6 at 2, 2 at 8/3, 18 at 3, 12 at 11/3; cubic
    // close packing has none at 8/3.
    let mut shells = Vec::<(f64, usize)>::new();
    for distance in distances(&lattice, x, 1.95).into_iter().skip(1) {
        let r2 = distance * distance;
        match shells.last_mut() {
            Some((shell, count)) if (*shell - r2).abs() < 1e-9 => *count += 1,
            _ => shells.push((r2, 1)),
        }
    }
    let expected = [(1.0, 12), (2.0, 6), (8.0 / 3.0, 2), (3.0, 18), (11.0 / 3.0, 12)];
    assert_eq!(shells.len(), expected.len());
    for (found, expected) in shells.into_iter().zip(expected) {
        assert_relative_eq!(found.0, expected.0, max_relative = 1e-12);
        assert_eq!(found.1, expected.1);
    }
}

#[test]
fn particles_fill_the_box() {
    let spacing = 0.07;
    for packing in PACKINGS {
        let lattice = packing.fit([1.0, 0.9, 0.8], spacing).unwrap();
        let dimension = packing.dimension().number();
        let lengths = lattice.lengths();
        let volume: f64 = lengths[..dimension].iter().product();
        let filled = lattice.count() as f64 * lattice.volume_per_particle();
        assert_relative_eq!(filled, volume, max_relative = 1e-14);
        assert_eq!(lattice.positions().count(), lattice.count());

        let (mut least, mut greatest) = ([f64::INFINITY; 3], [0.0_f64; 3]);
        for x in lattice.positions() {
            for k in 0..3 {
                least[k] = least[k].min(x[k]);
                greatest[k] = greatest[k].max(x[k]);
            }
        }
        for k in 0..dimension {
            assert!(least[k] >= 0.0 && greatest[k] < lengths[k]);
            assert_relative_eq!(least[k], lengths[k] - greatest[k], epsilon = 1e-14);
        }
        assert_eq!(least[dimension..], greatest[dimension..]);
    }
    for (packing, volume) in PACKINGS.into_iter().zip([
        spacing.powi(2),
        3.0_f64.sqrt() / 2.0 * spacing.powi(2),
        spacing.powi(3),
        spacing.powi(3) / 2.0_f64.sqrt(),
    ]) {
        let lattice = packing.fit([1.0; 3], spacing).unwrap();
        assert_relative_eq!(lattice.volume_per_particle(), volume, max_relative = 1e-14);
    }
}

#[test]
fn box_moves_by_half_a_cell_at_most() {
    let spacing = 0.013;
    for packing in PACKINGS {
        let half_cell = match packing {
            Packing::Square | Packing::Cubic => [0.5; 3],
            _ => [0.5, 3.0_f64.sqrt() / 2.0, (2.0_f64 / 3.0).sqrt()],
        };
        for i in 0..100 {
            let side = 0.1 + 0.001 * f64::from(i);
            let lattice = packing.fit([side; 3], spacing).unwrap();
            let lengths = lattice.lengths().into_iter().zip(half_cell);
            for (length, half_cell) in lengths.take(packing.dimension().number()) {
                let moved = (length - side).abs();
                assert!(moved <= half_cell * spacing * (1.0 + 1e-12));
            }
        }
    }
}

/// Holmes, Williams & Tilke (2011), Table 1: about 100,000 particles for each 0.001 m of width.
/// The whole box holds 8 % more than these round numbers.
#[test]
fn papers_boxes_hold_about_as_many_particles_as_its_table_1() {
    for thousandths in 1..=7 {
        let width = 0.001 * f64::from(thousandths);
        let lattice = Packing::HexagonalClosePacked.fit([0.025, 0.025, width], 0.0002).unwrap();
        let published = 1e5 * f64::from(thousandths);
        assert_relative_eq!(lattice.count() as f64, published, max_relative = 0.1);
    }
}

#[test]
fn displacements_stay_within_their_reach_and_the_box() {
    let (spacing, fraction) = (0.1, 0.2);
    for packing in PACKINGS {
        let lattice = packing.fit([2.0, 2.0, 1.0], spacing).unwrap();
        let lengths = lattice.lengths();
        let dimension = packing.dimension().number();
        let (mut sum, mut sum_of_squares) = (0.0, 0.0);
        for (x, moved) in lattice.positions().zip(lattice.displaced_positions(fraction, 7)) {
            assert_eq!(x[dimension..], moved[dimension..]);
            for k in 0..dimension {
                assert!((0.0..lengths[k]).contains(&moved[k]));
                let shift = (moved[k] - x[k]) / spacing;
                let period = lengths[k] / spacing;
                let shift = shift - period * (shift / period).round();
                assert!(shift.abs() <= fraction * (1.0 + 1e-12));
                sum += shift;
                sum_of_squares += shift * shift;
            }
        }
        // An even distribution has mean 0 and variance fraction^2 / 3.
        let samples = (dimension * lattice.count()) as f64;
        assert!((sum / samples).abs() < 4.0 * fraction / (3.0 * samples).sqrt());
        let variance = fraction * fraction / 3.0;
        assert_relative_eq!(sum_of_squares / samples, variance, max_relative = 0.1);
    }
}

#[test]
fn displacements_follow_the_published_generator() {
    // First outputs of PCG XSL RR 128/64 from state 42, stream 54, as its author publishes them.
    const OUTPUTS: [u64; 4] = [
        0x86b1_da1d_7206_2b68,
        0x1304_aa46_c985_3d39,
        0xa367_0e9e_0dd5_0358,
        0xf909_0e52_9a7d_ae00,
    ];
    let lattice = Packing::Square.fit([4.0, 4.0, 0.0], 1.0).unwrap();
    let fraction = 0.25;
    let positions = lattice.positions().zip(lattice.displaced_positions(fraction, 42));
    for ((x, moved), outputs) in positions.zip(OUTPUTS.chunks(2)) {
        for k in 0..2 {
            let even = (outputs[k] >> 11) as f64 / 2.0_f64.powi(53);
            assert_eq!(moved[k], x[k] + fraction * (2.0 * even - 1.0));
        }
    }
}

#[test]
fn seeds_differ_and_repeat() {
    let lattice = Packing::Cubic.fit([1.0; 3], 0.1).unwrap();
    let displaced = |seed| lattice.displaced_positions(0.1, seed).collect::<Vec<_>>();
    assert_eq!(displaced(1), displaced(1));
    assert_ne!(displaced(1), displaced(2));
    assert!(lattice.positions().eq(lattice.displaced_positions(0.0, 1)));
}

#[test]
fn images_lie_within_the_box() {
    assert_eq!(wrap(-1e-20, 1.0), 0.0);
    assert_eq!(wrap(1.0, 1.0), 0.0);
    assert_eq!(wrap(-0.25, 1.0), 0.75);
    assert_eq!(wrap(0.25, 1.0), 0.25);
}

#[test]
fn boxes_that_cannot_be_filled_are_refused() {
    let packing = Packing::HexagonalClosePacked;
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = packing.fit([1.0; 3], spacing);
        assert!(matches!(refused, Err(PackingError::Spacing(_))));
    }
    for height in [0.8, 0.0, -3.0, f64::NAN, f64::INFINITY] {
        let refused = packing.fit([3.0, 3.0, height], 1.0);
        assert!(matches!(refused, Err(PackingError::Side { side: 2, .. })));
    }
    let refused = packing.fit([1.0; 3], 1e-5);
    assert!(matches!(refused, Err(PackingError::Count(_))));
}
