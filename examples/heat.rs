//! The 2-D heat equation as a new method: a rate stage that computes the next temperature.
//!
//! A sub-domain is a set of rows of `N` points along x; `(j, k)` is a row's place along y and z. Row `j - 1` of the first
//! row is the last one, since y is periodic; the ends of a row are the stage's own affair.
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
            let row = |dj| &now.row(j as isize + dj, k as isize)[..N];
            let (south, here, north) = (row(-1), row(0), row(1));
            let next = &mut next.row(j, k)[..N];
            let mut advance = |i: usize, west: usize, east: usize| {
                let around = here[west] + here[east] + south[i] + north[i];
                next[i] = here[i] + self.number * (around - 4.0 * here[i]);
            };
            advance(0, N - 1, 1);
            (1..N - 1).for_each(|i| advance(i, i - 1, i + 1));
            advance(N - 1, N - 2, 0);
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut first = None;
    for schedule in Schedule::ALL {
        let domain = Grid::builder([N, N]).periodic([true, true]).build();
        let mut columns = Columns::new(domain.points());
        let (temperature, next) = (columns.state("temperature"), columns.rate("next"));
        columns.values_mut(temperature)[N * N / 2 + N / 2] = 1.0;
        let diffusion = Diffusion { temperature, next, number: 0.2 };
        // The stage computes the next temperature whole, so it is swapped in. A stage that computes a time derivative
        // leaves the rest to an `Integrator`, as in lorenz.rs (alone) and gray_scott.rs (on a grid).
        let step = Step::builder().rate(diffusion).swap(temperature, next).build();
        // `number` has the time step in it; what is given here is only what the clock counts, so steps.
        let model = Model::with_fixed_dt("heat", domain, columns, step, 1.0);
        let mut simulation = Simulation::new(model, Settings { schedule, ..Settings::default() })?;
        let start = std::time::Instant::now();
        simulation.advance(500)?;
        let (time, hash) = (start.elapsed(), simulation.state_hash());
        println!("{schedule:12} {hash:016x} {time:.1?}");
        assert_eq!(hash, *first.get_or_insert(hash), "the same bits under every schedule");
    }
    Ok(())
}
