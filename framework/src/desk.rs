//! What the workers have at hand while a leg runs.

use std::any::Any;
use std::sync::{Mutex, TryLockError};

use crate::activity::Activities;
use crate::columns::{ColumnId, Columns, Role};
use crate::domain::Domain;
use crate::step::{Step, Stretch};
use crate::view::{Slot, slots_of};

/// Working memory of one worker, for every stage of a step.
pub(crate) type Scratch = Vec<Box<dyn Any + Send>>;

fn scratch_for<D: Domain>(step: &Step<D>) -> Scratch {
    step.stages.iter().map(|stage| stage.scratch()).collect()
}

/// Memory that legs reuse, so that a leg does not allocate.
pub(crate) struct Desk {
    /// Every worker has its own: the locks are never contended.
    scratch: Vec<Mutex<Scratch>>,
    slots: Vec<Slot>,
    /// Per set of swapped pairs that occurs, the slots in that order.
    tables: Vec<(u64, Vec<Slot>)>,
    /// State columns, to be checked to be finite.
    pub checked: Vec<ColumnId>,
    pub activities: Activities,
}

impl Desk {
    /// Memory for the legs of `step` on `workers` workers.
    ///
    /// # Panics
    /// If the step swaps columns of different types: its handles belong to other columns.
    pub fn new<D: Domain>(step: &Step<D>, columns: &Columns, workers: usize) -> Self {
        for &(a, b) in &step.pairs {
            let kinds = [a, b].map(|id| columns.column(id).kind());
            assert_eq!(kinds[0], kinds[1], "columns {a:?} and {b:?} are swapped");
        }
        let scratch = (0..workers).map(|_| Mutex::new(scratch_for(step))).collect();
        let mut keys = Vec::new();
        for stretch in &step.stretches {
            let Stretch::Parts(parts) = stretch else { continue };
            let base = step.swapped_before_part(parts.start);
            for parity in [0, step.swapped] {
                let entries = (0..step.entries.len()).map(Some).chain([None]);
                keys.extend(entries.map(|e| base ^ parity ^ step.swapped_before(e)));
            }
        }
        keys.sort_unstable();
        keys.dedup();
        Self {
            scratch,
            slots: Vec::new(),
            tables: keys.into_iter().map(|key| (key, Vec::new())).collect(),
            checked: columns
                .iter()
                .filter(|(_, c)| c.role() == Role::State)
                .map(|(id, _)| id)
                .collect(),
            activities: Activities::new(workers),
        }
    }

    /// Finds the columns' memory anew, before a leg.
    pub fn lay_out<D: Domain>(&mut self, step: &Step<D>, columns: &mut Columns) {
        slots_of(columns, &mut self.slots);
        for (key, table) in &mut self.tables {
            table.clone_from(&self.slots);
            for (k, (a, b)) in step.pairs.iter().enumerate() {
                if *key >> k & 1 == 1 {
                    table.swap(a.0 as usize, b.0 as usize);
                }
            }
        }
    }

    /// The slots after exchanging the pairs in `swapped`.
    pub fn slots(&self, swapped: u64) -> &[Slot] {
        let table = self.tables.iter().find(|(key, _)| *key == swapped);
        &table.expect("all sets that occur are laid out").1
    }

    /// Hands `task` the worker's scratch, one for each stage of `step`.
    pub fn with_scratch<D: Domain, R>(
        &self,
        step: &Step<D>,
        worker: usize,
        task: impl FnOnce(&mut Scratch) -> R,
    ) -> R {
        match self.scratch[worker].try_lock() {
            Ok(mut scratch) => task(&mut scratch),
            Err(TryLockError::Poisoned(scratch)) => task(&mut scratch.into_inner()),
            // A stage that is itself parallel waits, and rayon runs another sub-domain on its
            // thread meanwhile: that one needs a scratch of its own.
            Err(TryLockError::WouldBlock) => task(&mut scratch_for(step)),
        }
    }
}
