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

    /// For each target: `target = keep target + weight dt k`, with the sum of its slopes as `k`.
    pub fn blend_dt(self, slopes: &[(ColumnId, ColumnId)], keep: f64, weight: f64) -> Self {
        firsts(slopes).fold(self, |linear, (is_first, slope)| {
            linear.push(&[slope], if is_first { keep } else { 1.0 }, weight, 1)
        })
    }

    /// For each target, with `y_n` in its register: `target = y_n + weight dt k`, with the sum of
    /// its slopes as `k`. One after the other, so that a velocity moves its point before it is
    /// itself overwritten.
    pub fn restart(
        self,
        registers: &[(ColumnId, ColumnId)],
        slopes: &[(ColumnId, ColumnId)],
        weight: f64,
    ) -> Self {
        firsts(slopes).fold(self, |linear, (is_first, slope)| {
            let register = registers.iter().filter(|&&(_, target)| is_first && target == slope.0);
            register
                .fold(linear, |linear, &(register, target)| linear.copy(&[(target, register)]))
                .add_dt(&[slope], weight)
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

/// Each slope, and whether it is the first of its target.
fn firsts(
    slopes: &[(ColumnId, ColumnId)],
) -> impl Iterator<Item = (bool, (ColumnId, ColumnId))> + '_ {
    slopes.iter().enumerate().map(|(i, &slope)| {
        let is_first = slopes[..i].iter().all(|&(target, _)| target != slope.0);
        (is_first, slope)
    })
}

/// For each target of `slopes` a new register of its type; the pairs (register, target).
pub(super) fn registers(
    columns: &mut Columns,
    name: &str,
    slopes: &[(ColumnId, ColumnId)],
) -> Vec<(ColumnId, ColumnId)> {
    firsts(slopes)
        .filter(|&(is_first, _)| is_first)
        .map(|(_, (target, _))| (columns.declare_like(target, name, Role::Register), target))
        .collect()
}

/// The pairs with the two columns exchanged.
pub(super) fn reversed(pairs: &[(ColumnId, ColumnId)]) -> Vec<(ColumnId, ColumnId)> {
    pairs.iter().map(|&(a, b)| (b, a)).collect()
}

/// The slopes, with the registers of their targets in place of these.
pub(super) fn matched(
    registers: &[(ColumnId, ColumnId)],
    slopes: &[(ColumnId, ColumnId)],
) -> Vec<(ColumnId, ColumnId)> {
    let of = |slope: (ColumnId, ColumnId)| {
        let found = registers.iter().filter(move |&&(_, target)| target == slope.0);
        found.map(move |&(register, _)| (register, slope.1))
    };
    slopes.iter().flat_map(|&slope| of(slope)).collect()
}
