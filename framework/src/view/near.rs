//! What a rate stage reads: own and neighbours' parts. The argument for its `unsafe` is the
//! [parent's](super).

use std::marker::PhantomData;

use super::{Part, Place};
use crate::activity::Activity;
use crate::columns::{ColumnSet, Element, Handle, Rate, State};
use crate::domain::{Domain, Partition, Span};

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

    /// What the worker is doing: for stages that tell a sampler ([`Activities::sample`]).
    ///
    /// [`Activities::sample`]: crate::Activities::sample
    pub fn activity(&self) -> &'a Activity {
        self.place.activity
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
    /// If the handle belongs to other columns, or the column is owned with an offset in this step
    /// ([`crate::UpdateStage::shifts`]).
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
            "column {:?} is written by the stage that reads it from neighbours",
            self.place.name(column.id())
        );
        assert!(
            !self.place.displaced.contains(column.id()),
            "column {:?} is owned with an offset in this step and so not seen by neighbours",
            self.place.name(column.id())
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
        // SAFETY: the spans are the sub-domain's own and so inside the column; `Near::new` promises
        // that nobody writes there during `'a`.
        unsafe { Part::new(self.base, self.partition.spans(self.id)) }
    }
}
