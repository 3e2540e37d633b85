//! A model: what a method builds and a simulation runs.

use crate::columns::Columns;
use crate::domain::Domain;
use crate::integrator::Plan;
use crate::whole::{FixedPace, Pacing, WholeStage};

/// What a method builds: divided space, fields, and the stages that advance them.
pub struct Model<D: Domain> {
    /// The method's name, for messages and checkpoints.
    pub method: String,
    /// Divided space.
    pub domain: D,
    /// Fields, with their initial state.
    pub columns: Columns,
    /// The step, and what comes before the first.
    pub plan: Plan<D>,
    /// Whole-domain stages, run in order at the beginning of every pace.
    pub whole: Vec<Box<dyn WholeStage<D>>>,
    /// Time step control, run after them.
    pub pacing: Box<dyn Pacing<D>>,
}

impl<D: Domain> Model<D> {
    /// A model that needs no whole-domain work, stepped by the same `dt` always.
    pub fn with_fixed_dt(
        method: &str,
        domain: D,
        columns: Columns,
        plan: impl Into<Plan<D>>,
        dt: f64,
    ) -> Self {
        Self {
            method: method.to_owned(),
            domain,
            columns,
            plan: plan.into(),
            whole: Vec::new(),
            pacing: Box::new(FixedPace(dt)),
        }
    }
}
