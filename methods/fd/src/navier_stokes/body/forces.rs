//! The forces at ghosts that make velocities there what they must be, after the projection.

use std::sync::Arc;

use finegrain_framework::{Real, Team};
use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::Faces;
use super::faces::{Face, Ghost};
use crate::error::FdError;
use crate::poisson::Solver;

/// The factored system. To the forces come, for each compartment of the bodies, a pressure in it: a force along its
/// gradient does nothing, and is set to none; and the fluid that velocities at ghosts send into it, which is of second
/// order and must come out again, is spread over its outline.
#[derive(Clone)]
pub(crate) struct Forces {
    system: Arc<LU<f64, Dyn, Dyn>>,
    unknowns: DVector<f64>,
}

impl Forces {
    /// From what the projection leaves of a unit force at each ghost; `solver` solves for the pressure.
    ///
    /// # Errors
    /// If the system is singular.
    pub fn new(faces: &Faces, mut solver: Solver<f64>) -> Result<Self, FdError> {
        let (mut team, ghosts) = (alone()?, faces.ghosts.len());
        let size = ghosts + faces.compartments.len();
        let mut system = DMatrix::zeros(size, size);
        let mut pressure = vec![0.0; faces.mesh.points()];
        for (n, ghost) in faces.ghosts.iter().enumerate() {
            pressure.fill(0.0);
            faces.add_divergence(ghost.face, 1.0, &mut pressure);
            solver.solve(&mut team, &mut pressure);
            let left = |face: Face| {
                f64::from(face == ghost.face) - faces.gradient(face, |cell| pressure[cell])
            };
            for (m, row) in faces.ghosts.iter().enumerate() {
                system[(m, n)] = row.sum_of(left);
            }
        }
        for (k, compartment) in faces.compartments.iter().enumerate() {
            for &(n, sign) in compartment {
                system[(n, ghosts + k)] = sign;
                system[(ghosts + k, n)] = sign;
            }
        }
        let system = system.lu();
        if !system.is_invertible() {
            let cause = "velocities at its surface do not determine the forces on it".to_owned();
            return Err(FdError::Body { number: 0, cause });
        }
        Ok(Self { system: Arc::new(system), unknowns: DVector::zeros(size) })
    }

    /// The forces that take away `excess(n)`, by which the velocities at ghost `n` and before it add up to more than
    /// they must.
    pub fn against(&mut self, count: usize, excess: impl Fn(usize) -> f64) -> &[f64] {
        self.unknowns.fill(0.0);
        for n in 0..count {
            self.unknowns[n] = -excess(n);
        }
        self.system.solve_mut(&mut self.unknowns);
        &self.unknowns.as_slice()[..count]
    }
}

fn alone() -> Result<Team, FdError> {
    Team::new(1).map_err(|cause| FdError::Body { number: 0, cause: cause.to_string() })
}

impl Ghost {
    /// What a field comes to that at the surface should be the wall's.
    pub fn sum_of(&self, field: impl Fn(Face) -> f64) -> f64 {
        let image = self.image.iter().map(|&(face, weight)| weight * field(face));
        field(self.face) + image.sum::<f64>()
    }
}

impl Faces {
    /// The derivative of a field in the cells across a face; none on walls.
    pub fn gradient(&self, face: Face, field: impl Fn(usize) -> f64) -> f64 {
        match self.cells(face) {
            [Some(lower), Some(upper)] => {
                (field(upper) - field(lower)) / self.mesh.spacing()[face.axis]
            }
            _ => 0.0,
        }
    }

    /// Adds the divergence of a velocity at a face to a field in the cells.
    pub fn add_divergence<T: Real>(&self, face: Face, velocity: f64, to: &mut [T]) {
        let flux = velocity / self.mesh.spacing()[face.axis];
        for (cell, flux) in self.cells(face).into_iter().zip([flux, -flux]) {
            if let Some(cell) = cell {
                to[cell] += T::of(flux);
            }
        }
    }
}
