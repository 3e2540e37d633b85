//! Cells find exactly the pairs that a search through everybody and all periodic images finds.

mod models;

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellsOptions;
use finegrain_framework::*;
use models::random::Random;
use models::sorted::{Case, options, scattered};

#[track_caller]
fn assert_found<T: Real>(what: &str, options: &CellsOptions, points: &[Vec<f64>]) {
    let mut case = Case::<T>::new(options.clone(), points);
    case.sort(2).unwrap();
    case.assert_all_pairs_found(what);
}

#[track_caller]
fn assert_found_in_both(what: &str, options: &CellsOptions, points: &[Vec<f64>]) {
    assert_found::<f64>(&format!("{what}, f64"), options, points);
    assert_found::<f32>(&format!("{what}, f32"), options, points);
}

#[test]
fn random_boxes() {
    for seed in 0..600 {
        let random = &mut Random(seed);
        let dims = 1 + random.below(3);
        let lower: Vec<f64> = (0..dims).map(|_| 4.0 * (random.unit() - 0.5)).collect();
        // From a third of the range to several ranges: thin boxes and roomy ones.
        let upper: Vec<f64> = lower.iter().map(|l| l + 0.3 * 20f64.powf(random.unit())).collect();
        let periodic: Vec<bool> = (0..dims).map(|_| random.one_in(2)).collect();
        let skin = if random.one_in(2) { 0.0 } else { 0.5 * random.unit() };
        let mut options = options(&lower, &upper, &periodic, 1.0, skin);
        options.block_points = 1 + random.below(12);
        let points = random.below(60);
        // Some lie outside the box: periodic ones are wrapped, open ones stay.
        let outside = |x: f64| x + if seed % 5 == 0 { 30.0 * (x - lower[0]) } else { 0.0 };
        let mut points = scattered(random, points, &lower, &upper);
        points.iter_mut().for_each(|x| x[0] = outside(x[0]));
        assert_found_in_both(&format!("seed {seed}"), &options, &points);
    }
}

/// The channel of Holmes et al.: two support radii are more than its width.
#[test]
fn boxes_thinner_than_two_ranges() {
    let random = &mut Random(1);
    for width in [0.001, 0.000_7, 0.000_6, 0.000_5, 0.000_1] {
        for periodic in [[true, true], [false, true]] {
            let options = options(&[0.0, 0.0], &[0.004, width], &periodic, 0.000_6, 0.0);
            let points = scattered(random, 60, &[0.0, 0.0], &[0.004, width]);
            assert_found_in_both(&format!("width {width} {periodic:?}"), &options, &points);
        }
    }
}

/// On the borders of cells and of the box, at distances of exactly the range.
#[test]
fn particles_on_borders() {
    for (range, count) in [(0.1, 10), (0.3, 7), (1.0 / 3.0, 9), (0.7, 5), (1e-3, 11)] {
        for lower in [0.0, -0.35, 1000.1] {
            for periodic in [false, true] {
                let upper = lower + count as f64 * range;
                let options = options(&[lower; 2], &[upper; 2], &[periodic; 2], range, 0.0);
                let at = |i: usize| lower + i as f64 * range;
                let points: Vec<_> = (0..=count)
                    .flat_map(|j| (0..=count).map(move |i| vec![at(i), at(j)]))
                    .collect();
                let what = format!("range {range} from {lower}, periodic {periodic}");
                assert_found_in_both(&what, &options, &points);
            }
        }
    }
}

/// As near to a cell border as a number can be, and as near to the range apart.
#[test]
fn particles_beside_borders() {
    let random = &mut Random(3);
    for case in 0..300 {
        let range = 0.1 + random.unit();
        let lower = 10.0 * (random.unit() - 0.5);
        let upper = lower + 6.0 * range;
        let points: Vec<_> = (0..7)
            .map(|i| lower + f64::from(i) * range)
            .flat_map(|x| [x.next_down().next_down(), x.next_down(), x, x.next_up()])
            .map(|x| vec![x])
            .collect();
        let options = options(&[lower], &[upper], &[case % 2 == 0], range, 0.0);
        assert_found_in_both(&format!("case {case}"), &options, &points);
    }
}

#[test]
fn all_in_one_place() {
    for periodic in [false, true] {
        let options = options(&[0.0; 3], &[5.0; 3], &[periodic; 3], 1.0, 0.2);
        assert_found_in_both("one place", &options, &vec![vec![2.0, 3.0, 4.0]; 30]);
    }
}

#[test]
fn one_particle_and_none() {
    for periodic in [false, true] {
        for side in [0.4, 5.0] {
            let options = options(&[0.0; 2], &[side; 2], &[periodic; 2], 1.0, 0.2);
            assert_found_in_both("one", &options, &[vec![0.3, 0.1]]);
            assert_found_in_both("none", &options, &[]);
        }
    }
}

/// Clusters so far apart that a dense table of the cells between them could not be held.
#[test]
fn clusters_in_empty_space() {
    let random = &mut Random(5);
    for distance in [1e4, 1e7, 1e12] {
        let options = options(&[0.0; 3], &[1.0; 3], &[false, true, false], 0.5, 0.1);
        let mut points = scattered(random, 90, &[0.0; 3], &[1.0; 3]);
        for (i, point) in points.iter_mut().enumerate() {
            point[0] += distance * (i % 3) as f64;
            point[2] -= distance * (i % 2) as f64;
        }
        assert_found::<f64>(&format!("{distance} apart"), &options, &points);
    }
}

#[test]
fn drift_within_half_the_skin() {
    for seed in 0..200 {
        let random = &mut Random(seed);
        let upper = [0.5 + 4.0 * random.unit(), 0.5 + random.unit()];
        let periodic = [random.one_in(2), random.one_in(2)];
        let skin = 0.4;
        let options = options(&[0.0; 2], &upper, &periodic, 1.0, skin);
        let points = scattered(random, 50, &[0.0; 2], &upper);
        let mut case = Case::<f64>::new(options, &points);
        case.sort(1).unwrap();
        for i in 0..50 {
            let (angle, far) = (7.0 * random.unit(), 0.4999 * skin);
            let [x, y] = [case.position[0], case.position[1]];
            case.columns.values_mut(x)[i] += far * angle.cos();
            case.columns.values_mut(y)[i] += far * angle.sin();
        }
        case.assert_all_pairs_found(&format!("seed {seed}"));
    }
}

#[test]
fn candidates_come_in_the_same_order_whoever_sorts() {
    let options = options(&[0.0; 3], &[30.0; 3], &[true, false, true], 1.0, 0.1);
    // More than several workers' chunks.
    let points = scattered(&mut Random(6), 70_001, &[0.0; 3], &[30.0; 3]);
    let outcome = |workers| {
        let mut case = Case::<f64>::new(options.clone(), &points);
        case.sort(workers).unwrap();
        (case.columns.values(case.number).to_vec(), case.runs())
    };
    let expected = outcome(1);
    for workers in [2, 3, 8] {
        assert!(outcome(workers) == expected, "{workers} workers");
    }
}

#[test]
fn sorting_is_stable() {
    let options = options(&[0.0; 2], &[6.0; 2], &[true, false], 1.0, 0.1);
    let random = &mut Random(7);
    let mut case = Case::<f64>::new(options, &scattered(random, 500, &[0.0; 2], &[6.0; 2]));
    for _ in 0..5 {
        case.sort(3).unwrap();
        for (_, span, _) in case.runs() {
            let order = &case.columns.values(case.number)[span.range()];
            assert!(order.is_sorted(), "{order:?}");
        }
        // Nobody has moved since: nobody is moved.
        case.sort(3).unwrap();
        assert!(case.columns.values(case.number).is_sorted());
        for &position in &case.position {
            case.columns.values_mut(position).iter_mut().for_each(|x| *x += 0.5 * random.unit());
        }
    }
}

/// However thin the box, a block is worth its hand-out.
#[test]
fn blocks_have_about_the_points_asked_for() {
    for [x, y, z] in [[40.0, 40.0, 40.0], [600.0, 10.0, 10.0], [60_000.0, 1.0, 1.0]] {
        let mut options = options(&[0.0; 3], &[x, y, z], &[true; 3], 1.0, 0.0);
        options.block_points = 100;
        let points = scattered(&mut Random(10), 60_000, &[0.0; 3], &[x, y, z]);
        let mut case = Case::<f64>::new(options, &points);
        case.sort(1).unwrap();
        let mean = 60_000 / case.cells.partition().len();
        // Of cells that hold one on average by chance, a third are empty and not counted.
        assert!((40..=200).contains(&mean), "{mean} points a block in a box of {x} x {y} x {z}");
    }
}

/// One that has flown away does not make the blocks of all others larger.
#[test]
fn blocks_where_most_of_the_box_is_empty() {
    let drop = scattered(&mut Random(11), 5_000, &[0.0; 2], &[25.0; 2]);
    for far in [[30.0, 0.0], [800.0, 10.0], [1e4, -1e4]] {
        for periodic in [false, true] {
            let (lower, upper) = ([0.0, -1.1e4], [1.1e4, 25.0]);
            let mut options = options(&lower, &upper, &[periodic; 2], 1.0, 0.0);
            options.block_points = 100;
            let points: Vec<_> = drop.iter().cloned().chain([far.to_vec()]).collect();
            let mut case = Case::<f64>::new(options, &points);
            case.sort(2).unwrap();
            let partition = case.cells.partition();
            let largest = (0..partition.len()).map(|id| partition.piece(id).points()).max();
            assert!(largest.unwrap() < 300, "{largest:?} points in a block, one at {far:?}");
            assert!(partition.len() < 100, "{} blocks, one at {far:?}", partition.len());
        }
    }
}

#[test]
fn a_position_that_is_not_finite_is_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for periodic in [false, true] {
            let options = options(&[0.0; 2], &[6.0; 2], &[periodic; 2], 1.0, 0.1);
            let mut points = scattered(&mut Random(8), 50, &[0.0; 2], &[6.0; 2]);
            points[17][1] = bad;
            let fault = Case::<f64>::new(options, &points).sort(2).unwrap_err().to_string();
            assert!(
                fault.contains("particle at place 17") && fault.contains("direction 1"),
                "{fault}"
            );
        }
    }
}

/// Moves particles by their velocities, with a rate stage so that cells are asked.
struct Move {
    position: Vec<State<f64>>,
    velocity: State<f64>,
}

struct Look;

impl RateStage<Cells<f64>> for Look {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        Vec::new()
    }

    fn rate(
        &self,
        _: &Near<'_, Cells<f64>>,
        _: &mut Rates<'_, Cells<f64>>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        Ok(())
    }
}

impl UpdateStage<Cells<f64>> for Move {
    type Scratch = ();

    fn update(
        &self,
        own: &mut Own<'_, Cells<f64>>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let velocity = own.state(self.velocity).whole();
        for &position in &self.position {
            let position = own.state_mut(position).whole();
            position.iter_mut().zip(velocity).for_each(|(x, v)| *x += moment.dt * v);
        }
        Ok(())
    }
}

/// Runs 20 steps in which particle `who` of the sorted ones moves by `far` in every direction and
/// a step, sorted only once.
fn run_away(settings: Settings, who: usize, far: f64) -> Result<(), RunError> {
    let options = options(&[0.0; 2], &[6.0; 2], &[true; 2], 1.0, 0.4);
    let points = scattered(&mut Random(9), 90, &[0.0; 2], &[6.0; 2]);
    let mut case = Case::<f64>::new(options, &points);
    let velocity = case.columns.state("velocity");
    case.sort(1).unwrap();
    case.columns.values_mut(velocity)[who] = far;
    let Case { columns, position, cells, .. } = case;
    let step = Step::builder().rate(Look).update(Move { position, velocity }).build();
    let model = Model::with_fixed_dt("drift", cells, columns, step, 1.0);
    Simulation::new(model, settings).unwrap().advance(20)
}

#[test]
fn drift_past_half_the_skin_is_an_error_that_names_the_particle() {
    for schedule in Schedule::ALL {
        let settings = Settings { schedule, workers: 3, ..Settings::default() };
        // The diagonal of 0.14 is 0.198, that of 0.15 is 0.212; half the skin is 0.2.
        run_away(settings.clone(), 41, 0.14 / 20.0).unwrap();
        let error = run_away(settings.clone(), 41, 0.03).unwrap_err();
        assert_eq!(error.step, 5, "{error}");
        assert!(error.to_string().contains("particle at place 41"), "{error}");
        let error = run_away(settings, 41, f64::NAN).unwrap_err();
        assert!(error.to_string().contains("particle at place 41"), "{error}");
    }
}

#[test]
fn no_particles_can_be_stepped() {
    for schedule in Schedule::ALL {
        let options = options(&[0.0; 2], &[6.0; 2], &[true; 2], 1.0, 0.4);
        let mut case = Case::<f64>::new(options, &[]);
        let velocity = case.columns.state("velocity");
        case.sort(1).unwrap();
        let Case { columns, position, cells, .. } = case;
        let step = Step::builder().rate(Look).update(Move { position, velocity }).build();
        let model = Model::with_fixed_dt("nobody", cells, columns, step, 1.0);
        let settings = Settings { schedule, workers: 3, ..Settings::default() };
        Simulation::new(model, settings).unwrap().advance(20).unwrap();
    }
}
