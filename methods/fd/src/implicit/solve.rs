//! The whole-domain stage that ends an implicit step.

use finegrain_framework::space::Grid;
use finegrain_framework::{Fault, Rate, Real, State, Whole, WholeStage};

use super::system::System;
use crate::time_stepping::Implicit;

/// Solves for the change of the unknown, and makes it.
pub struct Solve<T: Real> {
    scheme: Implicit,
    system: System,
    unknown: State<T>,
    /// `f(u_n, t)`, at the times that the scheme asks for.
    rates: Vec<Rate<T>>,
    /// The last change, for a scheme that asks for it.
    change: Option<State<T>>,
    weights: Vec<f64>,
    right: Vec<f64>,
}

impl<T: Real> Solve<T> {
    pub fn new(
        scheme: Implicit,
        system: System,
        weights: Vec<f64>,
        unknown: State<T>,
        rates: Vec<Rate<T>>,
        change: Option<State<T>>,
    ) -> Self {
        Self { scheme, system, unknown, rates, change, right: vec![0.0; weights.len()], weights }
    }
}

impl<T: Real> WholeStage<Grid> for Solve<T> {
    fn name(&self) -> &str {
        "implicit solve"
    }

    fn run(&mut self, whole: &mut Whole<'_, Grid>) -> Result<(), Fault> {
        // `(1 - share dt L) (u_{n+1} - u_n) = share dt sum(rates) + keep (u_n - u_{n-1})`.
        let [share, keep] = match self.scheme {
            Implicit::BackwardEuler => [1.0, 0.0],
            Implicit::CrankNicolson => [0.5, 0.0],
            Implicit::Bdf2 if whole.step == 0 => [1.0, 0.0],
            Implicit::Bdf2 => [2.0 / 3.0, 1.0 / 3.0],
        };
        let c = share * whole.dt;
        self.system.prepare(c)?;
        let (right, columns) = (&mut self.right, &mut *whole.columns);
        right.fill(0.0);
        for &rate in &self.rates {
            for (r, rate) in right.iter_mut().zip(columns.values(rate)) {
                *r += c * rate.as_f64();
            }
        }
        if let Some(change) = self.change {
            for (r, change) in right.iter_mut().zip(columns.values(change)) {
                *r += keep * change.as_f64();
            }
        }
        right.iter_mut().zip(&self.weights).for_each(|(r, w)| *r *= w);
        self.system.solve(right);
        for (u, &change) in columns.values_mut(self.unknown).iter_mut().zip(&*right) {
            *u += T::of(change);
        }
        if let Some(last) = self.change {
            for (last, &change) in columns.values_mut(last).iter_mut().zip(&*right) {
                *last = T::of(change);
            }
        }
        Ok(())
    }
}
