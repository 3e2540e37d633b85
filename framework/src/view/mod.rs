//! What a stage may see and touch: disjoint parts cut from shared columns.
//!
//! This is one of the few modules with `unsafe`. The argument, once for all of it:
//!
//! * A [`Partition`] is sealed: every point has one owner. Parts of different sub-domains
//!   never share an element.
//! * A schedule runs sub-domain `i`'s part `p` of a step only when `i` and all its neighbours
//!   have finished part `p - 1`, and lets none of them begin part `p + 1` before `i` has
//!   finished `p`. So whatever runs beside it *within sight* runs the same part `p`.
//! * In a rate part, everybody writes only columns in `writes` and reads from others only
//!   columns that are not. In an update part, everybody touches only what it owns.
//!
//! * A stage may own the points of a column by a shift of the partition instead. Shifts are sealed,
//!   too: parts are as disjoint, and whoever ever touches an element is its usual owner or a
//!   neighbour of that one, so that the second point orders them as it orders neighbours. (If the same
//!   memory had two shifts, owners could be two apart; a step refuses that.) Reading from a
//!   neighbour reaches what *its* neighbours own by the shift, two apart, so memory that has a shift is
//!   read by owners only. A stage that has shifts is a part of its own.
//!
//! * What a stage writes past the caches is behind a fence before the worker tells anybody that it has run it
//!   (`Work::fence`); until then only that worker sees it, in order.
//!
//! Hence no element that is being written is visible to anybody else. What a stage author
//! could get wrong (a column both read from neighbours and written, a span that is not a
//! neighbour's, one column borrowed twice) is checked here and panics, which the run reports
//! as an error of that stage.

mod near;
mod own;
mod part;
mod shifts;

pub use near::{Near, Reach, View};
pub use own::{Own, Rates};
pub use part::{Part, PartMut};

pub(crate) use shifts::Shifts;

use crate::activity::Activity;
use crate::columns::{ColumnId, ColumnSet, Columns, Element, ElementKind};
use crate::domain::{Partition, Span};
use crate::notes::Notebook;

/// Address and element type of one column's memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    address: *mut u8,
    kind: ElementKind,
}

// SAFETY: a slot is only an address; every access through it is in this module and argued there.
unsafe impl Send for Slot {}
// SAFETY: as for `Send`.
unsafe impl Sync for Slot {}

/// Writes the slots of all columns, in order of their ids, into `slots`.
pub(crate) fn slots_of(columns: &mut Columns, slots: &mut Vec<Slot>) {
    slots.clear();
    slots.extend(columns.addresses().map(|(address, kind)| Slot { address, kind }));
}

/// A sub-domain with the memory that its stages are to work on.
pub(crate) struct Place<'a, D> {
    pub domain: &'a D,
    pub partition: &'a Partition,
    pub id: usize,
    /// The columns' declarations.
    pub columns: &'a Columns,
    pub slots: &'a [Slot],
    /// What is owned with an offset, and by which shift of the partition.
    pub shifts: &'a Shifts,
    /// What has an offset somewhere in the step.
    pub displaced: ColumnSet,
    /// What sub-domains note for themselves.
    pub notebook: &'a Notebook,
    /// What the worker that works on it is doing.
    pub activity: &'a Activity,
}

impl<D> Clone for Place<'_, D> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<D> Copy for Place<'_, D> {}

impl<'a, D> Place<'a, D> {
    /// The points of a column that the sub-domain owns.
    fn spans(&self, column: ColumnId) -> &'a [Span] {
        match self.shifts.of(column) {
            Some(shift) => self.partition.shifted(shift, self.id),
            None => self.partition.spans(self.id),
        }
    }

    /// Name of a column, for messages.
    fn name(&self, id: ColumnId) -> &'a str {
        self.columns
            .iter()
            .nth(id.0 as usize)
            .map_or("of other columns", |(_, column)| column.name())
    }

    fn base<T: Element>(&self, id: ColumnId) -> *mut T {
        let slot = self.slots.get(id.0 as usize).filter(|slot| slot.kind == T::KIND);
        match slot {
            Some(slot) => slot.address.cast(),
            None => panic!("the handle of column number {} belongs to other columns", id.0),
        }
    }
}
