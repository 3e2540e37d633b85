//! Fringes: where a periodic box gives back as inflow what has left it as outflow.

use finegrain_framework::VectorField;

use crate::error::{SphError, finite, positive};

/// A stretch along x of a periodic box in which the fluid is brought to a given velocity, so that what
/// leaves the box at one end comes in at the other without its eddies (Nordström, Nordin &
/// Henningson 1999).
///
/// There, `dv/dt` has the term `rate w(x) (velocity - v)`, where `w` rises smoothly from 0 to 1
/// over the first half of the stretch and falls back over the last quarter.
#[derive(Clone, Debug, PartialEq)]
pub struct Fringe {
    /// Where it begins, m.
    pub from: f64,
    /// Where it ends, m.
    pub to: f64,
    /// Largest rate at which the fluid takes the velocity on, 1/s. The time step is at
    /// most half its inverse.
    pub rate: f64,
    /// The velocity, m/s.
    pub velocity: VectorField,
}

impl Fringe {
    pub(crate) fn check(&self) -> Result<(), SphError> {
        finite("fringe.from", self.from)?;
        positive("fringe.to - fringe.from", self.to - self.from)?;
        positive("fringe.rate", self.rate)
    }

    /// `rate w(x)`, 1/s (Nordström et al. 1999, eqs. 7 and 8).
    pub(crate) fn rate_at(&self, x: f64) -> f64 {
        let length = self.to - self.from;
        let (rise, fall) = (0.5 * length, 0.25 * length);
        self.rate * (step((x - self.from) / rise) - step((x - self.to) / fall + 1.0))
    }
}

/// A step from 0 at 0 to 1 at 1, all of whose derivatives are continuous.
fn step(x: f64) -> f64 {
    if x <= 0.0 {
        0.0
    } else if x >= 1.0 {
        1.0
    } else {
        1.0 / (1.0 + (1.0 / (x - 1.0) + 1.0 / x).exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rises_and_falls_within_its_stretch() {
        let velocity = VectorField::new(|_, _| [1.0, 0.0, 0.0]);
        let fringe = Fringe { from: 2.0, to: 3.0, rate: 5.0, velocity };
        for x in [0.0, 2.0, 3.0, 4.0] {
            assert_eq!(fringe.rate_at(x), 0.0, "at {x}");
        }
        for (x, rate) in [(2.25, 2.5), (2.5, 5.0), (2.75, 5.0), (2.875, 2.5)] {
            approx::assert_abs_diff_eq!(fringe.rate_at(x), rate, epsilon = 1e-12);
        }
    }
}
