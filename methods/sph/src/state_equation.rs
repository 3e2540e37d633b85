//! Equations of state: pressure from density.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Moment, Own, Real, Stage, UpdateStage};

use crate::evaluation::{Piece, Update};
use crate::fields::Fields;
use crate::physics::Fluid;
use crate::quantity::Quantity;
use crate::scheme::{Density, Scheme};

/// Pressure as a function of density, and for a gas of energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StateEquation {
    /// `p = c^2 (rho - rho_0) + p_b` (Morris, Fox & Zhu 1997 take `p_b = c^2 rho_0`).
    Linear {
        /// Background pressure `p_b` in units of `c^2 rho_0`.
        background: f64,
    },
    /// `p = c^2 rho_0 / gamma ((rho / rho_0)^gamma - 1) + p_b` (Monaghan 1994, with gamma = 7 for
    /// water).
    Tait {
        /// Exponent gamma.
        exponent: f64,
        /// Background pressure `p_b` in units of `c^2 rho_0`.
        background: f64,
    },
    /// `p = (gamma - 1) rho e`, with the specific internal energy `e`.
    IdealGas {
        /// Ratio gamma of the specific heats.
        heat_ratio: f64,
    },
}

impl StateEquation {
    /// Pressure, Pa, at `density`, for a fluid with reference density and sound speed; of an ideal
    /// gas as it has it at the temperature at which that is its sound speed.
    #[inline(always)]
    pub fn pressure<T: Real>(&self, density: T, reference_density: T, sound_speed: T) -> T {
        let stiffness = sound_speed * sound_speed * reference_density;
        let ratio = density / reference_density;
        match *self {
            Self::Linear { background } => stiffness * (ratio - T::one() + T::of(background)),
            Self::Tait { exponent, background } => {
                let gamma = T::of(exponent);
                stiffness * ((ratio.powf(gamma) - T::one()) / gamma + T::of(background))
            }
            Self::IdealGas { heat_ratio } => stiffness * ratio / T::of(heat_ratio),
        }
    }

    /// Density, kg/m^3, at `pressure`: the inverse of [`StateEquation::pressure`]. Where no density
    /// has so low a pressure, NaN or not positive.
    #[inline(always)]
    pub fn density<T: Real>(&self, pressure: T, reference_density: T, sound_speed: T) -> T {
        let ratio = pressure / (sound_speed * sound_speed * reference_density);
        match *self {
            Self::Linear { background } => {
                reference_density * (ratio + T::one() - T::of(background))
            }
            Self::Tait { exponent, background } => {
                let power = T::of(exponent) * (ratio - T::of(background)) + T::one();
                reference_density * power.powf(T::of(1.0 / exponent))
            }
            Self::IdealGas { heat_ratio } => reference_density * ratio * T::of(heat_ratio),
        }
    }

    /// Elastic energy, J/kg, at a density `ratio` to the reference density:
    /// `e = integral p / rho^2 d rho` from there.
    pub fn elastic_energy(&self, ratio: f64, sound_speed: f64) -> f64 {
        let expansion = 1.0 / ratio - 1.0;
        let (of_density, background) = match *self {
            Self::Linear { background } => (ratio.ln() + expansion, background),
            Self::Tait { exponent, background } => {
                let power = exponent - 1.0;
                let work =
                    if power == 0.0 { ratio.ln() } else { (ratio.powf(power) - 1.0) / power };
                ((work + expansion) / exponent, background)
            }
            Self::IdealGas { heat_ratio } => (ratio.ln() / heat_ratio, 0.0),
        };
        sound_speed * sound_speed * (of_density - background * expansion)
    }
}

/// The update that begins an evaluation: what follows from the density, which may itself be a sum,
/// for particles of one mass.
#[derive(Clone, Debug)]
pub(crate) struct Thermodynamics<T, P> {
    fields: Fields<T, P>,
    fluid: Fluid,
    particle_mass: T,
    /// Whether pressure evolves by itself.
    has_own_pressure: bool,
}

impl<T: Real, P: Real> Thermodynamics<T, P> {
    /// The update for a model whose terms see pressure as `pressures`.
    pub fn piece(
        fluid: &Fluid,
        scheme: &Scheme,
        particle_mass: T,
        pressures: &[Quantity],
    ) -> Piece<T, P> {
        let (fluid, has_own_pressure) = (*fluid, scheme.edac.is_some());
        let is_sum = scheme.density == Density::Summation;
        let written = pressures.iter().filter(|&&p| !has_own_pressure || p != Quantity::Pressure);
        Piece::Update(Update {
            reads: if is_sum { vec![Quantity::NumberDensity] } else { Vec::new() },
            writes: written.copied().chain([Quantity::Volume]).collect(),
            amends: false,
            stage: Box::new(move |fields| {
                let fields = fields.clone();
                Stage::update(Self { fields, fluid, particle_mass, has_own_pressure })
            }),
        })
    }
}

impl<T: Real, P: Real> UpdateStage<Cells<P>> for Thermodynamics<T, P> {
    type Scratch = ();

    fn name(&self) -> &str {
        "equation of state"
    }

    fn update(&self, own: &mut Own<'_, Cells<P>>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let (fields, fluid) = (&self.fields, &self.fluid);
        let density = own.state_mut(fields.density).whole();
        if let Some(number) = fields.number_density {
            for (density, &number) in density.iter_mut().zip(own.rate(number).whole()) {
                // There is no sum for particles of bodies whose density follows from the fluid.
                if number != T::zero() {
                    *density = self.particle_mass * number;
                }
            }
        }
        for (volume, &density) in own.state_mut(fields.volume).whole().iter_mut().zip(&*density) {
            *volume = self.particle_mass / density;
        }
        let (rho, c) = (T::of(fluid.density), T::of(fluid.sound_speed));
        let pressure = |density: T| fluid.state_equation.pressure(density, rho, c);
        if let Some(column) = fields.pressure.filter(|_| !self.has_own_pressure) {
            for (p, &density) in own.state_mut(column).whole().iter_mut().zip(&*density) {
                *p = pressure(density);
            }
        }
        if let Some(column) = fields.pressure_term {
            let term = own.state_mut(column).whole();
            for (term, &density) in term.iter_mut().zip(&*density) {
                *term = pressure(density) / (density * density);
            }
        }
        match density.iter().position(|&rho| rho <= T::zero()) {
            None => Ok(()),
            Some(i) => Err(Fault::new(format!(
                "particle {} has density {}; it must be positive",
                own.state(fields.identity).whole()[i],
                density[i]
            ))),
        }
    }
}
