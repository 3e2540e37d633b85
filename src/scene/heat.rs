//! Heat that spreads in a box of side 1, from a wave that keeps its shape: in a periodic box a product
//! of `sin(2 pi x)`, between ends of temperature zero one of `sin(pi x)`, between insulated ends one of
//! `cos(pi x)`. Its amplitude falls as `exp(-kappa k^2 t)` exactly, k^2 being that of all directions.
//!
//! From a step instead: from the signs of these waves, products of Fourier series of which every term falls so (Carslaw
//! & Jaeger 1959, Conduction of Heat in Solids, chapter 3). Between driven ends, a wave of temperature that wanders
//! inwards along the diagonal s, `exp(-b s) cos(w t - b s)` with `b^2 = w / 2 kappa` (chapter 2, section 6).

use std::f64::consts::{PI, TAU};

use super::parameter::{Parameter, ParameterError, Parameters};
use super::report::Report;

/// Diffusivity, m^2/s.
pub const DIFFUSIVITY: f64 = 0.01;
/// When the temperature is looked at, s.
pub const TIME: f64 = 1.0;

/// Of the temperature of driven ends, rad/s: one turn in the time of the scene.
const FREQUENCY: f64 = TAU / TIME;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 4] = [
    Parameter::integer("dim", 2, [1, 3], "dimensions"),
    Parameter::integer("resolution", 32, [9, 4000], "points across the box"),
    Parameter::choice(
        "ends",
        &["periodic", "cold", "insulated", "driven"],
        "what is at the ends: the other one, temperature zero, nothing that heat could pass, or a temperature \
         that swings once in the time of the scene",
    ),
    Parameter::choice(
        "start",
        &["wave", "step"],
        "temperature at the beginning: a wave, or its sign, which between cold ends is 1 all over",
    ),
];

/// What is at the ends of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxEnds {
    /// The other end.
    Periodic,
    /// The value zero.
    Fixed,
    /// The slope zero.
    Free,
}

impl BoxEnds {
    /// The wave along one direction that keeps its shape.
    pub fn shape(self, x: f64) -> f64 {
        match self {
            Self::Periodic => (TAU * x).sin(),
            Self::Fixed => (PI * x).sin(),
            Self::Free => (PI * x).cos(),
        }
    }

    /// Its wave number, 1/m.
    pub fn wave_number(self) -> f64 {
        if self == Self::Periodic { TAU } else { PI }
    }
}

/// What is in the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heating {
    /// A wave that keeps its shape.
    Wave(BoxEnds),
    /// A step, that of the wave's sign.
    Step(BoxEnds),
    /// A wave from the ends.
    Driven,
}

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatBox {
    /// Dimensions.
    pub dims: usize,
    /// Points across.
    pub resolution: usize,
    /// What is in it.
    pub heating: Heating,
}

impl HeatBox {
    /// From the scene's parameters.
    ///
    /// # Errors
    /// If there is to be a step between driven ends.
    pub fn new(parameters: &Parameters) -> Result<Self, ParameterError> {
        let is_step = parameters.choice("start") == "step";
        let of = |ends| if is_step { Heating::Step(ends) } else { Heating::Wave(ends) };
        let heating = match parameters.choice("ends") {
            "driven" if is_step => {
                return Err(ParameterError::Invalid {
                    name: "start",
                    value: "step".to_owned(),
                    range: "wave with ends = driven".to_owned(),
                });
            }
            "driven" => Heating::Driven,
            "cold" => of(BoxEnds::Fixed),
            "insulated" => of(BoxEnds::Free),
            _ => of(BoxEnds::Periodic),
        };
        let [dims, resolution] = ["dim", "resolution"].map(|name| parameters.number(name) as usize);
        Ok(Self { dims, resolution, heating })
    }

    /// Temperature, K, at a point and time.
    pub fn temperature(&self, x: [f64; 3], time: f64) -> f64 {
        let x = &x[..self.dims];
        match self.heating {
            Heating::Wave(ends) => {
                x.iter().map(|&x| ends.shape(x)).product::<f64>() * self.amplitude(ends, time)
            }
            Heating::Step(ends) => x.iter().map(|&x| step(ends, x, time)).product(),
            Heating::Driven => {
                let b = (FREQUENCY / (2.0 * DIFFUSIVITY)).sqrt();
                let inwards = b * x.iter().sum::<f64>() / (self.dims as f64).sqrt();
                (-inwards).exp() * (FREQUENCY * time - inwards).cos()
            }
        }
    }

    /// What is left of the amplitude of a wave.
    fn amplitude(&self, ends: BoxEnds, time: f64) -> f64 {
        (-DIFFUSIVITY * self.dims as f64 * ends.wave_number().powi(2) * time).exp()
    }

    /// Least and largest temperature that there can be, K: those of the beginning and of the ends.
    fn range(&self) -> [f64; 2] {
        match self.heating {
            Heating::Wave(BoxEnds::Fixed) | Heating::Step(BoxEnds::Fixed) => [0.0, 1.0],
            _ => [-1.0, 1.0],
        }
    }

    /// Judges temperatures at points. `temperature_l2`: L2 norm of the difference from the exact ones, over
    /// theirs; `overshoot`: by how much the range of what there was at the beginning and at the ends is left.
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        temperatures: impl Iterator<Item = ([f64; 3], f64)>,
    ) {
        let (mut difference, mut norm, mut over) = (0.0, 0.0, 0.0f64);
        let [least, most] = self.range();
        for (x, t) in temperatures {
            let exact = self.temperature(x, time);
            difference += (t - exact).powi(2);
            norm += exact * exact;
            over = over.max(t - most).max(least - t);
        }
        report.error("temperature_l2", (difference / norm).sqrt());
        report.result("overshoot", over, None);
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Heat in a box, {}-D", self.dims)
    }
}

/// What has become of the sign of a wave along one direction.
fn step(ends: BoxEnds, x: f64, time: f64) -> f64 {
    if time == 0.0 {
        // On the step itself the mean of both sides, which is what the series comes to.
        let shape = ends.shape(x);
        return if shape.abs() < 1e-12 { 0.0 } else { shape.signum() };
    }
    let decay = DIFFUSIVITY * ends.wave_number().powi(2) * time;
    let term = |k: i32| {
        let n = f64::from(2 * k + 1);
        let sign = if ends == BoxEnds::Free && k % 2 == 1 { -1.0 } else { 1.0 };
        4.0 / (PI * n) * sign * ends.shape(n * x) * (-decay * n * n).exp()
    };
    // Until terms are lost in rounding.
    let terms = (37.0 / decay).sqrt().ceil().min(1e6) as i32;
    (0..=terms / 2).map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows `heat_1D` and `heat_2D` of `08_linear_modes.csv`.
    #[test]
    fn amplitudes_are_those_of_the_reference() {
        for (dims, amplitude) in [(1, 0.6738254512), (2, 0.4540407387)] {
            let ends = BoxEnds::Periodic;
            let scene = HeatBox { dims, resolution: 32, heating: Heating::Wave(ends) };
            assert!((scene.amplitude(ends, 1.0) - amplitude).abs() < 1e-10);
        }
    }

    /// The heat equation itself, by small differences; and soon after a step, far from the others, the error function.
    #[test]
    fn temperatures_solve_the_heat_equation() {
        let still = [BoxEnds::Periodic, BoxEnds::Fixed, BoxEnds::Free];
        let heatings =
            still.into_iter().flat_map(|ends| [Heating::Wave(ends), Heating::Step(ends)]);
        for heating in heatings.chain([Heating::Driven]) {
            let scene = HeatBox { dims: 2, resolution: 32, heating };
            let (x, t, h) = ([0.37, 0.61, 0.0], 0.3, 1e-3);
            let at = |by: [f64; 2], later: f64| {
                scene.temperature([x[0] + by[0], x[1] + by[1], 0.0], t + later)
            };
            let rate = (at([0.0; 2], h) - at([0.0; 2], -h)) / (2.0 * h);
            let around = [[h, 0.0], [-h, 0.0], [0.0, h], [0.0, -h]].map(|by| at(by, 0.0));
            let laplacian = (around.iter().sum::<f64>() - 4.0 * at([0.0; 2], 0.0)) / (h * h);
            let size = rate.abs().max(0.01);
            assert!((rate - DIFFUSIVITY * laplacian).abs() < 1e-3 * size, "{heating:?}: {rate}");
        }
        // erf(1/2), Abramowitz & Stegun (1964), table 7.1.
        let t = 1e-3;
        for (ends, at) in [(BoxEnds::Periodic, 0.0), (BoxEnds::Fixed, 0.0), (BoxEnds::Free, 0.5)] {
            let away = (DIFFUSIVITY * t).sqrt();
            let side = if ends == BoxEnds::Free { -1.0 } else { 1.0 };
            assert!((step(ends, at + side * away, t) - 0.5204998778).abs() < 1e-9, "{ends:?}");
        }
    }
}
