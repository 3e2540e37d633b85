//! Scalar quantities of a field, as deterministic reductions.

use finegrain_framework::space::Grid;
use finegrain_framework::{Rate, State, Whole};

use crate::model::{Compiled, Parts};

/// What a field comes to over the whole mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Its integral.
    pub integral: f64,
    /// The integral of its square.
    pub square: f64,
    /// Its smallest value.
    pub least: f64,
    /// Its largest value.
    pub most: f64,
}

/// Sums up a field, with the weights of the difference operators' norm.
pub fn totals<T: Compiled>(
    whole: &mut Whole<'_, Grid>,
    parts: &Parts<T>,
    field: State<T>,
) -> Totals {
    let [integral, square] = whole.sum(|near| {
        let rows = near.rows(field);
        let mut sums = [0.0; 2];
        for (j, k) in near.sub_domain().rows() {
            let weight = parts.weights[1][j] * parts.weights[2][k];
            let mut along = [0.0; 2];
            let row = rows.row(j as isize, k as isize);
            for (u, &w) in row.iter().map(|u| u.as_f64()).zip(&parts.weights[0]) {
                along[0] += w * u;
                along[1] += w * u * u;
            }
            sums[0] += weight * along[0];
            sums[1] += weight * along[1];
        }
        sums
    });
    let [most, least] = whole.max(|near| {
        let rows = near.rows(field);
        let mut most = [f64::NEG_INFINITY; 2];
        for (j, k) in near.sub_domain().rows() {
            for u in rows.row(j as isize, k as isize).iter().map(|u| u.as_f64()) {
                // A NaN must show.
                for (most, u) in most.iter_mut().zip([u, -u]) {
                    *most = if u > *most || u.is_nan() { u } else { *most };
                }
            }
        }
        most
    });
    Totals { integral, square, least: -least, most }
}

/// Force of the fluid on body number `body` of an incompressible flow, over the density, m^3/s^2; the derived fields
/// must be up to date ([`finegrain_framework::Simulation::derive`]).
///
/// # Panics
/// If there is no such body.
pub fn force_on_body<T: Compiled>(
    whole: &Whole<'_, Grid>,
    parts: &Parts<T>,
    body: usize,
) -> [f64; 3] {
    let immersed = parts.immersed.as_ref().expect("a flow with bodies");
    immersed.force(whole.columns, body)
}

/// Largest magnitude of a derived field, which must be up to date; NaN if there is one.
pub fn largest<T: Compiled>(whole: &mut Whole<'_, Grid>, field: Rate<T>) -> f64 {
    let [most] = whole.max(|near| {
        let rows = near.rate_rows(field);
        let mut most = 0.0f64;
        for (j, k) in near.sub_domain().rows() {
            for u in rows.row(j as isize, k as isize) {
                let size = u.as_f64().abs();
                most = if size > most || size.is_nan() { size } else { most };
            }
        }
        [most]
    });
    most
}
