//! Bodies, and how the fluid feels them.

pub use finegrain_framework::shape::Body;

/// Whether the fluid sticks to bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Slip {
    /// It has the velocity of the surface there.
    #[default]
    No,
    /// It passes without friction: the viscous terms leave bodies out.
    Free,
}

/// Where the pressure of the particles that fill bodies comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WallPressure {
    /// From a density that evolves as that of the fluid does: virtual particles that repel by
    /// being compressed (Monaghan 1994).
    #[default]
    Evolved,
    /// From the fluid around, as a mean weighted with the kernel, continued hydrostatically
    /// (Adami, Hu & Adams 2012, eqs. 27 and 28).
    Extrapolated,
}

/// Which velocity friction sees in bodies that the fluid sticks to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WallVelocity {
    /// A profile that is linear from the particle that sees it through that of the surface, at
    /// most `beta_max` times its own (Morris, Fox & Zhu 1997, section 3.4).
    #[default]
    Linear,
    /// A profile that is linear in the distance from the surface and has the surface's velocity
    /// there, fitted to the fluid around by weighted least squares: the one that a particle of a
    /// body has is the same for all that see it, and no particle is too near to the surface.
    Fitted,
    /// Twice that of the surface less a mean of the fluid around, weighted with the kernel (Adami,
    /// Hu & Adams 2012, eqs. 22 and 23).
    Mirrored,
}
