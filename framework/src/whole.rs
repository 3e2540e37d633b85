//! Whole-domain work between parts: re-sorting, time step control, a linear solve, anything that needs to see or
//! change everything at once. Named as a kind of its own because it is where workers meet.

use crate::activity::UNWATCHED;
use crate::columns::{ColumnSet, Columns};
use crate::domain::Domain;
use crate::notes::Notebook;
use crate::stage::Fault;
use crate::team::Team;
use crate::view::{Near, Place, Shifts, Slot, slots_of};

/// Everything, for one worker at a time, with a team to work with.
pub struct Whole<'a, D: Domain> {
    /// The divided space; may be divided anew.
    pub domain: &'a mut D,
    /// All columns.
    pub columns: &'a mut Columns,
    /// Workers for internally parallel work.
    pub team: &'a mut Team,
    /// Number of steps done.
    pub step: u64,
    /// Present time; inside a step, that of the stage.
    pub time: f64,
    /// Length of the present step; between steps that of the last, and 0 before the first.
    pub dt: f64,
    pub(crate) partials: &'a mut Partials,
}

/// Memory that reductions reuse.
#[derive(Default)]
pub(crate) struct Partials {
    values: Vec<f64>,
    slots: Vec<Slot>,
}

impl<D: Domain> Whole<'_, D> {
    /// Reduces `N` numbers over all sub-domains.
    ///
    /// Every sub-domain contributes what `partial` computes from it, in parallel; the
    /// contributions are combined in order of sub-domain, so the result has the same bits for any
    /// number of workers.
    ///
    /// # Panics
    /// If `partial` does.
    pub fn reduce<const N: usize>(
        &mut self,
        identity: [f64; N],
        partial: impl Fn(&Near<'_, D>) -> [f64; N] + Sync,
        combine: impl Fn(f64, f64) -> f64,
    ) -> [f64; N] {
        let mut total = identity;
        let partials = self.partials(N, &|near, values| values.copy_from_slice(&partial(near)));
        for contribution in partials.chunks_exact(N) {
            for (total, &x) in total.iter_mut().zip(contribution) {
                *total = combine(*total, x);
            }
        }
        total
    }

    /// What every sub-domain contributes, `each` numbers; compiled once for a domain.
    fn partials(
        &mut self,
        each: usize,
        partial: &(dyn Fn(&Near<'_, D>, &mut [f64]) + Sync),
    ) -> &[f64] {
        let partition = self.domain.partition();
        assert!(partition.is_sealed(), "the domain's partition is not sealed");
        assert_eq!(partition.points(), self.columns.points());
        let Partials { values, slots } = &mut *self.partials;
        slots_of(self.columns, slots);
        values.clear();
        values.resize(partition.len() * each, 0.0);
        let (domain, columns, slots) = (&*self.domain, &*self.columns, &**slots);
        self.team.for_each_chunk(values, each, |id, values| {
            let (shifts, displaced) = (Shifts::NONE, ColumnSet::default());
            let (notebook, activity) = (Notebook::EMPTY, &UNWATCHED);
            let place = Place {
                domain,
                partition,
                id,
                columns,
                slots,
                shifts,
                displaced,
                notebook,
                activity,
            };
            // SAFETY: the partition is sealed and has as many points as the columns, which are
            // borrowed exclusively here; nobody writes any of them during the reduction.
            let near = unsafe { Near::new(place, ColumnSet::default()) };
            partial(&near, values);
        });
        values
    }

    /// Sums `N` numbers over all sub-domains; see [`Whole::reduce`].
    pub fn sum<const N: usize>(
        &mut self,
        partial: impl Fn(&Near<'_, D>) -> [f64; N] + Sync,
    ) -> [f64; N] {
        self.reduce([0.0; N], partial, |a, b| a + b)
    }

    /// Largest of `N` numbers over all sub-domains, NaN if there is one; see [`Whole::reduce`].
    pub fn max<const N: usize>(
        &mut self,
        partial: impl Fn(&Near<'_, D>) -> [f64; N] + Sync,
    ) -> [f64; N] {
        self.reduce([f64::NEG_INFINITY; N], partial, |a, b| if a > b || a.is_nan() { a } else { b })
    }
}

/// A stage over the whole domain, run at the beginning of every [`Pace`] or, as one of the stages of
/// a step, inside every step ([`crate::Stage::whole`]).
pub trait WholeStage<D: Domain>: Send {
    /// Name for error messages and traces.
    fn name(&self) -> &str;

    /// Does its work.
    ///
    /// # Errors
    /// If the state makes no sense; ends the run.
    fn run(&mut self, whole: &mut Whole<'_, D>) -> Result<(), Fault>;
}

/// How time goes on from here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Time step.
    pub dt: f64,
    /// For how many steps, until whole-domain work is due again.
    pub steps: u64,
}

/// Time step control.
///
/// A pace holds for a number of steps, the same whatever the schedule: that is what lets
/// `PeerToPeer` run several steps without a meeting and still give the same bits.
pub trait Pacing<D: Domain>: Send {
    /// The pace from here on; must follow from the state alone, so that a restarted run keeps it.
    ///
    /// # Errors
    /// If no time step is stable, say.
    fn pace(&mut self, whole: &mut Whole<'_, D>) -> Result<Pace, Fault>;

    /// Whether steps may be made a little shorter, so that one ends at the end time. A method whose
    /// time step is tied to its grid says no; its run then ends with the first step that reaches
    /// the end time.
    fn may_shorten(&self) -> bool {
        true
    }
}

/// The same time step always, and no whole-domain work.
#[derive(Clone, Copy, Debug)]
pub struct FixedPace(pub f64);

impl<D: Domain> Pacing<D> for FixedPace {
    fn pace(&mut self, _: &mut Whole<'_, D>) -> Result<Pace, Fault> {
        if self.0 > 0.0 && self.0.is_finite() {
            Ok(Pace { dt: self.0, steps: u64::MAX })
        } else {
            Err(Fault::new(format!("time step {} must be positive and finite", self.0)))
        }
    }
}

/// As [`FixedPace`], and never shortened to hit an end time.
#[derive(Clone, Copy, Debug)]
pub struct RigidPace(pub f64);

impl<D: Domain> Pacing<D> for RigidPace {
    fn pace(&mut self, whole: &mut Whole<'_, D>) -> Result<Pace, Fault> {
        FixedPace(self.0).pace(whole)
    }

    fn may_shorten(&self) -> bool {
        false
    }
}
