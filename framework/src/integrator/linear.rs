//! The update stage that all integrators are made of: linear combinations of own columns.

use crate::columns::{ColumnId, Columns, Element, ElementKind, Role};
use crate::domain::Domain;
use crate::real::Real;
use crate::stage::{Fault, Moment, UpdateStage};
use crate::view::Own;

/// `target = keep target + weight dt^power source`.
#[derive(Clone, Copy, Debug)]
struct Axpy {
    target: ColumnId,
    keep: f64,
    weight: f64,
    power: i32,
    source: ColumnId,
}

/// Linear combinations, applied in order to every point a sub-domain owns.
#[derive(Clone, Debug, Default)]
pub(super) struct Linear(Vec<Axpy>);

impl Linear {
    pub fn new() -> Self {
        Self::default()
    }

    /// For each pair: `target = source`.
    pub fn copy(self, pairs: &[(ColumnId, ColumnId)]) -> Self {
        self.push(pairs, 0.0, 1.0, 0)
    }

    /// For each pair: `target += weight source`.
    pub fn add(self, pairs: &[(ColumnId, ColumnId)], weight: f64) -> Self {
        self.push(pairs, 1.0, weight, 0)
    }

    /// For each pair: `target += weight dt source`.
    pub fn add_dt(self, pairs: &[(ColumnId, ColumnId)], weight: f64) -> Self {
        self.push(pairs, 1.0, weight, 1)
    }

    /// For each pair: `target += weight dt^2 source`.
    pub fn add_dt_squared(self, pairs: &[(ColumnId, ColumnId)], weight: f64) -> Self {
        self.push(pairs, 1.0, weight, 2)
    }

    /// For each pair: `target = keep target + weight dt source`.
    pub fn blend_dt(self, pairs: &[(ColumnId, ColumnId)], keep: f64, weight: f64) -> Self {
        self.push(pairs, keep, weight, 1)
    }

    /// For each slope (y, k), with `y_n` in the register of the same place:
    /// `y = y_n + weight dt k`. One after the other, so that a velocity moves its point before it
    /// is itself overwritten.
    pub fn restart(
        self,
        registers: &[(ColumnId, ColumnId)],
        slopes: &[(ColumnId, ColumnId)],
        weight: f64,
    ) -> Self {
        registers.iter().zip(slopes).fold(self, |linear, (&(register, state), &slope)| {
            linear.copy(&[(state, register)]).add_dt(&[slope], weight)
        })
    }

    fn push(mut self, pairs: &[(ColumnId, ColumnId)], keep: f64, weight: f64, power: i32) -> Self {
        self.0.extend(pairs.iter().map(|&(target, source)| Axpy {
            target,
            keep,
            weight,
            power,
            source,
        }));
        self
    }
}

impl<D: Domain> UpdateStage<D> for Linear {
    type Scratch = ();

    fn name(&self) -> &str {
        "integrator update"
    }

    fn update(&self, own: &mut Own<'_, D>, _: &mut (), moment: &Moment) -> Result<(), Fault> {
        for axpy in &self.0 {
            use ElementKind::{F32, F64};
            let mut own = own.reborrow();
            match (own.kind(axpy.target), own.kind(axpy.source)) {
                (F64, F64) => apply::<f64, f64, D>(axpy, &mut own, moment.dt),
                (F32, F32) => apply::<f32, f32, D>(axpy, &mut own, moment.dt),
                (F64, F32) => apply::<f64, f32, D>(axpy, &mut own, moment.dt),
                (F32, F64) => apply::<f32, f64, D>(axpy, &mut own, moment.dt),
                _ => return Err(Fault::new("only columns of floats can evolve")),
            }
        }
        Ok(())
    }
}

fn apply<T: Real + Element, S: Real + Element, D: Domain>(
    axpy: &Axpy,
    own: &mut Own<'_, D>,
    dt: f64,
) {
    let keep = T::of(axpy.keep);
    let weight = T::of(axpy.weight * dt.powi(axpy.power));
    let source = own.part::<S>(axpy.source);
    let mut target = own.part_mut::<T>(axpy.target);
    for k in 0..target.spans() {
        for (y, x) in target.span(k).iter_mut().zip(source.span(k)) {
            // A register may hold anything before its first use, NaN too: do not multiply it by 0.
            let kept = if axpy.keep == 0.0 { T::zero() } else { keep * *y };
            *y = kept + weight * T::of(x.as_f64());
        }
    }
}

/// For each (target, source) of `pairs`, a new register of the target's type; the pairs
/// (register, target).
pub(super) fn registers(
    columns: &mut Columns,
    name: &str,
    pairs: &[(ColumnId, ColumnId)],
) -> Vec<(ColumnId, ColumnId)> {
    pairs
        .iter()
        .map(|&(target, _)| {
            let register = columns.declare_like(target, name, Role::Register);
            (register, target)
        })
        .collect()
}

/// The pairs with the two columns exchanged.
pub(super) fn reversed(pairs: &[(ColumnId, ColumnId)]) -> Vec<(ColumnId, ColumnId)> {
    pairs.iter().map(|&(a, b)| (b, a)).collect()
}

/// Pairs (target of the first, source of the second), in order.
pub(super) fn matched(
    targets: &[(ColumnId, ColumnId)],
    sources: &[(ColumnId, ColumnId)],
) -> Vec<(ColumnId, ColumnId)> {
    targets.iter().zip(sources).map(|(&(target, _), &(_, source))| (target, source)).collect()
}
