//! Measured quantities against their definition.

mod flow;

use finegrain_framework::Settings;
use finegrain_sph::{Scheme, Viscosity, measure};

/// All pairs, with the nearest periodic image in every direction.
#[test]
fn the_closest_pair_is_that_of_all_pairs() {
    for dims in [2, 3] {
        let (mut simulation, fields, _) = flow::flow::<f64, f64>(
            dims,
            Viscosity::Morris,
            &Scheme::default(),
            false,
            Settings::default(),
        );
        simulation.begin().unwrap();
        let found = measure::closest_pair(&mut simulation.whole());
        let region = simulation.domain().region();
        let columns = simulation.columns();
        let mut least = f64::INFINITY;
        for i in 0..columns.points() {
            for j in 0..i {
                let squared: f64 = (0..dims)
                    .map(|a| {
                        let x = columns.values(fields.position[a]);
                        let length = region.upper[a] - region.lower[a];
                        let d = (x[i] - x[j]).abs();
                        d.min(length - d).powi(2)
                    })
                    .sum();
                least = least.min(squared);
            }
        }
        assert!((found / least.sqrt() - 1.0).abs() < 1e-12, "{found} {}", least.sqrt());
    }
}
