//! Whole-domain stages inside a step: when they run, what they see, and how they fail.

mod models;

use std::sync::{Arc, Mutex};

use finegrain_framework::space::Grid;
use finegrain_framework::*;
use models::closures::{rate_stage, update_stage, whole_in_step};

const POINTS: usize = 40;
const DT: f64 = 0.25;

/// What whole-domain stages were told: step, time and length of the step.
type Seen = Arc<Mutex<Vec<(u64, f64, f64)>>>;

/// A ring in which values spread to neighbours, lose their mean, spread again, and are shifted by the
/// time, so that fields change places before, between and after the two whole-domain stages.
fn ring(seen: &Seen, fails_at: u64) -> (Model<Grid>, State<f64>) {
    let domain = Grid::builder([1, POINTS]).periodic([false, true]).tile(3, 1).build();
    let mut columns = Columns::new(domain.points());
    let (u, next) = (columns.state("u"), columns.rate("next"));
    for (i, u) in columns.values_mut(u).iter_mut().enumerate() {
        *u = start(i);
    }
    let spread = rate_stage("spread", &[next.id()], move |near, rates, _| {
        let (now, mut next) = (near.rows(u), rates.rows(next));
        for (j, k) in near.sub_domain().rows() {
            let at = |dj: isize| now.row(j as isize + dj, k as isize)[0];
            next.row(j, k)[0] = spread(at(-1), at(0), at(1));
        }
        Ok(())
    });
    let centre = whole_in_step("centre", move |whole: &mut Whole<'_, Grid>| {
        let mean = mean(whole.columns.values(u));
        whole.team.for_each_chunk(whole.columns.values_mut(u), 7, |_, chunk| {
            chunk.iter_mut().for_each(|u| *u -= mean);
        });
        Ok(())
    });
    let told = Arc::clone(seen);
    let look = whole_in_step("look", move |whole: &mut Whole<'_, Grid>| {
        if whole.step == fails_at {
            return Err(Fault::new("enough"));
        }
        told.lock().unwrap().push((whole.step, whole.time, whole.dt));
        Ok(())
    });
    let shift = update_stage("shift", move |own: &mut Own<'_, Grid>, moment: &Moment| {
        own.state_mut(u).whole().iter_mut().for_each(|u| *u += 0.1 * moment.time);
        Ok(())
    });
    let step = Step::builder()
        .stage_at(0.0, &spread)
        .swap(u, next)
        .stage_at(0.0, &centre)
        .stage_at(0.5, &spread)
        .swap(u, next)
        .stage_at(0.5, &look)
        .stage_at(0.5, &spread)
        .stage_at(0.5, &centre)
        .swap(u, next)
        .stage_at(0.5, &shift)
        .build();
    (Model::with_fixed_dt("ring", domain, columns, step, DT), u)
}

fn start(i: usize) -> f64 {
    (i as f64 * 0.7).sin() + 0.3
}

fn spread(left: f64, here: f64, right: f64) -> f64 {
    here + 0.2 * (left - 2.0 * here + right)
}

fn mean(u: &[f64]) -> f64 {
    u.iter().sum::<f64>() / u.len() as f64
}

/// The same in plain loops.
fn expected(steps: u64) -> Vec<f64> {
    let spread = |u: &[f64]| -> Vec<f64> {
        let at = |i: usize| u[i % POINTS];
        (0..POINTS).map(|i| spread(at(i + POINTS - 1), at(i), at(i + 1))).collect()
    };
    let mut u: Vec<f64> = (0..POINTS).map(start).collect();
    for step in 0..steps {
        u = spread(&u);
        let middle = mean(&u);
        u.iter_mut().for_each(|u| *u -= middle);
        u = spread(&u);
        // What is centred next are the values before they have spread, which are then dropped.
        u = spread(&u);
        u.iter_mut().for_each(|u| *u += 0.1 * step as f64 * DT);
    }
    u
}

#[test]
fn every_schedule_runs_them_where_they_stand() {
    for schedule in Schedule::ALL {
        for workers in [1, 3] {
            let seen = Seen::default();
            let (model, u) = ring(&seen, u64::MAX);
            let settings = Settings { schedule, workers, trace: 100, ..Settings::default() };
            let mut simulation = Simulation::new(model, settings).unwrap();
            // In goes of odd and even length.
            for (steps, so_far) in [(1, 1), (4, 5), (2, 7)] {
                simulation.advance(steps).unwrap();
                assert_eq!(simulation.columns().values(u), expected(so_far), "{schedule}");
            }
            let told: Vec<_> = (0..7).map(|n| (n, (n as f64 + 0.5) * DT, DT)).collect();
            assert_eq!(*seen.lock().unwrap(), told);
            let trace = simulation.trace().unwrap();
            let names = trace.whole().into_iter().map(|e| trace.parts()[e.part as usize].clone());
            let order = ["centre", "look", "centre"].iter().cycle().take(21);
            assert!(names.eq(order.copied()), "{schedule}");
            let summary = trace.summary();
            assert!(summary.whole > 0.0 && summary.stages.iter().any(|(name, _)| name == "look"));
        }
    }
}

#[test]
fn one_that_fails_says_where() {
    for schedule in Schedule::ALL {
        let (model, _) = ring(&Seen::default(), 2);
        let settings = Settings { schedule, workers: 2, ..Settings::default() };
        let error = Simulation::new(model, settings).unwrap().advance(5).unwrap_err();
        let found = (error.step, error.stage.as_str(), error.sub_domain);
        assert_eq!(found, (2, "look", None));
        assert_eq!(error.cause, Cause::Fault(Fault::new("enough")));
    }
}

/// The check of the state is made after the last part of the workers.
#[test]
fn a_value_that_is_not_finite_is_found() {
    let (mut model, u) = ring(&Seen::default(), u64::MAX);
    model.columns.values_mut(u)[17] = f64::NAN;
    let settings = Settings { check_every: Some(1), ..Settings::default() };
    let error = Simulation::new(model, settings).unwrap().advance(1).unwrap_err();
    assert_eq!(error.cause, Cause::NotFinite { column: "u".to_owned() });
}
