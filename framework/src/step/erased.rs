//! Stages whose scratch type is forgotten, so that a step can hold any of them.

use std::any::Any;

use crossbeam_utils::CachePadded;

use crate::columns::{ColumnId, ColumnSet};
use crate::domain::Domain;
use crate::stage::{Fault, Moment, RateStage, UpdateStage};
use crate::view::{Near, Own, Rates};

/// A rate stage whose scratch type is forgotten.
pub(super) trait AnyRate<D: Domain>: Send + Sync {
    fn name(&self) -> &str;
    fn writes(&self) -> ColumnSet;
    fn scratch(&self) -> Box<dyn Any + Send>;
    fn rate(
        &self,
        near: &Near<'_, D>,
        rates: &mut Rates<'_, D>,
        scratch: &mut dyn Any,
        moment: &Moment,
    ) -> Result<(), Fault>;
}

/// An update stage whose scratch type is forgotten.
pub(super) trait AnyUpdate<D: Domain>: Send + Sync {
    fn name(&self) -> &str;
    fn shifts(&self) -> Vec<(ColumnId, usize)>;
    fn scratch(&self) -> Box<dyn Any + Send>;
    fn update(
        &self,
        own: &mut Own<'_, D>,
        scratch: &mut dyn Any,
        moment: &Moment,
    ) -> Result<(), Fault>;
}

/// A scratch that shares no cache line with another worker's: stages write to theirs all the time.
fn new_scratch<S: Default + Send + 'static>() -> Box<dyn Any + Send> {
    Box::new(CachePadded::new(S::default()))
}

/// The scratch that this very stage made.
fn own_scratch<S: 'static>(scratch: &mut dyn Any) -> &mut S {
    scratch.downcast_mut::<CachePadded<S>>().expect("a stage is handed the scratch it made")
}

impl<D: Domain, S: RateStage<D>> AnyRate<D> for S {
    fn name(&self) -> &str {
        RateStage::name(self)
    }
    fn writes(&self) -> ColumnSet {
        RateStage::writes(self).into_iter().collect()
    }
    fn scratch(&self) -> Box<dyn Any + Send> {
        new_scratch::<S::Scratch>()
    }
    fn rate(
        &self,
        near: &Near<'_, D>,
        rates: &mut Rates<'_, D>,
        scratch: &mut dyn Any,
        moment: &Moment,
    ) -> Result<(), Fault> {
        RateStage::rate(self, near, rates, own_scratch(scratch), moment)
    }
}

impl<D: Domain, S: UpdateStage<D>> AnyUpdate<D> for S {
    fn name(&self) -> &str {
        UpdateStage::name(self)
    }
    fn shifts(&self) -> Vec<(ColumnId, usize)> {
        UpdateStage::shifts(self)
    }
    fn scratch(&self) -> Box<dyn Any + Send> {
        new_scratch::<S::Scratch>()
    }
    fn update(
        &self,
        own: &mut Own<'_, D>,
        scratch: &mut dyn Any,
        moment: &Moment,
    ) -> Result<(), Fault> {
        UpdateStage::update(self, own, own_scratch(scratch), moment)
    }
}
