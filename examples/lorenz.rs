//! The Lorenz (1963) system from many initial conditions: a method without a grid.
use finegrain::framework::{space::Independent, *};

struct Lorenz([State<f64>; 3], [Rate<f64>; 3]);
impl RateStage<Independent> for Lorenz {
    type Scratch = ();
    fn writes(&self) -> Vec<ColumnId> {
        self.1.map(Handle::id).into()
    }
    fn rate(
        &self,
        near: &Near<Independent>,
        rates: &mut Rates<Independent>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let [x, y, z] = self.0.map(|column| near.state(column).own().whole());
        let [dx, dy, dz] = self.1.map(|column| rates.column(column).whole());
        for i in 0..x.len() {
            dx[i] = 10.0 * (y[i] - x[i]);
            dy[i] = x[i] * (28.0 - z[i]) - y[i];
            dz[i] = x[i] * y[i] - 8.0 / 3.0 * z[i];
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut columns = Columns::new(300);
    let state = ["x", "y", "z"].map(|name| columns.state(name));
    let rate = ["dx/dt", "dy/dt", "dz/dt"].map(|name| columns.rate(name));
    columns.values_mut(state[0]).iter_mut().zip(1..).for_each(|(x, i)| *x = 1e-6 * f64::from(i));
    let evolution = (0..3).fold(Evolution::new(), |all, i| all.with(state[i], rate[i]));
    let plan = Integrator::Rk4.plan(&mut columns, &evolution, &[Stage::rate(Lorenz(state, rate))]);
    let model = Model::with_fixed_dt("lorenz", Independent::new(300), columns, plan, 0.01);
    let mut run = Simulation::new(model, Settings::default())?;
    run.advance(4000)?; // what began a millionth apart is anywhere by now
    println!("x = {:.4?}, hash {:016x}", &run.columns().values(state[0])[..4], run.state_hash());
    Ok(())
}
