//! Links: ways of populations from a site of the fluid into a body, and back.

use finegrain_framework::Real;

use crate::body::Wall;

/// A population that comes out of a body: what the wall makes of the one that went in, and of others
/// nearby.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link<T> {
    /// Number of the velocity that comes out.
    pub q: u8,
    /// Number of the body.
    pub body: u8,
    /// Share of the opposite population of the same site.
    into: T,
    /// Share of the opposite population of the next site away from the body.
    far: T,
    /// Share of the same population of the same site.
    same: T,
    /// What a wall that slides adds.
    pub sliding: T,
}

/// What is known of a link when it is made.
pub(crate) struct Cut {
    /// Number of the velocity that comes out.
    pub q: usize,
    /// Number of the body.
    pub body: usize,
    /// Where on the way into the body its surface is, as a fraction.
    pub fraction: f64,
    /// Whether the next site away from the body is in the fluid.
    pub has_far: bool,
    /// `2 w_q c_q . u / c_s^2` with the velocity of the wall in lattice units (Ladd 1994), for the
    /// reference density, so that mass is kept in a closed box.
    pub sliding: f64,
}

impl<T: Real> Link<T> {
    /// The link of a cut (Bouzidi, Firdaouss & Lallemand 2001, eq. 5; with a moving wall Lallemand &
    /// Luo 2003).
    pub fn new(cut: &Cut, wall: Wall) -> Self {
        let d = match wall {
            Wall::HalfWay => 0.5,
            Wall::Interpolated if cut.fraction < 0.5 && !cut.has_far => 0.5,
            Wall::Interpolated => cut.fraction,
        };
        let [into, far, same, sliding] = if d < 0.5 {
            [2.0 * d, 1.0 - 2.0 * d, 0.0, cut.sliding]
        } else {
            [0.5 / d, 0.0, 1.0 - 0.5 / d, cut.sliding * 0.5 / d]
        };
        Self {
            q: cut.q as u8,
            body: cut.body as u8,
            into: T::of(into),
            far: T::of(far),
            same: T::of(same),
            sliding: T::of(sliding),
        }
    }

    /// The population that comes out: `at(opposite, n)` is a population after the last collision,
    /// the one that goes in or the one that comes out, `n` sites away from the body.
    #[inline(always)]
    pub fn returned(&self, at: impl Fn(bool, i32) -> T) -> T {
        let mut sum = self.into * at(true, 0) + self.same * at(false, 0) + self.sliding;
        if self.far != T::zero() {
            sum += self.far * at(true, 1);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(fraction: f64, wall: Wall, has_far: bool, sliding: f64) -> Link<f64> {
        Link::new(&Cut { q: 1, body: 0, fraction, has_far, sliding }, wall)
    }

    /// Wherever the wall is, populations that vary linearly along the link come out linear: each
    /// goes on by one site a step, there and back, and lands where it must.
    #[test]
    fn linear_populations_are_reflected_at_the_surface() {
        // What comes out, one step later, against the distance from this site away from the body.
        let after = |place: f64| 0.2 + 0.3 * place;
        for fraction in [0.01, 0.3, 0.5, 0.7, 1.0] {
            let at = |opposite: bool, n: i32| {
                let n = f64::from(n);
                after(if opposite { 1.0 - 2.0 * fraction - n } else { 1.0 + n })
            };
            let returned = link(fraction, Wall::Interpolated, true, 0.0).returned(at);
            assert!((returned - after(0.0)).abs() < 1e-15, "{fraction}: {returned}");
        }
    }

    /// Steady shear whose velocity is that of a wall on its surface: the populations of the
    /// equilibrium and, to first order in its slope, of the rest, go on as they are.
    #[test]
    fn shear_along_a_wall_that_slides_is_kept() {
        let (rest, share, wall_velocity, slope, relaxation_time) = (0.02, 0.3, 0.7, 0.05, 0.8);
        for fraction in [0.01, 0.3, 0.5, 0.7, 1.0] {
            // Along the velocity that comes out, against the distance from this site.
            let velocity = |n: f64| wall_velocity + slope * (n + fraction);
            let at = |opposite: bool, n: i32| {
                let sign = if opposite { -1.0 } else { 1.0 };
                let stress = (1.0 - relaxation_time) * share * slope;
                rest + sign * share * velocity(f64::from(n)) + stress
            };
            let link = link(fraction, Wall::Interpolated, true, 2.0 * share * wall_velocity);
            let expected = rest + share * velocity(0.0) - relaxation_time * share * slope;
            assert!((link.returned(at) - expected).abs() < 1e-15, "{fraction}");
        }
    }

    #[test]
    fn half_way_is_what_is_left_without_a_next_site() {
        let at = |opposite: bool, n: i32| {
            assert!(n == 0, "looked past a body");
            if opposite { 0.25 } else { 0.5 }
        };
        assert_eq!(link(0.2, Wall::Interpolated, false, 0.125).returned(at), 0.375);
        assert_eq!(link(0.2, Wall::HalfWay, true, 0.125).returned(at), 0.375);
        assert_eq!(link(0.5, Wall::Interpolated, true, 0.125).returned(at), 0.375);
    }
}
