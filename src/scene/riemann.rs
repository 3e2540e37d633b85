//! Exact solution of the Riemann problem of an ideal gas (Toro 1999, chapter 4).

use super::report::Report;

/// State of a gas that moves along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Density, kg/m^3.
    pub density: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Pressure, Pa.
    pub pressure: f64,
}

impl Gas {
    fn sound_speed(&self, heat_ratio: f64) -> f64 {
        (heat_ratio * self.pressure / self.density).sqrt()
    }

    /// Change of velocity through the wave that leads to `pressure`, and its derivative: a shock if
    /// pressure rises, a rarefaction if it falls (eqs. 4.6, 4.7 and 4.37).
    fn wave(&self, pressure: f64, heat_ratio: f64) -> (f64, f64) {
        let (g, p, sound) = (heat_ratio, self.pressure, self.sound_speed(heat_ratio));
        if pressure > p {
            let a = 2.0 / ((g + 1.0) * self.density);
            let b = (g - 1.0) / (g + 1.0) * p;
            let root = (a / (pressure + b)).sqrt();
            ((pressure - p) * root, root * (1.0 - 0.5 * (pressure - p) / (b + pressure)))
        } else {
            let ratio = pressure / p;
            let change = 2.0 * sound / (g - 1.0) * (ratio.powf(0.5 * (g - 1.0) / g) - 1.0);
            (change, ratio.powf(-0.5 * (g + 1.0) / g) / (self.density * sound))
        }
    }

    /// The state behind the wave that leads to `pressure` and `velocity` (eqs. 4.50 and 4.53).
    fn behind(&self, pressure: f64, velocity: f64, heat_ratio: f64) -> Self {
        let (g, ratio) = (heat_ratio, pressure / self.pressure);
        let k = (g - 1.0) / (g + 1.0);
        let change =
            if ratio > 1.0 { (ratio + k) / (k * ratio + 1.0) } else { ratio.powf(1.0 / g) };
        Self { density: self.density * change, velocity, pressure }
    }
}

/// A tube of gas that a diaphragm at x = 0 parts until t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Riemann {
    /// Ratio of the specific heats.
    pub heat_ratio: f64,
    /// Gas at x < 0.
    pub left: Gas,
    /// Gas at x > 0.
    pub right: Gas,
}

impl Riemann {
    /// Pressure and velocity between the waves, by Newton's method; no vacuum may form.
    pub fn star(&self) -> (f64, f64) {
        let (left, right, g) = (self.left, self.right, self.heat_ratio);
        let mut pressure = 0.5 * (left.pressure + right.pressure);
        for _ in 0..100 {
            let (l, dl) = left.wave(pressure, g);
            let (r, dr) = right.wave(pressure, g);
            let step = (l + r + right.velocity - left.velocity) / (dl + dr);
            let next = (pressure - step).max(1e-3 * pressure);
            let is_close = (next / pressure - 1.0).abs() < 1e-15;
            pressure = next;
            if is_close {
                break;
            }
        }
        let change = right.wave(pressure, g).0 - left.wave(pressure, g).0;
        (pressure, 0.5 * (left.velocity + right.velocity + change))
    }

    /// The gas at `x / t`.
    pub fn at(&self, x_over_t: f64) -> Gas {
        let (pressure, velocity) = self.star();
        if x_over_t < velocity {
            return self.side(self.left, x_over_t, pressure, velocity);
        }
        // The right side is the left one in a mirror.
        let mirror = |gas: Gas| Gas { velocity: -gas.velocity, ..gas };
        mirror(self.side(mirror(self.right), -x_over_t, pressure, -velocity))
    }

    /// The gas at `x` from the diaphragm, m, at a time, s, 0 too.
    pub fn around(&self, x: f64, time: f64) -> Gas {
        if time > 0.0 {
            self.at(x / time)
        } else if x < 0.0 {
            self.left
        } else {
            self.right
        }
    }

    /// Judges a gas: a length that it stands for, what it is and what it should be. `density_l1`, `velocity_l1`
    /// and `pressure_l1`: the integral of the error over that of what should be.
    pub fn judge(&self, report: &mut Report, gas: impl Iterator<Item = (f64, Gas, Gas)>) {
        let mut l1 = [[0.0; 2]; 3];
        for (length, gas, exact) in gas {
            let pairs = [
                (gas.density, exact.density),
                (gas.velocity, exact.velocity),
                (gas.pressure, exact.pressure),
            ];
            for (sums, (value, exact)) in l1.iter_mut().zip(pairs) {
                sums[0] += (value - exact).abs() * length;
                sums[1] += exact.abs() * length;
            }
        }
        for (name, [error, norm]) in
            ["density_l1", "velocity_l1", "pressure_l1"].into_iter().zip(l1)
        {
            report.error(name, error / norm);
        }
    }

    /// The gas left of the contact.
    fn side(&self, gas: Gas, x_over_t: f64, pressure: f64, velocity: f64) -> Gas {
        let (g, sound) = (self.heat_ratio, gas.sound_speed(self.heat_ratio));
        let behind = gas.behind(pressure, velocity, g);
        if pressure > gas.pressure {
            let ratio = pressure / gas.pressure;
            let mach = ((g + 1.0) / (2.0 * g) * ratio + (g - 1.0) / (2.0 * g)).sqrt();
            return if x_over_t < gas.velocity - sound * mach { gas } else { behind };
        }
        let head = gas.velocity - sound;
        let tail = velocity - behind.sound_speed(g);
        if x_over_t < head {
            gas
        } else if x_over_t > tail {
            behind
        } else {
            // Inside the rarefaction (eq. 4.56).
            let fan = 2.0 / (g + 1.0) + (g - 1.0) / ((g + 1.0) * sound) * (gas.velocity - x_over_t);
            Gas {
                density: gas.density * fan.powf(2.0 / (g - 1.0)),
                velocity: 2.0 / (g + 1.0) * (sound + 0.5 * (g - 1.0) * gas.velocity + x_over_t),
                pressure: gas.pressure * fan.powf(2.0 * g / (g - 1.0)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gas(density: f64, velocity: f64, pressure: f64) -> Gas {
        Gas { density, velocity, pressure }
    }

    /// Toro (1999), table 4.2, with more digits from an independent solver.
    #[test]
    fn star_states() {
        let sod =
            Riemann { heat_ratio: 1.4, left: gas(1.0, 0.0, 1.0), right: gas(0.125, 0.0, 0.1) };
        let (p, u) = sod.star();
        assert!((p - 0.3031301781).abs() < 1e-9 && (u - 0.92745262).abs() < 1e-8, "{p} {u}");
        let apart =
            Riemann { heat_ratio: 1.4, left: gas(1.0, -2.0, 0.4), right: gas(1.0, 2.0, 0.4) };
        let (p, u) = apart.star();
        assert!((p - 0.00189387342).abs() < 1e-10 && u.abs() < 1e-10, "{p} {u}");
        let blast =
            Riemann { heat_ratio: 1.4, left: gas(1.0, 0.0, 1000.0), right: gas(1.0, 0.0, 0.01) };
        let (p, u) = blast.star();
        assert!((p - 460.894).abs() < 1e-3 && (u - 19.5975).abs() < 1e-4, "{p} {u}");
    }

    #[test]
    fn a_mirrored_tube_has_a_mirrored_solution() {
        let tube =
            Riemann { heat_ratio: 1.4, left: gas(1.0, 0.3, 1.0), right: gas(0.125, 0.1, 0.1) };
        let mirror = |g: Gas| Gas { velocity: -g.velocity, ..g };
        let mirrored =
            Riemann { heat_ratio: 1.4, left: mirror(tube.right), right: mirror(tube.left) };
        for k in -40..40 {
            let x_over_t = 0.0501 * f64::from(k);
            let (a, b) = (tube.at(x_over_t), mirror(mirrored.at(-x_over_t)));
            assert!((a.density - b.density).abs() + (a.velocity - b.velocity).abs() < 1e-12);
        }
    }
}
