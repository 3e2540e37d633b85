//! Whatever a stage does wrong ends the run with an error that says where, under every schedule;
//! nobody waits for ever, and the process can go on to another run.

mod models;

use finegrain_framework::space::Grid;
use finegrain_framework::*;
use models::closures::{pacing, rate_stage, update_stage, whole_stage};

/// Where the mishap happens.
const STEP: u64 = 4;
const WHERE: usize = 5;

type Rated = fn(&Near<'_, Grid>, &Moment) -> Result<(), Fault>;
type Updated = fn(&mut f64, &Moment) -> Result<(), Fault>;

/// A ring of 12 sub-domains in which everybody adds up its neighbourhood, with a mishap in the
/// rate or the update.
fn ring(rated: Rated, updated: Updated) -> Model<Grid> {
    let domain = Grid::builder([3, 24]).periodic([false, true]).tile(2, 1).build();
    let mut columns = Columns::new(domain.points());
    let (level, sum) = (columns.state::<f64>("level"), columns.rate::<f64>("sum"));
    columns.values_mut(level).fill(1.0);
    let rate = rate_stage("adding up", &[sum.id()], move |near, rates, moment| {
        rated(near, moment)?;
        let (level, mut sum) = (near.rows(level), rates.rows(sum));
        for (j, k) in near.sub_domain().rows() {
            let beside = |dj| level.row(j as isize + dj, 0)[0];
            sum.row(j, k).fill(0.5 * (beside(-1) + beside(1)));
        }
        Ok(())
    });
    let update = update_stage("taking over", move |own, moment| {
        let sum = own.rate(sum).whole();
        let is_there = own.id() == WHERE && moment.step == STEP;
        let level = own.state_mut(level).whole();
        level.copy_from_slice(sum);
        if is_there { updated(&mut level[0], moment) } else { Ok(()) }
    });
    let step = Step::builder().stage_at(0.0, &rate).stage_at(0.5, &update).build();
    Model::with_fixed_dt("ring", domain, columns, step, 0.25)
}

fn all_settings() -> Vec<Settings> {
    let mut all = Vec::new();
    for schedule in Schedule::ALL {
        for workers in [1, 2, 5] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 1 }] {
                let check_every = Some(1);
                let chosen = Settings { schedule, workers, hand_out, ..Settings::default() };
                all.push(Settings { check_every, ..chosen });
            }
        }
    }
    all
}

/// Steps that many, under all settings; every error must be the same.
fn error_of<D: Domain>(model: impl Fn() -> Model<D>) -> RunError {
    let mut all = all_settings().into_iter().map(|settings| {
        let mut simulation = Simulation::new(model(), settings).unwrap();
        let error = simulation.advance(20).unwrap_err();
        // Not a sensible thing to do, but no reason to hang either.
        let _ = simulation.advance(2);
        error
    });
    let first = all.next().unwrap();
    all.for_each(|other| assert_eq!(other, first));
    // The process goes on.
    let mut healthy =
        Simulation::new(ring(|_, _| Ok(()), |_, _| Ok(())), Settings::default()).unwrap();
    healthy.advance(3).unwrap();
    first
}

fn expected(stage: &str, cause: Cause) -> RunError {
    RunError {
        method: "ring".to_owned(),
        step: STEP,
        time: 1.0,
        stage: stage.to_owned(),
        sub_domain: Some(WHERE),
        cause,
    }
}

fn is_there(near: &Near<'_, Grid>, moment: &Moment) -> bool {
    near.id() == WHERE && moment.step == STEP
}

#[test]
fn a_fault_in_a_rate_stage() {
    let rated: Rated = |near, moment| {
        if is_there(near, moment) { Err(Fault::new("negative density")) } else { Ok(()) }
    };
    let error = error_of(|| ring(rated, |_, _| Ok(())));
    assert_eq!(error, expected("adding up", Cause::Fault(Fault::new("negative density"))));
    assert_eq!(
        error.to_string(),
        "ring: step 4 (t = 1.000000e0), stage \"adding up\", sub-domain 5: negative density"
    );
}

#[test]
fn a_panic_in_a_rate_stage() {
    let rated: Rated = |near, moment| {
        assert!(!is_there(near, moment), "at {}", moment.step);
        Ok(())
    };
    let error = error_of(|| ring(rated, |_, _| Ok(())));
    assert_eq!(error, expected("adding up", Cause::Panic("at 4".to_owned())));
}

#[test]
fn a_fault_in_an_update_stage() {
    let error = error_of(|| ring(|_, _| Ok(()), |_, _| Err(Fault::new("no"))));
    assert_eq!(error, expected("taking over", Cause::Fault(Fault::new("no"))));
}

#[test]
fn a_panic_in_an_update_stage() {
    let error = error_of(|| ring(|_, _| Ok(()), |_, _| panic!("no")));
    assert_eq!(error, expected("taking over", Cause::Panic("no".to_owned())));
}

/// A payload that panics once more when it is dropped must not take the worker along.
#[test]
fn a_panic_with_a_payload_that_panics() {
    struct Grenade;
    impl Drop for Grenade {
        fn drop(&mut self) {
            panic!("when dropped");
        }
    }
    let error = error_of(|| ring(|_, _| Ok(()), |_, _| std::panic::panic_any(Grenade)));
    assert_eq!(error, expected("taking over", Cause::Panic("no message".to_owned())));
}

fn set(level: &mut f64, value: f64) -> Result<(), Fault> {
    *level = value;
    Ok(())
}

#[test]
fn values_that_are_not_finite() {
    let cause = Cause::NotFinite { column: "level".to_owned() };
    let updates: [Updated; 3] = [
        |level, _| set(level, f64::NAN),
        |level, _| set(level, f64::INFINITY),
        |level, _| set(level, f64::NEG_INFINITY),
    ];
    for updated in updates {
        let error = error_of(|| ring(|_, _| Ok(()), updated));
        assert_eq!(error, expected("taking over", cause.clone()));
    }
}

/// What has lost all sense is found long before it is infinite: wherever it is, in a leg and between steps.
#[test]
fn values_beyond_their_limit() {
    fn outcomes<T: Real>(
        value: f64,
        place: usize,
        limit: &'static Limit,
    ) -> [Result<(), RunError>; 2] {
        let domain = Grid::builder([72]).tile(1, 1).build();
        let mut columns = Columns::new(domain.points());
        let level = columns.state::<T>("level");
        columns.limit(level, limit);
        columns.values_mut(level)[place] = T::of(value);
        let idle = update_stage("idle", |_, _| Ok(()));
        let step = Step::builder().stage_at(0.0, &idle).build();
        let model = Model::with_fixed_dt("idle", domain, columns, step, 0.25);
        let settings = Settings { check_every: Some(1), ..Settings::default() };
        let mut simulation = Simulation::new(model, settings).unwrap();
        [simulation.check_finite(), simulation.advance(1)]
    }
    let limit = &Limit { most: 2.0, beyond: "the level is too high" };
    let cause = Cause::Beyond { column: "level".to_owned(), limit };
    for place in 0..72 {
        for (value, is_valid) in
            [(2.0, true), (-2.0, true), (2.5, false), (-2.5, false), (f64::NAN, false)]
        {
            for outcome in
                [outcomes::<f32>(value, place, limit), outcomes::<f64>(value, place, limit)]
                    .concat()
            {
                let expected = if is_valid { None } else { Some(cause.clone()) };
                assert_eq!(outcome.err().map(|e| e.cause), expected, "{value} at {place}");
            }
        }
    }
    assert!(cause.to_string().ends_with("not between -2 and 2: the level is too high"));
}

#[test]
#[should_panic(expected = "column \"next\" is swapped but no stage writes it")]
fn a_swap_with_what_nobody_writes() {
    let domain = Grid::builder([8]).tile(1, 1).build();
    let mut columns = Columns::new(domain.points());
    let (level, next) = (columns.state::<f64>("level"), columns.rate::<f64>("next"));
    let idle = update_stage("idle", |_, _| Ok(()));
    let step = Step::builder().stage_at(0.0, &idle).swap(level, next).build();
    let _ = Simulation::new(
        Model::with_fixed_dt("idle", domain, columns, step, 0.25),
        Settings::default(),
    );
}

/// Checked every three steps, a NaN of step 4 is found after step 5, in the neighbourhood.
#[test]
fn a_nan_is_found_at_the_next_check() {
    for schedule in Schedule::ALL {
        let run = |check_every| {
            let settings = Settings { schedule, workers: 3, check_every, ..Settings::default() };
            let model = ring(|_, _| Ok(()), |level, _| set(level, f64::NAN));
            Simulation::new(model, settings).unwrap().advance(20)
        };
        run(None).unwrap();
        let error = run(Some(3)).unwrap_err();
        assert_eq!((error.step, error.time), (5, 1.25));
        assert!([4, 5, 6].contains(&error.sub_domain.unwrap()), "{error}");
    }
}

/// Which of several faults is reported depends on who came first, but it is one of them, whole.
#[test]
fn everybody_fails_at_once() {
    let rated: Rated = |near, moment| match moment.step {
        STEP => Err(Fault::new(format!("sub-domain {}", near.id()))),
        _ => Ok(()),
    };
    for settings in all_settings() {
        let model = ring(rated, |_, _| Ok(()));
        let error = Simulation::new(model, settings).unwrap().advance(20).unwrap_err();
        assert_eq!(error.step, STEP);
        let id = error.sub_domain.unwrap();
        assert_eq!(error.cause, Cause::Fault(Fault::new(format!("sub-domain {id}"))));
    }
}

/// A ring with whole-domain work every second step.
fn ring_with(
    whole: Box<dyn WholeStage<Grid>>,
    pace: impl FnMut(&mut Whole<'_, Grid>) -> Result<Pace, Fault> + Send + 'static,
) -> Model<Grid> {
    let mut model = ring(|_, _| Ok(()), |_, _| Ok(()));
    model.whole = vec![whole_stage("looking on", |_| Ok(())), whole];
    model.pacing = pacing(pace);
    model
}

fn expected_in_whole(stage: &str, cause: Cause) -> RunError {
    RunError { sub_domain: None, ..expected(stage, cause) }
}

fn every_other_step(_: &mut Whole<'_, Grid>) -> Result<Pace, Fault> {
    Ok(Pace { dt: 0.25, steps: 2 })
}

#[test]
fn a_fault_in_a_whole_domain_stage() {
    let error = error_of(|| {
        let whole = whole_stage("sorting", |whole| match whole.step {
            STEP => Err(Fault::new("no")),
            _ => Ok(()),
        });
        ring_with(whole, every_other_step)
    });
    assert_eq!(error, expected_in_whole("sorting", Cause::Fault(Fault::new("no"))));
}

#[test]
fn a_panic_in_a_whole_domain_stage() {
    let error = error_of(|| {
        let whole = whole_stage("sorting", |whole| {
            assert_ne!(whole.step, STEP, "the team");
            Ok(())
        });
        ring_with(whole, every_other_step)
    });
    let Cause::Panic(message) = &error.cause else { panic!("{error}") };
    assert!(message.contains("the team"), "{error}");
    assert_eq!(error, expected_in_whole("sorting", error.cause.clone()));
}

/// One worker of the team panics while the others work.
#[test]
fn a_panic_inside_a_reduction() {
    let error = error_of(|| {
        let whole = whole_stage("summing", |whole: &mut Whole<'_, Grid>| {
            let step = whole.step;
            whole.sum(|near| {
                if near.id() == WHERE && step == STEP {
                    panic!("no");
                }
                [1.0]
            });
            Ok(())
        });
        ring_with(whole, every_other_step)
    });
    assert_eq!(error, expected_in_whole("summing", Cause::Panic("no".to_owned())));
}

/// A domain that can be divided anew.
struct Divided(Partition);

impl Domain for Divided {
    type SubDomain<'a> = Piece<'a>;

    fn partition(&self) -> &Partition {
        &self.0
    }

    fn sub_domain(&self, id: usize) -> Piece<'_> {
        self.0.piece(id)
    }
}

/// Four points, which `divide` divides anew when it is time.
fn divided_by(divide: fn(&mut Partition)) -> Model<Divided> {
    let mut partition = Partition::new(4);
    partition.push([Span { start: 0, end: 4 }], []);
    partition.seal().unwrap();
    let mut columns = Columns::new(4);
    columns.state::<f64>("level");
    let idle = update_stage("idle", |_, _| Ok(()));
    let step = Step::builder().stage_at(0.0, &idle).build();
    let mut model = Model::with_fixed_dt("ring", Divided(partition), columns, step, 0.25);
    model.whole = vec![whole_stage("dividing", move |whole: &mut Whole<'_, Divided>| {
        if whole.step == STEP {
            divide(&mut whole.domain.0);
        }
        Ok(())
    })];
    model.pacing = pacing(|_: &mut Whole<'_, Divided>| Ok(Pace { dt: 0.25, steps: 2 }));
    model
}

#[test]
fn a_division_of_space_that_went_wrong() {
    let torn = error_of(|| {
        divided_by(|partition| {
            partition.push([Span { start: 3, end: 5 }], []);
            // Whoever divides should have looked at this.
            let _ = partition.seal();
        })
    });
    let fault = Fault::new("the domain's partition is not sealed");
    assert_eq!(torn, expected_in_whole("division of space", Cause::Fault(fault)));
    let short = error_of(|| {
        divided_by(|partition| {
            partition.clear(3);
            partition.push([Span { start: 0, end: 3 }], []);
            partition.seal().unwrap();
        })
    });
    let fault = Fault::new("the domain has 3 points, the columns have 4");
    assert_eq!(short, expected_in_whole("division of space", Cause::Fault(fault)));
}

#[test]
fn a_fault_or_a_panic_in_step_control() {
    let idle = || whole_stage("idle", |_| Ok(()));
    let error = error_of(|| {
        ring_with(idle(), |whole| match whole.step {
            STEP => Err(Fault::new("no")),
            _ => every_other_step(whole),
        })
    });
    assert_eq!(error, expected_in_whole("time step control", Cause::Fault(Fault::new("no"))));
    let error = error_of(|| {
        ring_with(idle(), |whole| match whole.step {
            STEP => panic!("no"),
            _ => every_other_step(whole),
        })
    });
    assert_eq!(error, expected_in_whole("time step control", Cause::Panic("no".to_owned())));
}

#[test]
fn a_pace_that_is_none() {
    for (dt, steps) in [(0.0, 2), (-1.0, 2), (f64::NAN, 2), (f64::INFINITY, 2), (0.25, 0)] {
        let error = error_of(|| {
            ring_with(whole_stage("idle", |_| Ok(())), move |whole| match whole.step {
                STEP => Ok(Pace { dt, steps }),
                _ => every_other_step(whole),
            })
        });
        assert_eq!(error, expected_in_whole("time step control", error.cause.clone()));
        assert!(error.to_string().contains("is no pace"), "{error}");
    }
}

/// A stage may use rayon itself. While it waits, rayon may hand its thread another sub-domain.
#[test]
fn a_stage_that_is_parallel_inside() {
    for settings in all_settings() {
        let rated: Rated = |near, _| {
            fn tree(depth: u32) -> u64 {
                if depth == 0 {
                    return 1;
                }
                let (a, b) = rayon::join(|| tree(depth - 1), || tree(depth - 1));
                std::thread::yield_now();
                a + b
            }
            assert_eq!(tree(4), 16, "sub-domain {}", near.id());
            Ok(())
        };
        let model = ring(rated, |_, _| Ok(()));
        Simulation::new(model, settings).unwrap().advance(20).unwrap();
    }
}

#[test]
fn no_workers_are_refused_but_where_there_is_always_one() {
    for schedule in Schedule::ALL {
        let settings = Settings { schedule, workers: 0, ..Settings::default() };
        let model = ring(|_, _| Ok(()), |_, _| Ok(()));
        if schedule == Schedule::Serial {
            Simulation::new(model, settings).unwrap().advance(3).unwrap();
            continue;
        }
        let error = Simulation::new(model, settings).err().expect("nobody would do the work");
        assert!(error.to_string().contains("worker"), "{error}");
    }
}
