//! Implicit steps of equations that are linear in one unknown, `u' = f(u, t) = L u + b(t)`.
//!
//! Every scheme of [`crate::Implicit`] comes to one linear system a step, for the change of the unknown:
//! `(1 - c L) (u_{n+1} - u_n) = r`, in which the right-hand side is made of rates `f(u_n, t)` at the times of both ends of
//! the step and of the last change. So all that is known of an equation and of what holds at its boundary is what its
//! explicit stage evaluates, and `L`, too, is found by asking that stage ([`operator`]).
//!
//! In the norm `W` of the difference operators `W L` is symmetric and has no positive eigenvalue (Mattsson, Ham &
//! Iaccarino 2009), so that `W (1 - c L)` has a Cholesky factor ([`system`]).

mod operator;
mod solve;
mod system;

use finegrain_framework::space::Grid;
use finegrain_framework::{FixedPace, Pacing, RigidPace, Stage, Step};

use crate::boundary::Boundary;
use crate::error::FdError;
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd, norm};
use crate::operator::Order;
use crate::sweep::Form;
use crate::time_stepping::Implicit;
use operator::{AxisOperator, Operator};
use solve::Solve;
use system::System;

/// A model of an equation that is linear in its one unknown and a sum over the axes: `stage` evaluates it, and `along`
/// does so along a single axis.
pub(crate) fn model<T: Compiled>(
    mut builder: Builder<'_, T, 1, 0>,
    name: &str,
    scheme: Implicit,
    time_step: f64,
    stage: impl Fn(&Builder<'_, T, 1, 0>, Form) -> Result<Stage<Grid>, FdError>,
    along: impl Fn(&Builder<'_, f64, 1, 0>, Form) -> Result<Stage<Grid>, FdError>,
) -> Result<Fd<T>, FdError> {
    let (order, boundary) = (builder.order, builder.boundaries[0]);
    let axes: Result<_, _> =
        (0..builder.mesh.dims()).map(|a| axis(builder.mesh, boundary, order, a, &along)).collect();
    let operator = Operator(axes?);
    let weights = operator.weights();
    let system = System::new(operator)?;

    let mut step = Step::builder();
    let mut rates = builder.out.clone();
    if scheme == Implicit::CrankNicolson {
        step = step.stage_at(0.0, &stage(&builder, Form::Rate)?);
        let at_end = builder.columns.rate("rate_at_end");
        let at_beginning = std::mem::replace(&mut builder.out, vec![at_end]);
        step = step.stage_at(1.0, &stage(&builder, Form::Rate)?);
        builder.out = at_beginning;
        rates.push(at_end);
    } else {
        step = step.stage_at(1.0, &stage(&builder, Form::Rate)?);
    }
    let (mut change, mut pacing): (_, Box<dyn Pacing<Grid>>) =
        (None, Box::new(FixedPace(time_step)));
    if scheme == Implicit::Bdf2 {
        // Its formula is that of equal steps.
        (change, pacing) =
            (Some(builder.columns.state("last_change")), Box::new(RigidPace(time_step)));
    }
    let unknown = builder.unknowns[0];
    let solve = Solve::new(scheme, system, weights, unknown, rates, change);
    let plan = step.stage_at(1.0, &Stage::whole(solve)).build().into();
    builder.finish(name, plan, pacing)
}

/// What an equation makes of its unknown along axis `a` of a mesh.
fn axis(
    mesh: &Mesh,
    boundary: &Boundary,
    order: Order,
    a: usize,
    along: impl Fn(&Builder<'_, f64, 1, 0>, Form) -> Result<Stage<Grid>, FdError>,
) -> Result<AxisOperator, FdError> {
    let side = &mesh.sides()[a];
    let (line, boundary) = (Mesh::new([*side]), boundary.homogeneous_along(a));
    let mut builder = Builder::new(&line, [&boundary], order)?;
    builder.start([("unknown", &|_| 0.0)])?;
    let stage = along(&builder, Form::Rate)?;
    let Builder { domain, columns, unknowns, out, .. } = builder;
    Ok(AxisOperator::probe(domain, columns, &stage, unknowns[0], out[0], norm(side, order)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::Condition;
    use crate::mesh::{Side, Spread};

    /// All are, in their norm, and have a Cholesky factor, but for ghost points whose share depends on how deep they lie.
    #[test]
    fn operators_are_symmetric() {
        let conditions =
            [Condition::dirichlet(2.0), Condition::neumann(1.0), Condition::robin(1.0, 0.3, 0.5)];
        for (condition, order) in
            conditions.iter().flat_map(|c| Order::ALL.into_iter().map(move |order| (c, order)))
        {
            for spread in [Spread::Periodic, Spread::Ends, Spread::Cells] {
                if (spread, order) == (Spread::Ends, Order::Eighth) {
                    continue;
                }
                let mesh = Mesh::new([Side { points: 30, lower: 0.0, upper: 0.7, spread }]);
                let boundary = Boundary::all(condition.clone());
                let operator =
                    axis(&mesh, &boundary, order, 0, |line, form| f64::heat(line, 1.3, form));
                let has_depth = spread == Spread::Cells && order != Order::Second;
                let expected = !(has_depth && matches!(condition, Condition::Robin { .. }));
                let found = operator.unwrap().is_symmetric();
                assert_eq!(found, expected, "{spread:?}, order {order}, {condition:?}");
            }
        }
    }
}
