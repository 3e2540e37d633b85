//! What the ends of the axes are.

use super::NavierStokes;
use super::patch::{Beyond, Edge, Ghost};
use super::stencil::Layer;
use crate::error::FdError;
use crate::mesh::{AXES, Mesh, Spread};
use crate::poisson::axis::Waves;

/// What is at an end of an axis that is not periodic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlowEnd {
    /// A wall that slides with this velocity, m/s, along itself.
    Wall([f64; 3]),
    /// Fluid comes in straight, with the velocity that it has there at the beginning. At a lower end, across from an
    /// [`FlowEnd::Outflow`].
    Inflow,
    /// Fluid leaves, at an upper end. The last layer of cells lies beyond it: where they begin the pressure is zero.
    /// There and in them the velocity goes on along a straight line, so that what comes along is carried out: with half a
    /// weight for the last points of each component these are differences that sum by parts (Kreiss & Scherer 1974), and
    /// in the same weights the pressure does no work. Fluid must not come back in.
    Outflow,
}

impl FlowEnd {
    /// A wall at rest.
    pub const REST: Self = Self::Wall([0.0; 3]);
}

impl NavierStokes {
    /// The ends of an axis, if it is not periodic.
    fn ends_of(&self, mesh: &Mesh, axis: usize) -> Option<[FlowEnd; 2]> {
        let side = mesh.sides().get(axis)?;
        (side.spread == Spread::Cells).then_some(self.ends[axis])
    }

    pub(super) fn check_ends(&self, mesh: &Mesh) -> Result<(), FdError> {
        let is_open =
            |a: usize| self.ends_of(mesh, a).is_some_and(|ends| ends[1] == FlowEnd::Outflow);
        for (a, (side, axis)) in mesh.sides().iter().zip(AXES).enumerate() {
            match side.spread {
                Spread::Periodic => continue,
                Spread::Ends => return Err(FdError::Ends(axis)),
                Spread::Cells => {}
            }
            for (number, (flow_end, end)) in
                self.ends[a].into_iter().zip(["lower", "upper"]).enumerate()
            {
                let cause = match flow_end {
                    FlowEnd::Wall(velocity)
                        if !velocity.iter().all(|v| v.is_finite()) || velocity[a] != 0.0 =>
                    {
                        format!(
                            "the wall moves with {velocity:?} m/s; it must be finite and along the wall"
                        )
                    }
                    FlowEnd::Inflow if number == 1 || !is_open(a) => {
                        "fluid comes in at lower ends, where it leaves at the upper end".to_owned()
                    }
                    FlowEnd::Outflow if number == 0 || (0..a).any(is_open) => {
                        "fluid leaves at one upper end only".to_owned()
                    }
                    _ => continue,
                };
                return Err(FdError::Condition { axis, end, cause });
            }
        }
        Ok(())
    }

    /// What lies beyond the ends for the velocity along axis `i`, or for the pressure.
    pub(super) fn beyond(&self, mesh: &Mesh, i: Option<usize>) -> [Beyond; 3] {
        [0, 1, 2].map(|a| {
            let Some(ends) = self.ends_of(mesh, a) else { return Beyond::Periodic };
            Beyond::Ends(ends.map(|end| match (end, i) {
                (_, None) => Edge::HalfWay(Ghost::SAME),
                (FlowEnd::Outflow, _) => Edge::Straight,
                (FlowEnd::Inflow, Some(i)) if i == a => Edge::Straight,
                (FlowEnd::Inflow, _) => Edge::HalfWay(Ghost::with_value_at_wall(0.0)),
                (FlowEnd::Wall(_), Some(i)) if i == a => Edge::Wall,
                (FlowEnd::Wall(velocity), Some(i)) => {
                    Edge::HalfWay(Ghost::with_value_at_wall(velocity[i]))
                }
            }))
        })
    }

    /// The faces along an axis on which the velocity never changes.
    pub(super) fn steady_faces(&self, mesh: &Mesh, axis: usize) -> Option<Layer> {
        self.ends_of(mesh, axis).map(|_| Layer { axis, place: 0 })
    }

    /// The cells beyond an outflow.
    pub(super) fn layer_beyond(&self, mesh: &Mesh) -> Option<Layer> {
        let axis = (0..mesh.dims())
            .find(|&a| self.ends_of(mesh, a).is_some_and(|ends| ends[1] == FlowEnd::Outflow))?;
        Some(Layer { axis, place: mesh.shape()[axis] - 1 })
    }

    /// What the pressure is along an axis.
    pub(super) fn waves(&self, mesh: &Mesh, axis: usize) -> Waves {
        match self.ends_of(mesh, axis) {
            None => Waves::Periodic,
            Some([_, FlowEnd::Outflow]) => Waves::Open,
            Some(_) => Waves::Closed,
        }
    }
}
