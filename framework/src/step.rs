//! A step: the ordered list of stages that advances time by dt.

use std::any::Any;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use crate::columns::{ColumnId, ColumnSet, Columns, Handle, Rate, State};
use crate::domain::Domain;
use crate::stage::{Fault, Moment, RateStage, UpdateStage};
use crate::view::{Near, Own, Rates, Shifts};
use crate::whole::{Whole, WholeStage};

/// A rate stage whose scratch type is forgotten.
trait AnyRate<D: Domain>: Send + Sync {
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
trait AnyUpdate<D: Domain>: Send + Sync {
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

/// The scratch that this very stage made.
fn own_scratch<S: 'static>(scratch: &mut dyn Any) -> &mut S {
    scratch.downcast_mut().expect("a stage is handed the scratch it made")
}

impl<D: Domain, S: RateStage<D>> AnyRate<D> for S {
    fn name(&self) -> &str {
        RateStage::name(self)
    }
    fn writes(&self) -> ColumnSet {
        RateStage::writes(self).into_iter().collect()
    }
    fn scratch(&self) -> Box<dyn Any + Send> {
        Box::new(S::Scratch::default())
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
        Box::new(S::Scratch::default())
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

    fn is_same(&self, other: &Self) -> bool {
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

/// One use of a stage in a step.
pub(crate) struct Entry {
    /// Index into the step's stages.
    pub stage: usize,
    /// The stage runs at `t + c dt`.
    pub c: f64,
    /// For each swapped pair, whether it has been exchanged an odd number of times in this step
    /// before this entry: bit `k` for pair `k`.
    pub swapped: u64,
}

/// A step: parts in order, each one rate stage, update stages in a row, or a whole-domain stage.
///
/// Everybody may run a part once all neighbours have finished the part before; update stages in a
/// row need no meeting between them, so they are one part, unless they own columns with an offset. Before and after a whole-domain stage
/// all meet: it cuts the step into stretches.
pub struct Step<D: Domain> {
    pub(crate) stages: Vec<Stage<D>>,
    pub(crate) entries: Vec<Entry>,
    /// Part `p` is `entries[part_start[p]..part_start[p + 1]]`.
    pub(crate) part_start: Vec<usize>,
    pub(crate) pairs: Vec<(ColumnId, ColumnId)>,
    /// Pairs exchanged an odd number of times in a whole step.
    pub(crate) swapped: u64,
    /// What is done in one go.
    pub(crate) stretches: Vec<Stretch>,
    /// Columns of which the memory is owned with an offset somewhere in the step.
    pub(crate) displaced: ColumnSet,
    /// What the workers' last part owned with an offset, by the names of columns after the step.
    pub(crate) last_shifts: Shifts,
}

/// Parts of a step that are done in one go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Stretch {
    /// By the workers, sub-domain by sub-domain.
    Parts(Range<usize>),
    /// Over the whole domain: one part.
    Whole(usize),
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

    /// Number of parts.
    pub fn parts(&self) -> usize {
        self.part_start.len() - 1
    }

    /// Name of a part: its stages' names.
    pub fn part_name(&self, part: usize) -> String {
        let entries = &self.entries[self.part_start[part]..self.part_start[part + 1]];
        let names: Vec<_> = entries.iter().map(|e| self.stages[e.stage].name()).collect();
        names.join(" + ")
    }

    /// What it consists of, in words: the stages in order, each with its time in the step.
    pub(crate) fn outline(&self) -> String {
        let stage = |e: &Entry| format!("{} at {}", self.stages[e.stage].name(), e.c);
        self.entries.iter().map(stage).collect::<Vec<_>>().join(", ")
    }

    /// Pairs exchanged an odd number of times in a step before `entry`; `None` for after the step's
    /// last stage.
    pub(crate) fn swapped_before(&self, entry: Option<usize>) -> u64 {
        entry.map_or(self.swapped, |e| self.entries[e].swapped)
    }

    /// The same before a part; one past the last for after the step's last stage.
    pub(crate) fn swapped_before_part(&self, part: usize) -> u64 {
        self.swapped_before(Some(self.part_start[part]).filter(|_| part < self.parts()))
    }

    /// Exchanges the memory of the pairs in `swapped`.
    pub(crate) fn exchange(&self, columns: &mut Columns, swapped: u64) {
        for (k, &(a, b)) in self.pairs.iter().enumerate() {
            if swapped >> k & 1 == 1 {
                columns.exchange(a, b);
            }
        }
    }

    /// Finds what is owned with an offset.
    fn displace(&mut self) {
        let mut by_memory: Vec<(ColumnId, usize)> = Vec::new();
        for (column, shift) in self.stages.iter().flat_map(|stage| stage.shifts().iter()) {
            for column in [Some(column), self.partner(column)].into_iter().flatten() {
                let other = by_memory.iter().find(|(known, s)| *known == column && *s != shift);
                assert!(other.is_none(), "column {} is owned with two offsets", column.0);
                by_memory.push((column, shift));
                self.displaced.insert(column);
            }
        }
        let Some(part) = self.last_of_workers() else { return };
        let last = &self.entries[self.part_start[part + 1] - 1];
        let exchanged = last.swapped ^ self.swapped_before_part(part + 1);
        let renamed = |column: ColumnId| {
            let is_it = |&(a, b): &(ColumnId, ColumnId)| a == column || b == column;
            let pair = self.pairs.iter().position(is_it).filter(|k| exchanged >> k & 1 == 1);
            pair.and_then(|_| self.partner(column)).unwrap_or(column)
        };
        let shifts = self.stages[last.stage].shifts();
        self.last_shifts = shifts.iter().map(|(column, shift)| (renamed(column), shift)).collect();
    }

    /// The column that a column is exchanged with.
    fn partner(&self, column: ColumnId) -> Option<ColumnId> {
        let pair = self.pairs.iter().find(|(a, b)| *a == column || *b == column);
        pair.map(|&(a, b)| if a == column { b } else { a })
    }

    /// Whether the workers have to come back in the middle of it.
    pub(crate) fn has_whole(&self) -> bool {
        self.stages.iter().any(Stage::is_whole)
    }

    /// The last part that workers run; `None` if there is none.
    pub(crate) fn last_of_workers(&self) -> Option<usize> {
        let last = |stretch: &Stretch| match stretch {
            Stretch::Parts(parts) => Some(parts.end - 1),
            Stretch::Whole(_) => None,
        };
        self.stretches.iter().rev().find_map(last)
    }
}

/// Builds a [`Step`] stage by stage.
#[must_use]
pub struct StepBuilder<D: Domain> {
    step: Step<D>,
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
    pub fn swap<T: crate::columns::Element>(self, state: State<T>, rate: Rate<T>) -> Self {
        self.exchange(state.id(), rate.id())
    }

    /// Exchanges the memory of two rate columns: the present rates become the last ones.
    ///
    /// # Panics
    /// As [`StepBuilder::swap`]; if the two are the same.
    pub fn swap_rates<T: crate::columns::Element>(self, a: Rate<T>, b: Rate<T>) -> Self {
        self.exchange(a.id(), b.id())
    }

    /// Exchanges the memory of two state columns: what is advanced in place, each in the other's.
    ///
    /// # Panics
    /// As [`StepBuilder::swap_rates`].
    pub fn swap_states<T: crate::columns::Element>(self, a: State<T>, b: State<T>) -> Self {
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
