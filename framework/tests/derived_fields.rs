//! Fields that are computed only when somebody looks, and run ends that a rigid time step keeps to.

use finegrain_framework::run::{Every, Run, Stopped, Until};
use finegrain_framework::space::Grid;
use finegrain_framework::*;

/// A number for every point that grows by dt a step, or what is twice as much.
struct Growth {
    number: State<f64>,
    next: Rate<f64>,
}

impl RateStage<Grid> for Growth {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.next.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let (now, mut next) = (near.rows(self.number), rates.rows(self.next));
        for (j, k) in near.sub_domain().rows() {
            let row = now.row(j as isize, k as isize);
            for (next, now) in next.row(j, k).iter_mut().zip(row) {
                *next = now + moment.dt;
            }
        }
        Ok(())
    }
}

struct Double {
    number: State<f64>,
    double: Rate<f64>,
}

impl RateStage<Grid> for Double {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.double.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let (number, mut double) = (near.rows(self.number), rates.rows(self.double));
        for (j, k) in near.sub_domain().rows() {
            let row = number.row(j as isize, k as isize);
            for (double, number) in double.row(j, k).iter_mut().zip(row) {
                *double = 2.0 * number;
            }
        }
        Ok(())
    }
}

struct Reset(State<f64>);

impl UpdateStage<Grid> for Reset {
    type Scratch = ();

    fn update(&self, own: &mut Own<'_, Grid>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        own.state_mut(self.0).span(0).fill(0.0);
        Ok(())
    }
}

fn model(derived: impl Fn(State<f64>, Rate<f64>) -> Step<Grid>) -> (Model<Grid>, Rate<f64>) {
    let domain = Grid::builder([4, 6]).tile(2, 1).build();
    let mut columns = Columns::new(domain.points());
    let (number, next) = (columns.state("number"), columns.rate("next"));
    let double = columns.rate("double");
    let step = Step::builder().rate(Growth { number, next }).swap(number, next).build();
    let mut plan = Plan::from(step);
    plan.derived = Some(derived(number, double));
    let mut model = Model::with_fixed_dt("growth", domain, columns, plan, 0.1);
    model.pacing = Box::new(RigidPace(0.1));
    (model, double)
}

fn doubles() -> (Simulation<Grid>, Rate<f64>) {
    let (model, double) =
        model(|number, double| Step::builder().rate(Double { number, double }).build());
    let settings = Settings { workers: 2, ..Settings::default() };
    (Simulation::new(model, settings).unwrap(), double)
}

#[test]
fn whoever_looks_sees_the_present() {
    let (simulation, double) = doubles();
    let mut run = Run::new(simulation)
        .until(Until { steps: Some(7), ..Until::default() })
        .monitor("mean", Every::Steps(3), ["double"], move |whole| {
            whole.sum(|near| [near.rate(double).own().whole().iter().sum::<f64>() / 24.0])
        })
        .stop_when(Every::Steps(1), move |whole, _| {
            let expected = 0.2 * whole.step as f64;
            let wrong = |x: &f64| (x - expected).abs() > 1e-14;
            assert!(!whole.columns.values(double).iter().any(wrong));
            false
        });
    let summary = run.run().unwrap();
    let rows: Vec<f64> = summary.histories[0].column("double").unwrap().collect();
    for (row, expected) in rows.iter().zip([0.0, 0.6, 1.2]) {
        assert!((row - expected).abs() < 1e-14, "{rows:?}");
    }
    assert_eq!(rows.len(), 3);
    let at_the_end = run.simulation().columns().values(double);
    assert!(at_the_end.iter().all(|x| (x - 1.4).abs() < 1e-14));
}

#[test]
fn they_are_brought_up_to_date_only_when_asked() {
    let (mut simulation, double) = doubles();
    simulation.advance(2).unwrap();
    assert_eq!(simulation.columns().values(double)[0], 0.0);
    simulation.derive().unwrap();
    assert_eq!(simulation.columns().values(double)[0], 0.4);
}

#[test]
#[should_panic(expected = "changes the state")]
fn looking_must_not_change_the_state() {
    let (model, _) = model(|number, _| Step::builder().update(Reset(number)).build());
    let _ = Simulation::new(model, Settings::default());
}

#[test]
fn a_rigid_step_ends_with_the_first_that_reaches_the_end() {
    for (end, steps, time) in [(0.35, 4, 0.4), (0.3, 3, 0.3), (0.7, 7, 0.7), (0.05, 1, 0.1)] {
        let mut run = Run::new(doubles().0).until(Until { time: Some(end), ..Until::default() });
        let summary = run.run().unwrap();
        assert_eq!((summary.stopped, summary.step), (Stopped::Time, steps), "{end}");
        assert!((summary.time - time).abs() < 1e-15 && summary.time >= end, "{}", summary.time);
    }
}
