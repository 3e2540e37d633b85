//! In a periodic box momentum is conserved to round-off at every step, and total energy only
//! falls.

mod flow;

use finegrain_framework::Settings;
use finegrain_sph::{Viscosity, measure};

#[test]
fn momentum_to_round_off() {
    for viscosity in [Viscosity::Morris, Viscosity::StrainRate] {
        for dims in [2, 3] {
            let (mut simulation, fields, mass) =
                flow::flow::<f64>(dims, viscosity, false, Settings::default());
            simulation.begin().unwrap();
            let before = measure::totals(&mut simulation.whole(), &fields, mass);
            // What could be lost: every particle's momentum, once.
            let scale = (2.0 * before.kinetic_energy * before.mass).sqrt();
            for _ in 0..40 {
                simulation.advance(1).unwrap();
                let now = measure::totals(&mut simulation.whole(), &fields, mass);
                assert_eq!(now.mass, before.mass);
                for a in 0..dims {
                    let change = (now.momentum[a] - before.momentum[a]).abs() / scale;
                    assert!(change < 1e-13, "{viscosity:?} {dims}-D: {change:e}");
                }
            }
            let now = measure::totals(&mut simulation.whole(), &fields, mass);
            assert!(now.kinetic_energy < before.kinetic_energy);
        }
    }
}
