//! What particles of bodies take over from the pressure that was extrapolated to them.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Moment, Own, Real, Stage, UpdateStage};

use crate::evaluation::{Piece, Update};
use crate::fields::Fields;
use crate::physics::Fluid;
use crate::quantity::Quantity;

/// The update that gives particles of bodies the density that goes with their pressure (Adami, Hu
/// & Adams 2012, eq. 28), with volume and `p / rho^2`.
#[derive(Clone, Debug)]
pub(crate) struct WallState<T> {
    fields: Fields<T>,
    fluid: Fluid,
    particle_mass: T,
}

impl<T: Real> WallState<T> {
    /// For particles of one mass.
    pub fn piece(fluid: &Fluid, particle_mass: T) -> Piece<T> {
        let fluid = *fluid;
        Piece::Update(Update {
            reads: vec![Quantity::WallPressure],
            writes: vec![Quantity::Volume, Quantity::PressureTerm],
            amends: true,
            stage: Box::new(move |fields| {
                Stage::update(Self { fields: fields.clone(), fluid, particle_mass })
            }),
        })
    }
}

impl<T: Real> UpdateStage<Cells<T>> for WallState<T> {
    type Scratch = ();

    fn name(&self) -> &str {
        "state of bodies"
    }

    fn update(&self, own: &mut Own<'_, Cells<T>>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let fields = &self.fields;
        let (Some(depth), Some(pressure)) = (fields.wall_depth, fields.wall_pressure) else {
            return Ok(());
        };
        let (depth, pressure) = (own.state(depth).whole(), own.rate(pressure).whole());
        let density = own.state_mut(fields.density).whole();
        let volume = own.state_mut(fields.volume).whole();
        let pressure_term = own.state_mut(fields.pressure_term).whole();
        let (equation, rho, c) =
            (self.fluid.state_equation, T::of(self.fluid.density), T::of(self.fluid.sound_speed));
        for i in 0..depth.len() {
            if depth[i] > T::zero() {
                density[i] = equation.density(pressure[i], rho, c);
                volume[i] = self.particle_mass / density[i];
                pressure_term[i] = pressure[i] / (density[i] * density[i]);
                if density[i].is_nan() || density[i] <= T::zero() {
                    return Err(Fault::new(format!(
                        "particle {} in a body has density {}, from a pressure of {}; it must be \
                         positive",
                        own.spans()[0].start + i,
                        density[i],
                        pressure[i]
                    )));
                }
            }
        }
        Ok(())
    }
}
