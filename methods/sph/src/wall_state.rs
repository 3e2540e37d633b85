//! What particles of bodies take over from the pressure that was extrapolated to them.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Moment, Own, Real, Stage, UpdateStage};

use crate::evaluation::{Piece, Update};
use crate::fields::Fields;
use crate::physics::Fluid;
use crate::quantity::Quantity;

/// The update that gives particles of bodies the density that goes with their pressure (Adami, Hu
/// & Adams 2012, eq. 28), with all that follows from the two.
#[derive(Clone, Debug)]
pub(crate) struct WallState<T, P> {
    fields: Fields<T, P>,
    fluid: Fluid,
    particle_mass: T,
}

impl<T: Real, P: Real> WallState<T, P> {
    /// For particles of one mass, and terms that see pressure as `pressures`.
    pub fn piece(fluid: &Fluid, particle_mass: T, pressures: &[Quantity]) -> Piece<T, P> {
        let fluid = *fluid;
        Piece::Update(Update {
            reads: vec![Quantity::WallPressure],
            writes: pressures.iter().copied().chain([Quantity::Volume]).collect(),
            amends: true,
            stage: Box::new(move |fields| {
                Stage::update(Self { fields: fields.clone(), fluid, particle_mass })
            }),
        })
    }
}

impl<T: Real, P: Real> UpdateStage<Cells<P>> for WallState<T, P> {
    type Scratch = ();

    fn name(&self) -> &str {
        "state of bodies"
    }

    fn update(&self, own: &mut Own<'_, Cells<P>>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let fields = &self.fields;
        let (Some(depth), Some(extrapolated)) = (fields.wall_depth, fields.wall_pressure) else {
            return Ok(());
        };
        let (depth, extrapolated) = (own.state(depth).whole(), own.rate(extrapolated).whole());
        let density = own.state_mut(fields.density).whole();
        let volume = own.state_mut(fields.volume).whole();
        let mut pressure = fields.pressure.map(|p| own.state_mut(p).whole());
        let mut pressure_term = fields.pressure_term.map(|p| own.state_mut(p).whole());
        let (equation, rho, c) =
            (self.fluid.state_equation, T::of(self.fluid.density), T::of(self.fluid.sound_speed));
        for i in 0..depth.len() {
            if depth[i] > T::zero() {
                density[i] = equation.density(extrapolated[i], rho, c);
                volume[i] = self.particle_mass / density[i];
                if let Some(pressure) = &mut pressure {
                    pressure[i] = extrapolated[i];
                }
                if let Some(term) = &mut pressure_term {
                    term[i] = extrapolated[i] / (density[i] * density[i]);
                }
                if density[i] <= T::zero() || density[i].is_nan() {
                    return Err(Fault::new(format!(
                        "particle {} in a body has density {}, from a pressure of {}; it must be \
                         positive",
                        own.state(fields.identity).whole()[i],
                        density[i],
                        extrapolated[i]
                    )));
                }
            }
        }
        Ok(())
    }
}
