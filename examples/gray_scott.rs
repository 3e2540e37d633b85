//! The Gray-Scott reaction (Pearson 1993, Science 261, 189-192) between walls, as a run: a history,
//! fields for ParaView, checkpoints, and restart. Ctrl-C is `stop_on`; see `finegrain run`.
//!
//! `cargo run --release --example gray_scott` goes to step 4,000; with the name of a checkpoint that
//! it has written it goes on from there, and ends with the same hash.
use finegrain::framework::run::{Dump, Every, Run, RunFailed, Until};
use finegrain::framework::space::grid::Rows;
use finegrain::framework::{space::Grid, *};

const N: usize = 200;

struct GrayScott {
    state: [State<f64>; 2],
    rates: [Rate<f64>; 2],
}

impl RateStage<Grid> for GrayScott {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        self.rates.map(Handle::id).into()
    }

    fn rate(
        &self,
        near: &Near<Grid>,
        rates: &mut Rates<Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let (feed, kill, diffusivity) = (0.037, 0.06, [0.16, 0.08]);
        let [u, v] = self.state.map(|field| near.rows(field));
        let [mut du, mut dv] = self.rates.map(|rate| rates.rows(rate));
        for (j, k) in near.sub_domain().rows() {
            let (u, v) = (around(&u, j, k), around(&v, j, k));
            let (du, dv) = (du.row(j, k), dv.row(j, k));
            for i in 0..N {
                let reaction = u[1][i] * v[1][i] * v[1][i];
                du[i] = diffusivity[0] * laplacian(&u, i) - reaction + feed * (1.0 - u[1][i]);
                dv[i] = diffusivity[1] * laplacian(&v, i) + reaction - (feed + kill) * v[1][i];
            }
        }
        Ok(())
    }
}

/// A row with those below and above it. No flux goes through the walls: what would lie behind one is
/// as what lies before it.
fn around<'a>(rows: &Rows<'a, f64>, j: usize, k: usize) -> [&'a [f64]; 3] {
    let row = |dj: isize| rows.get(j as isize + dj, k as isize);
    let here = rows.row(j as isize, k as isize);
    [row(-1).unwrap_or(here), here, row(1).unwrap_or(here)]
}

fn laplacian([below, here, above]: &[&[f64]; 3], i: usize) -> f64 {
    let beside = here[i.saturating_sub(1)] + here[(i + 1).min(N - 1)];
    below[i] + beside + above[i] - 4.0 * here[i]
}

fn model() -> Model<Grid> {
    let domain = Grid::builder([N, N]).build();
    let mut columns = Columns::new(domain.points());
    let state = ["u", "v"].map(|name| columns.state(name));
    let rates = ["du", "dv"].map(|name| columns.rate(name));
    columns.values_mut(state[0]).fill(1.0);
    for j in N / 2 - 8..N / 2 + 8 {
        columns.values_mut(state[0])[j * N + N / 2 - 8..][..16].fill(0.5);
        columns.values_mut(state[1])[j * N + N / 2 - 8..][..16].fill(0.25);
    }
    let reaction = Stage::rate(GrayScott { state, rates });
    let evolution = Evolution::new().with(state[0], rates[0]).with(state[1], rates[1]);
    let plan = Integrator::Rk2.plan(&mut columns, &evolution, &[reaction]);
    Model::with_fixed_dt("gray-scott", domain, columns, plan, 1.0)
}

fn main() -> Result<(), RunFailed> {
    let model = model();
    let v = model.columns.find_state::<f64>("v").expect("the model has it");
    let simulation = Simulation::new(model, Settings::default()).expect("threads");
    let mut run = Run::new(simulation)
        .scene(format!("Gray-Scott, {N} x {N}"))
        .until(Until { steps: Some(4000), ..Until::default() })
        .out("out/gray-scott")
        .monitor("total", Every::Steps(50), ["v"], move |whole| {
            whole.sum(|near| {
                let part = near.state(v).own();
                [(0..near.spans().len()).flat_map(|k| part.span(k)).sum()]
            })
        })
        .dump(Dump::new("fields", Every::Steps(500)).scalar("u").scalar("v"))
        .checkpoint(Every::Steps(1000), 3);
    if let Some(checkpoint) = std::env::args().nth(1) {
        run = run.restart_from(checkpoint);
    }
    let summary = run.run()?;
    println!("{} at step {}, state {:016x}", summary.stopped, summary.step, summary.state_hash);
    Ok(())
}
