//! Bodies given as shapes: obstacles and walls that every method reads in its own way.

mod body;

use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use body::Body;

/// A solid body, described once for every method.
///
/// A particle method marks the particles inside as boundary, a grid method cuts or marks its
/// cells. Lengths are in metres, like the domain's. A shape knows nothing of periodic images: the
/// caller passes the image of the point that is nearest to the body.
///
/// In two dimensions `z` is 0: a disc is a [`Shape::Cylinder`] along [`Axis::Z`], a rectangle a
/// [`Shape::Cuboid`] without bounds in `z`.
///
/// ```
/// use finegrain_framework::shape::{Axis, Shape};
///
/// let cylinder = Shape::Cylinder { axis: Axis::Z, centre: [0.05, 0.05, 0.0], radius: 0.02 };
/// assert!(cylinder.contains([0.06, 0.05, 7.0]));
/// assert!((cylinder.signed_distance([0.05, 0.08, 0.0]) - 0.01).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A circular cylinder, without ends along `axis`.
    Cylinder {
        /// The direction in which the cylinder extends.
        axis: Axis,
        /// Any point of the centre line; the component along `axis` does not matter.
        centre: [f64; 3],
        /// Radius, above zero.
        radius: f64,
    },
    /// All points outside of a circular cylinder without ends: the wall of a pipe.
    Bore {
        /// The direction in which the pipe goes.
        axis: Axis,
        /// Any point of its centre line; the component along `axis` does not matter.
        centre: [f64; 3],
        /// Radius of the pipe, above zero.
        radius: f64,
    },
    /// A ball.
    Sphere {
        /// Centre.
        centre: [f64; 3],
        /// Radius, above zero.
        radius: f64,
    },
    /// A box with its faces across the coordinate directions.
    Cuboid {
        /// Lower corner; minus infinity where the box has no lower face.
        low: [f64; 3],
        /// Upper corner, above `low`; infinity where the box has no upper face.
        high: [f64; 3],
    },
    /// All points on one side of a plane.
    HalfSpace {
        /// A point of the plane.
        point: [f64; 3],
        /// Direction out of the body, of any length but zero.
        outward: [f64; 3],
    },
}

/// A coordinate direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    Y,
    /// The third coordinate.
    Z,
}

/// Why a [`Shape`] describes no body.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ShapeError {
    /// A radius is zero, negative, infinite or not a number.
    #[error("radius must be finite and above zero, not {0}")]
    Radius(f64),
    /// A centre, or the point of a plane, is not a finite point.
    #[error("position must be finite, not {0:?}")]
    Position([f64; 3]),
    /// A corner of a cuboid is not below the opposite one.
    #[error("corner {low:?} must be below corner {high:?} in every direction")]
    Corners {
        /// The corner given as lower.
        low: [f64; 3],
        /// The corner given as upper.
        high: [f64; 3],
    },
    /// A direction is zero or not finite.
    #[error("direction must be finite and other than zero, not {0:?}")]
    Direction([f64; 3]),
    /// A component of the velocity of a body's surface, m/s, is infinite or not a number.
    #[error("surface_velocity is {0}; it must be finite")]
    SurfaceVelocity(f64),
}

impl Shape {
    /// Checks that the numbers describe a body.
    ///
    /// # Errors
    /// [`ShapeError`] says which number is at fault.
    pub fn check(&self) -> Result<(), ShapeError> {
        let finite = |v: [f64; 3]| v.iter().all(|c| c.is_finite());
        match *self {
            Shape::Cylinder { centre, radius, .. }
            | Shape::Bore { centre, radius, .. }
            | Shape::Sphere { centre, radius } => {
                if !(radius > 0.0 && radius.is_finite()) {
                    return Err(ShapeError::Radius(radius));
                }
                if !finite(centre) {
                    return Err(ShapeError::Position(centre));
                }
            }
            Shape::Cuboid { low, high } => {
                if !(0..3).all(|k| low[k] < high[k]) {
                    return Err(ShapeError::Corners { low, high });
                }
            }
            Shape::HalfSpace { point, outward } => {
                if !finite(point) {
                    return Err(ShapeError::Position(point));
                }
                if !finite(outward) || norm(outward) == 0.0 {
                    return Err(ShapeError::Direction(outward));
                }
            }
        }
        Ok(())
    }

    /// Distance from `x` to the surface: negative inside, zero on the surface, positive outside.
    pub fn signed_distance(&self, x: [f64; 3]) -> f64 {
        match *self {
            Shape::Cylinder { axis, centre, radius } => {
                norm(across(axis, difference(x, centre))) - radius
            }
            Shape::Bore { axis, centre, radius } => {
                radius - norm(across(axis, difference(x, centre)))
            }
            Shape::Sphere { centre, radius } => norm(difference(x, centre)) - radius,
            Shape::Cuboid { low, high } => {
                let beyond = beyond_faces(x, low, high);
                let nearest_face = beyond.into_iter().fold(f64::NEG_INFINITY, f64::max);
                if nearest_face > 0.0 { norm(beyond.map(|b| b.max(0.0))) } else { nearest_face }
            }
            Shape::HalfSpace { point, outward } => dot(difference(x, point), unit(outward)),
        }
    }

    /// Whether `x` is inside the body or on its surface.
    pub fn contains(&self, x: [f64; 3]) -> bool {
        self.signed_distance(x) <= 0.0
    }

    /// Where the straight way from `from` to `to` first meets the surface, as a fraction of the way
    /// between 0 and 1; `None` if it misses the body or begins in it.
    pub fn crossing(&self, from: [f64; 3], to: [f64; 3]) -> Option<f64> {
        if self.contains(from) {
            return None;
        }
        let way = difference(to, from);
        let fraction = match *self {
            Shape::Cylinder { axis, centre, radius } => {
                let start = across(axis, difference(from, centre));
                entry_into_ball(start, across(axis, way), radius)
            }
            Shape::Bore { axis, centre, radius } => {
                let start = across(axis, difference(from, centre));
                exit_from_ball(start, across(axis, way), radius)
            }
            Shape::Sphere { centre, radius } => {
                entry_into_ball(difference(from, centre), way, radius)
            }
            Shape::Cuboid { low, high } => {
                let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
                for k in 0..3 {
                    if way[k] == 0.0 {
                        if !(low[k]..=high[k]).contains(&from[k]) {
                            return None;
                        }
                    } else {
                        let faces = [low[k], high[k]].map(|face| (face - from[k]) / way[k]);
                        enter = enter.max(faces[0].min(faces[1]));
                        leave = leave.min(faces[0].max(faces[1]));
                    }
                }
                (enter <= leave).then_some(enter)
            }
            Shape::HalfSpace { .. } => {
                let [start, end] = [from, to].map(|x| self.signed_distance(x));
                (end <= 0.0).then(|| start / (start - end))
            }
        };
        fraction.filter(|fraction| *fraction <= 1.0)
    }

    /// Outward unit vector: the gradient of [`Shape::signed_distance`] at `x`.
    ///
    /// Where the gradient is not unique (a centre, a centre line, points inside a cuboid that are
    /// equally near to several faces) it is one of the possible ones: the first coordinate
    /// direction that is.
    pub fn normal(&self, x: [f64; 3]) -> [f64; 3] {
        match *self {
            Shape::Cylinder { axis, centre, .. } => {
                let radial = across(axis, difference(x, centre));
                if norm(radial) > 0.0 {
                    unit(radial)
                } else {
                    match axis {
                        Axis::X => [0.0, 1.0, 0.0],
                        Axis::Y | Axis::Z => [1.0, 0.0, 0.0],
                    }
                }
            }
            Shape::Bore { axis, centre, radius } => {
                Shape::Cylinder { axis, centre, radius }.normal(x).map(|n| -n)
            }
            Shape::Sphere { centre, .. } => {
                let radial = difference(x, centre);
                if norm(radial) > 0.0 { unit(radial) } else { [1.0, 0.0, 0.0] }
            }
            Shape::Cuboid { low, high } => {
                let beyond = beyond_faces(x, low, high);
                let side = |k: usize| {
                    if x[k] - low[k] < high[k] - x[k] { -1.0 } else { 1.0 }
                };
                if beyond.iter().any(|&b| b > 0.0) {
                    unit([0, 1, 2].map(|k| side(k) * beyond[k].max(0.0)))
                } else {
                    let mut nearest = 0;
                    for k in 1..3 {
                        if beyond[k] > beyond[nearest] {
                            nearest = k;
                        }
                    }
                    let mut normal = [0.0; 3];
                    normal[nearest] = side(nearest);
                    normal
                }
            }
            Shape::HalfSpace { outward, .. } => unit(outward),
        }
    }
}

/// How far `x` lies beyond the nearer of the two faces across each direction; negative between.
fn beyond_faces(x: [f64; 3], low: [f64; 3], high: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| (low[k] - x[k]).max(x[k] - high[k]))
}

/// The fraction of the `way` from `start`, outside of a ball about the origin, at which it enters the
/// ball: the smaller root of `|start + s way| = radius`, in the form that does not cancel.
fn entry_into_ball(start: [f64; 3], way: [f64; 3], radius: f64) -> Option<f64> {
    let (a, b) = (dot(way, way), dot(start, way));
    let c = dot(start, start) - radius * radius;
    let discriminant = b * b - a * c;
    (b < 0.0 && discriminant >= 0.0).then(|| c / (discriminant.sqrt() - b))
}

/// The fraction of the `way` from `start`, inside of a ball about the origin, at which it leaves the ball:
/// the larger root, likewise; `None` if the way stays where it is.
fn exit_from_ball(start: [f64; 3], way: [f64; 3], radius: f64) -> Option<f64> {
    let (a, b) = (dot(way, way), dot(start, way));
    let c = dot(start, start) - radius * radius;
    let root = (b * b - a * c).sqrt();
    (a > 0.0).then(|| if b > 0.0 { -c / (b + root) } else { (root - b) / a })
}

/// The part of `v` at right angles to `axis`.
fn across(axis: Axis, v: [f64; 3]) -> [f64; 3] {
    match axis {
        Axis::X => [0.0, v[1], v[2]],
        Axis::Y => [v[0], 0.0, v[2]],
        Axis::Z => [v[0], v[1], 0.0],
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = norm(v);
    v.map(|c| c / length)
}

#[cfg(test)]
mod tests;
