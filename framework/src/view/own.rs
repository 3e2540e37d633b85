//! What a stage writes: own rates in a rate stage, own state in an update stage. The argument for
//! its `unsafe` is the [parent's](super).

use std::ops::DerefMut;

use super::{Part, PartMut, Place};
use crate::columns::{ColumnId, ColumnSet, Element, ElementKind, Handle, Rate, State};
use crate::domain::{Domain, Span};
use crate::notes::{Note, Notes};
use crate::pack::Bypass;

/// Which columns of one sub-domain have been borrowed, and how.
#[derive(Debug, Default, PartialEq)]
struct Borrows {
    shared: ColumnSet,
    exclusive: ColumnSet,
}

impl Borrows {
    fn share(&mut self, id: ColumnId) {
        assert!(!self.exclusive.contains(id), "column {} is already borrowed for writing", id.0);
        self.shared.insert(id);
    }

    fn claim(&mut self, id: ColumnId) {
        assert!(
            !self.shared.contains(id) && self.exclusive.insert(id),
            "column {} is already borrowed: a column is had once per call, before any loop",
            id.0
        );
    }
}

/// A sub-domain's own part of the rates, to be written by a rate stage.
pub struct Rates<'a, D: Domain> {
    place: Place<'a, D>,
    writes: ColumnSet,
    borrows: Borrows,
    bypass: Option<Bypass<'a>>,
}

impl<'a, D: Domain> Rates<'a, D> {
    /// # Safety
    /// As [`Near::new`] for the partition and slots. As long as `'a` lasts, nobody else touches
    /// the columns in `writes` in the sub-domain's spans.
    pub(crate) unsafe fn new(
        place: Place<'a, D>,
        writes: ColumnSet,
        bypass: Option<Bypass<'a>>,
    ) -> Self {
        Self { place, writes, borrows: Borrows::default(), bypass }
    }

    /// Leave to write past the caches; `None` unless all columns are far larger than these and
    /// the whole domain is stepped before anybody comes back to what is written here.
    pub(crate) fn bypass(&self) -> Option<Bypass<'a>> {
        self.bypass
    }

    /// The sub-domain's part of a rate column; each column can be had once per call.
    ///
    /// # Panics
    /// If the stage does not list the column in [`crate::RateStage::writes`], or has it already.
    pub fn column<T: Element>(&mut self, column: Rate<T>) -> PartMut<'a, T> {
        assert!(
            self.writes.contains(column.id()),
            "column {} is written but not listed in the stage's `writes`",
            column.id().0
        );
        self.borrows.claim(column.id());
        let spans = self.place.spans(column.id());
        // SAFETY: the spans are the sub-domain's own; `Rates::new` promises that nobody else touches
        // the column there, and `claim` that it is had only once.
        unsafe { PartMut::new(self.place.base(column.id()), spans) }
    }

    /// What the sub-domain has noted for itself, and may note for later stages of this step.
    ///
    /// # Panics
    /// If the handle belongs to other columns, or the notes are already borrowed.
    pub fn notes<T: Note>(&mut self, notes: Notes<T>) -> impl DerefMut<Target = T> + use<'a, T, D> {
        self.place.notebook.page(notes, self.place.id)
    }

    /// The divided space.
    pub fn domain(&self) -> &'a D {
        self.place.domain
    }

    /// Number of the sub-domain.
    pub fn id(&self) -> usize {
        self.place.id
    }
}

/// A sub-domain's own state, to be advanced by an update stage, and its own rates.
pub struct Own<'a, D: Domain> {
    place: Place<'a, D>,
    borrows: Borrows,
}

impl<'a, D: Domain> Own<'a, D> {
    /// # Safety
    /// As [`Near::new`] for the partition and slots. As long as `'a` lasts, nobody else touches
    /// the sub-domain's spans of any column.
    pub(crate) unsafe fn new(place: Place<'a, D>) -> Self {
        Self { place, borrows: Borrows::default() }
    }

    /// The divided space.
    pub fn domain(&self) -> &'a D {
        self.place.domain
    }

    /// The sub-domain.
    pub fn sub_domain(&self) -> D::SubDomain<'a> {
        self.place.domain.sub_domain(self.place.id)
    }

    /// Number of the sub-domain.
    pub fn id(&self) -> usize {
        self.place.id
    }

    /// The points it owns, but in columns with an offset.
    pub fn spans(&self) -> &'a [Span] {
        self.place.partition.spans(self.place.id)
    }

    /// Whether it owns other points of a column.
    pub(crate) fn is_shifted(&self, id: ColumnId) -> bool {
        self.place.shifts.of(id).is_some()
    }

    /// Own rates.
    ///
    /// # Panics
    /// If the handle belongs to other columns.
    pub fn rate<T: Element>(&mut self, column: Rate<T>) -> Part<'a, T> {
        self.shared(column)
    }

    /// Own state, read only.
    ///
    /// # Panics
    /// If the column is already borrowed for writing or the handle belongs to other columns.
    pub fn state<T: Element>(&mut self, column: State<T>) -> Part<'a, T> {
        self.shared(column)
    }

    /// Own state, to be advanced; each column can be had once per call.
    ///
    /// # Panics
    /// If the column is already borrowed or the handle belongs to other columns.
    pub fn state_mut<T: Element>(&mut self, column: State<T>) -> PartMut<'a, T> {
        self.part_mut(column.id())
    }

    fn shared<H: Handle>(&mut self, column: H) -> Part<'a, H::Element> {
        self.part(column.id())
    }

    /// Own part of any column, read only; panics as [`Own::state`].
    pub(crate) fn part<T: Element>(&mut self, id: ColumnId) -> Part<'a, T> {
        self.borrows.share(id);
        // SAFETY: the spans are the sub-domain's own; `Own::new` promises that nobody else touches
        // them, and `share` that the column is not borrowed for writing.
        unsafe { Part::new(self.place.base(id), self.place.spans(id)) }
    }

    /// Own part of any column, to be written; panics as [`Own::state_mut`].
    pub(crate) fn part_mut<T: Element>(&mut self, id: ColumnId) -> PartMut<'a, T> {
        self.borrows.claim(id);
        // SAFETY: as in `part`, with `claim` for the only borrow of the column.
        unsafe { PartMut::new(self.place.base(id), self.place.spans(id)) }
    }

    /// Element type of a column.
    pub(crate) fn kind(&self, id: ColumnId) -> ElementKind {
        self.place.slots[id.0 as usize].kind
    }

    /// The same own part with nothing borrowed, for as long as this one is not used.
    ///
    /// # Panics
    /// If something has been borrowed from this one: it might still be in use.
    pub(crate) fn reborrow(&mut self) -> Own<'_, D> {
        assert_eq!(self.borrows, Borrows::default(), "columns are borrowed");
        Own { place: self.place, borrows: Borrows::default() }
    }

    /// Whether all own values of a column are finite and within `most` of zero; integers always are.
    pub(crate) fn is_valid(&self, id: ColumnId, most: f64) -> bool {
        fn all_valid<T: num_traits::Float + Element, D: Domain>(
            own: &Own<'_, D>,
            id: ColumnId,
            most: f64,
        ) -> bool {
            assert!(!own.borrows.exclusive.contains(id), "column {} is being written", id.0);
            // SAFETY: as in `Own::part`; what is read here does not outlive this borrow of `own`.
            let part = unsafe { Part::new(own.place.base::<T>(id), own.place.spans(id)) };
            let most = T::from(most).map_or(T::max_value(), |most| most.min(T::max_value()));
            (0..own.place.spans(id).len()).all(|k| {
                let (chunks, rest) = part.span(k).as_chunks::<8>();
                // x * 0 is 0 for finite x and NaN otherwise; eight of all, so that it vectorises.
                let (mut sums, mut largest) = ([T::zero(); 8], [T::zero(); 8]);
                for chunk in chunks {
                    for ((sum, largest), &x) in sums.iter_mut().zip(&mut largest).zip(chunk) {
                        *sum = *sum + x * T::zero();
                        *largest = if x.abs() > *largest { x.abs() } else { *largest };
                    }
                }
                let is_within = |x: &T| x.abs() <= most;
                sums.iter().chain(&largest).chain(rest).all(is_within)
            })
        }
        match self.place.slots[id.0 as usize].kind {
            ElementKind::F32 => all_valid::<f32, D>(self, id, most),
            ElementKind::F64 => all_valid::<f64, D>(self, id, most),
            _ => true,
        }
    }
}
