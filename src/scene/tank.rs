//! A tank of water in the plane, open above: the walls of the scenes under gravity.

use finegrain_framework::shape::Shape;

/// Density of water, kg/m^3.
pub const DENSITY: f64 = 1000.0;
/// Gravity, m/s^2, downwards along y.
pub const GRAVITY: f64 = 9.81;

/// A tank with its lower left corner at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tank {
    /// Width inside, m.
    pub width: f64,
    /// Height of the walls, m.
    pub height: f64,
}

impl Tank {
    /// The walls: left, right and bottom.
    pub fn walls(&self) -> [Shape; 3] {
        let wall = |point, outward| Shape::HalfSpace { point, outward };
        [
            wall([0.0; 3], [1.0, 0.0, 0.0]),
            wall([self.width, 0.0, 0.0], [-1.0, 0.0, 0.0]),
            wall([0.0; 3], [0.0, 1.0, 0.0]),
        ]
    }
}
