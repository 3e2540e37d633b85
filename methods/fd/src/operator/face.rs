//! Values on the face between two points from the points on one side, of which differences are
//! derivatives: `f'_i = (f_{i+1/2} - f_{i-1/2}) / h`.
//!
//! They are not interpolations: what they give is the function whose means over cells are the points
//! (Shu & Osher 1988), and for that reason the derivative has the full order.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use serde::{Deserialize, Serialize};

/// How a value on a face is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Face {
    /// Upwind, first order: never oscillates, and smears.
    Upwind1,
    /// Upwind-biased, third order.
    Upwind3,
    /// Weighted essentially non-oscillatory, fifth order (Jiang & Shu 1996).
    Weno5,
    /// The same with weights that are less easily disturbed (Borges et al. 2008).
    Weno5Z,
}

impl Face {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Upwind1, Self::Upwind3, Self::Weno5, Self::Weno5Z];

    /// The name used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Upwind1 => "upwind1",
            Self::Upwind3 => "upwind3",
            Self::Weno5 => "weno5",
            Self::Weno5Z => "weno5-z",
        }
    }

    /// Order of accuracy where the solution is smooth.
    pub fn order(self) -> u32 {
        match self {
            Self::Upwind1 => 1,
            Self::Upwind3 => 3,
            Self::Weno5 | Self::Weno5Z => 5,
        }
    }
}

/// Makes values on faces.
pub(crate) trait FaceValue: Copy + Send + Sync + 'static {
    /// The value half-way between the third and the fourth place, from five points in a row, most of
    /// them on the side of the first.
    fn value<V: Pack>(u: [V; 5]) -> V;
}

/// [`Face::Upwind1`].
#[derive(Clone, Copy)]
pub(crate) struct Upwind1;

impl FaceValue for Upwind1 {
    #[inline(always)]
    fn value<V: Pack>([_, _, u, _, _]: [V; 5]) -> V {
        u
    }
}

/// [`Face::Upwind3`].
#[derive(Clone, Copy)]
pub(crate) struct Upwind3;

impl FaceValue for Upwind3 {
    #[inline(always)]
    fn value<V: Pack>([_, a, b, c, _]: [V; 5]) -> V {
        b * of::<V>(5.0 / 6.0) + c * of::<V>(1.0 / 3.0) - a * of::<V>(1.0 / 6.0)
    }
}

/// [`Face::Weno5`].
#[derive(Clone, Copy)]
pub(crate) struct Weno5;

impl FaceValue for Weno5 {
    /// Jiang & Shu (1996), eqs. 2.9, 2.15 to 2.17, with their `epsilon = 1e-6`.
    #[inline(always)]
    fn value<V: Pack>(u: [V; 5]) -> V {
        let mut weights = smoothness(u);
        for k in 0..3 {
            let s = weights[k] + of::<V>(1e-6);
            weights[k] = s.splat_like(of::<V>(LINEAR[k])) / (s * s);
        }
        blend(u, weights)
    }
}

/// [`Face::Weno5Z`].
#[derive(Clone, Copy)]
pub(crate) struct Weno5Z;

impl FaceValue for Weno5Z {
    /// Borges, Carmona, Costa & Don (2008, J. Comput. Phys. 227), eqs. 25 and 28 with `q = 2`, with which
    /// the order is 5 at critical points, too.
    #[inline(always)]
    fn value<V: Pack>(u: [V; 5]) -> V {
        let mut weights = smoothness(u);
        let difference = (weights[0] - weights[2]).abs();
        for k in 0..3 {
            // The ratio is held so that its square has room in single precision.
            let ratio = difference / (weights[k] + of::<V>(1e-30));
            let ratio = ratio.min(ratio.splat_like(of::<V>(1e9)));
            weights[k] = (ratio * ratio + of::<V>(1.0)) * of::<V>(LINEAR[k]);
        }
        blend(u, weights)
    }
}

/// The flux on the face between the third and the fourth of six points in a row, from their states, fluxes
/// and a speed that no wave exceeds: half of it goes with, half against the axis (Lax-Friedrichs splitting;
/// Shu & Osher 1989, J. Comput. Phys. 83, eq. 2.13).
#[inline(always)]
pub(crate) fn split<V: Pack, F: FaceValue>(u: [V; 6], flux: [V; 6], fastest: V) -> V {
    let (mut forth, mut back) = (u, u);
    for n in 0..6 {
        let carried = fastest * u[n];
        forth[n] = (flux[n] + carried) * of::<V>(0.5);
        back[n] = (flux[n] - carried) * of::<V>(0.5);
    }
    let [a, b, c, d, e, _] = forth;
    let [_, j, i, h, g, f] = back;
    F::value([a, b, c, d, e]) + F::value([f, g, h, i, j])
}

/// Weights with which the three parabolas are of fifth order together.
const LINEAR: [f64; 3] = [0.1, 0.6, 0.3];

#[inline(always)]
fn of<V: Pack>(value: f64) -> V::Scalar {
    V::Scalar::of(value)
}

/// How much a parabola varies.
#[inline(always)]
fn measure<V: Pack>(curvature: V, slope: V) -> V {
    curvature * curvature * of::<V>(13.0 / 12.0) + slope * slope * of::<V>(0.25)
}

/// How much each of the three parabolas varies (Jiang & Shu 1996, eq. 3.2 to 3.4).
#[inline(always)]
fn smoothness<V: Pack>([a, b, c, d, e]: [V; 5]) -> [V; 3] {
    [
        measure(a - b * of::<V>(2.0) + c, a - b * of::<V>(4.0) + c * of::<V>(3.0)),
        measure(b - c * of::<V>(2.0) + d, b - d),
        measure(c - d * of::<V>(2.0) + e, c * of::<V>(3.0) - d * of::<V>(4.0) + e),
    ]
}

/// Mean of the values of the three parabolas.
#[inline(always)]
fn blend<V: Pack>([a, b, c, d, e]: [V; 5], weights: [V; 3]) -> V {
    let sixth = of::<V>(1.0 / 6.0);
    let values = [
        a * of::<V>(2.0) - b * of::<V>(7.0) + c * of::<V>(11.0),
        c * of::<V>(5.0) - b + d * of::<V>(2.0),
        c * of::<V>(2.0) + d * of::<V>(5.0) - e,
    ];
    let sum = weights[0] + weights[1] + weights[2];
    let mean = values[0] * weights[0] + values[1] * weights[1] + values[2] * weights[2];
    mean * sixth / sum
}

#[cfg(test)]
mod tests {
    use finegrain_framework::pack::Packed;
    use pulp::Scalar;

    use super::*;

    type One = <f64 as Packed>::Pack<Scalar>;

    fn value<F: FaceValue>(u: [f64; 5]) -> f64 {
        let mut value = [0.0];
        F::value(u.map(|u| One::splat(Scalar, u))).store(&mut value);
        value[0]
    }

    fn derivative<F: FaceValue>(f: impl Fn(f64) -> f64, x: f64, h: f64) -> f64 {
        let around = |face: f64| [0, 1, 2, 3, 4].map(|i| f(x + h * (face + f64::from(i) - 2.5)));
        (value::<F>(around(0.5)) - value::<F>(around(-0.5))) / h
    }

    fn exact_to<F: FaceValue>() -> i32 {
        let is_exact = |q: i32| {
            let wanted = f64::from(q) * 0.7f64.powi(q - 1);
            let got = derivative::<F>(|x| x.powi(q), 0.7, 0.5);
            (got - wanted).abs() < 1e-12
        };
        (0..9).take_while(|&q| is_exact(q)).last().unwrap()
    }

    #[test]
    fn linear_ones_are_exact_for_polynomials() {
        assert_eq!((exact_to::<Upwind1>(), exact_to::<Upwind3>()), (1, 3));
    }

    /// On the flank of a wave, and where its slope vanishes.
    #[test]
    fn weighted_ones_are_of_fifth_order() {
        let order = |error: &dyn Fn(f64) -> f64| (error(0.04) / error(0.02)).log2();
        for (x, least) in [(0.3, 4.9), (std::f64::consts::FRAC_PI_2 + 0.01, 4.5)] {
            let js = order(&|h| (derivative::<Weno5>(f64::sin, x, h) - x.cos()).abs());
            let z = order(&|h| (derivative::<Weno5Z>(f64::sin, x, h) - x.cos()).abs());
            assert!(z > least, "{z} at {x}");
            assert!(js > 4.9 || x > 1.0, "{js} at {x}");
        }
    }

    /// Of a step at any place the value stays between its two sides but for a hundred-thousandth, and is
    /// that of the side it is on.
    #[test]
    fn weighted_ones_do_not_look_over_a_step() {
        for step in 0..6 {
            let u = [0, 1, 2, 3, 4].map(|i| if i < step { 1.0 } else { 0.0 });
            for face in [value::<Weno5>(u), value::<Weno5Z>(u)] {
                assert!((-1e-5..=1.0 + 1e-5).contains(&face), "{face} at {step}");
                if step != 3 {
                    assert!((face - u[2]).abs() < 1e-5, "{face} at {step}");
                }
            }
        }
    }
}
