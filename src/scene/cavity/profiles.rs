//! Velocities on the two lines through the middle of the cavity, where coordinates lie in [0.05, 0.95]:
//! nearer to the lid its corners, where the velocity jumps, decide how fast anything converges.
//!
//! Re = 100: streamfunction by finite differences on up to 256 x 256 points, extrapolated, to about
//! 1e-5 (`04_cavity_check.csv`). Re = 1000: Chebyshev methods, Botella & Peyret (1998), Comput. Fluids
//! 27, tables 9 and 10, and stations that an independent spectral solution adds
//! (`04_cavity_re1000_spectral.csv`).

/// Coordinate and velocity.
pub type Station = (f64, f64);

/// u on x = 1/2, and v on y = 1/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profiles {
    /// Height and velocity along x.
    pub upright: &'static [Station],
    /// Position along x and velocity along y.
    pub across: &'static [Station],
}

/// At Re = 100.
pub const RE_100: Profiles = Profiles {
    upright: &[
        (0.0546875, -0.03722),
        (0.0625, -0.041975),
        (0.0703125, -0.046627),
        (0.1015625, -0.064411),
        (0.171875, -0.10173),
        (0.28125, -0.157649),
        (0.453125, -0.213978),
        (0.5, -0.209149),
        (0.6171875, -0.138809),
        (0.734375, 0.004151),
        (0.8515625, 0.236445),
    ],
    across: &[
        (0.0625, 0.094808),
        (0.0703125, 0.103599),
        (0.078125, 0.111778),
        (0.09375, 0.126385),
        (0.15625, 0.164805),
        (0.2265625, 0.179356),
        (0.234375, 0.17956),
        (0.5, 0.057537),
        (0.8046875, -0.253542),
        (0.859375, -0.233713),
        (0.90625, -0.177159),
        (0.9453125, -0.10851),
    ],
};

/// At Re = 1000.
pub const RE_1000: Profiles = Profiles {
    upright: &[
        (0.0546875, -0.1812881),
        (0.0625, -0.20233),
        (0.0703125, -0.2228955),
        (0.1015625, -0.3004561),
        (0.171875, -0.388569),
        (0.28125, -0.2803696),
        (0.453125, -0.1081999),
        (0.5, -0.0620561),
        (0.6171875, 0.0570178),
        (0.734375, 0.1886747),
        (0.8515625, 0.3372212),
    ],
    across: &[
        (0.0625, 0.2807056),
        (0.0703125, 0.2962703),
        (0.078125, 0.3099097),
        (0.09375, 0.3330442),
        (0.15625, 0.3769189),
        (0.2265625, 0.3339924),
        (0.234375, 0.3253592),
        (0.35, 0.1882246),
        (0.5, 0.0257995),
        (0.68, -0.1730887),
        (0.8046875, -0.3202137),
        (0.859375, -0.4264545),
        (0.90625, -0.5264392),
        (0.9453125, -0.4103754),
    ],
};
