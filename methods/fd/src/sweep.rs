//! The stage that evaluates an equation on the rows of a tile.

use finegrain_framework::instructions;
use finegrain_framework::pack::Pack;
use finegrain_framework::space::Grid;
use finegrain_framework::space::grid::RowsOfMut;
use finegrain_framework::{
    ColumnId, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, State,
};

use crate::around::{Coefficients, Weights};
use crate::equation::Equation;
use crate::line::{Ends, Line};
use crate::packs::Advance;
use crate::plane::Plane;
use crate::row::{Cross, NearEnd, Out, Row, Window};

/// What becomes of the rate of change that an equation gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// It is written, for an integrator.
    Rate,
    /// Euler's method at once: `u + dt u'`, the next state.
    Euler,
    /// Of an equation of second order in time: `2 u_n - u_{n-1} + dt^2 u''`, the next state in the
    /// place of the last.
    TwoStep,
    /// The state before the first, in the place of `u_0 + dt u'_0`: `2 u_0 - (u_0 + dt u'_0) + dt^2/2 u''`.
    Before,
}

/// Evaluates an equation of `F` unknowns and `G` given fields, reading `R` points to either side, in
/// lines of `N` and, next to closed ends, `M` points.
pub(crate) struct Sweep<
    T: Real,
    E,
    const F: usize,
    const G: usize,
    const R: usize,
    const N: usize,
    const M: usize,
> {
    pub equation: E,
    pub unknowns: [State<T>; F],
    pub given: [State<T>; G],
    pub out: [Rate<T>; F],
    pub form: Form,
    /// Of each unknown and axis; `None` where there is no axis.
    pub lines: [[Option<Line<T>>; 3]; F],
    /// Of given fields, of which nothing is asked at closed ends.
    pub given_lines: [Option<Line<T>>; 3],
    pub coefficients: Coefficients<T, R>,
    /// Positions along each axis.
    pub positions: [Vec<f64>; 3],
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    /// Rows beyond the ends of y and z: of each field, axis and end, from the end outwards.
    ghosts: Vec<Vec<T>>,
    /// What is given on the boundary: of each unknown, at the two ends of x, and along a row at the end
    /// of y and z that is near.
    data: Vec<Vec<T>>,
    /// Of each field, at the two ends of a row.
    windows: Vec<[Window<T>; 2]>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { ghosts: Vec::new(), data: Vec::new(), windows: Vec::new() }
    }
}

/// Deepest ghost point.
const DEEPEST: usize = 4;

/// Where a ghost row is kept.
fn ghost_row(field: usize, axis: usize, end: usize, depth: usize) -> usize {
    ((field * 2 + axis - 1) * 2 + end) * DEEPEST + depth
}

impl<T: Real, E, const F: usize, const G: usize, const R: usize, const N: usize, const M: usize>
    Sweep<T, E, F, G, R, N, M>
where
    E: Equation<T, F, G>,
{
    #[inline(always)]
    fn run<V: Pack<Scalar = T>>(&self, simd: V::Simd, work: Work<'_, '_, T, F>) {
        let Work { near, out, scratch, moment } = work;
        let nx = near.domain().shape()[0];
        let axes = self.lines[0].iter().flatten().count();
        let weights = Weights::<V, R>::new(simd, axes, &self.coefficients);
        let single =
            Weights::<T::Pack<pulp::Scalar>, R>::new(pulp::Scalar, axes, &self.coefficients);
        let dt = T::of(moment.dt);
        let advance = match self.form {
            Form::Rate => Advance::Rate,
            Form::Euler => Advance::Euler(dt),
            Form::TwoStep => Advance::TwoStep(dt * dt),
            Form::Before => Advance::TwoStep(T::of(0.5) * dt * dt),
        };
        scratch.ghosts.resize_with((F + G) * 4 * DEEPEST, Vec::new);
        scratch.data.resize_with(F * 3, Vec::new);
        scratch.windows.resize(F + G, [Window::default(); 2]);
        let closed = self.lines[0][0].as_ref().map_or(0, Line::closed);
        let is_long = nx - 2 * closed.min(nx / 2) >= V::LANES.max(2 * R);
        let is_bounded = (0..F + G).any(|f| (0..3).any(|a| self.is_bounded(f, a)));
        let [rows, planes] = near.sub_domain().extent();
        for k in planes {
            let plane = |f| Plane::<T, R, N>::new(near, self.column(f), &rows, k);
            let fields: [_; F] = std::array::from_fn(plane);
            let given: [_; G] = std::array::from_fn(|g| plane(F + g));
            for j in rows.clone() {
                if is_bounded {
                    self.fill(near, scratch, (j, k), moment.stage_time);
                }
                let Scratch { ghosts, data, windows } = &mut *scratch;
                let mut ends = [[None; 2]; F];
                let mut given_ends = [[None; 2]; G];
                if is_bounded {
                    for a in 1..3 {
                        for f in 0..F {
                            ends[f][a - 1] =
                                self.near_end(&fields[f], [ghosts, data], (f, a), (j, k));
                        }
                        for g in 0..G {
                            given_ends[g][a - 1] =
                                self.near_end(&given[g], [ghosts, data], (F + g, a), (j, k));
                        }
                    }
                }
                // Not by `from_fn`, which is not inlined.
                let mut unknowns = [Cross::new(&fields[0], &ends[0]); F];
                for f in 1..F {
                    unknowns[f] = Cross::new(&fields[f], &ends[f]);
                }
                let mut crosses = [unknowns[0]; G];
                for g in 0..G {
                    crosses[g] = Cross::new(&given[g], &given_ends[g]);
                }
                let row = Row {
                    sweep: self,
                    number: j,
                    unknowns,
                    given: crosses,
                    data,
                    advance,
                    dt,
                    closed,
                };
                let mut out = Out { rows: out, row: (j, k) };
                if !is_long || !row.is_open() {
                    row.points(&single, windows, [0, nx], &mut out);
                    continue;
                }
                row.packs::<V>(simd, &weights, windows, [closed, nx - closed], &mut out);
                if closed > 0 {
                    row.points(&single, windows, [0, closed], &mut out);
                    row.points(&single, windows, [nx - closed, nx], &mut out);
                }
            }
        }
    }

    /// Line `a` of field `f`, unknowns first.
    #[inline(always)]
    pub fn line(&self, f: usize, a: usize) -> Option<&Line<T>> {
        if f < F { self.lines[f][a].as_ref() } else { self.given_lines[a].as_ref() }
    }

    fn is_bounded(&self, f: usize, a: usize) -> bool {
        self.line(f, a).is_some_and(|line| !matches!(line.ends, Ends::Periodic))
    }

    fn column(&self, f: usize) -> State<T> {
        if f < F { self.unknowns[f] } else { self.given[f - F] }
    }

    /// Fills rows beyond the ends, and what is given on the boundary, around row `(j, k)`.
    fn fill(
        &self,
        near: &Near<'_, Grid>,
        scratch: &mut Scratch<T>,
        (j, k): (usize, usize),
        time: f64,
    ) {
        for f in 0..F + G {
            for a in 0..3 {
                let Some(line) = self.line(f, a) else { continue };
                match &line.ends {
                    Ends::Periodic => {}
                    _ if a == 0 => {
                        if f < F {
                            let data = &mut scratch.data[f * 3];
                            data.clear();
                            data.extend(
                                [0, 1].map(|end| line.given(self, a, end, [0, j, k], time)),
                            );
                        }
                    }
                    Ends::Closed(_) => {
                        if f < F
                            && let Some((_, end)) = line.row([0, j, k][a])
                        {
                            let data = &mut scratch.data[f * 3 + a];
                            data.clear();
                            let points = 0..self.positions[0].len();
                            data.extend(points.map(|x| line.given(self, a, end, [x, j, k], time)));
                        }
                    }
                    Ends::Ghosts(ghosts) => {
                        for (end, ghosts) in ghosts.iter().enumerate() {
                            let at = line.counted_from([0, j, k][a], end);
                            for depth in 0..R.saturating_sub(at) {
                                let ghost = ghosts[depth];
                                let mut source = [j as isize, k as isize];
                                source[a - 1] = line.counted_from(ghost.source, end) as isize;
                                let from = near.rows(self.column(f)).row(source[0], source[1]);
                                let to = &mut scratch.ghosts[ghost_row(f, a, end, depth)];
                                to.clear();
                                to.extend(from.iter().enumerate().map(|(x, &u)| {
                                    ghost.keep * u
                                        + ghost.data * line.given(self, a, end, [x, j, k], time)
                                }));
                            }
                        }
                    }
                }
            }
        }
    }

    /// The rows of field `f`, unknowns first, along axis `a` around row `(j, k)`, if an end is near.
    fn near_end<'a>(
        &'a self,
        plane: &Plane<'a, T, R, N>,
        [ghosts, data]: [&'a [Vec<T>]; 2],
        (f, a): (usize, usize),
        (j, k): (usize, usize),
    ) -> Option<NearEnd<'a, T, M>> {
        let (y, z, at) = (j as isize, k as isize, [0, j, k][a]);
        let line = self.line(f, a).filter(|line| !line.is_inner(at, R))?;
        let mut near = NearEnd { rows: [&[]; M], closed: None };
        let mut range = -(R as isize)..R as isize + 1;
        if let Some((row, _)) = line.row(at) {
            range = row.from..row.to();
            if f < F {
                near.closed = Some((row, &data[f * 3 + a][..]));
            }
        }
        for by in range {
            let beyond = at as isize + by;
            let past = [-1 - beyond, beyond - line.points as isize];
            let end = past.iter().position(|&past| past >= 0);
            near.rows[(by + (M / 2) as isize) as usize] = match (end, &line.ends) {
                (Some(end), Ends::Ghosts(_)) => &ghosts[ghost_row(f, a, end, past[end] as usize)],
                (Some(_), Ends::Closed(_)) => &[],
                _ if a == 1 => plane.far.row(y + by, z),
                _ => plane.far.row(y, z + by),
            };
        }
        Some(near)
    }
}

impl<T: Real> Line<T> {
    /// What is given at an end of line `axis`, at the foot of point `[x, j, k]`.
    fn given<E, const F: usize, const G: usize, const R: usize, const N: usize, const M: usize>(
        &self,
        sweep: &Sweep<T, E, F, G, R, N, M>,
        axis: usize,
        end: usize,
        point: [usize; 3],
        time: f64,
    ) -> T {
        let mut position = [0, 1, 2].map(|a| sweep.positions[a][point[a]]);
        position[axis] = self.limits[end];
        T::of(self.conditions[end].data().at(position, time))
    }
}

/// A tile's share.
struct Work<'s, 'n, T, const F: usize> {
    near: &'s Near<'n, Grid>,
    out: &'s mut RowsOfMut<'n, T, F>,
    scratch: &'s mut Scratch<T>,
    moment: &'s Moment,
}

/// To be compiled for every instruction set.
struct Task<
    's,
    'n,
    T: Real,
    E,
    const F: usize,
    const G: usize,
    const R: usize,
    const N: usize,
    const M: usize,
> {
    sweep: &'s Sweep<T, E, F, G, R, N, M>,
    work: Work<'s, 'n, T, F>,
}

impl<T: Real, E, const F: usize, const G: usize, const R: usize, const N: usize, const M: usize>
    pulp::WithSimd for Task<'_, '_, T, E, F, G, R, N, M>
where
    E: Equation<T, F, G>,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        self.sweep.run::<T::Pack<S>>(simd, self.work);
    }
}

impl<T: Real, E, const F: usize, const G: usize, const R: usize, const N: usize, const M: usize>
    RateStage<Grid> for Sweep<T, E, F, G, R, N, M>
where
    E: Equation<T, F, G>,
{
    type Scratch = Scratch<T>;

    fn name(&self) -> &str {
        self.equation.name()
    }

    fn writes(&self) -> Vec<ColumnId> {
        self.out.iter().map(|rate| rate.id()).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        scratch: &mut Scratch<T>,
        moment: &Moment,
    ) -> Result<(), Fault> {
        let mut out = rates.rows_of(self.out);
        let work = Work { near, out: &mut out, scratch, moment };
        instructions::dispatch(Task { sweep: self, work });
        Ok(())
    }
}
