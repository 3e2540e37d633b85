//! Where the points are.

use finegrain_framework::check_memory;
use serde::{Deserialize, Serialize};

use crate::error::FdError;

/// How points lie between the ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Spread {
    /// The first at the lower end, and what leaves at one end comes back at the other.
    Periodic,
    /// The first and the last on the ends: boundary conditions by summation by parts.
    Ends,
    /// In the middle of cells: boundary conditions by ghost points beyond the ends.
    Cells,
}

/// One axis of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Side {
    /// Number of points.
    pub points: usize,
    /// Where it begins, m.
    pub lower: f64,
    /// Where it ends, m.
    pub upper: f64,
    /// How the points lie.
    pub spread: Spread,
}

impl Side {
    /// A side of a periodic mesh.
    pub fn periodic(points: usize, lower: f64, upper: f64) -> Self {
        Self { points, lower, upper, spread: Spread::Periodic }
    }

    /// A side with points on its ends.
    pub fn ends(points: usize, lower: f64, upper: f64) -> Self {
        Self { points, lower, upper, spread: Spread::Ends }
    }

    /// A side with points in the middle of cells.
    pub fn cells(points: usize, lower: f64, upper: f64) -> Self {
        Self { points, lower, upper, spread: Spread::Cells }
    }

    /// Distance of the points, m.
    pub fn spacing(&self) -> f64 {
        let gaps = if self.spread == Spread::Ends { self.points - 1 } else { self.points };
        (self.upper - self.lower) / gaps as f64
    }

    /// Position of a point, m.
    pub fn position(&self, point: usize) -> f64 {
        let shift = if self.spread == Spread::Cells { 0.5 } else { 0.0 };
        self.lower + (point as f64 + shift) * self.spacing()
    }
}

/// Evenly spaced points in 1, 2 or 3 directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    sides: Vec<Side>,
}

/// Names of the axes.
pub(crate) const AXES: [char; 3] = ['x', 'y', 'z'];

impl Mesh {
    /// A mesh with these sides, along x, y and z.
    pub fn new<const D: usize>(sides: [Side; D]) -> Self {
        const { assert!(D >= 1 && D <= 3, "space has 1 to 3 directions") };
        Self { sides: sides.to_vec() }
    }

    /// Number of directions.
    pub fn dims(&self) -> usize {
        self.sides.len()
    }

    /// Its sides, as many as it has directions.
    pub fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Points in each direction, 1 in those that it does not have.
    pub fn shape(&self) -> [usize; 3] {
        [0, 1, 2].map(|a| self.sides.get(a).map_or(1, |side| side.points))
    }

    /// Distance of points in each direction, m; 1 in those that it does not have.
    pub fn spacing(&self) -> [f64; 3] {
        [0, 1, 2].map(|a| self.sides.get(a).map_or(1.0, Side::spacing))
    }

    /// Volume that belongs to a point, m^D, boundaries aside.
    pub fn cell(&self) -> f64 {
        self.sides.iter().map(Side::spacing).product()
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.shape().iter().product()
    }

    /// Position of a point, m; 0 in directions that the mesh does not have.
    pub fn position(&self, point: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|a| self.sides.get(a).map_or(0.0, |side| side.position(point[a])))
    }

    /// Positions of all points, m, x running fastest.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let [nx, ny, _] = self.shape();
        (0..self.points()).map(move |i| self.position([i % nx, i / nx % ny, i / (nx * ny)]))
    }

    /// Refuses a mesh with more points than there is memory for `fields` columns of `T`.
    pub(crate) fn check_memory<T>(&self, fields: usize) -> Result<(), FdError> {
        let points = self.points();
        let checked = check_memory(points, fields * size_of::<T>());
        checked.map_err(|cause| FdError::Memory { points, cause })
    }

    pub(crate) fn is_periodic(&self) -> [bool; 3] {
        [0, 1, 2].map(|a| self.sides.get(a).is_none_or(|side| side.spread == Spread::Periodic))
    }

    /// Refuses a mesh with less than `least(spread)` points along an axis.
    pub(crate) fn check(&self, least: impl Fn(Spread) -> usize) -> Result<(), FdError> {
        for (side, axis) in self.sides.iter().zip(AXES) {
            let &Side { points, lower, upper, spread } = side;
            if points < least(spread) {
                return Err(FdError::TooFew { axis, points, least: least(spread) });
            }
            if !(lower < upper && lower.is_finite() && upper.is_finite()) {
                return Err(FdError::Extent { axis, lower, upper });
            }
        }
        Ok(())
    }
}
