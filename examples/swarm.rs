//! A swarm on a ring, whose members take on the mean velocity of those around (Motsch & Tadmor 2011, J.
//! Stat. Phys. 144, 923-947): particles in `Cells`, an update of its own, and steps that adapt.
use finegrain::framework::space::cells::{Cells, CellsOptions, Region, Run};
use finegrain::framework::*;

const RANGE: f64 = 0.01; // of a ring of length 1
const HASTE: f64 = 100.0; // 1/s

#[derive(Clone, Copy)]
struct Swarm {
    x: State<f64>,
    v: State<f64>,
    mean: Rate<f64>,
}

impl RateStage<Cells<f64>> for Swarm {
    type Scratch = Vec<Run>;
    fn writes(&self) -> Vec<ColumnId> {
        vec![self.mean.id()]
    }

    fn rate(
        &self,
        near: &Near<Cells<f64>>,
        rates: &mut Rates<Cells<f64>>,
        runs: &mut Vec<Run>,
        _: &Moment,
    ) -> Result<(), Fault> {
        let (x, v, block) = (near.state(self.x), near.state(self.v), near.sub_domain());
        let mean = rates.column(self.mean).whole();
        for cell in block.cells() {
            block.candidates(cell, runs);
            for i in cell.span.range().map(|i| i - near.spans()[0].start) {
                let (mut weight, mut sum) = (0.0, 0.0);
                for run in &*runs {
                    let there = near.reach(run.owner, run.span);
                    for (x_j, v_j) in x.at(there).iter().zip(v.at(there)) {
                        let distance = (x_j + run.shift[0] - x.own().whole()[i]).abs();
                        let influence = (1.0 - distance / RANGE).max(0.0);
                        weight += influence;
                        sum += influence * v_j;
                    }
                }
                // It sees itself: the weight is at least 1.
                mean[i] = sum / weight;
            }
        }
        Ok(())
    }
}

impl UpdateStage<Cells<f64>> for Swarm {
    type Scratch = ();
    /// Implicit in the velocity: stable whatever the step, and nobody becomes faster than the fastest.
    fn update(&self, own: &mut Own<Cells<f64>>, _: &mut (), at: &Moment) -> Result<(), Fault> {
        let mean = own.rate(self.mean).whole();
        let (x, v) = (own.state_mut(self.x).whole(), own.state_mut(self.v).whole());
        for ((x, v), mean) in x.iter_mut().zip(v).zip(mean) {
            *v = (*v + HASTE * at.dt * mean) / (1.0 + HASTE * at.dt);
            *x += at.dt * *v;
        }
        Ok(())
    }
}

impl Pacing<Cells<f64>> for Swarm {
    /// Sorts particles into cells, and goes as far as cells surely see all that are in range.
    fn pace(&mut self, whole: &mut Whole<Cells<f64>>) -> Result<Pace, Fault> {
        whole.domain.sort(whole.columns, whole.team)?;
        let [fastest] = whole.max(|near| {
            let speeds = near.state(self.v).own().whole().iter().map(|v| v.abs());
            [speeds.fold(0.0, f64::max)]
        });
        let dt = (0.1 / HASTE).min(0.25 * whole.domain.slack() / fastest);
        Ok(Pace { dt, steps: (whole.domain.slack() / (dt * fastest)) as u64 })
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut columns = Columns::new(10_000);
    let swarm = Swarm { x: columns.state("x"), v: columns.state("v"), mean: columns.rate("mean") };
    for (column, n) in [(swarm.x, 2.0f64), (swarm.v, 3.0)] {
        let values = columns.values_mut(column).iter_mut().zip(0..);
        values.for_each(|(value, i)| *value = (f64::from(i) * n.sqrt()).fract() - 0.5);
    }
    let region = Region { lower: vec![-0.5], upper: vec![0.5], periodic: vec![true] };
    let options = CellsOptions { region, range: RANGE, skin: 0.3 * RANGE, block_points: 256 };
    let domain = Cells::new(&mut columns, &[swarm.x], options)?;
    let plan = Step::builder().rate(swarm).update(swarm).build().into();
    let (method, pacing) = ("swarm".to_owned(), Box::new(swarm));
    let model = Model { method, domain, columns, plan, whole: Vec::new(), pacing };
    let mut simulation = Simulation::new(model, Settings::default())?;
    for _ in 0..5 {
        simulation.advance(200)?;
        let speeds = simulation.columns().values(swarm.v).iter().map(|v| v.abs());
        let fastest = speeds.fold(0.0, f64::max);
        println!("{:.3} s: the fastest moves at {fastest:.4} 1/s", simulation.clock().time());
    }
    println!("hash {:016x}", simulation.state_hash());
    Ok(())
}
