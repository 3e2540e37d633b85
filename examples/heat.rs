//! The 2-D heat equation as a new method: a rate stage that computes the next temperature.
use finegrain::framework::{space::Grid, *};

const N: usize = 512;

struct Diffusion {
    temperature: State<f64>,
    next: Rate<f64>,
    number: f64, // diffusivity dt / dx^2, at most 1/4
}

impl RateStage<Grid> for Diffusion {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.next.id()]
    }

    fn rate(
        &self,
        near: &Near<Grid>,
        rates: &mut Rates<Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let (now, mut next) = (near.rows(self.temperature), rates.rows(self.next));
        for (j, k) in near.sub_domain().rows() {
            let row = |dj| now.row(j as isize + dj, k as isize);
            let (south, here, north) = (row(-1), row(0), row(1));
            let next = next.row(j, k);
            let laplacian =
                |i: usize, west, east| west + east + south[i] + north[i] - 4.0 * here[i];
            for i in 1..N - 1 {
                next[i] = here[i] + self.number * laplacian(i, here[i - 1], here[i + 1]);
            }
            next[0] = here[0] + self.number * laplacian(0, here[N - 1], here[1]);
            next[N - 1] = here[N - 1] + self.number * laplacian(N - 1, here[N - 2], here[0]);
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for schedule in Schedule::ALL {
        let domain = Grid::builder([N, N]).periodic([true, true]).build();
        let mut columns = Columns::new(domain.points());
        let (temperature, next) = (columns.state("temperature"), columns.rate("next"));
        columns.values_mut(temperature)[N * N / 2 + N / 2] = 1.0;
        let diffusion = Diffusion { temperature, next, number: 0.2 };
        let step = Step::builder().rate(diffusion).swap(temperature, next).build();
        let model = Model::with_fixed_dt("heat", domain, columns, step, 1.0);
        let mut simulation = Simulation::new(model, Settings { schedule, ..Settings::default() })?;
        let start = std::time::Instant::now();
        simulation.advance(500)?;
        println!(
            "{schedule:12} {:016x} {:.3} s",
            simulation.state_hash(),
            start.elapsed().as_secs_f64()
        );
    }
    Ok(())
}
