//! A plate that relaxes by bending, `u' = -lap lap u`: two rate stages, the second of which reads
//! what its neighbours' first one wrote.

use finegrain_framework::space::Grid;
use finegrain_framework::space::grid::{Rows, RowsMut};
use finegrain_framework::*;

use super::random::Random;

struct Curvature {
    deflection: State<f32>,
    curvature: Rate<f32>,
}

struct Bending {
    curvature: Rate<f32>,
    velocity: Rate<f32>,
}

/// `factor` times the five-point Laplacian of a periodic plane.
fn laplacian(near: &Near<'_, Grid>, of: &Rows<'_, f32>, to: &mut RowsMut<'_, f32>, factor: f32) {
    for (j, k) in near.sub_domain().rows() {
        let row = |dj: isize| of.row(j as isize + dj, k as isize);
        let (south, here, north) = (row(-1), row(0), row(1));
        let n = here.len();
        for (i, to) in to.row(j, k).iter_mut().enumerate() {
            let (west, east) = (here[(i + n - 1) % n], here[(i + 1) % n]);
            *to = factor * (south[i] + north[i] + west + east - 4.0 * here[i]);
        }
    }
}

impl RateStage<Grid> for Curvature {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.curvature.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        laplacian(near, &near.rows(self.deflection), &mut rates.rows(self.curvature), 1.0);
        Ok(())
    }
}

impl RateStage<Grid> for Bending {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.velocity.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        if (near.id() as u64 * 5 + moment.step).is_multiple_of(3) {
            std::thread::yield_now();
        }
        laplacian(near, &near.rate_rows(self.curvature), &mut rates.rows(self.velocity), -1.0);
        Ok(())
    }
}

/// A periodic plate stepped by `integrator`.
pub fn plate(shape: [usize; 2], rows: usize, integrator: Integrator) -> Model<Grid> {
    let domain = Grid::builder(shape).periodic([true; 2]).tile(rows, 1).build();
    let mut columns = Columns::new(domain.points());
    let deflection = columns.state("deflection");
    let (curvature, velocity) = (columns.rate("curvature"), columns.rate("velocity"));
    let mut random = Random(shape.iter().sum::<usize>() as u64);
    columns.values_mut(deflection).fill_with(|| random.unit() as f32);
    let evaluation = [
        Stage::rate(Curvature { deflection, curvature }),
        Stage::rate(Bending { curvature, velocity }),
    ];
    let evolution = Evolution::new().with(deflection, velocity);
    let plan = integrator.plan(&mut columns, &evolution, &evaluation);
    Model::with_fixed_dt("plate", domain, columns, plan, 0.01)
}
