//! Gas dynamics: an ideal gas whose particles carry mass and energy, with shocks.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Moment, Own, Rate, Real, Stage, State, UpdateStage};

use crate::adaptive_density::{AdaptiveDensity, power};
use crate::error::{SphError, not_negative};
use crate::evaluation::{Piece, Update};
use crate::fields::Fields;
use crate::kernel::adaptive::AdaptiveKernel;
use crate::physics::{Fluid, Physics};
use crate::quantity::Quantity;
use crate::scheme::{Gradient, Scheme};
use crate::state_equation::StateEquation;
use crate::term::conductivity::Conductivity;
use crate::term::gas_pressure::GasPressure;
use crate::term::shock_viscosity::ShockViscosity;

/// What turns motion into heat in shocks, and spreads heat where energy jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShockCapturing {
    /// Artificial viscosity `alpha` (Monaghan 1997), about 1; 0 for none.
    pub viscosity: f64,
    /// How much of the approach of two particles adds to the speed of their signals, `beta` of
    /// Monaghan (1997): 3, against penetration.
    pub approach: f64,
    /// Artificial thermal conductivity `alpha_u` (Price 2008), about 1; 0 for none.
    pub conductivity: f64,
}

impl Default for ShockCapturing {
    fn default() -> Self {
        Self { viscosity: 1.0, approach: 3.0, conductivity: 1.0 }
    }
}

impl ShockCapturing {
    pub(crate) fn check(&self) -> Result<(), SphError> {
        not_negative("shock viscosity", self.viscosity)?;
        not_negative("shock approach", self.approach)?;
        not_negative("shock conductivity", self.conductivity)
    }
}

/// The pieces of gas dynamics, for particles of mass `mass` and the smoothing ratio `ratio`.
pub(crate) fn pieces<T: Real, P: Real, const D: usize>(
    kernel: AdaptiveKernel<T, D>,
    mass: T,
    ratio: T,
    heat_ratio: T,
    shocks: Option<ShockCapturing>,
) -> Vec<Piece<T, P>> {
    let mut pieces = vec![
        AdaptiveDensity::piece(kernel, mass, ratio),
        GasState::<T, D>::piece(mass, ratio, heat_ratio),
        Piece::Term(GasPressure { mass }.into()),
    ];
    let Some(ShockCapturing { viscosity, approach, conductivity }) = shocks else {
        return pieces;
    };
    if viscosity > 0.0 {
        let (strength, approach) = (T::of(viscosity), T::of(approach));
        pieces.push(Piece::Term(ShockViscosity { strength, approach }.into()));
    }
    if conductivity > 0.0 {
        let strength = T::of(conductivity);
        pieces.push(Piece::Term(Conductivity { mass, strength }.into()));
    }
    pieces
}

/// Density, volume, pressure and sound speed of an ideal gas, from smoothing length and energy:
/// `rho = m (eta / h)^D`, `p = (gamma - 1) rho e`, `c^2 = gamma p / rho`.
///
/// Where time stepping has made a very cold particle's energy negative, it has no pressure.
#[derive(Clone, Debug)]
struct GasState<T, const D: usize> {
    mass: T,
    ratio: T,
    heat_ratio: T,
    smoothing_length: Rate<T>,
    grad_h: Rate<T>,
    energy: State<T>,
    density: State<T>,
    volume: State<T>,
    pressure: Option<State<T>>,
    pressure_term: State<T>,
    sound_speed: Option<State<T>>,
}

impl<T: Real, const D: usize> GasState<T, D> {
    fn piece<P: Real>(mass: T, ratio: T, heat_ratio: T) -> Piece<T, P> {
        Piece::Update(Update {
            reads: vec![Quantity::SmoothingLength, Quantity::GradH],
            writes: vec![
                Quantity::Volume,
                Quantity::Pressure,
                Quantity::PressureTerm,
                Quantity::SoundSpeed,
            ],
            amends: false,
            stage: Box::new(move |fields: &Fields<T, P>| {
                let rate = |quantity| fields.rate(quantity).expect("declared, since it is read");
                Stage::update(Self {
                    mass,
                    ratio,
                    heat_ratio,
                    smoothing_length: rate(Quantity::SmoothingLength),
                    grad_h: rate(Quantity::GradH),
                    energy: fields.energy.expect("gas has energy"),
                    density: fields.density,
                    volume: fields.volume,
                    pressure: fields.pressure,
                    pressure_term: fields.pressure_term.expect("forces of gas read it"),
                    sound_speed: fields.sound_speed,
                })
            }),
        })
    }
}

impl<T: Real, P: Real, const D: usize> UpdateStage<Cells<P>> for GasState<T, D> {
    type Scratch = ();

    fn name(&self) -> &str {
        "ideal gas"
    }

    fn update(&self, own: &mut Own<'_, Cells<P>>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let smoothing_length = own.rate(self.smoothing_length).whole();
        let grad_h = own.rate(self.grad_h).whole();
        let energy = own.state(self.energy).whole();
        let density = own.state_mut(self.density).whole();
        let volume = own.state_mut(self.volume).whole();
        let pressure_term = own.state_mut(self.pressure_term).whole();
        let mut pressure = self.pressure.map(|column| own.state_mut(column).whole());
        let mut sound_speed = self.sound_speed.map(|column| own.state_mut(column).whole());
        let (excess, heat_ratio) = (self.heat_ratio - T::one(), self.heat_ratio);
        for i in 0..density.len() {
            volume[i] = power::<T, D>(smoothing_length[i] / self.ratio);
            density[i] = self.mass / volume[i];
            // p / rho
            let specific = excess * if energy[i] < T::zero() { T::zero() } else { energy[i] };
            pressure_term[i] = specific / (grad_h[i] * density[i]);
            if let Some(pressure) = &mut pressure {
                pressure[i] = specific * density[i];
            }
            if let Some(sound_speed) = &mut sound_speed {
                sound_speed[i] = (heat_ratio * specific).sqrt();
            }
        }
        Ok(())
    }
}

/// Refuses choices that do not make a gas.
pub(crate) fn check(fluid: &Fluid, physics: &Physics, scheme: &Scheme) -> Result<(), SphError> {
    let requires = |needed: bool, choice, needs| {
        if needed { Ok(()) } else { Err(SphError::Choice { choice, others: needs }) }
    };
    let StateEquation::IdealGas { heat_ratio } = fluid.state_equation else {
        let uniform = !scheme.smoothing.is_adaptive();
        requires(uniform, "a smoothing length that follows the density", "an ideal gas")?;
        return requires(physics.shock_capturing.is_none(), "shock capturing", "an ideal gas");
    };
    if !(heat_ratio > 1.0 && heat_ratio.is_finite()) {
        let range = "finite and above one";
        return Err(SphError::OutOfRange { name: "heat_ratio", value: heat_ratio, range });
    }
    if let Some(shocks) = physics.shock_capturing {
        shocks.check()?;
    }
    let follows = scheme.smoothing.is_adaptive();
    requires(follows, "an ideal gas", "a smoothing length that follows the density")?;
    requires(physics.energy, "an ideal gas", "the energy equation")?;
    let is_plain = scheme.gradient == Gradient::Kernel;
    requires(is_plain, "an ideal gas", "gradient = kernel")?;
    requires(physics.viscosity.is_none(), "an ideal gas", "no laminar viscosity")?;
    requires(physics.fringe.is_none(), "an ideal gas", "space without a fringe")?;
    requires(physics.bodies.is_empty(), "an ideal gas", "space without bodies")
}
