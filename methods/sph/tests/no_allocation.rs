//! A steady step allocates nothing: two sweeps and walls, particles sorted anew included.
//!
//! Lists of pairs that are kept are not among it: they take no more memory than they need, and grow when a
//! sub-domain has more pairs than ever.
//!
//! One test alone in its binary: see `counting`.

#[path = "../../../framework/tests/counting/mod.rs"]
mod counting;
mod flow;

use counting::allocations;
use finegrain_framework::{Schedule, Settings};
use finegrain_sph::{Scheme, Viscosity};

#[test]
fn steady_steps_allocate_nothing() {
    let mut found = Vec::new();
    for schedule in [Schedule::Serial, Schedule::Lockstep, Schedule::PeerToPeer, Schedule::Fixed] {
        for workers in [1, 3] {
            let settings = Settings { schedule, workers, ..Settings::default() };
            for (name, viscosity, scheme) in [
                ("one sweep", Viscosity::Monaghan, Scheme::default()),
                ("two sweeps", Viscosity::StrainRate, Scheme::default()),
                ("density as a sum", Viscosity::Morris, flow::edac()),
            ] {
                let model = flow::sph::<f64, f64>(2, viscosity, &scheme, true).model;
                let count = allocations(model, &settings);
                if count > 0 {
                    found.push(format!("{name}: {count} under {settings:?}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
