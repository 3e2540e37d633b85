//! Particles in cells, and all pairs of them found in two ways.

use std::collections::HashSet;

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{CellsOptions, Region, Run};
use finegrain_framework::*;

use super::random::Random;

/// A particle, another one, and the image that it is seen through.
pub type Pair = (usize, usize, [i64; 3]);

/// Particles in cells.
pub struct Case<T> {
    pub columns: Columns,
    pub position: Vec<State<T>>,
    /// Where in the order before sorting a particle was.
    pub number: State<u32>,
    pub cells: Cells<T>,
    pub options: CellsOptions,
}

impl<T: Real> Case<T> {
    /// Particles at `points`, not sorted yet.
    pub fn new(options: CellsOptions, points: &[Vec<f64>]) -> Self {
        let dims = options.region.lower.len();
        let mut columns = Columns::new(points.len());
        let position: Vec<State<T>> =
            (0..dims).map(|a| columns.state(&format!("position_{a}"))).collect();
        let number = columns.state("number");
        for (a, &position) in position.iter().enumerate() {
            let values = columns.values_mut(position);
            values.iter_mut().zip(points).for_each(|(x, point)| *x = T::of(point[a]));
        }
        let cells = Cells::new(&mut columns, &position, options.clone()).unwrap();
        Self { columns, position, number, cells, options }
    }

    /// Sorts them into cells, and notes where each was before.
    pub fn sort(&mut self, workers: usize) -> Result<(), Fault> {
        let number = self.columns.values_mut(self.number);
        number.iter_mut().zip(0..).for_each(|(number, i)| *number = i);
        self.cells.sort(&mut self.columns, &mut Team::new(workers).unwrap())
    }

    fn dims(&self) -> usize {
        self.position.len()
    }

    fn period(&self, a: usize) -> f64 {
        let Region { lower, upper, periodic } = &self.options.region;
        if periodic.get(a) == Some(&true) { upper[a] - lower[a] } else { 0.0 }
    }

    /// Whether `i` sees `j`, shifted, within range.
    fn in_range(&self, i: usize, j: usize, shift: [f64; 3]) -> bool {
        let squares = (0..self.dims()).map(|a| {
            let x = self.columns.values(self.position[a]);
            let d = x[i].as_f64() - (x[j].as_f64() + shift[a]);
            d * d
        });
        squares.sum::<f64>() <= self.options.range * self.options.range
    }

    fn pairs_by_search(&self) -> Vec<Pair> {
        let images: [i64; 3] = std::array::from_fn(|a| {
            let period = self.period(a);
            // Positions may have drifted out of the box by half a skin.
            let far = self.options.range + self.options.skin;
            if period > 0.0 { (far / period).ceil() as i64 + 1 } else { 0 }
        });
        let mut pairs = Vec::new();
        for i in 0..self.columns.points() {
            for j in 0..self.columns.points() {
                for z in -images[2]..=images[2] {
                    for y in -images[1]..=images[1] {
                        for x in -images[0]..=images[0] {
                            let image = [x, y, z];
                            let shift = std::array::from_fn(|a| image[a] as f64 * self.period(a));
                            if self.in_range(i, j, shift) {
                                pairs.push((i, j, image));
                            }
                        }
                    }
                }
            }
        }
        pairs
    }

    /// What the stages see, in the order in which they see it.
    pub fn runs(&self) -> Vec<(usize, Span, Vec<Run>)> {
        let partition = self.cells.partition();
        let mut all = Vec::new();
        for id in 0..partition.len() {
            let block = self.cells.sub_domain(id);
            let mut runs = Vec::new();
            block.surroundings(&mut runs);
            let around = seen(&runs);
            let once: HashSet<_> = around.iter().collect();
            assert_eq!(once.len(), around.len(), "nobody is around twice in the same place");
            let mut points = 0;
            for cell in block.cells() {
                let mut runs = Vec::new();
                block.candidates(cell, &mut runs);
                for run in &runs {
                    assert!(partition.sees(id, run.owner));
                    let [span] = partition.spans(run.owner) else { panic!("several spans") };
                    assert!(span.start <= run.span.start && run.span.end <= span.end);
                }
                let mut around = around.iter();
                for candidate in seen(&runs) {
                    let is_it = |&at: &(usize, [u64; 3])| at == candidate;
                    assert!(around.any(is_it), "around in the order in which a cell sees them");
                }
                points += cell.span.len();
                all.push((id, cell.span, runs));
            }
            assert_eq!(points, block.points(), "a block's cells hold its particles");
        }
        all
    }

    fn pairs_by_cells(&self) -> Vec<Pair> {
        let mut pairs = Vec::new();
        for (_, span, runs) in self.runs() {
            for i in span.range() {
                for run in &runs {
                    for j in run.span.range().filter(|&j| self.in_range(i, j, run.shift)) {
                        let image = std::array::from_fn(|a| match self.period(a) {
                            0.0 => 0,
                            period => (run.shift[a] / period).round() as i64,
                        });
                        pairs.push((i, j, image));
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    /// Compares the two ways.
    #[track_caller]
    pub fn assert_all_pairs_found(&self, what: &str) {
        let (mut expected, found) = (self.pairs_by_search(), self.pairs_by_cells());
        expected.sort_unstable();
        let missed: Vec<_> =
            expected.iter().filter(|pair| found.binary_search(pair).is_err()).take(5).collect();
        assert!(missed.is_empty(), "{what}: missed {missed:?} of {}", expected.len());
        assert!(found == expected, "{what}: {} pairs instead of {}", found.len(), expected.len());
    }
}

/// Points, and the bits of the shifts with which they are seen.
fn seen(runs: &[Run]) -> Vec<(usize, [u64; 3])> {
    let points = |run: &Run| {
        let shift = run.shift.map(f64::to_bits);
        run.span.range().map(move |i| (i, shift))
    };
    runs.iter().flat_map(points).collect()
}

/// A box, with blocks of a few particles.
pub fn options(
    lower: &[f64],
    upper: &[f64],
    periodic: &[bool],
    range: f64,
    skin: f64,
) -> CellsOptions {
    let region =
        Region { lower: lower.to_vec(), upper: upper.to_vec(), periodic: periodic.to_vec() };
    CellsOptions { region, range, skin, block_points: 6 }
}

/// Particles anywhere in a box.
pub fn scattered(
    random: &mut Random,
    points: usize,
    lower: &[f64],
    upper: &[f64],
) -> Vec<Vec<f64>> {
    let one = |random: &mut Random| {
        lower.iter().zip(upper).map(|(l, u)| l + random.unit() * (u - l)).collect()
    };
    (0..points).map(|_| one(random)).collect()
}
