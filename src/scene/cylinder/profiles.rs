//! Velocity on the lines of Morris, Fox & Zhu (1997): above the middle of the cylinder, and halfway
//! between two cylinders.
//!
//! Steady Navier-Stokes by finite elements (Q2-Q1, isoparametric, 96 x 30 elements; the mean velocity
//! is converged to a part in 10^6), for the parameters of Morris et al.: L = 0.1 m, a = 0.02 m, from
//! rows of `01_morris_re0.03_profiles.csv` and `01_morris_re1_profiles.csv`.

/// Velocity at a point, of which the origin is the middle of the cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Along the flow, m.
    pub x: f64,
    /// Across it, m.
    pub y: f64,
    /// Velocity, m/s.
    pub velocity: [f64; 2],
}

/// At nu = 1e-4 m^2/s, f = 5e-5 m/s^2.
pub const RE_0_03: [Station; 25] = [
    Station { x: 0.0, y: 0.022490234, velocity: [8.78171469e-05, 3.82503993e-08] },
    Station { x: 0.0, y: 0.024958885, velocity: [1.54075858e-04, 1.10178502e-07] },
    Station { x: 0.0, y: 0.027316627, velocity: [2.04146869e-04, 1.78317709e-07] },
    Station { x: 0.0, y: 0.029922334, velocity: [2.48553871e-04, 2.36977015e-07] },
    Station { x: 0.0, y: 0.032301909, velocity: [2.81368818e-04, 2.69718533e-07] },
    Station { x: 0.0, y: 0.034888278, velocity: [3.10302928e-04, 2.81565655e-07] },
    Station { x: 0.0, y: 0.037699414, velocity: [3.35106463e-04, 2.68181596e-07] },
    Station { x: 0.0, y: 0.040123224, velocity: [3.51678777e-04, 2.37543202e-07] },
    Station { x: 0.0, y: 0.04271413, velocity: [3.64977989e-04, 1.88909302e-07] },
    Station { x: 0.0, y: 0.044773866, velocity: [3.72527198e-04, 1.41220896e-07] },
    Station { x: 0.0, y: 0.047685383, velocity: [3.78871127e-04, 6.47137857e-08] },
    Station { x: 0.0, y: 0.05, velocity: [3.80407259e-04, 0.0] },
    Station { x: 0.05, y: 0.0, velocity: [5.63702210e-05, 0.0] },
    Station { x: 0.05, y: 0.0049245702, velocity: [6.16719512e-05, -8.05664056e-08] },
    Station { x: 0.05, y: 0.0082550334, velocity: [7.10376137e-05, -1.35374218e-07] },
    Station { x: 0.05, y: 0.011658365, velocity: [8.49250028e-05, -1.90858686e-07] },
    Station { x: 0.05, y: 0.016972713, velocity: [1.13654444e-04, -2.71273156e-07] },
    Station { x: 0.05, y: 0.020710678, velocity: [1.37377800e-04, -3.17164199e-07] },
    Station { x: 0.05, y: 0.024657271, velocity: [1.63840704e-04, -3.49310385e-07] },
    Station { x: 0.05, y: 0.028867513, velocity: [1.91810308e-04, -3.58855963e-07] },
    Station { x: 0.05, y: 0.033408932, velocity: [2.19498095e-04, -3.35715099e-07] },
    Station { x: 0.05, y: 0.038366349, velocity: [2.44372972e-04, -2.70158916e-07] },
    Station { x: 0.05, y: 0.04103394, velocity: [2.54655152e-04, -2.19577343e-07] },
    Station { x: 0.05, y: 0.04683011, velocity: [2.68321113e-04, -8.29890501e-08] },
    Station { x: 0.05, y: 0.05, velocity: [2.70392337e-04, 0.0] },
];

/// At nu = 1e-6 m^2/s, f = 1.5e-7 m/s^2.
pub const RE_1: [Station; 25] = [
    Station { x: 0.0, y: 0.022490234, velocity: [2.63862168e-05, 3.26391392e-07] },
    Station { x: 0.0, y: 0.024958885, velocity: [4.62386770e-05, 9.36596752e-07] },
    Station { x: 0.0, y: 0.027316627, velocity: [6.11801525e-05, 1.51010736e-06] },
    Station { x: 0.0, y: 0.029922334, velocity: [7.43541786e-05, 1.99826038e-06] },
    Station { x: 0.0, y: 0.032301909, velocity: [8.40172260e-05, 2.26542317e-06] },
    Station { x: 0.0, y: 0.034888278, velocity: [9.24662581e-05, 2.35517899e-06] },
    Station { x: 0.0, y: 0.037699414, velocity: [9.96403637e-05, 2.23397233e-06] },
    Station { x: 0.0, y: 0.040123224, velocity: [1.04390686e-04, 1.97260175e-06] },
    Station { x: 0.0, y: 0.04271413, velocity: [1.08174041e-04, 1.56446901e-06] },
    Station { x: 0.0, y: 0.044773866, velocity: [1.10309123e-04, 1.16761374e-06] },
    Station { x: 0.0, y: 0.047685383, velocity: [1.12095834e-04, 5.34285513e-07] },
    Station { x: 0.0, y: 0.05, velocity: [1.12527400e-04, 0.0] },
    Station { x: 0.05, y: 0.0, velocity: [1.55261474e-05, 0.0] },
    Station { x: 0.05, y: 0.0049245702, velocity: [1.71286423e-05, -6.54766169e-07] },
    Station { x: 0.05, y: 0.0082550334, velocity: [1.99650794e-05, -1.10003255e-06] },
    Station { x: 0.05, y: 0.011658365, velocity: [2.41841320e-05, -1.55039920e-06] },
    Station { x: 0.05, y: 0.016972713, velocity: [3.29630061e-05, -2.20137888e-06] },
    Station { x: 0.05, y: 0.020710678, velocity: [4.02650174e-05, -2.57075163e-06] },
    Station { x: 0.05, y: 0.024657271, velocity: [4.84680893e-05, -2.82663424e-06] },
    Station { x: 0.05, y: 0.028867513, velocity: [5.72061674e-05, -2.89771529e-06] },
    Station { x: 0.05, y: 0.033408932, velocity: [6.59267118e-05, -2.70417079e-06] },
    Station { x: 0.05, y: 0.038366349, velocity: [7.38223964e-05, -2.17054284e-06] },
    Station { x: 0.05, y: 0.04103394, velocity: [7.71028988e-05, -1.76220069e-06] },
    Station { x: 0.05, y: 0.04683011, velocity: [8.14790967e-05, -6.64924427e-07] },
    Station { x: 0.05, y: 0.05, velocity: [8.21452229e-05, 0.0] },
];
