//! A step: the ordered list of stages that advances time by dt.

mod builder;
mod erased;
mod stage;

pub use builder::StepBuilder;
pub use stage::Stage;

use std::ops::Range;

use crate::columns::{ColumnId, ColumnSet, Columns};
use crate::domain::Domain;
use crate::view::Shifts;

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
    pub(super) fn displace(&mut self) {
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
