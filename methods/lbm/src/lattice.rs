//! Lattices: sets of velocities with weights (Qian, d'Humieres & Lallemand 1992).
//!
//! A lattice is defined by its dimensions, the longest of its velocities and a weight for each
//! length; everything else follows. Velocities are in units of one spacing a time step, and the
//! squared speed of sound is 1/3 on all of them.

/// A lattice of `Q` velocities, known when a kernel is compiled.
///
/// Velocity 0 is rest; after it come pairs of opposite velocities, `2 n - 1` and `2 n`.
pub trait Lattice<const Q: usize>: Copy + Send + Sync + 'static {
    /// Its usual name.
    const NAME: &'static str;
    /// Directions of space.
    const DIMS: usize;
    /// The velocities, with zeros in directions that the lattice does not have.
    const VELOCITIES: [[i32; 3]; Q];
    /// The weights of the equilibrium at rest.
    const WEIGHTS: [f64; Q];
}

/// Squared speed of sound.
pub const SOUND_SPEED_SQUARED: f64 = 1.0 / 3.0;

/// Number of the velocity opposite to `q`.
#[inline(always)]
pub const fn opposite(q: usize) -> usize {
    match q {
        0 => 0,
        _ if q % 2 == 1 => q + 1,
        _ => q - 1,
    }
}

/// Weight of the velocities of a squared length; 0 if there are none.
pub(crate) const fn weight<L: Lattice<Q>, const Q: usize>(squared: i32) -> f64 {
    let mut q = 0;
    while q < Q {
        if square(L::VELOCITIES[q]) == squared {
            return L::WEIGHTS[q];
        }
        q += 1;
    }
    0.0
}

macro_rules! lattice {
    ($(#[$doc:meta])* $name:ident, $q:literal, $dims:literal, $weights:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl Lattice<$q> for $name {
            const NAME: &'static str = stringify!($name);
            const DIMS: usize = $dims;
            const VELOCITIES: [[i32; 3]; $q] = velocities($dims, $weights.len() as i32 - 1);
            const WEIGHTS: [f64; $q] = weights(Self::VELOCITIES, &$weights);
        }
    };
}

// By the square of the velocity: 0, 1, 2, 3.
lattice!(
    /// Nine velocities in the plane.
    D2Q9, 9, 2, [4.0 / 9.0, 1.0 / 9.0, 1.0 / 36.0]
);
lattice!(
    /// Nineteen velocities in space: all but the corners of a cube.
    D3Q19, 19, 3, [1.0 / 3.0, 1.0 / 18.0, 1.0 / 36.0]
);
lattice!(
    /// Twenty-seven velocities in space.
    D3Q27, 27, 3, [8.0 / 27.0, 2.0 / 27.0, 1.0 / 54.0, 1.0 / 216.0]
);

/// All velocities with components -1, 0 and 1 and a square of at most `most`, in pairs.
const fn velocities<const Q: usize>(dims: usize, most: i32) -> [[i32; 3]; Q] {
    let mut all = [[0; 3]; Q];
    let mut count = 1;
    // Those that come after rest when x runs slowest, so that none of them goes back in x; their opposites
    // come before it.
    let mut code = 14;
    while code < 27 {
        let c = [code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1];
        if square(c) <= most && (dims == 3 || c[2] == 0) {
            all[count] = c;
            all[count + 1] = [-c[0], -c[1], -c[2]];
            count += 2;
        }
        code += 1;
    }
    assert!(count == Q);
    all
}

const fn weights<const Q: usize>(velocities: [[i32; 3]; Q], by_square: &[f64]) -> [f64; Q] {
    let mut all = [0.0; Q];
    let mut q = 0;
    while q < Q {
        all[q] = by_square[square(velocities[q]) as usize];
        q += 1;
    }
    all
}

/// Squared length.
pub(crate) const fn square(c: [i32; 3]) -> i32 {
    c[0] * c[0] + c[1] * c[1] + c[2] * c[2]
}

/// Choice of a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LatticeKind {
    /// [`D2Q9`].
    D2Q9,
    /// [`D3Q19`].
    D3Q19,
    /// [`D3Q27`].
    D3Q27,
}

impl LatticeKind {
    /// Its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Self::D2Q9 => D2Q9::NAME,
            Self::D3Q19 => D3Q19::NAME,
            Self::D3Q27 => D3Q27::NAME,
        }
    }

    /// Directions of space.
    pub fn dims(self) -> usize {
        match self {
            Self::D2Q9 => 2,
            Self::D3Q19 | Self::D3Q27 => 3,
        }
    }

    /// The velocities.
    pub fn velocities(self) -> &'static [[i32; 3]] {
        match self {
            Self::D2Q9 => &const { D2Q9::VELOCITIES },
            Self::D3Q19 => &const { D3Q19::VELOCITIES },
            Self::D3Q27 => &const { D3Q27::VELOCITIES },
        }
    }

    /// The weights.
    pub fn weights(self) -> &'static [f64] {
        match self {
            Self::D2Q9 => &const { D2Q9::WEIGHTS },
            Self::D3Q19 => &const { D3Q19::WEIGHTS },
            Self::D3Q27 => &const { D3Q27::WEIGHTS },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [LatticeKind; 3] = [LatticeKind::D2Q9, LatticeKind::D3Q19, LatticeKind::D3Q27];

    /// Sum of `w c_a c_b ...` over the velocities.
    fn moment(lattice: LatticeKind, directions: &[usize]) -> f64 {
        let product = |c: &[i32; 3]| directions.iter().map(|&a| f64::from(c[a])).product::<f64>();
        lattice.velocities().iter().zip(lattice.weights()).map(|(c, w)| w * product(c)).sum()
    }

    #[test]
    fn velocities_are_distinct_and_paired() {
        for lattice in ALL {
            let velocities = lattice.velocities();
            for (q, c) in velocities.iter().enumerate() {
                assert_eq!(opposite(opposite(q)), q);
                assert_eq!(velocities[opposite(q)], c.map(|c| -c));
                assert_eq!(lattice.weights()[opposite(q)], lattice.weights()[q]);
                assert!(velocities[..q].iter().all(|other| other != c));
                assert!(lattice.dims() == 3 || c[2] == 0);
            }
        }
    }

    /// Up to fourth order the moments are those of an isotropic Gaussian of variance 1/3: what the
    /// Navier-Stokes equations ask for.
    #[test]
    fn moments_are_isotropic_up_to_fourth_order() {
        let delta = |a: usize, b: usize| f64::from(u8::from(a == b));
        let is = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-15);
        for lattice in ALL {
            let dims = lattice.dims();
            is(moment(lattice, &[]), 1.0);
            for a in 0..dims {
                is(moment(lattice, &[a]), 0.0);
                for b in 0..dims {
                    is(moment(lattice, &[a, b]), SOUND_SPEED_SQUARED * delta(a, b));
                    for c in 0..dims {
                        is(moment(lattice, &[a, b, c]), 0.0);
                        for d in 0..dims {
                            let pairs = delta(a, b) * delta(c, d)
                                + delta(a, c) * delta(b, d)
                                + delta(a, d) * delta(b, c);
                            let expected = SOUND_SPEED_SQUARED.powi(2) * pairs;
                            is(moment(lattice, &[a, b, c, d]), expected);
                        }
                    }
                }
            }
        }
    }
}
