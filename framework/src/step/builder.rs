//! Builds a step stage by stage.

use super::{Entry, Stage, Step, Stretch};
use crate::columns::{ColumnId, ColumnSet, Element, Handle, Rate, State};
use crate::domain::Domain;
use crate::stage::{RateStage, UpdateStage};
use crate::view::Shifts;

/// Builds a [`Step`] stage by stage.
#[must_use]
pub struct StepBuilder<D: Domain> {
    step: Step<D>,
}

impl<D: Domain> Step<D> {
    /// Begins an empty step.
    pub fn builder() -> StepBuilder<D> {
        StepBuilder {
            step: Self {
                stages: Vec::new(),
                entries: Vec::new(),
                part_start: Vec::new(),
                pairs: Vec::new(),
                swapped: 0,
                stretches: Vec::new(),
                displaced: ColumnSet::default(),
                last_shifts: Shifts::default(),
            },
        }
    }
}

impl<D: Domain> StepBuilder<D> {
    /// Adds a rate stage at the beginning of the step, `t`.
    pub fn rate(self, stage: impl RateStage<D>) -> Self {
        self.stage_at(0.0, &Stage::rate(stage))
    }

    /// Adds an update stage at the beginning of the step, `t`.
    pub fn update(self, stage: impl UpdateStage<D>) -> Self {
        self.stage_at(0.0, &Stage::update(stage))
    }

    /// Adds a stage at `t + c dt`; the same stage may be used several times.
    pub fn stage_at(mut self, c: f64, stage: &Stage<D>) -> Self {
        let step = &mut self.step;
        let known = step.stages.iter().position(|s| s.is_same(stage));
        let index = known.unwrap_or_else(|| {
            step.stages.push(stage.clone());
            step.stages.len() - 1
        });
        let is_plain = |stage: &Stage<D>| stage.is_update() && stage.shifts().is_empty();
        let joins_updates = is_plain(stage)
            && step.entries.last().is_some_and(|last| is_plain(&step.stages[last.stage]));
        if !joins_updates {
            step.part_start.push(step.entries.len());
        }
        step.entries.push(Entry { stage: index, c, swapped: step.swapped });
        self
    }

    /// Adds several stages at `t + c dt`.
    pub fn stages_at(self, c: f64, stages: &[Stage<D>]) -> Self {
        stages.iter().fold(self, |step, stage| step.stage_at(c, stage))
    }

    /// Exchanges the memory of a state and a rate column: what a rate stage computed *is* the
    /// next state (explicit stencils, lattice streaming). Costs nothing.
    ///
    /// # Panics
    /// If one of the columns is exchanged with a third one elsewhere in the step.
    pub fn swap<T: Element>(self, state: State<T>, rate: Rate<T>) -> Self {
        self.exchange(state.id(), rate.id())
    }

    /// Exchanges the memory of two rate columns: the present rates become the last ones.
    ///
    /// # Panics
    /// As [`StepBuilder::swap`]; if the two are the same.
    pub fn swap_rates<T: Element>(self, a: Rate<T>, b: Rate<T>) -> Self {
        self.exchange(a.id(), b.id())
    }

    /// Exchanges the memory of two state columns: what is advanced in place, each in the other's.
    ///
    /// # Panics
    /// As [`StepBuilder::swap_rates`].
    pub fn swap_states<T: Element>(self, a: State<T>, b: State<T>) -> Self {
        self.exchange(a.id(), b.id())
    }

    pub(crate) fn exchange(mut self, a: ColumnId, b: ColumnId) -> Self {
        assert_ne!(a, b, "a column is swapped with itself");
        let step = &mut self.step;
        let pair = (a.min(b), a.max(b));
        let index = step.pairs.iter().position(|&p| p == pair).unwrap_or_else(|| {
            assert!(
                step.pairs.iter().all(|&(x, y)| x != a && x != b && y != a && y != b),
                "a column is swapped with two different columns"
            );
            assert!(step.pairs.len() < 64, "more than 64 swapped pairs");
            step.pairs.push(pair);
            step.pairs.len() - 1
        });
        step.swapped ^= 1 << index;
        self
    }

    /// The step.
    ///
    /// # Panics
    /// If a column, or one that it is exchanged with, is owned with two different offsets.
    pub fn build(mut self) -> Step<D> {
        let step = &mut self.step;
        for (part, &start) in step.part_start.iter().enumerate() {
            match step.stretches.last_mut() {
                _ if step.stages[step.entries[start].stage].is_whole() => {
                    step.stretches.push(Stretch::Whole(part));
                }
                Some(Stretch::Parts(parts)) => parts.end = part + 1,
                _ => step.stretches.push(Stretch::Parts(part..part + 1)),
            }
        }
        step.part_start.push(step.entries.len());
        step.displace();
        self.step
    }
}
