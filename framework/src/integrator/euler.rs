//! Euler's method, explicit and symplectic.

use super::linear::Linear;
use super::{Evolution, Plan};
use crate::domain::Domain;
use crate::step::{Stage, Step};

/// `y_{n+1} = y_n + dt y'(t_n, y_n)`.
pub(super) fn explicit<D: Domain>(evolution: &Evolution, evaluation: &[Stage<D>]) -> Plan<D> {
    let update = Linear::new().add_dt(&evolution.slopes(), 1.0);
    Step::builder().stages_at(0.0, evaluation).stage_at(0.0, &Stage::update(update)).build().into()
}

/// `v_{n+1} = v_n + dt a(x_n, v_n)`, then `x_{n+1} = x_n + dt v_{n+1}`
/// (Hairer, Lubich & Wanner 2006, section I.1.2).
pub(super) fn symplectic<D: Domain>(evolution: &Evolution, evaluation: &[Stage<D>]) -> Plan<D> {
    let update = Linear::new()
        .add_dt(&evolution.rates, 1.0)
        .add_dt(&evolution.motions, 1.0)
        .add_dt(&evolution.drifts, 1.0);
    Step::builder().stages_at(0.0, evaluation).stage_at(0.0, &Stage::update(update)).build().into()
}
