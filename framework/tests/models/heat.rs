//! Heat by a stencil whose rates are the next state, which is then swapped in.

use finegrain_framework::space::Grid;
use finegrain_framework::*;

use super::random::Random;

/// The next temperature from the seven-point stencil; insulated where the grid is bounded.
pub struct Diffusion {
    now: State<f64>,
    next: Rate<f64>,
    number: f64,
}

impl RateStage<Grid> for Diffusion {
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
        // Some sub-domains dawdle, others at every step, so that more interleavings occur than
        // even costs would show.
        if (near.id() as u64 * 7 + moment.step).is_multiple_of(5) {
            std::thread::yield_now();
        }
        let (now, mut next) = (near.rows(self.now), rates.rows(self.next));
        let wraps = near.domain().periodic()[0];
        for (j, k) in near.sub_domain().rows() {
            let (j, k) = (j, k);
            let here = now.row(j as isize, k as isize);
            let beside =
                |dj: isize, dk: isize| now.get(j as isize + dj, k as isize + dk).unwrap_or(here);
            let rows = [beside(-1, 0), beside(1, 0), beside(0, -1), beside(0, 1)];
            let last = here.len() - 1;
            for (i, next) in next.row(j, k).iter_mut().enumerate() {
                let west = if i > 0 {
                    i - 1
                } else if wraps {
                    last
                } else {
                    i
                };
                let east = if i < last {
                    i + 1
                } else if wraps {
                    0
                } else {
                    i
                };
                let around: f64 = rows.iter().map(|row| row[i]).sum();
                *next = here[i] + self.number * (around + here[west] + here[east] - 6.0 * here[i]);
            }
        }
        Ok(())
    }
}

/// Random temperatures that spread, `passes` stencils and swaps a step.
pub fn heat<const D: usize>(
    shape: [usize; D],
    periodic: bool,
    tile: [usize; 2],
    passes: usize,
) -> Model<Grid> {
    let domain = Grid::builder(shape).periodic([periodic; D]).tile(tile[0], tile[1]).build();
    let mut columns = Columns::new(domain.points());
    let (now, next) = (columns.state("temperature"), columns.rate("next"));
    let mut random = Random(shape.iter().sum::<usize>() as u64);
    columns.values_mut(now).fill_with(|| random.unit());
    let stage = Stage::rate(Diffusion { now, next, number: 0.1 });
    let step = (0..passes)
        .fold(Step::builder(), |step, _| step.stage_at(0.0, &stage).swap(now, next))
        .build();
    Model::with_fixed_dt("heat", domain, columns, step, 1.0)
}
