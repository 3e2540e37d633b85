//! Divided space: how many sub-domains there are, which points each owns, and which are
//! neighbours.

mod shift;

use crate::columns::Columns;
use crate::stage::Fault;
use crate::view::Near;
use shift::Shift;

/// A half-open range of points that one sub-domain owns: `start..end` of every column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// First point.
    pub start: usize,
    /// One past the last point.
    pub end: usize,
}

impl Span {
    /// Number of points.
    pub fn len(self) -> usize {
        self.end - self.start
    }

    /// Whether it owns no point.
    pub fn is_empty(self) -> bool {
        self.start == self.end
    }

    /// As an index range.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start..self.end
    }
}

/// Divided space.
///
/// A domain describes itself by a [`Partition`], which is checked once when it is made:
/// nothing a domain does later can make two sub-domains own the same point. Geometry
/// (cells, rows) is the business of the domain's own [`SubDomain`] type.
pub trait Domain: Send + Sync + Sized + 'static {
    /// One piece of this space, with whatever geometry its stages need.
    type SubDomain<'a>: SubDomain
    where
        Self: 'a;

    /// Ownership and neighbourhood.
    fn partition(&self) -> &Partition;

    /// The sub-domain `id`, below `self.partition().len()`.
    fn sub_domain(&self, id: usize) -> Self::SubDomain<'_>;

    /// Asked before every rate stage of every sub-domain: is the division of space still
    /// right for the present state? Cells check here that no particle has left its cell by
    /// more than the skin allows, so that neighbourhoods are never silently stale.
    ///
    /// # Errors
    /// What is stale, and where.
    fn check(&self, _near: &Near<'_, Self>) -> Result<(), Fault> {
        Ok(())
    }

    /// What cannot be derived from the columns at an arbitrary step and must therefore be in
    /// a checkpoint, as plain numbers; empty for a space that never changes.
    fn save(&self) -> Vec<u64> {
        Vec::new()
    }

    /// Takes back what [`Domain::save`] gave, with the columns already restored.
    ///
    /// # Errors
    /// If the numbers do not fit this domain.
    fn restore(&mut self, saved: &[u64], _columns: &Columns) -> Result<(), Fault> {
        if saved.is_empty() {
            Ok(())
        } else {
            Err(Fault::new(
                "the checkpoint holds a division of space that this domain does not have",
            ))
        }
    }
}

/// One piece of a [`Domain`].
pub trait SubDomain {
    /// Its place in the partition: everything a schedule needs to know.
    fn piece(&self) -> Piece<'_>;

    /// Number of the sub-domain.
    fn id(&self) -> usize {
        self.piece().id
    }

    /// Number of points it owns.
    fn points(&self) -> usize {
        self.piece().spans.iter().map(|s| s.len()).sum()
    }
}

/// A sub-domain as the partition knows it.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// Number of the sub-domain.
    pub id: usize,
    /// The points it owns.
    pub spans: &'a [Span],
    /// The other sub-domains whose state its rates may read, ascending.
    pub neighbours: &'a [u32],
}

impl SubDomain for Piece<'_> {
    fn piece(&self) -> Piece<'_> {
        *self
    }
}

/// Why a partition was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PartitionError {
    /// Two spans share a point, or a span is reversed.
    #[error("spans {first:?} and {second:?} overlap: a point must have one owner")]
    Overlap {
        /// One span.
        first: Span,
        /// The other.
        second: Span,
    },
    /// A span lies past the last point.
    #[error("span {span:?} ends past the last of {points} points")]
    Outside {
        /// The span.
        span: Span,
        /// Points there are.
        points: usize,
    },
    /// Some points belong to nobody.
    #[error("{owned} of {points} points are owned by a sub-domain; all must be")]
    Unowned {
        /// Points that have an owner.
        owned: usize,
        /// Points there are.
        points: usize,
    },
    /// `a` names `b` as a neighbour but not the reverse, or itself, or twice.
    #[error(
        "sub-domain {a} lists {b} as a neighbour: neighbours must be other, distinct, ascending and mutual"
    )]
    Neighbours {
        /// Who lists.
        a: usize,
        /// Who is listed.
        b: usize,
    },
    /// By a shift, somebody owns points of a sub-domain that is no neighbour.
    #[error(
        "by a shift sub-domain {id} owns points {span:?}, of which some are usually sub-domain {owner}'s, which is not its neighbour"
    )]
    Far {
        /// What it owns.
        span: Span,
        /// Who owns it.
        id: usize,
        /// Who owns some of it without the shift.
        owner: usize,
    },
}

/// Which points each sub-domain owns and which sub-domains are neighbours.
///
/// Checked by [`Partition::seal`]: every point has exactly one owner and neighbourhood is
/// mutual. Everything that lets sub-domains run beside one another rests on this, so the
/// framework takes it from here and not from the domain's own answers.
#[derive(Debug, Default)]
pub struct Partition {
    points: usize,
    spans: Vec<Span>,
    /// Sub-domain `i` owns `spans[span_start[i]..span_start[i + 1]]`.
    span_start: Vec<u32>,
    neighbours: Vec<u32>,
    neighbour_start: Vec<u32>,
    shifts: Vec<Shift>,
    strip: Option<usize>,
    sealed: bool,
    by_start: Vec<Span>,
}

impl Partition {
    /// An empty partition of `points` points, to be filled by [`Partition::push`].
    pub fn new(points: usize) -> Self {
        let mut partition = Self::default();
        partition.clear(points);
        partition
    }

    /// Forgets all sub-domains but keeps the memory, so that a space that is divided anew
    /// does not allocate.
    pub fn clear(&mut self, points: usize) {
        self.points = points;
        self.spans.clear();
        self.neighbours.clear();
        self.span_start.clear();
        self.span_start.push(0);
        self.neighbour_start.clear();
        self.neighbour_start.push(0);
        self.shifts.clear();
        self.strip = None;
        self.sealed = false;
    }

    /// Tells that sub-domains are numbered strip by strip, `width` side by side in each, instead of all that lie
    /// beside one another: who steps some of them ahead of others need not look further.
    pub fn number_in_strips(&mut self, width: usize) {
        self.strip = Some(width);
    }

    /// Sub-domains side by side in a strip, if they are numbered in strips.
    pub fn strip(&self) -> Option<usize> {
        self.strip
    }

    /// Adds the next sub-domain; `neighbours` ascending.
    pub fn push(
        &mut self,
        spans: impl IntoIterator<Item = Span>,
        neighbours: impl IntoIterator<Item = u32>,
    ) {
        self.spans.extend(spans);
        self.span_start.push(self.spans.len() as u32);
        self.neighbours.extend(neighbours);
        self.neighbour_start.push(self.neighbours.len() as u32);
        self.sealed = false;
    }

    /// Once all sub-domains are there, adds another way of owning points: in columns that a stage
    /// moves by it ([`crate::UpdateStage::shifts`]), sub-domain `id` owns `spans(id)` instead. Returns
    /// its number.
    pub fn push_shift<S: IntoIterator<Item = Span>>(
        &mut self,
        spans: impl Fn(usize) -> S,
    ) -> usize {
        self.shifts.push(Shift::new(self.len(), spans));
        self.sealed = false;
        self.shifts.len() - 1
    }

    /// The points that sub-domain `id` owns by shift number `shift`.
    ///
    /// # Panics
    /// If there is no such shift.
    pub fn shifted(&self, shift: usize, id: usize) -> &[Span] {
        self.shifts[shift].spans(id)
    }

    /// Checks that the sub-domains are disjoint, own every point and are mutual neighbours, and that
    /// by every shift each point has one owner, too: its usual one or a neighbour of that.
    ///
    /// # Errors
    /// The first violation found.
    pub fn seal(&mut self) -> Result<(), PartitionError> {
        cover(&self.spans, self.points, &mut self.by_start)?;
        for a in 0..self.len() {
            let mut last = None;
            for &b in self.neighbours(a) {
                let mutual = (b as usize) < self.len()
                    && b as usize != a
                    && last.is_none_or(|last| last < b)
                    && self.neighbours(b as usize).binary_search(&(a as u32)).is_ok();
                if !mutual {
                    return Err(PartitionError::Neighbours { a, b: b as usize });
                }
                last = Some(b);
            }
        }
        for shift in &self.shifts {
            shift.seal(self)?;
        }
        self.sealed = true;
        Ok(())
    }

    /// Whether [`Partition::seal`] has accepted it as it is now.
    pub fn is_sealed(&self) -> bool {
        self.sealed
    }

    /// Number of sub-domains.
    pub fn len(&self) -> usize {
        self.span_start.len().saturating_sub(1)
    }

    /// Whether there are no sub-domains.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// The points that sub-domain `id` owns.
    pub fn spans(&self, id: usize) -> &[Span] {
        &self.spans[self.span_start[id] as usize..self.span_start[id + 1] as usize]
    }

    /// The sub-domain that owns `point`; `None` if there is no such point.
    pub fn owner(&self, point: usize) -> Option<usize> {
        (0..self.len()).find(|&id| self.spans(id).iter().any(|span| span.range().contains(&point)))
    }

    /// The neighbours of sub-domain `id`, ascending.
    pub fn neighbours(&self, id: usize) -> &[u32] {
        &self.neighbours[self.neighbour_start[id] as usize..self.neighbour_start[id + 1] as usize]
    }

    /// Neighbours of a sub-domain on average; 0 if there are no sub-domains.
    pub fn mean_neighbours(&self) -> f64 {
        self.neighbours.len() as f64 / self.len().max(1) as f64
    }

    /// Sub-domain `id`.
    pub fn piece(&self, id: usize) -> Piece<'_> {
        Piece { id, spans: self.spans(id), neighbours: self.neighbours(id) }
    }

    /// Whether the rates of `id` may read the state of `owner`.
    pub fn sees(&self, id: usize, owner: usize) -> bool {
        id == owner || self.neighbours(id).binary_search(&(owner as u32)).is_ok()
    }

    /// Bytes held.
    pub fn memory(&self) -> usize {
        (self.spans.capacity() + self.by_start.capacity()) * size_of::<Span>()
            + (self.span_start.capacity()
                + self.neighbours.capacity()
                + self.neighbour_start.capacity())
                * 4
            + self.shifts.iter().map(Shift::memory).sum::<usize>()
    }
}

/// Checks that spans are disjoint and cover all points; puts those that are not empty in order.
fn cover(spans: &[Span], points: usize, by_start: &mut Vec<Span>) -> Result<(), PartitionError> {
    by_start.clear();
    by_start.extend(spans.iter().filter(|s| s.start != s.end));
    by_start.sort_unstable_by_key(|s| s.start);
    let mut owned = 0;
    let mut last = Span { start: 0, end: 0 };
    // An empty span may lie anywhere but outside: its address is computed all the same.
    let outside = spans.iter().find(|s| s.start.max(s.end) > points);
    if let Some(&span) = outside {
        return Err(PartitionError::Outside { span, points });
    }
    for &span in &*by_start {
        if span.start < last.end || span.end < span.start {
            return Err(PartitionError::Overlap { first: last, second: span });
        }
        owned += span.len();
        last = span;
    }
    if owned == points { Ok(()) } else { Err(PartitionError::Unowned { owned, points }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(start: usize, end: usize) -> Span {
        Span { start, end }
    }

    #[test]
    fn a_point_with_two_owners_is_refused() {
        let mut p = Partition::new(4);
        p.push([span(0, 3)], [1]);
        p.push([span(2, 4)], [0]);
        assert!(matches!(p.seal(), Err(PartitionError::Overlap { .. })));
        assert!(!p.is_sealed());
    }

    #[test]
    fn a_point_without_owner_is_refused() {
        let mut p = Partition::new(4);
        p.push([span(0, 1), span(2, 4)], []);
        assert_eq!(p.seal(), Err(PartitionError::Unowned { owned: 3, points: 4 }));
    }

    #[test]
    fn a_point_past_the_end_is_refused() {
        let mut p = Partition::new(4);
        p.push([span(0, 5)], []);
        assert!(matches!(p.seal(), Err(PartitionError::Outside { .. })));
    }

    #[test]
    fn an_empty_span_past_the_end_is_refused() {
        let mut p = Partition::new(4);
        p.push([span(0, 4), span(1000, 1000)], []);
        assert!(matches!(p.seal(), Err(PartitionError::Outside { .. })));
        let mut p = Partition::new(4);
        p.push([span(0, 4), span(2, 2), span(4, 4)], []);
        assert_eq!(p.seal(), Ok(()));
    }

    #[test]
    fn a_reversed_span_is_refused() {
        let mut p = Partition::new(4);
        p.push([span(0, 4), span(3, 1)], []);
        assert!(matches!(p.seal(), Err(PartitionError::Overlap { .. })));
    }

    #[test]
    fn neighbours_must_be_mutual_and_other() {
        for (first, second) in [(vec![1], vec![]), (vec![0], vec![]), (vec![1, 1], vec![0])] {
            let mut p = Partition::new(2);
            p.push([span(0, 1)], first);
            p.push([span(1, 2)], second);
            assert!(matches!(p.seal(), Err(PartitionError::Neighbours { .. })));
        }
    }
}
