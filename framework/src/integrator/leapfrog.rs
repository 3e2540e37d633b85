//! Leapfrog, kick-drift-kick.

use super::linear::Linear;
use super::{Evolution, Plan};
use crate::columns::{ColumnId, Columns, Role};
use crate::domain::Domain;
use crate::step::{Stage, Step};

/// Kick-drift-kick leapfrog (velocity Verlet; Hairer, Lubich & Wanner 2003, Acta Numerica 12) with
/// one evaluation a step.
///
/// For `x' = v`, `v' = a(x)`:
/// `v_{n+1/2} = v_n + dt/2 a_n`, `x_{n+1} = x_n + dt v_{n+1/2}`,
/// `v_{n+1} = v_{n+1/2} + dt/2 a_{n+1}`.
///
/// Rates may also depend on the velocity (viscosity) and there may be quantities with rates but
/// without motion (density, energy). So that the step stays of second order, the evaluation at
/// t_{n+1} sees them predicted, `y* = y_n + dt y'_n`, and the second kick then corrects:
/// `y_{n+1} = y* + dt/2 (y'_{n+1} - y'_n)` (as Price et al. 2018, PASA 35, e031, section 2.3.4,
/// without their iteration). Decay, `y' = -k y`, is stable for `k dt` up to 1. Where rates do not depend on `v` this is the above, exactly.
pub(super) fn leapfrog<D: Domain>(
    columns: &mut Columns,
    evolution: &Evolution,
    evaluation: &[Stage<D>],
) -> Plan<D> {
    // For every rate a second column: the rates at the beginning of the step.
    let last: Vec<(ColumnId, ColumnId)> = evolution
        .rates
        .iter()
        .map(|&(state, rate)| {
            columns.keep(rate);
            (state, columns.declare_like(rate, "last", Role::Rate))
        })
        .collect();
    for &(_, drift) in &evolution.drifts {
        columns.keep(drift);
    }
    // x += dt v + dt^2/2 a for motions whose velocity has a rate.
    let accelerations: Vec<(ColumnId, ColumnId)> = evolution
        .motions
        .iter()
        .filter_map(|&(position, velocity)| {
            let (_, rate) = evolution.rates.iter().find(|&&(y, _)| y == velocity)?;
            Some((position, *rate))
        })
        .collect();
    let drift_and_predict = Linear::new()
        .add_dt(&evolution.motions, 1.0)
        .add_dt_squared(&accelerations, 0.5)
        .add_dt(&evolution.drifts, 1.0)
        .add_dt(&evolution.rates, 1.0);
    let correct = Linear::new().add_dt(&evolution.rates, 0.5).add_dt(&last, -0.5);
    let mut step = Step::builder().stage_at(0.0, &Stage::update(drift_and_predict));
    for (&(_, rate), &(_, last)) in evolution.rates.iter().zip(&last) {
        step = step.exchange(rate, last);
    }
    let step = step.stages_at(1.0, evaluation).stage_at(1.0, &Stage::update(correct)).build();
    let prologue = Step::builder().stages_at(0.0, evaluation).build();
    Plan { prologue: Some(prologue), step, derived: None }
}
