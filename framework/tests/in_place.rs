//! Streaming in place: a stage that owns the points of some columns with an offset.

use finegrain_framework::space::Grid;
use finegrain_framework::*;

const SHAPE: [usize; 3] = [3, 11, 7];
/// Where what goes forward from a row is kept: one plane up, one row down.
const SHIFT: [isize; 2] = [-1, 1];
const STEPS: u64 = 9;

/// What goes forward and backward along the shift meets at every point, is mixed, and goes on.
struct Mix {
    /// Arrived from behind.
    forward: State<f64>,
    /// Still ahead, where it comes from.
    backward: State<f64>,
    /// A point at which it breaks.
    breaks: Option<[usize; 3]>,
}

/// What a point makes of what arrives.
fn mix(forward: f64, backward: f64) -> [f64; 2] {
    let sum = 0.3 * (forward + backward);
    [(forward + sum).sin(), (backward - sum * forward).cos()]
}

impl UpdateStage<Grid> for Mix {
    type Scratch = ();

    fn shifts(&self) -> Vec<(ColumnId, usize)> {
        vec![(self.backward.id(), 0)]
    }

    fn update(&self, own: &mut Own<'_, Grid>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let tile = own.sub_domain();
        let (mut here, mut ahead) = (own.rows_mut(self.forward), own.rows_mut(self.backward));
        for (j, k) in tile.rows() {
            let (here, ahead) = (here.row(j, k), ahead.row(j, k));
            for x in 0..SHAPE[0] {
                // Each takes the other's place, and the columns are exchanged.
                let [forward, backward] = mix(here[x], ahead[x]);
                (ahead[x], here[x]) = (forward, backward);
                if self.breaks == Some([x, j, k]) {
                    ahead[x] = f64::NAN;
                }
            }
        }
        Ok(())
    }
}

fn number([x, j, k]: [usize; 3]) -> usize {
    (k * SHAPE[1] + j) * SHAPE[0] + x
}

/// The point that lies `SHIFT` ahead.
fn ahead([x, j, k]: [usize; 3]) -> [usize; 3] {
    let [ny, nz] = [SHAPE[1], SHAPE[2]].map(|n| n as isize);
    let j = (j as isize + SHIFT[0]).rem_euclid(ny);
    let k = (k as isize + SHIFT[1]).rem_euclid(nz);
    [x, j as usize, k as usize]
}

fn points() -> impl Iterator<Item = [usize; 3]> {
    (0..SHAPE[2])
        .flat_map(|k| (0..SHAPE[1]).flat_map(move |j| (0..SHAPE[0]).map(move |x| [x, j, k])))
}

fn start(point: [usize; 3], way: f64) -> f64 {
    (number(point) as f64 * 0.37 + way).sin()
}

fn model(tile: [usize; 2], breaks: Option<[usize; 3]>) -> (Model<Grid>, [State<f64>; 2]) {
    let builder = Grid::builder(SHAPE).periodic([false, true, true]).tile(tile[0], tile[1]);
    let domain = builder.shifts(&[SHIFT]).build();
    let mut columns = Columns::new(domain.points());
    let (forward, backward) = (columns.state("forward"), columns.state("backward"));
    for point in points() {
        columns.values_mut(forward)[number(ahead(point))] = start(point, 0.0);
        columns.values_mut(backward)[number(point)] = start(point, 1.0);
    }
    let stage = Mix { forward, backward, breaks };
    let step = Step::builder().update(stage).swap_states(forward, backward).build();
    (Model::with_fixed_dt("mix", domain, columns, step, 1.0), [forward, backward])
}

/// The same with a second set of values: what left each point, forward and backward.
fn reference() -> Vec<[f64; 2]> {
    let mut now: Vec<_> = points().map(|p| [start(p, 0.0), start(p, 1.0)]).collect();
    for _ in 0..STEPS {
        let mut arrived = vec![[0.0; 2]; now.len()];
        for point in points() {
            let (here, there) = (number(point), number(ahead(point)));
            arrived[there][0] = now[here][0];
            arrived[here][1] = now[there][1];
        }
        now = arrived.into_iter().map(|[forward, backward]| mix(forward, backward)).collect();
    }
    now
}

#[test]
fn streaming_in_place_has_the_bits_of_two_sets_of_values() {
    let expected = reference();
    for tile in [[1, 1], [2, 3], [4, 2], [11, 7]] {
        for schedule in Schedule::ALL {
            for (workers, steps_ahead) in [(1, None), (2, Some(3)), (5, Some(9))] {
                for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 7 }] {
                    let (model, [forward, backward]) = model(tile, None);
                    let settings = Settings {
                        schedule,
                        workers,
                        hand_out,
                        steps_ahead,
                        ..Settings::default()
                    };
                    let mut simulation = Simulation::new(model, settings).unwrap();
                    simulation.advance(4).unwrap();
                    simulation.advance(STEPS - 4).unwrap();
                    let columns = simulation.columns();
                    for point in points() {
                        let [to, from] = expected[number(point)];
                        let found = columns.values(forward)[number(ahead(point))];
                        assert_eq!(found, to, "{tile:?} {schedule} {workers} {point:?}");
                        assert_eq!(columns.values(backward)[number(point)], from);
                    }
                }
            }
        }
    }
}

/// What is not finite is found where the stage that left it owns it, under every schedule, by the
/// name that the column then has.
#[test]
fn values_that_are_not_finite_are_found_with_an_offset() {
    for schedule in Schedule::ALL {
        let breaks = [1, 4, 6];
        let (model, _) = model([2, 2], Some(breaks));
        let settings = Settings { schedule, workers: 3, ..Settings::default() };
        let settings = Settings { check_every: Some(1), ..settings };
        let mut simulation = Simulation::new(model, settings).unwrap();
        let error = simulation.advance(1).unwrap_err();
        // Row 4 of plane 6 is the tile's with rows 4 and 5 of plane 6, of six tiles a pair of planes.
        assert_eq!(error.sub_domain, Some(3 * 6 + 2), "{schedule}");
        assert_eq!(error.cause, Cause::NotFinite { column: "forward".to_owned() });
    }
}

/// Reads a column from neighbours.
struct Read {
    from: State<f64>,
    to: Rate<f64>,
}

impl RateStage<Grid> for Read {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.to.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        _: &mut Rates<'_, Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        near.rows(self.from);
        Ok(())
    }
}

/// A neighbour's neighbour may be writing there.
#[test]
fn what_is_owned_with_an_offset_is_not_seen_by_neighbours() {
    for reads_forward in [true, false] {
        let domain = Grid::builder(SHAPE).periodic([false, true, true]).shifts(&[SHIFT]).build();
        let mut columns = Columns::new(domain.points());
        let (forward, backward) = (columns.state("forward"), columns.state("backward"));
        let from = if reads_forward { forward } else { backward };
        let to = columns.rate("to");
        let step = Step::builder()
            .rate(Read { from, to })
            .update(Mix { forward, backward, breaks: None })
            .swap_states(forward, backward)
            .build();
        let model = Model::with_fixed_dt("mix", domain, columns, step, 1.0);
        let mut simulation = Simulation::new(model, Settings::default()).unwrap();
        let error = simulation.advance(1).unwrap_err().to_string();
        assert!(error.contains("owned with an offset"), "{error}");
    }
}

/// Owns a column with one of two offsets.
struct Move(State<f64>, usize);

impl UpdateStage<Grid> for Move {
    type Scratch = ();

    fn shifts(&self) -> Vec<(ColumnId, usize)> {
        vec![(self.0.id(), self.1)]
    }

    fn update(&self, _: &mut Own<'_, Grid>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        Ok(())
    }
}

#[test]
fn two_offsets_of_the_same_memory_are_refused() {
    let mut columns = Columns::new(1);
    let (a, b) = (columns.state("a"), columns.state("b"));
    let build = |second: State<f64>, shift: usize| {
        std::panic::catch_unwind(|| {
            let step = Step::<Grid>::builder().update(Move(a, 0)).swap_states(a, b);
            step.update(Move(second, shift)).build().parts()
        })
    };
    // Stages with offsets never share a part.
    assert_eq!(build(a, 0).unwrap(), 2);
    assert_eq!(build(b, 0).unwrap(), 2);
    assert!(build(a, 1).is_err());
    assert!(build(b, 1).is_err());
}
