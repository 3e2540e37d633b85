//! Explicit Runge-Kutta methods.

use super::linear::{Linear, matched, registers, reversed};
use super::{Evolution, Plan};
use crate::columns::Columns;
use crate::domain::Domain;
use crate::step::{Stage, Step};

/// Midpoint method (Runge 1895):
/// `y_1 = y_n + dt/2 k(t_n, y_n)`, `y_{n+1} = y_n + dt k(t_n + dt/2, y_1)`.
pub(super) fn rk2<D: Domain>(
    columns: &mut Columns,
    evolution: &Evolution,
    evaluation: &[Stage<D>],
) -> Plan<D> {
    let slopes = evolution.slopes();
    let start = registers(columns, "start", &slopes);
    let half = Linear::new().copy(&start).add_dt(&slopes, 0.5);
    let full = Linear::new().restart(&start, &slopes, 1.0);
    Step::builder()
        .stages_at(0.0, evaluation)
        .stage_at(0.0, &Stage::update(half))
        .stages_at(0.5, evaluation)
        .stage_at(0.5, &Stage::update(full))
        .build()
        .into()
}

/// The optimal third-order strong-stability-preserving method (Shu & Osher 1988):
/// `y_1 = y_n + dt k(t_n, y_n)`,
/// `y_2 = 3/4 y_n + 1/4 (y_1 + dt k(t_n + dt, y_1))`,
/// `y_{n+1} = 1/3 y_n + 2/3 (y_2 + dt k(t_n + dt/2, y_2))`.
pub(super) fn ssp_rk3<D: Domain>(
    columns: &mut Columns,
    evolution: &Evolution,
    evaluation: &[Stage<D>],
) -> Plan<D> {
    let slopes = evolution.slopes();
    let start = registers(columns, "start", &slopes);
    let restart = reversed(&start);
    let first = Linear::new().copy(&start).add_dt(&slopes, 1.0);
    let second = Linear::new().blend_dt(&slopes, 1.0 / 4.0, 1.0 / 4.0).add(&restart, 3.0 / 4.0);
    let third = Linear::new().blend_dt(&slopes, 2.0 / 3.0, 2.0 / 3.0).add(&restart, 1.0 / 3.0);
    Step::builder()
        .stages_at(0.0, evaluation)
        .stage_at(0.0, &Stage::update(first))
        .stages_at(1.0, evaluation)
        .stage_at(1.0, &Stage::update(second))
        .stages_at(0.5, evaluation)
        .stage_at(0.5, &Stage::update(third))
        .build()
        .into()
}

/// The classical method (Kutta 1901): `k_1 = k(t_n, y_n)`, `k_2 = k(t_n + dt/2, y_n + dt/2 k_1)`,
/// `k_3 = k(t_n + dt/2, y_n + dt/2 k_2)`, `k_4 = k(t_n + dt, y_n + dt k_3)`,
/// `y_{n+1} = y_n + dt (k_1/6 + k_2/3 + k_3/3 + k_4/6)`.
pub(super) fn rk4<D: Domain>(
    columns: &mut Columns,
    evolution: &Evolution,
    evaluation: &[Stage<D>],
) -> Plan<D> {
    let slopes = evolution.slopes();
    let start = registers(columns, "start", &slopes);
    let sum = registers(columns, "sum", &slopes);
    let result = reversed(&sum);
    let gather = matched(&sum, &slopes);
    let first =
        Linear::new().copy(&start).copy(&sum).add_dt(&gather, 1.0 / 6.0).add_dt(&slopes, 1.0 / 2.0);
    let again = |weight| Linear::new().add_dt(&gather, 1.0 / 3.0).restart(&start, &slopes, weight);
    let fourth = Linear::new().add_dt(&gather, 1.0 / 6.0).copy(&result);
    Step::builder()
        .stages_at(0.0, evaluation)
        .stage_at(0.0, &Stage::update(first))
        .stages_at(0.5, evaluation)
        .stage_at(0.5, &Stage::update(again(1.0 / 2.0)))
        .stages_at(0.5, evaluation)
        .stage_at(0.5, &Stage::update(again(1.0)))
        .stages_at(1.0, evaluation)
        .stage_at(1.0, &Stage::update(fourth))
        .build()
        .into()
}
