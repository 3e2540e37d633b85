//! Implosion of Noh (1987): cold gas of density 1 streams with speed 1 towards the origin, where it
//! stops. A shock of speed (gamma - 1) / 2 runs outwards through gas that gets denser as it comes
//! nearer; gamma = 5/3. Infinitely strong, it shows what wall heating and noise a method makes.

use super::parameter::{Parameter, Parameters};

/// Ratio of the specific heats.
pub const HEAT_RATIO: f64 = 5.0 / 3.0;
/// Pressure at the start instead of 0.
pub const PRESSURE: f64 = 1e-6;
/// When it is looked at, s.
pub const TIME: f64 = 0.6;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::integer("dim", 1, [1, 2], "dimensions"),
    Parameter::integer("resolution", 200, [20, 20_000], "points along a metre at the start"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noh {
    /// Dimensions.
    pub dims: usize,
    /// Points along a metre.
    pub resolution: f64,
}

impl Noh {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            resolution: parameters.number("resolution"),
        }
    }

    /// How far the shock is from the origin, m.
    pub fn shock(&self, time: f64) -> f64 {
        0.5 * (HEAT_RATIO - 1.0) * time
    }

    /// Density behind the shock: 4 in 1-D, 16 in 2-D.
    pub fn shocked_density(&self) -> f64 {
        ((HEAT_RATIO + 1.0) / (HEAT_RATIO - 1.0)).powi(self.dims as i32)
    }

    /// Density at the distance `r`, m, from the origin.
    pub fn density(&self, r: f64, time: f64) -> f64 {
        if r < self.shock(time) {
            self.shocked_density()
        } else {
            (1.0 + time / r).powi(self.dims as i32 - 1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_reference_profile() {
        let table = include_str!("../../tests/references/noh.csv");
        for (dims, name) in [(1, "planar,"), (2, "cylindrical,")] {
            let scene = Noh { dims, resolution: 200.0 };
            let mut rows = 0;
            for row in table.lines().filter_map(|line| line.strip_prefix(name)) {
                let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
                // The shock is at one of the distances: it has two densities there.
                if (numbers[0] - scene.shock(TIME)).abs() > 1e-9 {
                    let density = scene.density(numbers[0], TIME);
                    assert!((density / numbers[1] - 1.0).abs() < 1e-8, "{density} at {row}");
                    rows += 1;
                }
            }
            assert!(rows > 20, "{name} {rows}");
        }
    }
}
