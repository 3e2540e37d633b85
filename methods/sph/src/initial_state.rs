//! The fields of a start, as they are before the first step: a scene may have set them after the
//! model was built.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Handle, Real, Whole, WholeStage};

use crate::fields::Fields;

/// Refuses fields that are not finite, and densities that are not positive, before the first step.
/// Positions are looked at where they are sorted.
pub(crate) struct InitialState<T, P> {
    pub fields: Fields<T, P>,
}

impl<T: Real, P: Real> WholeStage<Cells<P>> for InitialState<T, P> {
    fn name(&self) -> &str {
        "check of the initial state"
    }

    fn run(&mut self, whole: &mut Whole<'_, Cells<P>>) -> Result<(), Fault> {
        if whole.step > 0 {
            return Ok(());
        }
        let (fields, columns) = (&self.fields, &*whole.columns);
        let wrong = |i: usize, name: &str, value: T, range: &str| {
            let identity = columns.values(fields.identity)[i];
            Err(Fault::new(format!(
                "particle {identity} starts with {name} = {value}; it must be {range}"
            )))
        };
        // A pressure that follows from the density is not there yet.
        let pressure = fields.pressure.filter(|_| fields.pressure_rate.is_some());
        for &column in fields.velocity.iter().chain(&fields.energy).chain(&pressure) {
            let values = columns.values(column);
            if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                return wrong(i, columns.column(column.id()).name(), values[i], "finite");
            }
        }
        let density = columns.values(fields.density);
        match density.iter().position(|&rho| !(rho > T::zero() && rho.is_finite())) {
            Some(i) => wrong(i, "density", density[i], "finite and above zero"),
            None => Ok(()),
        }
    }
}
