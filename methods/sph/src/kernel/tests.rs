use std::f64::consts::PI;

use approx::assert_relative_eq;

use super::{Kernel, SmoothingFunction};
use crate::dimension::Dimension::{self, One, Three, Two};
use crate::packing::Packing;
use SmoothingFunction::{
    CubicSpline, Gaussian, QuarticSpline, QuinticSpline, WendlandC2, WendlandC4, WendlandC6,
};

const FUNCTIONS: [SmoothingFunction; 7] =
    [Gaussian, CubicSpline, QuarticSpline, QuinticSpline, WendlandC2, WendlandC4, WendlandC6];
const DIMENSIONS: [Dimension; 3] = [One, Two, Three];

/// Every kernel in every dimension, with a smoothing length other than one.
fn kernels() -> impl Iterator<Item = (SmoothingFunction, Dimension, Kernel<f64>)> {
    FUNCTIONS.into_iter().flat_map(|function| {
        DIMENSIONS.map(|dimension| (function, dimension, Kernel::new(function, dimension, 0.3)))
    })
}

/// Squared distances from 0 to beyond the support, no multiple of a lane width in number, and a
/// padding lane.
fn distances_squared(kernel: &Kernel<f64>) -> Vec<f64> {
    let radius = kernel.support_radius();
    (0..=1000)
        .map(|i| (1.1 * radius * f64::from(i) / 1000.0).powi(2))
        .chain([f64::INFINITY])
        .collect()
}

/// Integral of W over all space, in spherical shells, by Simpson's rule.
fn integral(kernel: &Kernel<f64>, function: SmoothingFunction, dimension: Dimension) -> f64 {
    const INTERVALS: u32 = 6000; // The knots of the splines, at multiples of 1/2, are nodes.
    let h = kernel.smoothing_length();
    let shell = |q: f64| match dimension {
        One => 2.0 * h,
        Two => 2.0 * PI * q * h.powi(2),
        Three => 4.0 * PI * q.powi(2) * h.powi(3),
    };
    // The Gaussian drops to zero at the support: integrate up to, not across, the edge.
    let edge = function.support() * (1.0 - f64::EPSILON);
    let step = edge / f64::from(INTERVALS);
    (0..=INTERVALS)
        .map(|i| {
            let weight = match i {
                0 | INTERVALS => 1.0,
                i if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let q = step * f64::from(i);
            weight * kernel.w(q.min(edge)) * shell(q) * step / 3.0
        })
        .sum()
}

#[test]
fn integral_over_space_is_one() {
    const ERF_3: f64 = 0.999_977_909_503_001_4;
    for (function, dimension, kernel) in kernels() {
        let missing = match (function, dimension) {
            (Gaussian, One) => 1.0 - ERF_3,
            (Gaussian, Two) => (-9.0_f64).exp(),
            (Gaussian, Three) => 1.0 - ERF_3 + 6.0 * (-9.0_f64).exp() / PI.sqrt(),
            _ => 0.0,
        };
        assert_relative_eq!(integral(&kernel, function, dimension), 1.0 - missing, epsilon = 1e-11);
    }
}

#[test]
fn gaussian_is_the_papers_equation_7() {
    let h = 2e-4;
    for (dimension, alpha) in [
        (One, 1.0 / (PI.powf(0.5) * h)),
        (Two, 1.0 / (PI * h.powi(2))),
        (Three, 1.0 / (PI.powf(1.5) * h.powi(3))),
    ] {
        let kernel = Kernel::new(Gaussian, dimension, h);
        assert_eq!(kernel.support_radius(), 3.0 * h);
        assert_relative_eq!(kernel.w(1.3), alpha * f64::exp(-1.3 * 1.3), max_relative = 1e-14);
    }
}

#[test]
fn slope_is_the_derivative() {
    const STEP: f64 = 1e-5;
    for (function, _, kernel) in kernels() {
        for i in 1..400 {
            let q = f64::from(i) * 0.01 + 0.001;
            if (q - function.support()).abs() < 2.0 * STEP {
                continue;
            }
            let difference = (kernel.w(q + STEP) - kernel.w(q - STEP)) / (2.0 * STEP);
            assert_relative_eq!(
                kernel.dw_dq(q),
                difference,
                epsilon = 1e-8 * kernel.w(0.0),
                max_relative = 1e-8
            );
        }
    }
}

#[test]
fn profile_falls_steadily_and_smoothly_to_the_edge() {
    const STEP: f64 = 1e-3;
    for (function, _, kernel) in kernels() {
        assert_eq!(kernel.dw_dq(0.0), 0.0);
        let top = kernel.w(0.0);
        let mut q = 0.0;
        while q + STEP < function.support() {
            let (here, next) = (kernel.w(q), kernel.w(q + STEP));
            assert!(next < here && next > 0.0, "{function:?} at {q}");
            assert!(here - next < 2.0 * STEP * top, "{function:?} at {q}");
            let (here, next) = (kernel.dw_dq(q), kernel.dw_dq(q + STEP));
            assert!((here - next).abs() < 6.0 * STEP * top, "{function:?} at {q}");
            q += STEP;
        }
        let edge = function.support();
        assert_eq!((kernel.w(edge), kernel.dw_dq(edge)), (0.0, 0.0));
        // Only the Gaussian is cut off above zero.
        let drop = kernel.w(edge - 1e-9) / top;
        assert!(drop < if function == Gaussian { 1.3e-4 } else { 1e-15 });
    }
}

#[test]
fn lanes_equal_the_definition() {
    for (function, _, kernel) in kernels() {
        let h = kernel.smoothing_length();
        let distance_squared = distances_squared(&kernel);
        let mut w = vec![f64::NAN; distance_squared.len()];
        let mut gradient_factor = w.clone();
        kernel.evaluate(&distance_squared, &mut w, &mut gradient_factor);
        for (lane, r2) in distance_squared.iter().enumerate() {
            let q = r2.sqrt() / h;
            if q < function.support() {
                let tolerance = 1e-14 * kernel.w(0.0);
                let slope = gradient_factor[lane] * q * h * h;
                assert_relative_eq!(w[lane], kernel.w(q), epsilon = tolerance);
                assert_relative_eq!(slope, kernel.dw_dq(q), epsilon = tolerance);
            } else {
                assert_eq!((w[lane], gradient_factor[lane]), (0.0, 0.0));
            }
        }

        let mut alone = vec![f64::NAN; distance_squared.len()];
        kernel.gradient_factor(&distance_squared, &mut alone);
        assert_eq!(alone, gradient_factor);
    }
}

#[test]
fn gradient_factor_has_its_limit_at_no_distance() {
    for (function, _, kernel) in kernels() {
        let h = kernel.smoothing_length();
        let mut factor = [f64::NAN; 2];
        kernel.gradient_factor(&[0.0, (1e-6 * h).powi(2)], &mut factor);
        assert!(factor[0].is_finite() && factor[0] < 0.0, "{function:?}");
        assert_relative_eq!(factor[0], factor[1], max_relative = 1e-5);
        // F(0) is the second derivative at the centre, over h^2.
        let curvature = kernel.dw_dq(1e-6) / 1e-6;
        assert_relative_eq!(factor[0] * h * h, curvature, max_relative = 1e-5);
    }
}

/// [`Kernel::evaluate`] as a task for [`pulp::Arch::dispatch`].
struct Evaluation<'a> {
    kernel: Kernel<f64>,
    distance_squared: &'a [f64],
    w: &'a mut [f64],
    gradient_factor: &'a mut [f64],
}

impl pulp::WithSimd for Evaluation<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.kernel.evaluate(self.distance_squared, self.w, self.gradient_factor);
    }
}

#[test]
fn lanes_have_the_same_bits_in_every_instruction_set() {
    for (function, _, kernel) in kernels() {
        let distance_squared = distances_squared(&kernel);
        let zeros = vec![0.0; distance_squared.len()];
        let (mut w, mut factor) = (zeros.clone(), zeros.clone());
        kernel.evaluate(&distance_squared, &mut w, &mut factor);
        let (mut w_widest, mut factor_widest) = (zeros.clone(), zeros);
        pulp::Arch::new().dispatch(Evaluation {
            kernel,
            distance_squared: &distance_squared,
            w: &mut w_widest,
            gradient_factor: &mut factor_widest,
        });
        assert_eq!(w, w_widest, "{function:?}");
        assert_eq!(factor, factor_widest, "{function:?}");
    }
}

/// On a lattice the sums over neighbours reproduce a constant, `sum V W = 1`, the gradient of a
/// linear field and the Laplacian of a quadratic one, both `- sum V F x_a x_b = delta_ab`
/// (Brookshaw 1985 for the Laplacian).
#[test]
fn sums_over_a_lattice_are_consistent() {
    let spacing = 0.1;
    for packing in
        [Packing::Square, Packing::Hexagonal, Packing::Cubic, Packing::HexagonalClosePacked]
    {
        let lattice = packing.fit([1.0; 3], spacing).unwrap();
        let lengths = lattice.lengths();
        let volume = lattice.volume_per_particle();
        let here = lattice.positions().next().unwrap();
        // To the nearest image of each particle: the box is wider than two supports.
        let offsets: Vec<[f64; 3]> = lattice
            .positions()
            .map(|there| {
                [0, 1, 2].map(|k| {
                    let x = here[k] - there[k];
                    if lengths[k] > 0.0 { x - lengths[k] * (x / lengths[k]).round() } else { x }
                })
            })
            .collect();
        let distance_squared: Vec<f64> =
            offsets.iter().map(|x| x.iter().map(|c| c * c).sum()).collect();
        for function in FUNCTIONS {
            let dimension = packing.dimension();
            // Narrower functions need a longer smoothing length for as many neighbours.
            let h = match function {
                WendlandC4 => 0.19,
                WendlandC6 => 0.22,
                _ => 0.16,
            };
            let kernel = Kernel::new(function, dimension, h);
            let mut w = vec![0.0; offsets.len()];
            let mut factor = w.clone();
            kernel.evaluate(&distance_squared, &mut w, &mut factor);
            assert_relative_eq!(volume * w.iter().sum::<f64>(), 1.0, epsilon = 0.008);
            for a in 0..dimension.number() {
                for b in 0..dimension.number() {
                    let terms = offsets.iter().zip(&factor);
                    let moment: f64 = terms.map(|(x, f)| -volume * f * x[a] * x[b]).sum();
                    let exact = if a == b { 1.0 } else { 0.0 };
                    assert_relative_eq!(moment, exact, epsilon = 0.008);
                }
            }
        }
    }
}

#[test]
fn single_precision_agrees_with_double() {
    for (function, dimension, kernel) in kernels() {
        let single = Kernel::new(function, dimension, kernel.smoothing_length() as f32);
        let distance_squared = distances_squared(&kernel);
        let rounded: Vec<f32> = distance_squared.iter().map(|r2| *r2 as f32).collect();
        let lanes = distance_squared.len();
        let (mut w, mut factor) = (vec![0.0; lanes], vec![0.0; lanes]);
        let (mut w_single, mut factor_single) = (vec![0.0; lanes], vec![0.0; lanes]);
        kernel.evaluate(&distance_squared, &mut w, &mut factor);
        single.evaluate(&rounded, &mut w_single, &mut factor_single);
        let cut = f64::from(Kernel::<f32>::cut()) * kernel.support_radius();
        for lane in 0..lanes {
            let distance = distance_squared[lane].sqrt();
            if distance >= cut && distance < kernel.support_radius() {
                assert_eq!((w_single[lane], factor_single[lane]), (0.0, 0.0));
                continue;
            }
            let w_error = (f64::from(w_single[lane]) - w[lane]).abs() / w[0].abs();
            let factor_error =
                (f64::from(factor_single[lane]) - factor[lane]).abs() / factor[0].abs();
            assert!(w_error < 2e-6, "{function:?}: W is off by {w_error:e}");
            assert!(factor_error < 2e-6, "{function:?}: F is off by {factor_error:e}");
        }
    }
}

#[test]
fn pairs_on_the_edge_do_not_interact() {
    assert!(Kernel::<f64>::cut() > 0.999_98 && Kernel::<f32>::cut() > 0.999_5);
    for (_, _, kernel) in kernels() {
        let cut = Kernel::<f64>::cut() * kernel.support_radius();
        let squared = [1.0 - 1e-12, 1.0 + 1e-12].map(|share| (share * cut).powi(2));
        let (mut w, mut factor) = ([f64::NAN; 2], [f64::NAN; 2]);
        kernel.evaluate(&squared, &mut w, &mut factor);
        assert!(w[0] > 0.0 && factor[0] < 0.0);
        assert_eq!((w[1], factor[1]), (0.0, 0.0));
    }
}

#[test]
fn not_a_number_is_not_hidden() {
    for (function, _, kernel) in kernels() {
        let (mut w, mut factor) = ([0.0], [0.0]);
        kernel.evaluate(&[f64::NAN], &mut w, &mut factor);
        assert!(w[0].is_nan() && factor[0].is_nan(), "{function:?}");
    }
}

#[test]
#[should_panic(expected = "smoothing length must be finite and above zero")]
fn smoothing_length_of_zero_is_refused() {
    Kernel::new(CubicSpline, Two, 0.0_f32);
}
