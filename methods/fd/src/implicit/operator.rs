//! The matrix of an equation, from its explicit stage.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use finegrain_framework::space::Grid;
use finegrain_framework::{
    Columns, Model, Rate, Schedule, Settings, Simulation, Stage, State, Step,
};

/// What a rate stage along one axis makes of the unknown there: a matrix, by columns.
#[derive(Clone, Debug)]
pub struct AxisOperator {
    /// Of every point the points of which it changes the rates, and by how much; in order.
    columns: Vec<Vec<(usize, f64)>>,
    /// Weights of the points in the norm.
    weights: Vec<f64>,
}

impl AxisOperator {
    /// Asks the stage what it makes of an unknown that is 1 at one point and 0 elsewhere, of all points in turn; it must
    /// be linear, with nothing imposed at the ends but zero.
    pub fn probe(
        domain: Grid,
        columns: Columns,
        stage: &Stage<Grid>,
        unknown: State<f64>,
        rate: Rate<f64>,
        weights: Vec<f64>,
    ) -> Self {
        let step = Step::builder().stage_at(0.0, stage).build();
        let model = Model::with_fixed_dt("probe", domain, columns, step, 1.0);
        let settings = Settings {
            schedule: Schedule::Serial,
            workers: 1,
            check_every: None,
            ..Settings::default()
        };
        let mut simulation =
            Simulation::new(model, settings).expect("a single worker needs no thread");
        let mut column = |j: usize| -> Vec<(usize, f64)> {
            simulation.whole().columns.values_mut(unknown)[j] = 1.0;
            simulation.advance(1).expect("stages of differences do not fail");
            let columns = simulation.whole().columns;
            columns.values_mut(unknown)[j] = 0.0;
            let rates = columns.values(rate).iter().copied().enumerate();
            rates.filter(|&(_, c)| c != 0.0).collect()
        };
        Self { columns: (0..weights.len()).map(&mut column).collect(), weights }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.columns.len()
    }

    /// Whether it is symmetric in the norm, but for rounding.
    pub fn is_symmetric(&self) -> bool {
        let entry = |i: usize, j: usize| {
            let found = self.columns[j].iter().find(|&&(row, _)| row == i);
            self.weights[i] * found.map_or(0.0, |&(_, c)| c)
        };
        let entries = || {
            let of = |j: usize| self.columns[j].iter().map(move |&(i, _)| (i, j));
            (0..self.points()).flat_map(of)
        };
        let largest = entries().map(|(i, j)| entry(i, j).abs()).fold(0.0, f64::max);
        entries().all(|(i, j)| (entry(i, j) - entry(j, i)).abs() <= 1e-12 * largest)
    }
}

/// The sum of operators along 1 to 3 axes, x running fastest.
#[derive(Clone, Debug)]
pub struct Operator(pub Vec<AxisOperator>);

impl Operator {
    /// Number of points.
    pub fn points(&self) -> usize {
        self.0.iter().map(AxisOperator::points).product()
    }

    /// Weights of the points in the norm.
    pub fn weights(&self) -> Vec<f64> {
        self.0.iter().fold(vec![1.0], |inner, axis| {
            axis.weights.iter().flat_map(|outer| inner.iter().map(move |w| w * outer)).collect()
        })
    }

    /// Whether it is symmetric in the norm, but for rounding.
    pub fn is_symmetric(&self) -> bool {
        self.0.iter().all(AxisOperator::is_symmetric)
    }

    /// `W (1 - c L)`; of a symmetric one the lower triangle only.
    pub fn system(&self, c: f64) -> SparseColMat<usize, f64> {
        let (n, weights, is_symmetric) = (self.points(), self.weights(), self.is_symmetric());
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for (point, &weight) in weights.iter().enumerate() {
            // Along every axis: the column there, the place in it, and how far points are apart.
            let mut stride = 1;
            let lines = self.0.iter().map(|axis| {
                let line = (
                    &axis.columns[point / stride % axis.points()],
                    point / stride % axis.points(),
                    stride,
                );
                stride *= axis.points();
                line
            });
            let lines: Vec<_> = lines.collect();
            let mut add = |row: usize, l: f64| {
                rows.push(row);
                values.push(if row == point {
                    weight * (1.0 - c * l)
                } else {
                    -c * weights[row] * l
                });
            };
            if !is_symmetric {
                for &(column, here, stride) in lines.iter().rev() {
                    for &(i, l) in column.iter().filter(|&&(i, _)| i < here) {
                        add(point - (here - i) * stride, l);
                    }
                }
            }
            let own = |&(column, here, _): &(&Vec<(usize, f64)>, usize, usize)| {
                column.iter().filter(|&&(i, _)| i == here).map(|&(_, l)| l).sum::<f64>()
            };
            add(point, lines.iter().map(own).sum());
            for &(column, here, stride) in &lines {
                for &(i, l) in column.iter().filter(|&&(i, _)| i > here) {
                    add(point + (i - here) * stride, l);
                }
            }
            starts.push(rows.len());
        }
        SparseColMat::new(SymbolicSparseColMat::new_checked(n, n, starts, None, rows), values)
    }
}
