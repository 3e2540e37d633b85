//! The stages of a step with bodies.

use std::sync::Arc;

use finegrain_framework::space::Grid;
use finegrain_framework::{Columns, Fault, Rate, Real, State, Whole, WholeStage};

use super::faces::Face;
use super::{Faces, Forces};
use crate::model::Compiled;
use crate::poisson::Solver;

/// What stages with bodies share.
#[derive(Clone, Debug)]
pub(crate) struct Immersed<T: Real> {
    pub faces: Arc<Faces>,
    pub velocity: Vec<State<T>>,
    pub rates: Vec<Rate<T>>,
    pub pressure: Rate<T>,
    /// Of the force on bodies, for those who look.
    pub traction: Vec<Rate<T>>,
    /// By a body force, m/s^2.
    pub acceleration: [f64; 3],
}

impl<T: Real> Immersed<T> {
    fn inside(&self) -> impl Iterator<Item = Face> {
        self.faces.inside.iter().flatten().copied()
    }

    /// Force of the fluid on body number `body` over the density, m^3/s^2, where [`Immersed::traction`] is up to date:
    /// what goes through the outline of the faces inside, and what drives the fluid between this and the surface.
    pub fn force(&self, columns: &Columns, body: usize) -> [f64; 3] {
        let (faces, mut force) = (&self.faces, [0.0; 3]);
        for &Face { axis, cell } in &faces.inside[body] {
            let traction = columns.values(self.traction[axis])[cell].as_f64();
            force[axis] += traction * faces.mesh.cell();
        }
        for (a, excess) in faces.excess[body].into_iter().enumerate() {
            force[a] += self.acceleration[a] * excess;
        }
        force
    }
}

/// What velocities are made to fit bodies.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum When {
    /// Those at the beginning.
    Start,
    /// Those after a step of the same rates, so that rounding does not add up.
    Step,
    /// Rates, for those who look.
    Look,
}

/// Inside of bodies nothing drives the fluid but what makes it fit around them. For those who look keeps what would:
/// the fluxes of momentum through the outline of the faces inside.
pub(crate) struct Still<T: Real> {
    pub immersed: Immersed<T>,
    pub when: When,
}

impl<T: Compiled> WholeStage<Grid> for Still<T> {
    fn name(&self) -> &str {
        "rest in bodies"
    }

    fn run(&mut self, whole: &mut Whole<'_, Grid>) -> Result<(), Fault> {
        let all = &self.immersed;
        match self.when {
            When::Start => {
                for &rate in &all.rates {
                    whole.columns.values_mut(rate).fill(T::zero());
                }
            }
            When::Look => {
                for &traction in &all.traction {
                    whole.columns.values_mut(traction).fill(T::zero());
                }
                for Face { axis, cell } in all.inside() {
                    let rate = whole.columns.values(all.rates[axis])[cell];
                    let fluxes = rate - T::of(all.acceleration[axis]);
                    whole.columns.values_mut(all.traction[axis])[cell] = fluxes;
                }
            }
            When::Step => {}
        }
        for Face { axis, cell } in all.inside() {
            whole.columns.values_mut(all.rates[axis])[cell] = T::zero();
        }
        Ok(())
    }
}

/// Puts the pressure in the place of the divergence, and adds forces at ghosts to the rates, so that with both there
/// is neither slip nor divergence.
pub(crate) struct NoSlip<T: Compiled> {
    pub immersed: Immersed<T>,
    pub solver: Solver<T>,
    pub forces: Forces,
    pub divergence: Vec<T>,
    pub when: When,
}

impl<T: Compiled> WholeStage<Grid> for NoSlip<T> {
    fn name(&self) -> &str {
        "pressure solve and forces of bodies"
    }

    fn run(&mut self, whole: &mut Whole<'_, Grid>) -> Result<(), Fault> {
        let Self { immersed, solver, forces, divergence, when } = self;
        let Immersed { faces, velocity, rates, pressure, traction, .. } = immersed;
        divergence.copy_from_slice(whole.columns.values(*pressure));
        solver.solve(whole.team, whole.columns.values_mut(*pressure));
        // How much of the velocity counts beside the rates.
        let share = match when {
            When::Start => 1.0,
            When::Step => 1.0 / whole.dt,
            When::Look => 0.0,
        };
        let columns = &*whole.columns;
        let p = columns.values(*pressure);
        let left = |face: Face| {
            let velocity = columns.values(velocity[face.axis])[face.cell].as_f64();
            let rate = columns.values(rates[face.axis])[face.cell].as_f64();
            rate + share * velocity - faces.gradient(face, |cell| p[cell].as_f64())
        };
        let excess = |n: usize| {
            let ghost = &faces.ghosts[n];
            ghost.sum_of(left) - share * ghost.sum
        };
        let found = forces.against(faces.ghosts.len(), excess);
        for (ghost, &force) in faces.ghosts.iter().zip(found) {
            let Face { axis, cell } = ghost.face;
            whole.columns.values_mut(rates[axis])[cell] += T::of(force);
            faces.add_divergence(ghost.face, force, divergence);
        }
        whole.columns.values_mut(*pressure).copy_from_slice(divergence);
        solver.solve(whole.team, whole.columns.values_mut(*pressure));
        if *when == When::Look {
            for Face { axis, cell } in faces.inside.iter().flatten().copied() {
                let p = whole.columns.values(*pressure);
                let gradient = faces.gradient(Face { axis, cell }, |cell| p[cell].as_f64());
                whole.columns.values_mut(traction[axis])[cell] -= T::of(gradient);
            }
        }
        Ok(())
    }
}
