//! Particles that repel one another within a range, stepped by leapfrog and re-sorted into their
//! cells as often as the fastest one demands.

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{CellsOptions, Region, Run};
use finegrain_framework::*;

use super::random::Random;

struct Repulsion<const D: usize> {
    position: [State<f64>; D],
    stiffness: State<f32>,
    acceleration: [Rate<f64>; D],
}

/// Room for the runs around any cell from the start: how far a worker's scratch has grown by some
/// step depends on what it happened to be handed.
struct Seen(Vec<Run>);

impl Default for Seen {
    fn default() -> Self {
        Self(Vec::with_capacity(256))
    }
}

impl<const D: usize> RateStage<Cells<f64>> for Repulsion<D> {
    type Scratch = Seen;

    fn writes(&self) -> Vec<ColumnId> {
        self.acceleration.map(|a| a.id()).to_vec()
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<f64>>,
        rates: &mut Rates<'_, Cells<f64>>,
        Seen(runs): &mut Seen,
        _: &Moment,
    ) -> Result<(), Fault> {
        let block = near.sub_domain();
        let range = block.domain().range();
        let first = near.spans()[0].start;
        let position = self.position.map(|x| near.state(x));
        let own = position.map(|x| x.own().whole());
        let stiffness = near.state(self.stiffness);
        let mut acceleration = self.acceleration.map(|a| rates.column(a).whole());
        for cell in block.cells() {
            block.candidates(cell, runs);
            for i in cell.span.range().map(|i| i - first) {
                let mut sum = [0.0; D];
                for run in &*runs {
                    let reach = near.reach(run.owner, run.span);
                    let (theirs, stiffness) = (position.map(|x| x.at(reach)), stiffness.at(reach));
                    for (j, &stiffness) in stiffness.iter().enumerate() {
                        let away: [f64; D] =
                            std::array::from_fn(|a| own[a][i] - (theirs[a][j] + run.shift[a]));
                        let distance = away.iter().map(|d| d * d).sum::<f64>().sqrt();
                        if distance > 0.0 && distance < range {
                            let force = f64::from(stiffness) * (1.0 / distance - 1.0 / range);
                            for (sum, away) in sum.iter_mut().zip(away) {
                                *sum += force * away;
                            }
                        }
                    }
                }
                for (a, sum) in acceleration.iter_mut().zip(sum) {
                    a[i] = sum;
                }
            }
        }
        Ok(())
    }
}

/// Sorts particles into their cells.
pub struct Sorting;

impl WholeStage<Cells<f64>> for Sorting {
    fn name(&self) -> &str {
        "sorting"
    }

    fn run(&mut self, whole: &mut Whole<'_, Cells<f64>>) -> Result<(), Fault> {
        whole.domain.sort(whole.columns, whole.team)
    }
}

/// As many steps as the fastest particle takes to move by half of what the skin allows.
struct SkinPace<const D: usize> {
    velocity: [State<f64>; D],
    dt: f64,
}

impl<const D: usize> Pacing<Cells<f64>> for SkinPace<D> {
    fn pace(&mut self, whole: &mut Whole<'_, Cells<f64>>) -> Result<Pace, Fault> {
        let velocity = self.velocity;
        let [fastest] = whole.max(|near| {
            let v = velocity.map(|v| near.state(v).own().whole());
            let squares = (0..v[0].len()).map(|i| v.iter().map(|v| v[i] * v[i]).sum::<f64>());
            [squares.fold(0.0, f64::max)]
        });
        let steps = 0.5 * whole.domain.slack() / (self.dt * fastest.sqrt());
        Ok(Pace { dt: self.dt, steps: (steps as u64).clamp(1, 20) })
    }
}

/// Where particles live and how many there are.
#[derive(Clone)]
pub struct Swarm<const D: usize> {
    pub points: usize,
    pub size: [f64; D],
    pub periodic: [bool; D],
    pub range: f64,
    pub block_points: usize,
}

impl<const D: usize> Swarm<D> {
    /// Particles anywhere in the box, each moving somewhere.
    pub fn model(&self) -> Model<Cells<f64>> {
        let mut columns = Columns::new(self.points);
        let axes = ["x", "y", "z"];
        let position: [State<f64>; D] =
            std::array::from_fn(|a| columns.state(&format!("position_{}", axes[a])));
        let velocity: [State<f64>; D] =
            std::array::from_fn(|a| columns.state(&format!("velocity_{}", axes[a])));
        let acceleration: [Rate<f64>; D] =
            std::array::from_fn(|a| columns.rate(&format!("acceleration_{}", axes[a])));
        // Columns of every width, so that re-sorting moves them all.
        let stiffness = columns.state::<f32>("stiffness");
        let number = columns.state::<u32>("number");
        let kind = columns.state::<u8>("kind");
        let mut random = Random(self.points as u64);
        for a in 0..D {
            columns.values_mut(position[a]).fill_with(|| random.unit() * self.size[a]);
            columns.values_mut(velocity[a]).fill_with(|| random.unit() - 0.5);
        }
        columns.values_mut(stiffness).fill_with(|| 0.01 + 0.01 * random.unit() as f32);
        columns.values_mut(number).iter_mut().zip(0..).for_each(|(n, i)| *n = i);
        columns.values_mut(kind).iter_mut().zip(0..).for_each(|(k, i): (_, u32)| *k = i as u8);
        let options = CellsOptions {
            region: Region {
                lower: vec![0.0; D],
                upper: self.size.to_vec(),
                periodic: self.periodic.to_vec(),
            },
            range: self.range,
            skin: 0.3 * self.range,
            block_points: self.block_points,
        };
        let domain = Cells::new(&mut columns, &position, options).unwrap();
        let evolution = (0..D).fold(Evolution::new(), |evolution, a| {
            evolution.with_motion(position[a], velocity[a]).with(velocity[a], acceleration[a])
        });
        let stage = Stage::rate(Repulsion { position, stiffness, acceleration });
        let plan = Integrator::Leapfrog.plan(&mut columns, &evolution, &[stage]);
        Model {
            method: "particles".to_owned(),
            domain,
            columns,
            plan,
            whole: vec![Box::new(Sorting)],
            pacing: Box::new(SkinPace { velocity, dt: 0.03 * self.range }),
        }
    }
}
