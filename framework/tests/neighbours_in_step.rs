//! Dependencies on a graph that no geometry made: in a rate part every neighbour is at exactly the
//! part before, in an update part its rates are complete.
//!
//! Every point's state is its age in steps, its rate the age of its neighbourhood, which is only
//! defined where all agree. A schedule that lets anybody begin early or late, or a hand-out that
//! forgets or doubles a sub-domain, makes the ages disagree.

mod models;

use finegrain_framework::*;
use models::random::Random;

/// A graph of sub-domains of uneven sizes, some of them empty, some without neighbours.
struct Graph {
    partition: Partition,
}

impl Graph {
    fn random(seed: u64) -> Self {
        let mut random = Random(seed);
        let nodes = 1 + random.below(40);
        let mut neighbours = vec![Vec::new(); nodes];
        for b in 0..nodes {
            for a in 0..b {
                if random.one_in(1 + nodes / 4) || (a + 1 == b && seed.is_multiple_of(2)) {
                    neighbours[a].push(b as u32);
                    neighbours[b].push(a as u32);
                }
            }
        }
        let sizes: Vec<usize> = (0..nodes).map(|_| random.below(4)).collect();
        let mut partition = Partition::new(sizes.iter().sum());
        let mut start = 0;
        for (size, mut neighbours) in sizes.into_iter().zip(neighbours) {
            neighbours.sort_unstable();
            // One point a span, so that a sub-domain owns several.
            let spans = (start..start + size).map(|start| Span { start, end: start + 1 });
            partition.push(spans, neighbours);
            start += size;
        }
        partition.seal().unwrap();
        Self { partition }
    }
}

impl Domain for Graph {
    type SubDomain<'a> = Piece<'a>;

    fn partition(&self) -> &Partition {
        &self.partition
    }

    fn sub_domain(&self, id: usize) -> Piece<'_> {
        self.partition.piece(id)
    }
}

/// The age of everybody in sight, if it is the same and as expected.
fn common_age(view: View<'_, u64>, near: &Near<'_, Graph>, expected: u64) -> Result<(), Fault> {
    let partition = near.domain().partition();
    for &owner in near.neighbours().iter().chain([&(near.id() as u32)]) {
        for &span in partition.spans(owner as usize) {
            let age = view.at(near.reach(owner as usize, span))[0];
            if age != expected {
                return Err(Fault::new(format!(
                    "sub-domain {} finds {owner} at age {age}, not {expected}",
                    near.id()
                )));
            }
        }
    }
    Ok(())
}

#[derive(Clone, Copy)]
struct Fields {
    age: State<u64>,
    seen: Rate<u64>,
    again: Rate<u64>,
}

struct Look(Fields);
struct LookAgain(Fields);
struct Grow(Fields);

fn fill(mut part: PartMut<'_, u64>, value: u64) {
    (0..part.spans()).for_each(|k| part.span(k).fill(value));
}

impl RateStage<Graph> for Look {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.0.seen.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Graph>,
        rates: &mut Rates<'_, Graph>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        if near.id().is_multiple_of(3) {
            std::thread::yield_now();
        }
        common_age(near.state(self.0.age), near, moment.step)?;
        fill(rates.column(self.0.seen), moment.step + 1);
        Ok(())
    }
}

impl RateStage<Graph> for LookAgain {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.0.again.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Graph>,
        rates: &mut Rates<'_, Graph>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        common_age(near.state(self.0.age), near, moment.step)?;
        common_age(near.rate(self.0.seen), near, moment.step + 1)?;
        fill(rates.column(self.0.again), moment.step + 1);
        Ok(())
    }
}

impl UpdateStage<Graph> for Grow {
    type Scratch = ();

    fn update(&self, own: &mut Own<'_, Graph>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let (again, mut age) = (own.rate(self.0.again), own.state_mut(self.0.age));
        for k in 0..age.spans() {
            // Were it run twice, the age would tell.
            let grown = age.span(k)[0] + 1;
            if grown != again.span(k)[0] {
                return Err(Fault::new(format!("age {grown} but rate {}", again.span(k)[0])));
            }
            age.span(k)[0] = grown;
        }
        Ok(())
    }
}

fn model(seed: u64) -> Model<Graph> {
    let domain = Graph::random(seed);
    let mut columns = Columns::new(domain.partition.points());
    let (age, seen, again) = (columns.state("age"), columns.rate("seen"), columns.rate("again"));
    let fields = Fields { age, seen, again };
    let step =
        Step::builder().rate(Look(fields)).rate(LookAgain(fields)).update(Grow(fields)).build();
    Model::with_fixed_dt("ages", domain, columns, step, 1.0)
}

#[test]
fn everybody_in_sight_is_at_the_same_part() {
    for seed in 0..60 {
        for schedule in Schedule::ALL {
            for (workers, hand_out) in
                [(1, HandOut::Natural), (3, HandOut::Natural), (4, HandOut::Shuffled { seed })]
            {
                let steps_ahead = Some(1 + seed % 9);
                let settings =
                    Settings { schedule, workers, hand_out, steps_ahead, ..Settings::default() };
                let mut simulation = Simulation::new(model(seed), settings).unwrap();
                simulation.advance(20).unwrap_or_else(|error| panic!("graph {seed}: {error}"));
                let (age, _) = simulation.columns().iter().next().unwrap();
                let ages: &[u64] = bytemuck::cast_slice(simulation.columns().bytes(age));
                assert!(ages.iter().all(|&age| age == 20), "graph {seed}: {ages:?}");
            }
        }
    }
}
