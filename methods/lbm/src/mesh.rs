//! Where the sites are, and the units that follow from their distance and the time step.

use serde::{Deserialize, Serialize};

use crate::error::{LbmError, finite, positive};
use crate::lattice::{LatticeKind, SOUND_SPEED_SQUARED};

/// Sites in the middle of cubic cells, and the time step.
///
/// In lattice units spacing and time step are 1; these two numbers are the whole conversion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Sites in x, y and z; 1 in z in the plane.
    pub shape: [usize; 3],
    /// Lower corner of the first cell, m: the first site is half a spacing further in each direction.
    pub corner: [f64; 3],
    /// Distance of the sites, m.
    pub spacing: f64,
    /// Time step, s.
    pub time_step: f64,
    /// Which directions are periodic. In others bodies must close the mesh.
    pub periodic: [bool; 3],
}

/// The time step, s, with which a speed has a Mach number: acoustic scaling, `dt ~ dx`.
pub fn time_step_of_mach(spacing: f64, speed: f64, mach: f64) -> f64 {
    spacing * mach * SOUND_SPEED_SQUARED.sqrt() / speed
}

/// The time step, s, with which a kinematic viscosity, m^2/s, has a relaxation time (in time steps):
/// diffusive scaling, `dt ~ dx^2`. From `nu = c_s^2 (tau - 1/2) dt`.
pub fn time_step_of_relaxation_time(spacing: f64, viscosity: f64, relaxation_time: f64) -> f64 {
    SOUND_SPEED_SQUARED * (relaxation_time - 0.5) * spacing * spacing / viscosity
}

impl Mesh {
    /// Relaxation time of a kinematic viscosity, m^2/s, in time steps.
    pub fn relaxation_time(&self, viscosity: f64) -> f64 {
        0.5 + viscosity * self.time_step / (SOUND_SPEED_SQUARED * self.spacing * self.spacing)
    }

    /// Mach number of a speed, m/s.
    pub fn mach(&self, speed: f64) -> f64 {
        speed / (self.unit_velocity() * SOUND_SPEED_SQUARED.sqrt())
    }

    /// One lattice unit of velocity, m/s.
    pub fn unit_velocity(&self) -> f64 {
        self.spacing / self.time_step
    }

    /// One lattice unit of acceleration, m/s^2.
    pub fn unit_acceleration(&self) -> f64 {
        self.spacing / (self.time_step * self.time_step)
    }

    /// Volume of the cell of a site, m^3 (m^2 in 2-D).
    pub fn cell_volume(&self, dims: usize) -> f64 {
        self.spacing.powi(dims as i32)
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.shape.iter().product()
    }

    /// Position of a site, m; sites beyond the mesh have one, too.
    pub fn position(&self, site: [isize; 3]) -> [f64; 3] {
        let mut position = self.corner;
        for a in 0..3 {
            // In the plane z is that of the corner.
            if self.shape[a] > 1 || a < 2 {
                position[a] += (site[a] as f64 + 0.5) * self.spacing;
            }
        }
        position
    }

    /// Number of a site of the mesh, x running fastest.
    pub(crate) fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.shape[1] + y) * self.shape[0] + x
    }

    /// The site of the mesh that is this one or a periodic image of it; `None` beyond a bounded end.
    pub(crate) fn wrap(&self, site: [isize; 3]) -> Option<[usize; 3]> {
        let mut wrapped = [0; 3];
        for a in 0..3 {
            let n = self.shape[a] as isize;
            if !(0..n).contains(&site[a]) && !self.periodic[a] {
                return None;
            }
            wrapped[a] = site[a].rem_euclid(n) as usize;
        }
        Some(wrapped)
    }

    pub(crate) fn check(&self, lattice: LatticeKind) -> Result<(), LbmError> {
        positive("spacing", self.spacing)?;
        positive("time_step", self.time_step)?;
        for c in self.corner {
            finite("corner", c)?;
        }
        if self.sites() == 0 || (lattice.dims() == 2 && self.shape[2] != 1) {
            return Err(LbmError::Shape { shape: self.shape, lattice: lattice.name() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_go_there_and_back() {
        let (spacing, viscosity) = (0.01, 1e-4);
        let mesh = |time_step| Mesh {
            shape: [10, 10, 1],
            corner: [0.0; 3],
            spacing,
            time_step,
            periodic: [true; 3],
        };
        let by_time = mesh(time_step_of_relaxation_time(spacing, viscosity, 0.8));
        assert!((by_time.relaxation_time(viscosity) - 0.8).abs() < 1e-15);
        let by_speed = mesh(time_step_of_mach(spacing, 2.0, 0.1));
        assert!((by_speed.mach(2.0) - 0.1).abs() < 1e-15);
        assert!((by_speed.unit_velocity() * by_speed.time_step - spacing).abs() < 1e-18);
    }
}
