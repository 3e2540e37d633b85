//! Bodies and the no-slip condition on them.
//!
//! A body is filled with particles that do not move and take part in the sums (Monaghan 1994). For
//! the viscous terms they are given the velocity that a linear profile through that of the surface
//! has where they are (Morris, Fox & Zhu 1997, section 3.4), or one that is extrapolated from the
//! fluid (Adami, Hu & Adams 2012), or they are left out.

use std::sync::Arc;

use finegrain_framework::Real;
use finegrain_framework::space::cells::Region;

use crate::body::Body;
use crate::quantity::Quantity;

/// The surfaces of all bodies of a scene, with the periodic images that can be seen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Walls {
    /// Number of bodies of the scene.
    count: usize,
    images: Vec<Image>,
}

/// A body as it is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Image {
    /// Number of the body among all.
    pub number: usize,
    body: Body,
    /// To be added to a position for the body to be where it was declared.
    shift: [f64; 3],
}

impl Image {
    fn signed_distance(&self, x: [f64; 3]) -> f64 {
        self.body.shape.signed_distance(std::array::from_fn(|a| x[a] + self.shift[a]))
    }

    /// Direction from `x` straight to the surface, or on into the body, by differences over `step`,
    /// m, in the first `dims` directions.
    pub fn inwards(&self, x: [f64; 3], step: f64, dims: usize) -> [f64; 3] {
        let mut fall = [0.0; 3];
        for a in 0..dims {
            let (mut low, mut high) = (x, x);
            low[a] -= step;
            high[a] += step;
            fall[a] = self.signed_distance(low) - self.signed_distance(high);
        }
        let norm = fall.iter().map(|x| x * x).sum::<f64>().sqrt();
        fall.map(|x| x / norm)
    }
}

impl Walls {
    /// Bodies in a region; images further than `range` from all of the region are left out.
    pub fn new(all: &[Body], region: &Region, range: f64) -> Self {
        let dims = region.lower.len();
        let length = |a: usize| region.upper[a] - region.lower[a];
        let images = |a: usize| if a < dims && region.periodic[a] { -1..=1 } else { 0..=0 };
        let centre: [f64; 3] = std::array::from_fn(|a| {
            if a < dims { 0.5 * (region.lower[a] + region.upper[a]) } else { 0.0 }
        });
        let half_diagonal = 0.5 * (0..dims).map(|a| length(a).powi(2)).sum::<f64>().sqrt();
        let mut seen_bodies = Vec::new();
        for (number, &body) in all.iter().enumerate() {
            for k in images(2) {
                for j in images(1) {
                    for i in images(0) {
                        let mut shift = [0.0; 3];
                        for (a, n) in [i, j, k].into_iter().enumerate().take(dims) {
                            shift[a] = f64::from(n) * length(a);
                        }
                        let seen = std::array::from_fn(|a| centre[a] + shift[a]);
                        if body.shape.signed_distance(seen) < half_diagonal + range {
                            seen_bodies.push(Image { number, body, shift });
                        }
                    }
                }
            }
        }
        Self { count: all.len(), images: seen_bodies }
    }

    /// Distance to the nearest surface, m; negative inside a body.
    pub fn signed_distance(&self, x: [f64; 3]) -> f64 {
        self.distances(x).map(|(_, distance)| distance).fold(f64::INFINITY, f64::min)
    }

    /// Velocity of the nearest surface, m/s; 0 if there is none.
    pub fn surface_velocity(&self, x: [f64; 3]) -> [f64; 3] {
        self.nearest(x).map_or([0.0; 3], |(image, _)| image.body.surface_velocity)
    }

    /// The body with the nearest surface, and the distance to it, m, negative inside.
    pub fn nearest(&self, x: [f64; 3]) -> Option<(&Image, f64)> {
        self.distances(x).min_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// The first body that none of these points is in.
    pub fn find_empty(&self, points: &[[f64; 3]]) -> Option<usize> {
        (0..self.count).find(|&number| {
            let fills = |x: [f64; 3]| {
                self.distances(x).any(|(image, distance)| image.number == number && distance < 0.0)
            };
            !points.iter().any(|&x| fills(x))
        })
    }

    fn distances(&self, x: [f64; 3]) -> impl Iterator<Item = (&Image, f64)> {
        self.images.iter().map(move |image| (image, image.signed_distance(x)))
    }
}

/// How friction sees the particles of bodies.
#[derive(Clone, Debug)]
pub(crate) enum Friction<T> {
    /// With the velocity that they have been given.
    AsGiven,
    /// On a linear profile.
    Linear(NoSlip<T>),
    /// Not at all.
    None,
}

impl<T: Real> Friction<T> {
    /// How a fluid particle at `position` sees the velocities in bodies.
    #[inline(always)]
    pub fn at(&self, position: [f64; 3]) -> Extrapolation<T> {
        match self {
            Self::AsGiven => Extrapolation::none(),
            Self::Linear(no_slip) => no_slip.at(position),
            Self::None => Extrapolation::frictionless(),
        }
    }
}

/// Velocity that friction sees in bodies, besides that with which their particles move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum VelocityInBodies {
    /// That of the surface.
    Surface,
    /// That which is extrapolated from the fluid.
    Mirrored,
}

impl VelocityInBodies {
    /// What friction reads of a particle.
    pub fn reads(in_bodies: Option<Self>, dims: usize) -> Vec<Quantity> {
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        let seen = in_bodies.into_iter().flat_map(|v| (0..dims).map(move |a| v.component(a)));
        velocity.chain(seen).chain([Quantity::Volume, Quantity::WallDepth]).collect()
    }

    /// Its component `a`.
    #[inline(always)]
    pub fn component(self, a: usize) -> Quantity {
        match self {
            Self::Surface => Quantity::SurfaceVelocity(a),
            Self::Mirrored => Quantity::MirroredVelocity(a),
        }
    }
}

/// No-slip condition on the surfaces of all bodies.
#[derive(Clone, Debug)]
pub(crate) struct NoSlip<T> {
    pub walls: Arc<Walls>,
    /// Largest extrapolation, `beta_max - 1` in Morris et al. (1997): a fluid particle very near
    /// the surface would otherwise see wall particles at any velocity.
    pub most: T,
    /// No fluid particle counts as nearer to the surface than this, m.
    pub least_distance: T,
}

impl<T: Real> NoSlip<T> {
    /// How a fluid particle at `position` sees the velocities in bodies.
    pub fn at(&self, position: [f64; 3]) -> Extrapolation<T> {
        let distance = T::of(self.walls.signed_distance(position)).max(self.least_distance);
        Extrapolation { most: self.most, per_depth: T::one() / distance }
    }
}

/// How one particle sees the velocities of wall particles: a velocity that falls linearly through
/// that of the surface differs from its own by `1 + depth_j / distance_i` times the difference to
/// the surface, at most `beta_max` times.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extrapolation<T> {
    most: T,
    per_depth: T,
}

impl<T: Real> Extrapolation<T> {
    /// Wall particles are seen as they are.
    #[inline(always)]
    pub fn none() -> Self {
        Self { most: T::zero(), per_depth: T::zero() }
    }

    /// Wall particles are not seen: at any depth their weight is multiplied by zero.
    #[inline(always)]
    pub fn frictionless() -> Self {
        Self { most: T::zero(), per_depth: T::min_value() }
    }

    /// Multiplies the weights of velocity differences accordingly.
    #[inline(always)]
    pub fn amplify(&self, weights: &mut [T], wall_depth: Option<&[T]>) {
        let Self { most, per_depth } = *self;
        for (weight, &depth) in weights.iter_mut().zip(wall_depth.into_iter().flatten()) {
            *weight *= T::one() + (depth * per_depth).min(most).max(-T::one());
        }
    }
}
