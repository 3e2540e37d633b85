//! The box that particles live in.

use crate::columns::{Columns, State};
use crate::real::Real;
use crate::stage::Fault;
use crate::team::Team;

/// The box that particles live in.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Lower corner, one number a dimension.
    pub lower: Vec<f64>,
    /// Upper corner.
    pub upper: Vec<f64>,
    /// Which directions are periodic. In the others particles may go anywhere; the box there
    /// follows them.
    pub periodic: Vec<bool>,
}

impl Region {
    /// Brings positions that have left the box in a periodic direction to where they come in again.
    ///
    /// # Errors
    /// If a position is not finite; names the particle's place in the columns.
    pub(super) fn wrap<T: Real>(
        &self,
        columns: &mut Columns,
        positions: &[State<T>],
        team: &mut Team,
    ) -> Result<(), Fault> {
        for (a, &column) in positions.iter().enumerate() {
            let values = columns.values_mut(column);
            if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                return Err(Fault::new(format!(
                    "the particle at place {i} has coordinate {} in direction {a}, which is not finite",
                    values[i]
                )));
            }
            if !self.periodic[a] {
                continue;
            }
            let (lower, upper) = (self.lower[a], self.upper[a]);
            let length = upper - lower;
            let first = first_inside(lower);
            team.for_each_chunk(values, 16_384, |_, chunk| {
                for value in chunk {
                    let x = value.as_f64();
                    if !(lower..upper).contains(&x) {
                        let wrapped = x - ((x - lower) / length).floor() * length;
                        // Rounding may lead to the upper end, which is the lower end.
                        let wrapped = T::of(wrapped);
                        let is_inside = (lower..upper).contains(&wrapped.as_f64());
                        *value = if is_inside { wrapped } else { first };
                    }
                }
            });
        }
        Ok(())
    }
}

/// The number of type `T` that is at least `lower` and next to it.
fn first_inside<T: Real>(lower: f64) -> T {
    let first = T::of(lower);
    if first.as_f64() < lower { first + T::epsilon() * first.abs() } else { first }
}
