//! A stage of any kind, as a step uses it.

use std::any::Any;
use std::sync::{Arc, Mutex, PoisonError};

use super::erased::{AnyRate, AnyUpdate};
use crate::columns::ColumnSet;
use crate::domain::Domain;
use crate::stage::{Fault, Moment, RateStage, UpdateStage};
use crate::view::{Near, Own, Rates, Shifts};
use crate::whole::{Whole, WholeStage};

/// A stage of any kind, shared by all the places of a step where it is used.
pub struct Stage<D: Domain>(Kind<D>);

enum Kind<D: Domain> {
    Rate(Arc<dyn AnyRate<D>>, ColumnSet),
    Update(Arc<dyn AnyUpdate<D>>, Arc<Shifts>),
    Whole(Arc<SharedWhole<D>>),
}

/// A whole-domain stage, run by one thread at a time.
struct SharedWhole<D: Domain> {
    name: String,
    stage: Mutex<Box<dyn WholeStage<D>>>,
}

impl<D: Domain> Clone for Stage<D> {
    fn clone(&self) -> Self {
        Self(match &self.0 {
            Kind::Rate(stage, writes) => Kind::Rate(Arc::clone(stage), *writes),
            Kind::Update(stage, shifts) => Kind::Update(Arc::clone(stage), Arc::clone(shifts)),
            Kind::Whole(stage) => Kind::Whole(Arc::clone(stage)),
        })
    }
}

impl<D: Domain> Stage<D> {
    /// A rate stage.
    pub fn rate(stage: impl RateStage<D>) -> Self {
        let writes = AnyRate::writes(&stage);
        Self(Kind::Rate(Arc::new(stage), writes))
    }

    /// An update stage.
    pub fn update(stage: impl UpdateStage<D>) -> Self {
        let shifts = AnyUpdate::shifts(&stage).into_iter().collect();
        Self(Kind::Update(Arc::new(stage), Arc::new(shifts)))
    }

    /// A whole-domain stage, a linear solve say: all workers come back before it, so that there is no
    /// running ahead past it.
    pub fn whole(stage: impl WholeStage<D> + 'static) -> Self {
        let name = stage.name().to_owned();
        Self(Kind::Whole(Arc::new(SharedWhole { name, stage: Mutex::new(Box::new(stage)) })))
    }

    /// The stage's name.
    pub fn name(&self) -> &str {
        match &self.0 {
            Kind::Rate(stage, _) => stage.name(),
            Kind::Update(stage, _) => stage.name(),
            Kind::Whole(stage) => &stage.name,
        }
    }

    pub(super) fn is_same(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Kind::Rate(a, _), Kind::Rate(b, _)) => Arc::ptr_eq(a, b),
            (Kind::Update(a, _), Kind::Update(b, _)) => Arc::ptr_eq(a, b),
            (Kind::Whole(a), Kind::Whole(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }

    pub(crate) fn is_rate(&self) -> bool {
        matches!(self.0, Kind::Rate(..))
    }

    pub(crate) fn is_update(&self) -> bool {
        matches!(self.0, Kind::Update(..))
    }

    pub(crate) fn is_whole(&self) -> bool {
        matches!(self.0, Kind::Whole(_))
    }

    pub(crate) fn writes(&self) -> ColumnSet {
        match &self.0 {
            Kind::Rate(_, writes) => *writes,
            Kind::Update(..) | Kind::Whole(_) => ColumnSet::default(),
        }
    }

    /// Columns that it owns with an offset, each with the shift.
    pub(crate) fn shifts(&self) -> &Shifts {
        match &self.0 {
            Kind::Update(_, shifts) => shifts,
            Kind::Rate(..) | Kind::Whole(_) => Shifts::NONE,
        }
    }

    pub(crate) fn scratch(&self) -> Box<dyn Any + Send> {
        match &self.0 {
            Kind::Rate(stage, _) => stage.scratch(),
            Kind::Update(stage, _) => stage.scratch(),
            Kind::Whole(_) => Box::new(()),
        }
    }

    /// Runs a rate stage.
    pub(crate) fn run_rate(
        &self,
        near: &Near<'_, D>,
        rates: &mut Rates<'_, D>,
        scratch: &mut dyn Any,
        moment: &Moment,
    ) -> Result<(), Fault> {
        match &self.0 {
            Kind::Rate(stage, _) => stage.rate(near, rates, scratch, moment),
            _ => unreachable!("parts never mix kinds"),
        }
    }

    /// Runs an update stage.
    pub(crate) fn run_update(
        &self,
        own: &mut Own<'_, D>,
        scratch: &mut dyn Any,
        moment: &Moment,
    ) -> Result<(), Fault> {
        match &self.0 {
            Kind::Update(stage, _) => stage.update(own, scratch, moment),
            _ => unreachable!("parts never mix kinds"),
        }
    }

    /// Runs a whole-domain stage.
    pub(crate) fn run_whole(&self, whole: &mut Whole<'_, D>) -> Result<(), Fault> {
        match &self.0 {
            Kind::Whole(stage) => {
                stage.stage.lock().unwrap_or_else(PoisonError::into_inner).run(whole)
            }
            _ => unreachable!("parts never mix kinds"),
        }
    }
}
