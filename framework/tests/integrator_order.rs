//! Each integrator reaches its order on problems with known solutions, with forces that depend
//! on position, on velocity and on time.

use finegrain_framework::space::Independent;
use finegrain_framework::*;

/// `x'' = -x - 2 c x' + cos(t)`, an oscillator with damping `c`, driven if `driven`.
struct Oscillator {
    position: State<f64>,
    velocity: State<f64>,
    acceleration: Rate<f64>,
    damping: f64,
    driven: bool,
}

impl RateStage<Independent> for Oscillator {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.acceleration.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Independent>,
        rates: &mut Rates<'_, Independent>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let x = near.state(self.position).own().whole();
        let v = near.state(self.velocity).own().whole();
        let force = if self.driven { moment.stage_time.cos() } else { 0.0 };
        for (i, a) in rates.column(self.acceleration).whole().iter_mut().enumerate() {
            *a = -x[i] - 2.0 * self.damping * v[i] + force;
        }
        Ok(())
    }
}

/// Error in x and v at t = 2 after `steps` steps.
fn error(integrator: Integrator, damping: f64, driven: bool, steps: u64) -> f64 {
    let domain = Independent::new(1);
    let mut columns = Columns::new(1);
    let position = columns.state("position");
    let velocity = columns.state("velocity");
    let acceleration = columns.rate("acceleration");
    columns.values_mut(position)[0] = 1.0;
    let oscillator = Stage::rate(Oscillator { position, velocity, acceleration, damping, driven });
    let evolution = Evolution::new().with_motion(position, velocity).with(velocity, acceleration);
    let plan = integrator.plan(&mut columns, &evolution, &[oscillator]);
    let end = 2.0;
    let model = Model {
        method: "oscillator".to_owned(),
        domain,
        columns,
        plan,
        whole: Vec::new(),
        pacing: Box::new(FixedPace(end / steps as f64)),
    };
    let mut simulation = Simulation::new(model, Settings::default()).unwrap();
    simulation.advance(steps).unwrap();
    let x = simulation.columns().values(position)[0];
    let v = simulation.columns().values(velocity)[0];
    let (exact_x, exact_v) = exact(damping, driven, end);
    (x - exact_x).hypot(v - exact_v)
}

/// Solution for `x(0) = 1`, `x'(0) = 0`: with damping c and w^2 = 1 - c^2, the driven particular
/// solution is `sin(t) / (2 c)` (resonance); without driving the free decay.
fn exact(c: f64, driven: bool, t: f64) -> (f64, f64) {
    let w = (1.0 - c * c).sqrt();
    let (p, dp) = if driven { (t.sin() / (2.0 * c), t.cos() / (2.0 * c)) } else { (0.0, 0.0) };
    let dp0 = if driven { 1.0 / (2.0 * c) } else { 0.0 };
    // x = e^{-ct} (a cos wt + b sin wt) + p with x(0) = 1 and x'(0) = 0.
    let (a, b) = (1.0, (c - dp0) / w);
    let (sin, cos) = (w * t).sin_cos();
    let e = (-c * t).exp();
    let free = e * (a * cos + b * sin);
    let dfree = -c * free + e * w * (b * cos - a * sin);
    (free + p, dfree + dp)
}

fn measured_order(integrator: Integrator, damping: f64, driven: bool) -> f64 {
    let (coarse, fine) =
        (error(integrator, damping, driven, 64), error(integrator, damping, driven, 128));
    (coarse / fine).log2()
}

#[test]
fn conservative_force() {
    for integrator in Integrator::ALL {
        let order = measured_order(integrator, 0.0, false);
        assert!((order - f64::from(integrator.order())).abs() < 0.1, "{integrator:?}: {order}");
    }
}

#[test]
fn force_that_depends_on_velocity() {
    for integrator in Integrator::ALL {
        let order = measured_order(integrator, 0.3, false);
        assert!((order - f64::from(integrator.order())).abs() < 0.15, "{integrator:?}: {order}");
    }
}

/// Fails at first order if a stage is handed the step's time instead of its own.
#[test]
fn force_that_depends_on_time() {
    for integrator in Integrator::ALL {
        let order = measured_order(integrator, 0.3, true);
        assert!((order - f64::from(integrator.order())).abs() < 0.15, "{integrator:?}: {order}");
    }
}

/// `x' = v - 2 c x`, `v' = -x`: the damped oscillator, with the damping as a drift of `x`.
struct Drifting {
    position: State<f64>,
    acceleration: Rate<f64>,
    drift: Rate<f64>,
    damping: f64,
}

impl RateStage<Independent> for Drifting {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.acceleration.id(), self.drift.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Independent>,
        rates: &mut Rates<'_, Independent>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let x = near.state(self.position).own().whole()[0];
        rates.column(self.acceleration).whole()[0] = -x;
        rates.column(self.drift).whole()[0] = -2.0 * self.damping * x;
        Ok(())
    }
}

fn error_with_drift(integrator: Integrator, steps: u64) -> f64 {
    let damping = 0.2;
    let mut columns = Columns::new(1);
    let position = columns.state("position");
    let velocity = columns.state("velocity");
    let acceleration = columns.rate("acceleration");
    let drift = columns.rate("drift");
    columns.values_mut(position)[0] = 1.0;
    // At rest: x' = 0.
    columns.values_mut(velocity)[0] = 2.0 * damping;
    let drifting = Stage::rate(Drifting { position, acceleration, drift, damping });
    let evolution = Evolution::new()
        .with_motion(position, velocity)
        .with_drift(position, drift)
        .with(velocity, acceleration);
    let plan = integrator.plan(&mut columns, &evolution, &[drifting]);
    let end = 2.0;
    let model = Model {
        method: "drifting".to_owned(),
        domain: Independent::new(1),
        columns,
        plan,
        whole: Vec::new(),
        pacing: Box::new(FixedPace(end / steps as f64)),
    };
    let mut simulation = Simulation::new(model, Settings::default()).unwrap();
    simulation.advance(steps).unwrap();
    let x = simulation.columns().values(position)[0];
    let v = simulation.columns().values(velocity)[0];
    let (exact_x, rate) = exact(damping, false, end);
    (x - exact_x).hypot(v - (rate + 2.0 * damping * exact_x))
}

#[test]
fn motion_with_a_drift() {
    for integrator in Integrator::ALL {
        // Leapfrog takes the drift to first order, as it says.
        let expected = if integrator == Integrator::Leapfrog { 1 } else { integrator.order() };
        let order = (error_with_drift(integrator, 64) / error_with_drift(integrator, 128)).log2();
        assert!((order - f64::from(expected)).abs() < 0.15, "{integrator:?}: {order}");
    }
}
