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
//! Hence no element that is being written is visible to anybody else. What a stage author
//! could get wrong (a column both read from neighbours and written, a span that is not a
//! neighbour's, one column borrowed twice) is checked here and panics, which the run reports
//! as an error of that stage.

use std::marker::PhantomData;

use crate::columns::{ColumnId, ColumnSet, Columns, Element, ElementKind, Handle, Rate, State};
use crate::domain::{Domain, Partition, Span};

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
    pub slots: &'a [Slot],
}

impl<D> Clone for Place<'_, D> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<D> Copy for Place<'_, D> {}

impl<D> Place<'_, D> {
    fn base<T: Element>(&self, id: ColumnId) -> *mut T {
        let slot = self.slots.get(id.0 as usize).filter(|slot| slot.kind == T::KIND);
        match slot {
            Some(slot) => slot.address.cast(),
            None => panic!("column handle {} belongs to other columns", id.0),
        }
    }
}

/// Points of the sub-domain itself or of a neighbour, checked by [`Near::reach`].
#[derive(Clone, Copy)]
pub struct Reach<'a> {
    span: Span,
    /// From where they are seen: a number alone could be another domain's sub-domain.
    partition: &'a Partition,
    id: usize,
}

impl std::fmt::Debug for Reach<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Reach({:?} from {})", self.span, self.id)
    }
}

impl Reach<'_> {
    /// The points.
    pub fn span(&self) -> Span {
        self.span
    }
}

/// What a rate stage may see: its own part and its neighbours' parts, read only.
pub struct Near<'a, D: Domain> {
    place: Place<'a, D>,
    writes: ColumnSet,
}

impl<D: Domain> Clone for Near<'_, D> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<D: Domain> Copy for Near<'_, D> {}

impl<'a, D: Domain> Near<'a, D> {
    /// # Safety
    /// `place.partition` is sealed and every slot addresses `partition.points()` elements of its
    /// kind. As long as `'a` lasts, nobody writes columns outside `writes` in the spans of the
    /// sub-domain and its neighbours.
    pub(crate) unsafe fn new(place: Place<'a, D>, writes: ColumnSet) -> Self {
        Self { place, writes }
    }

    /// The divided space.
    pub fn domain(&self) -> &'a D {
        self.place.domain
    }

    /// The sub-domain whose rates are wanted.
    pub fn sub_domain(&self) -> D::SubDomain<'a> {
        self.place.domain.sub_domain(self.place.id)
    }

    /// Its number.
    pub fn id(&self) -> usize {
        self.place.id
    }

    /// The points it owns.
    pub fn spans(&self) -> &'a [Span] {
        self.place.partition.spans(self.place.id)
    }

    /// Its neighbours, ascending.
    pub fn neighbours(&self) -> &'a [u32] {
        self.place.partition.neighbours(self.place.id)
    }

    /// Makes points of the sub-domain itself or of a neighbour readable.
    ///
    /// # Panics
    /// If `owner` is neither, or does not own all of `span`.
    pub fn reach(&self, owner: usize, span: Span) -> Reach<'a> {
        let Place { partition, id, .. } = self.place;
        assert!(
            owner < partition.len() && partition.sees(id, owner),
            "sub-domain {id} reads sub-domain {owner}, which is not its neighbour"
        );
        assert!(
            span.start <= span.end
                && partition
                    .spans(owner)
                    .iter()
                    .any(|s| s.start <= span.start && span.end <= s.end),
            "sub-domain {id} reads points {span:?}, which sub-domain {owner} does not own"
        );
        Reach { span, partition, id }
    }

    /// A state column, as far as it can be seen from here.
    ///
    /// # Panics
    /// If the handle belongs to other columns.
    pub fn state<T: Element>(&self, column: State<T>) -> View<'a, T> {
        self.view(column)
    }

    /// A rate column that an earlier stage of this step wrote, as far as it can be seen from
    /// here.
    ///
    /// # Panics
    /// If this stage itself writes the column: that would be a race. If the handle belongs to
    /// other columns.
    pub fn rate<T: Element>(&self, column: Rate<T>) -> View<'a, T> {
        self.view(column)
    }

    fn view<H: Handle>(&self, column: H) -> View<'a, H::Element> {
        assert!(
            !self.writes.contains(column.id()),
            "column {} is written by the stage that reads it from neighbours",
            column.id().0
        );
        let Place { partition, id, .. } = self.place;
        View { base: self.place.base(column.id()), partition, id, near: PhantomData }
    }
}

/// One column, read only, as far as it can be seen from one sub-domain.
#[derive(Clone, Copy)]
pub struct View<'a, T> {
    base: *const T,
    partition: &'a Partition,
    id: usize,
    near: PhantomData<&'a [T]>,
}

impl<'a, T> View<'a, T> {
    /// Values at points that [`Near::reach`] has checked.
    ///
    /// # Panics
    /// If `reach` was checked for another sub-domain.
    #[inline]
    pub fn at(&self, reach: Reach<'a>) -> &'a [T] {
        assert!(
            reach.id == self.id && std::ptr::eq(reach.partition, self.partition),
            "reach of another sub-domain"
        );
        // SAFETY: the span is owned by this sub-domain or a neighbour (`Near::reach`) and so
        // lies inside the column; `Near::new` promises that nobody writes there during `'a`.
        unsafe { std::slice::from_raw_parts(self.base.add(reach.span.start), reach.span.len()) }
    }

    /// The sub-domain's own values.
    pub fn own(&self) -> Part<'a, T> {
        Part { base: self.base, spans: self.partition.spans(self.id), part: PhantomData }
    }
}

/// A sub-domain's own part of one column, read only.
#[derive(Clone, Copy)]
pub struct Part<'a, T> {
    base: *const T,
    spans: &'a [Span],
    part: PhantomData<&'a [T]>,
}

impl<'a, T> Part<'a, T> {
    /// Values of span `k` of the sub-domain.
    ///
    /// # Panics
    /// If there is no such span.
    #[inline]
    pub fn span(&self, k: usize) -> &'a [T] {
        let span = self.spans[k];
        // SAFETY: the span is the sub-domain's own; nobody writes there during `'a`.
        unsafe { std::slice::from_raw_parts(self.base.add(span.start), span.len()) }
    }

    /// All values of a sub-domain that owns one span.
    ///
    /// # Panics
    /// If it owns several.
    #[inline]
    pub fn whole(&self) -> &'a [T] {
        assert_eq!(self.spans.len(), 1, "the sub-domain owns several spans");
        self.span(0)
    }
}

/// A sub-domain's own part of one column, to be written.
pub struct PartMut<'a, T> {
    base: *mut T,
    spans: &'a [Span],
    part: PhantomData<&'a mut [T]>,
}

impl<'a, T> PartMut<'a, T> {
    /// Number of spans.
    pub fn spans(&self) -> usize {
        self.spans.len()
    }

    /// Values of span `k` of the sub-domain.
    ///
    /// # Panics
    /// If there is no such span.
    #[inline]
    pub fn span(&mut self, k: usize) -> &mut [T] {
        let span = self.spans[k];
        // SAFETY: the span is the sub-domain's own, this is the only borrow of the column
        // (`Exclusive`), and it is borrowed for as long as the result lives.
        unsafe { std::slice::from_raw_parts_mut(self.base.add(span.start), span.len()) }
    }

    /// All values of a sub-domain that owns one span.
    ///
    /// # Panics
    /// If it owns several.
    #[inline]
    pub fn whole(self) -> &'a mut [T] {
        assert_eq!(self.spans.len(), 1, "the sub-domain owns several spans");
        let span = self.spans[0];
        // SAFETY: as in `span`; `self` is consumed, so this stays the only borrow during `'a`.
        unsafe { std::slice::from_raw_parts_mut(self.base.add(span.start), span.len()) }
    }
}

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
            "column {} is already borrowed",
            id.0
        );
    }
}

/// A sub-domain's own part of the rates, to be written by a rate stage.
pub struct Rates<'a, D: Domain> {
    place: Place<'a, D>,
    writes: ColumnSet,
    borrows: Borrows,
}

impl<'a, D: Domain> Rates<'a, D> {
    /// # Safety
    /// As [`Near::new`] for the partition and slots. As long as `'a` lasts, nobody else touches
    /// the columns in `writes` in the sub-domain's spans.
    pub(crate) unsafe fn new(place: Place<'a, D>, writes: ColumnSet) -> Self {
        Self { place, writes, borrows: Borrows::default() }
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
        PartMut {
            base: self.place.base(column.id()),
            spans: self.place.partition.spans(self.place.id),
            part: PhantomData,
        }
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

    /// The points it owns.
    pub fn spans(&self) -> &'a [Span] {
        self.place.partition.spans(self.place.id)
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
        Part { base: self.place.base(id), spans: self.spans(), part: PhantomData }
    }

    /// Own part of any column, to be written; panics as [`Own::state_mut`].
    pub(crate) fn part_mut<T: Element>(&mut self, id: ColumnId) -> PartMut<'a, T> {
        self.borrows.claim(id);
        PartMut { base: self.place.base(id), spans: self.spans(), part: PhantomData }
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

    /// Whether all own values of a column are finite; integers always are.
    pub(crate) fn is_finite(&self, id: ColumnId) -> bool {
        fn all_finite<T: num_traits::Float + Element, D: Domain>(
            own: &Own<'_, D>,
            id: ColumnId,
        ) -> bool {
            let part = Part {
                base: own.place.base::<T>(id).cast_const(),
                spans: own.spans(),
                part: PhantomData,
            };
            // x * 0 is 0 for finite x and NaN otherwise; eight sums, so that it vectorises.
            (0..own.spans().len()).all(|k| {
                let values = part.span(k);
                let (chunks, rest) = values.as_chunks::<8>();
                let mut sums = [T::zero(); 8];
                for chunk in chunks {
                    for (sum, &x) in sums.iter_mut().zip(chunk) {
                        *sum = *sum + x * T::zero();
                    }
                }
                sums.iter().chain(rest).all(|x| x.is_finite())
            })
        }
        match self.place.slots[id.0 as usize].kind {
            ElementKind::F32 => all_finite::<f32, D>(self, id),
            ElementKind::F64 => all_finite::<f64, D>(self, id),
            _ => true,
        }
    }
}
