//! A partition is accepted exactly if every point has one owner and neighbours are mutual.
//!
//! Everything that lets sub-domains run beside one another rests on this, so it is compared with
//! a check that looks at every point, on partitions that are right and on ones that are nearly so.

mod models;

use finegrain_framework::{Partition, Span};
use models::random::Random;

#[derive(Clone, Debug)]
struct Pieces {
    points: usize,
    spans: Vec<Vec<Span>>,
    neighbours: Vec<Vec<u32>>,
}

impl Pieces {
    /// A right one: points cut anywhere, the cuts dealt out at random.
    fn random(random: &mut Random) -> Self {
        let (points, count) = (random.below(30), 1 + random.below(6));
        let mut pieces =
            Self { points, spans: vec![Vec::new(); count], neighbours: vec![Vec::new(); count] };
        let mut start = 0;
        while start < points {
            let end = start + 1 + random.below(points - start);
            pieces.spans[random.below(count)].push(Span { start, end });
            if random.one_in(5) {
                pieces.spans[random.below(count)].push(Span { start: end, end });
            }
            start = end;
        }
        for b in 0..count {
            for a in 0..b {
                if random.one_in(2) {
                    pieces.neighbours[a].push(b as u32);
                    pieces.neighbours[b].push(a as u32);
                }
            }
        }
        pieces.neighbours.iter_mut().for_each(|near| near.sort_unstable());
        pieces
    }

    /// Changes one thing, perhaps for the worse.
    fn disturb(&mut self, random: &mut Random) {
        let id = random.below(self.spans.len());
        let (spans, near) = (&mut self.spans[id], &mut self.neighbours[id]);
        let (span, neighbour) = (random.below(spans.len().max(1)), random.below(near.len().max(1)));
        match random.below(9) {
            0 if !spans.is_empty() => spans[span].start += 1,
            1 if !spans.is_empty() => spans[span].end += 1,
            2 if !spans.is_empty() => spans[span].start = spans[span].start.saturating_sub(1),
            3 if !spans.is_empty() => drop(spans.remove(span)),
            4 if !spans.is_empty() => spans.push(spans[span]),
            5 if !near.is_empty() => drop(near.remove(neighbour)),
            6 => near.push(random.below(8) as u32),
            7 => near.reverse(),
            _ => self.points = (self.points + random.below(3)).saturating_sub(1),
        }
    }

    fn is_right(&self) -> bool {
        let mut owners = vec![0; self.points];
        for span in self.spans.iter().flatten() {
            if span.start > span.end || span.end > self.points {
                return false;
            }
            owners[span.range()].iter_mut().for_each(|count| *count += 1);
        }
        let are_mutual = |a: usize, b: u32| {
            let back = self.neighbours.get(b as usize);
            b as usize != a && back.is_some_and(|back| back.contains(&(a as u32)))
        };
        owners.iter().all(|&count| count == 1)
            && self.neighbours.iter().enumerate().all(|(a, near)| {
                near.windows(2).all(|pair| pair[0] < pair[1])
                    && near.iter().all(|&b| are_mutual(a, b))
            })
    }

    fn is_accepted(&self, partition: &mut Partition) -> bool {
        partition.clear(self.points);
        for (spans, near) in self.spans.iter().zip(&self.neighbours) {
            partition.push(spans.iter().copied(), near.iter().copied());
        }
        let accepted = partition.seal().is_ok();
        assert_eq!(partition.is_sealed(), accepted);
        accepted
    }
}

#[test]
fn accepted_exactly_if_right() {
    let mut partition = Partition::new(0);
    let mut wrong = 0;
    for seed in 0..20_000 {
        let random = &mut Random(seed);
        let mut pieces = Pieces::random(random);
        assert!(pieces.is_right() && pieces.is_accepted(&mut partition), "seed {seed}");
        for _ in 0..1 + random.below(2) {
            pieces.disturb(random);
        }
        let is_right = pieces.is_right();
        wrong += usize::from(!is_right);
        assert_eq!(pieces.is_accepted(&mut partition), is_right, "seed {seed}: {pieces:?}");
    }
    assert!(wrong > 5_000, "only {wrong} wrong ones");
}
