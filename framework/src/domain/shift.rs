//! Ownership with an offset: the same sub-domains, other points.

use super::{Partition, PartitionError, Span};

/// Another way of owning points, by the same sub-domains ([`Partition::push_shift`]).
#[derive(Debug, Default)]
pub(super) struct Shift {
    spans: Vec<Span>,
    /// Sub-domain `i` owns `spans[start[i]..start[i + 1]]`.
    start: Vec<u32>,
}

impl Shift {
    pub fn new<S: IntoIterator<Item = Span>>(
        sub_domains: usize,
        spans: impl Fn(usize) -> S,
    ) -> Self {
        let mut shift = Self { spans: Vec::new(), start: vec![0] };
        for id in 0..sub_domains {
            shift.spans.extend(spans(id));
            shift.start.push(shift.spans.len() as u32);
        }
        shift
    }

    pub fn spans(&self, id: usize) -> &[Span] {
        &self.spans[self.start[id] as usize..self.start[id + 1] as usize]
    }

    pub fn memory(&self) -> usize {
        self.spans.capacity() * size_of::<Span>() + self.start.capacity() * size_of::<u32>()
    }

    /// Checks that every point has one owner, who is the one that owns it without offset or a neighbour
    /// of that one: whoever waits for neighbours then waits for everybody who ever touches what it
    /// touches.
    pub fn seal(&self, partition: &Partition) -> Result<(), PartitionError> {
        super::cover(&self.spans, partition.points, &mut Vec::new())?;
        let usual = by_start((0..partition.len()).map(|id| (id, partition.spans(id))));
        let mut first = 0;
        for (span, id) in by_start((0..partition.len()).map(|id| (id, self.spans(id)))) {
            while usual[first].0.end <= span.start {
                first += 1;
            }
            let touched = usual[first..].iter().take_while(|(other, _)| other.start < span.end);
            for &(_, owner) in touched {
                if !partition.sees(id, owner) {
                    return Err(PartitionError::Far { span, id, owner });
                }
            }
        }
        Ok(())
    }
}

/// Spans that are not empty, in order, each with its owner.
fn by_start<'a>(spans: impl Iterator<Item = (usize, &'a [Span])>) -> Vec<(Span, usize)> {
    let mut all: Vec<_> =
        spans.flat_map(|(id, spans)| spans.iter().map(move |&span| (span, id))).collect();
    all.retain(|(span, _)| !span.is_empty());
    all.sort_unstable_by_key(|(span, _)| span.start);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of `n` sub-domains of three points.
    fn ring(n: usize) -> Partition {
        let mut partition = Partition::new(3 * n);
        for i in 0..n {
            let mut around = [(i + n - 1) % n, (i + 1) % n].map(|j| j as u32);
            around.sort_unstable();
            partition.push([Span { start: 3 * i, end: 3 * i + 3 }], around);
        }
        partition
    }

    /// What sub-domain `i` owns `by` points ahead, around the end in two spans.
    fn ahead(n: usize, by: usize) -> impl Fn(usize) -> Vec<Span> {
        move |i| {
            (3 * i..3 * i + 3)
                .map(|point| (point + by) % (3 * n))
                .map(|point| Span { start: point, end: point + 1 })
                .collect()
        }
    }

    #[test]
    fn offsets_up_to_a_neighbour_are_sealed() {
        for by in [0, 1, 3, 12, 14] {
            let mut partition = ring(5);
            let shift = partition.push_shift(ahead(5, by));
            assert!(!partition.is_sealed());
            assert_eq!(partition.seal(), Ok(()), "{by}");
            assert_eq!(partition.shifted(shift, 4)[0].start, (12 + by) % 15);
        }
    }

    #[test]
    fn offsets_past_a_neighbour_are_refused() {
        for by in [4, 6, 8, 11] {
            let mut partition = ring(5);
            partition.push_shift(ahead(5, by));
            assert!(matches!(partition.seal(), Err(PartitionError::Far { .. })), "{by}");
        }
    }

    #[test]
    fn offsets_that_are_none_are_refused() {
        let whole = |start, end| vec![Span { start, end }];
        let mut partition = ring(5);
        partition.push_shift(|i| whole(3 * i, 3 * i + 2));
        assert_eq!(partition.seal(), Err(PartitionError::Unowned { owned: 10, points: 15 }));
        let mut partition = ring(5);
        partition.push_shift(|i| whole(3 * i, 15.min(3 * i + 4)));
        assert!(matches!(partition.seal(), Err(PartitionError::Overlap { .. })));
        let mut partition = ring(5);
        partition.push_shift(|i| whole(3 * i + 1, 3 * i + 4));
        assert!(matches!(partition.seal(), Err(PartitionError::Outside { .. })));
    }
}
